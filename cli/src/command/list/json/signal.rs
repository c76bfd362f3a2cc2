//! A signal: where it stands, and what its bits mean.

use canspec_codegen::model::{self, Encoding, OfModel, Protocol, Range, TextForm, Unit, WrittenPlace};
use canspec_codegen::number::Rational;
use canspec_codegen::text::Text;
use serde::Serialize;

use super::remarks::{Remarks, Value, names};
use crate::command::list::{meaning, words};
use crate::show::severity::Severity;

/// A signal.
#[derive(Serialize)]
pub struct Signal<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    array: Option<Element<'a>>,
    types: &'a [String],
    place: WrittenPlace,
    /// The least number of bytes of a text whose length varies.
    least_bytes: Option<u16>,
    #[serde(rename = "as")]
    form: &'static str,
    fill: Option<u8>,
    format: Option<String>,
    parts: Vec<Signal<'a>>,
    scale: Option<String>,
    offset: Option<String>,
    unit: Option<String>,
    minimum: Option<String>,
    maximum: Option<String>,
    values: Vec<Value<'a>>,
    /// The name of the value that says that there is none.
    absent: Option<&'a str>,
    /// The raw value that the device starts with.
    default: Option<i128>,
    bits: Vec<StatusBit<'a>>,
    out_of_range: Option<&'static str>,
    power_off: Option<&'static str>,
    #[serde(rename = "in")]
    kinds: Vec<&'static str>,
    models: Vec<&'a str>,
    by_model: Vec<Own<'a>>,
}

/// Which element of an array a signal is.
#[derive(Serialize)]
struct Element<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    index: u8,
    /// The least number of elements, if that varies.
    least: Option<usize>,
}

/// A bit of a status word.
#[derive(Serialize)]
struct StatusBit<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    bit: u8,
    /// The byte in which the spec counts the bit, and its number there.
    byte: Option<usize>,
    bit_of_byte: Option<usize>,
    severity: Option<&'static str>,
    set_when: Option<&'a Text>,
    clear_when: Option<&'a Text>,
    effect: Option<&'a Text>,
    led: Option<&'a Text>,
    models: Vec<&'a str>,
}

/// What a signal is on a device model.
#[derive(Serialize)]
struct Own<'a> {
    model: &'a str,
    minimum: Option<String>,
    maximum: Option<String>,
    default: Option<i128>,
    scale: Option<String>,
    offset: Option<String>,
    unit: Option<String>,
}

impl<'a> Signal<'a> {
    /// Returns the signals of a message.
    pub fn all(protocol: &'a Protocol, message: &'a model::Message) -> Vec<Self> {
        let of = |signal| Self { array: Element::of(message, signal), ..Self::of(protocol, signal) };
        message.signals.iter().map(of).collect()
    }

    fn of(protocol: &'a Protocol, signal: &'a model::Signal) -> Self {
        let [scale, offset] = linear(signal);
        let [minimum, maximum] = limits(signal.range);
        Self {
            name: &signal.name,
            remarks: (&signal.doc).into(),
            array: None,
            types: &signal.types,
            place: signal.written(),
            least_bytes: signal.run.map(|run| run.least),
            form: words::encoding(&signal.encoding),
            fill: fill(&signal.encoding),
            format: meaning::format(&signal.encoding),
            parts: signal.encoding.parts().iter().map(|part| Self::of(protocol, part)).collect(),
            scale,
            offset,
            unit: symbol(signal.unit),
            minimum,
            maximum,
            values: Value::all(protocol, protocol.named_values(signal)),
            absent: meaning::absent(protocol, signal),
            default: signal.default,
            bits: StatusBit::all(protocol, signal),
            out_of_range: signal.conduct.out_of_range.map(words::out_of_range),
            power_off: signal.conduct.keeps.map(words::power_off),
            kinds: signal.kinds.iter().map(|kind| kind.name()).collect(),
            models: names(protocol, &signal.models),
            by_model: Own::all(protocol, signal),
        }
    }
}

impl<'a> Element<'a> {
    fn of(message: &'a model::Message, signal: &model::Signal) -> Option<Self> {
        let (element, array) = (signal.element?, message.array_of(signal)?);
        Some(Self { name: &array.name, remarks: (&array.doc).into(), index: element.index, least: array.least })
    }
}

impl<'a> StatusBit<'a> {
    fn all(protocol: &'a Protocol, signal: &'a model::Signal) -> Vec<Self> {
        meaning::status_bits(protocol, signal).map(|bit| Self::of(protocol, signal, bit)).collect()
    }

    fn of(protocol: &'a Protocol, signal: &model::Signal, known: &'a model::StatusBit) -> Self {
        let written = signal.byte_of(known);
        Self {
            name: &known.name,
            remarks: (&known.doc).into(),
            bit: known.bit,
            byte: written.map(|(byte, _)| byte),
            bit_of_byte: written.map(|(_, bit)| bit),
            severity: Severity::of(known).map(Severity::word),
            set_when: known.set_when.as_ref(),
            clear_when: known.clear_when.as_ref(),
            effect: known.effect.as_ref(),
            led: known.led.as_ref(),
            models: names(protocol, &known.models),
        }
    }
}

impl<'a> Own<'a> {
    /// Returns each device model that has limits, a default or a scale of its own.
    fn all(protocol: &'a Protocol, signal: &model::Signal) -> Vec<Self> {
        let has_own = |model| {
            let limits = signal.model_ranges.iter().any(|own| own.model == model);
            let defaults = signal.model_defaults.iter().any(|own| own.model == model);
            limits || defaults || signal.encoding.by_model().iter().any(|own| own.model == model)
        };
        protocol.models.ids().filter(|model| has_own(*model)).map(|model| Self::of(protocol, signal, model)).collect()
    }

    fn of(protocol: &'a Protocol, signal: &model::Signal, model: model::ModelId) -> Self {
        let scaled: Option<&OfModel<model::Signal>> = signal.encoding.by_model().iter().find(|own| own.model == model);
        let [scale, offset] = scaled.map_or([None, None], |own| linear(&own.value));
        let on = signal.on(Some(model));
        let [minimum, maximum] = limits(on.range_for(Some(model)));
        Self {
            model: &protocol[model].name,
            minimum,
            maximum,
            default: on.default_for(Some(model)),
            scale,
            offset,
            unit: scaled.and_then(|own| symbol(own.value.unit)),
        }
    }
}

/// Returns scale and offset of a number that has them on every device model.
fn linear(signal: &model::Signal) -> [Option<String>; 2] {
    let linear = signal.encoding.linear().filter(|_| signal.encoding.by_model().is_empty());
    [linear.map(|linear| linear.scale), linear.map(|linear| linear.offset)].map(exact)
}

fn exact(number: Option<Rational>) -> Option<String> {
    number.map(|number| number.to_string())
}

/// Returns the ends of limits.
pub fn limits(range: Option<Range>) -> [Option<String>; 2] {
    [range.map(|range| range.minimum), range.map(|range| range.maximum)].map(exact)
}

fn symbol(unit: Option<Unit>) -> Option<String> {
    unit.map(|unit| unit.symbol.to_string())
}

fn fill(encoding: &Encoding) -> Option<u8> {
    match encoding.text_form()? {
        TextForm::Ascii { fill } => Some(fill),
        TextForm::Hexadecimal => None,
    }
}
