//! All messages together: the enum that a received frame decodes to.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::address;
use super::doc;
use super::identifier::unnamed;
use super::literal::hexadecimal;
use super::message::{is_exact, selector_name};
use super::names::{MessageNames, Names, ident, screaming};
use super::place::Written;
use crate::model::{Message, Protocol, SelectorPlace, Shape};

/// Emits what every frame shows, and the selectors in the data.
pub fn frame(protocol: &Protocol) -> TokenStream {
    let width = if protocol.identifier.extended { quote!(EXTENDED) } else { quote!(STANDARD) };
    let fields = &protocol.identifier.fields;
    let (mask, value) = unnamed(&protocol.identifier);
    let fixed = (mask != 0).then(|| {
        let (mask, value) = (hexadecimal(mask, 32), hexadecimal(value, 32));
        quote!(.id_bits(#mask, #value))
    });
    let constants = fields.iter().filter_map(|field| {
        let (place, value) = (screaming(&field.name), hexadecimal(field.constant?, field.width));
        Some(quote!(.id(Identifier::#place, #value)))
    });
    let sent = fields.iter().filter_map(|field| {
        let value = hexadecimal(field.send.filter(|value| *value != 0 && field.constant.is_none())?, field.width);
        let place = screaming(&field.name);
        Some(quote!(.send_id(Identifier::#place, #value)))
    });
    let selectors = used_selectors(protocol).map(|index| selector(protocol, index));
    quote! {
        /// What every frame shows.
        const FRAME: Filter = Filter::#width #fixed #(#constants)* #(#sent)*;
        #(#selectors)*
    }
}

/// Returns the selectors in the data that some frame has.
fn used_selectors(protocol: &Protocol) -> impl Iterator<Item = usize> {
    let shapes = || protocol.messages.iter().flat_map(|message| &message.shapes);
    (0..protocol.selectors.len()).filter(move |index| shapes().any(|shape| shape.selectors.contains(index)))
}

fn selector(protocol: &Protocol, index: usize) -> Option<TokenStream> {
    let known = &protocol.selectors[index];
    let SelectorPlace::Payload(place) = known.place else { return None };
    let (constant, name) = (selector_name(protocol, index), &known.name);
    let written = Written::new(place);
    let title = doc::title(&known.doc, name);
    let comment = doc::item(protocol, &known.doc, &doc::sentence_of(&format!("{title}: {}", written.text())), None);
    let place_of = written.expression();
    let normal = known.normal.map(|normal| {
        let normal = hexadecimal(normal, place.width());
        quote!(.normal(#normal))
    });
    Some(quote!(#comment pub const #constant: Selector = Selector::new(#name, #place_of) #normal;))
}

/// Emits `Message`, last in the file.
pub fn protocol(protocol: &Protocol, names: &Names) -> TokenStream {
    let variants = Variants::new(protocol, names);
    let definition = variants.definition();
    let implementation = implementation(protocol, names, &variants);
    quote! {
        #definition

        /// A recognised frame.
        pub type Received = canspec_runtime::Received<Message>;

        impl Message {
            /// Recognises a frame.
            ///
            /// # Errors
            ///
            /// Says why the frame is not recognised.
            pub fn decode(frame: &impl embedded_can::Frame) -> Result<Received, Problem> {
                Received::decode(frame)
            }
        }

        #implementation
    }
}

/// The variants of `Message`, each with its comment and the struct it carries.
struct Variants<'a> {
    list: Vec<(&'a Ident, String, Option<&'a Ident>)>,
    is_exact: bool,
}

impl<'a> Variants<'a> {
    fn new(protocol: &Protocol, names: &'a Names) -> Self {
        let mut list: Vec<(&Ident, String, Option<&Ident>)> = Vec::new();
        for (message, known) in protocol.messages.iter().zip(&names.messages) {
            for (shape, variant) in message.shapes.iter().zip(&known.variants) {
                if !list.iter().any(|(name, ..)| *name == variant) {
                    list.push((
                        variant,
                        comment(protocol, message, known, shape),
                        known.carried(shape).map(|known| &known.name),
                    ));
                }
            }
        }
        let mut signals = protocol.messages.iter().flat_map(|message| &message.signals);
        let is_exact = signals.all(is_exact);
        Self { list, is_exact }
    }

    fn definition(&self) -> TokenStream {
        let eq = self.is_exact.then(|| quote!(, Eq, Hash));
        let variants = self.list.iter().map(|(name, comment, carried)| {
            let comment = doc::line(comment.clone());
            let carried = carried.map(|name| quote!((#name)));
            quote!(#comment #name #carried)
        });
        quote! {
            /// Every message that a frame can carry.
            #[derive(Clone, Copy, Debug, PartialEq #eq)]
            pub enum Message { #(#variants),* }
        }
    }

    fn layout(&self) -> TokenStream {
        let (carrying, empty): (Vec<_>, Vec<_>) = self.list.iter().partition(|(.., carried)| carried.is_some());
        let carrying = carrying.iter().map(|(name, ..)| quote!(Self::#name(message) => message));
        let empty: Vec<_> = empty.iter().map(|(name, ..)| name).collect();
        let empty = (!empty.is_empty()).then(|| quote!(#(Self::#empty)|* => &(),));
        quote! {
            fn layout(&self) -> &dyn Layout {
                match self { #empty #(#carrying),* }
            }
        }
    }
}

fn comment(protocol: &Protocol, message: &Message, names: &MessageNames, shape: &Shape) -> String {
    let access = &protocol.accesses[message.accesses[shape.access].access].name;
    match names.carried(shape) {
        Some(_) => doc::sentence_of(&doc::title(&message.doc, &message.name)),
        None => format!("The {} of `{}` by `{access}`.", shape.kind.name(), message.name),
    }
}

fn implementation(protocol: &Protocol, names: &Names, variants: &Variants) -> TokenStream {
    let normal = protocol.identifier.fields.iter().filter_map(|field| {
        let (place, value) = (screaming(&field.name), hexadecimal(field.normal?, field.width));
        Some(quote!(.id(Identifier::#place, #value)))
    });
    let modes = address::modes(protocol);
    let messages = protocol.messages.iter().zip(&names.messages);
    let shapes = messages.flat_map(|(message, names)| {
        message.shapes.iter().zip(&names.variants).map(|(shape, variant)| row(names, shape, variant))
    });
    let layout = variants.layout();
    quote! {
        impl Protocol for Message {
            type Identifier = Identifier;
            const FRAME: Filter = FRAME;
            const NORMAL: Filter = FRAME #(#normal)*;
            const MODES: &'static [Mode] = #modes;
            const SHAPES: &'static [Shape<Self>] = &[#(#shapes),*];

            #layout
        }
    }
}

fn row(names: &MessageNames, shape: &Shape, variant: &Ident) -> TokenStream {
    let (home, exchange) = (&names.structs[0].name, &names.exchanges[shape.access]);
    let kind = ident(shape.kind.name());
    let carries = names.carried(shape).is_some();
    let decode = if carries { quote!(|data| Self::#variant(Layout::decode(data))) } else { quote!(|_| Self::#variant) };
    quote!(Shape::#kind(&#home::#exchange, #decode))
}
