//! The variants of the enum of all messages.

use proc_macro2::Ident;

use super::doc::{self, Comment};
use super::types::{FrameTypes, Types};
use crate::model::{FrameLayout, Protocol};

/// A variant of the enum of all messages.
pub struct Variant {
    /// Its name.
    pub name: Ident,
    /// Comment of the variant.
    pub comment: Comment,
    /// The struct that it carries.
    pub carried: Option<Ident>,
}

/// Plans the variants, each once.
pub fn variants(protocol: &Protocol, types: &Types) -> Vec<Variant> {
    let mut variants: Vec<Variant> = Vec::new();
    for (layout, FrameTypes { variant, carried }) in protocol.frames.iter().zip(&types.frames) {
        if !variants.iter().any(|known| known.name == *variant) {
            let comment = Comment::line(sentence(protocol, layout, carried.is_some()));
            variants.push(Variant { name: variant.clone(), comment, carried: carried.clone() });
        }
    }
    variants
}

fn sentence(protocol: &Protocol, frame: &FrameLayout, carries: bool) -> String {
    let message = &protocol[frame.message];
    if carries {
        return doc::sentence_of(&doc::title(&message.doc, &message.name));
    }
    format!("The {} of `{}` by `{}`.", frame.kind.name(), message.name, protocol[frame.access].name)
}
