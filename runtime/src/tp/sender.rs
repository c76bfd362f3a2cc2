//! Takes a message apart into packets.

use super::control::{Control, Reason};
use super::{PACKET, packets};
use crate::Data;

/// Makes the frames of one message. As an iterator it gives the packets that may be sent now.
#[derive(Clone, Debug)]
pub struct Sender<'a> {
    data: &'a [u8],
    group: u32,
    packets: u8,
    limit: u8,
    /// The next packet to send.
    next: u16,
    /// The last packet that may be sent now.
    allowed: u16,
    /// The last packet that was sent. All before it were sent, too.
    sent: u16,
    /// The last packet from which on packets were asked for.
    asked: u16,
    /// How often they were asked for again.
    repetitions: u8,
}

/// How often a receiver may ask again for the packets from one on.
const REPETITIONS: u8 = 2;

/// What a control frame of the receiver changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Packets may be sent, or 0 if the receiver asks to wait.
    Allowed(u8),
    /// The receiver has the whole message.
    Done,
    /// The receiver has given up.
    Aborted(Reason),
    /// It is about another message, or none of a receiver. Or it leaves out packets that were
    /// never sent: an acknowledgement of all, or a request for those after them.
    Other,
    /// It asks for packets that the message does not have, or for the third time again for the same
    /// ones, or acknowledges another size. The transfer is to be aborted.
    Wrong,
}

impl<'a> Sender<'a> {
    /// Returns the sender of a message to one receiver, who may allow up to `limit` packets at once; 255 means any.
    /// Returns `None` unless there are 9 to 1,785 bytes.
    pub fn new(group: u32, data: &'a [u8], limit: u8) -> Option<Self> {
        let (packets, limit) = (packets(data.len())?, limit.max(1));
        Some(Self { data, group, packets, limit, next: 1, allowed: 0, sent: 0, asked: 0, repetitions: 0 })
    }

    /// Returns what goes on with the same message, whose data lie elsewhere.
    pub(crate) fn over<'b>(&self, data: &'b [u8]) -> Sender<'b> {
        let Self { group, packets, limit, next, allowed, sent, asked, repetitions, .. } = *self;
        Sender { data, group, packets, limit, next, allowed, sent, asked, repetitions }
    }

    /// Returns the data.
    pub(crate) const fn data(&self) -> &'a [u8] {
        self.data
    }

    /// Returns why the transfer is given up after an answer that is wrong.
    pub(crate) const fn wrong(&self) -> Reason {
        if self.repetitions > REPETITIONS { Reason::REPETITIONS } else { Reason::OTHER }
    }

    /// Returns the control frame that begins a message to one receiver.
    pub fn rts(&self) -> Data {
        Control::Rts { size: self.size(), packets: self.packets, limit: self.limit }.encode(self.group)
    }

    /// Begins a message to all: returns its control frame. All packets may be sent then, with 50 to
    /// 200 ms between them.
    pub fn bam(&mut self) -> Data {
        (self.next, self.allowed) = (1, self.packets.into());
        Control::Bam { size: self.size(), packets: self.packets }.encode(self.group)
    }

    /// Returns the control frame that gives up.
    pub fn abort(&self, reason: Reason) -> Data {
        Control::Abort(reason).encode(self.group)
    }

    /// Takes a control frame of the receiver.
    pub fn control(&mut self, data: &Data) -> Answer {
        let control = Control::decode(data).filter(|(_, group)| *group == self.group);
        match control.map(|(control, _)| control) {
            Some(Control::Cts { packets: 0, .. }) => {
                self.allowed = self.next.saturating_sub(1);
                Answer::Allowed(0)
            }
            Some(Control::Cts { packets, next }) => self.allow(packets, next),
            Some(Control::EndOfMsgAck { size, packets }) if (size, packets) != (self.size(), self.packets) => {
                Answer::Wrong
            }
            Some(Control::EndOfMsgAck { .. }) if self.sent < self.packets.into() => Answer::Other,
            Some(Control::EndOfMsgAck { .. }) => Answer::Done,
            Some(Control::Abort(reason)) => Answer::Aborted(reason),
            Some(Control::Rts { .. } | Control::Bam { .. }) | None => Answer::Other,
        }
    }

    fn allow(&mut self, packets: u8, next: u8) -> Answer {
        let next = u16::from(next);
        let last = next.saturating_add(packets.into()).saturating_sub(1);
        if next == 0 || last > self.packets.into() || packets > self.limit {
            return Answer::Wrong;
        }
        if next > self.sent.saturating_add(1) {
            return Answer::Other;
        }
        self.count(next);
        if self.repetitions > REPETITIONS {
            return Answer::Wrong;
        }
        (self.next, self.allowed) = (next, last);
        Answer::Allowed(packets)
    }

    /// Counts how often packets are asked for again.
    fn count(&mut self, next: u16) {
        let is_further = next > self.asked;
        let before = if is_further { 0 } else { self.repetitions };
        let is_again = !is_further || next <= self.sent;
        self.repetitions = before.saturating_add(is_again.into());
        self.asked = self.asked.max(next);
    }

    /// Returns the number of data bytes, which is at most 1,785.
    fn size(&self) -> u16 {
        u16::try_from(self.data.len()).unwrap_or_default()
    }
}

impl Iterator for Sender<'_> {
    type Item = Data;

    fn next(&mut self) -> Option<Data> {
        let number = u8::try_from(self.next).ok().filter(|_| self.next <= self.allowed)?;
        let start = usize::from(number.checked_sub(1)?).checked_mul(PACKET)?;
        let mut packet = [0xFF; 8];
        let chunk = [number].into_iter().chain(self.data.get(start..)?.iter().copied().take(PACKET));
        packet.iter_mut().zip(chunk).for_each(|(place, byte)| *place = byte);
        self.sent = self.sent.max(self.next);
        self.next = self.next.saturating_add(1);
        Some(packet)
    }
}
