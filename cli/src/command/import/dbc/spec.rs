//! The parts of a first spec.

use canspec_codegen::source::forbidden;

use super::places::BitRange;

/// A spec with reports only.
pub struct Spec {
    /// Name of the DBC.
    pub file: String,
    pub protocol: String,
    /// The version that the DBC states.
    pub version: String,
    pub extended: bool,
    /// Data bytes of most messages.
    pub length: u8,
    pub messages: Vec<Message>,
    /// What the DBC says and the spec does not, each a sentence.
    pub limits: Vec<String>,
}

pub struct Message {
    pub name: String,
    pub title: String,
    pub note: String,
    /// Its sender in the DBC.
    pub sender: Option<String>,
    pub id: u32,
    pub length: u8,
    /// Milliseconds from one frame to the next.
    pub cycle: Option<u64>,
    pub fields: Vec<Field>,
}

/// A signal or a constant.
pub struct Field {
    pub name: String,
    pub place: BitRange,
    pub is_constant: bool,
    /// Keys and their values, as YAML.
    pub keys: Vec<(&'static str, String)>,
    /// What a human must decide.
    pub decide: Vec<String>,
}

/// Returns a text in one line of characters that a spec may hold.
pub fn one_line(text: &str) -> String {
    let seen = text.split(|letter: char| letter.is_whitespace() || forbidden(letter).is_some());
    seen.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}
