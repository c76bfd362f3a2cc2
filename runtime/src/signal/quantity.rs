//! Numbers as thousandths of their unit.

use super::{AnySignal, Signal};
use crate::error::{Fault, Value};
use crate::physical::Physical;
use crate::quantity::single;
use crate::raw::Raw;
use crate::{Data, Error, Meaning, Number, Payload};

/// The parts of a unit that are counted.
const PARTS: u16 = 1000;

/// A signal that is a number, for code that reads a quantity without knowing its type.
pub trait ReadNumber: AnySignal {
    /// Returns thousandths of the unit, or the number itself if there is none. It is the nearest integer, with ties
    /// away from zero. It is `None` if the bits mean something else, or an `i32` cannot hold it.
    fn read_number(&self, data: &Data) -> Option<i32>;
}

/// A signal that is a number, for code that sets a quantity without knowing its type.
pub trait SetNumber {
    /// Returns what a frame with `length` data bytes sets: thousandths of the unit, or the number itself if there is
    /// none. It is `None` if the frame does not have the signal, and where [`ReadNumber::read_number`] is.
    fn set_in(&self, data: &Data, length: usize) -> Option<i32>;

    /// Writes thousandths of the unit, or the number itself if there is none.
    ///
    /// # Errors
    ///
    /// Refuses values outside the limits, or between the last step and the limit. It also refuses values that would be
    /// sent as bits that mean something else.
    fn set_number(&'static self, value: i32, payload: &mut Payload) -> Result<(), Error>;
}

impl<R: Raw, F: Physical<R>> ReadNumber for Signal<R, F> {
    fn read_number(&self, data: &Data) -> Option<i32> {
        let raw = self.get_some(data, data.len())?;
        if self.special(raw.to_bits()).is_some() {
            return None;
        }
        let parts = self.parts();
        let integer = match raw.number() {
            Number::Single(value) => return single::parts_of(value, parts),
            Number::Unsigned(integer) => i64::try_from(integer).ok()?,
            Number::Signed(integer) => integer,
            Number::Float(_) | Number::Fraction { .. } => return None,
        };
        i32::try_from(self.exact_scale().parts_of(integer, parts.into())?).ok()
    }
}

impl<R: Raw, F: Physical<R>> SetNumber for Signal<R, F> {
    fn set_in(&self, data: &Data, length: usize) -> Option<i32> {
        if self.place().is_within(length) { self.read_number(data) } else { None }
    }

    fn set_number(&'static self, value: i32, payload: &mut Payload) -> Result<(), Error> {
        let parts = self.parts();
        let asked = asked(value, parts);
        if matches!(R::from_bits(0).number(), Number::Single(_)) {
            let single = single::of_parts(value, parts);
            return self.set_raw(R::from_bits(single.to_bits().into()), asked, payload);
        }
        let Some([below, nearest, above]) = self.exact_scale().raws_around(value.into(), parts.into()) else {
            return Err(self.refused(Fault::Width(Value::Number(asked)), payload));
        };
        // What lies between two steps must lie between two legal ones, whichever type the limits have.
        for step in [below, above] {
            self.set_step(step, asked, &mut payload.clone())?;
        }
        self.set_step(nearest, asked, payload)
    }
}

impl<R: Raw, F: Physical<R>> Signal<R, F> {
    fn set_step(&'static self, step: i64, asked: Number, payload: &mut Payload) -> Result<(), Error> {
        match R::from_meaning(Meaning::Number(Number::Signed(step))) {
            Some(raw) => self.set_raw(raw, asked, payload),
            None => Err(self.refused(Fault::Width(Value::Number(asked)), payload)),
        }
    }

    /// Writes a raw number. An error names the one that was asked for.
    fn set_raw(&'static self, raw: R, asked: Number, payload: &mut Payload) -> Result<(), Error> {
        if let Some(index) = self.special(raw.to_bits()) {
            return Err(self.refused(Fault::Special(Value::Number(asked), Some(index)), payload));
        }
        self.put_some(Some(raw), payload).map_err(|error| error.of_asked(asked))
    }

    /// Returns how many parts of a unit are counted.
    const fn parts(&self) -> u16 {
        if self.unit.is_some() { PARTS } else { 1 }
    }
}

/// Returns the number that parts are.
fn asked(value: i32, parts: u16) -> Number {
    Number::Fraction { numerator: value.into(), denominator: parts.into() }
}
