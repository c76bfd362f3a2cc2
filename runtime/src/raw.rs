//! The Rust types of raw values.

use core::fmt::{self, Write};

use crate::text::Escaped;
use crate::{Number, PackedText, StatusBit, bytes, status};

/// The type of a signal's raw value: an integer, `f32`, named values, a status word, a text, raw bytes or a packed value.
pub trait Raw: Copy + Sync + 'static {
    /// Whether the bits are a number in two's complement.
    const SIGNED: bool = false;

    /// Whether the bits are decimal digits of four bits each.
    const IS_DECIMAL: bool = false;

    /// Whether a raw value can be given as a number in the signal's unit.
    const IS_NUMBER: bool = false;

    /// Takes the low bits of a word, sign-extended if the type is signed.
    fn from_bits(bits: u64) -> Self;

    /// Returns the bits of the word, sign-extended if the type is signed.
    fn to_bits(self) -> u64;

    /// Returns what the value means.
    fn meaning(&self) -> Meaning<'_>;

    /// Returns the value with this meaning, if there is one.
    fn from_meaning(meaning: Meaning<'_>) -> Option<Self>;

    /// Tests whether the bits give the same value. The parts of a packed value can be too large for
    /// their places.
    #[inline(always)]
    fn is_whole(self) -> bool {
        true
    }

    /// Returns the bits of an integer, or `None` if it has none. They can be more than the place
    /// holds.
    #[inline(always)]
    fn bits_of(integer: i64) -> Option<u64> {
        (Self::SIGNED || integer >= 0).then_some(integer as u64)
    }

    /// Returns the bits of the least and the greatest number at a place. `all` has all bits of the
    /// place.
    fn ends(all: u64) -> [u64; 2] {
        let highest = all.wrapping_shr(Self::SIGNED.into());
        [if Self::SIGNED { !highest } else { 0 }, highest]
    }

    /// Returns the number that limits apply to: the integer, or the float.
    #[inline(always)]
    fn number(self) -> Number {
        if Self::SIGNED { Number::Signed(self.to_bits() as i64) } else { Number::Unsigned(self.to_bits()) }
    }

    /// Tests whether this is a finite number.
    #[inline(always)]
    fn is_finite(self) -> bool {
        true
    }

    /// Tests whether this is a finite number inside limits, both legal.
    #[inline(always)]
    fn is_within(self, minimum: Self, maximum: Self) -> bool {
        let [value, minimum, maximum] = [self, minimum, maximum].map(Self::to_bits);
        if Self::SIGNED {
            (minimum as i64..=maximum as i64).contains(&(value as i64))
        } else {
            (minimum..=maximum).contains(&value)
        }
    }

    /// Returns a limit as precisely as this type can meet it.
    #[inline(always)]
    fn limit(exact: f64) -> f64 {
        exact
    }
}

/// A raw value that physical values are scaled from.
pub trait Integer: Raw + PartialEq {}

/// The meaning of a value, for code that does not know its type.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Meaning<'a> {
    /// A number in the signal's unit.
    Number(Number),
    /// The name of a named value.
    Name(&'a str),
    /// A text.
    Text(&'a str),
    /// Raw bytes.
    Bytes(&'a [u8]),
    /// The text of a packed value.
    Packed(PackedText),
    /// The bits of a status word, and all its named bits, set or not.
    Status(u64, &'static [StatusBit]),
    /// No meaning: a value without a name, a number that is not finite, or a text that would not
    /// give these bits.
    None,
}

impl fmt::Display for Meaning<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(formatter),
            Self::Name(text) | Self::Text(text) => Escaped(formatter).write_str(text),
            Self::Bytes(bytes) => bytes::write(bytes, formatter),
            Self::Packed(text) => write!(Escaped(formatter), "{text}"),
            Self::Status(bits, known) => write_status(*bits, known, formatter),
            Self::None => formatter.write_str("?"),
        }
    }
}

/// Writes the names of the set bits. Those without a name become one number.
fn write_status(bits: u64, known: &'static [StatusBit], formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
    let mut names = formatter.debug_set();
    for bit in status::set_bits(bits, known) {
        names.entry(&format_args!("{}", bit.name));
    }
    match status::unknown(bits, known) {
        0 => names.finish(),
        unknown => names.entry(&format_args!("{unknown:#X}")).finish(),
    }
}

macro_rules! unsigned {
    ($($type:ty)*) => {$(
        impl Integer for $type {}

        impl Raw for $type {
            const IS_NUMBER: bool = true;

            #[inline(always)]
            #[expect(clippy::allow_attributes, reason = "not every width truncates")]
            #[allow(clippy::cast_possible_truncation, reason = "the place is as wide as the type at most")]
            fn from_bits(bits: u64) -> Self {
                bits as Self
            }

            #[inline(always)]
            fn to_bits(self) -> u64 {
                self.into()
            }

            #[inline(always)]
            fn is_within(self, minimum: Self, maximum: Self) -> bool {
                (minimum..=maximum).contains(&self)
            }

            fn meaning(&self) -> Meaning<'_> {
                Meaning::Number(self.number())
            }

            fn from_meaning(meaning: Meaning<'_>) -> Option<Self> {
                whole(meaning)?.try_into().ok()
            }
        }
    )*};
}

macro_rules! signed {
    ($($type:ty)*) => {$(
        impl Integer for $type {}

        impl Raw for $type {
            const SIGNED: bool = true;
            const IS_NUMBER: bool = true;

            #[inline(always)]
            #[expect(clippy::allow_attributes, reason = "not every width truncates")]
            #[allow(clippy::cast_possible_truncation, reason = "the place is as wide as the type at most")]
            fn from_bits(bits: u64) -> Self {
                bits as Self
            }

            #[inline(always)]
            fn to_bits(self) -> u64 {
                i64::from(self) as u64
            }

            #[inline(always)]
            fn is_within(self, minimum: Self, maximum: Self) -> bool {
                (minimum..=maximum).contains(&self)
            }

            fn meaning(&self) -> Meaning<'_> {
                Meaning::Number(self.number())
            }

            fn from_meaning(meaning: Meaning<'_>) -> Option<Self> {
                whole(meaning)?.try_into().ok()
            }
        }
    )*};
}

unsigned!(u8 u16 u32 u64);
signed!(i8 i16 i32 i64);

/// Returns an integer.
fn whole(meaning: Meaning<'_>) -> Option<i128> {
    match meaning {
        Meaning::Number(Number::Unsigned(number)) => Some(number.into()),
        Meaning::Number(Number::Signed(number)) => Some(number.into()),
        Meaning::Number(_)
        | Meaning::Name(_)
        | Meaning::Text(_)
        | Meaning::Bytes(_)
        | Meaning::Packed(_)
        | Meaning::Status(..)
        | Meaning::None => None,
    }
}

impl Raw for f32 {
    const IS_NUMBER: bool = true;

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a float has 32 bits")]
    fn from_bits(bits: u64) -> Self {
        Self::from_bits(bits as u32)
    }

    #[inline(always)]
    fn to_bits(self) -> u64 {
        f32::to_bits(self).into()
    }

    fn meaning(&self) -> Meaning<'_> {
        if self.is_finite() { Meaning::Number(Number::Float((*self).into())) } else { Meaning::None }
    }

    #[expect(clippy::cast_possible_truncation, reason = "the nearest float is what is sent")]
    fn from_meaning(meaning: Meaning<'_>) -> Option<Self> {
        let Meaning::Number(number) = meaning else { return None };
        let nearest = number.to_f64() as Self;
        (nearest.is_finite() || !number.to_f64().is_finite()).then_some(nearest)
    }

    #[inline(always)]
    fn number(self) -> Number {
        Number::Single(self)
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.is_finite()
    }

    #[inline(always)]
    fn is_within(self, minimum: Self, maximum: Self) -> bool {
        (minimum..=maximum).contains(&self)
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "the nearest float is what can be met")]
    fn limit(exact: f64) -> f64 {
        (exact as Self).into()
    }
}
