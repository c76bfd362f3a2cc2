//! Access to signals for code that does not know their types.

use core::cmp::Ordering;
use core::fmt;

use crate::error::{Fault, Refusable, Value};
use crate::physical::Physical;
use crate::raw::Raw;
use crate::{Data, Error, Meaning, Number, Payload, Place, Signal};

/// What a signal says in one frame, for code that does not know the message.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Reading<'a> {
    /// Name of the signal.
    pub name: &'static str,
    /// Unit of the physical value.
    pub unit: Option<&'static str>,
    /// The integer in the frame. For a float it is the bit pattern, and for a text the bytes.
    pub raw: Number,
    /// What it means.
    pub meaning: Meaning<'a>,
    /// Whether the frame is an error reply. Its values mean nothing unless the document says so.
    pub is_of_error_reply: bool,
}

impl fmt::Display for Reading<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_of_error_reply {
            return write!(formatter, "{} ? (error reply)", self.name);
        }
        write!(formatter, "{} {}", self.name, self.meaning)?;
        match (self.meaning, self.unit) {
            (Meaning::Number(_), Some(unit)) => write!(formatter, " {unit}"),
            _ => Ok(()),
        }
    }
}

/// A signal, for code that reads it without knowing its type.
///
/// It cannot write, so a program that only reads does not contain the code to write.
pub trait AnySignal {
    /// Returns the name.
    fn name(&self) -> &'static str;

    /// Returns the unit of the physical value.
    fn unit(&self) -> Option<&'static str>;

    /// Returns the place in the data.
    fn place(&self) -> Place;

    /// Returns the documented limits of the physical value, both legal. They hold if no device
    /// model is chosen.
    fn limits(&self) -> Option<(Number, Number)>;

    /// Tests whether a device model does not have the signal, and no bit of the data shows it.
    fn is_hidden(&self, data: &Data, model: Option<u8>) -> bool;

    /// Shows the signal's value in a frame to `visitor`.
    fn read(&self, data: &Data, visitor: &mut dyn FnMut(Reading<'_>));
}

impl<R: Raw, F: Physical<R>> AnySignal for Signal<R, F> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn unit(&self) -> Option<&'static str> {
        self.unit
    }

    fn place(&self) -> Place {
        self.place
    }

    fn limits(&self) -> Option<(Number, Number)> {
        self.limits.map(|limits| self.numbers(limits))
    }

    fn is_hidden(&self, data: &Data, model: Option<u8>) -> bool {
        self.blank(model).is_some_and(|blank| self.place.get(data) == blank)
    }

    fn read(&self, data: &Data, visitor: &mut dyn FnMut(Reading<'_>)) {
        let bits = self.place.any_bits(*data, R::SIGNED);
        let value = R::from_bits(bits);
        let meaning = match (self.special(bits), self.scale) {
            (Some(index), _) => Meaning::Name(self.special_name(index)),
            (None, _) if self.is_by_model => Meaning::None,
            (None, Some(_)) if R::IS_NUMBER && value.is_finite() => Meaning::Number(self.number(self.physical(value))),
            (None, _) => value.meaning(),
        };
        let raw = if R::SIGNED { Number::Signed(bits as i64) } else { Number::Unsigned(bits) };
        visitor(Reading { name: self.name, unit: self.unit, raw, meaning, is_of_error_reply: false });
    }
}

/// A signal, for code that writes it without knowing its type.
pub trait WriteSignal: AnySignal {
    /// Writes the value with this meaning.
    ///
    /// # Errors
    ///
    /// Refuses unknown names, and values that the signal's bits cannot hold. If `payload` keeps to
    /// limits, it also refuses values outside them.
    fn write(&'static self, meaning: Meaning<'_>, payload: &mut Payload) -> Result<(), Error>;
}

impl<R: Raw, F: Physical<R>> WriteSignal for Signal<R, F> {
    fn write(&'static self, meaning: Meaning<'_>, payload: &mut Payload) -> Result<(), Error> {
        if R::IS_NUMBER && !self.is_by_model {
            if let Meaning::Number(number) = meaning {
                let before = *payload.data();
                F::write(self, number, payload)?;
                return self.confirm(payload, before, Value::Number(number));
            }
        }
        let raw = self.special_value(meaning).or_else(|| self.plain_value(meaning));
        raw.ok_or_else(|| self.refused(Fault::Meaning, payload)).and_then(|raw| self.put(raw, payload))
    }
}

impl<R: Raw, F: Physical<R>> Signal<R, F> {
    /// Returns the special raw value of a name.
    fn special_value(&self, meaning: Meaning<'_>) -> Option<R> {
        let Meaning::Name(wanted) = meaning else { return None };
        let special = self.specials.iter().find(|(_, name)| *name == wanted);
        special.map(|(raw, _)| R::from_bits(*raw as u64))
    }

    /// Returns the raw value of a meaning that depends on no device model.
    fn plain_value(&self, meaning: Meaning<'_>) -> Option<R> {
        if self.is_by_model { None } else { R::from_meaning(meaning) }
    }

    /// Writes a number as its own raw value, or as the nearest one.
    pub(crate) fn write_raw(&'static self, number: Number, payload: &mut Payload) -> Result<(), Error> {
        let raw_of = |number| R::from_meaning(Meaning::Number(number));
        if let Some(raw) = raw_of(number).filter(|_| !self.is_scaled()) {
            return self.put(raw, payload);
        }
        let value = number.to_f64();
        match self.exact_scale().raw(value).and_then(|whole| raw_of(Number::Signed(whole))) {
            Some(raw) => {
                self.check_fraction(value, raw, payload)?;
                self.put(raw, payload)
            }
            None => Err(self.refused(Fault::Width(Value::Number(number)), payload)),
        }
    }

    /// Tests a number with a fraction that is rounded to `raw`.
    fn check_fraction(&'static self, value: f64, raw: R, payload: &Payload) -> Result<(), Error> {
        let sent = self.number(self.physical(raw)).to_f64();
        let is_exact = sent.partial_cmp(&value) == Some(Ordering::Equal);
        if is_exact || !payload.keeps_limits() || !self.check_model(raw.to_bits(), payload)? {
            return Ok(());
        }
        let (refused, told) = (|fault| Err(self.refused(fault, payload)), Value::Number(Number::Float(value)));
        let limits = self.limits_in(payload.model()).map(|limits| self.numbers(limits));
        match (limits, self.special(raw.to_bits())) {
            (Some((minimum, maximum)), _) if !(minimum.to_f64()..=maximum.to_f64()).contains(&value) => {
                refused(Fault::Limits(told))
            }
            (_, Some(index)) => refused(Fault::Special(told, Some(index))),
            _ => Ok(()),
        }
    }
}
