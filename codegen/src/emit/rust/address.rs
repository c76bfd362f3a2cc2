//! Addresses, addressing modes, and the targets of requests.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::derives::Derives;
use super::doc;
use super::identifier::field_place;
use super::literal::{decimal, hexadecimal};
use super::names::{Names, ident};
use crate::model::{Address, AddressPattern, AddressType, Answers, Doc, Id, Mode, ModeId, Protocol, Who};

/// Emits the types of addresses and the modes.
pub fn addressing(protocol: &Protocol) -> TokenStream {
    let types = protocol.address_types.iter().map(|address| address_type(protocol, address));
    let modes = protocol.modes.iter().map(|known| mode(protocol, known));
    quote!(#(#types)* #(#modes)*)
}

fn address_type(protocol: &Protocol, address: &AddressType) -> TokenStream {
    let AddressType { name, first, last, offset, .. } = address;
    let constant = address_name(name);
    let title = doc::title(&address.doc, name);
    let comment = doc::item(protocol, &address.doc, &doc::sentence_of(&format!("{title}: {}", range(address))), None);
    let (first, last) = (number(*first), number(*last));
    let offset = (*offset != 0).then(|| {
        let offset = number(*offset);
        quote!(.offset(#offset))
    });
    let descending = (address.sign < 0).then(|| quote!(.descending()));
    let strict = address.strict.then(|| quote!(.strict()));
    let send = address.send.map(|send| {
        let send = number(send);
        quote!(.default_number(#send))
    });
    quote!(#comment pub const #constant: AddressType = AddressType::new(#name, #first, #last) #offset #descending #strict #send;)
}

/// Writes the documented numbers for people.
fn range(address: &AddressType) -> String {
    format!("`0x{:02X}..=0x{:02X}`", address.first, address.last)
}

/// Writes an address number: hexadecimal as in documents, decimal if it is negative.
fn number(number: i64) -> TokenStream {
    u32::try_from(number).map_or_else(|_| decimal(number), |number| hexadecimal(number, 8))
}

/// Returns the name of the constant of an address type.
pub fn address_name(name: &str) -> Ident {
    ident(&format!("{}_ADDRESS", name.to_ascii_uppercase()))
}

fn mode_name(name: &str) -> Ident {
    ident(&format!("{}_MODE", name.to_ascii_uppercase()))
}

/// Writes who answers, mode by mode.
pub fn answers_list(answers: &Answers) -> TokenStream {
    let answers = answers.iter().map(|who| match who {
        None => quote!(None),
        Some(Who::One) => quote!(Some(Who::One)),
        Some(Who::Each) => quote!(Some(Who::Each)),
        Some(Who::Coordinator) => quote!(Some(Who::Coordinator)),
        Some(Who::Nobody) => quote!(Some(Who::Nobody)),
    });
    quote!([#(#answers),*])
}

fn mode(protocol: &Protocol, mode: &Mode) -> TokenStream {
    let (name, constant) = (&mode.name, mode_name(&mode.name));
    let comment = doc::item(protocol, &mode.doc, &doc::sentence_of(&doc::title(&mode.doc, name)), None);
    let target = option(mode.target.map(|id| {
        let name = address_name(&protocol[id].name);
        quote!(&#name)
    }));
    let [request, one, each, coordinator] = [&mode.request, &mode.one, &mode.each, &mode.coordinator]
        .map(|known| option(known.as_ref().map(|known| pattern(protocol, known))));
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

fn pattern(protocol: &Protocol, pattern: &AddressPattern) -> TokenStream {
    let fields = protocol.identifier.fields.iter().filter(|field| pattern.mask & field.mask() != 0);
    let constants = fields.map(|field| {
        let (place, value) = (super::names::screaming(&field.name), hexadecimal(field.get(pattern.value), field.width));
        quote!((Identifier::#place, #value))
    });
    let addresses = pattern.addresses.iter().map(|known| address(protocol, known));
    quote!(Pattern { constants: &[#(#constants),*], addresses: &[#(#addresses),*] })
}

fn address(protocol: &Protocol, address: &Address) -> TokenStream {
    let (place, width) = field_place(protocol, address.field);
    let kind = &protocol[address.address_type];
    let name = address_name(&kind.name);
    let excluded = address.excluded.iter().map(|(first, last)| {
        let (first, last) = (hexadecimal(*first, width), hexadecimal(*last, width));
        quote!((#first, #last))
    });
    let excluding = (!kind.strict && !address.excluded.is_empty()).then(|| quote!(.excluding(&[#(#excluded),*])));
    quote!(Address::new(Identifier::#place, &#name) #excluding)
}

/// Returns the paths of all modes.
pub fn modes(protocol: &Protocol) -> TokenStream {
    let names = protocol.modes.iter().map(|mode| mode_name(&mode.name));
    quote!(&[#(#names),*])
}

/// A variant of `Target`.
struct Variant<'a> {
    name: &'a Ident,
    mode: &'a Mode,
    id: ModeId,
    address: Option<&'a AddressType>,
}

/// Emits `Target`, unless nobody sends requests.
pub fn target(protocol: &Protocol, names: &Names, derives: Derives) -> Option<TokenStream> {
    let optional = derives.variants();
    let modes = protocol.modes.entries().filter(|(_, mode)| mode.request.is_some());
    let variants = modes.map(|(id, mode)| {
        let address = mode.target.map(|address| &protocol[address]);
        Variant { name: &names.targets[id], mode, id, address }
    });
    let variants: Vec<_> = variants.collect();
    let definitions = variants.iter().map(|variant| definition(protocol, variant));
    let sender = sender(protocol).map(sent_by);
    let destination = destination(&variants);
    (!variants.is_empty()).then(|| {
        quote! {
            /// Whom a request addresses.
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
            #optional
            pub enum Target { #(#definitions),* }
            #sender
            #destination
        }
    })
}

fn definition(protocol: &Protocol, variant: &Variant) -> TokenStream {
    let name = variant.name;
    let title = doc::title(&variant.mode.doc, &variant.mode.name);
    let numbers = variant.address.map_or_else(String::new, |address| format!(": {}", range(address)));
    let errata_elsewhere = Doc { errata: Vec::new(), ..variant.mode.doc.clone() };
    let comment = doc::item(protocol, &errata_elsewhere, &doc::sentence_of(&format!("{title}{numbers}")), None);
    let number = variant.address.map(|address| {
        let integer = number_type(address);
        quote!((#integer))
    });
    quote!(#comment #name #number)
}

/// Returns the type of an address number.
fn number_type(address: &AddressType) -> Ident {
    match (address.first, address.last) {
        (0.., ..=0xFF) => format_ident!("u8"),
        (0.., ..=0xFFFF) => format_ident!("u16"),
        _ => format_ident!("i32"),
    }
}

/// Finds the kind of address that a request is sent from.
fn sender(protocol: &Protocol) -> Option<&AddressType> {
    let requests = protocol.modes.iter().filter_map(|mode| Some((mode, mode.request.as_ref()?)));
    let mut senders = requests.flat_map(|(mode, request)| {
        request.addresses.iter().filter(|address| Some(address.address_type) != mode.target)
    });
    senders.next().map(|address| &protocol[address.address_type])
}

fn sent_by(sender: &AddressType) -> TokenStream {
    let (name, integer) = (ident(&sender.name), number_type(sender));
    let comment =
        doc::line(format!("Returns the route from another `{}` than the usual one: {}.", sender.name, range(sender)));
    let number = if integer == "i32" { quote!(#name) } else { quote!(#name.into()) };
    quote! {
        impl Target {
            #comment
            #[must_use]
            pub fn sent_by(self, #name: #integer) -> Route<Self> {
                Route::new(self, #number)
            }
        }
    }
}

fn destination(variants: &[Variant]) -> TokenStream {
    let modes = variants.iter().map(|variant| {
        let (name, index) = (variant.name, proc_macro2::Literal::usize_unsuffixed(variant.id.place()));
        let number = variant.address.map(|_| quote!((_)));
        quote!(Self::#name #number => #index)
    });
    let arms = ["u8", "u16", "i32"].into_iter().filter_map(|integer| numbers(variants, Some(integer)));
    let arms = arms.chain(numbers(variants, None));
    quote! {
        impl Destination for Target {
            type Protocol = Message;

            fn mode(self) -> usize {
                match self { #(#modes),* }
            }

            fn number(self) -> Option<i32> {
                match self { #(#arms),* }
            }
        }
    }
}

/// Emits the arm of the targets whose number has this type.
fn numbers(variants: &[Variant], integer: Option<&str>) -> Option<TokenStream> {
    let kind = |variant: &&Variant| {
        variant.address.map(|address| number_type(address).to_string()) == integer.map(str::to_owned)
    };
    let names: Vec<_> = variants.iter().filter(kind).map(|variant| variant.name).collect();
    let arm = match integer {
        None => quote!(#(Self::#names)|* => None),
        Some("i32") => quote!(#(Self::#names(number))|* => Some(number)),
        Some(_) => quote!(#(Self::#names(number))|* => Some(number.into())),
    };
    (!names.is_empty()).then_some(arm)
}
