//! Emitters write the checked model in other languages. They cannot fail.

mod dbc;
mod lua;
mod options;
mod rust;

pub use dbc::{Dbc, Dropped, dbc};
pub use lua::wireshark;
pub use options::{Goal, Options, Scaled, Switch};
pub(crate) use rust::{camel_case, member};
pub use rust::{is_word_of_rust, manual, module, rust, tokens};
