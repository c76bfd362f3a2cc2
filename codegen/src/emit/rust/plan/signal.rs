//! Signals: their constants, and the members of the structs that carry their values.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::doc::{self, Comment};
use super::encoding::{Coding, WordTypes};
use super::literal::{decimal, hexadecimal};
use super::models::Models;
use super::naming::{Pool, member};
use super::place::Written;
use super::scales::Scales;
use super::types::Types;
use super::unit::Unit;
use crate::emit::Scaled;
use crate::model::keywords::{OUT_OF_RANGE, POWER_OFF};
use crate::model::{
    self, Array, Conduct, Lacking, LongMessage, Message, MessageId, NamedValue, Parts, Protocol, Range, SignalId, Table,
};
use crate::report::tree::Path;

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
    pub unit: Option<String>,
    /// What its encoding is in Rust.
    pub coding: Coding,
    /// Type in which limits are compared, if it is not that of the raw value.
    pub physical: Option<TokenStream>,
    /// Lowest and highest value where no device model is chosen.
    pub limits: Option<[TokenStream; 2]>,
    /// Constant of the limits by device model.
    pub model_limits: Option<Ident>,
    /// Raw values that are legal outside the limits, with their names in the spec.
    pub specials: Vec<(TokenStream, String)>,
    /// Whether the last of them says that there is no value.
    pub has_absent: bool,
    /// What device models do not have: variant of the model, and bits or a value.
    pub lacking: Vec<(Ident, TokenStream)>,
    /// Whether some device models do not have it at all.
    pub is_of_some_models: bool,
    /// Whether its scale depends on the device model.
    pub is_by_model: bool,
    /// The methods for device models, if its scale depends on the model.
    pub scales: Option<Scales>,
    /// The constants of the others. Those of an array are with its first element.
    pub values: Vec<Special>,
    /// The member of structs.
    pub member: Member,
}

/// The value that stands for a raw value outside the limits.
pub struct Special {
    /// Its constant.
    pub constant: Ident,
    /// Comment of the constant.
    pub comment: Comment,
    /// The value.
    pub value: TokenStream,
}

/// The member of structs that carries a signal's value, alone or as an element of an array.
pub struct Member {
    /// Its name.
    pub name: Ident,
    /// Which element of the member the value is, if the member is an array.
    pub index: Option<Literal>,
    /// Comment of the member.
    pub comment: Comment,
    /// Type of the value.
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

impl Member {
    /// Writes where a struct has the value.
    pub fn value(&self) -> TokenStream {
        let (name, index) = (&self.name, self.index.iter());
        quote!(#name #([#index])*)
    }
}

/// The names of a signal.
struct Names {
    constant: Ident,
    field: Ident,
    /// Those of its special values.
    values: Vec<Ident>,
}

/// What carries signals, and the numbers of data bytes that it can have.
struct Content<'a> {
    message: &'a Message,
    /// The least first.
    lengths: Vec<usize>,
    /// What it is in texts.
    carriers: &'static str,
}

impl<'a> Content<'a> {
    fn of_frames(message: &'a Message) -> Self {
        let lengths = message.lengths.iter().map(|length| usize::from(*length)).collect();
        Self { message, lengths, carriers: "frames" }
    }

    fn of_long(long: &'a LongMessage) -> Self {
        let lengths = long.lengths.iter().map(|length| usize::from(*length)).collect();
        Self { message: &long.content, lengths, carriers: "messages" }
    }

    /// Tests whether it can lack a signal because it is short.
    fn lacks(&self, signal: &model::Signal) -> bool {
        self.lengths.first().is_some_and(|shortest| signal.reach() > *shortest)
    }
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
        let constants = message.signals.map(|known| constant(&known.name, members));
        let of_array = |array: &Array, fields: &mut Pool| fields.take(self.name(message, array.elements[0]), "_");
        let arrays = message.arrays.map(|array| of_array(array, &mut fields));
        let content = Content::of_frames(message);
        let kept = self.kept(message);
        let signals = message.signals.entries().map(|(signal, known)| {
            let field = match known.element {
                Some(element) => arrays[element.array].clone(),
                None => fields.take(self.name(message, signal), "_"),
            };
            let words = self.types.words(self.types.packed[id][signal].as_ref());
            let mut planned = self.named(&content, known, (constants[signal].clone(), field), &words, members);
            if kept.contains(&signal) {
                planned.member.put = format_ident!("keep");
            }
            planned
        });
        signals.collect()
    }

    /// Returns the signals of a part that a module can get. Nobody changes them, since limits hold for the whole message.
    fn kept(&self, message: &Message) -> Vec<SignalId> {
        let parts = message.long.and_then(|long| Some((long, self.protocol[long].parts()?)));
        let Some((long, Parts { counter, .. })) = parts else { return Vec::new() };
        let mut frames = self.protocol.frames_of(message);
        let is_sent = frames.any(|frame| frame.is_to_module() && self.protocol.part_of(frame) == Some(long));
        let kept = message.signals.ids().filter(|signal| is_sent && Some(*signal) != *counter);
        kept.collect()
    }

    /// Plans the signals of what several frames carry together. The elements of an array are one.
    pub fn long_signals(&self, long: &LongMessage, members: &mut Pool) -> Vec<(Signal, SignalId)> {
        let (content, message, mut fields) = (Content::of_long(long), &long.content, Pool::default());
        let is_first = |signal: &model::Signal| signal.element.is_none_or(|element| element.index == 0);
        let first = message.signals.entries().filter(|(_, signal)| is_first(signal));
        let signals = first.map(|(id, known)| {
            let row = model::Signal { name: message.field_name(known).to_owned(), ..known.clone() };
            let names = (constant(&row.name, members), fields.take(self.name(message, id), "_"));
            (self.named(&content, &row, names, &self.types.words(None), members), id)
        });
        signals.collect()
    }

    /// Plans a signal that has the names of its constant and of its member.
    fn named(
        &self,
        content: &Content,
        known: &model::Signal,
        (constant, field): (Ident, Ident),
        words: &WordTypes,
        members: &mut Pool,
    ) -> Signal {
        let values = named_values(known).iter().map(|special| {
            let name = format!("{}_{}", content.message.field_name(known), special.name);
            members.take(name.to_ascii_uppercase(), "_VALUE")
        });
        let names = Names { constant, field, values: values.collect() };
        let coding = Coding::new(self.protocol, words, known, self.scaled);
        let scales = Scales::new(self.protocol, (self.models, self.scaled), content.message, known, members);
        self.signal(content, known, (names, scales), coding)
    }

    /// Names the member of a signal.
    fn name(&self, message: &Message, signal: SignalId) -> String {
        member(message, &message[signal], self.scaled)
    }

    fn signal(
        &self,
        content: &Content,
        signal: &model::Signal,
        (Names { constant, field, values }, scales): (Names, Option<Scales>),
        coding: Coding,
    ) -> Signal {
        let message = content.message;
        let range = signal.hull(self.protocol.models_of(message));
        let range = range.map(|range| coding.limits.range(signal, range));
        let special = |(special, name)| Special::new(name, (self.protocol, message), signal, &coding, special);
        Signal {
            comment: Comment::line(format!(
                "The signal `{}`, to read or write it alone, or to ask for its limits.",
                signal.name
            )),
            name: signal.name.clone(),
            place: Written::new(signal.place),
            unit: signal.unit.map(|unit| unit.symbol.to_string()),
            physical: coding.physical(),
            limits: range.map(|range| coding.limits.ends(signal, range)),
            model_limits: self.models.limits_of(self.protocol, signal).cloned(),
            specials: signal.specials.iter().map(|known| (as_signed(known.raw), known.name.clone())).collect(),
            has_absent: signal.has_absent,
            lacking: self.lacking(message, signal),
            is_of_some_models: self.protocol.models_of(message).any(|model| !signal.is_of(model)),
            is_by_model: !signal.encoding.by_model().is_empty(),
            scales,
            values: named_values(signal).iter().zip(values).map(special).collect(),
            member: self.member(content, signal, field, &coding, range),
            constant,
            coding,
        }
    }

    /// Plans what the models of a message do not have.
    fn lacking(&self, message: &Message, signal: &model::Signal) -> Vec<(Ident, TokenStream)> {
        let Self { protocol, models, .. } = *self;
        let rows = |known: Lacking| {
            let model = models.variant(known.model);
            let [mask, blank] = [known.mask, known.blank].map(|bits| hexadecimal(bits, signal.place.width()));
            let is_whole = !signal.is_of(known.model);
            let bits = if is_whole { quote!(Lack::Signal(#mask, #blank)) } else { quote!(Lack::Bits(#mask)) };
            let bits = (known.mask != 0).then_some(bits);
            let values = known.values.into_iter().map(as_signed).map(|raw| quote!(Lack::Value(#raw)));
            bits.into_iter().chain(values).map(|lack| (model.clone(), lack)).collect::<Vec<_>>()
        };
        let lacking = protocol.models_of(message).filter_map(|model| protocol.lacking(message, signal, model));
        lacking.flat_map(rows).collect()
    }

    fn member(
        &self,
        content: &Content,
        signal: &model::Signal,
        name: Ident,
        coding: &Coding,
        range: Option<Range>,
    ) -> Member {
        let message = content.message;
        let is_at_end = elements(message, signal).any(|element| content.lacks(element));
        let is_optional = is_at_end || signal.has_absent;
        let doc = message.array_of(signal).map_or(&signal.doc, |array| &array.doc);
        let sentence = self.sentence(content, signal, coding, range);
        let paragraphs = doc::paragraphs(self.protocol, doc, &sentence, Some(&message.doc));
        let comment = Comment::new(paragraphs.into_iter().chain(type_notes(self.protocol, signal, coding)));
        let [get, put] = coding.methods().map(|name| if is_optional { format_ident!("{name}_some") } else { name });
        let index = signal.element.map(|element| Literal::u8_unsuffixed(element.index));
        Member { name, index, comment, kind: coding.value(), is_optional, is_at_end, get, put }
    }

    fn sentence(&self, content: &Content, signal: &model::Signal, coding: &Coding, range: Option<Range>) -> String {
        let message = content.message;
        let doc = message.array_of(signal).map_or(&signal.doc, |array| &array.doc);
        let (title, unit) = (doc::title(doc, message.field_name(signal)), Unit::new(signal, self.scaled).phrase);
        let range = range.map(|range| format!("`{}..={}`", range.minimum, range.maximum));
        let (place, optional) = (Some(places(message, signal)), optional(content, signal));
        let only = only_on(self.protocol, signal);
        let facts = [place, varying(message, signal), optional, coding.step.clone(), range, specials(signal), only];
        let facts: Vec<_> = facts.into_iter().flatten().chain(conduct(signal)).collect();
        let models = models(self.protocol, signal);
        format!("{}{models}", doc::sentence_of(&format!("{title}{unit}: {}", facts.join(", "))))
    }
}

impl Special {
    fn new(
        constant: Ident,
        (protocol, message): (&Protocol, &Message),
        known: &model::Signal,
        coding: &Coding,
        special: &NamedValue,
    ) -> Self {
        let (field, only) = (message.field_name(known), super::word::only(protocol, &special.models));
        let title = special.title.iter().map(|title| doc::sentence_of(&title.in_rust_doc()));
        let sentence = format!("The value of `{field}` that stands for `{}`{only}.", special.name);
        let sentences: Vec<_> = std::iter::once(sentence).chain(title).collect();
        Self { constant, comment: Comment::line(sentences.join(" ")), value: coding.value_of(known, special.raw) }
    }
}

/// Takes the name of a signal's constant.
fn constant(name: &str, members: &mut Pool) -> Ident {
    members.take(name.to_ascii_uppercase(), "_SIGNAL")
}

/// Writes a raw value as the signed number that has its bits.
fn as_signed(raw: i128) -> TokenStream {
    if i64::try_from(raw).is_ok() {
        return decimal(raw);
    }
    let bits = decimal(raw);
    quote!(u64::cast_signed(#bits))
}

/// Returns a signal, or all elements of its array.
fn elements<'a>(message: &'a Message, signal: &'a model::Signal) -> impl Iterator<Item = &'a model::Signal> {
    let array = message.array_of(signal);
    let alone = array.is_none().then_some(signal);
    alone.into_iter().chain(array.into_iter().flat_map(|array| &array.elements).map(|id| &message[*id]))
}

/// Returns the special values that have constants. A missing value has none, and an array has them once.
fn named_values(signal: &model::Signal) -> &[NamedValue] {
    let is_first = signal.element.is_none_or(|element| element.index == 0);
    let count = if is_first { signal.specials.len() - usize::from(signal.has_absent) } else { 0 };
    &signal.specials[..count]
}

/// Writes the place of a signal, or those of the first and the last element of its array.
fn places(message: &Message, signal: &model::Signal) -> String {
    let start = signal.window;
    match signal.run {
        Some(run) if run.varies() => {
            return format!("{} to {} bytes from byte {start} on", run.least, run.most);
        }
        Some(run) => return format!("bytes {start}..{}", start + run.most - 1),
        None => {}
    }
    let mut all = elements(message, signal).map(|element| Written::new(element.place).after(element.window).text());
    let first = all.next().unwrap_or_default();
    all.last().map_or_else(|| first.clone(), |last| format!("{first} to {last}"))
}

/// Says how many elements an array has, if that varies.
fn varying(message: &Message, signal: &model::Signal) -> Option<String> {
    let array = message.array_of(signal)?;
    Some(format!("{} to {} elements", array.least?, array.elements.len()))
}

/// Says which frames or messages lack a signal, or elements of its array.
fn optional(content: &Content, signal: &model::Signal) -> Option<String> {
    let carriers = content.carriers;
    let mut all: Vec<_> = elements(content.message, signal).map(|element| least(content, element)).collect();
    all.dedup();
    match all.as_slice() {
        [bytes] => content.lacks(signal).then(|| format!("only in {carriers} of {bytes} bytes")),
        _ => Some(format!("not all of them in shorter {carriers}")),
    }
}

/// Returns the numbers of data bytes with which a signal is there.
fn least(content: &Content, signal: &model::Signal) -> String {
    let lengths = content.lengths.iter().filter(|length| **length >= signal.reach());
    lengths.map(usize::to_string).collect::<Vec<_>>().join(" or ")
}

/// Says what a device does with the value.
fn conduct(signal: &model::Signal) -> impl Iterator<Item = String> {
    let Conduct { out_of_range, keeps, .. } = signal.conduct;
    let limiting = OUT_OF_RANGE.iter().filter(move |(_, known)| Some(*known) == out_of_range);
    let keeping = POWER_OFF.iter().filter(move |(_, known)| Some(*known) == keeps);
    let limiting = limiting.map(|(word, _)| format!("{word} out of range"));
    limiting.chain(keeping.map(|(word, _)| format!("{word} without power")))
}

/// Names the only device models that have a signal.
fn only_on(protocol: &Protocol, signal: &model::Signal) -> Option<String> {
    let names: Vec<_> = signal.models.iter().map(|model| format!("`{}`", protocol[*model].name)).collect();
    (!names.is_empty()).then(|| format!("only on {}", names.join(" and ")))
}

/// Says that limits depend on the device model, and which models have none.
fn models(protocol: &Protocol, signal: &model::Signal) -> String {
    if signal.model_ranges.is_empty() {
        return String::new();
    }
    let unlimited = protocol.models.entries().filter(|(id, _)| signal.limits_for(Some(*id)).is_none());
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
    let docs = others.filter_map(|path| protocol.types.iter().map(|known| &known.doc).find(|doc| doc.path == path));
    docs.filter_map(|doc| Some(doc::sentence_of(&doc.note.as_ref()?.in_rust_doc())))
}
