//! IEEE 754 numbers in single precision.

use super::quantity::{as_double, quantity, typed, wanted};
use super::{Allowed, Input, Room, Value, bits};
use crate::model::{Misfit, NoteRule, Signal};

pub struct Float<'a> {
    pub signal: &'a Signal,
}

impl Room for Float<'_> {
    fn value(&self, bits: u64) -> Value {
        let value = float(bits);
        if value.is_finite() { Value::Number(value.into()) } else { Value::None }
    }

    fn raw(&self, input: &Input, allowed: &Allowed) -> Result<u64, String> {
        match input {
            Input::Raw(raw) => {
                let bits = bits(self.signal, *raw)?;
                allowed.check_float(self.signal, float(bits).into()).map(|()| bits)
            }
            Input::Number(value) => self.number(*value, allowed),
            Input::Integer(value) => self.number(as_double(*value), allowed),
            Input::Text(_) | Input::Bytes { .. } | Input::Status { .. } => Err(input.is_not(&wanted(self.signal))),
        }
    }

    fn parse(&self, text: &str, unit: bool) -> Result<u64, Misfit> {
        let value = quantity(self.signal, text, unit)?;
        let single: Option<f32> = value.to_string().parse().ok();
        let single = single.unwrap_or({
            #[allow(clippy::cast_possible_truncation, reason = "rounds to nearest")]
            let single = value.to_f64() as f32;
            single
        });
        Ok(u64::from(single.to_bits()))
    }

    fn typed(&self, text: &str) -> Result<Input, String> {
        typed(self.signal, text)
    }

    fn oddity(&self, bits: u64, value: &Value) -> Option<(NoteRule, String)> {
        let text = || format!("{} is {}", self.signal.name, float(bits));
        (*value == Value::None).then(|| (NoteRule::NotFinite, text()))
    }
}

impl Float<'_> {
    fn number(&self, value: f64, allowed: &Allowed) -> Result<u64, String> {
        allowed.check_float(self.signal, value)?;
        #[allow(clippy::cast_possible_truncation, reason = "rounds to nearest; an overflow is tested")]
        let single = value as f32;
        if value.is_finite() && single.is_infinite() {
            let unit = self.signal.unit_text();
            return Err(format!("{value}{unit} does not fit a floating-point number of 32 bits"));
        }
        Ok(single.to_bits().into())
    }
}

fn float(bits: u64) -> f32 {
    f32::from_bits(u32::try_from(bits & u64::from(u32::MAX)).unwrap_or(0))
}
