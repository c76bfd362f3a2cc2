//! All messages together: the enum that a received frame decodes to.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::derives::Derives;
use super::dispatch::{measuring, recognising};
use super::filter::normal;
use super::parts::{inlining, part_name, parts};
use super::plan::recognition::Recognition;
use super::plan::variant::Variant;
use super::plan::{Plan, literal};
use super::way::{node, way};
use crate::emit::Goal;

/// Emits `Message`: its type, then how a frame is recognised.
pub fn protocol(plan: &Plan, derives: Derives) -> [TokenStream; 2] {
    let definition = definition(plan, derives);
    let decode_for = (!plan.models.rows.is_empty()).then(decode_for);
    let functions = functions(plan);
    let first = functions.iter().filter_map(|parts| parts.first());
    let implementation = implementation(plan, derives, first);
    let further: Vec<_> = functions.iter().flat_map(|parts| parts.iter().skip(1)).collect();
    let decoding = quote! {
        #definition

        /// A recognised frame; `canspec_runtime::Received` shows how to ask it what it says.
        pub type Received = canspec_runtime::Received<Message>;

        /// A request ready to be sent, whose replies carry `R`.
        pub type Request<R> = canspec_runtime::Request<Message, R>;

        /// A frame that answers a request.
        pub type Reply<R> = canspec_runtime::Reply<Message, R>;

        impl Message {
            /// Recognises a frame, or says why it does not.
            #[inline]
            pub fn decode(frame: &impl embedded_can::Frame) -> Result<Received, Problem> {
                Received::decode(frame)
            }

            #decode_for

            #(#further)*
        }
    };
    [decoding, implementation]
}

/// Emits how a frame of a device model is recognised.
fn decode_for() -> TokenStream {
    quote! {
        /// Recognises a frame of a device model: of messages that look the same, the one that it has.
        /// Says why if there is none.
        #[inline]
        pub fn decode_for(model: Model, frame: &impl embedded_can::Frame) -> Result<Received, Problem> {
            Received::decode_for(model, frame)
        }
    }
}

fn definition(plan: &Plan, derives: Derives) -> TokenStream {
    let mut signals = plan.messages.iter().flat_map(|message| &message.signals);
    let eq = signals.all(|signal| signal.coding.is_exact()).then(|| quote!(, Eq, Hash));
    let attributes = derives.variants(&quote!(Clone, Copy, Debug, PartialEq #eq));
    let variants = plan.variants.iter().map(|Variant { name, renamed, comment, carried }| {
        let (renamed, carried) = (derives.renamed(renamed.as_deref()), carried.iter());
        quote!(#comment #renamed #name #((#carried))*)
    });
    quote! {
        /// Every message that a frame can carry.
        #attributes
        pub enum Message { #(#variants),* }
    }
}

/// Emits the functions of the trait: they recognise frames, say how long frames should be, and run a task on a message.
///
/// A long function goes on in others, which stand behind it.
fn functions(plan: &Plan) -> Vec<Vec<TokenStream>> {
    let Plan { recognition: Recognition { frames, lengths }, selectors, .. } = plan;
    let recognising = frames.iter().map(|(name, frames)| recognising(name, frames, selectors));
    let measuring = lengths.iter().map(|(name, lengths)| measuring(name, lengths, selectors));
    recognising.chain(measuring).chain([run_of(&plan.variants)]).collect()
}

/// Emits the functions that run a task on what a message carries: the one of the trait, then those in which it goes on.
fn run_of(variants: &[Variant]) -> Vec<TokenStream> {
    let (carrying, empty): (Vec<_>, Vec<_>) = variants.iter().partition(|variant| variant.carried.is_some());
    let (carrying, empty) = (names_of(&carrying), names_of(&empty));
    match (carrying.is_empty(), empty.as_slice()) {
        (true, []) => vec![run(0, &quote!(_), &quote!(match *self {}))],
        (true, _) => vec![run(0, &quote!(task), &quote!(task.run(&())))],
        (false, []) => runs(carrying, &quote!()),
        (false, [only]) => runs(carrying, &quote!(Self::#only => task.run(&()),)),
        (false, _) => runs(carrying, &quote!(_ => task.run(&()),)),
    }
}

fn names_of<'a>(variants: &[&'a Variant]) -> Vec<&'a Ident> {
    variants.iter().map(|variant| &variant.name).collect()
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
    let inlined = inlining(index);
    quote!(#inlined fn #name<T: Task>(&self, #task: T) -> T::Output { #body })
}

fn implementation<'a>(plan: &Plan, derives: Derives, functions: impl Iterator<Item = &'a TokenStream>) -> TokenStream {
    let normal = normal(&plan.base);
    let modes = plan.modes.iter().map(|mode| &mode.constant);
    let timing = plan.timing.as_ref().map(|_| {
        quote!(
            const TIMING: Timing = TIMING;
        )
    });
    let after_silence = plan.after_silence.iter();
    let starting = plan.starting.iter().map(|code| literal::decimal(*code));
    let truths = truths(plan, derives);
    let (way, node) = (way(&plan.ways), node(&plan.ways));
    let length = common_length(plan).into_iter().map(Literal::u8_unsuffixed);
    quote! {
        impl Protocol for Message {
            type Identifier = Identifier;
            const FRAME: Filter = FRAME;
            const NORMAL: Filter = #normal;
            #(const LENGTH: Option<u8> = Some(#length);)*
            const MODES: &'static [Mode] = &[#(#modes),*];
            #(const STARTING: Option<u64> = Some(#starting);)*
            #timing
            #(const AFTER_SILENCE: AfterSilence = AfterSilence::#after_silence;)*
            const MESSAGES: &'static [Entry<Self>] = MESSAGES;
            #(const #truths: bool = true;)*

            #way
            #node
            #(#functions)*
        }
    }
}

/// Names what is true of the protocol, and not of every one.
fn truths(plan: &Plan, derives: Derives) -> impl Iterator<Item = Ident> {
    let mut exchanges = plan.messages.iter().flat_map(|message| &message.exchanges);
    let truths = [
        ("CONTROLLER_REPORTS", plan.accesses.iter().any(|access| access.is_from_controller)),
        ("DATA_SELECTORS", !plan.in_data.is_empty()),
        ("FOREIGN_LIKE_OWN", plan.foreign_like_own),
        ("IN_ONE_PLACE", derives.goal() == Goal::Size && plan.recognition.is_of_both_directions()),
        ("REFUSALS", exchanges.any(|exchange| exchange.refusal.is_some())),
    ];
    truths.into_iter().filter(|(_, is_true)| *is_true).map(|(name, _)| format_ident!("{name}"))
}

/// Returns the number of data bytes that every frame has, if all have as many.
fn common_length(plan: &Plan) -> Option<u8> {
    let mut lengths = plan.recognition.all_lengths();
    let first = lengths.next()?;
    lengths.all(|length| length == first).then_some(first)
}
