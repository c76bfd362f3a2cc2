//! What a call gives by name: signals, and fields of the header and of the identifier that nothing else decides.

use canspec_runtime::Place;

use super::Refusal;
use super::encode::{refuse, twice};
use crate::model::{
    AddressPattern, EnumerationId, FieldId, FrameLayout, IdentifierField, Message, Protocol, SelectorPlace,
};
use crate::number::Rational;

/// What a call gives for a frame.
pub struct Given {
    /// The texts of the signals.
    pub signals: Vec<(String, String)>,
    selectors: Vec<(Place, u64)>,
    fields: Vec<(FieldId, u32)>,
}

impl Given {
    /// Sorts what a call gives. A signal comes before a field of the header, and that before one of the identifier. What is
    /// none of these is left among the signals.
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
            let is_signal = is_signal(&name);
            let selector = layout.selectors.iter().find(|id| protocol[**id].name == name);
            let field = protocol.identifier.fields.entries().find(|(_, field)| field.name == name);
            match (selector.map(|id| (*id, &protocol[*id])), field) {
                (Some((_, known)), _) if !is_signal && known.continues.is_some() => {
                    return Err(decided(message, &name));
                }
                (Some((id, known)), _) if !is_signal => {
                    let SelectorPlace::Payload(place) = known.place else { continue };
                    let value = raw(protocol, message, &name, (&text, known.enumeration), place.max())?;
                    let constant = layout.constants.iter().find(|constant| constant.selector == id);
                    if let Some(constant) = constant.filter(|constant| !constant.admits(value)) {
                        let values: Vec<_> = constant.values().map(|value| format!("{value:#04X}")).collect();
                        let text = format!("`{name}` is {value:#04X}, and in this frame it is {}", values.join(" or "));
                        return Err(refuse(message, &text));
                    }
                    sorted.selectors.push((place, value));
                }
                (_, Some((id, known))) if !is_signal => {
                    if is_decided(protocol, layout, pattern, (id, known)) {
                        return Err(decided(message, &name));
                    }
                    let greatest = known.greatest();
                    let value = raw(protocol, message, &name, (&text, known.enumeration), greatest.into())?;
                    sorted.fields.push((id, u32::try_from(value).unwrap_or(greatest)));
                }
                _ => sorted.signals.push((name, text)),
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
