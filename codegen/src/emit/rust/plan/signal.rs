//! Signals: their constants, and the members of the structs that carry their values.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::doc::{self, Comment};
use super::encoding::Coding;
use super::literal::decimal;
use super::models::Models;
use super::naming::{Pool, member};
use super::place::Written;
use super::types::Types;
use super::unit::Unit;
use crate::emit::Scaled;
use crate::model::{self, Message, MessageId, NamedValue, Protocol, Range, SignalId, Table};
use crate::syntax::tree::Path;

/// A signal.
pub struct Signal {
    /// Its constant.
    pub constant: Ident,
    /// Comment of the constant.
    pub comment: Comment,
    /// The name in the spec.
    pub name: String,
    /// Where it stands.
    pub place: Written,
    /// Its unit.
    pub unit: Option<&'static str>,
    /// What its encoding is in Rust.
    pub coding: Coding,
    /// Type in which limits are compared, if it is not that of the raw value.
    pub physical: Option<TokenStream>,
    /// Lowest and highest value where no device model is chosen.
    pub limits: Option<[TokenStream; 2]>,
    /// Constant of the limits by device model.
    pub model_limits: Option<Ident>,
    /// Raw values that are legal outside the limits.
    pub specials: Vec<Special>,
    /// Whether the last of them says that there is no value.
    pub has_absent: bool,
    /// The member of structs.
    pub member: Member,
}

/// A raw value that is legal outside the limits.
pub struct Special {
    /// The raw value.
    pub raw: TokenStream,
    /// The name in the spec.
    pub name: String,
    /// Constant of the value that stands for it.
    pub constant: Ident,
    /// Comment of the constant.
    pub comment: Comment,
    /// That value.
    pub value: TokenStream,
}

/// The member of structs that carries a signal's value.
pub struct Member {
    /// Its name.
    pub name: Ident,
    /// Comment of the member.
    pub comment: Comment,
    /// Its type.
    pub kind: TokenStream,
    /// Whether a frame can lack it, because the frame is short or says so.
    pub is_optional: bool,
    /// Whether short frames lack it.
    pub is_at_end: bool,
    /// The signal's method that reads it.
    pub get: Ident,
    /// The signal's method that writes it.
    pub put: Ident,
}

/// The names of a signal.
struct Names {
    constant: Ident,
    field: Ident,
    specials: Vec<Ident>,
}

/// What the signals of a protocol are planned from.
pub struct Context<'a> {
    /// The protocol.
    pub protocol: &'a Protocol,
    /// Types of the module.
    pub types: &'a Types,
    /// Device models.
    pub models: &'a Models,
    /// What scaled values are.
    pub scaled: Scaled,
}

impl Context<'_> {
    /// Plans a message's signals, whose constants are among its members.
    pub fn signals(&self, id: MessageId, members: &mut Pool) -> Table<SignalId, Signal> {
        let (message, mut fields) = (&self.protocol[id], Pool::default());
        let constants = message.signals.map(|known| members.take(known.name.to_ascii_uppercase(), "_SIGNAL"));
        let signals = message.signals.entries().map(|(signal, known)| {
            let (constant, field) = (constants[signal].clone(), fields.take(member(known, self.scaled), "_"));
            let mut named = |special: &NamedValue| {
                let name = format!("{constant}_{}", special.name.to_ascii_uppercase());
                members.take(name, "_VALUE")
            };
            let specials = known.specials.iter().map(&mut named).collect();
            let coding = Coding::new(self.protocol, &self.types.words(id, signal), known, self.scaled);
            self.signal(message, known, Names { constant, field, specials }, coding)
        });
        signals.collect()
    }

    fn signal(
        &self,
        message: &Message,
        signal: &model::Signal,
        Names { constant, field, specials }: Names,
        coding: Coding,
    ) -> Signal {
        let range = signal.hull(self.protocol.models_of(message));
        let range = range.map(|range| coding.limits.range(signal, range));
        let special = |(special, name)| Special::new(name, signal, &coding, special);
        Signal {
            comment: Comment::line(format!(
                "The signal `{}`, to read or write it alone, or to ask for its limits.",
                signal.name
            )),
            name: signal.name.clone(),
            place: Written::new(signal.place),
            unit: signal.unit.map(|unit| unit.symbol),
            physical: coding.physical(),
            limits: range.map(|range| coding.limits.ends(signal, range)),
            model_limits: self.models.limits_of(self.protocol, signal).cloned(),
            specials: signal.specials.iter().zip(specials).map(special).collect(),
            has_absent: signal.has_absent,
            member: self.member(message, signal, field, &coding, range),
            constant,
            coding,
        }
    }

    fn member(
        &self,
        message: &Message,
        signal: &model::Signal,
        name: Ident,
        coding: &Coding,
        range: Option<Range>,
    ) -> Member {
        let is_at_end = message.is_optional(signal);
        let is_optional = is_at_end || signal.has_absent;
        let sentence = self.sentence(message, signal, coding, range);
        let paragraphs = doc::paragraphs(self.protocol, &signal.doc, &sentence, Some(&message.doc));
        let comment = Comment::new(paragraphs.into_iter().chain(type_notes(self.protocol, signal, coding)));
        let [get, put] = coding.methods().map(|name| if is_optional { format_ident!("{name}_some") } else { name });
        Member { name, comment, kind: coding.value(), is_optional, is_at_end, get, put }
    }

    fn sentence(&self, message: &Message, signal: &model::Signal, coding: &Coding, range: Option<Range>) -> String {
        let (title, unit) = (doc::title(&signal.doc, &signal.name), Unit::new(signal, self.scaled).phrase);
        let range = range.map(|range| format!("`{}..={}`", range.minimum, range.maximum));
        let place = Some(Written::new(signal.place).text());
        let optional =
            message.is_optional(signal).then(|| format!("only in frames of {} bytes", least(message, signal)));
        let facts = [place, optional, coding.step.clone(), range, specials(signal)];
        let facts: Vec<_> = facts.into_iter().flatten().collect();
        let models = models(self.protocol, signal);
        format!("{}{models}", doc::sentence_of(&format!("{title}{unit}: {}", facts.join(", "))))
    }
}

impl Special {
    fn new(constant: Ident, known: &model::Signal, coding: &Coding, special: &NamedValue) -> Self {
        Self {
            raw: as_signed(special.raw),
            name: special.name.clone(),
            constant,
            comment: Comment::line(format!("The value of `{}` that stands for `{}`.", known.name, special.name)),
            value: coding.value_of(known, special.raw),
        }
    }
}

/// Writes a raw value as the signed number that has its bits.
fn as_signed(raw: i128) -> TokenStream {
    if i64::try_from(raw).is_ok() {
        return decimal(raw);
    }
    let bits = decimal(raw);
    quote!(u64::cast_signed(#bits))
}

/// Returns the numbers of data bytes with which a message's frame has a signal.
fn least(message: &Message, signal: &model::Signal) -> String {
    let lengths = message.lengths.iter().filter(|length| **length >= signal.end());
    lengths.map(u8::to_string).collect::<Vec<_>>().join(" or ")
}

/// Says that limits depend on the device model, and which models have none.
fn models(protocol: &Protocol, signal: &model::Signal) -> String {
    if signal.model_ranges.is_empty() {
        return String::new();
    }
    let unlimited = protocol.models.entries().filter(|(id, _)| signal.range_for(Some(*id)).is_none());
    let names: Vec<_> = unlimited.map(|(_, model)| format!("`{}`", model.name)).collect();
    let none = if names.is_empty() { String::new() } else { format!(" These have none: {}.", names.join(", ")) };
    format!(" The limits depend on the device model.{none}")
}

fn specials(signal: &model::Signal) -> Option<String> {
    let specials = signal.specials.iter().map(|special| format!("raw {} is `{}`", special.raw, special.name));
    (!signal.specials.is_empty()).then(|| specials.collect::<Vec<_>>().join(", "))
}

/// Returns the notes of a signal's types, except of one that is a type in Rust too.
fn type_notes(protocol: &Protocol, signal: &model::Signal, coding: &Coding) -> impl Iterator<Item = String> {
    let paths = signal.types.iter().map(|name| Path::default().key("types").key(name));
    let others = paths.filter(|path| coding.documented.as_ref() != Some(path));
    let docs = others.filter_map(|path| protocol.types.iter().find(|doc| doc.path == path));
    docs.filter_map(|doc| Some(doc::sentence_of(&doc.note.as_ref()?.in_rust_doc())))
}
