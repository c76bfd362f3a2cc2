//! Texts of others: what a spec says in words, and names of files.
//!
//! A [`Text`] has no way to an output but one that is made for this output, so that nothing in it is ever obeyed.

mod dbc;
mod lua;
mod rust_doc;

use serde::Serialize;

pub(crate) use lua::quoted as quoted_in_lua;
pub(crate) use rust_doc::code;

use crate::source::visible;

/// A text of one line, without characters that act on a terminal, reverse its direction or cannot be seen.
///
/// In JSON it is a string. It cannot be written without saying what for:
///
/// ```compile_fail
/// let text = canspec_codegen::text::Text::new("A charger");
/// println!("{text}");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(transparent)]
pub struct Text(String);

impl Text {
    /// Cleans a text: line ends and tabs become spaces, other characters that have no place in it U+FFFD.
    pub fn new(text: &str) -> Self {
        Self(visible(&text.trim().replace("\r\n", " ").replace(['\n', '\t'], " ")))
    }

    /// Returns the text for a terminal, or for a file that people read.
    pub fn for_people(&self) -> &str {
        &self.0
    }

    /// Returns the content of a string in Rust, whose quotes are still to be put around it.
    pub fn as_rust_str(&self) -> &str {
        &self.0
    }
}
