//! The bits of status words.

/// A bit of a status word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct StatusBit {
    /// Number of the bit. Bit 0 is the least significant.
    pub bit: u8,
    /// Name of the condition.
    pub name: &'static str,
    /// The severity, if the document says it.
    pub severity: Option<Severity>,
    /// What it means, in a few words.
    pub title: &'static str,
}

/// The severity of a status bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Severity {
    /// Describes a condition.
    State,
    /// Warns of something that the device recovers from.
    Alarm,
    /// Reports a defect.
    Fault,
}

impl StatusBit {
    /// Returns a bit whose severity is not known.
    pub const fn new(bit: u8, name: &'static str, title: &'static str) -> Self {
        Self { bit, name, severity: None, title }
    }

    /// Returns a bit that describes a condition.
    pub const fn state(bit: u8, name: &'static str, title: &'static str) -> Self {
        Self { severity: Some(Severity::State), ..Self::new(bit, name, title) }
    }

    /// Returns a bit that warns of something that the device recovers from.
    pub const fn alarm(bit: u8, name: &'static str, title: &'static str) -> Self {
        Self { severity: Some(Severity::Alarm), ..Self::new(bit, name, title) }
    }

    /// Returns a bit that reports a defect.
    pub const fn fault(bit: u8, name: &'static str, title: &'static str) -> Self {
        Self { severity: Some(Severity::Fault), ..Self::new(bit, name, title) }
    }

    /// Returns the bit as a mask.
    pub const fn mask(self) -> u64 {
        1_u64.wrapping_shl(self.bit as u32)
    }
}

/// Returns the set bits that have a name, the lowest first.
pub fn set_bits(bits: u64, legend: &'static [StatusBit]) -> impl Iterator<Item = &'static StatusBit> {
    legend.iter().filter(move |bit| bits & bit.mask() != 0)
}

/// Returns the set bits that have no name.
pub fn unknown(bits: u64, legend: &[StatusBit]) -> u64 {
    legend.iter().fold(bits, |rest, bit| rest & !bit.mask())
}
