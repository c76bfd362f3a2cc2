//! Writes signals: where their bits are, and what they mean.

use canspec_runtime::Place;
use canspec_runtime::plumbing::ByteOrder;

use super::table::Value;
use crate::model::{
    Encoding, Lacking, Message, NamedValue, Numeral, OfModel, PartId, Piece, Protocol, Range, Signal, StatusBit, Table,
    TextForm,
};
use crate::words::number::Rational;

/// How a value is shown. Numbers are what has limits.
const INTEGER: &str = "integer";
const DOUBLE: &str = "double";
const TEXT: &str = "text";
const BITS: &str = "bits";

/// Before Lua 5.3, a raw value of more bits is no Lua number.
const LUA_BITS: u8 = 32;

/// Returns a place: its byte order, its bits in the eight bytes read in that order, and the bytes
/// that it touches.
pub fn place(place: Place) -> Value {
    let bits = place.bits_of_payload();
    let touched: Vec<usize> = (0..8).filter(|byte| place.mask()[*byte] != 0).collect();
    let first = touched.first().copied().unwrap_or_default();
    Value::record()
        .with("big", Value::flag(place.order() == ByteOrder::Big))
        .with("shift", Value::number(bits.shift()))
        .with("width", Value::number(bits.width()))
        .with("first", Value::Plain(first.to_string()))
        .with("count", Value::Plain(touched.len().to_string()))
}

/// Writes a raw value as the interpreter compares it, in quotes if it is no Lua number.
pub fn wide(raw: impl Into<i128>, width: u8) -> Value {
    let raw = raw.into();
    if width > LUA_BITS { Value::text(&raw.to_string()) } else { Value::number(raw) }
}

/// Returns the names of raw values.
pub fn names(values: &[NamedValue], width: u8) -> Value {
    Value::map(values.iter().map(|value| (wide(value.raw, width), Value::text(&value.name))))
}

/// Returns a signal of a message that `shortest` data bytes can carry.
pub fn signal(protocol: &Protocol, (message, shortest): (&Message, usize), signal: &Signal) -> Value {
    let record = Value::record()
        .with("name", Value::text(&signal.name))
        .maybe("title", signal.doc.title.as_ref().map(Value::words))
        .with("place", place(signal.place))
        .maybe("unit", signal.unit.map(|unit| Value::text(&unit.symbol)));
    let record = limits(meaning(protocol, (message, shortest), record, signal), signal);
    let rows = protocol.models.ids().filter_map(|model| protocol.lacking(message, signal, model));
    let rows: Vec<_> = rows.map(|known| (Value::id(known.model), lacking(shortest, signal, &known))).collect();
    record.maybe("lacking", (!rows.is_empty()).then(|| Value::map(rows.into_iter())))
}

/// Adds the meaning of the bits: the function that turns them into a value, and how the value is
/// shown.
fn meaning(protocol: &Protocol, of: (&Message, usize), record: Value, signal: &Signal) -> Value {
    let made = |by, shown| record.with("kind", Value::text(by)).with("shown", Value::text(shown));
    match &signal.encoding {
        Encoding::Number { numeral, .. } if signal.encoding.is_unscaled() => {
            written(made("integer", INTEGER), *numeral)
        }
        Encoding::Number { numeral, scale, offset } => {
            scaled(written(made("number", DOUBLE), *numeral), *scale, *offset)
        }
        Encoding::ByModel { numeral, signals } => {
            let on = |own: &OfModel<Signal>| (Value::id(own.model), self::signal(protocol, of, &own.value));
            written(made("by_model", DOUBLE), *numeral).with("on", Value::map(signals.iter().map(on)))
        }
        Encoding::Float => made("float", DOUBLE),
        Encoding::Named(id) => {
            let values = &protocol[*id].values;
            made("named", TEXT).with("names", names(values, signal.place.width()))
        }
        Encoding::Status(id) => made("status", BITS).with("bits", Value::list(&protocol[*id].bits, status_bit)),
        Encoding::Text(TextForm::Hexadecimal) => made("bytes", TEXT),
        Encoding::Text(TextForm::Ascii { fill: 0 }) => made("text", TEXT),
        Encoding::Text(TextForm::Ascii { fill }) => {
            made("text", TEXT).with("fill", Value::text(&format!("{fill:02X}")))
        }
        Encoding::Packed { pieces, parts } => {
            made("packed", TEXT).with("pieces", Value::list(pieces, |known| piece(known, parts)))
        }
    }
}

/// Returns the bits that a device model does not have, what they are there, and the raw values that it does not have.
fn lacking(shortest: usize, signal: &Signal, known: &Lacking) -> Value {
    let is_whole = !signal.is_of(known.model);
    let values = known.values.iter().map(|raw| (wide(*raw, signal.place.width()), Value::flag(true)));
    Value::record()
        .with("mask", Value::unsigned_of_64_bits(known.mask))
        .with("blank", Value::unsigned_of_64_bits(known.blank))
        .maybe("whole", is_whole.then(|| Value::flag(true)))
        .maybe("longer", (is_whole && signal.reach() > shortest).then(|| longer(shortest, signal)))
        .maybe("values", (!known.values.is_empty()).then(|| Value::map(values)))
}

/// Says that only some messages have a signal, or how many bytes of a text all of them have.
fn longer(shortest: usize, signal: &Signal) -> Value {
    match signal.run {
        None => Value::flag(true),
        Some(_) => Value::Plain(shortest.saturating_sub(signal.window.into()).to_string()),
    }
}

/// Adds which integer the bits are.
fn written(record: Value, numeral: Numeral) -> Value {
    match numeral {
        Numeral::Unsigned => record,
        Numeral::Signed => record.with("signed", Value::flag(true)),
        Numeral::Bcd => record.with("numeral", Value::text("bcd")),
    }
}

/// Adds scale and offset over one denominator. So (raw * numerator + offset) / denominator divides
/// once.
fn scaled(record: Value, scale: Rational, offset: Rational) -> Value {
    let denominator = scale.common_denominator(offset).unwrap_or(1);
    let over = |number: Rational| number.numerator() * (denominator / number.denominator());
    record
        .with("numerator", Value::number(over(scale)))
        .with("offset", Value::number(over(offset)))
        .with("denominator", Value::number(denominator))
}

fn status_bit(bit: &StatusBit) -> Value {
    Value::record()
        .with("bit", Value::number(bit.bit))
        .with("name", Value::text(&bit.name))
        .maybe("title", bit.doc.title.as_ref().map(Value::words))
}

fn piece(piece: &Piece, parts: &Table<PartId, Signal>) -> Value {
    let (part, digits) = match piece {
        Piece::Literal(text) => return Value::record().with("literal", Value::text(text)),
        Piece::Part { part, digits } => (&parts[*part], digits),
    };
    written(Value::record(), part.encoding.numeral())
        .with("place", place(part.place))
        .maybe("text", part.encoding.text_form().map(|_| Value::flag(true)))
        .maybe("digits", digits.map(|digits| Value::Plain(digits.to_string())))
        .maybe("range", part.range.map(|known| range(part, known)))
}

/// Adds special values and limits.
fn limits(record: Value, signal: &Signal) -> Value {
    let specials = (!signal.specials.is_empty()).then(|| names(&signal.specials, signal.place.width()));
    let own = signal.model_ranges.iter().map(|own| (Value::id(own.model), range(signal, own.value)));
    let own = (!signal.model_ranges.is_empty()).then(|| Value::map(own));
    record
        .maybe("specials", specials)
        .maybe("range", signal.range.map(|known| range(signal, known)))
        .maybe("model_ranges", own)
}

fn wide_limits(signal: &Signal, range: Range) -> Option<[Value; 2]> {
    let numeral = signal.encoding.linear()?.numeral;
    if signal.place.width() <= LUA_BITS || !signal.encoding.is_unscaled() {
        return None;
    }
    let limit = |limit: Rational| {
        let integer = limit.to_integer()?;
        if numeral.is_signed() {
            i64::try_from(integer).ok().map(Value::signed_of_64_bits)
        } else {
            u64::try_from(integer).ok().map(Value::unsigned_of_64_bits)
        }
    };
    Some([limit(range.minimum)?, limit(range.maximum)?])
}

/// Returns limits. They are integers of 64 bits if the values are no Lua numbers. For a float, the
/// floats nearest to the limits are legal too.
fn range(signal: &Signal, range: Range) -> Value {
    if let Some(limits) = wide_limits(signal, range) {
        return Value::list(limits, |limit| limit);
    }
    let [minimum, maximum] = [range.minimum, range.maximum].map(|limit| {
        let exact = limit.to_f64();
        #[expect(clippy::cast_possible_truncation, reason = "the nearest float is what can be met")]
        let nearest = f64::from(exact as f32);
        (exact, if signal.encoding.is_single() { nearest } else { exact })
    });
    Value::list([minimum.0.min(minimum.1), maximum.0.max(maximum.1)], Value::double)
}
