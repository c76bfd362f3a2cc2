//! Methods that read and set a number whose scale depends on the device model.

use indexmap::IndexMap;
use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::plan::scales::{Row, Scales};
use super::plan::signal::Signal;

/// Emits the method that returns the signal of a device model. It stands beside the constant of the signal, which `any`
/// returns.
pub fn on_model(signal: &Signal, any: &TokenStream) -> Option<TokenStream> {
    let Signal { coding, name, scales, .. } = signal;
    let Scales { on, kind, rows, has_others, .. } = scales.as_ref()?;
    let raw = &coding.raw;
    let scaled = |Row { unit, scale, offset, limits, .. }: &Row| {
        let unit = unit.iter().map(|unit| quote!(.unit(#unit)));
        let scale = scale.iter().map(|[numerator, denominator]| quote!(.scale(#numerator, #denominator)));
        let offset = offset.iter().map(|[above, below]| quote!(.offset(#above, #below)));
        let limits = limits.iter().map(|[minimum, maximum]| quote!(.limits(#minimum, #maximum)));
        quote!(#any.on_model() #(#unit)* #(#scale)* #(#offset)* #(#limits)*)
    };
    // Models with the same signal share an arm.
    let mut groups: IndexMap<String, (Vec<&Ident>, TokenStream)> = IndexMap::new();
    for row in rows {
        let scaled = scaled(row);
        groups.entry(scaled.to_string()).or_insert_with(|| (Vec::new(), scaled)).0.push(&row.model);
    }
    let arms = groups.values().map(|(models, scaled)| {
        quote! {
            #(Model::#models)|* => {
                const SIGNAL: Signal<#raw, #kind> = #scaled;
                Some(&SIGNAL)
            }
        }
    });
    let others = has_others.then(|| quote!(_ => None,));
    let comment = format!(" Returns the signal `{name}` of a device model; `None` of a model without a scale.");
    Some(quote! {
        #[doc = #comment]
        #[must_use]
        pub const fn #on(model: Model) -> Option<&'static Signal<#raw, #kind>> {
            match model { #(#arms)* #others }
        }
    })
}

/// Emits the methods of a struct that read and set the value. `owner` has the method for the device model.
pub fn methods(signal: &Signal, owner: &TokenStream) -> Option<TokenStream> {
    let Signal { name, constant, member, scales, .. } = signal;
    let Scales { on, get, set, message, kind, .. } = scales.as_ref()?;
    let value = member.value();
    let raw = if member.is_optional { quote!(self.#value?) } else { quote!(self.#value) };
    let given = quote!(signal.raw_of(value, #message)?);
    let given = if member.is_optional { quote!(Some(#given)) } else { given };
    let reads = format!(" Returns the number that `{name}` is on a device model; `None` if it is none.");
    let sets = format!(
        " Sets `{name}` to a number of a device model. Refuses one without a scale, and values outside its limits."
    );
    Some(quote! {
        #[doc = #reads]
        #[must_use]
        pub fn #get(&self, model: Model) -> Option<#kind> {
            #owner::#on(model)?.physical_of(#raw)
        }

        #[doc = #sets]
        pub fn #set(&mut self, model: Model, value: #kind) -> Result<(), Error> {
            let signal = #owner::#on(model).ok_or(#owner::#constant.without_scale(#message))?;
            self.#value = #given;
            Ok(())
        }
    })
}
