//! Turns messages of a DBC into messages of a spec.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use can_dbc::{Dbc, Message as Source, MessageId, Signal};

use super::index::Index;
use super::limits::{beside_messages, cycle, is_parameter_group};
use super::names::{Names, snake_case, type_name};
use super::places::BitRange;
use super::signals::{Translated, meaning, unit_of};
use super::spec::{Field, Message, Spec, one_line};
use super::variants::{Variant, variants};
use super::yaml::quoted;

/// The message in which some tools keep signals without a message.
const NO_MESSAGE: &str = "VECTOR__INDEPENDENT_SIG_MSG";

/// Data bytes of a classic frame.
const LONGEST: u64 = 8;

/// Makes a spec of a DBC.
pub fn spec(dbc: &Dbc, file: &str, protocol: &str) -> Spec {
    let index = Index::new(dbc);
    let mut importer = Importer { dbc, index: &index, names: Names::default(), limits: Limits::default() };
    let extended = is_extended(dbc);
    let sources = importer.sources(extended);
    let messages: Vec<Message> = sources.into_iter().flat_map(|source| importer.messages(source)).collect();
    let version = Some(one_line(&dbc.version.0)).filter(|version| !version.is_empty());
    let mut limits = importer.limits.all;
    limits.extend(index.astray(dbc));
    limits.extend(beside_messages(dbc));
    Spec {
        file: one_line(file),
        protocol: Names::default().take(protocol, str::to_owned),
        version: version.unwrap_or_else(|| "unknown".to_owned()),
        extended,
        length: usual_length(&messages),
        messages,
        limits,
    }
}

/// Tests whether most messages have 29 bits.
fn is_extended(dbc: &Dbc) -> bool {
    let messages = dbc.messages.iter().filter(|message| message.name != NO_MESSAGE);
    let (extended, standard): (Vec<_>, Vec<_>) =
        messages.partition(|message| matches!(message.id, MessageId::Extended(_)));
    extended.len() > standard.len()
}

fn usual_length(messages: &[Message]) -> u8 {
    let mut counts: BTreeMap<u8, usize> = BTreeMap::new();
    for message in messages {
        *counts.entry(message.length).or_default() += 1;
    }
    counts.into_iter().max_by_key(|(length, count)| (*count, *length)).map_or(8, |(length, _)| length)
}

fn identifier(id: MessageId) -> u32 {
    match id {
        MessageId::Standard(id) => id.into(),
        MessageId::Extended(id) => id,
    }
}

/// Remarks about the DBC, each only once.
#[derive(Default)]
struct Limits {
    all: Vec<String>,
    known: HashSet<String>,
}

struct Importer<'a> {
    dbc: &'a Dbc,
    index: &'a Index<'a>,
    /// Names of messages and of sets of named values, which become types.
    names: Names,
    limits: Limits,
}

impl<'a> Importer<'a> {
    fn limit(&mut self, limit: String) {
        if self.limits.known.insert(limit.clone()) {
            self.limits.all.push(limit);
        }
    }

    /// Returns the messages that a spec can have.
    fn sources(&mut self, extended: bool) -> Vec<&'a Source> {
        let mut identifiers = BTreeSet::new();
        let mut sources = Vec::new();
        for source in &self.dbc.messages {
            let id = identifier(source.id);
            let why = if source.name == NO_MESSAGE {
                Some("its signals belong to no message".to_owned())
            } else if matches!(source.id, MessageId::Extended(_)) != extended {
                Some(format!("0x{id:X} has {} bits, unlike most", if extended { 11 } else { 29 }))
            } else if source.size > LONGEST {
                Some(format!("it has {} data bytes", source.size))
            } else {
                (!identifiers.insert(id)).then(|| format!("another one has its identifier 0x{id:X}"))
            };
            match why {
                Some(why) => self.limit(format!("message `{}`: {why}", source.name)),
                None => sources.push(source),
            }
        }
        sources
    }

    /// Makes a message for each value of the multiplexors.
    fn messages(&mut self, source: &'a Source) -> Vec<Message> {
        let found = variants(self.index, source);
        let variants = found.unwrap_or_else(|why| {
            self.limit(format!("message `{}`: {why}", source.name));
            Vec::new()
        });
        if is_parameter_group(self.index, source.id) {
            self.limit(format!("message `{}`: it comes from any source at any priority", source.name));
        }
        variants.iter().filter_map(|variant| self.message(source, variant)).collect()
    }

    fn message(&mut self, source: &'a Source, variant: &Variant) -> Option<Message> {
        let length = u8::try_from(source.size).ok()?;
        let labels: Vec<_> =
            variant.constants.iter().map(|(index, value)| self.label(source, *index, *value)).collect();
        let short: Vec<_> = labels.iter().map(|(_, name)| name.as_str()).collect();
        let wanted = [&[snake_case(&source.name, "message").as_str()], &short[..]].concat().join("_");
        let name = self.names.take(&wanted, type_name);
        let long: Vec<_> = labels.iter().map(|(title, _)| title.as_str()).collect();
        let title = [&[source.name.as_str()], &long[..]].concat().join(", ");
        let fields = self.fields(source, variant, &name, length)?;
        Some(Message {
            title,
            note: one_line(self.index.comment(source.id, None)),
            sender: source.transmitter.as_deref().map(one_line),
            id: identifier(source.id),
            length,
            cycle: cycle(self.index, source.id),
            fields,
            name,
        })
    }

    /// Returns the label of a multiplexor's value, for a title and for a name.
    fn label(&self, source: &Source, index: usize, value: u64) -> (String, String) {
        let signal = &source.signals[index].name;
        let named = self.index.values(source.id, signal);
        let known = named.iter().find(|named| u64::try_from(named.id) == Ok(value));
        let numbered = format!("{}_{value}", snake_case(signal, "multiplexor"));
        match known.map(|known| one_line(&known.description)).filter(|text| !text.is_empty()) {
            Some(text) => (format!("{signal} = {value} ({text})"), snake_case(&text, &numbered)),
            None => (format!("{signal} = {value}"), numbered),
        }
    }

    /// Returns the possible constants and signals, or `None` if a multiplexor is impossible.
    fn fields(&mut self, source: &Source, variant: &Variant, message: &str, length: u8) -> Option<Vec<Field>> {
        let mut frame = Draft { id: source.id, message, length, taken: Vec::new(), names: Names::default() };
        let mut fields = Vec::new();
        for (index, value) in &variant.constants {
            let field = frame.constant(&source.signals[*index], *value);
            fields.push(self.told(source, *index, field)?);
        }
        for index in &variant.signals {
            let field = self.field(&mut frame, source, &source.signals[*index]);
            fields.extend(self.told(source, *index, field));
        }
        Some(fields)
    }

    /// Notes why a field is impossible.
    fn told(&mut self, source: &Source, index: usize, field: Result<Field, String>) -> Option<Field> {
        field.map_err(|why| self.limit(format!("signal `{}.{}`: {why}", source.name, source.signals[index].name))).ok()
    }

    fn field<'s>(&mut self, frame: &mut Draft<'s>, source: &Source, signal: &'s Signal) -> Result<Field, String> {
        let place = frame.place(signal)?;
        let Translated { mut keys, unit, is_named, decide, lost } = meaning(self.index, frame.id, signal)?;
        frame.take(place, &signal.name)?;
        for lost in lost {
            self.limit(format!("signal `{}.{}`: {lost}", source.name, signal.name));
        }
        let member = |name: &str| unit.map_or_else(|| name.to_owned(), |unit| format!("{name}_{}", unit.suffix));
        let type_of = |name: &str| type_name(&format!("{}_{name}", frame.message));
        let mut name = frame.names.take(&snake_case(&signal.name, "signal"), member);
        while is_named && !self.names.is_free(&type_of(&name)) {
            name = frame.names.take(&name, member);
        }
        if is_named {
            self.names.take(&name, type_of);
        }
        let title = match unit_of(signal).filter(|_| unit.is_none()) {
            Some(symbol) => format!("{} in {}", signal.name, one_line(symbol)),
            None => signal.name.clone(),
        };
        let note = one_line(self.index.comment(frame.id, Some(&signal.name)));
        keys.extend((!title.eq_ignore_ascii_case(&name)).then(|| ("title", quoted(&title))));
        keys.extend((!note.is_empty()).then(|| ("note", quoted(&note))));
        Ok(Field { name, place, is_constant: false, keys, decide })
    }
}

/// What the fields of a message share.
struct Draft<'a> {
    id: MessageId,
    message: &'a str,
    length: u8,
    /// Bits and their owners.
    taken: Vec<(u64, &'a str)>,
    names: Names,
}

impl<'a> Draft<'a> {
    fn place(&self, signal: &Signal) -> Result<BitRange, String> {
        let outside = || format!("it lies outside of the {} data bytes", self.length);
        BitRange::new(signal, self.length).ok_or_else(outside)
    }

    /// Takes the bits of a place.
    fn take(&mut self, place: BitRange, name: &'a str) -> Result<(), String> {
        if let Some((_, other)) = self.taken.iter().find(|(mask, _)| mask & place.mask() != 0) {
            return Err(format!("it shares bits with `{other}`"));
        }
        self.taken.push((place.mask(), name));
        Ok(())
    }

    /// Makes a constant field of a multiplexor.
    fn constant(&mut self, signal: &'a Signal, value: u64) -> Result<Field, String> {
        let place = self.place(signal)?;
        if value > u64::MAX >> (64 - place.width()) {
            return Err(format!("its bits do not hold the value {value} of the multiplexor"));
        }
        self.take(place, &signal.name)?;
        let name = self.names.take(&snake_case(&signal.name, "signal"), str::to_owned);
        Ok(Field { name, place, is_constant: true, keys: vec![("const", value.to_string())], decide: Vec::new() })
    }
}
