//! The identifier: its fields, and how they show the direction.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::choice::{either, tuple};
use super::derives::Derives;
use super::plan::comparison::{Comparison, Range, Test};
use super::plan::documented::{Documented, Shown};
use super::plan::heading::Heading;
use super::plan::identifier::{Field, Identifier};

/// Emits the struct of the identifier and its fields' places.
pub fn identifier(identifier: &Identifier, derives: Derives) -> TokenStream {
    let (comment, attributes) =
        (&identifier.comment, derives.structure(&quote!(Clone, Copy, Debug, PartialEq, Eq, Hash)));
    let members =
        identifier.fields.iter().map(|Field { comment, member, kind, .. }| quote!(#comment pub #member: #kind));
    let places = identifier.fields.iter().map(|Field { place_comment, place, bits: [high, low], .. }| {
        quote!(#place_comment pub const #place: Bits = Bits::new(#high, #low);)
    });
    let (split, directions) = (splitting(identifier), directions(identifier));
    quote! {
        #comment
        #attributes
        pub struct Identifier { #(#members),* }
        impl Identifier { #(#places)* #split }
        #directions
    }
}

fn splitting(Identifier { fields, ones, .. }: &Identifier) -> TokenStream {
    let members: Vec<_> = fields.iter().map(|field| &field.member).collect();
    let places: Vec<_> = fields.iter().map(|field| &field.place).collect();
    let ones = ones.iter();
    quote! {
        /// Splits an identifier.
        #[must_use]
        #[inline]
        pub fn from_raw(id: u32) -> Self {
            Self { #(#members: Self::#places.read(id)),* }
        }

        /// Joins the fields; bits that a field cannot hold are dropped.
        #[must_use]
        #[inline]
        pub fn to_raw(self) -> u32 {
            #(#ones |)* #(Self::#places.write(self.#members))|*
        }
    }
}

/// Emits the tests of an identifier that every protocol needs.
fn directions(Identifier { foreign, heading, documented, .. }: &Identifier) -> TokenStream {
    let foreign = foreign.as_ref().map(is_foreign);
    let head = head(heading);
    let documented = documented_modes(documented);
    quote! {
        impl IdentifierFields for Identifier {
            const FROM_RAW: fn(u32) -> Self = Self::from_raw;
            const TO_RAW: fn(Self) -> u32 = Self::to_raw;

            #foreign
            #head
            #documented
        }
    }
}

/// Emits the test in which modes an identifier is a request with documented addresses only, if any mode has requests.
fn documented_modes(Documented { common, fields, modes }: &Documented) -> Option<TokenStream> {
    let shown = all(common);
    let bits = match modes.as_slice() {
        [] => return None,
        [Shown { mode, .. }] if common.is_empty() => shifted(quote!(1), *mode),
        [Shown { mode, .. }] => shifted(quote!(u8::from(#shown)), *mode),
        several => {
            let own = mode_of(fields, several);
            if common.is_empty() { own } else { quote!(if #shown { #own } else { 0 }) }
        }
    };
    let id = if common.is_empty() && fields.is_empty() { quote!(_) } else { quote!(id) };
    Some(quote!(#[inline] fn documented_modes(#id: u32) -> u8 { #bits }))
}

/// Tells modes apart by their fields.
fn mode_of(fields: &[Ident], modes: &[Shown]) -> TokenStream {
    let subject = tuple(fields.iter().map(|place| quote!(Self::#place.of(id))).collect());
    let arms = modes.iter().map(|Shown { mode, ranges }| {
        let (pattern, bit) = (tuple(ranges.iter().map(|own| pattern(own)).collect()), shifted(quote!(1), *mode));
        quote!(#pattern => #bit,)
    });
    quote!(match #subject { #(#arms)* _ => 0 })
}

fn shifted(bit: TokenStream, mode: usize) -> TokenStream {
    let place = Literal::usize_unsuffixed(mode);
    if mode == 0 { bit } else { quote!(#bit << #place) }
}

fn pattern(ranges: &[Range]) -> TokenStream {
    let ranges = ranges.iter().map(|range| match range {
        Range::One(only) => quote!(#only),
        Range::Span(first, last) => quote!(#first..=#last),
    });
    either(&ranges.collect::<Vec<_>>())
}

/// Emits where a frame goes.
fn head(heading: &Heading) -> TokenStream {
    let outcome = outcome(heading);
    let id = if matches!(heading, Heading::Known { .. }) { quote!(_) } else { quote!(id) };
    quote!(#[inline(always)] fn head<H: Headed>(#id: u32, frame: H) -> H::Output { #outcome })
}

fn outcome(heading: &Heading) -> TokenStream {
    match heading {
        Heading::Known { to_module, to_controller } => known(*to_module, *to_controller),
        Heading::By { place, is_byte, cases, otherwise } => {
            let arms = cases.iter().map(|(ranges, next)| (pattern(ranges), outcome(next)));
            let arms = arms.map(|(pattern, next)| quote!(#pattern => #next,));
            let otherwise = outcome(otherwise);
            // Processors take fewer instructions to test a byte.
            let value = if *is_byte { quote!(byte(id)) } else { quote!(of(id)) };
            quote!(match Self::#place.#value { #(#arms)* _ => #otherwise })
        }
        Heading::Tests { to_module, to_controller } => {
            let tests = tuple([to_module, to_controller].map(condition).into());
            let arms = [(true, true), (true, false), (false, true), (false, false)].map(|(module, controller)| {
                let outcome = known(module, controller);
                quote!((#module, #controller) => #outcome,)
            });
            quote!(match #tests { #(#arms)* })
        }
    }
}

fn known(to_module: bool, to_controller: bool) -> TokenStream {
    match (to_module, to_controller) {
        (true, true) => quote!(frame.to(Heading::Either)),
        (true, false) => quote!(frame.to(Heading::Module)),
        (false, true) => quote!(frame.to(Heading::Controller)),
        (false, false) => quote!(frame.to(Heading::Neither)),
    }
}

fn is_foreign(foreign: &Test) -> TokenStream {
    let condition = condition(foreign);
    quote!(#[inline] fn is_foreign(id: u32) -> bool { #condition })
}

fn condition(test: &Test) -> TokenStream {
    let mut conditions: Vec<_> = test.any.iter().map(|tests| all(tests)).collect();
    match conditions.len() {
        0 => quote!(false),
        1 => conditions.remove(0),
        _ => quote!(#((#conditions))||*),
    }
}

fn all(tests: &[Comparison]) -> TokenStream {
    match tests {
        [] => quote!(true),
        [only] => comparison(only),
        several => {
            let tests = several.iter().map(|test| {
                let (is_choice, test) = (test.inside && test.ranges.len() > 1, comparison(test));
                if is_choice { quote!((#test)) } else { test }
            });
            quote!(#(#tests)&&*)
        }
    }
}

/// Tests whether a value lies inside one of the ranges, or outside all.
fn comparison(Comparison { place, inside, ranges }: &Comparison) -> TokenStream {
    let value = place.as_ref().map_or_else(|| quote!(id), |place| quote!(Self::#place.of(id)));
    let tests = ranges.iter().map(|range| in_range(&value, range, *inside));
    if *inside { quote!(#(#tests)||*) } else { quote!(#(#tests)&&*) }
}

/// Tests whether a value lies inside a range, or outside.
fn in_range(value: &TokenStream, range: &Range, inside: bool) -> TokenStream {
    match (range, inside) {
        (Range::One(only), true) => quote!(#value == #only),
        (Range::One(only), false) => quote!(#value != #only),
        (Range::Span(first, last), true) => quote!((#first..=#last).contains(&#value)),
        (Range::Span(first, last), false) => quote!(!(#first..=#last).contains(&#value)),
    }
}
