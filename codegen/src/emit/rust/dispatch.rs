//! Which message a frame carries: one `match` over its selectors for each direction, or one for both.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::choice::{choice, matched, split};
use super::parts::{inlining, part_name};
use super::plan::recognition::{Candidate, Cases, Outcome};
use super::plan::rows::Arm;
use super::plan::selector::Selectors;

/// Emits the functions that find the message of a frame: the first one, and those that it calls.
///
/// The first becomes part of its caller. Otherwise the frame would have to be written to memory for it.
pub fn recognising(name: &str, Cases { arms, rest }: &Cases<Outcome>, selectors: &Selectors) -> Vec<TokenStream> {
    let written = arms.iter().map(|arm| Arm { sets: arm.sets.clone(), outcome: decoded(&arm.outcome) });
    let parts = split(selectors, written.collect());
    let rest = rest.as_ref().map_or_else(|| quote!(frame.unknown()), decoded);
    let functions = parts.iter().enumerate().map(|(index, arms)| {
        let (own, next) = (part_name(name, index), part_name(name, index + 1));
        let otherwise = if index + 1 < parts.len() { quote!(Self::#next(frame)) } else { rest.clone() };
        let found = if arms.is_empty() { otherwise } else { matched(selectors, arms, &otherwise) };
        let inlined = inlining(index);
        quote!(#inlined fn #own(frame: &Incoming) -> Result<Received, Problem> { #found })
    });
    functions.collect()
}

/// Decodes the message of a frame.
fn decoded(outcome: &Outcome) -> TokenStream {
    match outcome {
        Outcome::Frames(candidates) => match candidates.as_slice() {
            [only] => of_kind(only),
            several => {
                let several = several.iter().map(of_kind);
                quote!(frame.best([#(#several),*]))
            }
        },
        Outcome::Pair(pair) => {
            let [request, reply] = &**pair;
            let (receiver, exchange, answer) = (receiver(reply), exchange(reply), message(reply));
            if request.variant == reply.variant {
                quote!(#receiver.both(#exchange, #answer))
            } else {
                let request = message(request);
                quote!(#receiver.pair(#exchange, #request, #answer))
            }
        }
    }
}

/// Decodes the message of a kind of frame.
fn of_kind(candidate: &Candidate) -> TokenStream {
    let (receiver, exchange, message) = (receiver(candidate), exchange(candidate), message(candidate));
    let kind = &candidate.kind;
    quote!(#receiver.#kind(#exchange, #message))
}

/// Emits the frame with the numbers of data bytes that it can have.
fn receiver(Candidate { sized, .. }: &Candidate) -> TokenStream {
    let lengths = sized.iter().map(|own| quote!(.of_lengths(#own::LENGTHS)));
    quote!(frame #(#lengths)*)
}

fn exchange(Candidate { owner, exchange, .. }: &Candidate) -> TokenStream {
    quote!(&#owner::#exchange)
}

/// Emits the message, with its values out of the data.
fn message(Candidate { variant, carries, .. }: &Candidate) -> TokenStream {
    let carried = carries.then(|| quote!((frame.values())));
    quote!(Self::#variant #carried)
}

/// Emits the functions that return the lengths of frames by the constants of the identifier.
pub fn measuring(name: &str, Cases { arms, rest }: &Cases<Vec<u8>>, selectors: &Selectors) -> Vec<TokenStream> {
    let rest = rest.as_ref().map_or_else(|| quote!(&[]), |lengths| list(lengths));
    let arms = arms.iter().map(|arm| Arm { sets: arm.sets.clone(), outcome: list(&arm.outcome) });
    let parts = split(selectors, arms.collect());
    let functions = parts.iter().enumerate().map(|(index, arms)| {
        let (own, next) = (part_name(name, index), part_name(name, index + 1));
        let goes_on = index + 1 < parts.len();
        let otherwise = if goes_on { quote!(Self::#next(frame)) } else { rest.clone() };
        let frame = if goes_on || !arms.is_empty() { quote!(frame) } else { quote!(_) };
        let lengths = choice(selectors, arms, &otherwise);
        quote!(fn #own(#frame: &Incoming) -> &'static [u8] { #lengths })
    });
    functions.collect()
}

fn list(lengths: &[u8]) -> TokenStream {
    let lengths = lengths.iter().map(|length| Literal::u8_unsuffixed(*length));
    quote!(&[#(#lengths),*])
}
