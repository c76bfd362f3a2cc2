//! Why a value is refused.

use core::fmt;

use crate::Number;

/// A value that a signal of a message does not take.
///
/// It has what was refused, and by which signal. What the document says of it is worked out once
/// somebody asks, so a refusal costs a program little.
#[derive(Clone, Copy)]
pub struct ValueError {
    message: &'static str,
    signal: &'static dyn Refusable,
    fault: Fault,
    model: Option<u8>,
}

/// Why a value is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Reason {
    /// The value lies outside the documented range, or does not fit the signal's bits. Both the
    /// given and the rounded value count.
    Limits {
        /// The refused value.
        value: Number,
        /// Unit of value and limits.
        unit: Option<&'static str>,
        /// The smallest legal value.
        minimum: Number,
        /// The largest legal value.
        maximum: Number,
    },
    /// The value would be rounded to a raw value that means something else.
    Special {
        /// The refused value.
        value: Number,
        /// Unit of the value.
        unit: Option<&'static str>,
        /// Name of what would be sent.
        name: &'static str,
    },
    /// The value is infinite or not a number.
    NotFinite,
    /// The signal has no value of this kind or name.
    Meaning,
    /// An optional signal has no value, but the frame is long enough for it. A value behind it is
    /// given, or the chosen device model is one of the few that have the signal.
    Missing,
    /// A frame to a module would carry another part of a long message than before: its number, or
    /// its data. Only the whole message makes such frames, since its limits hold for all parts
    /// together.
    Part,
}

/// A refused value.
#[derive(Clone, Copy, PartialEq)]
pub enum Value {
    /// The bits of a raw value.
    Raw(u64),
    /// A number in the unit of the signal.
    Number(Number),
}

/// What is wrong with a value, as far as it is known without the document.
#[derive(Clone, Copy)]
pub(crate) enum Fault {
    /// It lies outside the limits, or is not finite.
    Limits(Value),
    /// The bits cannot hold it.
    Width(Value),
    /// It would be sent as a special raw value, by its number, or as the bits that say that there is no value.
    Special(Value, Option<u32>),
    /// See [`Reason::Meaning`].
    Meaning,
    /// See [`Reason::Missing`].
    Missing,
    /// See [`Reason::Part`].
    Part,
}

/// A signal that refuses values.
pub(crate) trait Refusable: Sync {
    /// Returns the name.
    fn own_name(&self) -> &'static str;

    /// Returns the unit.
    fn own_unit(&self) -> Option<&'static str>;

    /// Returns a refused value in the unit.
    fn told(&self, value: Value) -> Number;

    /// Returns the least and the greatest number that a device model takes. They are those that the bits hold if the
    /// document does not limit them, or if only the bits count.
    fn limits(&self, model: Option<u8>, only_bits: bool) -> (Number, Number);

    /// Returns the name of a special raw value.
    fn special_name(&self, index: u32) -> &'static str;
}

impl ValueError {
    #[inline(always)]
    pub(crate) fn new(message: &'static str, signal: &'static dyn Refusable, fault: Fault, model: Option<u8>) -> Self {
        Self { message, signal, fault, model }
    }

    /// Says that a number was asked for, where limits or the width of the bits refuse its raw value.
    pub(crate) fn asked(self, number: Number) -> Self {
        let fault = match self.fault {
            Fault::Limits(_) => Fault::Limits(Value::Number(number)),
            Fault::Width(_) => Fault::Width(Value::Number(number)),
            other @ (Fault::Special(..) | Fault::Meaning | Fault::Missing | Fault::Part) => other,
        };
        Self { fault, ..self }
    }

    /// Returns the name of the message.
    #[must_use]
    pub const fn message(&self) -> &'static str {
        self.message
    }

    /// Returns the name of the signal.
    #[must_use]
    pub fn signal(&self) -> &'static str {
        self.signal.own_name()
    }

    /// Returns why the value is refused.
    #[must_use]
    pub fn reason(&self) -> Reason {
        let Self { signal, model, .. } = *self;
        let unit = signal.own_unit();
        match self.fault {
            Fault::Limits(value) | Fault::Width(value) => {
                let (value, only_bits) = (signal.told(value), matches!(self.fault, Fault::Width(_)));
                let is_number = if only_bits { !value.is_nan() } else { value.is_finite() };
                if !is_number {
                    return Reason::NotFinite;
                }
                let (minimum, maximum) = signal.limits(model, only_bits);
                Reason::Limits { value, unit, minimum, maximum }
            }
            Fault::Special(value, index) => {
                let name = index.map_or("not_available", |index| signal.special_name(index));
                Reason::Special { value: signal.told(value), unit, name }
            }
            Fault::Meaning => Reason::Meaning,
            Fault::Missing => Reason::Missing,
            Fault::Part => Reason::Part,
        }
    }
}

impl fmt::Display for ValueError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "`{}` of `{}` ", self.signal(), self.message)?;
        let with_space = |unit: Option<&'static str>| unit.map_or(("", ""), |unit| (" ", unit));
        match self.reason() {
            Reason::Limits { value, unit, minimum, maximum } => {
                let (space, unit) = with_space(unit);
                write!(formatter, "is {value}{space}{unit}, but its limits are {minimum} and {maximum}{space}{unit}")
            }
            Reason::Special { value, unit, name } => {
                let (space, unit) = with_space(unit);
                write!(formatter, "is {value}{space}{unit}, which would be sent as `{name}`")
            }
            Reason::NotFinite => formatter.write_str("is no finite number"),
            Reason::Meaning => formatter.write_str("has no such value"),
            Reason::Missing => formatter.write_str("is left out, but the frame is long enough for it"),
            Reason::Part => formatter.write_str("is that of another part, which only the whole message makes"),
        }
    }
}

impl fmt::Debug for ValueError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fields = formatter.debug_struct("ValueError");
        fields.field("message", &self.message).field("signal", &self.signal()).field("reason", &self.reason());
        fields.finish_non_exhaustive()
    }
}

impl PartialEq for ValueError {
    fn eq(&self, other: &Self) -> bool {
        let said = |error: &Self| (error.message, error.signal(), error.reason());
        said(self) == said(other)
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for ValueError {
    fn format(&self, formatter: defmt::Formatter<'_>) {
        defmt::write!(formatter, "{=str} of {=str}: {}", self.signal(), self.message, self.reason());
    }
}

#[cfg(test)]
mod tests {
    use core::mem::size_of;

    use crate::{Error, Payload, Place, Reason, Signal};

    #[test]
    fn an_error_is_no_larger_than_what_it_refers_to_needs() {
        assert!(size_of::<Error>() <= 72, "{}", size_of::<Error>());
    }

    #[test]
    fn an_error_can_be_handed_to_another_thread() {
        fn is_handed_over<T: Send + Sync>(_: T) {}
        is_handed_over(Error::Model { message: "set" });
    }

    #[test]
    fn errors_are_equal_if_they_say_the_same() {
        const ONE: Signal<u8> = Signal::new("level", Place::byte(0)).limits(1, 5);
        const SAME: Signal<u8> = Signal::new("level", Place::byte(1)).limits(1, 5);
        const OTHER: Signal<u8> = Signal::new("level", Place::byte(0)).limits(1, 6);
        let refused = |signal: &'static Signal<u8>, value, message| {
            signal.put(value, &mut Payload::within_limits(message, [0; 8])).expect_err("a value outside the limits")
        };
        let error = refused(&ONE, 7, "set");
        assert_eq!(error, refused(&SAME, 7, "set"));
        assert!(matches!(error.reason(), Some(Reason::Limits { unit: None, .. })));
        for other in [refused(&ONE, 8, "set"), refused(&ONE, 7, "get"), refused(&OTHER, 7, "set")] {
            assert_ne!(error, other);
        }
    }
}
