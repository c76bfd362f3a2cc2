//! How identifiers show who sends a frame and whom it reaches.

use indexmap::IndexMap;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::pattern::address;
use super::plan::address::{Number, Pattern};
use super::plan::way::{Route, Shown, Way};
use crate::model::{Id, ModeId};

/// Emits the function that finds the way by which a frame travels, if there are addressing modes.
pub fn way(ways: &[Way]) -> Option<TokenStream> {
    let fits = ways.iter().map(|Way { mode, who, pattern: Pattern { constants, addresses }, .. }| {
        let mode = Literal::usize_unsuffixed(mode.place());
        let start = who.as_ref().map_or_else(|| quote!(request(#mode)), |who| quote!(reply(#mode, Who::#who)));
        let constants = constants.iter().map(|(place, value)| quote!(.id(Identifier::#place, #value)));
        let addresses = addresses.iter().map(address);
        quote!(shown.#start #(#constants)* #(.address(&#addresses))*)
    });
    (!ways.is_empty()).then(|| quote!(fn way(shown: &Shown) -> Option<Way> { Way::best([#(#fits),*]) }))
}

/// Emits the function that finds the module that sends a frame or is asked, if identifiers show modules.
pub fn node(ways: &[Way]) -> Option<TokenStream> {
    let nodes = ways.iter().filter_map(|way| Some((way, number(way.node.as_ref()?))));
    let arms = arms(nodes)?;
    Some(quote! {
        fn node(way: &Way) -> Option<i32> {
            Some(match way.place() { #arms })
        }
    })
}

/// Emits the function that finds the route of a request.
pub fn route(ways: &[Way]) -> TokenStream {
    let routes = ways.iter().filter_map(|way| Some((way, shown(way.route.as_ref()?))));
    let arms = arms(routes).unwrap_or_default();
    quote! {
        fn shown(way: &Way) -> Option<Route<Self>> {
            Some(match way.place() { #arms })
        }
    }
}

/// Writes a route as an identifier shows it.
fn shown(Route { variant, target, sender }: &Route) -> TokenStream {
    let target = target.as_ref().map(|(target, kind)| {
        let number = number(target);
        if *kind == Number::I32 { quote!((#number)) } else { quote!((#number.try_into().ok()?)) }
    });
    let sender = sender.as_ref().map(number);
    sender.map_or_else(
        || quote!(Self::#variant #target.into()),
        |sender| quote!(Route::new(Self::#variant #target, #sender)),
    )
}

fn number(Shown { place, kind }: &Shown) -> TokenStream {
    quote!(way.number(Identifier::#place, &#kind))
}

/// Writes the arms of a match over the ways; those with the same value are one.
fn arms<'a>(values: impl Iterator<Item = (&'a Way, TokenStream)>) -> Option<TokenStream> {
    let mut arms: IndexMap<String, (TokenStream, Vec<&Way>)> = IndexMap::new();
    for (way, value) in values {
        arms.entry(value.to_string()).or_insert_with(|| (value, Vec::new())).1.push(way);
    }
    let (values, ways): (Vec<_>, Vec<_>) = arms.into_values().unzip();
    let places = ways.iter().map(|ways| places(ways));
    (!values.is_empty()).then(|| quote!(#(#places => #values,)* _ => return None))
}

/// Writes a pattern of some ways; those of modes with the same senders are one.
fn places(ways: &[&Way]) -> TokenStream {
    let mut senders: IndexMap<ModeId, Vec<&Option<Ident>>> = IndexMap::new();
    for way in ways {
        senders.entry(way.mode).or_default().push(&way.who);
    }
    let mut modes: IndexMap<Vec<&Option<Ident>>, Vec<Literal>> = IndexMap::new();
    for (mode, senders) in senders {
        modes.entry(senders).or_default().push(Literal::usize_unsuffixed(mode.place()));
    }
    let places = modes.iter().map(|(senders, modes)| {
        let (to_module, known) = (senders.iter().filter(|who| who.is_none()), senders.iter().copied().flatten());
        let (to_module, known): (Vec<_>, Vec<_>) = (to_module.map(|_| quote!(None)).collect(), known.collect());
        let to_controller = (!known.is_empty()).then(|| quote!(Some(#(Who::#known)|*)));
        let senders = to_module.into_iter().chain(to_controller);
        quote!((#(#modes)|*, #(#senders)|*))
    });
    quote!(#(#places)|*)
}
