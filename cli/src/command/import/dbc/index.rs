//! What other parts of a DBC say about messages and signals, by identifier and name.

use std::collections::{BTreeMap, HashMap, HashSet};

use can_dbc::{
    AttributeValue, Comment, Dbc, ExtendedMultiplex, MessageId, SignalExtendedValueType, ValDescription,
    ValueDescription,
};

use super::spec::one_line;

/// A message, or one of its signals.
type Item<'a> = (u32, Option<&'a str>);

/// If something is said twice, the first counts.
pub struct Index<'a> {
    comments: HashMap<Item<'a>, &'a str>,
    values: HashMap<Item<'a>, &'a [ValDescription]>,
    formats: HashMap<Item<'a>, &'a SignalExtendedValueType>,
    multiplexors: HashMap<Item<'a>, &'a ExtendedMultiplex>,
    /// By the name of the attribute.
    attributes: HashMap<(u32, &'a str), &'a AttributeValue>,
    defaults: HashMap<&'a str, &'a AttributeValue>,
}

impl<'a> Index<'a> {
    pub fn new(dbc: &'a Dbc) -> Self {
        let comments = dbc.comments.iter().filter_map(|comment| match comment {
            Comment::Message { id, comment } => Some(((id.raw(), None), comment.as_str())),
            Comment::Signal { message_id, name, comment } => {
                Some(((message_id.raw(), Some(name.as_str())), comment.as_str()))
            }
            Comment::Node { .. } | Comment::EnvVar { .. } | Comment::Plain { .. } => None,
        });
        let values = dbc.value_descriptions.iter().filter_map(|known| match known {
            ValueDescription::Signal { message_id, name, value_descriptions } => {
                Some((item(*message_id, name), value_descriptions.as_slice()))
            }
            ValueDescription::EnvironmentVariable { .. } => None,
        });
        let formats = dbc.signal_extended_value_type_list.iter();
        let formats =
            formats.map(|known| (item(known.message_id, &known.signal_name), &known.signal_extended_value_type));
        let multiplexors = dbc.extended_multiplex.iter();
        let attributes = dbc.attribute_values_message.iter();
        Self {
            comments: first(comments),
            values: first(values),
            formats: first(formats),
            multiplexors: first(multiplexors.map(|known| (item(known.message_id, &known.signal_name), known))),
            attributes: first(attributes.map(|known| ((known.message_id.raw(), known.name.as_str()), &known.value))),
            defaults: first(dbc.attribute_defaults.iter().map(|known| (known.name.as_str(), &known.value))),
        }
    }

    pub fn comment(&self, id: MessageId, signal: Option<&str>) -> &'a str {
        self.comments.get(&(id.raw(), signal)).copied().unwrap_or_default()
    }

    pub fn values(&self, id: MessageId, signal: &str) -> &'a [ValDescription] {
        self.values.get(&item(id, signal)).copied().unwrap_or_default()
    }

    pub fn format(&self, id: MessageId, signal: &str) -> Option<&'a SignalExtendedValueType> {
        self.formats.get(&item(id, signal)).copied()
    }

    pub fn multiplexor(&self, id: MessageId, signal: &str) -> Option<&'a ExtendedMultiplex> {
        self.multiplexors.get(&item(id, signal)).copied()
    }

    /// Returns the value of an attribute of a message, or else its default.
    pub fn attribute(&self, id: MessageId, name: &str) -> Option<&'a AttributeValue> {
        self.attributes.get(&(id.raw(), name)).or_else(|| self.defaults.get(name)).copied()
    }

    /// Lists what is about no message and no signal of the file.
    pub fn astray(&self, dbc: &Dbc) -> Vec<String> {
        let signals = dbc.messages.iter().flat_map(|message| {
            let names = message.signals.iter().map(|signal| Some(signal.name.as_str()));
            names.chain([None]).map(|name| (message.id.raw(), name))
        });
        let known: HashSet<Item> = signals.collect();
        let values = self.values.keys().map(|item| (*item, "names of the values of", String::new()));
        let comments =
            self.comments.iter().map(|(item, text)| (*item, "a comment on", format!(": {}", one_line(text))));
        let formats = self.formats.keys().map(|item| (*item, "the type of", String::new()));
        let multiplexors = self.multiplexors.keys().map(|item| (*item, "the multiplexor of", String::new()));
        let all = values.chain(comments).chain(formats).chain(multiplexors);
        let astray: BTreeMap<_, _> =
            all.filter(|(item, ..)| !known.contains(item)).map(|(item, what, more)| ((item, what), more)).collect();
        astray.into_iter().map(|((item, what), more)| sentence(item, what, &more)).collect()
    }
}

fn sentence((id, signal): Item, what: &str, more: &str) -> String {
    let id = id & !(1 << 31);
    match signal {
        Some(signal) => format!("{what} `{signal}` of 0x{id:X}, which is no signal of the file{more}"),
        None => format!("{what} 0x{id:X}, which is no message of the file{more}"),
    }
}

fn item(id: MessageId, signal: &str) -> Item<'_> {
    (id.raw(), Some(signal))
}

fn first<K: Eq + std::hash::Hash, V>(entries: impl Iterator<Item = (K, V)>) -> HashMap<K, V> {
    let mut found = HashMap::new();
    for (key, value) in entries {
        found.entry(key).or_insert(value);
    }
    found
}
