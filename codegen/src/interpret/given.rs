//! What a call gives by name: signals, and fields of the header and of the identifier that nothing else decides.

use canspec_runtime::Place;

use super::Refusal;
use super::refusal::{refuse, twice};
use crate::model::{
    AddressPattern, EnumerationId, FieldId, FrameLayout, IdentifierField, Message, Protocol, Selector, SelectorId,
    SelectorPlace,
};
use crate::words::number::Rational;

/// What a call gives for a frame.
pub struct Given {
    /// The texts of the signals.
    pub signals: Vec<(String, String)>,
    selectors: Vec<(Place, u64)>,
    fields: Vec<(FieldId, u32)>,
}

impl Given {
    /// Sorts what a call gives. A signal comes before a field of the header, and that before one of the identifier.
    /// What is none of these is left among the signals.
    ///
    /// # Errors
    ///
    /// Refuses a field that is given twice, a field that the message or its address decides, and a value that the field
    /// cannot have.
    pub fn of(
        protocol: &Protocol,
        (message, layout): (&Message, &FrameLayout),
        pattern: &AddressPattern,
        given: Vec<(String, String)>,
    ) -> Result<Self, Refusal> {
        let is_signal = |name: &str| message.signals.iter().any(|signal| signal.name == name);
        if let Some(name) = twice(&given).filter(|name| !is_signal(name)) {
            return Err(refuse(message, &format!("`{name}` is given twice")));
        }
        let mut sorted = Self { signals: Vec::new(), selectors: Vec::new(), fields: Vec::new() };
        for (name, text) in given {
            let mut in_header = layout.selectors.iter().filter_map(|id| match protocol[*id].place {
                SelectorPlace::Payload(place) => Some((*id, place)).filter(|_| protocol[*id].name == name),
                SelectorPlace::Identifier(_) => None,
            });
            if is_signal(&name) {
                sorted.signals.push((name, text));
            } else if let Some((id, place)) = in_header.next() {
                sorted.selectors.push((place, selected(protocol, (message, layout), (id, place), &text)?));
            } else if let Some((id, field)) = protocol.identifier.fields.entries().find(|(_, field)| field.name == name)
            {
                if is_decided(protocol, layout, pattern, (id, field)) {
                    return Err(decided(message, &name));
                }
                let greatest = field.greatest();
                let value = raw(protocol, message, &name, (&text, field.enumeration), greatest.into())?;
                sorted.fields.push((id, u32::try_from(value).unwrap_or(greatest)));
            } else {
                sorted.signals.push((name, text));
            }
        }
        Ok(sorted)
    }

    /// Puts the fields into an identifier and into data.
    pub fn put(&self, protocol: &Protocol, id: u32, data: &mut [u8; 8]) -> u32 {
        self.selectors.iter().for_each(|(place, value)| place.put(data, *value));
        self.fields.iter().fold(id, |id, (field, value)| protocol[*field].put(id, *value))
    }
}

/// Reads the value of a field of the header.
fn selected(
    protocol: &Protocol,
    (message, layout): (&Message, &FrameLayout),
    (id, place): (SelectorId, Place),
    text: &str,
) -> Result<u64, Refusal> {
    let Selector { name, continues, enumeration, .. } = &protocol[id];
    if continues.is_some() {
        return Err(decided(message, name));
    }
    let value = raw(protocol, message, name, (text, *enumeration), place.max())?;
    let constant = layout.constants.iter().find(|constant| constant.selector == id);
    match constant.filter(|constant| !constant.admits(value)) {
        Some(constant) => {
            let text = format!("`{name}` is {value:#04X}, and in this frame it is {}", constant.text());
            Err(refuse(message, &text))
        }
        None => Ok(value),
    }
}

/// Tests whether a constant or an address stands in a field of the identifier.
fn is_decided(
    protocol: &Protocol,
    layout: &FrameLayout,
    pattern: &AddressPattern,
    (id, field): (FieldId, &IdentifierField),
) -> bool {
    let is_constant =
        field.constant.is_some() || field.continues.is_some() || layout.identifier().any(|(known, _)| known == id);
    is_constant || pattern.fixes(field, &protocol.identifier.fields)
}

fn decided(message: &Message, name: &str) -> Refusal {
    refuse(message, &format!("the message or its address decides `{name}`"))
}

/// Reads a number, or the name of a value.
fn raw(
    protocol: &Protocol,
    message: &Message,
    name: &str,
    (text, enumeration): (&str, Option<EnumerationId>),
    greatest: u64,
) -> Result<u64, Refusal> {
    let values = enumeration.map_or(&[][..], |id| &protocol[id].values);
    let named = values.iter().find(|value| value.name == text).map(|value| value.raw);
    let whole = named.or_else(|| Rational::parse(text).and_then(Rational::to_integer));
    let fitting = whole.and_then(|whole| u64::try_from(whole).ok()).filter(|value| *value <= greatest);
    fitting.ok_or_else(|| {
        let others: Vec<_> = values.iter().map(|value| format!(", `{}`", value.name)).collect();
        refuse(message, &format!("`{name}` has no value `{text}`; it has 0 to {greatest}{}", others.concat()))
    })
}
