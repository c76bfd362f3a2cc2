//! Splits a `match` that is too long for one function into parts. Each part calls the next.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::layout::formatted;
use super::plan::naming::ident;

/// How many lines the arms in one function may have.
const LINES: usize = 72;

/// How many parts become part of their caller, since calls between them keep what they return in memory.
const INLINED: usize = 4;

/// Distributes items evenly over the fewest parts that are short enough, at least one.
pub fn parts<T>(items: Vec<T>, arm: impl Fn(&T) -> TokenStream) -> Vec<Vec<T>> {
    let height = height();
    let heights: Vec<_> = items.iter().map(|item| height(&arm(item))).collect();
    let total = heights.iter().sum::<usize>();
    let enough = total.div_ceil(total.div_ceil(LINES).max(1));
    let (mut parts, mut part, mut lines) = (Vec::new(), Vec::new(), 0);
    for (item, height) in items.into_iter().zip(heights) {
        if !part.is_empty() && (lines >= enough || lines + height > LINES) {
            parts.push(std::mem::take(&mut part));
            lines = 0;
        }
        lines += height;
        part.push(item);
    }
    parts.push(part);
    parts
}

/// Names the function of a part.
pub fn part_name(name: &str, index: usize) -> Ident {
    if index == 0 { ident(name) } else { ident(&format!("{name}_{}", index + 1)) }
}

/// Returns how a part is inlined. The first ones become part of their caller. Another one may, also in another crate.
pub fn inlining(index: usize) -> TokenStream {
    if index < INLINED { quote!(#[inline(always)]) } else { quote!(#[inline]) }
}

/// Returns what counts the lines of an arm in a function of an `impl`.
fn height() -> impl Fn(&TokenStream) -> usize {
    let others = lines(None);
    move |arm| lines(Some(arm)).saturating_sub(others)
}

fn lines(arm: Option<&TokenStream>) -> usize {
    let function = quote!(impl Message { fn decode() { match id { #arm _ => last(), } } });
    formatted([function]).lines().count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns how many arms each part has, if the arms have these heights, of at least three lines.
    fn lengths(heights: Vec<usize>) -> Vec<usize> {
        let arm = |height: &usize| {
            let lines = (2..*height).map(|_| quote!(one();));
            quote!(0x01 => { #(#lines)* })
        };
        parts(heights, arm).iter().map(Vec::len).collect()
    }

    #[test]
    fn arms_are_distributed_evenly_over_parts_that_are_short_enough() {
        assert_eq!(lengths(Vec::new()), [0]);
        assert_eq!(lengths(vec![4; 18]), [18]);
        assert_eq!(lengths(vec![4; 41]), [14, 14, 13]);
        assert_eq!(lengths(vec![5; 20]), [10, 10]);
    }

    #[test]
    fn a_part_is_filled_to_its_last_line_and_not_beyond() {
        assert_eq!(lengths(vec![12, 60, 12]), [2, 1]);
        assert_eq!(lengths(vec![12, 61, 12]), [1, 1, 1]);
    }

    #[test]
    fn no_part_is_empty_beside_arms_that_are_too_wide_to_be_laid_out() {
        let wide = ident(&"a".repeat(200));
        let arm = |_: &usize| quote!(0x01 => frame.reply(&#wide::#wide, Self::#wide(frame.values())),);
        for count in [1, 2, 30] {
            let parts = parts((0..count).collect(), arm);
            assert!(parts.iter().all(|part| !part.is_empty()), "{count}");
        }
    }

    #[test]
    fn an_arm_is_as_high_as_it_is_laid_out() {
        assert_eq!(height()(&quote!(0x01 => one(),)), 1);
        let long = ident(&"a".repeat(60));
        assert_eq!(height()(&quote!(0x01 => #long(#long),)), 3);
    }
}
