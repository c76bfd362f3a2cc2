//! Who sends a frame, and to whom.

use super::super::put;
use super::Filled;
use crate::address::{Address, Pattern};
use crate::{Addressing, Mode, Received};

/// Who sends a frame, and to whom.
#[derive(Clone, Copy, Debug)]
pub struct Ends {
    id: u32,
    is_to_module: bool,
    addressing: Option<Addressing>,
    answer: Option<u32>,
}

/// All frames of a message have one identifier.
impl PartialEq for Ends {
    fn eq(&self, other: &Self) -> bool {
        (self.id, self.is_to_module) == (other.id, other.is_to_module)
    }
}

impl Ends {
    pub(super) const fn new(id: u32, is_to_module: bool, addressing: Option<Addressing>) -> Self {
        Self { id, is_to_module, addressing, answer: None }
    }

    /// Returns the ends of a frame, if it is one of the transport.
    pub(super) fn of<T: Filled>(received: &Received<T::Protocol>) -> Option<Self> {
        let is_own = T::FRAMES.contains(&received.exchange().message());
        is_own.then(|| Self::new(received.frame().raw_id(), received.is_to_module(), received.addressing()))
    }

    /// Says which identifier the receiver's answer has.
    pub(super) const fn answered_by(self, answer: Option<u32>) -> Self {
        Self { answer, ..self }
    }

    /// Returns the identifier of the sender's frames.
    pub const fn id(&self) -> u32 {
        self.id
    }

    /// Tests whether the sender is the controller.
    pub const fn is_to_module(&self) -> bool {
        self.is_to_module
    }

    /// Returns the identifier of the receiver's answer, if one is known.
    pub(super) const fn answer(&self) -> Option<u32> {
        self.answer
    }

    /// Tests whether a frame of the receiver answers one of the sender. Its mode can be another one, if addresses show
    /// who they are.
    pub(super) fn answers(&self, sender: &Self) -> bool {
        let is_between = match (self.addressing, sender.addressing) {
            (Some(own), Some(other)) => {
                let is_named = own.addresses().iter().any(|address| !address.kind().is_sent());
                let is_same_mode = own.mode().name == other.mode().name;
                (is_named || is_same_mode) && self.agrees_with(sender) && sender.agrees_with(self)
            }
            (None, None) => true,
            _ => false,
        };
        self.is_to_module != sender.is_to_module && is_between
    }

    /// Tests whether the other one shows the same addresses. It may lack those that are sent unless the caller says
    /// otherwise.
    fn agrees_with(&self, other: &Self) -> bool {
        self.addresses().iter().all(|address| {
            let (kind, number) = (address.kind(), address.number(self.id));
            let shown = other.addressing.and_then(|known| known.number(kind, other.id));
            shown.map_or(kind.is_sent(), |shown| shown == number)
        })
    }

    fn addresses(&self) -> &'static [Address] {
        self.addressing.map_or(&[], |known| known.addresses())
    }

    /// Returns the identifier of an answer: in the mode of the message, or else in one that shows the same addresses.
    /// `id` is what it has elsewhere.
    pub(super) fn answer_in(&self, modes: &'static [Mode], id: u32) -> Option<u32> {
        let own = self.addressing?.mode();
        let others = modes.iter().filter(|_| self.addresses().iter().any(|address| !address.kind().is_sent()));
        let mut patterns = [own].into_iter().chain(others).flat_map(|mode| self.patterns_back(mode)).flatten();
        let pattern = patterns.find(|pattern| self.is_shown_by(pattern))?;
        let id = pattern.constants.iter().fold(id, |id, (bits, value)| put(id, *bits, *value));
        let address = |id, address: &Address| {
            let shown = self.addressing.and_then(|known| known.number(address.kind(), self.id));
            let number = shown.unwrap_or_else(|| address.kind().sent_number());
            put(id, address.bits(), address.kind().raw(number))
        };
        Some(pattern.addresses.iter().fold(id, address))
    }

    /// Returns the patterns of a mode by which the receiver can answer.
    fn patterns_back(&self, mode: &'static Mode) -> [Option<&'static Pattern>; 3] {
        if self.is_to_module {
            [mode.one.as_ref(), mode.each.as_ref(), mode.coordinator.as_ref()]
        } else {
            [mode.request.as_ref(), None, None]
        }
    }

    /// Tests whether a pattern shows the addresses that the frame shows, and no others.
    fn is_shown_by(&self, pattern: &Pattern) -> bool {
        let has = |addresses: &[Address], address: &Address| {
            address.kind().is_sent() || addresses.iter().any(|known| known.kind().is(address.kind()))
        };
        let own = self.addresses();
        own.iter().all(|address| has(pattern.addresses, address))
            && pattern.addresses.iter().all(|address| has(own, address))
    }
}
