//! The documents that a spec follows.

/// A document that a spec follows. The constant `DOCUMENTS` of generated code has each of them.
///
/// A program can write it into its log. Readers of the log then know what the program was made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Document {
    /// Its title as printed.
    pub title: &'static str,
    /// Its version as printed.
    pub version: &'static str,
}
