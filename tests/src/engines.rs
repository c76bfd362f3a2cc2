//! What both engines say of a frame, and to which bits they encode a value.

use canspec_codegen::interpret::{self, Frame, Input, Limits, Value, raw_of};
use canspec_codegen::model::{Message, ModelId, Protocol, Signal};
use canspec_codegen::number::Rational;
use canspec_runtime::{Meaning, Number, Payload, Problem, Reading, WriteSignal};
use embedded_can::Frame as _;

use crate::{models, number, received};

/// Compares what the engines say of a frame, and tells whether they recognise it.
///
/// # Panics
///
/// If they disagree.
pub fn compare_decoding<P: canspec_runtime::Protocol>(
    protocol: &Protocol,
    model: Option<ModelId>,
    frame: &Frame,
) -> bool {
    let report = interpreted(protocol, model, frame);
    assert_eq!(generated::<P>(model, frame), report, "{}: {frame:X?} of {model:?}", protocol.name);
    report.is_ok()
}

/// Compares to which bits the engines encode a value, within the bits alone and within the limits of each device model.
///
/// # Panics
///
/// If they disagree.
pub fn compare_encoding(
    protocol: &Protocol,
    message: &Message,
    signal: &Signal,
    known: &'static dyn WriteSignal,
    value: f64,
) {
    for limits in std::iter::once(Limits::Bits).chain(models(protocol).map(Limits::Range)) {
        let bits = raw_of(protocol, message, signal, &Input::Number(value), limits).ok();
        let expected = bits.map(|bits| {
            let mut data = [0; 8];
            signal.place.put(&mut data, bits);
            data
        });
        let data = written(known, value, limits);
        assert_eq!(data, expected, "{}.{}.{} = {value} in {limits:?}", protocol.name, message.name, signal.name);
    }
}

/// Returns values around the limits, around special values, between the steps, and at random; what is no number refuses
/// them all.
pub fn candidates(signal: &Signal, random: &mut fastrand::Rng) -> Vec<f64> {
    let limits = signal.limits().flat_map(|(range, _)| [range.minimum.to_f64(), range.maximum.to_f64()]);
    let mut values =
        vec![0.0, -0.0, 0.5, 1.5, 2.5, -0.5, -1.5, 0.049_999_999_999_999_99, f64::NAN, f64::INFINITY, 1e300];
    values.extend(limits.flat_map(|limit| [limit, limit.next_up(), limit.next_down()]));
    let specials = signal.specials.iter().flat_map(|special| [special.raw - 1, special.raw, special.raw + 1]);
    let specials = specials.filter_map(|raw| signal.encoding.value_of(raw)).map(Rational::to_f64);
    values.extend(specials.collect::<Vec<_>>().windows(2).flat_map(|steps| between(steps[0], steps[1])));
    values.extend((0..40).map(|_| random.f64() * 2_f64.powi(random.i32(-12..40)) * f64::from(random.i8(-1..=1))));
    values
}

/// Returns values from one step to the next.
fn between(one: f64, other: f64) -> impl Iterator<Item = f64> {
    (0..=8).map(move |eighth| one + (other - one) * f64::from(eighth) / 8.0)
}

/// What either engine says of a frame.
#[derive(Debug, PartialEq)]
struct Report {
    message: String,
    access: String,
    kind: String,
    addressing: Option<String>,
    signals: Vec<(String, Option<String>, u64, String)>,
    selectors: Vec<(String, u64)>,
    reserved: [u8; 8],
    encoded: Option<Vec<u8>>,
}

fn generated<P: canspec_runtime::Protocol>(model: Option<ModelId>, frame: &Frame) -> Result<Report, Problem> {
    let received = received::<P>(model, frame)?;
    let mut signals = Vec::new();
    received.visit(|reading| signals.push(shown(&reading)));
    let exchange = received.exchange();
    Ok(Report {
        message: exchange.message().to_owned(),
        access: exchange.access().to_owned(),
        kind: format!("{:?}", received.kind()),
        addressing: received.addressing().map(|addressing| addressing.mode().name.to_owned()),
        signals,
        selectors: received.selectors().map(|(selector, raw)| (selector.name.to_owned(), raw)).collect(),
        reserved: received.reserved(),
        encoded: received.encode().ok().map(|frame| frame.data().to_vec()),
    })
}

fn shown(reading: &Reading) -> (String, Option<String>, u64, String) {
    let bits = match reading.raw {
        Number::Unsigned(raw) => raw,
        Number::Signed(raw) => raw.cast_unsigned(),
        Number::Single(_) | Number::Float(_) | Number::Fraction { .. } => panic!("a raw value is an integer"),
    };
    let meaning = match reading.meaning {
        Meaning::Number(number @ (Number::Float(_) | Number::Fraction { .. })) => {
            format!("{:016X}", number.to_f64().to_bits())
        }
        Meaning::Number(number) => number.to_string(),
        Meaning::Name(name) | Meaning::Text(name) => name.to_owned(),
        Meaning::Packed(text) => text.to_string(),
        Meaning::Bytes(_) => reading.meaning.to_string(),
        Meaning::Status(..) => "status".to_owned(),
        _ => "none".to_owned(),
    };
    (reading.name.to_owned(), reading.unit.map(str::to_owned), bits, meaning)
}

fn interpreted(protocol: &Protocol, model: Option<ModelId>, frame: &Frame) -> Result<Report, Problem> {
    let mut decoded = interpret::decode(protocol, model, frame).map_err(|problem| match problem.problem {
        interpret::Problem::Frame => Problem::Frame,
        interpret::Problem::Foreign => Problem::Foreign,
        interpret::Problem::Identifier => Problem::Identifier,
        interpret::Problem::UnknownMessage => Problem::UnknownMessage,
        interpret::Problem::Length => Problem::Length,
    })?;
    let message = &protocol.messages[decoded.message];
    let content = interpret::Content::of(protocol, &decoded);
    decoded.hide_lacking(protocol);
    let selectors = decoded.selectors.iter();
    Ok(Report {
        message: message.name.clone(),
        access: protocol.accesses[decoded.access].name.clone(),
        kind: format!("{:?}", decoded.kind),
        addressing: decoded.addressing.map(|travel| protocol[travel.mode].name.clone()),
        signals: decoded
            .signals
            .iter()
            .map(|reading| read(protocol, &message.signals[reading.signal], reading))
            .collect(),
        selectors: selectors.map(|(index, raw)| (protocol.selectors[*index].name.clone(), *raw)).collect(),
        reserved: decoded.reserved,
        encoded: interpret::encode(protocol, model, &content).ok().map(|frame| frame.data),
    })
}

/// Returns what a signal says without a device model, since readings of generated Rust know none.
fn read(protocol: &Protocol, signal: &Signal, reading: &interpret::Reading) -> (String, Option<String>, u64, String) {
    let width = signal.place.width();
    let negative = signal.encoding.numeral().is_signed() && reading.bits >> (width - 1) == 1;
    let bits = if negative && width < 64 { reading.bits | u64::MAX << width } else { reading.bits };
    let meaning = match &interpret::physical(protocol, signal, reading.bits) {
        Value::None => "none".to_owned(),
        Value::Integer(value) => value.to_string(),
        Value::Number(value) => format!("{:016X}", value.to_bits()),
        Value::Name(text) | Value::Text(text) => text.clone(),
        Value::Status { .. } => "status".to_owned(),
    };
    (signal.name.clone(), signal.unit.map(|unit| unit.symbol.to_string()), bits, meaning)
}

/// Writes a value through a signal of the generated code.
fn written(known: &'static dyn WriteSignal, value: f64, limits: Limits) -> Option<[u8; 8]> {
    let mut payload = match limits {
        Limits::Bits => Payload::new("message", [0; 8]),
        Limits::Range(model) => Payload::within_limits("message", [0; 8]).for_model(model.map(number)),
    };
    known.write(Meaning::Number(Number::Float(value)), &mut payload).ok().map(|()| *payload.data())
}
