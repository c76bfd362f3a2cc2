//! A signal: its constant, and those of its special values.

use proc_macro2::TokenStream;
use quote::quote;

use super::plan::signal::{Signal, Special};

/// Emits the types of a signal: that of its raw value, and that of its limits if it is another.
pub fn kinds(Signal { coding, physical, .. }: &Signal) -> TokenStream {
    let (raw, physical) = (&coding.raw, physical.iter());
    quote!(#raw #(, #physical)*)
}

/// Emits the value of a signal's constant.
pub fn value(signal: &Signal) -> TokenStream {
    let Signal { name, place, unit, coding, limits, model_limits, specials, has_absent, lacking, .. } = signal;
    let unit = unit.iter().map(|unit| quote!(.unit(#unit)));
    let offset = coding.offset.iter().map(|[above, below]| quote!(.offset(#above, #below)));
    let scale = coding.scale.iter().map(|[numerator, denominator]| quote!(.scale(#numerator, #denominator)));
    let limits = limits.iter().map(|[minimum, maximum]| quote!(.limits(#minimum, #maximum)));
    let model_limits = model_limits.iter().map(|table| quote!(.model_limits(#table)));
    let rows = specials.iter().map(|(raw, name)| quote!((#raw, #name)));
    let listed = (!specials.is_empty()).then(|| quote!(.specials(&[#(#rows),*])));
    let absent = has_absent.then(|| quote!(.absent()));
    let lacking = lacking.iter().map(|(model, lack)| quote!((Model::#model as u8, #lack)));
    let lacking = (!signal.lacking.is_empty()).then(|| quote!(.lacking(&[#(#lacking),*])));
    let depends = signal.is_by_model.then(|| quote!(.by_model()));
    quote! {
        Signal::new(#name, #place)
            #(#unit)* #(#scale)* #(#offset)* #(#limits)* #(#model_limits)* #listed #absent #lacking #depends
    }
}

/// Emits the value that stands for a special raw value.
pub fn special_value(Special { constant, comment, value }: &Special, signal: &Signal) -> TokenStream {
    let kind = &signal.member.kind;
    quote!(#comment pub const #constant: #kind = #value;)
}
