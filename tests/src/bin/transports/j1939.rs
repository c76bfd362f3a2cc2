//! A node on a bus of J1939.

use canspec_runtime::Data;
use canspec_runtime::tp::{ALL, Answer, Assembler, Event, Link, Reason, SIZES, Sender, memory};

use crate::{Node, Word};

/// The formats of control frames and of packets, and the first one that has no receiver.
const CONTROL: u32 = 0xEC;
const PACKET: u32 = 0xEB;
const BROADCAST: u32 = 0xF0;

type Memory = [u8; memory(*SIZES.end())];

/// A node that receives a message and sends another one at a time.
pub struct J1939 {
    assembler: Assembler<Memory, 1>,
    /// The greatest number of packets that a receiver may allow at once.
    limit: u8,
    sending: Option<(Link, Sender<'static>)>,
}

impl J1939 {
    pub fn new(limit: u8) -> Self {
        Self { assembler: Assembler::new(), limit, sending: None }
    }

    /// Returns the packets that may be sent now.
    fn packets(&mut self) -> Vec<Word> {
        let Some((link, sender)) = &mut self.sending else { return Vec::new() };
        sender.map(|data| frame(PACKET, *link, data)).collect()
    }

    /// Takes a control frame about the message that is being sent, if it is one.
    fn answered(&mut self, from: Link, data: Data) -> Option<Vec<Word>> {
        let (link, sender) = self.sending.as_mut().filter(|(link, _)| link.reversed() == from)?;
        let link = *link;
        let words = match sender.control(&data) {
            Answer::Allowed(_) => return Some(self.packets()),
            Answer::Done => vec![Word::Sent],
            Answer::Aborted(reason) => vec![Word::Broken(format!("{reason:?}"))],
            Answer::Wrong => {
                vec![frame(CONTROL, link, sender.abort(Reason::OTHER)), Word::Broken(format!("{:?}", Answer::Wrong))]
            }
            Answer::Other => return None,
        };
        self.sending = None;
        Some(words)
    }
}

impl Node for J1939 {
    fn send(&mut self, id: u32, data: Vec<u8>) -> Vec<Word> {
        let (group, link) = parted(id);
        // The program ends soon, and a sender borrows its data.
        let Some(mut sender) = Sender::new(group, data.leak(), self.limit) else {
            return vec![Word::Broken("Size".into())];
        };
        let is_broadcast = link.target == ALL;
        let first = if is_broadcast { sender.bam() } else { sender.rts() };
        self.sending = Some((link, sender));
        let mut words = vec![frame(CONTROL, link, first)];
        words.extend(self.packets());
        words.extend(is_broadcast.then_some(Word::Sent));
        words
    }

    fn take(&mut self, id: u32, data: &[u8]) -> Vec<Word> {
        let (Ok(data), (_, link)) = (Data::try_from(data), parted(id)) else { return Vec::new() };
        match format(id) {
            CONTROL => self.answered(link, data).unwrap_or_else(|| words(&self.assembler.control(link, &data, 0))),
            PACKET => words(&self.assembler.packet(link, &data, 0)),
            _ => Vec::new(),
        }
    }
}

fn format(id: u32) -> u32 {
    id >> 16 & 0xFF
}

/// Returns the group of an identifier, and its nodes.
fn parted(id: u32) -> (u32, Link) {
    let [source, low, ..] = id.to_le_bytes();
    let group = id >> 8 & 0x3_FFFF;
    if format(id) < BROADCAST {
        (group & !0xFF, Link { source, target: low })
    } else {
        (group, Link { source, target: ALL })
    }
}

fn frame(format: u32, link: Link, data: Data) -> Word {
    let priority = 7 << 26;
    Word::Frame(priority | format << 16 | u32::from(link.target) << 8 | u32::from(link.source), data.to_vec())
}

/// Returns what the assembler does.
fn words(event: &Event<Memory>) -> Vec<Word> {
    let whole = event.whole.iter().map(|transfer| {
        let id = transfer.group << 8 | u32::from(transfer.link.source);
        let target = if format(id) < BROADCAST { transfer.link.target.into() } else { 0 };
        Word::Message(id | target << 8, transfer.data().to_vec())
    });
    let broken = event.broken.iter().chain(&event.refused).map(|broken| Word::Broken(format!("{:?}", broken.cause)));
    let answer = event.answer.iter().map(|(link, data)| frame(CONTROL, *link, *data));
    whole.chain(broken).chain(answer).collect()
}
