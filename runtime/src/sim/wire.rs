//! Frames under way.

use crate::Frame;
use crate::clock::{earlier, has_come, later_of};

/// Frames under way, at most `W`, in the order in which they were sent. Behind the last one all slots are empty.
#[derive(Clone, Copy, Debug)]
pub struct Wire<const W: usize>([Option<UnderWay>; W]);

/// A frame under way.
#[derive(Clone, Copy, Debug)]
pub struct UnderWay {
    /// When it comes.
    pub at: u32,
    /// Who has sent it.
    pub from: Sender,
    pub frame: Frame,
}

/// Who sends a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sender {
    /// The client. Its frames wait in its driver until the bus is back.
    Client,
    /// The device of this number.
    Device(u8),
    /// Another controller.
    Other,
}

impl<const W: usize> Wire<W> {
    pub const EMPTY: Self = Self([None; W]);

    /// Sends a frame that comes at a time, but not before what its sender has sent before. It is lost if there is no
    /// room. Returns when it comes.
    pub fn send(&mut self, at: u32, from: Sender, frame: Frame) -> u32 {
        let at = self.under_way().filter(|other| other.from == from).map(|other| other.at).fold(at, later_of);
        if let Some(slot) = self.0.iter_mut().find(|slot| slot.is_none()) {
            *slot = Some(UnderWay { at, from, frame });
        }
        at
    }

    /// Takes out the frame that has come first.
    pub fn arrived(&mut self, now: u32) -> Option<UnderWay> {
        let come = self.under_way().enumerate().filter(|(_, frame)| has_come(frame.at, now));
        let (place, _) = come.reduce(|one, other| if earlier(other.1.at, one.1.at, now) { other } else { one })?;
        let rest = self.0.get_mut(place..)?;
        let first = rest.first_mut()?.take();
        rest.rotate_left(1);
        first
    }

    /// Tests whether a frame of a sender is under way.
    pub fn has(&self, from: Sender) -> bool {
        self.under_way().any(|frame| frame.from == from)
    }

    fn under_way(&self) -> impl Iterator<Item = &UnderWay> {
        self.0.iter().map_while(Option::as_ref)
    }
}
