//! Which message a frame carries: one `match` over its selectors for each direction.

use proc_macro2::{Ident, Literal, TokenStream, TokenTree};
use quote::quote;

use super::choice::{Arm, choice, condition, joined, split};
use super::names::{Names, ident};
use super::parts::part_name;
use super::rows::{Constants, implies, lengths, rows};
use crate::model::{Course, FrameId, Protocol};

/// Emits how frames are recognised, and how long those should be that are not: each function with those in which it
/// goes on.
pub fn dispatch(protocol: &Protocol, names: &Names) -> [Vec<TokenStream>; 4] {
    let plan = &protocol.recognition;
    let [requests, replies] = [&plan.requests, &plan.replies].map(|course| Direction { protocol, names, course });
    [
        requests.recognising("request"),
        replies.recognising("reply"),
        requests.measuring("request_lengths"),
        replies.measuring("reply_lengths"),
    ]
}

/// The frames of one direction.
struct Direction<'a> {
    protocol: &'a Protocol,
    names: &'a Names,
    course: &'a Course,
}

impl Direction<'_> {
    /// Emits the functions that find the message of a frame, none if there are no frames.
    fn recognising(&self, name: &str) -> Vec<TokenStream> {
        let rows = rows(self.protocol, self.course);
        let (rest, rows): (Vec<_>, Vec<_>) = rows.into_iter().partition(|row| row.constants.is_empty());
        let rest = rest.first().map(|row| self.decoded(&row.outcome));
        let arms = rows.into_iter().map(|row| {
            let body = self.decoded(&row.outcome);
            Arm::new(row.constants, body)
        });
        let parts = split(self.protocol, arms.collect());
        let functions = parts.iter().enumerate().map(|(index, arms)| {
            let next = (index + 1 < parts.len()).then(|| part_name(name, index + 1));
            let found = self.found(arms, rest.as_ref().filter(|_| index == 0), next.as_ref());
            recognising(&part_name(name, index), &found)
        });
        if self.course.choice.is_none() { Vec::new() } else { functions.collect() }
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

    /// Takes the message out of a frame; several are told apart by length, model and addresses.
    fn decoded(&self, frames: &[FrameId]) -> TokenStream {
        let mut decoded = frames.iter().map(|frame| self.recognised(*frame));
        let first = decoded.next();
        quote!(#first #(.or(#decoded, frame, model))*)
    }

    /// Takes the message of a kind of frame out of the data.
    fn recognised(&self, id: FrameId) -> TokenStream {
        let (layout, variant) = (&self.protocol[id], &self.names.variants[id]);
        let names = &self.names.messages[layout.message];
        let (home, exchange) = (&names.structs[0].name, &names.exchanges[layout.exchange]);
        let kind = ident(layout.kind.name());
        let carried = names.carried(layout).map(|_| quote!((Layout::decode(data))));
        quote!(Recognised::#kind(&#home::#exchange, Self::#variant #carried))
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
        if self.course.choice.is_none() { Vec::new() } else { functions }
    }

    /// Returns the lengths of frames by constants in the identifier, unless fewer constants say the same.
    fn measured(&self) -> Vec<(Constants, Vec<u8>)> {
        let mut measured: Vec<(Constants, Vec<u8>)> = Vec::new();
        for row in lengths(self.protocol, self.course).into_iter().rev() {
            let less = measured.iter().rfind(|(less, _)| implies(&row.constants, less));
            if less.is_none_or(|(_, known)| *known != row.outcome) {
                measured.push((row.constants, row.outcome));
            }
        }
        measured.reverse();
        measured
    }
}

fn list(lengths: &[u8]) -> TokenStream {
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
pub fn argument(name: &str, body: &TokenStream) -> TokenStream {
    let name = ident(name);
    if mentions(body, &name.to_string()) { quote!(#name) } else { quote!(_) }
}

fn mentions(code: &TokenStream, name: &str) -> bool {
    let mut used = Vec::new();
    collect(code.clone(), &mut used);
    used.iter().any(|known| known == name)
}

/// Collects the identifiers that are not the end of a path.
fn collect(tokens: TokenStream, used: &mut Vec<String>) {
    let mut colons = 0;
    for token in tokens {
        match token {
            TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
            TokenTree::Ident(name) if colons < 2 => {
                used.push(name.to_string());
                colons = 0;
            }
            TokenTree::Group(group) => {
                collect(group.stream(), used);
                colons = 0;
            }
            TokenTree::Ident(_) | TokenTree::Punct(_) | TokenTree::Literal(_) => colons = 0,
        }
    }
}
