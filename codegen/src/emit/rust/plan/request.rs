//! The methods that build requests.

use proc_macro2::{Ident, TokenStream};

use super::doc::Comment;

/// A method that builds a request.
#[derive(Clone)]
pub struct Request {
    /// Its name.
    pub method: Ident,
    /// Comment of the method.
    pub comment: Comment,
    /// The path of the exchange.
    pub exchange: TokenStream,
    /// Type of the replies' values.
    pub reply: TokenStream,
    /// Whether the request carries the values of the struct.
    pub carries: bool,
}
