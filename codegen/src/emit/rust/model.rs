//! Device models, and the limits that depend on them.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::derives::Derives;
use super::doc;
use super::literal::{ends, physical_type};
use super::message::whole;
use super::names::{Names, model_variants};
use crate::emit::Float;
use crate::model::{FrameLayout, Kind, Message, ModelId, Protocol, Range, Signal, SignalId, Table};
use crate::syntax::tree::Step;

/// Limits by device model, which signals share.
pub struct Limits {
    pub name: Ident,
    ranges: Table<ModelId, Option<Range>>,
    /// The type of limits that are integers.
    whole: Option<TokenStream>,
    of: String,
}

impl Limits {
    /// Tests whether a signal has these limits, compared as these are.
    fn are_of(&self, protocol: &Protocol, signal: &Signal) -> bool {
        let text = |kind: &Option<TokenStream>| kind.as_ref().map(ToString::to_string);
        self.ranges == ranges(protocol, signal) && text(&self.whole) == text(&whole(signal))
    }
}

/// Returns every table of limits by device model once.
pub fn limits(protocol: &Protocol) -> Vec<Limits> {
    let mut known: Vec<Limits> = Vec::new();
    let signals = protocol.messages.iter().flat_map(|message| &message.signals);
    for signal in signals.filter(|signal| !signal.model_ranges.is_empty()) {
        if known.iter().any(|limits| limits.are_of(protocol, signal)) {
            continue;
        }
        let of = type_name(signal).unwrap_or(&signal.name).to_owned();
        let mut name = format!("{}_LIMITS", of.to_ascii_uppercase());
        while known.iter().any(|limits| limits.name == name) {
            name.push('_');
        }
        known.push(Limits {
            name: format_ident!("{name}"),
            ranges: ranges(protocol, signal),
            whole: whole(signal),
            of,
        });
    }
    known
}

fn ranges(protocol: &Protocol, signal: &Signal) -> Table<ModelId, Option<Range>> {
    protocol.models.ids().map(|model| signal.range_for(Some(model))).collect()
}

/// Returns the type that a model changes: the last step but one of `models.MODEL.types.TYPE.range`.
fn type_name(signal: &Signal) -> Option<&str> {
    let (changed, _) = signal.model_ranges.first()?.path.split()?;
    match changed.split()? {
        (_, Step::Key(name)) => Some(name),
        _ => None,
    }
}

/// Emits the enum of the device models, if there are any, and the tables of their limits.
pub fn models(protocol: &Protocol, names: &Names, derives: Derives, float: Float) -> Option<TokenStream> {
    let variants = model_variants(protocol);
    let comments = protocol.models.iter().map(|model| {
        let title = model.doc.title.as_ref().map_or_else(String::new, |title| format!(": {}", doc::plain(title)));
        doc::item(protocol, &model.doc, &doc::sentence_of(&format!("`{}`{title}", model.name)), None)
    });
    let optional = derives.structure();
    let serialized = protocol.models.iter().map(|model| derives.variant(&model.name));
    let texts = protocol.models.iter().map(|model| &model.name);
    let count = proc_macro2::Literal::usize_unsuffixed(variants.len());
    let tables = names.limits.iter().map(|limits| table(limits, &variants, float));
    let all: Vec<_> = variants.iter().collect();
    let within = within(protocol);
    (!variants.is_empty()).then(|| {
        quote! {
            /// A device model.
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
            #[repr(u8)]
            #optional
            pub enum Model { #(#comments #serialized #all),* }

            impl Model {
                /// Every device model.
                pub const ALL: [Self; #count] = [#(Self::#all),*];

                /// Returns the vendor's name.
                #[must_use]
                pub const fn name(self) -> &'static str {
                    match self { #(Self::#all => #texts),* }
                }
            }

            impl From<Model> for u8 {
                fn from(model: Model) -> Self {
                    model as Self
                }
            }

            #within

            #(#tables)*
        }
    })
}

/// Emits what values become that a device model takes, if any depend on it.
fn within(protocol: &Protocol) -> Option<TokenStream> {
    protocol.frames.iter().any(|frame| depends_on_model(protocol, frame)).then(|| {
        quote! {
            /// Values that a device model takes. Requests with them keep to its limits, and not to those of other models.
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Within<M> {
                values: M,
                model: Model,
            }
        }
    })
}

fn table(limits: &Limits, variants: &Table<ModelId, Ident>, float: Float) -> TokenStream {
    let name = &limits.name;
    let comment = doc::line(format!("Limits of `{}` by device model.", limits.of));
    let rows = limits.ranges.iter().zip(variants).map(|(range, model)| {
        let range = range.map_or_else(
            || quote!(None),
            |range| {
                let [minimum, maximum] = ends(range, limits.whole.is_some(), float);
                quote!(Some((#minimum, #maximum)))
            },
        );
        quote!((Model::#model as u8, #range))
    });
    let kind = limits.whole.clone().unwrap_or_else(|| physical_type(float));
    quote!(#comment const #name: &[(u8, Option<(#kind, #kind)>)] = &[#(#rows),*];)
}

/// Refers to the limits that a signal has by device model.
pub fn model_limits(protocol: &Protocol, names: &Names, signal: &Signal) -> Option<TokenStream> {
    let mut own = names.limits.iter().filter(|_| !signal.model_ranges.is_empty());
    let name = own.find(|limits| limits.are_of(protocol, signal)).map(|limits| &limits.name)?;
    Some(quote!(.model_limits(#name)))
}

/// Lists the device models that have a message, unless every model has it.
pub fn models_of(protocol: &Protocol, message: &Message) -> Option<TokenStream> {
    let variants = model_variants(protocol);
    let models = message.models.iter().map(|model| &variants[*model]);
    (!message.models.is_empty()).then(|| quote!(.models(&[#(Model::#models as u8),*])))
}

/// Tests whether a frame is a request with values that depend on the device model.
pub fn depends_on_model(protocol: &Protocol, frame: &FrameLayout) -> bool {
    let has_own_limits = |(_, signal): (SignalId, &Signal)| !signal.model_ranges.is_empty();
    let depends = !protocol[frame.message].models.is_empty() || protocol.signals_of(frame).any(has_own_limits);
    frame.kind == Kind::Request && frame.set.is_none() && depends && !frame.signals.is_empty()
}
