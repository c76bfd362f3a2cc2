//! Fields and status bits that only some device models have.

use super::{Message, ModelId, Protocol, Signal};

/// Bits of a signal that a device model does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Lacking {
    /// The device model.
    pub model: ModelId,
    /// The bits.
    pub mask: u64,
    /// What they are on such a model.
    pub blank: u64,
}

impl Lacking {
    /// Returns the bits that a signal shows, although the device model does not have them.
    pub fn shown(&self, bits: u64) -> u64 {
        (bits ^ self.blank) & self.mask
    }
}

impl Protocol {
    /// Returns the bits of a signal that a device model does not have, if there are any.
    pub fn lacking(&self, message: &Message, signal: &Signal, model: ModelId) -> Option<Lacking> {
        if !signal.is_of(model) {
            let mask = signal.place.max();
            return Some(Lacking { model, mask, blank: if message.reserved.are_ones { mask } else { 0 } });
        }
        let word = &self[signal.encoding.status_word()?];
        let others = word.bits.iter().filter(|bit| !bit.is_of(model));
        let mask = others.fold(0, |mask, bit| mask | 1 << bit.bit);
        (mask != 0).then_some(Lacking { model, mask, blank: 0 })
    }

    /// Says what bits of a signal show, although a device model does not have it.
    pub fn lack(&self, message: &Message, signal: &Signal, model: ModelId, bits: u64) -> Option<String> {
        let shown = self.lacking(message, signal, model)?.shown(bits);
        if shown == 0 {
            return None;
        }
        let (known, name) = (&self[model].name, &signal.name);
        if !signal.is_of(model) {
            return Some(format!("{known} has no `{name}`"));
        }
        let bits = self[signal.encoding.status_word()?].bits.iter().filter(|bit| shown >> bit.bit & 1 == 1);
        let names: Vec<_> = bits.map(|bit| format!("`{}`", bit.name)).collect();
        Some(format!("`{name}` of {known} has no {}", names.join(", ")))
    }
}
