//! Which message a frame carries: one `match` over its selectors for each direction.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::choice::{choice, condition, split};
use super::parts::part_name;
use super::plan::recognition::{Cases, Outcome, Reads, Recognised};
use super::plan::rows::Arm;
use super::plan::selector::Selectors;

/// Emits the functions that find the message of a frame: the first one, and those that it calls.
pub fn recognising(name: &str, Cases { arms, rest }: &Cases<Outcome>, selectors: &Selectors) -> Vec<TokenStream> {
    let written = arms.iter().map(|arm| Arm { sets: arm.sets.clone(), outcome: decoded(&arm.outcome) });
    let parts = split(selectors, written.collect());
    let mut known = arms.iter();
    let functions = parts.iter().enumerate().map(|(index, arms)| {
        let next = (index + 1 < parts.len()).then(|| part_name(name, index + 1));
        let rest = rest.as_ref().filter(|_| index == 0);
        let outcomes = known.by_ref().take(arms.len()).map(|arm| &arm.outcome).chain(rest);
        let reads = outcomes.fold(Reads::default(), |reads, outcome| reads.or(outcome.reads));
        let found = found(selectors, arms, rest, next.as_ref());
        let function = function(&part_name(name, index), reads, next.is_some(), &found);
        if index == 0 { inlined(&function) } else { function }
    });
    functions.collect()
}

/// Says that a function becomes part of its caller. Otherwise the message would be copied once more.
fn inlined(function: &TokenStream) -> TokenStream {
    quote! {
        #[expect(clippy::inline_always, reason = "only decoding calls it")]
        #[inline(always)]
        #function
    }
}

/// Emits a function that finds the message of a frame, and may call the next one.
fn function(name: &Ident, reads: Reads, goes_on: bool, found: &TokenStream) -> TokenStream {
    let asks = reads.model || goes_on;
    let id = reads.id.then(|| quote!(let id = frame.raw_id();));
    let data = reads.data.then(|| quote!(let data = &frame.bytes();));
    let frame = if asks || reads.id || reads.data || reads.frame { quote!(frame) } else { quote!(_) };
    let model = if asks { quote!(model) } else { quote!(_) };
    quote!(fn #name(#frame: &Frame, #model: Option<u8>) -> Option<Recognised<Self>> { #id #data #found })
}

/// Emits a function's body: its arms, then the next function or the frame without constants.
fn found(
    selectors: &Selectors,
    arms: &[Arm<TokenStream>],
    rest: Option<&Outcome>,
    next: Option<&Ident>,
) -> TokenStream {
    let rest = rest.map(decoded);
    let otherwise = match (next, &rest) {
        (None, None) => quote!(return None),
        (None, Some(rest)) => rest.clone(),
        (Some(next), None) => quote!(return Self::#next(frame, model)),
        (Some(next), Some(rest)) => quote!(Self::#next(frame, model).unwrap_or_else(|| #rest)),
    };
    if let ([Arm { sets, outcome }], None, None) = (arms, rest, next) {
        let condition = condition(selectors, &sets[0]);
        return quote!((#condition).then(|| #outcome));
    }
    let choice = choice(selectors, arms, &otherwise);
    if arms.is_empty() { quote!(Some(#choice)) } else { quote!(let recognised = #choice; Some(recognised)) }
}

/// Decodes the message of a frame. Length, model and addresses tell several apart.
fn decoded(outcome: &Outcome) -> TokenStream {
    let mut frames = outcome.frames.iter().map(recognised);
    let first = frames.next();
    quote!(#first #(.or(#frames, frame, model))*)
}

/// Decodes the message of a kind of frame from the data.
fn recognised(Recognised { kind, home, exchange, variant, carries, sized }: &Recognised) -> TokenStream {
    let read = if sized.is_some() { quote!(Layout::read(frame)) } else { quote!(Layout::decode(data)) };
    let carried = carries.then(|| quote!((#read)));
    let lengths = sized.iter().map(|own| quote!(.of_lengths(#own::LENGTHS)));
    quote!(Recognised::#kind(&#home::#exchange, Self::#variant #carried) #(#lengths)*)
}

/// Emits the functions that return the lengths of frames by the constants of the identifier.
pub fn measuring(name: &str, Cases { arms, rest }: &Cases<Vec<u8>>, selectors: &Selectors) -> Vec<TokenStream> {
    let rest = rest.as_ref().map_or_else(|| quote!(&[]), |lengths| list(lengths));
    let arms = arms.iter().map(|arm| Arm { sets: arm.sets.clone(), outcome: list(&arm.outcome) });
    let parts = split(selectors, arms.collect());
    let functions = parts.iter().enumerate().map(|(index, arms)| {
        let (own, next) = (part_name(name, index), part_name(name, index + 1));
        let goes_on = index + 1 < parts.len();
        let otherwise = if goes_on { quote!(Self::#next(id)) } else { rest.clone() };
        let id = if goes_on || !arms.is_empty() { quote!(id) } else { quote!(_) };
        let lengths = choice(selectors, arms, &otherwise);
        quote!(fn #own(#id: u32) -> &'static [u8] { #lengths })
    });
    functions.collect()
}

fn list(lengths: &[u8]) -> TokenStream {
    let lengths = lengths.iter().map(|length| Literal::u8_unsuffixed(*length));
    quote!(&[#(#lengths),*])
}
