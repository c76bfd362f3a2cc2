//! The methods that build requests.

use proc_macro2::TokenStream;
use quote::quote;

use super::derives::Derives;
use super::plan::request::Request;

/// Emits the method that builds a request.
pub fn request(known: &Request, derives: Derives) -> TokenStream {
    let Request { method, comment, exchange, reply, carries } = known;
    let (inlined, request_to) = (derives.inlined(), derives.request_to());
    let (receiver, content) = if *carries { (quote!(&self,), quote!(self)) } else { (quote!(), quote!(&())) };
    quote! {
        #comment
        #inlined
        pub fn #method(#receiver route: impl Into<Route<Target>>) -> Result<Request<#reply>, Error> {
            #exchange.#request_to(route, #content)
        }
    }
}

/// Emits the method that builds a request to a device model.
pub fn request_of_model(Request { method, comment, exchange, reply, .. }: &Request, derives: Derives) -> TokenStream {
    let (inlined, request_within) = (derives.inlined(), derives.request_within());
    quote! {
        #comment
        #inlined
        pub fn #method(&self, route: impl Into<Route<Target>>) -> Result<Request<#reply>, Error> {
            #exchange.#request_within(self.model, route, &self.values)
        }
    }
}
