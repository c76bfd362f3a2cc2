//! Restricts values beyond their kind: to one of a few words, to a number, or to a place.

use serde_json::{Map, Value, json};

use crate::model::NoteRule;
use crate::model::keywords::{
    ABSENT, ANSWERS, ERRATUM_KINDS, EXPECTED, NUMBER_FORMATS, ORIGINS, OUT_OF_RANGE, OUTSIDE, POWER_OFF, SEVERITIES,
    SIDES,
};
use crate::model::{AfterSilence, Failure, Kind, TimeRole, Unit};
use crate::read::syntax::ast::Key;
use crate::reference::rules::RULES;

/// The form of a text. What YAML reads as a number needs none.
#[derive(Clone, Copy)]
pub struct Form {
    /// The text as a regular expression, in which `N` stands for a number.
    pattern: &'static str,
    /// What an editor says about a text of another form.
    message: &'static str,
}

const NUMBER: Form =
    Form { pattern: "N", message: "Write a number: `12`, `-40`, `0x1F`, `0b101`, `41.5` or `1/1024`." };
const RANGE: Form = Form { pattern: r"N\.\.N( [^0-9 ]+)?", message: "Write the limits as `41.5..58.5`." };
/// From the most to the least significant.
pub const PLACE: Form = Form { pattern: r"N(\.\.N)?", message: "Write `7..4` or one number." };

/// A text can end where the message ends.
const BYTES: Form = Form { pattern: r"N(\.\.(N)?)?", message: "Write `0..3` or one number." };
const LENGTH: Form = Form { pattern: PLACE.pattern, message: "Write one number, or `0..400` for an open text." };

/// What a value must be, beyond its kind.
enum Demand {
    /// A text has a form.
    Form(Form),
    /// One of a few words.
    Choice(Vec<&'static str>),
    /// One of a few words, or any other text.
    Suggestion(Vec<String>),
    /// Whatever its kind allows.
    Anything,
}

/// Keys whose texts have a form, with the struct that has the key. The keys of a field are in
/// [`of_field`].
const FORMS: [(&str, &str, Form); 18] = [
    ("Access", "refusal", NUMBER),
    ("Access", "reply", NUMBER),
    ("Access", "report", NUMBER),
    ("Access", "request", NUMBER),
    ("Elements", "bytes", PLACE),
    ("Elements", "repeat", NUMBER),
    ("Example", "count", NUMBER),
    ("Message", "length", LENGTH),
    ("Message", "match", NUMBER),
    ("Message", "send", NUMBER),
    ("Parts", "data", PLACE),
    ("Product", "limits", RANGE),
    ("Reserved", "send", NUMBER),
    ("StatusBit", "bit", NUMBER),
    ("StatusBit", "byte", NUMBER),
    ("StatusBit", "first", NUMBER),
    ("StatusBit", "repeat", NUMBER),
    ("Timing", "tries", NUMBER),
];

/// Returns the keys whose value is one of a few words, with the struct that has the key.
fn choices() -> [(&'static str, &'static str, Vec<&'static str>); 14] {
    let answers = ANSWERS.map(|(word, _)| word).to_vec();
    [
        ("Access", "answers", answers.clone()),
        ("Access", "from", SIDES.map(|(word, _)| word).to_vec()),
        ("Access", "in", kinds()),
        ("AfterSilence", "output", AfterSilence::ALL.map(AfterSilence::name).to_vec()),
        ("Allowance", "rule", RULES.iter().map(|rule| rule.name).collect()),
        ("Erratum", "kind", ERRATUM_KINDS.to_vec()),
        ("Example", "fails", Failure::ALL.map(|(_, word)| word).to_vec()),
        ("Example", "notes", NoteRule::ALL.map(|(_, name)| name).to_vec()),
        ("Example", "origin", ORIGINS.map(|(word, _)| word).to_vec()),
        ("Message", "answers", answers),
        ("Message", "in", vec![Kind::Request.name(), Kind::Reply.name()]),
        ("Reserved", "expect", EXPECTED.map(|(word, _)| word).to_vec()),
        ("StatusBit", "severity", SEVERITIES.map(|(word, _)| word).to_vec()),
        ("Timing", "role", TimeRole::ALL.map(TimeRole::name).to_vec()),
    ]
}

fn kinds() -> Vec<&'static str> {
    Kind::ALL.map(Kind::name).to_vec()
}

/// Returns what the value of a field's key must be.
fn of_field(key: Key) -> Demand {
    match key {
        Key::Bytes => Demand::Form(BYTES),
        Key::Bits => Demand::Form(PLACE),
        Key::Repeat => Demand::Form(Form { message: "Write `3`, or `1..48` in a message of parts.", ..PLACE }),
        Key::Step
        | Key::First
        | Key::Fill
        | Key::Scale
        | Key::Offset
        | Key::Const
        | Key::Send
        | Key::Normal
        | Key::Starting
        | Key::Continues
        | Key::Reply => Demand::Form(NUMBER),
        Key::Range => Demand::Form(RANGE),
        Key::As => Demand::Choice(NUMBER_FORMATS.map(|(word, _)| word).to_vec()),
        Key::In => Demand::Choice(kinds()),
        Key::Absent => Demand::Choice(ABSENT.map(|(word, _)| word).to_vec()),
        Key::OutOfRange => Demand::Choice(OUT_OF_RANGE.map(|(word, _)| word).to_vec()),
        Key::PowerOff => Demand::Choice(POWER_OFF.map(|(word, _)| word).to_vec()),
        Key::Outside => Demand::Choice(OUTSIDE.to_vec()),
        Key::Unit => Demand::Suggestion(Unit::ALL.map(|unit| unit.symbol.to_string()).to_vec()),
        Key::Type
        | Key::Values
        | Key::Fields
        | Key::Status
        | Key::Format
        | Key::Default
        | Key::Models
        | Key::Examples
        | Key::Title
        | Key::Note
        | Key::Section
        | Key::Erratum => Demand::Anything,
    }
}

/// Returns every key with its struct and what its value must be.
fn demands() -> impl Iterator<Item = (&'static str, &'static str, Demand)> {
    let forms = FORMS.into_iter().map(|(item, key, form)| (item, key, Demand::Form(form)));
    let choices = choices().into_iter().map(|(item, key, words)| (item, key, Demand::Choice(words)));
    let fields = Key::ALL.iter().map(|key| ("Field", key.name(), of_field(*key)));
    forms.chain(choices).chain(fields)
}

/// Adds every demand to the schema.
pub fn restrict(schema: &mut Value) {
    for (item, key, demand) in demands() {
        if let Some(value) = value_of(schema, item, key) {
            demand.add_to(value);
        }
    }
}

impl Demand {
    fn add_to(self, value: &mut Map<String, Value>) {
        match self {
            Self::Form(form) => form.demand(value),
            Self::Choice(words) => {
                value.remove("type");
                value.insert("enum".to_owned(), words.into());
            }
            Self::Suggestion(words) => {
                let text = value.remove("type").unwrap_or_else(|| "string".into());
                value.insert("anyOf".to_owned(), json!([{ "enum": words }, { "type": text }]));
            }
            Self::Anything => {}
        }
    }
}

impl Form {
    /// Demands the form of a text.
    pub fn demand(self, value: &mut Map<String, Value>) {
        let number = r"-?(0x[0-9A-Fa-f]+|0b[01]+|[0-9]+(\.[0-9]+)?)(/(0x[0-9A-Fa-f]+|0b[01]+|[0-9]+))?";
        value.insert("pattern".to_owned(), format!("^{}$", self.pattern.replace('N', number)).into());
        value.insert("patternErrorMessage".to_owned(), self.message.into());
    }
}

/// Returns the schema of a key's value. For a list or a map it is the schema of each entry.
fn value_of<'s>(schema: &'s mut Value, item: &str, key: &str) -> Option<&'s mut Map<String, Value>> {
    let value = schema.pointer_mut(&format!("/definitions/{item}/properties/{key}"))?;
    let entries = ["items", "additionalProperties"].into_iter().find(|inner| value.get(inner).is_some());
    match entries {
        Some(inner) => value.get_mut(inner),
        None => Some(value),
    }?
    .as_object_mut()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_that_is_restricted_exists() -> serde_json::Result<()> {
        let mut schema = serde_json::from_str(&crate::reference::schema::schema())?;
        for (item, key, _) in demands().filter(|(_, _, demand)| !matches!(demand, Demand::Anything)) {
            assert!(value_of(&mut schema, item, key).is_some(), "{item}.{key}");
        }
        Ok(())
    }
}
