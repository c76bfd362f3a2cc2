//! Texts written by others: the words in a spec, and names of files.
//!
//! Each output has its own method to write a [`Text`], so no output ever obeys what is in it.

mod dbc;
mod lua;
mod rust_doc;

use serde::{Deserialize, Serialize};

pub(crate) use lua::quoted as quoted_in_lua;
pub(crate) use rust_doc::code;

use crate::words::visible::visible;

/// A text of one line, without characters that act on a terminal, reverse its direction or cannot be seen.
///
/// In JSON it is a string. It has no `Display`, because each output needs its own method:
///
/// ```compile_fail
/// let text = canspec_codegen::text::Text::new("A charger");
/// println!("{text}");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub struct Text(String);

impl From<String> for Text {
    fn from(text: String) -> Self {
        Self::new(&text)
    }
}

impl From<Text> for String {
    fn from(text: Text) -> Self {
        text.0
    }
}

impl Text {
    /// Cleans a text: line ends and tabs become spaces, and other forbidden characters U+FFFD.
    pub fn new(text: &str) -> Self {
        let is_clean = text.bytes().all(|byte| matches!(byte, b' '..=b'~'));
        if is_clean {
            Self(text.trim().to_owned())
        } else {
            Self(visible(&text.trim().replace("\r\n", " ").replace(['\n', '\t'], " ")))
        }
    }

    /// Returns the text for a terminal, or for a file that people read.
    pub fn for_people(&self) -> &str {
        &self.0
    }

    /// Returns the content of a string in Rust, without the quotes around it.
    pub fn as_rust_str(&self) -> &str {
        &self.0
    }
}
