//! Device models, and the limits that depend on them.

use indexmap::IndexMap;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::derives::Derives;
use super::plan::models::{Limits, Model, Models};
use crate::model::{ModelId, Table};

/// Emits the enum of the device models, if there are any, and the tables of their limits.
pub fn models(Models { rows, has_within, limits, .. }: &Models, derives: Derives) -> Option<TokenStream> {
    let attributes = derives.structure(&quote!(Clone, Copy, Debug, PartialEq, Eq, Hash));
    let definitions = rows.iter().map(|Model { variant, comment, name, .. }| {
        let serialized = derives.variant(name);
        quote!(#comment #serialized #variant)
    });
    let texts = rows.iter().map(|model| &model.name);
    let count = Literal::usize_unsuffixed(rows.len());
    let all: Vec<_> = rows.iter().map(|model| &model.variant).collect();
    let (bit_rates, fact) = (bit_rates(rows), fact(rows));
    let within = has_within.then(within);
    let tables = limits.iter().map(table);
    (!rows.is_empty()).then(|| {
        quote! {
            /// A device model.
            #attributes
            #[repr(u8)]
            pub enum Model { #(#definitions),* }

            impl Model {
                /// Every device model.
                pub const ALL: [Self; #count] = [#(Self::#all),*];

                /// Returns the vendor's name.
                #[must_use]
                pub const fn name(self) -> &'static str {
                    match self { #(Self::#all => #texts),* }
                }

                #bit_rates
                #fact
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

/// Emits the method that returns the speeds of the bus, if the document states them for a model.
fn bit_rates(rows: &Table<ModelId, Model>) -> Option<TokenStream> {
    let arms = arms(rows, |Model { bit_rates, .. }| quote!(&[#(#bit_rates),*]))?;
    Some(quote! {
        /// Returns the speeds of the bus that the document states for this model, in bit/s.
        #[must_use]
        pub const fn bit_rates(self) -> &'static [u32] {
            match self { #arms }
        }
    })
}

/// Emits the method that returns a rating, if the document states some.
fn fact(rows: &Table<ModelId, Model>) -> Option<TokenStream> {
    let arms = arms(rows, |Model { facts, .. }| {
        let facts = facts.iter().map(|(name, value)| quote!((#name, #value)));
        quote!(&[#(#facts),*])
    })?;
    Some(quote! {
        /// Returns a rating that no message carries: thousandths of its unit, or a plain number.
        ///
        /// It is `None` if the document does not state it for this model, or no `i32` is exactly that value.
        #[must_use]
        pub fn fact(self, quantity: Quantity) -> Option<i32> {
            let facts: &[(&str, i32)] = match self { #arms };
            facts.iter().find(|(name, _)| *name == quantity.name()).map(|(_, value)| *value)
        }
    })
}

/// Emits an arm for each list that models have, if one of them has any.
fn arms(rows: &Table<ModelId, Model>, list: impl Fn(&Model) -> TokenStream) -> Option<TokenStream> {
    let mut models: IndexMap<String, (TokenStream, Vec<&Ident>)> = IndexMap::new();
    for model in rows {
        let list = list(model);
        models.entry(list.to_string()).or_insert_with(|| (list, Vec::new())).1.push(&model.variant);
    }
    let is_empty = models.keys().all(|list| *list == quote!(&[]).to_string());
    let arms = models.values().map(|(list, models)| quote!(#(Self::#models)|* => #list,));
    (!is_empty).then(|| arms.collect())
}

/// Emits the type of values that a device model takes.
fn within() -> TokenStream {
    quote! {
        /// Values that a device model takes. Requests with them keep to its limits, and not to those of other models.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Within<M> {
            values: M,
            model: Model,
        }
    }
}

fn table(Limits { constant, comment, kind, rows }: &Limits) -> TokenStream {
    let rows = rows.iter().map(row);
    quote!(#comment const #constant: &[(u8, Option<(#kind, #kind)>)] = &[#(#rows),*];)
}

fn row((model, range): &(Ident, Option<[TokenStream; 2]>)) -> TokenStream {
    let range = match range {
        None => quote!(None),
        Some([minimum, maximum]) => quote!(Some((#minimum, #maximum))),
    };
    quote!((Model::#model as u8, #range))
}
