//! Attributes and optional traits, which the options add to items.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use crate::emit::{Goal, Options, Switch};

/// Emits what the options add to items.
#[derive(Clone, Copy)]
pub struct Derives<'a> {
    options: &'a Options,
}

impl<'a> Derives<'a> {
    pub fn new(options: &'a Options) -> Self {
        Self { options }
    }

    /// Returns what programs are optimized for.
    pub fn goal(self) -> Goal {
        self.options.goal
    }

    /// Emits the attribute of a function that builds requests, or addresses them.
    pub fn inlined(self) -> TokenStream {
        match self.options.goal {
            Goal::Speed => quote!(#[inline(always)]),
            Goal::Size => quote!(#[inline]),
        }
    }

    /// Emits the name of the method of an exchange that builds a request.
    pub fn request_to(self) -> Ident {
        self.of_goal("request_to")
    }

    /// Emits the name of the method of an exchange that builds a request to a device model.
    pub fn request_within(self) -> Ident {
        self.of_goal("request_within")
    }

    fn of_goal(self, name: &str) -> Ident {
        match self.options.goal {
            Goal::Speed => format_ident!("inlined_{name}"),
            Goal::Size => format_ident!("{name}"),
        }
    }

    /// Emits the imports of the crates, which the runtime re-exports. Only messages have values that are arbitrary.
    pub fn imports(self, has_messages: bool) -> TokenStream {
        let Options { serde, defmt, arbitrary, .. } = self.options;
        let arbitrary = if has_messages { arbitrary } else { &Switch::Never };
        let crates = [("arbitrary", arbitrary), ("defmt", defmt), ("serde", serde)];
        let imports = crates.map(|(name, switch)| {
            let name = format_ident!("{name}");
            gated(switch, &quote!(use canspec_runtime::plumbing::#name;))
        });
        quote!(#(#imports)*)
    }

    /// Emits the attributes of a struct that has these traits, and whose fields have the optional ones.
    pub fn structure(self, traits: &TokenStream) -> TokenStream {
        self.attributes(traits, &quote!(serde(crate = "canspec_runtime::plumbing::serde")))
    }

    /// Emits the attributes of an enum that has these traits, and whose variants go by their names in the spec.
    pub fn variants(self, traits: &TokenStream) -> TokenStream {
        self.attributes(traits, &quote!(serde(crate = "canspec_runtime::plumbing::serde", rename_all = "snake_case")))
    }

    fn attributes(self, traits: &TokenStream, of_serde: &TokenStream) -> TokenStream {
        let Options { serde, defmt, .. } = self.options;
        let (of_both, of_defmt) = (quote!(serde::Serialize, serde::Deserialize), quote!(defmt::Format));
        let always = [(serde, &of_both), (defmt, &of_defmt)].map(|(switch, traits)| match switch {
            Switch::Always => quote!(, #traits),
            Switch::Never | Switch::Gated(_) => TokenStream::new(),
        });
        let serde = match serde {
            Switch::Always => quote!(#[#of_serde]),
            Switch::Never | Switch::Gated(_) => attributes(serde, &[&quote!(derive(#of_both)), of_serde]),
        };
        let defmt = match defmt {
            Switch::Always => TokenStream::new(),
            Switch::Never | Switch::Gated(_) => attributes(defmt, &[&quote!(derive(#of_defmt))]),
        };
        quote!(#[derive(#traits #(#always)*)] #serde #defmt)
    }

    /// Emits the attribute of a variant that has another name than in Rust.
    pub fn variant(self, name: &str) -> TokenStream {
        attributes(&self.options.serde, &[&quote!(serde(rename = #name))])
    }

    /// Emits the attribute of a variant that can have another name than in Rust.
    pub fn renamed(self, name: Option<&str>) -> Option<TokenStream> {
        name.map(|name| self.variant(name))
    }

    /// Emits the attribute of a field that can hold infinities and what is no number.
    pub fn float(self) -> TokenStream {
        attributes(&self.options.serde, &[&quote!(serde(with = "canspec_runtime::with_serde::float"))])
    }

    /// Emits the attribute of an array that is too long for `serde`.
    pub fn array(self) -> TokenStream {
        attributes(&self.options.serde, &[&quote!(serde(with = "canspec_runtime::with_serde::array"))])
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
        if is_empty {
            self.arbitrary(name, &quote!(_), &quote!(Ok(Self)))
        } else {
            self.arbitrary(name, &quote!(unstructured), &quote!(canspec_runtime::with_arbitrary::layout(unstructured)))
        }
    }

    /// Emits the traits of a long message's struct that no derive can give it.
    pub fn long_message(self, name: &Ident) -> TokenStream {
        let value = quote!(canspec_runtime::with_arbitrary::long_layout(unstructured));
        self.arbitrary(name, &quote!(unstructured), &value)
    }

    fn arbitrary(self, name: &Ident, unstructured: &TokenStream, value: &TokenStream) -> TokenStream {
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
