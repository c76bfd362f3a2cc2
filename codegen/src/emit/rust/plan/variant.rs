//! The variants of the enum of all messages.

use std::collections::HashSet;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::doc::{self, Comment};
use super::naming::Pool;
use super::types::{FrameTypes, Types};
use crate::model::{FrameLayout, Protocol};

/// A variant of the enum of all messages.
pub struct Variant {
    /// Its name.
    pub name: Ident,
    /// Its name in texts, where that is not made of the other one.
    pub renamed: Option<String>,
    /// Comment of the variant.
    pub comment: Comment,
    /// The struct that it carries.
    pub carried: Option<Ident>,
}

/// Plans the variants, each once.
pub fn variants(protocol: &Protocol, types: &Types) -> Vec<Variant> {
    let (mut known, mut texts) = (HashSet::new(), Pool::default());
    let frames = protocol.frames.iter().zip(&types.frames);
    let once = frames.filter(|(_, FrameTypes { variant, .. })| known.insert(variant));
    let variant = |(layout, FrameTypes { variant, text, carried }): (&FrameLayout, &FrameTypes)| {
        let comment = Comment::line(sentence(protocol, layout, carried.is_some()));
        let renamed = texts.renamed(variant, text, "_message");
        Variant { name: variant.clone(), renamed, comment, carried: carried.clone() }
    };
    once.map(variant).collect()
}

/// Returns the pattern for all variants but those that are known: none, the only one, or `_`.
pub fn others(variants: &[Variant], is_known: impl Fn(&Ident) -> bool) -> Option<TokenStream> {
    let mut others = variants.iter().filter(|variant| !is_known(&variant.name));
    let Variant { name, carried, .. } = others.next()?;
    Some(match (others.next(), carried) {
        (Some(_), _) => quote!(_),
        (None, Some(_)) => quote!(Message::#name(_)),
        (None, None) => quote!(Message::#name),
    })
}

fn sentence(protocol: &Protocol, frame: &FrameLayout, carries: bool) -> String {
    let message = &protocol[frame.message];
    if carries {
        return doc::sentence_of(&doc::title(&message.doc, &message.name));
    }
    format!("The {} of `{}` by `{}`.", frame.kind.name(), message.name, protocol[frame.access].name)
}
