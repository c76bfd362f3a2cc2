//! Addresses, addressing modes, and the targets of requests.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::derives::Derives;
use super::pattern::pattern;
use super::plan::address::{AddressType, Mode, NamedAddress, Number, Sender, Shown, Target, Targets, Value};
use super::plan::way::Way;
use super::way::route;
use crate::model::Id;

/// Emits a kind of address.
pub fn address_type(address: &AddressType) -> TokenStream {
    let AddressType { constant, comment, name, first, last, .. } = address;
    let offset = address.offset.iter().map(|offset| quote!(.offset(#offset)));
    let descending = address.descending.then(|| quote!(.descending()));
    let strict = address.strict.then(|| quote!(.strict()));
    let send = address.send.iter().map(|send| quote!(.default_number(#send)));
    let numbers = address.named.iter().map(|known| &known.number);
    let only = (!address.named.is_empty()).then(|| quote!(.only(&[#(#numbers),*])));
    let named = address.named.iter().map(|known| named_address(known, address.number));
    quote! {
        #comment
        pub const #constant: AddressType =
            AddressType::new(#name, #first, #last) #only #(#offset)* #descending #strict #(#send)*;
        #(#named)*
    }
}

fn named_address(NamedAddress { constant, comment, number }: &NamedAddress, kind: Number) -> TokenStream {
    let kind = number_type(kind);
    quote!(#comment pub const #constant: #kind = #number;)
}

/// Emits a mode.
pub fn mode(Mode { constant, comment, name, target, patterns }: &Mode) -> TokenStream {
    let target = option(target.as_ref().map(|name| quote!(&#name)));
    let [request, one, each, coordinator] = patterns.each_ref().map(|known| option(known.as_ref().map(pattern)));
    quote! {
        #comment
        pub const #constant: Mode = Mode {
            name: #name,
            target: #target,
            request: #request,
            one: #one,
            each: #each,
            coordinator: #coordinator,
        };
    }
}

fn option(value: Option<TokenStream>) -> TokenStream {
    value.map_or_else(|| quote!(None), |value| quote!(Some(#value)))
}

/// Emits the targets of requests.
pub fn targets(Targets { variants, sender }: &Targets, ways: &[Way], derives: Derives) -> TokenStream {
    let attributes = derives.variants(&quote!(Clone, Copy, Debug, PartialEq, Eq, Hash));
    let definitions = variants.iter().map(|target| definition(target, derives));
    let sender = sender.as_ref().map(sent_by);
    let destination = destination(variants, ways, derives);
    quote! {
        /// Whom a request addresses.
        #attributes
        pub enum Target { #(#definitions),* }
        #sender
        #destination
    }
}

fn definition(Target { variant, renamed, comment, number, .. }: &Target, derives: Derives) -> TokenStream {
    let renamed = derives.renamed(renamed.as_deref());
    let number = number.map(|number| {
        let kind = number_type(number);
        quote!((#kind))
    });
    quote!(#comment #renamed #variant #number)
}

fn number_type(number: Number) -> TokenStream {
    match number {
        Number::U8 => quote!(u8),
        Number::U16 => quote!(u16),
        Number::I32 => quote!(i32),
    }
}

/// Writes an address number as the runtime takes it.
fn widened(name: &Ident, number: Number) -> TokenStream {
    match number {
        Number::U8 | Number::U16 => quote!(#name.into()),
        Number::I32 => quote!(#name),
    }
}

fn sent_by(Sender { argument, number, comment }: &Sender) -> TokenStream {
    let (kind, value) = (number_type(*number), widened(argument, *number));
    quote! {
        impl Target {
            #comment
            #[must_use]
            pub fn sent_by(self, #argument: #kind) -> Route<Self> {
                Route::new(self, #value)
            }
        }
    }
}

/// Emits the function that returns the target of one module.
fn module(Target { variant, number, .. }: &Target) -> TokenStream {
    let number = if *number == Some(Number::I32) { quote!(number) } else { quote!(number.try_into().ok()?) };
    quote! {
        fn module(number: i32) -> Option<Target> {
            Some(Target::#variant(#number))
        }
    }
}

fn destination(variants: &[Target], ways: &[Way], derives: Derives) -> TokenStream {
    let inlined = derives.inlined();
    let modes = variants.iter().map(|Target { variant, mode, number, .. }| {
        let (index, number) = (Literal::usize_unsuffixed(mode.place()), number.map(|_| quote!((_))));
        quote!(Self::#variant #number => #index)
    });
    let request = request(variants, &inlined);
    let replies = replies(variants, &inlined);
    let route = route(ways);
    let module = variants.iter().find(|target| target.is_module).map(module);
    quote! {
        impl Addressed for Message {
            type Target = Target;

            #module
        }

        impl Destination for Target {
            type Protocol = Message;

            #inlined
            fn mode(self) -> usize {
                match self { #(#modes),* }
            }

            #request

            #replies

            #route
        }
    }
}

/// Emits what the identifiers of requests show.
fn request(variants: &[Target], inlined: &TokenStream) -> TokenStream {
    let arms = variants.iter().map(|target| {
        let pattern = pattern_of(target, &target.request);
        let filter = id_filter(
            target,
            &target.request,
            |place, kind, number| quote!(.documented(Identifier::#place, &#kind, #number)?),
        );
        quote!(#pattern => #filter)
    });
    let sender = sender_argument(variants.iter().flat_map(|target| &target.request));
    quote! {
        #inlined
        fn request(self, #sender: Option<i32>) -> Result<IdFilter, Error> {
            Ok(match self { #(#arms),* })
        }
    }
}

/// Emits what the identifiers of replies show.
fn replies(variants: &[Target], inlined: &TokenStream) -> TokenStream {
    let replies =
        || variants.iter().flat_map(|target| target.replies.iter().map(move |(who, shown)| (target, who, shown)));
    let arms = replies().map(|(target, who, shown)| {
        let pattern = pattern_of(target, shown);
        let filter =
            id_filter(target, shown, |place, kind, number| quote!(.address(Identifier::#place, &#kind, #number)));
        quote!((#pattern, Who::#who) => #filter)
    });
    let sender = sender_argument(replies().flat_map(|(.., shown)| shown));
    if arms.clone().next().is_none() {
        return quote!(
            #inlined
            fn replies(self, _: Who, _: Option<i32>) -> Option<IdFilter> {
                None
            }
        );
    }
    quote! {
        #inlined
        fn replies(self, who: Who, #sender: Option<i32>) -> Option<IdFilter> {
            Some(match (self, who) {
                #(#arms,)*
                _ => return None,
            })
        }
    }
}

/// Writes the pattern of a target, with its number if the identifier shows it.
fn pattern_of(Target { variant, number, .. }: &Target, shown: &[Shown]) -> TokenStream {
    let is_shown = shown.iter().any(|shown| matches!(shown.value, Value::Target(_)));
    let number = number.map(|_| if is_shown { quote!((number)) } else { quote!((_)) });
    quote!(Self::#variant #number)
}

/// Names the argument for the sender's address, if an identifier shows it.
fn sender_argument<'a>(mut shown: impl Iterator<Item = &'a Shown>) -> TokenStream {
    if shown.any(|shown| matches!(shown.value, Value::Sender(_))) { quote!(sender) } else { quote!(_) }
}

/// Writes a filter of identifiers. `address` writes the call that adds an address.
fn id_filter(
    target: &Target,
    shown: &[Shown],
    address: impl Fn(&Ident, &Ident, TokenStream) -> TokenStream,
) -> TokenStream {
    let fields = shown.iter().map(|Shown { place, value }| match value {
        Value::Constant(value) => quote!(.id(Identifier::#place, #value)),
        Value::Target(kind) => {
            let number = target.number.map(|number| widened(&quote::format_ident!("number"), number));
            address(place, kind, quote!(#number))
        }
        Value::Sender(kind) => address(place, kind, quote!(#kind.chosen(sender))),
        Value::Usual(kind) => address(place, kind, quote!(#kind.chosen(None))),
    });
    quote!(IdFilter::ANY #(#fields)*)
}
