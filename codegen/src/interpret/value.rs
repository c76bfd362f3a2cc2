//! One signal: raw bits to physical value and back.

use std::cmp::Ordering;
use std::fmt::Display;

use canspec_runtime::plumbing::{Scale, nearest};

use super::{Input, Refusal, Value};
use crate::model::{Encoding, Enumeration, Kind, Message, ModelId, NamedValue, Protocol, Range, Signal, raw_limits};
use crate::number::Rational;
use crate::texts::{parse_packed, raw_of_bits, text_bits, text_of_bits, unnamed, write_packed};

/// Returns the physical value of a signal's raw bits.
pub fn physical(protocol: &Protocol, signal: &Signal, bits: u64) -> Value {
    match &signal.encoding {
        Encoding::Number { signed, scale, offset } => {
            let raw = extended(signal, bits, *signed);
            match signal.specials.iter().find(|special| special.raw == raw) {
                Some(special) => Value::Name(special.name.clone()),
                None if signal.encoding.is_unscaled() => Value::Integer(raw),
                None => Value::Number(scaled(raw, *scale, *offset)),
            }
        }
        Encoding::Float => {
            let value = float(bits);
            if value.is_finite() { Value::Number(value.into()) } else { Value::None }
        }
        Encoding::Named(id) => {
            let named = named(&protocol[*id], bits);
            named.map_or(Value::None, |value| Value::Name(value.name.clone()))
        }
        Encoding::Status(id) => {
            let word = &protocol[*id];
            let set = word.bits.iter().map(|bit| bit.bit).filter(|bit| bits >> bit & 1 == 1);
            Value::Status { set: set.collect(), unknown: bits & !word.known() }
        }
        Encoding::Text => text_of_bits(signal, bits).map_or(Value::None, Value::Text),
        Encoding::Packed { pieces, parts } => {
            write_packed(pieces, parts, signal, bits).map_or(Value::None, Value::Text)
        }
    }
}

/// Returns the raw number of a signal's bits.
fn extended(signal: &Signal, bits: u64, signed: bool) -> i128 {
    let width = signal.place.width();
    let negative = signed && bits >> (width - 1) & 1 == 1;
    i128::from(bits) - if negative { 1 << width } else { 0 }
}

/// Returns the float of a signal's bits.
pub fn float(bits: u64) -> f32 {
    f32::from_bits(u32::try_from(bits & u64::from(u32::MAX)).unwrap_or(0))
}

/// Finds the named value of raw bits.
pub fn named(enumeration: &Enumeration, bits: u64) -> Option<&NamedValue> {
    enumeration.values.iter().find(|value| value.raw == i128::from(bits))
}

fn scaled(raw: i128, scale: Rational, offset: Rational) -> f64 {
    i64::try_from(raw).map_or(f64::NAN, |raw| runtime_scale(scale, offset).physical(raw))
}

/// Returns the scale as the runtime computes with it; the checks have made sure that its numbers fit.
fn runtime_scale(scale: Rational, offset: Rational) -> Scale {
    let part = |number: i128| i64::try_from(number).unwrap_or(1);
    Scale::new(part(scale.numerator()), part(scale.denominator()))
        .offset(part(offset.numerator()), part(offset.denominator()))
}

/// Tests a physical value against the range; of a float, the floats nearest to the limits are legal too.
pub fn in_range(signal: &Signal, range: &Range, value: f64) -> bool {
    let is_within = |minimum: f64, maximum: f64| (minimum..=maximum).contains(&value);
    #[allow(clippy::cast_possible_truncation, reason = "the nearest float is what can be met")]
    let nearest = |limit: f64| f64::from(limit as f32);
    let (minimum, maximum) = (range.minimum.to_f64(), range.maximum.to_f64());
    let is_float = matches!(signal.encoding, Encoding::Float);
    is_within(minimum, maximum) || (is_float && is_within(nearest(minimum), nearest(maximum)))
}

/// Tests an integer that is its own physical value against the range, however many digits it has.
pub fn whole_in_range(range: &Range, value: i128) -> bool {
    (range.minimum..=range.maximum).contains(&Rational::integer(value))
}

/// What a value to send must keep to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limits {
    /// What the bits hold, as in a reply.
    Bits,
    /// The range too, as in a request: that of a device model, or where none is chosen the hull of those of all models.
    Range(Option<ModelId>),
}

impl Limits {
    /// Returns what holds in a kind of frame.
    pub fn of(kind: Kind, model: Option<ModelId>) -> Self {
        if kind == Kind::Request { Self::Range(model) } else { Self::Bits }
    }
}

/// Returns the raw bits of a value to send; a request also refuses what lies outside the range and what is not finite.
///
/// # Errors
///
/// Names message, signal, value, unit and limits.
pub fn raw_of(
    protocol: &Protocol,
    message: &Message,
    signal: &Signal,
    input: &Input,
    limits: Limits,
) -> Result<u64, Refusal> {
    Encoder { protocol, message, signal, limits }
        .raw(input)
        .map_err(|why| Refusal(format!("{}.{}: {why}", message.name, signal.name)))
}

/// Encodes one signal.
struct Encoder<'a> {
    protocol: &'a Protocol,
    message: &'a Message,
    signal: &'a Signal,
    limits: Limits,
}

impl Encoder<'_> {
    fn raw(&self, input: &Input) -> Result<u64, String> {
        match (&self.signal.encoding, input) {
            (Encoding::Float, Input::Raw(raw)) => {
                let bits = self.bits(*raw, false)?;
                self.check_float(float(bits).into()).map(|()| bits)
            }
            (Encoding::Float, Input::Number(value)) => self.float(*value),
            (Encoding::Float, Input::Integer(value)) => self.float(as_double(*value)),
            (Encoding::Number { signed, .. }, Input::Raw(raw)) => self.raw_number(*raw, *signed),
            (Encoding::Number { signed, scale, offset }, input) => self.number(*signed, *scale, *offset, input),
            (_, Input::Raw(raw)) => self.bits(*raw, false),
            (Encoding::Named(id), Input::Text(name)) => self.name(&self.protocol[*id], name),
            (Encoding::Status(id), Input::Status { set, unknown }) => {
                let word = &self.protocol[*id];
                let named = raw_of_bits(word, set)?;
                if unknown & word.known() != 0 {
                    return Err(format!("`unknown` has bits {:#X} that have a name", unknown & word.known()));
                }
                self.bits((named | unknown).into(), false)
            }
            (Encoding::Text, Input::Text(text)) => text_bits(self.signal, text),
            (Encoding::Packed { pieces, parts }, Input::Text(text)) => parse_packed(pieces, parts, self.signal, text)
                .ok_or_else(|| format!("`{text}` is not of the documented form")),
            _ => Err(self.unwanted(input)),
        }
    }

    fn unwanted(&self, input: &Input) -> String {
        format!("{} is not {}", describe(input), wanted(self.signal))
    }

    fn name(&self, enumeration: &Enumeration, name: &str) -> Result<u64, String> {
        let value = enumeration.values.iter().find(|value| value.name == name);
        let value = value.ok_or_else(|| unnamed(enumeration, self.signal, name))?;
        self.bits(value.raw, false)
    }

    fn number(&self, signed: bool, scale: Rational, offset: Rational, input: &Input) -> Result<u64, String> {
        let value = match input {
            Input::Text(name) => {
                let special = self.signal.specials.iter().find(|special| special.name == *name);
                let special = special.ok_or_else(|| self.unwanted(input))?;
                return self.bits(special.raw, signed);
            }
            Input::Integer(value) if self.signal.encoding.is_unscaled() => return self.whole(*value, signed),
            Input::Integer(value) => as_double(*value),
            Input::Number(value) => *value,
            Input::Raw(_) | Input::Status { .. } => return Err(self.unwanted(input)),
        };
        let raw =
            if self.signal.encoding.is_unscaled() { nearest(value) } else { runtime_scale(scale, offset).raw(value) };
        if let Some(raw) = raw.map(i128::from) {
            let special = self.special(raw);
            self.check_sent(value, scaled(raw, scale, offset), special)?;
            if special.is_none() && self.signal.encoding.is_unscaled() {
                self.check_whole(raw)?;
            }
        } else {
            self.check_range(value)?;
        }
        let raw = raw.ok_or_else(|| self.misfit(value))?;
        self.bits(raw.into(), signed).map_err(|_| self.misfit(value))
    }

    /// Encodes an unscaled number.
    fn whole(&self, value: i128, signed: bool) -> Result<u64, String> {
        if self.special(value).is_none() {
            self.check_whole(value)?;
        }
        self.bits(value, signed).map_err(|_| self.misfit(value))
    }

    fn special(&self, raw: i128) -> Option<&NamedValue> {
        self.signal.specials.iter().find(|special| special.raw == raw)
    }

    /// Encodes a raw number, which in a request must lie in the range too.
    fn raw_number(&self, raw: i128, signed: bool) -> Result<u64, String> {
        let Encoding::Number { scale, offset, .. } = self.signal.encoding else { return self.bits(raw, signed) };
        let bits = self.bits(raw, signed)?;
        match self.special(raw) {
            Some(_) => {}
            None if self.signal.encoding.is_unscaled() => self.check_whole(raw)?,
            None => self.check_range(scaled(raw, scale, offset))?,
        }
        Ok(bits)
    }

    fn float(&self, value: f64) -> Result<u64, String> {
        self.check_float(value)?;
        #[allow(clippy::cast_possible_truncation, reason = "rounds to nearest; an overflow is tested")]
        let single = value as f32;
        if value.is_finite() && single.is_infinite() {
            return Err(self.misfit(value));
        }
        Ok(single.to_bits().into())
    }

    fn check_float(&self, value: f64) -> Result<(), String> {
        if self.limits != Limits::Bits && !value.is_finite() {
            return Err(format!("{value} is not a finite number"));
        }
        self.check_range(value)
    }

    fn check_range(&self, value: f64) -> Result<(), String> {
        self.limits_missed(value).map_or(Ok(()), |limits| Err(format!("{value}{} is outside {limits}", self.unit())))
    }

    fn check_whole(&self, value: i128) -> Result<(), String> {
        match self.range() {
            Some(range) if !whole_in_range(&range, value) => {
                Err(format!("{value}{} is outside {}", self.unit(), self.limits_of(range)))
            }
            _ => Ok(()),
        }
    }

    /// Tests a number to send, and what it becomes by rounding: another number, or a special value.
    fn check_sent(&self, value: f64, sent: f64, special: Option<&NamedValue>) -> Result<(), String> {
        let is_exact = sent.partial_cmp(&value) == Some(Ordering::Equal);
        if self.limits == Limits::Bits || is_exact && special.is_some() {
            return Ok(());
        }
        self.check_range(value)?;
        let unit = self.unit();
        match (special, self.limits_missed(sent)) {
            (Some(NamedValue { name, .. }), _) => Err(format!("{value}{unit} would be sent as `{name}`")),
            (None, Some(limits)) => {
                Err(format!("{value}{unit} would be sent as {sent}{unit}, which is outside {limits}"))
            }
            (None, None) => Ok(()),
        }
    }

    /// Returns the limits outside which a number lies.
    fn limits_missed(&self, value: f64) -> Option<String> {
        let range = self.range().filter(|range| !in_range(self.signal, range, value))?;
        Some(self.limits_of(range))
    }

    /// Returns the range to keep to, if there is one.
    fn range(&self) -> Option<Range> {
        match self.limits {
            Limits::Bits => None,
            Limits::Range(None) => self.signal.hull(self.protocol.models_of(self.message)),
            Limits::Range(model) => self.signal.range_for(model),
        }
    }

    fn limits_of(&self, range: Range) -> String {
        format!("{}..{}{}{}", range.minimum, range.maximum, self.unit(), self.advice())
    }

    fn advice(&self) -> &'static str {
        match self.limits {
            Limits::Range(None) if !self.signal.model_ranges.is_empty() => {
                ", the limits of the models taken together; choose a model for its own"
            }
            Limits::Range(_) | Limits::Bits => "",
        }
    }

    fn unit(&self) -> String {
        self.signal.unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol))
    }

    /// Says what the bits can hold.
    fn misfit(&self, value: impl Display) -> String {
        let (unit, width) = (self.unit(), self.signal.place.width());
        self.signal.held().map_or_else(
            || format!("{value}{unit} does not fit a floating-point number of 32 bits"),
            |Range { minimum, maximum }| {
                format!("{value}{unit} does not fit {width} bits, which hold {minimum}..{maximum}{unit}")
            },
        )
    }

    /// Returns a raw number as bits of the signal's width.
    fn bits(&self, raw: i128, signed: bool) -> Result<u64, String> {
        let width = self.signal.place.width();
        let (first, last) = raw_limits(width, signed);
        if !(first..=last).contains(&raw) {
            return Err(format!("raw {raw} does not fit {width} bits, which hold {first}..{last}"));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the mask keeps the bits that fit")]
        let bits = raw as u64;
        Ok(bits & self.signal.place.max())
    }
}

#[allow(clippy::cast_precision_loss, reason = "rounds to nearest")]
fn as_double(value: i128) -> f64 {
    value as f64
}

fn describe(input: &Input) -> String {
    match input {
        Input::Raw(raw) => format!("raw {raw}"),
        Input::Integer(value) => value.to_string(),
        Input::Number(value) => value.to_string(),
        Input::Text(text) => format!("the text `{text}`"),
        Input::Status { .. } => "a set of bits".to_owned(),
    }
}

/// Names what a signal takes.
fn wanted(signal: &Signal) -> String {
    match signal.encoding {
        Encoding::Number { .. } | Encoding::Float => {
            let unit = signal.unit.map_or_else(|| " without a unit".to_owned(), |unit| format!(" in {}", unit.symbol));
            let specials = signal.specials.iter().map(|special| format!(" or `{}`", special.name));
            format!("a number{unit}{}", specials.collect::<String>())
        }
        Encoding::Named(_) => "the name of a value".to_owned(),
        Encoding::Status(_) => "a set of bits".to_owned(),
        Encoding::Text | Encoding::Packed { .. } => "a text".to_owned(),
    }
}
