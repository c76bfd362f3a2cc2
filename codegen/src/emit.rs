//! Emitters: from the checked model to other languages. They cannot fail.

mod rust;

pub use rust::rust;
