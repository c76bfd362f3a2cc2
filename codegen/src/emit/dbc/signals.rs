//! Turns signals of the model into signals of a DBC.

use canspec_runtime::Place;

use super::file::Signal;
use super::text::{remarks, unit};
use crate::model::{
    Encoding, NamedValue, Numeral, Protocol, Range, Selector, Severity, Signal as Meaning, StatusBit, StatusWord,
    TextForm,
};
use crate::words::number::Rational;

/// A signal as the file has it.
pub struct Written {
    pub signals: Vec<Signal>,
    /// What the file cannot say, as the part of a sentence after the signal's name.
    pub loss: Option<&'static str>,
}

/// Returns a signal as the file has it: as one signal, or one for each status bit or part.
pub fn written(protocol: &Protocol, signal: &Meaning, name: &str) -> Written {
    let whole = |signals| Written { signals, loss: None };
    let range = signal.range.or_else(|| signal.held());
    match &signal.encoding {
        Encoding::Number { numeral: Numeral::Bcd, .. } => {
            let number = Signal { unit: String::new(), ..plain(signal, name) };
            Written { signals: vec![number], loss: Some("is in decimal digits; its bits are given as a number") }
        }
        Encoding::Number { numeral: numeral @ (Numeral::Unsigned | Numeral::Signed), scale, offset } => {
            whole(vec![Signal {
                signed: numeral.is_signed(),
                factor: *scale,
                offset: *offset,
                range,
                ..plain(signal, name)
            }])
        }
        Encoding::ByModel { numeral, .. } => {
            let raw = Signal { signed: numeral.is_signed(), range: signal.held(), ..plain(signal, name) };
            Written { signals: vec![raw], loss: Some("has a scale that depends on the device model; it is given raw") }
        }
        Encoding::Float => whole(vec![Signal { float: true, range, ..plain(signal, name) }]),
        Encoding::Named(id) => {
            let values = named(&protocol[*id].values);
            let signed = values.iter().any(|(raw, _)| *raw < 0);
            whole(vec![Signal { signed, named: values, ..plain(signal, name) }])
        }
        Encoding::Status(word) => whole(status(&protocol[*word], signal.place, name)),
        Encoding::Text(form) => {
            let loss = match form {
                TextForm::Ascii { .. } => "is a text; it is given as a number",
                TextForm::Hexadecimal => "is raw bytes; they are given as a number",
            };
            Written { signals: vec![plain(signal, name)], loss: Some(loss) }
        }
        Encoding::Packed { parts, .. } => {
            let signals = parts.iter().flat_map(|part| signals(protocol, part, &format!("{name}_{}", part.name)));
            let loss = Some("is one text of several parts; each part is a signal");
            Written { signals: signals.collect(), loss }
        }
    }
}

/// Returns the DBC signals of a signal.
pub fn signals(protocol: &Protocol, signal: &Meaning, name: &str) -> Vec<Signal> {
    written(protocol, signal, name).signals
}

fn plain(signal: &Meaning, name: &str) -> Signal {
    Signal {
        unit: signal.unit.map_or_else(String::new, unit),
        comment: remarks(&signal.doc),
        named: named(&signal.specials),
        start: signal.default,
        ..Signal::new(name.to_owned(), signal.place)
    }
}

/// Returns a signal for each named bit, and one for each run of bits without a name.
fn status(word: &StatusWord, place: Place, name: &str) -> Vec<Signal> {
    let mut signals = Vec::new();
    let mut high = place.width();
    for bit in word.bits_in(place).rev() {
        signals.extend(unnamed(place, name, bit.bit + 1, high));
        let comment = about(bit);
        signals.push(Signal { comment, ..Signal::new(format!("{name}_{}", bit.name), place.bit(bit.bit)) });
        high = bit.bit;
    }
    signals.extend(unnamed(place, name, 0, high));
    signals
}

/// Returns the bits of a status word from `low` to below `end`, if there are any.
fn unnamed(place: Place, name: &str, low: u8, end: u8) -> Option<Signal> {
    let high = end.checked_sub(1).filter(|high| *high >= low)?;
    let comment = "Bits without a name".to_owned();
    Some(Signal { comment, ..Signal::new(format!("{name}_unnamed_{high}_{low}"), place.bits(high, low)) })
}

/// Says what a status bit means.
fn about(bit: &StatusBit) -> String {
    let facts =
        [("set when", &bit.set_when), ("cleared when", &bit.clear_when), ("effect", &bit.effect), ("LED", &bit.led)];
    let facts = facts.iter().filter_map(|(what, text)| Some(format!("{what}: {}", text.as_ref()?.in_dbc())));
    let severity = bit.severity.map(|severity| match severity {
        Severity::State => "state".to_owned(),
        Severity::Alarm => "alarm".to_owned(),
        Severity::Fault => "fault".to_owned(),
    });
    let remarks = Some(remarks(&bit.doc)).filter(|text| !text.is_empty());
    remarks.into_iter().chain(severity).chain(facts).collect::<Vec<_>>().join("; ")
}

/// Returns a selector in the data bytes. If it has only one value in these frames, its range is
/// that value.
pub fn selector(protocol: &Protocol, selector: &Selector, place: Place, constant: Option<u64>, name: String) -> Signal {
    let values = selector.enumeration.map(|index| named(&protocol.enumerations[index].values));
    let plain = Signal::new(name, place);
    let only = constant.map(|value| Rational::integer(value.into()));
    let range = only.map(|only| Range { minimum: only, maximum: only });
    Signal { comment: remarks(&selector.doc), named: values.unwrap_or_default(), range: range.or(plain.range), ..plain }
}

fn named(values: &[NamedValue]) -> Vec<(i128, String)> {
    values.iter().map(|value| (value.raw, value.name.clone())).collect()
}
