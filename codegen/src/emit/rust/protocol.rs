//! All messages together: the enum that a received frame decodes to.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::address;
use super::derives::Derives;
use super::dispatch::dispatch;
use super::doc;
use super::entries::entries;
use super::exchange::selector_name;
use super::identifier::unnamed;
use super::literal::hexadecimal;
use super::message::is_exact;
use super::names::{Names, screaming};
use super::parts::{part_name, parts};
use super::place::Written;
use crate::model::{FrameLayout, Protocol, SelectorId, SelectorPlace};

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
        let (place, value) = (screaming(&field.name), hexadecimal(field.sent(), field.width));
        (field.constant.is_none() && field.sent() != 0).then(|| quote!(.send_id(Identifier::#place, #value)))
    });
    let selectors = used_selectors(protocol).map(|id| selector(protocol, id));
    quote! {
        /// What every frame shows.
        const FRAME: Filter = Filter::#width #fixed #(#constants)* #(#sent)*;
        #(#selectors)*
    }
}

/// Returns the selectors in the data that some frame has.
fn used_selectors(protocol: &Protocol) -> impl Iterator<Item = SelectorId> {
    let is_used = |id: &SelectorId| protocol.frames.iter().any(|frame| frame.selectors.contains(id));
    protocol.selectors.ids().filter(is_used)
}

fn selector(protocol: &Protocol, id: SelectorId) -> Option<TokenStream> {
    let known = &protocol[id];
    let SelectorPlace::Payload(place) = known.place else { return None };
    let (constant, name) = (selector_name(protocol, id), &known.name);
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
pub fn protocol(protocol: &Protocol, names: &Names, derives: Derives) -> TokenStream {
    let variants = Variants::new(protocol, names);
    let definition = variants.definition(derives);
    let decode_for = decode_for(protocol);
    let functions: Vec<_> = dispatch(protocol, names).into_iter().chain([variants.run()]).collect();
    let first = functions.iter().filter_map(|parts| parts.first());
    let implementation = implementation(protocol, first);
    let entries = entries(protocol, names);
    let further = functions.iter().flat_map(|parts| parts.iter().skip(1));
    quote! {
        #definition

        /// A recognised frame; [`canspec_runtime::Received`] shows how to ask it what it says.
        pub type Received = canspec_runtime::Received<Message>;

        /// A request ready to be sent, whose replies carry `R`.
        pub type Request<R> = canspec_runtime::Request<Message, R>;

        /// A frame that answers a request.
        pub type Reply<R> = canspec_runtime::Reply<Message, R>;

        impl Message {
            /// Recognises a frame.
            ///
            /// # Errors
            ///
            /// Says why the frame is not recognised.
            pub fn decode(frame: &impl embedded_can::Frame) -> Result<Received, Problem> {
                Received::decode(frame)
            }

            #decode_for

            #(#further)*
        }

        #implementation

        #entries
    }
}

/// Emits how a frame of a device model is recognised, if anything depends on the model.
fn decode_for(protocol: &Protocol) -> Option<TokenStream> {
    (!protocol.models.is_empty()).then(|| {
        quote! {
            /// Recognises a frame of a device model: of messages that look the same, the one that it has.
            ///
            /// # Errors
            ///
            /// Says why the frame is not recognised.
            pub fn decode_for(model: Model, frame: &impl embedded_can::Frame) -> Result<Received, Problem> {
                Received::decode_for(model, frame)
            }
        }
    })
}

/// The variants of `Message`, each with its comment and the struct it carries.
struct Variants<'a> {
    list: Vec<(&'a Ident, String, Option<&'a Ident>)>,
    is_exact: bool,
}

impl<'a> Variants<'a> {
    fn new(protocol: &Protocol, names: &'a Names) -> Self {
        let mut list: Vec<(&Ident, String, Option<&Ident>)> = Vec::new();
        for (frame, variant) in protocol.frames.iter().zip(&names.variants) {
            if !list.iter().any(|(name, ..)| *name == variant) {
                let carried = names.messages[frame.message].carried(frame).map(|known| &known.name);
                list.push((variant, comment(protocol, frame, carried.is_some()), carried));
            }
        }
        let mut signals = protocol.messages.iter().flat_map(|message| &message.signals);
        let is_exact = signals.all(is_exact);
        Self { list, is_exact }
    }

    fn definition(&self, derives: Derives) -> TokenStream {
        let optional = derives.variants();
        let eq = self.is_exact.then(|| quote!(, Eq, Hash));
        let variants = self.list.iter().map(|(name, comment, carried)| {
            let comment = doc::line(comment.clone());
            let carried = carried.map(|name| quote!((#name)));
            quote!(#comment #name #carried)
        });
        quote! {
            /// Every message that a frame can carry.
            #[derive(Clone, Copy, Debug, PartialEq #eq)]
            #optional
            pub enum Message { #(#variants),* }
        }
    }

    /// Emits the functions that run a task on what a message carries: the one of the trait, then those in which it goes on.
    fn run(&self) -> Vec<TokenStream> {
        let (carrying, empty): (Vec<_>, Vec<_>) = self.list.iter().partition(|(.., carried)| carried.is_some());
        let (carrying, empty) = (names_of(&carrying), names_of(&empty));
        match (carrying.is_empty(), empty.as_slice()) {
            (true, []) => vec![run(0, &quote!(_), &quote!(match *self {}))],
            (true, _) => vec![run(0, &quote!(task), &quote!(task.run(&())))],
            (false, []) => runs(carrying, &quote!()),
            (false, [only]) => runs(carrying, &quote!(Self::#only => task.run(&()),)),
            (false, _) => runs(carrying, &quote!(_ => task.run(&()),)),
        }
    }
}

fn names_of<'a>(variants: &[&(&'a Ident, String, Option<&Ident>)]) -> Vec<&'a Ident> {
    variants.iter().map(|(name, ..)| *name).collect()
}

/// Emits what the variants carry; `empty` is the arm of those that carry nothing.
fn runs(carrying: Vec<&Ident>, empty: &TokenStream) -> Vec<TokenStream> {
    let parts = parts(carrying, |name| quote!(Self::#name(message) => task.run(message),));
    let functions = parts.iter().enumerate().map(|(index, names)| {
        let next = (index + 1 < parts.len()).then(|| part_name("run", index + 1));
        let rest = match next {
            Some(next) => quote!(_ => self.#next(task),),
            None if index > 0 => quote!(_ => task.run(&()),),
            None => empty.clone(),
        };
        run(index, &quote!(task), &quote!(match self { #(Self::#names(message) => task.run(message),)* #rest }))
    });
    functions.collect()
}

fn run(index: usize, task: &TokenStream, body: &TokenStream) -> TokenStream {
    let name = part_name("run", index);
    quote!(fn #name<T: Task>(&self, #task: T) -> T::Output { #body })
}

fn comment(protocol: &Protocol, frame: &FrameLayout, carries: bool) -> String {
    let message = &protocol[frame.message];
    if carries {
        return doc::sentence_of(&doc::title(&message.doc, &message.name));
    }
    format!("The {} of `{}` by `{}`.", frame.kind.name(), message.name, protocol[frame.access].name)
}

fn implementation<'a>(protocol: &Protocol, functions: impl Iterator<Item = &'a TokenStream>) -> TokenStream {
    let normal = protocol.identifier.fields.iter().filter_map(|field| {
        let (place, value) = (screaming(&field.name), hexadecimal(field.normal?, field.width));
        Some(quote!(.id(Identifier::#place, #value)))
    });
    let modes = address::modes(protocol);
    quote! {
        impl Protocol for Message {
            type Identifier = Identifier;
            const FRAME: Filter = FRAME;
            const NORMAL: Filter = FRAME #(#normal)*;
            const MODES: &'static [Mode] = #modes;
            const MESSAGES: &'static [Entry<Self>] = MESSAGES;

            #(#functions)*
        }
    }
}
