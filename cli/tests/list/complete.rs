//! Each text, number and name of a model stands in the full form, and in JSON.

use std::collections::BTreeSet;
use std::path::Path;

use canspec_codegen::model::{Doc, NamedValue, Protocol, Range, Signal, StatusBit};
use canspec_codegen::number::Rational;
use canspec_codegen::text::Text;
use serde_json::Value;

use super::{list, object, protocol, specs};

/// What must be found, each with what it is.
type Facts = BTreeSet<(&'static str, String)>;

#[test]
fn all_that_a_spec_says_stands_in_the_full_form() {
    for spec in specs() {
        // A table breaks lines between words.
        let full = without_blanks(&list(&spec, &["--full"]));
        for (what, fact) in facts(&protocol(&spec)) {
            assert!(full.contains(&without_blanks(&fact)), "{}: {what} `{fact}`", spec.display());
        }
    }
}

#[test]
fn all_that_a_spec_says_stands_in_json() {
    for spec in specs() {
        let mut texts = BTreeSet::new();
        collect(&object(&spec), &mut texts);
        for (what, fact) in facts(&protocol(&spec)) {
            let fact = if what == "bit rate" { format!("{fact}000") } else { fact };
            assert!(texts.contains(&fact), "{}: {what} `{fact}`", spec.display());
        }
    }
}

#[test]
fn a_message_alone_has_its_notes_and_the_errata_that_it_names() {
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs/infy.yaml");
    let shown = without_blanks(&list(&spec, &["--message", "set_module_output"]));
    let protocol = protocol(&spec);
    let message = protocol.messages.iter().find(|message| message.name == "set_module_output").expect("it is there");
    let mut facts = Facts::new();
    message.signals.iter().for_each(|signal| of_signal(&protocol, signal, &mut facts));
    of_doc(&message.doc, &mut facts);
    let named = protocol.errata.iter().filter(|erratum| message.doc.errata.contains(&erratum.name));
    facts.extend(named.map(|erratum| ("reason", erratum.because.for_people().to_owned())));
    assert!(facts.len() > 30, "{facts:?}");
    for (what, fact) in facts {
        assert!(shown.contains(&without_blanks(&fact)), "{what} `{fact}`");
    }
}

#[test]
fn a_message_in_parts_shows_what_says_how_much_comes() {
    for (spec, message, shown) in [
        ("fast_packets", "engine", "length in byte 1 of the first part"),
        ("parts", "cells", "as many elements as `state.cells` says"),
        ("parts_until_silence", "trips", "until `pause`"),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../tests/specs/features/{spec}.yaml"));
        let listed = without_blanks(&list(&path, &["--message", message]));
        assert!(listed.contains(&without_blanks(shown)), "{spec}: {listed}");
    }
}

#[test]
fn bits_of_the_identifier_without_a_name_are_listed() {
    let heading = |spec: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(spec);
        let text = list(&path, &["--full"]);
        let line = text.lines().find(|line| line.starts_with("Identifier of ")).expect("it is there").to_owned();
        (line, text)
    };
    // MEGMEET 2.1 prints six ones before the last bit.
    let (line, text) = heading("specs/megmeet.yaml");
    assert!(line.ends_with("7 sender, 6..1 always 1, 0 more."), "{line}");
    assert!(text.lines().any(|row| row.split_whitespace().eq(["6..1", "always", "1"])), "{text}");
    for spec in specs() {
        let (line, _) = heading(spec.to_str().expect("the path is text"));
        assert_eq!(covered(&line), covered_by(&protocol(&spec)), "{line}");
    }
}

/// Returns the bits of all spans that a line names.
fn covered(line: &str) -> u32 {
    let words = line.split(": ").nth(1).expect("it has spans").split(", ");
    let bits = words.flat_map(|words| {
        let span = words.split(' ').next().expect("it begins with bits");
        let (high, low) = span.split_once("..").unwrap_or((span, span));
        let [high, low]: [u32; 2] = [high, low].map(|bit| bit.parse().expect("it is a bit"));
        low..=high
    });
    bits.fold(0, |all, bit| all | 1 << bit)
}

fn covered_by(protocol: &Protocol) -> u32 {
    protocol.identifier.fields.iter().fold(protocol.identifier.mask, |all, field| all | field.mask())
}

#[test]
fn a_field_says_in_each_message_what_its_constant_means_there() {
    // GCP 3.3 uses command 0x0F for two purposes.
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs/gcp.yaml");
    for (message, meaning) in [
        ("limit_input_current", "sub_command = 0x1205: Limit the input current"),
        ("set_operating_mode", "sub_command = 0x1111: Set the mode of the DC input"),
    ] {
        let shown = list(&spec, &["--message", message]);
        assert!(shown.contains(meaning), "{shown}");
    }
}

#[test]
fn each_word_is_listed_with_its_owner() {
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs/megmeet.yaml");
    let text = list(&spec, &["--full"]);
    let types = text.split("\nTYPE ").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("it has types");
    assert!(types.contains("\nmodule_status.value "), "{types}");
    assert!(!types.contains("\nvalue "), "{types}");
}

#[test]
fn the_frames_of_a_sequence_stand_below_it_in_their_order() {
    let mut count = 0;
    for spec in specs() {
        let (text, json) = (list(&spec, &["--full"]), object(&spec));
        let protocol = protocol(&spec);
        let tables: Vec<_> = text.split("\nSEQUENCE ").skip(1).collect();
        assert_eq!(tables.len(), protocol.sequences.len(), "{}", spec.display());
        for (doc, table) in protocol.sequences.iter().zip(tables) {
            let place = format!("{}.", doc.path);
            let examples = protocol.examples.iter().filter(|example| example.doc.path.to_string().starts_with(&place));
            let ids: Vec<_> = examples
                .map(|example| format!("{:0digits$X}", example.id, digits = if example.extended { 8 } else { 3 }))
                .collect();
            let frames = table.split("\nFRAME ").nth(1).and_then(|rest| rest.split("\n\n").next()).unwrap_or_default();
            let shown: Vec<_> = frames.lines().skip(1).filter(|line| !line.starts_with(' ')).collect();
            assert_eq!(shown.len(), ids.len(), "{}: {table}", spec.display());
            assert!(shown.iter().zip(&ids).all(|(line, id)| line.starts_with(id.as_str())), "{ids:?}: {table}");
            let name = doc.path.to_string().rsplit('.').next().map(Value::from);
            let listed = json["examples"].as_array().expect("it is a list").iter();
            let listed: Vec<_> = listed.filter(|example| Some(&example["sequence"]) == name.as_ref()).collect();
            assert!(listed.iter().zip(&ids).all(|(example, id)| example["frames"][0]["id"] == **id), "{listed:?}");
            assert_eq!(listed.len(), ids.len());
            count += ids.len();
        }
    }
    assert!(count > 50, "{count} frames");
}

fn without_blanks(text: &str) -> String {
    text.split_whitespace().collect()
}

/// Collects texts and numbers, also those inside of others.
fn collect(value: &Value, texts: &mut BTreeSet<String>) {
    match value {
        Value::String(text) => {
            texts.insert(text.clone());
        }
        Value::Number(number) => {
            texts.insert(number.to_string());
        }
        Value::Array(items) => items.iter().for_each(|item| collect(item, texts)),
        Value::Object(members) => members.values().for_each(|member| collect(member, texts)),
        Value::Null | Value::Bool(_) => {}
    }
}

fn facts(protocol: &Protocol) -> Facts {
    let mut facts = Facts::new();
    protocol.docs().into_iter().for_each(|doc| of_doc(doc, &mut facts));
    let rates = protocol.bit_rates.iter().chain(protocol.models.iter().flat_map(|model| &model.bit_rates));
    facts.extend(rates.map(|rate| ("bit rate", (rate / 1000).to_string())));
    for erratum in &protocol.errata {
        for (what, text) in [("print", &erratum.prints), ("use", &erratum.uses), ("reason", &erratum.because)] {
            facts.insert((what, text.for_people().to_owned()));
        }
    }
    for enumeration in &protocol.enumerations {
        enumeration.values.iter().for_each(|value| of_value(value, &mut facts));
    }
    let contents = protocol.contents().flat_map(|message| &message.signals);
    contents.for_each(|signal| of_signal(protocol, signal, &mut facts));
    for model in &protocol.models {
        for own in &model.types {
            own.range.iter().for_each(|range| of_range(range, &mut facts));
            let numbers = [own.scale, own.offset, own.default].into_iter().flatten();
            facts.extend(numbers.map(|number| ("number of a model", number.to_string())));
        }
        facts.extend(model.facts.iter().map(|(name, _)| ("fact", name.for_people().to_owned())));
    }
    for known in &protocol.allowances {
        let texts = [&known.rule, &known.at, &known.because];
        facts.extend(texts.map(|text| ("accepted warning", text.for_people().to_owned())));
    }
    let of_types =
        protocol.types.iter().filter(|known| !is_address(protocol, &known.doc)).flat_map(|known| &known.keys);
    facts.extend(of_types.map(|(_, text)| ("key of a type", text.for_people().to_owned())));
    arrays(protocol, &mut facts);
    facts
}

fn is_address(protocol: &Protocol, doc: &Doc) -> bool {
    protocol.address_types.iter().any(|known| known.doc.path == doc.path)
}

/// Replaces the numbered titles of elements by that of their array, which is listed once.
fn arrays(protocol: &Protocol, facts: &mut Facts) {
    for message in protocol.contents() {
        for array in &message.arrays {
            for element in &array.elements {
                let title = message[*element].doc.title.as_ref();
                let title = title.map(|title| ("title", title.for_people().to_owned()));
                facts.retain(|fact| Some(fact) != title.as_ref());
            }
            of_doc(&array.doc, facts);
            facts.insert(("array", array.name.clone()));
        }
    }
}

fn of_doc(doc: &Doc, facts: &mut Facts) {
    let texts = [("title", &doc.title), ("note", &doc.note), ("section", &doc.section)];
    let texts = texts.into_iter().filter_map(|(what, text)| Some((what, text.as_ref()?)));
    let errata = doc.errata.iter().map(|name| ("erratum", name));
    facts.extend(texts.chain(errata).map(|(what, text): (_, &Text)| (what, text.for_people().to_owned())));
}

fn of_value(value: &NamedValue, facts: &mut Facts) {
    facts.insert(("named value", value.name.clone()));
    facts.extend(value.title.iter().map(|title| ("title of a value", title.for_people().to_owned())));
}

fn of_range(range: &Range, facts: &mut Facts) {
    facts.extend([range.minimum, range.maximum].map(|end| ("end of a range", end.to_string())));
}

fn of_signal(protocol: &Protocol, signal: &Signal, facts: &mut Facts) {
    of_doc(&signal.doc, facts);
    facts.extend(signal.unit.map(|unit| ("unit", unit.symbol.to_string())));
    if signal.encoding.by_model().is_empty() {
        signal.ranges().for_each(|(range, _)| of_range(&range, facts));
    }
    signal.specials.iter().for_each(|value| of_value(value, facts));
    facts.extend(signal.element.is_none().then(|| ("signal", signal.name.clone())));
    for own in signal.on_each() {
        own.range.iter().for_each(|range| of_range(range, facts));
        let Some(linear) = own.encoding.linear() else { continue };
        facts.extend((linear.scale != Rational::ONE).then(|| ("scale", linear.scale.to_string())));
        facts.extend((linear.offset != Rational::ZERO).then(|| ("offset", linear.offset.to_string())));
    }
    let word = signal.encoding.status_word();
    word.into_iter().flat_map(|word| protocol[word].bits_in(signal.place)).for_each(|bit| of_bit(bit, facts));
    signal.encoding.parts().iter().for_each(|part| of_signal(protocol, part, facts));
}

fn of_bit(bit: &StatusBit, facts: &mut Facts) {
    of_doc(&bit.doc, facts);
    facts.insert(("status bit", bit.name.clone()));
    let texts = [&bit.set_when, &bit.clear_when, &bit.effect, &bit.led];
    facts.extend(texts.into_iter().flatten().map(|text| ("condition or effect", text.for_people().to_owned())));
}
