//! Transfers of many nodes at once: whatever is lost, repeated or late, each message that is reported was sent.

use std::collections::VecDeque;

use canspec_codegen::interpret::{Assembled, Assembly, Form, Frame, decode};
use canspec_codegen::model::Protocol;
use canspec_runtime::transfers;
use canspec_tests::devices_batteries::{Label, Message, Tp};
use canspec_tests::{received, specs};
use fastrand::Rng;

fn protocol() -> Protocol {
    let path = specs("tests/specs/devices").into_iter().find(|path| path.ends_with("batteries.yaml"));
    canspec_tests::protocol(path.expect("the spec of the batteries"))
}

/// A message that a battery sends, to the charger or to everybody.
#[derive(Clone, Debug)]
struct Transfer {
    battery: u32,
    target: u32,
    data: Vec<u8>,
}

/// Frames of J1939-21, written byte by byte.
impl Transfer {
    fn new(battery: u32, rng: &mut Rng) -> Self {
        let target = if rng.u8(..3) == 0 { 0xFF } else { 0x56 };
        Self { battery, target, data: (0..rng.usize(9..=30)).map(|_| rng.u8(..)).collect() }
    }

    fn frame(&self, format: u32, data: Vec<u8>) -> Frame {
        frame(7 << 26 | format << 16 | self.target << 8 | self.battery, data)
    }

    fn answer(&self, data: Vec<u8>) -> Frame {
        frame(7 << 26 | 0xEC << 16 | self.battery << 8 | self.target, data)
    }

    fn packets(&self) -> Vec<Frame> {
        let packets = (1..).zip(self.data.chunks(7));
        let packet = |(number, chunk): (u8, &[u8])| {
            let padding = vec![0xFF; 7 - chunk.len()];
            self.frame(0xEB, [&[number], chunk, &padding].concat())
        };
        packets.map(packet).collect()
    }

    fn announcement(&self) -> Frame {
        let control = if self.target == 0xFF { 0x20 } else { 0x10 };
        let [size, packets] = [self.data.len(), self.packets().len()].map(byte);
        self.frame(0xEC, vec![control, size, 0, packets, 0xFF, 0, 0x15, 0])
    }

    /// What the nodes put on the bus. Some frames are lost, late, repeated, or never sent.
    fn frames(&self, rng: &mut Rng) -> Vec<Frame> {
        let packets = self.packets();
        let (mut frames, mut lost) = (vec![self.announcement()], Vec::new());
        for (index, packet) in packets.iter().enumerate() {
            match rng.u8(..12) {
                0 => lost.push(index),
                1 => frames.extend([packet.clone(), packet.clone()]),
                2 if frames.len() > 1 => frames.insert(frames.len() - 1, packet.clone()),
                _ => frames.push(packet.clone()),
            }
        }
        if self.target != 0xFF {
            match (lost.first(), rng.u8(..4)) {
                (Some(first), 0 | 1) => {
                    let again = self.answer(vec![0x11, 0xFF, byte(*first + 1), 0xFF, 0xFF, 0, 0x15, 0]);
                    frames.push(again);
                    frames.extend(packets[*first..].iter().cloned());
                }
                (Some(_), 2) => frames.push(self.answer(vec![0xFF, 3, 0xFF, 0xFF, 0xFF, 0, 0x15, 0])),
                _ => {}
            }
        }
        frames
    }
}

fn byte(number: usize) -> u8 {
    u8::try_from(number).expect("it is small")
}

fn frame(id: u32, data: Vec<u8>) -> Frame {
    Frame { id, extended: true, data, form: Form::Data }
}

/// Decodes a log, and returns the messages that ended.
fn assembled(protocol: &Protocol, log: &[Frame]) -> Vec<Assembled<()>> {
    let mut assembly = Assembly::default();
    let mut ended = Vec::new();
    for frame in log {
        let decoded = decode(protocol, None, frame).unwrap_or_else(|problem| panic!("{frame:X?}: {}", problem.text));
        ended.extend(assembly.take(protocol, None, (), frame, &decoded).ended);
    }
    ended.extend(assembly.finish(protocol, None));
    ended
}

/// Counts the messages that generated code finds whole in a log. Each of them was sent.
fn whole_in_rust(log: &[Frame], sent: &[Transfer]) -> usize {
    let mut assembler = transfers::Assembler::<Tp, 16>::new();
    let mut whole = 0;
    for (frame, now) in log.iter().zip(0..) {
        let received = received::<Message>(None, frame).expect("the frame is one of the protocol");
        let Some(message) = assembler.take(&received, now).whole else { continue };
        let (identifier, label) = (message.identifier(), message.values::<Label>().expect("it is a label"));
        let link = (u32::from(identifier.source), u32::from(identifier.target));
        let is_it = |known: &Transfer| (known.battery, known.target) == link && *known.data == *label.text;
        assert!(sent.iter().any(is_it), "nobody sent {message:?}");
        whole += 1;
    }
    whole
}

#[test]
fn each_transfer_that_is_reported_was_sent_and_each_one_announced_is_reported() {
    let protocol = protocol();
    let (mut whole, mut incomplete, mut in_rust) = (0, 0, 0);
    for seed in 0..2_000 {
        let mut rng = Rng::with_seed(seed);
        let (mut sent, mut announced, mut queues) = (Vec::new(), 0, Vec::new());
        for battery in 1..=rng.u32(1..=8) {
            let (mut queue, mut spoiled) = (VecDeque::new(), Vec::new());
            for _ in 0..rng.usize(1..5) {
                let transfer = Transfer::new(battery, &mut rng);
                let frames = transfer.frames(&mut rng);
                // Packets without their announcement would fill up a message before them that is not whole.
                let is_announced = rng.u8(..10) != 0 || spoiled.contains(&transfer.target);
                announced += usize::from(is_announced);
                spoiled.retain(|target| *target != transfer.target);
                if !transfer.packets().iter().all(|packet| frames.contains(packet)) {
                    spoiled.push(transfer.target);
                }
                queue.extend(frames.into_iter().skip(usize::from(!is_announced)));
                sent.push(transfer);
            }
            queues.push(queue);
        }
        let mut log = Vec::new();
        while let Some(index) = (!queues.is_empty()).then(|| rng.usize(..queues.len())) {
            match queues[index].pop_front() {
                Some(frame) => log.push(frame),
                None => drop(queues.swap_remove(index)),
            }
        }
        in_rust += whole_in_rust(&log, &sent);
        let ended = assembled(&protocol, &log);
        assert_eq!(ended.len(), announced, "seed {seed}: each message that is announced is reported once");
        for message in ended {
            let Some(data) = message.data else {
                incomplete += 1;
                assert!(message.incomplete.is_some(), "seed {seed}");
                continue;
            };
            let (source, target) = (message.frame.id & 0xFF, message.frame.id >> 8 & 0xFF);
            let of_one = |known: &Transfer| (known.battery, known.target, &known.data) == (source, target, &data);
            assert!(sent.iter().any(of_one), "seed {seed}: nobody sent {data:X?}");
            whole += 1;
        }
    }
    assert!(whole > 5_000 && incomplete > 2_000, "{whole} whole and {incomplete} incomplete messages");
    assert!(in_rust > 5_000, "{in_rust} whole messages in generated code");
}

/// Identifiers and data of frames.
type Log<'a> = &'a [(u32, &'a [u8])];

/// Returns what a log of battery 1 says: the data of whole messages, and why others are not whole.
fn said(log: Log) -> Vec<String> {
    let frames: Vec<_> = log.iter().map(|(id, data)| frame(*id, data.to_vec())).collect();
    let ended = assembled(&protocol(), &frames).into_iter();
    ended
        .map(|message| message.incomplete.unwrap_or_else(|| format!("{:02X?}", message.data.unwrap_or_default())))
        .collect()
}

const CONTROL: u32 = 0x1CEC_5601;
const DATA: u32 = 0x1CEB_5601;
const ANSWER: u32 = 0x1CEC_0156;
/// Announces ten bytes in two packets.
const TEN: &[u8] = &[0x10, 10, 0, 2, 0xFF, 0, 0x15, 0];
const FIRST: &[u8] = &[1, 1, 2, 3, 4, 5, 6, 7];
const SECOND: &[u8] = &[2, 8, 9, 10, 0xFF, 0xFF, 0xFF, 0xFF];
const ALL: &str = "[01, 02, 03, 04, 05, 06, 07, 08, 09, 0A]";

#[test]
fn each_way_to_spoil_a_transfer_has_its_own_result() {
    let logs: [(&str, Log, &[&str]); 12] = [
        ("nothing", &[(CONTROL, TEN), (DATA, FIRST), (DATA, SECOND)], &[ALL]),
        ("no bytes", &[(CONTROL, &[0x10, 0, 0, 0, 0xFF, 0, 0x15, 0])], &["0 bytes in 0 packets are announced"]),
        (
            "2,000 bytes",
            &[(CONTROL, &[0x10, 0xD0, 7, 0xFF, 0xFF, 0, 0x15, 0])],
            &["2000 bytes in 255 packets are announced"],
        ),
        (
            "too few packets",
            &[(CONTROL, &[0x10, 15, 0, 2, 0xFF, 0, 0x15, 0])],
            &["15 bytes in 2 packets are announced"],
        ),
        (
            "abort",
            &[(CONTROL, TEN), (DATA, FIRST), (ANSWER, &[0xFF, 3, 0xFF, 0xFF, 0xFF, 0, 0x15, 0])],
            &["packet 2 is missing; the transfer is aborted for reason 3"],
        ),
        (
            "a new start",
            &[(CONTROL, TEN), (DATA, FIRST), (CONTROL, TEN), (DATA, FIRST), (DATA, SECOND)],
            &["packet 2 is missing; another message begins", ALL],
        ),
        (
            "other data in a packet",
            &[(CONTROL, TEN), (DATA, FIRST), (DATA, &[1, 9, 9, 9, 9, 9, 9, 9])],
            &["packet 2 is missing; packet 1 came twice, with other data"],
        ),
        (
            "an early acknowledgement",
            &[(CONTROL, TEN), (DATA, FIRST), (ANSWER, &[0x13, 10, 0, 2, 0xFF, 0, 0x15, 0])],
            &["packet 2 is missing; the receiver says that it came whole"],
        ),
        (
            "packets out of order",
            &[(CONTROL, TEN), (DATA, SECOND), (DATA, FIRST)],
            &["packet 1 is missing; packet 1 came after packet 2"],
        ),
        (
            "packets once more",
            &[
                (CONTROL, TEN),
                (DATA, SECOND),
                (ANSWER, &[0x11, 2, 1, 0xFF, 0xFF, 0, 0x15, 0]),
                (DATA, FIRST),
                (DATA, SECOND),
            ],
            &[ALL],
        ),
        ("packets alone", &[(DATA, FIRST), (DATA, SECOND)], &[]),
        ("the end of the log", &[(CONTROL, TEN)], &["the packets 1, 2 are missing"]),
    ];
    for (how, log, expected) in logs {
        assert_eq!(said(log), expected, "{how}");
    }
}
