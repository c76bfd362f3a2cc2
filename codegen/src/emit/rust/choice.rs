//! A choice by the values of selectors: a `match`, or less if less is enough.

use std::mem;

use indexmap::IndexMap;
use proc_macro2::TokenStream;
use quote::quote;

use super::parts::parts;
use super::plan::rows::{Arm, Constants};
use super::plan::selector::{Selector, Selectors, Source};
use crate::model::SelectorId;

/// Chooses the first arm with a set that holds, else `otherwise`. It asks `frame`.
pub fn choice(selectors: &Selectors, arms: &[Arm<TokenStream>], otherwise: &TokenStream) -> TokenStream {
    if let [Arm { sets, outcome }] = arms
        && let [only] = sets.as_slice()
    {
        let condition = condition(selectors, only);
        return quote!(if #condition { #outcome } else { #otherwise });
    }
    if arms.is_empty() {
        return otherwise.clone();
    }
    matched(selectors, arms, otherwise)
}

/// The same as a `match`, also of a single arm.
pub fn matched(selectors: &Selectors, arms: &[Arm<TokenStream>], otherwise: &TokenStream) -> TokenStream {
    let columns = columns(selectors, arms);
    let values = columns.iter().map(|selector| value(&selectors[*selector]));
    let subject = tuple(values.collect());
    let arms = arms.iter().map(|arm| written(selectors, &columns, arm));
    quote!(match #subject { #(#arms)* _ => #otherwise })
}

/// Tests whether all constants hold.
fn condition(selectors: &Selectors, constants: &Constants) -> TokenStream {
    let tests = in_order(selectors, constants.keys().copied()).into_iter().filter_map(|id| {
        let (value, constant) = (value(&selectors[id]), selectors[id].value(*constants.get(&id)?));
        Some(quote!(#value == #constant))
    });
    quote!(#(#tests)&&*)
}

/// Distributes arms over functions, so that none gets too long.
pub fn split(selectors: &Selectors, arms: Vec<Arm<TokenStream>>) -> Vec<Vec<Arm<TokenStream>>> {
    let columns = columns(selectors, &arms);
    parts(arms, |arm| written(selectors, &columns, arm))
}

fn written(selectors: &Selectors, columns: &[SelectorId], Arm { sets, outcome }: &Arm<TokenStream>) -> TokenStream {
    let patterns = rows(columns, sets).into_iter().flat_map(|row| {
        let mut parts: Vec<_> =
            columns.iter().zip(row).map(|(column, values)| ranges(&selectors[*column], values)).collect();
        if parts.len() == 1 {
            parts.remove(0)
        } else {
            vec![tuple(parts.iter().map(|patterns| either(patterns)).collect())]
        }
    });
    quote!(#(#patterns)|* => #outcome,)
}

/// The values of each column in a pattern. Any value will do if there is none.
type Row = Vec<Vec<u64>>;

/// Joins sets of constants that differ in one column.
fn rows(columns: &[SelectorId], sets: &[Constants]) -> Vec<Row> {
    let row = |constants: &Constants| {
        columns.iter().map(|column| constants.get(column).copied().into_iter().collect()).collect()
    };
    let rows: Vec<Row> = sets.iter().map(row).collect();
    (0..columns.len()).rev().fold(rows, |rows, column| {
        let mut joined: IndexMap<(Row, bool), Vec<u64>> = IndexMap::new();
        for mut row in rows {
            let own = mem::take(&mut row[column]);
            joined.entry((row, own.is_empty())).or_default().extend(own);
        }
        let put_back = |((mut row, _), own): ((Row, bool), Vec<u64>)| {
            row[column] = own;
            row
        };
        joined.into_iter().map(put_back).collect()
    })
}

/// Writes patterns of one value as one pattern.
pub fn either(patterns: &[TokenStream]) -> TokenStream {
    if patterns.is_empty() { quote!(_) } else { quote!(#(#patterns)|*) }
}

/// Writes values of one selector, and three or more in a row as a range.
fn ranges(selector: &Selector, mut values: Vec<u64>) -> Vec<TokenStream> {
    values.sort_unstable();
    values.dedup();
    let runs = values.chunk_by(|value, next| next - value == 1).flat_map(|run| match run {
        [first, _, .., last] => {
            let (first, last) = (selector.value(*first), selector.value(*last));
            vec![quote!(#first..=#last)]
        }
        few => few.iter().map(|value| selector.value(*value)).collect(),
    });
    runs.collect()
}

/// Writes several values or patterns as one.
pub fn tuple(mut parts: Vec<TokenStream>) -> TokenStream {
    if parts.len() == 1 { parts.remove(0) } else { quote!((#(#parts),*)) }
}

/// Returns the selectors that some arm looks at.
fn columns(selectors: &Selectors, arms: &[Arm<TokenStream>]) -> Vec<SelectorId> {
    in_order(selectors, arms.iter().flat_map(|arm| &arm.sets).flat_map(Constants::keys).copied())
}

/// Puts selectors in order: first the identifier, then the data.
fn in_order(selectors: &Selectors, known: impl Iterator<Item = SelectorId>) -> Vec<SelectorId> {
    let mut columns: Vec<_> = known.collect();
    columns.sort_unstable_by_key(|id| selectors[*id].rank);
    columns.dedup();
    columns
}

fn value(selector: &Selector) -> TokenStream {
    match &selector.source {
        Source::Identifier(place) => quote!(frame.id(Identifier::#place)),
        Source::Data(constant) => quote!(frame.data(#constant.place)),
    }
}
