//! Every key of a field in every place of a spec: it has an effect on what the engines do, or it is an error.

use std::collections::BTreeSet;

use canspec_codegen::emit::{self, Options};
use canspec_codegen::interpret::{Frame, Target, Value as Meaning, decode, physical, requests};
use canspec_codegen::model::{Protocol, Signal};
use canspec_codegen::source::Source;
use canspec_codegen::syntax::ast::Key;
use canspec_codegen::{Outcome, compile};
use canspec_tests::{Frames, models};
use rayon::prelude::*;
use serde_yaml::{Mapping, Value};

const REFERENCE: &str = include_str!("../../docs/language/reference.md");

/// A field of each role.
const SPEC: &str = r#"
canspec: 1
protocol: keys
title: Every place of a field
document: {title: Test, version: "1"}
length: 8
identifier:
  priority: {bits: 28..26}
  family:   {bits: 25..24, const: 2}
  command:  {bits: 23..16}
  target:   {bits: 15..8}
  source:   {bits: 7..0}
header:
  result: {bytes: 0}
  spare:  {bytes: 7}
  flags:  {bytes: 1, fields: {more: {bits: 7..4, continues: 2}, page: {bits: 3..0}}}
types:
  controller: {values: {0xF0: main, 0xF1: other}, send: 0xF0, outside: refused}
  module:     {range: 0..0x3F}
  level:      {bytes: 2, range: 0..30}
  alarms:     {bytes: 2, status: {hot: {bit: 3}}}
  lamp:       {bytes: 4, values: {0: dark, 1: bright}}
  serial:     {format: "{letter}{number}", fields: {letter: {bytes: 6, as: text}, number: {bytes: 7}}}
  pair:       {bytes: 6, fields: {high: {bits: 7..4}, low: {bits: 3..0}}}
  titled:     {title: What the type says}
addressing:
  single:
    request: {target: module, source: controller}
    one:     {target: controller, source: module}
access:
  set:  {request: {}, reply: {}, answers: {single: one}}
  scan: {request: {}, reply: {}, in: [reply], answers: {single: one}}
messages:
  numbers:
    section: "1"
    match: {command: 1, result: 0}
    access: [set]
    fields:
      plain: {bytes: 3}
      steps: {bytes: 4, scale: 1/2, offset: 7, unit: A, range: 10..20, default: 12}
  floats:
    section: "1"
    match: {command: 6}
    access: [set]
    fields: {float: {bytes: 7..4, as: float, type: titled}}
  words:
    section: "1"
    match: {command: 2}
    access: [set]
    fields:
      alarms: {type: alarms}
      faults: {bytes: 3, status: {cold: {bit: 5}}}
      lamp:   {type: lamp}
      state:  {bytes: 5, values: {0: idle, 1: busy}}
      pair:   {type: pair}
      word:   {bytes: 7, fields: {above: {bits: 7..4}, below: {bits: 3..0}}}
  texts:
    section: "1"
    match: {command: 3}
    access: [set]
    fields:
      name:   {bytes: 2..3, as: text}
      serial: {type: serial}
      built:
        type: titled
        format: "{letter}-{year:2}-{day}"
        fields:
          letter: {bytes: 4, as: text}
          date:   {bytes: 5, fields: {year: {bits: 7..4}, day: {bits: 3..0}}}
  one:
    section: "1"
    match: {command: 4, page: 1}
    access: [set]
    fields:
      action: {bytes: 2, const: 1}
      lamp:   {type: lamp}
  single:
    section: "1"
    match: {command: 5}
    access: [set]
    value: {bytes: 2..3}
  typed:
    section: "1"
    match: {command: 7}
    access: [set]
    fields: {level: {type: level}}
  row:
    section: "1"
    match: {command: 9}
    access: [set]
    fields: {row: {bytes: 2, repeat: 2}}
  all:
    section: "1"
    match: {command: 8}
    access: [scan]
    members: [heat, power]
  heat:
    section: "1"
    match: {result: 1, command: 8}
    value: {bytes: 2}
  power:
    section: "1"
    match: {result: 2, command: 8}
    value: {bytes: 2}
models:
  M1: {title: One model, section: "1", types: {level: {range: 0..20}}}
errata:
  E1: {kind: note, prints: a, uses: b, because: c}
"#;

/// Returns what is written after a key. In each place that reads the key, one of these should mean something.
fn samples(key: Key) -> Vec<&'static str> {
    let samples: &[_] = match key {
        Key::Bytes => &["1", "5", "3..2"],
        Key::Bits => &["1", "2..1"],
        Key::Step => &["2"],
        Key::First => &["0"],
        Key::Type => &["titled"],
        Key::As | Key::Absent | Key::OutOfRange | Key::PowerOff => return words(key),
        Key::Fill => &["0x20"],
        Key::Scale => &["1/4", "-1"],
        Key::Repeat | Key::Offset => &["3"],
        Key::Unit => &["V"],
        Key::Range => &["1..15"],
        // The second one names the addresses of the controllers.
        Key::Values => &[
            "{5: five, 6: six}",
            "{0xF0: five, 0xF1: six}",
            "{5: {name: five, models: [M1]}}",
            "{5: {name: five, title: The fifth}}",
        ],
        Key::Fields => &["{inner: {bits: 0}}", "{letter: {bytes: 4, as: text}, year: {bytes: 5}, day: {bytes: 6}}"],
        Key::Status => &["{late: {bit: 2}}"],
        Key::Format => &["\"{inner}\"", "\"{letter}/{number}\"", "\"{letter}.{year:2}.{day}\""],
        Key::Const | Key::Normal | Key::Starting | Key::Continues => &["1"],
        // The second one lies in the range of the controllers.
        Key::Send => &["1", "0xF1"],
        Key::Default => &["11", "5", "bright", "busy", "x"],
        Key::Outside => &["refused"],
        Key::Reply => &["{priority: 5}"],
        Key::In => &["[request]", "[reply]"],
        Key::Models => &["[M1]"],
        Key::Examples => &["[{bytes: 01, means: 1}]", "[{bytes: 4131, means: A49}]", "[{bytes: 01, means: bright}]"],
        Key::Title => &["A new title"],
        Key::Note => &["a new note"],
        Key::Section => &["\"9.9\""],
        Key::Erratum => &["E1"],
    };
    samples.to_vec()
}

/// Returns the words among which a key chooses, as the reference lists them, without that which an absent key stands for.
fn words(key: Key) -> Vec<&'static str> {
    let quoted = |cell: &'static str| cell.split('`').skip(1).step_by(2);
    let (words, default) = (quoted(row(key)[2]), row(key)[4]);
    words.filter(|word| !quoted(default).any(|absent| absent == *word)).collect()
}

/// The keys that lead to a field.
type Place = Vec<String>;

/// Keys that have an effect, but cannot be changed alone without an error.
///
/// All bits of the identifier are taken. An address that counts down has another offset. Only one field continues a set.
/// A code of devices that start needs one of those that answer.
const ALWAYS_ERRORS: [(Key, char); 5] =
    [(Key::Bits, 'I'), (Key::Scale, 'A'), (Key::Starting, 'I'), (Key::Starting, 'H'), (Key::Continues, 'I')];

/// What one sample of a key does in one place.
struct Trial {
    place: Place,
    key: Key,
    sample: &'static str,
    effect: Effect,
}

#[derive(PartialEq)]
enum Effect {
    Error,
    Change,
    Nothing,
}

#[test]
fn every_key_in_every_place_has_an_effect_or_is_an_error() {
    let trials = trials();
    let silent = trials.iter().filter(|trial| trial.effect == Effect::Nothing && !trial.is_for_readers());
    let silent: Vec<_> =
        silent.map(|trial| format!("{}.{}: {}", trial.place.join("."), trial.key.name(), trial.sample)).collect();
    assert!(silent.is_empty(), "{} without a word:\n{}", silent.len(), silent.join("\n"));
    let wrong: Vec<_> = Key::ALL.iter().filter_map(|key| misstated(*key, &trials)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Says where a key has an effect and where the reference says so, if that is not the same.
fn misstated(key: Key, trials: &[Trial]) -> Option<String> {
    let of_key = trials.iter().filter(|trial| trial.key == key && trial.effect == Effect::Change);
    let besides = ALWAYS_ERRORS.iter().filter(|(known, _)| *known == key).map(|(_, letter)| *letter);
    let used: BTreeSet<_> = of_key.filter_map(Trial::letter).chain(besides).collect();
    let stated = stated(key);
    (used != stated).then(|| format!("`{}` has an effect in {used:?}, the reference says {stated:?}", key.name()))
}

/// Returns what the reference says in the column "used in".
fn stated(key: Key) -> BTreeSet<char> {
    match row(key)[6].trim() {
        "entries of `types`" => BTreeSet::from(['A', 'M']),
        letters => letters.chars().filter(|letter| *letter != ' ').collect(),
    }
}

/// Returns the cells of a key in the table of the reference.
fn row(key: Key) -> Vec<&'static str> {
    let name = format!("`{}`", key.name());
    let (_, text) = REFERENCE.split_once("\n## Fields").expect("the reference has fields");
    let rows = text.lines().filter_map(|line| line.strip_prefix('|')).map(|line| line.split('|').collect::<Vec<_>>());
    let row = rows.into_iter().find(|cells| cells[0].contains(&name));
    row.unwrap_or_else(|| panic!("the reference has no {name}"))
}

/// Sets each key in each place.
fn trials() -> Vec<Trial> {
    let spec: Value = serde_yaml::from_str(SPEC).expect("the spec is YAML");
    let before = Compiled::of(&spec).unwrap_or_else(|errors| panic!("{errors}"));
    let mut frames = Frames::new(&before.protocol, 1);
    let frames: Vec<_> = (0..100).map(|_| frames.next_frame()).collect();
    let made = before.made(&frames).collect::<Vec<_>>();
    let effect = |changed: &Value| match Compiled::of(changed) {
        Err(_) => Effect::Error,
        Ok(after) if before.differs(&made, &after, &frames) => Effect::Change,
        Ok(_) => Effect::Nothing,
    };
    let places = places(&spec);
    let samples = places.iter().flat_map(|place| {
        let keys = Key::ALL.iter().flat_map(|key| samples(*key).into_iter().map(|sample| (*key, sample)));
        keys.map(move |(key, sample)| (place, key, sample))
    });
    let trial = |(place, key, sample): (&Place, Key, &'static str)| {
        let changed = with(&spec, place, key, sample);
        (changed != spec).then(|| Trial { place: place.clone(), key, sample, effect: effect(&changed) })
    };
    samples.collect::<Vec<_>>().into_par_iter().filter_map(trial).collect()
}

impl Trial {
    /// Tells whether it is a remark for readers of the spec: a type passes on neither its section nor its note.
    fn is_for_readers(&self) -> bool {
        matches!(self.key, Key::Section | Key::Note) && self.place.iter().any(|key| key == "types")
    }

    /// Returns the letter that the reference has for the place.
    fn letter(&self) -> Option<char> {
        match self.place[0].as_str() {
            "identifier" => Some('I'),
            "header" => Some('H'),
            "types" if ["controller", "module"].contains(&self.place[1].as_str()) => Some('A'),
            "types" | "messages" => Some('M'),
            _ => None,
        }
    }
}

/// A spec that is right.
struct Compiled {
    protocol: Protocol,
    examples: usize,
    warnings: BTreeSet<String>,
}

impl Compiled {
    /// Compiles a spec, or says what is wrong.
    fn of(spec: &Value) -> Result<Self, String> {
        let text = serde_yaml::to_string(spec).expect("YAML can be written");
        let source = Source::new("keys.yaml", text.into_bytes()).map_err(|errors| errors.concise())?;
        let Outcome { protocol, summary, diagnostics } = compile(source);
        let protocol = protocol.ok_or_else(|| diagnostics.concise())?;
        let warnings = diagnostics.located().map(|found| found.message.to_owned()).collect();
        Ok(Self { protocol, examples: summary.examples, warnings })
    }

    /// Tells whether something else is made of another spec; a warning more is not enough.
    fn differs(&self, made: &[String], other: &Self, frames: &[Frame]) -> bool {
        !self.warnings.is_subset(&other.warnings) || other.made(frames).zip(made).any(|(other, made)| other != *made)
    }

    /// Returns what the two engines make of a spec, one after the other; that a DBC shows something is not enough.
    fn made(&self, frames: &[Frame]) -> impl Iterator<Item = String> {
        let make: [fn(&Self, &[Frame]) -> String; 4] = [
            |spec, _| spec.examples.to_string(),
            |spec, _| emit::tokens(&spec.protocol, &Options::default()).to_string(),
            |spec, frames| received(&spec.protocol, frames),
            |spec, _| sent(&spec.protocol),
        ];
        make.into_iter().map(move |make| make(self, frames))
    }
}

fn received(protocol: &Protocol, frames: &[Frame]) -> String {
    frames.iter().map(|frame| format!("{:?}", decode(protocol, None, frame))).collect::<Vec<_>>().join("\n")
}

/// Returns the requests of each message: without any value, and without one of the values.
fn sent(protocol: &Protocol) -> String {
    let target = Target { name: "module".to_owned(), number: Some(3) };
    let mut sent = Vec::new();
    for (model, message) in models(protocol).flat_map(|model| protocol.messages.iter().map(move |known| (model, known)))
    {
        let values: Vec<_> = message.signals.iter().filter_map(|signal| value(protocol, signal)).collect();
        for left_out in message.signals.iter().map(|signal| Some(&signal.name)).chain([None]) {
            let values: Vec<_> = values.iter().filter(|(name, _)| Some(name) != left_out).cloned().collect();
            let frames = requests(protocol, model, None, &message.name, &target, None, &values);
            sent.push(format!("{frames:?}"));
        }
    }
    sent.join("\n")
}

/// Returns a value of a signal as a person writes it.
fn value(protocol: &Protocol, signal: &Signal) -> Option<(String, String)> {
    let meanings =
        [24, 1, 0].into_iter().filter(|bits| *bits <= signal.place.max()).map(|bits| physical(protocol, signal, bits));
    let text = match meanings.into_iter().find(|value| *value != Meaning::None)? {
        Meaning::Integer(number) => number.to_string(),
        Meaning::Number(number) => number.to_string(),
        Meaning::Name(text) | Meaning::Text(text) => text,
        Meaning::Status { .. } => "[]".to_owned(),
        Meaning::None => return None,
    };
    Some((signal.name.clone(), text))
}

/// Returns the place of each field.
fn places(spec: &Value) -> Vec<Place> {
    let mut found = Vec::new();
    for root in ["identifier", "header", "types"] {
        fields(spec, &[root], &mut found);
    }
    for (root, inside) in [("messages", "fields"), ("models", "types")] {
        for name in keys(spec, &[root]) {
            fields(spec, &[root, &name, inside], &mut found);
        }
    }
    found.push(["messages", "single", "value"].map(str::to_owned).to_vec());
    found
}

/// Adds the fields of a map, and those inside.
fn fields(spec: &Value, map: &[&str], found: &mut Vec<Place>) {
    for name in keys(spec, map) {
        let place = [map, &[name.as_str()]].concat();
        found.push(place.iter().map(|key| (*key).to_owned()).collect());
        fields(spec, &[&place[..], &["fields"]].concat(), found);
    }
}

fn keys(spec: &Value, map: &[&str]) -> Vec<String> {
    let map = map.iter().try_fold(spec, |value, key| value.get(*key)).and_then(Value::as_mapping);
    map.into_iter().flat_map(Mapping::keys).filter_map(Value::as_str).map(str::to_owned).collect()
}

/// Sets a key of a field.
fn with(spec: &Value, place: &[String], key: Key, sample: &str) -> Value {
    let mut changed = spec.clone();
    let field = place.iter().try_fold(&mut changed, |value, key| value.get_mut(key.as_str()));
    let field = field.and_then(Value::as_mapping_mut).expect("a place is one of the spec");
    field.insert(key.name().into(), serde_yaml::from_str(sample).expect("a sample is YAML"));
    changed
}
