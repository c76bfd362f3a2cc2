//! Optional traits: what the options add to items, each behind its switch.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use crate::emit::{Options, Switch};

/// Emits the optional traits of items.
#[derive(Clone, Copy)]
pub struct Derives<'a> {
    options: &'a Options,
}

impl<'a> Derives<'a> {
    pub fn new(options: &'a Options) -> Self {
        Self { options }
    }

    /// Emits the imports of the crates, which the runtime passes on.
    pub fn imports(self) -> TokenStream {
        let Options { serde, defmt, arbitrary, .. } = self.options;
        let serde = gated(
            serde,
            &quote!(
                use canspec_runtime::plumbing::serde;
            ),
        );
        let defmt = gated(
            defmt,
            &quote!(
                use canspec_runtime::plumbing::defmt;
            ),
        );
        let arbitrary = gated(
            arbitrary,
            &quote!(
                use canspec_runtime::plumbing::arbitrary;
            ),
        );
        quote!(#serde #defmt #arbitrary)
    }

    /// Emits the attributes of a struct whose fields have the traits.
    pub fn structure(self) -> TokenStream {
        self.attributes(&quote!(serde(crate = "canspec_runtime::plumbing::serde")))
    }

    /// Emits the attributes of an enum whose variants go by their names in the spec.
    pub fn variants(self) -> TokenStream {
        self.attributes(&quote!(serde(crate = "canspec_runtime::plumbing::serde", rename_all = "snake_case")))
    }

    fn attributes(self, of_serde: &TokenStream) -> TokenStream {
        let derive = quote!(derive(serde::Serialize, serde::Deserialize));
        let serde = attributes(&self.options.serde, &[&derive, of_serde]);
        let defmt = attributes(&self.options.defmt, &[&quote!(derive(defmt::Format))]);
        quote!(#serde #defmt)
    }

    /// Emits the attribute of a variant that has another name than in Rust.
    pub fn variant(self, name: &str) -> TokenStream {
        attributes(&self.options.serde, &[&quote!(serde(rename = #name))])
    }

    /// Emits the attribute of a field that can hold infinities and what is no number.
    pub fn float(self) -> TokenStream {
        attributes(&self.options.serde, &[&quote!(serde(with = "canspec_runtime::with_serde::float"))])
    }

    /// Emits the traits of a word, by its legend.
    pub fn word(self, name: &Ident) -> TokenStream {
        let serialize = quote! {
            impl serde::Serialize for #name {
                fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    canspec_runtime::with_serde::serialize(*self, serializer)
                }
            }
        };
        let deserialize = quote! {
            impl<'de> serde::Deserialize<'de> for #name {
                fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    canspec_runtime::with_serde::deserialize(deserializer)
                }
            }
        };
        let format = quote! {
            impl defmt::Format for #name {
                fn format(&self, formatter: defmt::Formatter<'_>) {
                    canspec_runtime::with_defmt::format(*self, formatter);
                }
            }
        };
        let Options { serde, defmt, .. } = self.options;
        let (serialize, deserialize) = (gated(serde, &serialize), gated(serde, &deserialize));
        let format = gated(defmt, &format);
        quote!(#serialize #deserialize #format)
    }

    /// Emits the traits of a message's struct that no derive can give it.
    pub fn message(self, name: &Ident, is_empty: bool) -> TokenStream {
        let (unstructured, value) = if is_empty {
            (quote!(_), quote!(Ok(Self)))
        } else {
            (quote!(unstructured), quote!(canspec_runtime::with_arbitrary::layout(unstructured)))
        };
        let arbitrary = quote! {
            impl<'a> arbitrary::Arbitrary<'a> for #name {
                fn arbitrary(#unstructured: &mut arbitrary::Unstructured<'a>) -> arbitrary::Result<Self> {
                    #value
                }
            }
        };
        gated(&self.options.arbitrary, &arbitrary)
    }
}

/// Puts an item behind a switch.
fn gated(switch: &Switch, item: &TokenStream) -> TokenStream {
    match switch {
        Switch::Never => TokenStream::new(),
        Switch::Gated(feature) => quote!(#[cfg(feature = #feature)] #item),
        Switch::Always => item.clone(),
    }
}

/// Puts attributes behind a switch.
fn attributes(switch: &Switch, attributes: &[&TokenStream]) -> TokenStream {
    match switch {
        Switch::Never => TokenStream::new(),
        Switch::Gated(feature) => quote!(#[cfg_attr(feature = #feature, #(#attributes),*)]),
        Switch::Always => quote!(#(#[#attributes])*),
    }
}
