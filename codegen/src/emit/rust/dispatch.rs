//! Which message a frame carries: one `match` over its selectors for each direction.

use std::collections::BTreeSet;

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::choice::{Arm, choice, condition, joined, split};
use super::names::{MessageNames, Names, ident};
use super::parts::part_name;
use super::rows::{Constants, implies, rows};
use crate::model::{FrameLayout, Kind, Protocol};

/// Emits how frames are recognised, and how long those should be that are not: each function with those in which it
/// goes on.
pub fn dispatch(protocol: &Protocol, names: &Names) -> [Vec<TokenStream>; 4] {
    let frames = protocol.frames.entries().map(|(id, layout)| Known {
        names: &names.messages[layout.message],
        layout,
        variant: &names.variants[id],
    });
    let (requests, replies): (Vec<_>, Vec<_>) = frames.partition(|known| known.layout.kind == Kind::Request);
    let [requests, replies] = [requests, replies].map(|known| Direction { protocol, known });
    [
        requests.recognising("request"),
        replies.recognising("reply"),
        requests.measuring("request_lengths"),
        replies.measuring("reply_lengths"),
    ]
}

/// A kind of frame of a message.
struct Known<'a> {
    names: &'a MessageNames,
    layout: &'a FrameLayout,
    variant: &'a Ident,
}

impl Known<'_> {
    fn constants(&self) -> Constants {
        self.layout.constants.iter().map(|known| (known.selector, known.value)).collect()
    }

    fn in_identifier(&self) -> Constants {
        let known = self.layout.constants.iter().filter(|known| known.in_identifier().is_some());
        known.map(|known| (known.selector, known.value)).collect()
    }

    /// Takes the message out of the data.
    fn decoded(&self) -> TokenStream {
        let Self { names, layout, variant } = self;
        let (home, exchange) = (&names.structs[0].name, &names.exchanges[layout.exchange]);
        let kind = ident(layout.kind.name());
        let carried = names.carried(layout).map(|_| quote!((Layout::decode(data))));
        quote!(Recognised::#kind(&#home::#exchange, Self::#variant #carried))
    }
}

/// The frames of one direction.
struct Direction<'a> {
    protocol: &'a Protocol,
    known: Vec<Known<'a>>,
}

impl Direction<'_> {
    /// Emits the functions that find the message of a frame, none if there are no frames.
    fn recognising(&self, name: &str) -> Vec<TokenStream> {
        let rows = rows(self.known.iter().map(Known::constants));
        let (rest, rows): (Vec<_>, Vec<_>) = rows.into_iter().partition(Constants::is_empty);
        let rest = rest.first().map(|row| self.decoded(row));
        let arms = rows.into_iter().map(|row| {
            let body = self.decoded(&row);
            Arm::new(row, body)
        });
        let parts = split(self.protocol, arms.collect());
        let functions = parts.iter().enumerate().map(|(index, arms)| {
            let next = (index + 1 < parts.len()).then(|| part_name(name, index + 1));
            let found = self.found(arms, rest.as_ref().filter(|_| index == 0), next.as_ref());
            recognising(&part_name(name, index), &found)
        });
        if self.known.is_empty() { Vec::new() } else { functions.collect() }
    }

    /// Emits what a function finds: by its arms, in the next function, and else the frame without constants.
    fn found(&self, arms: &[Arm], rest: Option<&TokenStream>, next: Option<&Ident>) -> TokenStream {
        let otherwise = match (next, rest) {
            (None, None) => quote!(return None),
            (None, Some(rest)) => rest.clone(),
            (Some(next), None) => quote!(return Self::#next(frame, model)),
            (Some(next), Some(rest)) => quote!(Self::#next(frame, model).unwrap_or_else(|| #rest)),
        };
        if let ([Arm { sets, body }], None, None) = (arms, rest, next) {
            let condition = condition(self.protocol, &sets[0]);
            return quote!((#condition).then(|| #body));
        }
        let choice = choice(self.protocol, arms, &otherwise);
        if arms.is_empty() { quote!(Some(#choice)) } else { quote!(let recognised = #choice; Some(recognised)) }
    }

    /// Takes the message out of frames that show these constants; several are told apart by length, model and addresses.
    fn decoded(&self, row: &Constants) -> TokenStream {
        let mut decoded = self.known.iter().filter(|known| implies(row, &known.constants())).map(Known::decoded);
        let first = decoded.next();
        quote!(#first #(.or(#decoded, frame, model))*)
    }

    /// Emits the functions that say how long frames are that show some constants in the identifier.
    fn measuring(&self, name: &str) -> Vec<TokenStream> {
        let rows = self.measured();
        let (rest, rows): (Vec<_>, Vec<_>) = rows.into_iter().partition(|(row, _)| row.is_empty());
        let rest = rest.first().map_or_else(|| quote!(&[]), |(_, lengths)| list(lengths));
        let arms = rows.into_iter().map(|(row, lengths)| Arm::new(row, list(&lengths)));
        let mut parts = split(self.protocol, joined(arms)).into_iter().enumerate().peekable();
        let mut functions = Vec::new();
        while let Some((index, arms)) = parts.next() {
            let next = parts.peek().map(|(next, _)| part_name(name, *next));
            let otherwise = next.map_or_else(|| rest.clone(), |next| quote!(Self::#next(id)));
            functions.push(measuring(&part_name(name, index), &choice(self.protocol, &arms, &otherwise)));
        }
        if self.known.is_empty() { Vec::new() } else { functions }
    }

    /// Returns the lengths of frames by constants in the identifier, unless fewer constants say the same.
    fn measured(&self) -> Vec<(Constants, BTreeSet<u8>)> {
        let mut measured: Vec<(Constants, BTreeSet<u8>)> = Vec::new();
        for row in rows(self.known.iter().map(Known::in_identifier)).into_iter().rev() {
            let known = self.known.iter().filter(|known| implies(&row, &Known::in_identifier(known)));
            let lengths = known.map(|known| known.layout.length).collect();
            let less = measured.iter().rfind(|(less, _)| implies(&row, less));
            if less.is_none_or(|(_, known)| *known != lengths) {
                measured.push((row, lengths));
            }
        }
        measured.reverse();
        measured
    }
}

fn list(lengths: &BTreeSet<u8>) -> TokenStream {
    let lengths = lengths.iter().map(|length| Literal::u8_unsuffixed(*length));
    quote!(&[#(#lengths),*])
}

fn recognising(name: &Ident, found: &TokenStream) -> TokenStream {
    let id = mentions(found, "id").then(|| quote!(let id = frame.raw_id();));
    let data = mentions(found, "data").then(|| quote!(let data = &frame.bytes();));
    let body = quote!(#id #data #found);
    let (frame, model) = (argument("frame", &body), argument("model", &body));
    quote!(fn #name(#frame: &Frame, #model: Option<u8>) -> Option<Recognised<Self>> { #body })
}

fn measuring(name: &Ident, lengths: &TokenStream) -> TokenStream {
    let id = argument("id", lengths);
    quote!(fn #name(#id: u32) -> &'static [u8] { #lengths })
}

/// Names an argument if the body uses it.
fn argument(name: &str, body: &TokenStream) -> TokenStream {
    let name = ident(name);
    if mentions(body, &name.to_string()) { quote!(#name) } else { quote!(_) }
}

fn mentions(code: &TokenStream, name: &str) -> bool {
    let mut used = Vec::new();
    super::collect(code.clone(), &mut used);
    used.iter().any(|known| known == name)
}
