//! The JSON object of a frame, which `decode` writes and `encode` reads.

mod input;
mod output;

pub use input::Content;
pub use output::{Outcome, bit_names, write};

/// The members of a JSON object, in order.
#[derive(Debug, Default)]
pub struct Members<K, V>(pub Vec<(K, V)>);
