//! What several frames carry together: its struct, its signals, and how the joined data are read and written.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::carrier::in_parts;
use super::derives::Derives;
use super::exchange::exchange;
use super::plan::literal::decimal;
use super::plan::long::{Carriage, Field, Length, Long, Row, Step};
use super::plan::message::Message;
use super::plan::signal::Member;
use super::request::request;
use super::scales;
use super::signal::{kinds, special_value, value};
use super::transport::{bare, sent, transferred};

/// The longest array that `serde` knows.
const LONGEST_OF_SERDE: usize = 32;

/// Emits the struct of a long message.
pub fn long(message: &Message, long: &Long, derives: Derives) -> TokenStream {
    let (definition, layout) = (definition(long, derives), (!long.fields.is_empty()).then(|| layout(long)));
    let Long { name, fields, requests, carriage: Carriage { parts, transfer }, .. } = long;
    let exchanges = message.exchanges.iter().filter(|_| *name == message.owner).map(exchange);
    let transfers = transfer.iter().flat_map(|transfer| transfer.requests.iter().map(|own| sent(own, transfer)));
    let bare = transfer.iter().flat_map(|transfer| transfer.bare.iter().map(|own| bare(own, transfer)));
    let transferred = transfer.as_ref().filter(|_| !fields.is_empty()).map(|transfer| transferred(name, transfer));
    let signals = fields.iter().map(|field| signal(field, name));
    let requests = requests.iter().map(|known| request(known, derives));
    let parts = parts.iter().map(in_parts);
    let by_model = fields.iter().filter(|field| field.row.is_none());
    let by_model = by_model.filter_map(|field| scales::methods(&field.signal, &quote!(Self)));
    let optional = if fields.is_empty() { derives.message(name, true) } else { derives.long_message(name) };
    quote! {
        #definition
        impl #name { #(#signals)* #(#exchanges)* #(#requests)* #(#parts)* #(#transfers)* #(#bare)* #(#by_model)* }
        #layout
        #transferred
        #optional
    }
}

fn definition(Long { name, comment, fields, is_exact, .. }: &Long, derives: Derives) -> TokenStream {
    let eq = is_exact.then(|| quote!(, Eq, Hash));
    let attributes = derives.structure(&quote!(Clone, Copy, Debug, PartialEq #eq));
    let members = fields.iter().map(|field| member(field, derives));
    let body = if fields.is_empty() { quote!(;) } else { quote!({ #(#members),* }) };
    quote!(#comment #attributes pub struct #name #body)
}

fn member(Field { signal, row, .. }: &Field, derives: Derives) -> TokenStream {
    let Member { name, comment, kind, is_optional, .. } = &signal.member;
    let kind = if *is_optional { quote!(Option<#kind>) } else { kind.clone() };
    let attribute = match row {
        _ if signal.coding.is_float => Some(derives.float()),
        Some(Row { count, varies: false, .. }) if *count > LONGEST_OF_SERDE => Some(derives.array()),
        _ => None,
    };
    let kind = match row {
        None => kind,
        Some(Row { count, varies, .. }) => {
            let count = Literal::usize_unsuffixed(*count);
            if *varies { quote!(Elements<#kind, #count>) } else { quote!([#kind; #count]) }
        }
    };
    quote!(#comment #attribute pub #name: #kind)
}

fn signal(Field { signal, start, row, run }: &Field, owner: &Ident) -> TokenStream {
    let (constant, comment, start) = (&signal.constant, &signal.comment, Literal::u16_unsuffixed(*start));
    let (kinds, value) = (kinds(signal), value(signal));
    if let Some(run) = run {
        let least = run.varies().then(|| Literal::u16_unsuffixed(run.least)).into_iter();
        return quote! {
            #comment
            pub const #constant: LongText<#kinds> = LongText::new(#start, #value) #(.at_least(#least))*;
        };
    }
    let step = row.as_ref().map(|row| match row.step {
        Step::Bytes(bytes) => {
            let bytes = decimal(bytes);
            quote!(.every(#bytes))
        }
        Step::Bits(bits) => {
            let bits = decimal(bits);
            quote!(.every_bits(#bits))
        }
    });
    let values = signal.values.iter().map(|special| special_value(special, signal));
    let on_model = scales::on_model(signal, &quote!(#owner::#constant.signal()));
    quote! {
        #comment
        pub const #constant: LongSignal<#kinds> = LongSignal::new(#start, #value) #step;
        #(#values)*
        #on_model
    }
}

/// Emits how the joined data are read and written.
fn layout(long: &Long) -> TokenStream {
    let Long { name, message, fields, shortest, longest, .. } = long;
    let blank = long.are_ones.then(|| {
        quote!(
            const BLANK: u8 = 0xFF;
        )
    });
    let end = end(long);
    let [shortest, longest] = [shortest, longest].map(|length| Literal::usize_unsuffixed(*length));
    let varying = long.elements.map(|elements| varying(long, elements));
    let Varying { constants, count } = varying.unwrap_or_default();
    let (on_model, reads) = (on_model(fields), fields.iter().map(read));
    let values = quote!(Self { #(#reads),* });
    let decode = if count.is_empty() { values } else { quote!({ #count #values }) };
    let mut writes: Vec<_> = fields.iter().map(write).collect();
    let last = writes.pop();
    let is_short = writes.is_empty() && end.is_none();
    let encode = if is_short { quote!(#last) } else { quote!({ #end #(#writes?;)* #last }) };
    quote! {
        impl LongLayout for #name {
            const MESSAGE: &'static str = #message;
            const SHORTEST: usize = #shortest;
            const LONGEST: usize = #longest;
            #blank
            #constants
            const DECODE: fn(&[u8]) -> Self = |data| #decode;
            const ENCODE: fn(&Self, &mut LongPayload<'_>) -> Result<(), Error> = |message, payload| #encode;
            #on_model
        }
    }
}

/// What a long message has beside others if arrays of it vary in length.
#[derive(Default)]
struct Varying {
    /// The least and the greatest number of elements, and how many bytes they take.
    constants: TokenStream,
    /// How many elements the data hold.
    count: TokenStream,
}

fn varying(Long { fields, shortest, .. }: &Long, [least, most]: [usize; 2]) -> Varying {
    let arrays = || fields.iter().filter(|field| field.varies());
    let constants: Vec<_> = arrays().map(|field| &field.signal.constant).collect();
    let Some((first, others)) = constants.split_first() else { return Varying::default() };
    let least_bytes = (*shortest > 0).then(|| Literal::usize_unsuffixed(*shortest)).into_iter();
    let [least, most] = [least, most].map(Literal::usize_unsuffixed);
    let is_array = |field: &Field| field.row.is_some();
    let count = arrays().all(is_array).then(|| {
        quote! {
            let count = Self::#first.fitting(data.len()) #(.min(Self::#others.fitting(data.len())))*;
        }
    });
    Varying {
        constants: quote! {
            const ELEMENTS: Option<(usize, usize)> = Some((#least, #most));
            const BYTES: fn(usize) -> usize = |elements|
                Self::#first.reach(elements) #(.max(Self::#others.reach(elements)))* #(.max(#least_bytes))*;
        },
        count: count.unwrap_or_default(),
    }
}

/// Emits how a field is read.
fn read(Field { signal, row, run, .. }: &Field) -> TokenStream {
    let (constant, Member { name, get, is_optional, is_at_end, .. }) = (&signal.constant, &signal.member);
    if run.is_some() {
        let method = if *is_at_end { quote!(read_optional) } else { quote!(read) };
        return quote!(#name: Self::#constant.#method(data));
    }
    if *is_at_end {
        let method = if row.is_some() { quote!(read_optional_array) } else { quote!(read_optional) };
        return quote!(#name: Self::#constant.#method(data, Signal::#get));
    }
    // All eight bytes are there, so only the value can be missing.
    let get = if *is_optional { quote!(|signal, data| signal.#get(data, 8)) } else { quote!(Signal::#get) };
    let value = match row {
        None => quote!(read(data, #get)),
        Some(Row { varies: false, .. }) => quote!(read_array(data, #get)),
        Some(Row { varies: true, .. }) => quote!(read_some(data, count, #get)),
    };
    quote!(#name: Self::#constant.#value)
}

/// Emits how values are left out that a device model does not have.
fn on_model(fields: &[Field]) -> Option<TokenStream> {
    let optional = fields.iter().filter(|field| field.signal.is_of_some_models && field.signal.member.is_optional);
    let cases = optional.map(|Field { signal, row, .. }| {
        let (constant, name) = (&signal.constant, &signal.member.name);
        let hide = if row.is_some() { quote!(hide_all) } else { quote!(hide) };
        quote!(Self::#constant.#hide(&mut self.#name, data, model);)
    });
    let cases: Vec<_> = cases.collect();
    (!cases.is_empty())
        .then(|| quote!(fn on_model(mut self, data: &[u8], model: Option<u8>) -> Self { #(#cases)* self }))
}

/// Emits how a field is written.
fn write(Field { signal, row, run, .. }: &Field) -> TokenStream {
    let (constant, Member { name, put, is_at_end, .. }) = (&signal.constant, &signal.member);
    if run.is_some() {
        let method = if *is_at_end { quote!(write_optional) } else { quote!(write) };
        return quote!(Self::#constant.#method(&message.#name, payload));
    }
    match row {
        None => quote!(Self::#constant.write(message.#name, payload, Signal::#put)),
        Some(Row { varies: true, .. }) => quote!(Self::#constant.write_some(&message.#name, payload, Signal::#put)),
        Some(Row { varies: false, .. }) => quote!(Self::#constant.write_all(&message.#name, payload, Signal::#put)),
    }
}

/// Emits how long the message is that has the values which are there.
fn end(Long { fields, shortest, lengths, .. }: &Long) -> Option<TokenStream> {
    let cases = lengths.iter().filter(|length| !length.added.is_empty()).map(|Length { bytes, added }| {
        let bytes = Literal::usize_unsuffixed(*bytes);
        let members = added.iter().map(|(field, index)| {
            let (name, index) = (&fields[*field].signal.member.name, index.map(Literal::usize_unsuffixed).into_iter());
            quote!(message.#name #([#index])*)
        });
        let mut of_some: Vec<_> = added.iter().map(|(field, _)| *field).collect();
        of_some.dedup();
        let of_some = of_some.into_iter().map(|field| &fields[field]).filter(|field| field.signal.is_of_some_models);
        let reaches = of_some.map(|Field { signal, run, .. }| {
            let (constant, known) = (&signal.constant, if run.is_some() { quote!(byte) } else { quote!(signal) });
            quote!(|| payload.reaches(Self::#constant.#known()))
        });
        quote!(if #(#members.is_some())||* #(#reaches)* { payload.end_after(#bytes); })
    });
    let shortest = Literal::usize_unsuffixed(*shortest);
    (!lengths.is_empty()).then(|| quote!(payload.end_after(#shortest); #(#cases)*))
}
