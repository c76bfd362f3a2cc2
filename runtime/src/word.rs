//! Named values, status words and packed values: integers with a legend.

use core::fmt;

use crate::packed;
use crate::plumbing::{Integer, Piece, Raw};
use crate::{Meaning, PackedText, StatusBit, status};

/// An integer with a legend: named values, a status word or a packed value.
///
/// The generated types offer all this as methods of their own.
pub trait Word: Copy + Sync + PartialEq + 'static {
    /// The integer in the frame.
    type Raw: Integer;
    /// What the integer stands for.
    const LEGEND: Legend<Self::Raw>;
    /// Returns the value of an integer, even if the legend does not have it.
    const FROM_RAW: fn(Self::Raw) -> Self;
    /// Returns the integer in the frame.
    const RAW: fn(Self) -> Self::Raw;

    /// Returns the name of a named value, unless it has none.
    fn name(self) -> Option<&'static str> {
        Self::LEGEND.name(Self::RAW(self))
    }

    /// Finds a named value by its name.
    fn named(name: &str) -> Option<Self> {
        Self::LEGEND.named(name).map(Self::FROM_RAW)
    }

    /// Returns the set bits of a status word that have a name, the lowest first.
    fn set_bits(self) -> impl Iterator<Item = &'static StatusBit> {
        status::set_bits(self.to_bits(), Self::LEGEND.bits())
    }

    /// Returns the set bits of a status word that have no name.
    fn unknown(self) -> u64 {
        status::unknown(self.to_bits(), Self::LEGEND.bits())
    }

    /// Returns the text of a packed value, or `None` if that text would not give the same value.
    fn text(self) -> Option<PackedText> {
        packed::text(self)
    }

    /// Reads a packed value from a text of the documented form.
    fn parse(text: &str) -> Option<Self> {
        packed::parse(text)
    }

    /// Writes the parts of a packed value in the documented form, even if the text is not exact.
    ///
    /// # Errors
    ///
    /// Passes on errors of the formatter.
    fn write(self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        packed::write(self, formatter)
    }
}

/// What an integer stands for.
#[derive(Clone, Copy, Debug)]
pub enum Legend<R: 'static> {
    /// Every number that has a name.
    Names(&'static [(R, &'static str)]),
    /// Every bit that has a name, the lowest first.
    Bits(&'static [StatusBit]),
    /// The number of bytes, and the pieces of their text.
    Text(u8, &'static [Piece]),
}

impl<R: Integer> Legend<R> {
    fn name(self, raw: R) -> Option<&'static str> {
        self.names().iter().find(|(other, _)| *other == raw).map(|(_, name)| *name)
    }

    fn named(self, name: &str) -> Option<R> {
        self.names().iter().find(|(_, other)| *other == name).map(|(raw, _)| *raw)
    }

    const fn names(self) -> &'static [(R, &'static str)] {
        match self {
            Self::Names(names) => names,
            Self::Bits(_) | Self::Text(..) => &[],
        }
    }

    const fn bits(self) -> &'static [StatusBit] {
        match self {
            Self::Bits(bits) => bits,
            Self::Names(_) | Self::Text(..) => &[],
        }
    }
}

impl<W: Word> Raw for W {
    const SIGNED: bool = W::Raw::SIGNED;

    fn from_bits(bits: u64) -> Self {
        W::FROM_RAW(W::Raw::from_bits(bits))
    }

    fn to_bits(self) -> u64 {
        W::RAW(self).to_bits()
    }

    fn meaning(&self) -> Meaning<'_> {
        let raw = self.to_bits();
        match W::LEGEND {
            Legend::Bits(bits) => Meaning::Status(raw, bits),
            Legend::Text(..) => packed::text(*self).map_or(Meaning::None, Meaning::Packed),
            Legend::Names(_) => self.name().map_or(Meaning::None, Meaning::Name),
        }
    }

    fn is_whole(self) -> bool {
        !matches!(W::LEGEND, Legend::Text(..)) || W::FROM_RAW(W::RAW(self)) == self
    }

    fn from_meaning(meaning: Meaning<'_>) -> Option<Self> {
        match meaning {
            Meaning::Name(name) => W::named(name),
            Meaning::Text(text) => packed::parse(text),
            Meaning::Status(raw, _) => Some(W::from_bits(raw)),
            Meaning::Number(_) | Meaning::Bytes(_) | Meaning::Packed(_) | Meaning::None => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;

    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Power {
        On,
        Off,
        Unknown(u8),
    }

    impl Word for Power {
        type Raw = u8;
        const LEGEND: Legend<u8> = Legend::Names(&[(0, "on"), (1, "off")]);
        const FROM_RAW: fn(u8) -> Self = |raw| match raw {
            0 => Self::On,
            1 => Self::Off,
            _ => Self::Unknown(raw),
        };
        const RAW: fn(Self) -> u8 = |power| match power {
            Self::On => 0,
            Self::Off => 1,
            Self::Unknown(raw) => raw,
        };
    }

    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Status(u8);

    impl Word for Status {
        type Raw = u8;
        const LEGEND: Legend<u8> =
            Legend::Bits(&[StatusBit::state(0, "dc_off", "DC side is off"), StatusBit::alarm(5, "hot", "Too hot")]);
        const FROM_RAW: fn(u8) -> Self = Self;
        const RAW: fn(Self) -> u8 = |status| status.0;
    }

    #[test]
    fn values_have_names_both_ways() {
        assert_eq!(Power::FROM_RAW(1).name(), Some("off"));
        assert_eq!(Power::named("off"), Some(Power::Off));
        assert_eq!(Power::named("of"), None);
    }

    #[test]
    fn a_value_without_a_name_is_kept() {
        assert_eq!(Power::from_bits(7), Power::Unknown(7));
        assert_eq!((Power::Unknown(7).to_bits(), Power::Unknown(7).name()), (7, None));
        assert_eq!(Power::Unknown(7).meaning(), Meaning::None);
    }

    #[test]
    fn a_status_word_names_its_set_bits_and_keeps_the_others() {
        let status = Status(0b1010_0001);
        assert_eq!(status.set_bits().map(|bit| bit.name).collect::<Vec<_>>(), ["dc_off", "hot"]);
        assert_eq!(status.unknown(), 0b1000_0000);
    }
}
