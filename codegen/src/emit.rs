//! Emitters: from the checked model to other languages. They cannot fail.

mod rust;

pub(crate) use rust::camel_case;
pub use rust::rust;
