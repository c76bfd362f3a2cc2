//! The label of a Huawei module, a long text in parts. The program asks for it until each part has come.

use std::collections::{BTreeMap, VecDeque};

use canspec_protocols::huawei::parts::{Assembler, Outcome};
use canspec_protocols::huawei::{ELabel, ELabelPart, Frame, Message, Parted, Target, Text};
use canspec_runtime::client::{Client, Step};
use canspec_runtime::sim::{Answer, Bench, Device, Event, Faults, Rules};
use canspec_runtime::{Bytes, Received};

/// A module with a label.
struct Module {
    label: ELabel,
    /// Frames that it has not sent yet.
    waiting: VecDeque<Frame>,
}

impl Module {
    fn new(text: &str) -> Self {
        Self { label: ELabel { text: Text::new(text).expect("a short text") }, waiting: VecDeque::new() }
    }
}

impl Device<Message> for Module {
    fn answer(&mut self, request: &Received<Message>, _now: u32) -> Answer<Message> {
        if let (Message::ReadTextELabel, Some(node)) = (request.content(), request.node()) {
            let blank = Message::ELabelPart(ELabelPart { part: 1, data: Bytes::new([0; 6]) });
            let blank = request.answer(node, blank).expect("it is asked");
            self.waiting = self.label.frames(&blank).expect("it has room").collect();
        }
        Answer::Silence
    }

    fn report(&mut self, _node: u8, _now: u32) -> Option<Frame> {
        self.waiting.pop_front()
    }
}

/// The label that section 12.4 prints, with a number of its own.
fn text(number: u8) -> String {
    format!(
        "[Board Properties]\r\nBoardType=SAMP1\r\n\r\nBarCode=2102987QABC2A00000{number}\r\nItem=02987QAB\r\n\
         Description=Sample,R48xxS\r\nIssueNumber=00\r\nBOM=\r\n"
    )
}

#[test]
fn labels_are_read_in_parts_although_frames_get_lost() {
    let nodes = [1, 4, 0x7F];
    let modules = nodes.map(|node| (node, Module::new(&text(node))));
    let rules = Rules { gap: super::pace::<Message>().gap, ..Rules::default() };
    let mut bench = Bench::<Message, Module, 3, 128>::new(modules, rules, 1);
    for node in nodes {
        *bench.faults(node).expect("a module") = Faults { deaf: 10, lost: 5, twice: 5, ..Faults::NONE };
    }
    let mut client = Client::<Message, 4>::new(super::pace::<Message>());
    let mut tickets = BTreeMap::new();
    for node in nodes {
        let request = ELabel::read_text(Target::Psu(node)).expect("an address");
        tickets.insert(node, client.every(500, request, 0).expect("room"));
    }
    let (mut assembler, mut labels) = (Assembler::<ELabel, 3>::new(200), BTreeMap::new());
    let mut torn = 0;
    for now in 0..60_000 {
        while let Some(event) = bench.poll(now) {
            let Event::Frame { frame, at } = event else { panic!("{event:?}") };
            let _ = client.handle(&frame, at);
            for outcome in assembler.receive(&frame, now) {
                let Outcome::Whole(whole) = outcome else { continue };
                let node = whole.identifier().address;
                labels.insert(node, whole.values.text.as_str().expect("a text").to_owned());
                tickets.remove(&node).into_iter().for_each(|ticket| client.cancel(ticket));
            }
        }
        while assembler.timed_out(now).is_some() {
            torn += 1;
        }
        while let Step::Send { frame, .. } = client.poll(now) {
            bench.send(&frame, now);
        }
    }
    assert_eq!(labels, nodes.into_iter().map(|node| (node, text(node))).collect());
    assert!(torn > 0 && bench.tally().lost > 0, "some frames get lost");
}
