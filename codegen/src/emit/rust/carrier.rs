//! How frames carry a long message in numbered parts.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::plan::carrier::Carrier;
use super::plan::request::Request;

/// Emits what an assembler and a sender need.
pub fn carrier(carrier: &Carrier) -> TokenStream {
    let Carrier { whole, part, number, data, memory, first, parts, others, .. } = carrier;
    let memory = Literal::usize_unsuffixed(*memory);
    let first = first.map(Literal::u16_unsuffixed).map_or_else(|| quote!(None), |first| quote!(Some(#first)));
    let firsts = carrier.model_firsts.iter().map(|(model, first)| {
        let first = Literal::u16_unsuffixed(*first);
        quote!((Model::#model as u8, #first))
    });
    let counter = carrier.counter.iter().map(|counter| {
        quote!(
            const COUNTER: Option<Place> = Some(#part::#counter.place());
        )
    });
    let length = carrier.length.iter().map(|place| {
        quote!(
            const LENGTH: Option<Place> = Some(#place);
        )
    });
    let sizes = carrier.sizes.iter().map(|size| Literal::u16_unsuffixed(*size));
    let sizes = (sizes.len() > 0).then(|| quote!(const SIZES: &'static [usize] = &[#(#sizes),*];));
    let silence = carrier.silence.iter().map(|time| {
        let time = Literal::u32_unsuffixed(*time);
        quote!(
            const SILENCE: Option<u32> = Some(#time);
        )
    });
    let of_models = !carrier.model_firsts.is_empty();
    let of_models = of_models.then(|| quote!(const MODEL_FIRSTS: &'static [(u8, u16)] = &[#(#firsts),*];));
    let continues = carrier.continues;
    let continues = continues.then(|| {
        quote!(
            const CONTINUATION: Option<Continuation> = Some(CONTINUATION);
        )
    });
    let to_module = carrier.to_module.iter().map(|(exchange, kind)| quote!((&#exchange, Kind::#kind)));
    let to_module = (!carrier.to_module.is_empty())
        .then(|| quote!(const TO_MODULE: &'static [(&'static Exchange, Kind)] = &[#(#to_module),*];));
    let counts =
        carrier.counts.iter().map(|(variants, place)| quote!(#(Message::#variants(_))|* => Said::Count(#place),));
    let others = others.iter().map(|others| quote!(#others => Said::Nothing,));
    quote! {
        impl Parted for #whole {
            type Protocol = Message;
            type Part = #part;
            type Memory = [u8; #memory];
            const NUMBER: Place = #part::#number.place();
            const DATA: Place = #data;
            #(#counter)*
            #(#length)*
            #sizes
            #(#silence)*
            const FIRST: Option<u16> = #first;
            #of_models
            #continues
            #to_module
            const SAID: fn(&Message) -> Said = |message| match message {
                #(Message::#parts(_))|* => Said::Part,
                #(#counts)*
                #(#others)*
            };
        }
    }
}

/// Emits the method that builds the frames of a message in parts.
pub fn in_parts(Request { method, comment, exchange, .. }: &Request) -> TokenStream {
    quote! {
        #comment
        pub fn #method(&self, route: impl Into<Route<Target>>) -> Result<parts::Frames<Self>, Error> {
            #exchange.parts_to(route, self)
        }
    }
}
