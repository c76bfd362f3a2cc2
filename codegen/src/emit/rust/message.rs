//! One message: its structs, signals, exchanges and requests.

use canspec_runtime::Data;
use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::derives::Derives;
use super::doc;
use super::exchange::{exchange, modes, shared_name};
use super::literal::{data, decimal, ends, physical, physical_type};
use super::model::{depends_on_model, model_limits};
use super::names::{MessageNames, Names, Struct};
use super::place::Written;
use super::word::{integer, text_type};
use crate::emit::Float;
use crate::model::{Encoding, FrameLayout, Kind, Message, NamedValue, Protocol, Range, Signal, SignalId};
use crate::number::Rational;
use crate::syntax::tree::Path;

/// A message on its way into Rust.
pub struct Emitter<'a> {
    pub protocol: &'a Protocol,
    pub all: &'a Names,
    pub names: &'a MessageNames,
    pub message: &'a Message,
    pub derives: Derives<'a>,
    pub float: Float,
}

impl Emitter<'_> {
    /// Emits every struct of the message.
    pub fn items(&self) -> TokenStream {
        let structs = self.names.structs.iter().enumerate();
        let structs = structs.map(|(index, known)| {
            let (definition, constants, layout) =
                (self.definition(known), self.constants(index, known), self.layout(known));
            let optional = self.derives.message(&known.name, known.signals.is_empty());
            quote!(#definition #constants #layout #optional)
        });
        quote!(#(#structs)*)
    }

    fn home(&self) -> &Ident {
        &self.names.structs[0].name
    }

    pub fn sentence(&self) -> String {
        let Message { name, doc, .. } = self.message;
        doc::sentence_of(&doc::title(doc, name))
    }

    fn definition(&self, known: &Struct) -> TokenStream {
        let comment = doc::item(self.protocol, &self.message.doc, &self.sentence(), None);
        let name = &known.name;
        let members = known.signals.iter().map(|id| self.member(*id));
        let exact = known.signals.iter().all(|id| is_exact(&self.message[*id]));
        let eq = exact.then(|| quote!(, Eq, Hash));
        let body = if known.signals.is_empty() { quote!(;) } else { quote!({ #(#members),* }) };
        let optional = self.derives.structure();
        quote!(#comment #[derive(Clone, Copy, Debug, PartialEq #eq)] #optional pub struct #name #body)
    }

    fn member(&self, id: SignalId) -> TokenStream {
        let signal = &self.message[id];
        let (name, kind) = (&self.names.fields[id], self.field_type(id));
        let paragraphs =
            doc::paragraphs(self.protocol, &signal.doc, &self.member_sentence(signal), Some(&self.message.doc));
        let comment = doc::comment(paragraphs.into_iter().chain(self.type_notes(signal)));
        let float = matches!(signal.encoding, Encoding::Float).then(|| self.derives.float());
        quote!(#comment #float pub #name: #kind)
    }

    /// Returns the notes of a signal's types, except of one that is a type in Rust too.
    fn type_notes(&self, signal: &Signal) -> impl Iterator<Item = String> {
        let in_rust = match &signal.encoding {
            Encoding::Named(known) => Some(&self.protocol[*known].doc.path),
            Encoding::Status(known) => Some(&self.protocol[*known].doc.path),
            Encoding::Number { .. } | Encoding::Float | Encoding::Text | Encoding::Packed { .. } => None,
        };
        let paths = signal.types.iter().map(|name| Path::default().key("types").key(name));
        let others = paths.filter(move |path| in_rust != Some(path));
        let docs = others.filter_map(|path| self.protocol.types.iter().find(|doc| doc.path == path));
        docs.filter_map(|doc| Some(doc::sentence_of(&doc::plain(doc.note.as_ref()?))))
    }

    fn member_sentence(&self, signal: &Signal) -> String {
        let title = doc::title(&signal.doc, &signal.name);
        let unit = signal.unit.map_or_else(String::new, |unit| format!(" in {}", unit.symbol));
        let range = self.range(signal).map(|range| format!("`{}..={}`", range.minimum, range.maximum));
        let facts = [Some(Written::new(signal.place).text()), step(signal), range, specials(signal)];
        let facts: Vec<_> = facts.into_iter().flatten().collect();
        let depends = !signal.model_ranges.is_empty();
        let model = if depends { " The limits depend on the device model." } else { "" };
        format!("{}{model}", doc::sentence_of(&format!("{title}{unit}: {}", facts.join(", "))))
    }

    fn field_type(&self, id: SignalId) -> TokenStream {
        if is_scaled(&self.message[id]) { physical_type(self.float) } else { self.raw_type(id) }
    }

    fn raw_type(&self, id: SignalId) -> TokenStream {
        let signal = &self.message[id];
        let width = signal.place.width();
        let name = match &signal.encoding {
            Encoding::Number { signed, .. } => return integer(width, *signed),
            Encoding::Float => return quote!(f32),
            Encoding::Text => return text_type(width),
            Encoding::Named(known) => Some(&self.all.enumerations[*known]),
            Encoding::Status(known) => Some(&self.all.status_words[*known]),
            Encoding::Packed { .. } => self.names.packed[id].as_ref(),
        };
        quote!(#name)
    }

    fn constants(&self, index: usize, known: &Struct) -> TokenStream {
        let name = &known.name;
        let is_home = index == 0;
        let signals = self.message.signals.ids().filter(|_| is_home).map(|id| self.signal(id));
        let reserved = self.reserved(known);
        let exchanges = self.message.exchanges.ids().filter(|_| is_home);
        let exchanges =
            exchanges.map(|id| exchange(self.protocol, self.all, self.message, &self.names.exchanges[id], id));
        let requests = self.requests().filter(|frame| frame.set.is_none() && self.host(frame) == name);
        let requests: Vec<_> = requests.collect();
        let methods = requests.iter().map(|frame| self.method(frame));
        let dependent = requests.iter().filter(|frame| depends_on_model(self.protocol, frame));
        let dependent: Vec<_> = dependent.copied().collect();
        let within = dependent.first().map(|frame| self.within(frame));
        let of_model = within.as_ref().map(|_| {
            let methods = dependent.iter().map(|frame| self.method_of_model(frame));
            quote!(impl Within<#name> { #(#methods)* })
        });
        quote!(impl #name { #(#signals)* #reserved #(#exchanges)* #within #(#methods)* } #of_model)
    }

    /// Returns the requests of the message.
    pub fn requests(&self) -> impl Iterator<Item = &FrameLayout> {
        self.protocol.frames_of(self.message).filter(|frame| frame.kind == Kind::Request)
    }

    /// Emits the method that tests values against a device model.
    fn within(&self, frame: &FrameLayout) -> TokenStream {
        let exchange = self.exchange_path(frame);
        quote! {
            /// Returns the values for a device model if it takes them.
            ///
            /// # Errors
            ///
            /// Refuses a model that does not have the message, and values outside its limits.
            pub fn within(self, model: Model) -> Result<Within<Self>, Error> {
                #exchange.within(model, &self)?;
                Ok(Within { values: self, model })
            }
        }
    }

    /// Emits the method that builds a request to a device model.
    fn method_of_model(&self, frame: &FrameLayout) -> TokenStream {
        let (method, exchange) = (&self.names.methods[frame.exchange], &self.names.exchanges[frame.exchange]);
        let home = self.home();
        let reply = self.reply(frame).map_or_else(|| quote!(()), |name| quote!(#name));
        let comment = doc::comment(self.method_comment(frame, " with these values", ""));
        quote! {
            #comment
            pub fn #method(&self, route: impl Into<Route<Target>>) -> Result<Request<#reply>, Error> {
                #home::#exchange.request_within(self.model, route, &self.values)
            }
        }
    }

    /// Returns the struct that the reply carries.
    fn reply(&self, frame: &FrameLayout) -> Option<&Ident> {
        let mut others = self.protocol.frames_of(self.message).filter(|other| other.exchange == frame.exchange);
        let reply = others.find(|other| other.kind == Kind::Reply);
        reply.and_then(|reply| self.names.carried(reply)).map(|known| &known.name)
    }

    /// Returns the limits where no device model is chosen.
    fn range(&self, signal: &Signal) -> Option<Range> {
        signal.hull(self.protocol.models_of(self.message))
    }

    /// Returns the path to the exchange by which a kind of frame travels, from the struct that hosts its method.
    fn exchange_path(&self, frame: &FrameLayout) -> TokenStream {
        let (exchange, home) = (&self.names.exchanges[frame.exchange], self.home());
        if self.host(frame) == home { quote!(Self::#exchange) } else { quote!(#home::#exchange) }
    }

    /// Returns the struct that has the method which builds a request.
    fn host(&self, frame: &FrameLayout) -> &Ident {
        self.names.carried(frame).map_or_else(|| self.home(), |known| &known.name)
    }

    fn signal(&self, id: SignalId) -> TokenStream {
        let signal = &self.message[id];
        let (name, raw) = (&self.names.constants[id], self.raw_type(id));
        let (text, place) = (&signal.name, Written::new(signal.place).expression());
        let comment = doc::line(format!("The signal `{text}`."));
        let refinements = [
            unit(signal),
            scale(signal),
            self.range(signal).map(|range| limits(range, whole(signal).is_some(), self.float)),
            model_limits(self.protocol, self.all, signal),
            special_list(signal),
        ];
        let refinements = refinements.into_iter().flatten();
        let values = signal.specials.iter().map(|special| self.special(id, special));
        let physical = calculated(signal, self.float).map(|kind| quote!(, #kind));
        quote!(#comment pub const #name: Signal<#raw #physical> = Signal::new(#text, #place) #(#refinements)*; #(#values)*)
    }

    /// Emits the physical value that stands for a special raw value.
    fn special(&self, id: SignalId, special: &NamedValue) -> TokenStream {
        let signal = &self.message[id];
        let name = quote::format_ident!("{}_{}", self.names.constants[id], special.name.to_ascii_uppercase());
        let kind = self.field_type(id);
        let comment = doc::line(format!("The value of `{}` that stands for `{}`.", signal.name, special.name));
        let value = match &signal.encoding {
            encoding if is_scaled(signal) => {
                physical(encoding.value_of(special.raw).unwrap_or(Rational::ZERO), self.float)
            }
            _ => decimal(special.raw),
        };
        quote!(#comment pub const #name: #kind = #value;)
    }

    fn reserved(&self, known: &Struct) -> Option<TokenStream> {
        let frame = self.protocol.frames_of(self.message).find(|frame| frame.signals == known.signals)?;
        let reserved = data(reserved(frame));
        let comment = doc::line("The bits that the document reserves.");
        (!known.signals.is_empty()).then(|| quote!(#comment pub const RESERVED: Data = #reserved;))
    }

    /// Emits the method that builds a request.
    pub fn method(&self, frame: &FrameLayout) -> TokenStream {
        let (method, exchange) = (&self.names.methods[frame.exchange], self.exchange_path(frame));
        let reply = match self.reply(frame) {
            None => quote!(()),
            Some(name) if name == self.host(frame) => quote!(Self),
            Some(name) => quote!(#name),
        };
        let carries = self.names.carried(frame).is_some();
        let (values, refused) =
            if carries { (" with these values", "values outside their limits, ") } else { ("", "") };
        let comment = doc::comment(self.method_comment(frame, values, refused));
        let (receiver, content) = if carries { (Some(quote!(&self,)), quote!(self)) } else { (None, quote!(&())) };
        quote! {
            #comment
            pub fn #method(#receiver route: impl Into<Route<Target>>) -> Result<Request<#reply>, Error> {
                #exchange.request_to(route, #content)
            }
        }
    }

    /// Describes a method; what holds for all messages stands at the access.
    fn method_comment(&self, frame: &FrameLayout, values: &str, refused: &str) -> Vec<String> {
        let own = &self.message[frame.exchange];
        let access = &self.protocol[frame.access];
        let shared = shared_name(self.protocol, self.all, self.message, frame.exchange);
        let shared = shared.map_or_else(String::new, |shared| format!("({shared})"));
        let first = format!("Builds the request [`{}`]{shared}{values}.", access.name);
        let modes = (own.answers != access.answers).then(|| modes(self.protocol, &own.answers));
        let errors = format!("Refuses {refused}other addressing modes, and undocumented addresses.");
        std::iter::once(first).chain(modes).chain(["# Errors".to_owned(), errors]).collect()
    }

    /// Emits how values are read and written.
    fn layout(&self, known: &Struct) -> Option<TokenStream> {
        let (name, home) = (&known.name, self.home());
        let owner = if name == home { quote!(Self) } else { quote!(#home) };
        let constants: Vec<_> = known.signals.iter().map(|id| &self.names.constants[*id]).collect();
        let fields: Vec<_> = known.signals.iter().map(|id| &self.names.fields[*id]).collect();
        let verbs = known.signals.iter().map(|id| is_scaled(&self.message[*id]));
        let (get, put): (Vec<_>, Vec<_>) = verbs
            .map(|scaled| if scaled { (quote!(decode), quote!(encode)) } else { (quote!(get), quote!(put)) })
            .unzip();
        let decode = quote!(Self { #(#fields: #owner::#constants.#get(data)),* });
        let writes = constants.iter().zip(&fields).zip(&put);
        let writes = writes.map(|((constant, field), put)| quote!(#owner::#constant.#put(message.#field, payload)));
        let writes: Vec<_> = writes.collect();
        let (last, others) = writes.split_last()?;
        let encode = if others.is_empty() { quote!(#last) } else { quote!({ #(#others?;)* #last }) };
        Some(quote! {
            impl Layout for #name {
                const SIGNALS: &'static [&'static dyn AnySignal] = &[#(&#owner::#constants),*];
                const DECODE: Decode<Self> = |data| #decode;
                const ENCODE: Encode<Self> = |message, payload| #encode;
            }
        })
    }
}

/// Tests whether equality of physical values is exact.
pub fn is_exact(signal: &Signal) -> bool {
    !matches!(signal.encoding, Encoding::Float) && !is_scaled(signal)
}

fn is_scaled(signal: &Signal) -> bool {
    matches!(signal.encoding, Encoding::Number { .. }) && !signal.encoding.is_unscaled()
}

fn unit(signal: &Signal) -> Option<TokenStream> {
    let symbol = signal.unit?.symbol;
    Some(quote!(.unit(#symbol)))
}

fn scale(signal: &Signal) -> Option<TokenStream> {
    let Encoding::Number { scale, offset, .. } = &signal.encoding else { return None };
    let [numerator, denominator, above, below] =
        [scale.numerator(), scale.denominator(), offset.numerator(), offset.denominator()].map(decimal);
    let offset = (*offset != Rational::ZERO).then(|| quote!(.offset(#above, #below)));
    let scale = (*scale != Rational::ONE).then(|| quote!(.scale(#numerator, #denominator)));
    Some(quote!(#scale #offset))
}

/// Returns the type of physical values and limits where it is not that of the raw values: of scaled numbers, of floats with
/// limits in double precision, and of integers whose limits have a fraction.
fn calculated(signal: &Signal, float: Float) -> Option<TokenStream> {
    let is_calculated = match signal.encoding {
        Encoding::Number { .. } => whole(signal).is_none(),
        Encoding::Float => float == Float::F64 && signal.ranges().next().is_some(),
        Encoding::Text | Encoding::Named(_) | Encoding::Status(_) | Encoding::Packed { .. } => false,
    };
    is_calculated.then(|| physical_type(float))
}

/// Returns the type of a number that is a raw integer, and its limits too.
pub fn whole(signal: &Signal) -> Option<TokenStream> {
    let Encoding::Number { signed, .. } = signal.encoding else { return None };
    let is_whole = signal.encoding.is_unscaled() && signal.has_whole_limits();
    is_whole.then(|| integer(signal.place.width(), signed))
}

fn limits(range: Range, is_whole: bool, float: Float) -> TokenStream {
    let [minimum, maximum] = ends(range, is_whole, float);
    quote!(.limits(#minimum, #maximum))
}

fn special_list(signal: &Signal) -> Option<TokenStream> {
    let specials = signal.specials.iter().map(|special| {
        let (raw, name) = (decimal(special.raw), &special.name);
        quote!((#raw, #name))
    });
    (!signal.specials.is_empty()).then(|| quote!(.specials(&[#(#specials),*])))
}

fn step(signal: &Signal) -> Option<String> {
    let Encoding::Number { scale, offset, .. } = &signal.encoding else { return None };
    let unit = signal.unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol));
    let step = (*scale != Rational::ONE).then(|| format!("steps of {scale}{unit}"));
    let offset = (*offset != Rational::ZERO).then(|| format!("raw 0 is {offset}{unit}"));
    let facts: Vec<_> = step.into_iter().chain(offset).collect();
    (!facts.is_empty()).then(|| facts.join(", "))
}

fn specials(signal: &Signal) -> Option<String> {
    let specials = signal.specials.iter().map(|special| format!("raw {} is `{}`", special.raw, special.name));
    (!signal.specials.is_empty()).then(|| specials.collect::<Vec<_>>().join(", "))
}

/// Returns the bits of the data that neither signals nor selectors cover.
fn reserved(frame: &FrameLayout) -> Data {
    let present = u64::MAX.checked_shl(64 - 8 * u32::from(frame.length)).unwrap_or(0);
    (!frame.covered & present).to_be_bytes()
}
