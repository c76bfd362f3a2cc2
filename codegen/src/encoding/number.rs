//! Integers, scaled or not, with special values.

use canspec_runtime::plumbing::{Scale, nearest};

use super::quantity::{as_double, quantity, typed, wanted};
use super::{Allowed, Input, Room, Value, bits, bits_of_spec};
use crate::model::{Misfit, NamedValue, NoteRule, Numeral, Range, Signal};
use crate::words::number::Rational;

pub struct Number<'a> {
    pub signal: &'a Signal,
    pub numeral: Numeral,
    pub scale: Rational,
    pub offset: Rational,
}

impl Room for Number<'_> {
    fn value(&self, bits: u64) -> Value {
        let raw = self.signal.raw_of(bits);
        match (self.special(raw), self.numeral.integer(raw)) {
            (Some(special), _) => Value::Name(special.name.clone()),
            (None, Some(integer)) if self.is_unscaled() => Value::Integer(integer),
            (None, Some(integer)) => Value::Number(self.physical(integer)),
            (None, None) => Value::None,
        }
    }

    fn raw(&self, input: &Input, allowed: &Allowed) -> Result<u64, String> {
        match input {
            Input::Raw(raw) => self.raw_number(*raw, allowed),
            Input::Integer(value) if self.is_unscaled() => self.whole(*value, allowed),
            Input::Integer(value) => self.number(as_double(*value), allowed),
            Input::Number(value) => self.number(*value, allowed),
            Input::Text(name) => {
                let special = self.signal.specials.iter().find(|special| special.name == *name);
                bits(self.signal, special.ok_or_else(|| input.is_not(&wanted(self.signal)))?.raw)
            }
            Input::Bytes { .. } | Input::Status { .. } => Err(input.is_not(&wanted(self.signal))),
        }
    }

    fn parse(&self, text: &str, unit: bool) -> Result<u64, Misfit> {
        if let Some(special) = self.signal.specials.iter().find(|special| special.name == text) {
            return bits_of_spec(self.signal, special.raw);
        }
        let value = quantity(self.signal, text, unit)?;
        let integer = value.minus(self.offset).and_then(|value| value.over(self.scale)).and_then(Rational::to_integer);
        let (scale, name) = (self.scale, &self.signal.name);
        let integer = integer.ok_or_else(|| format!("`{text}` is no whole number of steps of {scale} for `{name}`"))?;
        let raw = self.numeral.raw(integer).ok_or_else(|| self.misfit(value))?;
        self.check_present(value, raw)?;
        bits_of_spec(self.signal, raw)
    }

    fn typed(&self, text: &str) -> Result<Input, String> {
        typed(self.signal, text)
    }

    fn oddity(&self, bits: u64, value: &Value) -> Option<(NoteRule, String)> {
        let text = || format!("{} {bits:#X} is no number", self.signal.name);
        (*value == Value::None).then(|| (NoteRule::UnknownValue, text()))
    }
}

impl Number<'_> {
    fn is_unscaled(&self) -> bool {
        self.scale == Rational::ONE && self.offset == Rational::ZERO
    }

    fn special(&self, raw: i128) -> Option<&NamedValue> {
        self.signal.specials.iter().find(|special| special.raw == raw)
    }

    fn physical(&self, integer: i128) -> f64 {
        i64::try_from(integer).map_or(f64::NAN, |integer| self.runtime_scale().physical(integer))
    }

    /// Returns the scale as the runtime computes with it. The checks ensure that its numbers fit.
    fn runtime_scale(&self) -> Scale {
        let part = |number: i128| i64::try_from(number).unwrap_or(1);
        let scale = Scale::new(part(self.scale.numerator()), part(self.scale.denominator()));
        if self.offset == Rational::ZERO {
            return scale;
        }
        scale.offset(part(self.offset.numerator()), part(self.offset.denominator()))
    }

    fn number(&self, value: f64, allowed: &Allowed) -> Result<u64, String> {
        let integer = if self.is_unscaled() { nearest(value) } else { self.runtime_scale().raw(value) };
        let integer = integer.map(i128::from);
        let Some((integer, raw)) = integer.and_then(|integer| Some((integer, self.numeral.raw(integer)?))) else {
            allowed.check(self.signal, value)?;
            return Err(self.misfit(value));
        };
        if let Err(why) = self.check_present(value, raw) {
            allowed.check(self.signal, value)?;
            return Err(why);
        }
        let special = self.special(raw).map(|special| special.name.as_str());
        allowed.check_sent(self.signal, value, (raw, self.physical(integer)), special)?;
        if special.is_none() && self.is_unscaled() {
            allowed.check_whole(self.signal, integer)?;
        }
        bits(self.signal, raw).map_err(|_| self.misfit(value))
    }

    /// Encodes an unscaled number.
    fn whole(&self, value: i128, allowed: &Allowed) -> Result<u64, String> {
        let raw = self.numeral.raw(value);
        if raw.is_none_or(|raw| self.special(raw).is_none()) {
            allowed.check_whole(self.signal, value)?;
        }
        if let Some(Err(why)) = raw.map(|raw| self.check_present(value, raw)) {
            allowed.check_whole(self.signal, value)?;
            return Err(why);
        }
        raw.and_then(|raw| self.signal.bits_of(raw)).ok_or_else(|| self.misfit(value))
    }

    /// Encodes a raw number. In a request it must lie within the range.
    fn raw_number(&self, raw: i128, allowed: &Allowed) -> Result<u64, String> {
        let bits = bits(self.signal, raw)?;
        match (self.special(raw), self.numeral.integer(raw)) {
            (Some(_), _) => {}
            (None, Some(integer)) if self.is_unscaled() => allowed.check_whole(self.signal, integer)?,
            (None, Some(integer)) => allowed.check_raw(self.signal, raw, self.physical(integer))?,
            (None, None) => allowed.check_meaning(raw)?,
        }
        Ok(bits)
    }

    /// Refuses a number whose raw value says that there is none.
    fn check_present(&self, value: impl std::fmt::Display, raw: i128) -> Result<(), String> {
        let absent = self.signal.absent().filter(|absent| absent.raw == raw);
        absent.map_or(Ok(()), |absent| {
            Err(format!("{value}{} would be sent as `{}`", self.signal.unit_text(), absent.name))
        })
    }

    /// Says that a value does not fit, and what the bits can hold.
    fn misfit(&self, value: impl std::fmt::Display) -> String {
        let (unit, width) = (self.signal.unit_text(), self.signal.place.width());
        let held =
            self.signal.held().map(|Range { minimum, maximum }| format!(", which hold {minimum}..{maximum}{unit}"));
        format!("{value}{unit} does not fit {width} bits{}", held.unwrap_or_default())
    }
}
