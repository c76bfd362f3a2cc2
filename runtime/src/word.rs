//! Named values, status words and packed values: integers with a legend.

use crate::packed::{self, Piece};
use crate::{Integer, Meaning, Raw, StatusBit, status};

/// An integer with a legend: named values, a status word or a packed value.
pub trait Word: Copy + PartialEq + 'static {
    /// The integer that stands in the frame.
    type Raw: Integer;
    /// What the integer stands for.
    const LEGEND: Legend<Self>;

    /// Returns the value that stands for `raw`, whether the legend has it or not.
    fn from_raw(raw: Self::Raw) -> Self;

    /// Returns the integer that stands in the frame.
    fn raw(self) -> Self::Raw;
}

/// What an integer stands for.
#[derive(Clone, Copy, Debug)]
pub enum Legend<W: 'static> {
    /// Every value that has a name.
    Names(&'static [(W, &'static str)]),
    /// Every bit that has a name, the lowest first.
    Bits(&'static [StatusBit]),
    /// The number of bytes, and the pieces of the text that they are written as.
    Text(u8, &'static [Piece]),
}

/// Named values: an enum with one variant a name, and one that keeps a value without a name.
pub trait Named: Word {
    /// Returns the name, unless the value has none.
    fn name(self) -> Option<&'static str> {
        let bits = self.raw().to_bits();
        names::<Self>().iter().find(|(value, _)| value.raw().to_bits() == bits).map(|(_, name)| *name)
    }

    /// Finds a value by its name.
    fn from_name(name: &str) -> Option<Self> {
        names::<Self>().iter().find(|(_, other)| *other == name).map(|(value, _)| *value)
    }
}

/// A status word: each named bit is a condition, and bits without a name are kept.
pub trait StatusWord: Word {
    /// Tests whether all bits of `other` are set.
    fn contains(self, other: Self) -> bool {
        let bits = other.raw().to_bits();
        self.raw().to_bits() & bits == bits
    }

    /// Tests whether some bit of `other` is set.
    fn intersects(self, other: Self) -> bool {
        self.raw().to_bits() & other.raw().to_bits() != 0
    }

    /// Tests whether no bit is set.
    fn is_empty(self) -> bool {
        self.raw().to_bits() == 0
    }

    /// Returns the bits that are set here or in `other`.
    #[must_use]
    fn union(self, other: Self) -> Self {
        Self::from_raw(Self::Raw::from_bits(self.raw().to_bits() | other.raw().to_bits()))
    }

    /// Returns the set bits that have a name, the lowest first.
    fn set_bits(self) -> impl Iterator<Item = &'static StatusBit> {
        status::set_bits(self.raw().to_bits(), bits::<Self>())
    }

    /// Returns the set bits that have no name.
    fn unknown(self) -> u64 {
        status::unknown(self.raw().to_bits(), bits::<Self>())
    }
}

const fn names<W: Word>() -> &'static [(W, &'static str)] {
    match W::LEGEND {
        Legend::Names(names) => names,
        Legend::Bits(_) | Legend::Text(..) => &[],
    }
}

const fn bits<W: Word>() -> &'static [StatusBit] {
    match W::LEGEND {
        Legend::Names(_) | Legend::Text(..) => &[],
        Legend::Bits(bits) => bits,
    }
}

impl<W: Word> Raw for W {
    const SIGNED: bool = W::Raw::SIGNED;

    fn from_bits(bits: u64) -> Self {
        W::from_raw(W::Raw::from_bits(bits))
    }

    fn to_bits(self) -> u64 {
        self.raw().to_bits()
    }

    fn meaning(&self) -> Meaning<'_> {
        let raw = self.to_bits();
        match W::LEGEND {
            Legend::Bits(bits) => Meaning::Status(raw, bits),
            Legend::Text(..) => packed::text(*self).map_or(Meaning::None, Meaning::Packed),
            Legend::Names(names) => names
                .iter()
                .find(|(value, _)| value.to_bits() == raw)
                .map_or(Meaning::None, |(_, name)| Meaning::Name(name)),
        }
    }

    fn is_whole(self) -> bool {
        !matches!(W::LEGEND, Legend::Text(..)) || W::from_raw(self.raw()) == self
    }

    fn from_meaning(meaning: Meaning<'_>) -> Option<Self> {
        match meaning {
            Meaning::Name(name) => names::<W>().iter().find(|(_, other)| *other == name).map(|(value, _)| *value),
            Meaning::Text(text) => packed::parse(text),
            Meaning::Status(raw, _) => Some(W::from_bits(raw)),
            Meaning::Number(_) | Meaning::Packed(_) | Meaning::None => None,
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
        const LEGEND: Legend<Self> = Legend::Names(&[(Self::On, "on"), (Self::Off, "off")]);

        fn from_raw(raw: u8) -> Self {
            match raw {
                0 => Self::On,
                1 => Self::Off,
                _ => Self::Unknown(raw),
            }
        }

        fn raw(self) -> u8 {
            match self {
                Self::On => 0,
                Self::Off => 1,
                Self::Unknown(raw) => raw,
            }
        }
    }

    impl Named for Power {}

    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Status(u8);

    impl Word for Status {
        type Raw = u8;
        const LEGEND: Legend<Self> =
            Legend::Bits(&[StatusBit::state(0, "dc_off", "DC side is off"), StatusBit::alarm(5, "hot", "Too hot")]);

        fn from_raw(raw: u8) -> Self {
            Self(raw)
        }

        fn raw(self) -> u8 {
            self.0
        }
    }

    impl StatusWord for Status {}

    #[test]
    fn values_have_names_both_ways() {
        assert_eq!(Power::from_raw(1).name(), Some("off"));
        assert_eq!(Power::from_name("off"), Some(Power::Off));
        assert_eq!(Power::from_name("of"), None);
    }

    #[test]
    fn a_value_without_a_name_is_kept() {
        assert_eq!(Power::from_bits(7), Power::Unknown(7));
        assert_eq!((Power::Unknown(7).to_bits(), Power::Unknown(7).name()), (7, None));
        assert_eq!(Power::Unknown(7).meaning(), Meaning::None);
    }

    #[test]
    fn a_status_word_names_its_set_bits_and_keeps_the_others() {
        let status = Status::from_raw(0b1010_0001);
        assert_eq!(status.set_bits().map(|bit| bit.name).collect::<Vec<_>>(), ["dc_off", "hot"]);
        assert_eq!(status.unknown(), 0b1000_0000);
        assert!(status.contains(Status(0b0010_0000)) && !status.contains(Status(0b0010_0010)));
        assert!(status.intersects(Status(0b0010_0010)) && !status.intersects(Status(0b0000_0010)));
        assert_eq!(Status(1).union(Status(4)), Status(5));
        assert!(Status(0).is_empty());
    }
}
