//! Where quantities are read and set.

use proc_macro2::TokenStream;
use quote::quote;

use super::plan::quantity::{Quantities, Read, Set, States, Value, ValueKind};
use crate::model::OutOfRange;

/// Emits where quantities are read and set.
pub fn quantities(Quantities { reads, sets }: &Quantities) -> TokenStream {
    let (reads, sets) = (reads.iter().map(read), sets.iter().map(set));
    quote! {
        impl Quantities for Message {
            const READS: &'static [ReadPath] = &[#(#reads),*];
            const SETS: &'static [SetPath] = &[#(#sets),*];
        }
    }
}

fn read(Read { value, frames, request }: &Read) -> TokenStream {
    let frames = frames.iter().map(|(kind, exchange)| quote!((Kind::#kind, #exchange)));
    let path = path(&quote!(ReadPath), value, &quote!(&[#(#frames),*]));
    let asked = request.as_ref().map(|request| quote!(.asked_by(#request)));
    quote!(#path #asked)
}

fn set(Set { value, request, is_echoed, conduct, others }: &Set) -> TokenStream {
    let path = path(&quote!(SetPath), value, request);
    let rows = others.iter().map(|(place, bits)| quote!((#place, #bits)));
    let with = (!others.is_empty()).then(|| quote!(.with(&[#(#rows),*])));
    let echoed = is_echoed.then(|| quote!(.echoed()));
    let limiting = conduct.out_of_range.map(|known| match known {
        OutOfRange::Refused => quote!(.refusing()),
        OutOfRange::Ignored => quote!(.ignoring()),
        OutOfRange::Limited => quote!(.limiting()),
    });
    let keeping = conduct.keeps.map(|keeps| if keeps { quote!(.kept()) } else { quote!(.lost()) });
    quote!(#path #echoed #with #limiting #keeping)
}

fn path(table: &TokenStream, Value { name, unit, kind }: &Value, frames: &TokenStream) -> TokenStream {
    let unit = unit.as_ref().map_or_else(|| quote!(None), |unit| quote!(Some(#unit)));
    match kind {
        ValueKind::Number(signal) => quote!(#table::number(Quantity::new(#name), #unit, #frames, #signal)),
        ValueKind::Switch(States { place, inactive, active }) => {
            quote!(#table::switch(Quantity::new(#name), #frames, States { place: #place, inactive: #inactive, active: #active }))
        }
    }
}
