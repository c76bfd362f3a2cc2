//! Why a signal refuses values.

use super::Signal;
use crate::error::{Fault, Refusable, Value};
use crate::physical::Physical;
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
            Value::Raw(bits) => self.physical(R::from_bits(bits)).number(self.scale),
            Value::Number(number) => number,
        }
    }

    fn legal(&self, model: Option<u8>) -> Option<(Number, Number)> {
        self.limits_in(model).map(|limits| self.numbers(limits))
    }

    fn held(&self) -> (Number, Number) {
        let [one, other] = R::ends(self.place.max()).map(|bits| self.told(Value::Raw(bits)));
        self.rising((one, other))
    }

    fn special_name(&self, index: u32) -> &'static str {
        let special = usize::try_from(index).ok().and_then(|index| self.specials.get(index));
        special.map_or("", |(_, name)| *name)
    }
}
