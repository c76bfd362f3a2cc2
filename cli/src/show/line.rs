//! The JSON object of a frame, which `decode` writes and `encode` reads.

mod input;
mod json;
mod output;
mod transport;

pub use input::{Content, Line, Message};
pub use json::{integer, natural};
pub use output::{addresses, all_selectors, bit_names, selected, set_bits, write};
pub use transport::content as of_transport;

use serde::{Serialize, Serializer};

/// The members of a JSON object, in order.
#[derive(Debug, Default)]
pub struct Members<K, V>(pub Vec<(K, V)>);

impl<K: Serialize, V: Serialize> Serialize for Members<K, V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}
