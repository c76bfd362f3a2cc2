//! A choice by the values of selectors: a `match`, or less where less is enough.

use proc_macro2::TokenStream;
use quote::quote;

use super::exchange::selector_name;
use super::identifier::field_place;
use super::literal::hexadecimal;
use super::parts::parts;
use super::rows::{Constants, agree};
use crate::model::{Protocol, SelectorId, SelectorPlace};

/// What is chosen where one of these sets of constants holds.
pub struct Arm {
    pub sets: Vec<Constants>,
    pub body: TokenStream,
}

impl Arm {
    pub fn new(constants: Constants, body: TokenStream) -> Self {
        Self { sets: vec![constants], body }
    }
}

/// Chooses the first arm of which a set holds, else `otherwise`; reads the identifier `id` and the bytes `data`.
pub fn choice(protocol: &Protocol, arms: &[Arm], otherwise: &TokenStream) -> TokenStream {
    if let [Arm { sets, body }] = arms
        && let [only] = sets.as_slice()
    {
        let condition = condition(protocol, only);
        return quote!(if #condition { #body } else { #otherwise });
    }
    if arms.is_empty() {
        return otherwise.clone();
    }
    let columns = columns(protocol, arms);
    let values = columns.iter().map(|selector| value(protocol, *selector));
    let subject = tuple(values.collect());
    let arms = arms.iter().map(|arm| written(protocol, &columns, arm));
    quote!(match #subject { #(#arms)* _ => #otherwise })
}

/// Tests whether all constants hold.
pub fn condition(protocol: &Protocol, constants: &Constants) -> TokenStream {
    let tests = columns_of(protocol, constants.keys().copied()).into_iter().filter_map(|selector| {
        let (value, constant) = (value(protocol, selector), constant(protocol, selector, *constants.get(&selector)?));
        Some(quote!(#value == #constant))
    });
    quote!(#(#tests)&&*)
}

/// Distributes arms over functions of which none gets too long.
pub fn split(protocol: &Protocol, arms: Vec<Arm>) -> Vec<Vec<Arm>> {
    let columns = columns(protocol, &arms);
    parts(arms, |arm| written(protocol, &columns, arm))
}

/// Joins arms that choose the same, where no arm between them holds for the same frame.
pub fn joined(arms: impl Iterator<Item = Arm>) -> Vec<Arm> {
    let mut joined: Vec<Arm> = Vec::new();
    for arm in arms {
        let is_apart = |other: &Arm| !other.sets.iter().any(|set| arm.sets.iter().any(|known| agree(set, known)));
        let same = joined.iter().rposition(|other| other.body.to_string() == arm.body.to_string());
        match same.filter(|same| joined[same + 1..].iter().all(is_apart)) {
            Some(same) => joined[same].sets.extend(arm.sets),
            None => joined.push(arm),
        }
    }
    joined
}

fn written(protocol: &Protocol, columns: &[SelectorId], Arm { sets, body }: &Arm) -> TokenStream {
    let patterns = match columns {
        [column] => ranges(protocol, *column, sets),
        _ => sets.iter().map(|constants| pattern(protocol, columns, constants)).collect(),
    };
    quote!(#(#patterns)|* => #body,)
}

fn pattern(protocol: &Protocol, columns: &[SelectorId], constants: &Constants) -> TokenStream {
    let fixed = |selector: &SelectorId| Some(constant(protocol, *selector, *constants.get(selector)?));
    tuple(columns.iter().map(|selector| fixed(selector).unwrap_or_else(|| quote!(_))).collect())
}

/// Writes values of one selector, and three or more in a row as a range.
fn ranges(protocol: &Protocol, selector: SelectorId, sets: &[Constants]) -> Vec<TokenStream> {
    let mut values: Vec<_> = sets.iter().filter_map(|constants| constants.get(&selector).copied()).collect();
    values.sort_unstable();
    let constant = |value| constant(protocol, selector, value);
    let runs = values.chunk_by(|value, next| next - value == 1).flat_map(|run| match run {
        [first, _, .., last] => {
            let (first, last) = (constant(*first), constant(*last));
            vec![quote!(#first..=#last)]
        }
        few => few.iter().copied().map(constant).collect(),
    });
    runs.collect()
}

fn tuple(mut parts: Vec<TokenStream>) -> TokenStream {
    if parts.len() == 1 { parts.remove(0) } else { quote!((#(#parts),*)) }
}

/// Returns the selectors that some arm looks at.
fn columns(protocol: &Protocol, arms: &[Arm]) -> Vec<SelectorId> {
    columns_of(protocol, arms.iter().flat_map(|arm| &arm.sets).flat_map(Constants::keys).copied())
}

/// Puts selectors in order: first the identifier, then the data.
fn columns_of(protocol: &Protocol, selectors: impl Iterator<Item = SelectorId>) -> Vec<SelectorId> {
    let mut columns: Vec<_> = selectors.collect();
    columns.sort_unstable_by_key(|selector| match protocol[*selector].place {
        SelectorPlace::Identifier(field) => (None, Some(field)),
        SelectorPlace::Payload(_) => (Some(*selector), None),
    });
    columns.dedup();
    columns
}

fn value(protocol: &Protocol, selector: SelectorId) -> TokenStream {
    match protocol[selector].place {
        SelectorPlace::Identifier(field) => {
            let (place, _) = field_place(protocol, field);
            quote!(Identifier::#place.of(id))
        }
        SelectorPlace::Payload(_) => {
            let constant = selector_name(protocol, selector);
            quote!(#constant.place.get(data))
        }
    }
}

/// Writes the value of a selector.
pub fn constant(protocol: &Protocol, selector: SelectorId, value: u64) -> TokenStream {
    let width = match protocol[selector].place {
        SelectorPlace::Identifier(field) => protocol[field].width,
        SelectorPlace::Payload(place) => place.width(),
    };
    hexadecimal(value, width)
}
