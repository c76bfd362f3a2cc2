//! Units: those of the language, and those that a spec declares.

use std::fmt;
use std::ops::Deref;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::words::number::Rational;

/// A unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Unit {
    /// The symbol in specs, logs and documentation.
    pub symbol: Symbol,
    /// The ending of a Rust field name.
    pub suffix: Symbol,
}

impl Unit {
    /// Every unit of the language.
    pub const ALL: [Self; 19] = [
        Self::known("V", "v"),
        Self::known("A", "a"),
        Self::known("W", "w"),
        Self::known("VA", "va"),
        Self::known("var", "var"),
        Self::known("Ah", "ah"),
        Self::known("Wh", "wh"),
        Self::known("Ω", "ohm"),
        Self::known("Hz", "hz"),
        Self::known("°C", "c"),
        Self::known("K", "k"),
        Self::known("Pa", "pa"),
        Self::known("%", "percent"),
        Self::known("s", "s"),
        Self::known("ms", "ms"),
        Self::known("min", "min"),
        Self::known("h", "h"),
        Self::known("rpm", "rpm"),
        Self::known("m", "m"),
    ];

    const fn known(symbol: &str, suffix: &str) -> Self {
        Self { symbol: Symbol::cut(symbol), suffix: Symbol::cut(suffix) }
    }

    /// Returns a unit that a spec declares, unless a text is too long.
    pub(crate) fn declared(symbol: &str, suffix: &str) -> Option<Self> {
        Some(Self { symbol: Symbol::new(symbol)?, suffix: Symbol::new(suffix)? })
    }

    /// Tests whether it can do harm if a device is told to give too much of it.
    pub(crate) fn can_harm(self) -> bool {
        ["V", "A", "W"].contains(&&*self.symbol)
    }

    /// Finds a unit of the language by its symbol.
    pub fn find(symbol: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| *unit.symbol == *symbol)
    }
}

/// A number with a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Quantity {
    /// The number.
    pub value: Rational,
    /// Its unit, if it has one.
    pub unit: Option<Unit>,
}

/// A short text, which is copied like a number.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Symbol {
    bytes: [u8; Self::LONGEST],
    length: usize,
}

impl Symbol {
    /// The most bytes that it has.
    pub const LONGEST: usize = 23;

    /// Returns the text, unless it is too long.
    fn new(text: &str) -> Option<Self> {
        (text.len() <= Self::LONGEST).then(|| Self::cut(text))
    }

    /// Returns the text, as far as it fits.
    const fn cut(text: &str) -> Self {
        let (text, mut bytes, mut length) = (text.as_bytes(), [0; Self::LONGEST], 0);
        while length < text.len() && length < Self::LONGEST {
            bytes[length] = text[length];
            length += 1;
        }
        Self { bytes, length }
    }
}

impl Deref for Symbol {
    type Target = str;

    fn deref(&self) -> &str {
        let bytes = self.bytes.get(..self.length).unwrap_or_default();
        str::from_utf8(bytes).unwrap_or_default()
    }
}

impl fmt::Display for Symbol {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(formatter)
    }
}

impl fmt::Debug for Symbol {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(formatter)
    }
}

impl Serialize for Symbol {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (**self).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Symbol {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::new(&text).ok_or_else(|| D::Error::custom(format!("`{text}` is too long for a unit")))
    }
}
