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
    let bit_rates = bit_rates(rows);
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
    let mut models: IndexMap<String, (TokenStream, Vec<&Ident>)> = IndexMap::new();
    for Model { variant, bit_rates, .. } in rows {
        let rates = quote!(&[#(#bit_rates),*]);
        models.entry(rates.to_string()).or_insert_with(|| (rates, Vec::new())).1.push(variant);
    }
    let arms = models.values().map(|(rates, models)| quote!(#(Self::#models)|* => #rates));
    rows.iter().any(|model| !model.bit_rates.is_empty()).then(|| {
        quote! {
            /// Returns the speeds of the bus that the document states for this model, in bit/s.
            #[must_use]
            pub const fn bit_rates(self) -> &'static [u32] {
                match self { #(#arms),* }
            }
        }
    })
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
