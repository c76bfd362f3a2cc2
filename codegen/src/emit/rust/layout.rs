//! The layout of generated code.

use proc_macro2::TokenStream;

use super::{lines, spacing};

/// Lays the code out; if it is no Rust it stays as it is, so that its compiler can say why.
pub fn formatted(code: &TokenStream) -> String {
    let file = syn::parse2(code.clone());
    file.map_or_else(|_| code.to_string(), |file| spacing::spaced(&lines::joined(&prettyplease::unparse(&file))))
}
