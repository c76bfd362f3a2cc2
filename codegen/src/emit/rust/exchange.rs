//! How messages travel: each access once, and what each message adds to it.

use proc_macro2::TokenStream;
use quote::quote;

use super::filter::{filter, required};
use super::plan::exchange::{Access, Exchange, SharedFrame};
use crate::model::Who;

/// Emits the part of an access that messages share.
pub fn access(access: &Access) -> TokenStream {
    let Access { constant, comment, name, answers, has_values, member_of, frames, is_from_controller } = access;
    let answers = answers_list(answers);
    let has_values = has_values.then(|| quote!(.with_values()));
    let member_of = member_of.iter().map(|set| quote!(.member_of(#set)));
    let frames = frames.iter().map(|SharedFrame { method, filter: shown, is_accepting }| {
        let filter = filter(shown);
        let accepting = is_accepting.then(|| quote!(.accepting()));
        quote!(.#method(&#filter #accepting))
    });
    let from_controller = is_from_controller.then(|| quote!(.from_controller()));
    quote! {
        #comment
        pub const #constant: Access =
            Access::new(#name, &#answers) #has_values #(#member_of)* #(#frames)* #from_controller;
    }
}

/// Emits how a message travels by one of its accesses.
pub fn exchange(exchange: &Exchange) -> TokenStream {
    let Exchange { constant, comment, shared, message, length, .. } = exchange;
    let required = required(&exchange.required);
    let length = length.iter().map(|length| quote!(.length(#length)));
    let particulars = particulars(exchange).map(|particulars| quote!(.with(&#particulars)));
    quote! {
        #comment
        pub const #constant: Exchange = #shared.of(#message) #required #(#length)* #particulars;
    }
}

/// Emits what only some messages have.
fn particulars(exchange: &Exchange) -> Option<TokenStream> {
    let Exchange { models, .. } = exchange;
    let answers = exchange.answers.as_ref().map(|answers| {
        let list = answers_list(answers);
        quote!(.answers(&#list))
    });
    let models = (!models.is_empty()).then(|| quote!(.models(&[#(Model::#models as u8),*])));
    let sent = sent(exchange).map(|sent| quote!(.sending(&#sent)));
    let refusal = exchange.refusal.as_ref().map(|refusal| {
        let filter = filter(refusal);
        quote!(.refusal(&#filter))
    });
    let particulars: TokenStream = [answers, models, sent, refusal].into_iter().flatten().collect();
    (!particulars.is_empty()).then(|| quote!(Particulars::NOTHING #particulars))
}

/// Emits what frames have that are built, although any is accepted there.
fn sent(Exchange { sends, filled, .. }: &Exchange) -> Option<TokenStream> {
    let ids = sends.iter().map(|(place, value)| quote!(.id(Identifier::#place, #value)));
    let ones = filled.iter().map(|(kind, ones)| quote!(.#kind(#ones)));
    (!(sends.is_empty() && filled.is_empty())).then(|| quote!(Sent::NOTHING #(#ids)* #(#ones)*))
}

/// Writes who answers in each mode.
fn answers_list(answers: &[Option<Who>]) -> TokenStream {
    let answers = answers.iter().map(|who| match who {
        None => quote!(None),
        Some(Who::One) => quote!(Some(Who::One)),
        Some(Who::Each) => quote!(Some(Who::Each)),
        Some(Who::Coordinator) => quote!(Some(Who::Coordinator)),
        Some(Who::Nobody) => quote!(Some(Who::Nobody)),
    });
    quote!([#(#answers),*])
}
