//! Fields, named values and status bits that only some device models have.

use super::{DeviceModel, Message, ModelId, NamedValue, Protocol, Signal, Table};

/// What a device model does not have of a signal.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Lacking {
    /// The device model.
    pub model: ModelId,
    /// The bits.
    pub mask: u64,
    /// What they are on such a model.
    pub blank: u64,
    /// The named raw values.
    pub values: Vec<i128>,
}

impl Lacking {
    /// Returns the bits that a signal shows, although the device model does not have them.
    pub fn shown(&self, bits: u64) -> u64 {
        (bits ^ self.blank) & self.mask
    }
}

impl Message {
    /// Returns the bits of a signal that a device model does not have; `None` if it has it.
    pub(crate) fn blank(&self, signal: &Signal, model: ModelId) -> Option<u64> {
        let blank = if self.reserved.are_ones { signal.place.max() } else { 0 };
        (!signal.is_of(model)).then_some(blank)
    }
}

impl Protocol {
    /// Returns the raw values of a signal that have a name.
    pub fn named_values<'a>(&'a self, signal: &'a Signal) -> &'a [NamedValue] {
        signal.encoding.enumeration().map_or(&signal.specials, |known| &self[known].values)
    }

    /// Returns what a device model does not have of a signal, if there is anything.
    pub fn lacking(&self, message: &Message, signal: &Signal, model: ModelId) -> Option<Lacking> {
        if let Some(blank) = message.blank(signal, model) {
            let mask = signal.place.max();
            return Some(Lacking { model, mask, blank, values: Vec::new() });
        }
        let bits = signal.encoding.status_word().into_iter().flat_map(|word| &self[word].bits);
        let mask = bits.filter(|bit| !bit.is_of(model)).fold(0, |mask, bit| mask | 1 << bit.bit);
        let values = self.named_values(signal).iter().filter(|value| !value.is_of(model));
        let values: Vec<_> = values.map(|value| value.raw).collect();
        (mask != 0 || !values.is_empty()).then_some(Lacking { model, mask, blank: 0, values })
    }

    /// Says what bits of a signal show, although a device model does not have it.
    pub fn lack(&self, message: &Message, signal: &Signal, model: ModelId, bits: u64) -> Option<String> {
        let lacking = self.lacking(message, signal, model)?;
        let (shown, raw) = (lacking.shown(bits), signal.raw_of(bits));
        let (known, name) = (&self[model].name, &signal.name);
        if !signal.is_of(model) {
            return (shown != 0).then(|| format!("{known} has no `{name}`"));
        }
        let word = signal.encoding.status_word().into_iter().flat_map(|word| &self[word].bits);
        let set = word.filter(|bit| shown >> bit.bit & 1 == 1).map(|bit| &bit.name);
        let value = self.named_values(signal).iter().find(|value| value.raw == raw && !value.is_of(model));
        let names: Vec<_> = set.chain(value.map(|value| &value.name)).map(|name| format!("`{name}`")).collect();
        (!names.is_empty()).then(|| format!("`{name}` of {known} has no {}", names.join(", ")))
    }
}

/// Names the only device models that have something; `None` if every model has it.
pub fn only(models: &Table<ModelId, DeviceModel>, of: &[ModelId]) -> Option<String> {
    let names: Vec<_> = of.iter().map(|model| models[*model].name.as_str()).collect();
    (!names.is_empty()).then(|| format!("only {}", names.join(", ")))
}
