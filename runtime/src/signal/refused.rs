//! Why a signal refuses values.

use super::Signal;
use crate::error::{Fault, Refusable, Value};
use crate::physical::Physical;
use crate::plumbing::Scale;
use crate::raw::Raw;
use crate::{Error, Number, Payload, ValueError};

impl<R: Raw, F: Physical<R>> Signal<R, F> {
    /// Refuses a value. A program does no more than to note it, so this calls nothing.
    #[inline]
    pub(crate) fn refused(&'static self, fault: Fault, payload: &Payload) -> Error {
        Error::Value(ValueError::new(payload.message(), self, fault, payload.model()))
    }

    /// Says that a device model has no scale for the signal. Generated code calls it.
    #[doc(hidden)]
    #[must_use]
    pub fn without_scale(&'static self, message: &'static str) -> Error {
        Error::Value(ValueError::new(message, self, Fault::Meaning, None))
    }

    /// Returns the least and the greatest value that the bits hold.
    fn held(&self) -> (F, F) {
        let [one, other] = R::ends(self.place.max()).map(|bits| self.physical(R::from_bits(bits)));
        let is_falling = !F::IS_RAW && self.scale.is_some_and(Scale::is_falling);
        if is_falling { (other, one) } else { (one, other) }
    }
}

impl<R: Raw, F: Physical<R>> Refusable for Signal<R, F> {
    fn own_name(&self) -> &'static str {
        self.name
    }

    fn own_unit(&self) -> Option<&'static str> {
        self.unit
    }

    fn told(&self, value: Value) -> Number {
        match value {
            Value::Raw(bits) => self.number(self.physical(R::from_bits(bits))),
            Value::Number(number) => number,
        }
    }

    fn limits(&self, model: Option<u8>, only_bits: bool) -> (Number, Number) {
        let legal = if only_bits { None } else { self.limits_in(model) };
        self.numbers(legal.unwrap_or_else(|| self.held()))
    }

    fn special_name(&self, index: u32) -> &'static str {
        let special = usize::try_from(index).ok().and_then(|index| self.specials.get(index));
        special.map_or("", |(_, name)| *name)
    }
}
