//! What a long message is, whatever carries it.

use crate::model::{Doc, ModelId, Reserved};

/// What a long message is, whatever carries it.
#[derive(Clone, Copy)]
pub struct Head<'a> {
    pub name: &'a str,
    pub doc: &'a Doc,
    /// The only models that have it.
    pub models: &'a [ModelId],
    /// What the bits are that nothing names.
    pub reserved: Reserved,
}
