//! One message: its structs, signals, exchanges and requests.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, quote};

use super::derives::Derives;
use super::exchange::exchange;
use super::long::long;
use super::plan::message::{Length, Message, Struct, Within};
use super::plan::signal::{Member, Signal};
use super::request::{request, request_of_model};
use super::scales;
use super::signal::{kinds, special_value, value};

/// Emits every struct of a message.
pub fn message(message: &Message, derives: Derives) -> TokenStream {
    let structs = message.structs.iter().map(|own| {
        let definition = definition(message, own, derives);
        let (constants, layout) = (constants(message, own, derives), layout(message, own));
        let optional = derives.message(&own.name, own.signals.is_empty());
        quote!(#definition #constants #layout #optional)
    });
    let whole = message.long.as_ref().map(|whole| long(message, whole, derives));
    quote!(#whole #(#structs)*)
}

fn definition(message: &Message, own: &Struct, derives: Derives) -> TokenStream {
    let Struct { name, comment, signals, members, is_exact, .. } = own;
    let members = members.iter().map(|ids| member(&message.signals[ids[0]], ids.len(), derives));
    let eq = is_exact.then(|| quote!(, Eq, Hash));
    let body = if signals.is_empty() { quote!(;) } else { quote!({ #(#members),* }) };
    let attributes = derives.structure(&quote!(Clone, Copy, Debug, PartialEq #eq));
    quote!(#comment #attributes pub struct #name #body)
}

fn member(Signal { coding, member, .. }: &Signal, count: usize, derives: Derives) -> TokenStream {
    let Member { name, index, comment, kind, is_optional, .. } = member;
    let float = coding.is_float.then(|| derives.float());
    let kind = if *is_optional { quote!(Option<#kind>) } else { kind.clone() };
    let count = Literal::usize_unsuffixed(count);
    let kind = if index.is_some() { quote!([#kind; #count]) } else { kind };
    quote!(#comment #float pub #name: #kind)
}

fn constants(message: &Message, own: &Struct, derives: Derives) -> TokenStream {
    let Struct { name, is_home, requests, within, .. } = own;
    let signals = message.signals.iter().filter(|_| *is_home).map(|known| signal(known, name));
    let owner = if *is_home { quote!(Self) } else { message.home.to_token_stream() };
    let by_model = own.signals.iter().filter_map(|id| scales::methods(&message.signals[*id], &owner));
    let exchanges = message.exchanges.iter().filter(|_| *name == message.owner).map(exchange);
    let requests = requests.iter().map(|known| request(known, derives));
    let of_model = within.as_ref().map(|Within { requests, .. }| {
        let requests = requests.iter().map(|known| request_of_model(known, derives));
        quote!(impl Within<#name> { #(#requests)* })
    });
    let within = within.as_ref().map(self::within);
    quote!(impl #name { #(#signals)* #(#exchanges)* #within #(#requests)* #(#by_model)* } #of_model)
}

fn signal(signal: &Signal, owner: &Ident) -> TokenStream {
    let Signal { constant, comment, .. } = signal;
    let (kinds, value) = (kinds(signal), value(signal));
    let values = signal.values.iter().map(|special| special_value(special, signal));
    let on_model = scales::on_model(signal, &quote!(#owner::#constant));
    quote!(#comment pub const #constant: Signal<#kinds> = #value; #(#values)* #on_model)
}

/// Emits the method that tests values against a device model.
fn within(Within { exchange, .. }: &Within) -> TokenStream {
    quote! {
        /// Returns the values for a device model. Refuses one that lacks the message, and values outside its limits.
        pub fn within(self, model: Model) -> Result<Within<Self>, Error> {
            #exchange.within(model, &self)?;
            Ok(Within { values: self, model })
        }
    }
}

/// Emits how values are read and written.
fn layout(message: &Message, own: &Struct) -> Option<TokenStream> {
    let Struct { name, is_home, signals, members, lengths, reserved, .. } = own;
    if members.is_empty() {
        return None;
    }
    let home = &message.home;
    let owner = if *is_home { quote!(Self) } else { quote!(#home) };
    let signals: Vec<_> = signals.iter().map(|id| &message.signals[*id]).collect();
    let constants = signals.iter().map(|signal| &signal.constant);
    let reads = members.iter().map(|ids| {
        let elements: Vec<_> = ids.iter().map(|id| &message.signals[*id]).collect();
        let Member { name, index, .. } = &elements[0].member;
        let values = elements.iter().map(|signal| read(signal, &owner));
        if index.is_some() { quote!(#name: [#(#values),*]) } else { quote!(#name: #(#values)*) }
    });
    let values = quote!(Self { #(#reads),* });
    let sized = (!lengths.is_empty()).then(|| sized(lengths, &values));
    let decode = if sized.is_some() { quote!(<Self as Layout>::read_some(data, 8)) } else { values };
    let writes = members.iter().flatten().map(|id| {
        let Signal { constant, member, .. } = &message.signals[*id];
        let (put, value) = (&member.put, member.value());
        quote!(payload.#put(&#owner::#constant, self.#value))
    });
    let end = (!lengths.is_empty()).then(|| end(message, lengths, &owner));
    let on_model = on_model(&signals, &owner);
    let reserved = reserved.as_ref().map(|(comment, bits)| quote!(#comment const RESERVED: Data = #bits;));
    Some(quote! {
        impl Layout for #name {
            const SIGNALS: AnySignals = &[#(&#owner::#constants),*];
            #reserved
            const DECODE: Decode<Self> = |data| #decode;
            #sized
            #on_model
            #[inline(always)]
            fn write_to(&self, payload: &mut Payload) -> bool { #end #(#writes)&&* }
        }
    })
}

/// Emits how the value of a signal is read.
fn read(signal: &Signal, owner: &TokenStream) -> TokenStream {
    let Signal { constant, member: Member { get, is_optional, is_at_end, .. }, .. } = signal;
    let length = match (is_optional, is_at_end) {
        (false, _) => quote!(),
        (true, false) => quote!(, 8),
        (true, true) => quote!(, length),
    };
    quote!(#owner::#constant.#get(data #length))
}

/// Emits how values are read from frames of several lengths.
fn sized(lengths: &[Length], values: &TokenStream) -> TokenStream {
    let bytes = lengths.iter().map(|length| &length.bytes);
    quote! {
        const LENGTHS: &'static [u8] = &[#(#bytes),*];
        #[inline]
        fn read_some(data: &Data, length: usize) -> Self { #values }
    }
}

/// Emits how values are left out that a device model does not have.
fn on_model(signals: &[&Signal], owner: &TokenStream) -> Option<TokenStream> {
    let optional = signals.iter().filter(|signal| signal.is_of_some_models && signal.member.is_optional);
    let cases: Vec<_> = optional
        .map(|Signal { constant, member, .. }| {
            let value = member.value();
            quote!(if #owner::#constant.is_hidden(data, model) { self.#value = None; })
        })
        .collect();
    (!cases.is_empty()).then(|| {
        quote! {
            #[inline]
            fn on_model(mut self, data: &Data, model: Option<u8>) -> Self { #(#cases)* self }
        }
    })
}

/// Emits how long the frame is that has the values which are there.
fn end(message: &Message, lengths: &[Length], owner: &TokenStream) -> TokenStream {
    let (shortest, longer) = (&lengths[0].bytes, &lengths[1..]);
    let cases = longer.iter().map(|Length { bytes, added }| {
        let signals = || added.iter().map(|id| &message.signals[*id]);
        let members = signals().map(|signal| signal.member.value());
        // Nobody sees from its values whether a frame ended before them, or said that there are none.
        let had = signals().all(|signal| signal.has_absent).then(|| quote!(|| payload.had(#bytes)));
        let of_some = signals().filter(|signal| signal.is_of_some_models).map(|signal| &signal.constant);
        let reaches = of_some.map(|constant| quote!(|| payload.reaches(&#owner::#constant, #bytes)));
        quote!(if #(self.#members.is_some())||* #had #(#reaches)* { payload.end_after(#bytes); })
    });
    quote!(payload.end_after(#shortest); #(#cases)*)
}
