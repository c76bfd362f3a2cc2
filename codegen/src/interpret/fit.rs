//! How well a frame fits what it may be: its addresses, and the device model.

use std::cmp::Reverse;

use super::Frame;
use crate::model::{AddressPattern, FieldId, FrameId, FrameLayout, Message, ModelId, Protocol, Travel, Who};

/// A kind of frame that a frame may be.
pub type Candidate<'a> = (FrameId, &'a FrameLayout);

/// A frame, and what it may be.
pub struct Decoder<'a, 'f> {
    pub protocol: &'a Protocol,
    pub model: Option<ModelId>,
    pub frame: &'f Frame,
    pub data: [u8; 8],
}

/// How well an addressing pattern fits, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fit {
    Documented,
    Tolerated,
    DocumentedElsewhere,
    ToleratedElsewhere,
    None,
}

/// The mode that a frame shows.
pub struct Addressing<'a> {
    pub fit: Fit,
    /// How many bits of the identifier the mode fixes.
    pub constants: usize,
    pub travel: Option<(Travel, &'a AddressPattern)>,
}

impl<'a> Decoder<'a, '_> {
    pub fn field(&self, id: FieldId) -> u32 {
        self.protocol[id].get(self.frame.id)
    }

    /// Returns the kinds of frames that have the frame's length.
    pub fn candidates(&self, frames: &'a [FrameId]) -> impl Iterator<Item = Candidate<'a>> {
        let protocol = self.protocol;
        let length = self.frame.data.len();
        let known = frames.iter().map(move |id| (*id, &protocol[*id]));
        known.filter(move |(_, layout)| layout.has_length(length))
    }

    /// Ranks candidates: first those that the device model has, then those whose addresses fit
    /// better.
    pub fn rank(&self, (_, frame): &Candidate) -> (Reverse<bool>, Fit, Reverse<usize>) {
        let addressing = self.addressing(frame);
        let is_of_model = self.model.is_none_or(|model| self.protocol[frame.message].is_of(model));
        (Reverse(is_of_model), addressing.fit, Reverse(addressing.constants))
    }

    pub fn message(&self, (_, frame): Candidate) -> &'a Message {
        &self.protocol[frame.message]
    }

    /// Finds the mode that fits best: documented addresses, then tolerated ones, then modes that
    /// the message does not have.
    pub fn addressing(&self, frame: &FrameLayout) -> Addressing<'a> {
        self.documented(frame).unwrap_or_else(|| self.tolerated(frame))
    }

    /// Finds a mode of the message whose addresses are all documented, as nearly every frame has one.
    fn documented(&self, frame: &FrameLayout) -> Option<Addressing<'a>> {
        let mut best: Option<(Travel, &AddressPattern)> = None;
        for way in &frame.travels {
            let Some(pattern) = self.protocol[way.mode].pattern(frame.is_to_module(), way.who) else { continue };
            let is_better = best.is_none_or(|(_, known)| known.constants < pattern.constants);
            if is_better && self.fits(pattern) == Some(false) {
                best = Some((*way, pattern));
            }
        }
        let (_, pattern) = best?;
        Some(Addressing { fit: Fit::Documented, constants: pattern.constants, travel: best })
    }

    /// Finds the mode that fits best if none fits as documented.
    fn tolerated(&self, frame: &FrameLayout) -> Addressing<'a> {
        let patterns = self.protocol.modes.entries().flat_map(|(mode, known)| {
            let is_to_module = frame.is_to_module();
            let senders: &[_] = if is_to_module { &[Who::Nobody] } else { &[Who::One, Who::Each, Who::Coordinator] };
            senders.iter().filter_map(move |who| Some((Travel { mode, who: *who }, known.pattern(is_to_module, *who)?)))
        });
        let fitting = patterns.filter_map(|(shown, pattern)| {
            let tolerated = self.fits(pattern)?;
            let is_shown = |own: &&Travel| own.mode == shown.mode && (frame.is_to_module() || own.who == shown.who);
            let own = frame.travels.iter().find(is_shown);
            let fit = match (own.is_some(), tolerated) {
                (true, false) => Fit::Documented,
                (true, true) => Fit::Tolerated,
                (false, false) => Fit::DocumentedElsewhere,
                (false, true) => Fit::ToleratedElsewhere,
            };
            let travel = own.copied().unwrap_or(shown);
            Some(Addressing { fit, constants: pattern.constants, travel: Some((travel, pattern)) })
        });
        let none = Addressing { fit: Fit::None, constants: 0, travel: None };
        fitting.min_by_key(|known| (known.fit, Reverse(known.constants))).unwrap_or(none)
    }

    /// Tests a pattern. `Some(true)` means that it holds with an address that the document does not
    /// name.
    fn fits(&self, pattern: &AddressPattern) -> Option<bool> {
        if self.frame.id & pattern.mask != pattern.value {
            return None;
        }
        pattern.addresses.iter().try_fold(false, |tolerated, address| {
            let address_type = &self.protocol[address.address_type];
            let raw = self.field(address.field);
            let excluded = || address.excluded.iter().any(|(first, last)| (*first..=*last).contains(&raw));
            match address_type.documents(raw) {
                true => Some(tolerated),
                false if address_type.strict || excluded() => None,
                false => Some(true),
            }
        })
    }
}
