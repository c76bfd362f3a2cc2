//! What the spec says about the protocol as a whole.

use proc_macro2::TokenStream;

use super::literal;
use crate::model::{Document, Protocol};

/// The documents of a protocol, and the speeds of its bus.
pub struct About {
    /// Title and version of each document.
    pub documents: Vec<[String; 2]>,
    /// Speeds in bit/s.
    pub bit_rates: Vec<TokenStream>,
}

impl About {
    /// Plans what is said about a protocol.
    pub fn new(protocol: &Protocol) -> Self {
        let printed =
            |Document { title, version, .. }: &Document| [title, version].map(|text| text.for_people().to_owned());
        Self { documents: protocol.documents.iter().map(printed).collect(), bit_rates: rates(&protocol.bit_rates) }
    }
}

/// Writes speeds in bit/s.
pub fn rates(rates: &[u32]) -> Vec<TokenStream> {
    rates.iter().map(|rate| literal::decimal(*rate)).collect()
}
