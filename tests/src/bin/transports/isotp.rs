//! A node on a bus of ISO-TP.

use canspec_runtime::embedded_can::{Id, StandardId};
use canspec_runtime::isotp::{Answer, Assembler, Event, Link, Packet, SIZES, Sender, Separation, memory};

use crate::{Node, Word};

type Memory = [u8; memory(*SIZES.end())];

/// A node that receives a message and sends another one at a time.
pub struct IsoTp {
    assembler: Assembler<Memory, 1>,
    padding: Option<u8>,
    sending: Option<(Link, Sender<'static>)>,
}

impl IsoTp {
    /// Returns a node that asks for blocks and a separation, and fills frames up if there is a byte for that.
    pub fn new(block: u8, separation: u8, padding: Option<u8>) -> Self {
        let assembler = Assembler::new().pacing(block, Separation(separation)).padded(padding);
        Self { assembler, padding, sending: None }
    }

    /// Returns the frames that may be sent now, and whether they were the last ones.
    fn frames(&mut self) -> Vec<Word> {
        let Some((link, sender)) = &mut self.sending else { return Vec::new() };
        let mut words: Vec<_> = sender.map(|packet| frame(*link, &packet)).collect();
        if sender.is_done() {
            words.push(Word::Sent);
            self.sending = None;
        }
        words
    }
}

impl Node for IsoTp {
    fn send(&mut self, id: u32, data: Vec<u8>) -> Vec<Word> {
        // The program ends soon, and a sender borrows its data.
        let sender = Sender::new(data.leak()).map(|sender| sender.padded(self.padding));
        let Some((link, sender)) = link(id).zip(sender) else { return vec![Word::Broken("Size".into())] };
        self.sending = Some((link, sender));
        self.frames()
    }

    fn take(&mut self, id: u32, data: &[u8]) -> Vec<Word> {
        let Some(link) = link(id) else { return Vec::new() };
        let answer = self.sending.as_mut().map_or(Answer::Other, |(_, sender)| sender.control(data));
        match answer {
            Answer::Allowed(_) => self.frames(),
            Answer::Wait => Vec::new(),
            Answer::Overflow | Answer::Wrong => {
                self.sending = None;
                vec![Word::Broken(format!("{answer:?}"))]
            }
            Answer::Other => words(&self.assembler.receive(link, data, 0)),
        }
    }
}

/// Returns the link of frames with an identifier. That of the other direction differs by 8, as in OBD.
fn link(id: u32) -> Option<Link> {
    let standard = |id: u32| StandardId::new(u16::try_from(id).ok()?).map(Id::Standard);
    Some(Link { source: standard(id)?, target: standard(id ^ 8)? })
}

fn frame(link: Link, packet: &Packet) -> Word {
    Word::Frame(raw(link.source), packet.data().to_vec())
}

fn raw(id: Id) -> u32 {
    match id {
        Id::Standard(id) => id.as_raw().into(),
        Id::Extended(id) => id.as_raw(),
    }
}

/// Returns what the assembler does.
fn words(event: &Event<Memory>) -> Vec<Word> {
    let broken = event.broken.iter().chain(&event.refused).map(|broken| Word::Broken(format!("{:?}", broken.cause)));
    let whole = event.whole.iter();
    let whole = whole.map(|transfer| Word::Message(raw(transfer.link.source), transfer.data().to_vec()));
    let answer = event.answer.iter().map(|(link, packet)| frame(*link, packet));
    broken.chain(whole).chain(answer).collect()
}
