//! A spec that is based on another one means the same as both written out in one.

use canspec_codegen::emit::{self, Options};
use canspec_codegen::source::Source;
use canspec_codegen::{Bases, Outcome, compile};
use canspec_tests::random_specs::Spec;
use canspec_tests::random_specs::yaml::written;
use rayon::prelude::*;
use serde_yaml::{Mapping, Value};

const MEGMEET: &str = include_str!("../../specs/megmeet.yaml");

/// Rectifiers that speak MEGMEET's protocol, with another scale, another message and without the last barcode.
const DERIVED: &str = r"
canspec: 1
protocol: megmeet_like
title: Rectifiers with the protocol of others
based_on: megmeet
replaces: [messages.rated_current.value.scale, messages.rated_current.examples]
removes: [messages.barcode_4]
messages:
  rated_current:
    value: {scale: 1/10}
    examples:
      - {reply: 1081827E#0188271000000000, means: 1000 A}
  own_word: {section: megmeet 2.2.2, match: {signal: 0xFFE}, access: [read], value: {type: III}}
";

/// Edits of the base that write the same out.
const WRITTEN_OUT: [(&str, &str); 9] = [
    ("protocol: megmeet\n", "protocol: megmeet_like\n"),
    ("title: MEGMEET rectifier modules\n", "title: Rectifiers with the protocol of others\n"),
    ("document: {", "documents:\n  megmeet: {"),
    ("section: \"", "section: \"megmeet "),
    ("value: {type: VII, scale: 1/100, unit: A}", "value: {type: VII, scale: 1/10, unit: A}"),
    ("      - {request: 108182FE#0188000000000000, origin: ours}\n", ""),
    ("means: 100 A, origin: ours, note: \"the 100 A module of 2.2.2\", erratum: M16}", "means: 1000 A}"),
    ("  barcode_4:", "  # barcode_4:"),
    (
        "\nquantities:\n",
        "\n  own_word: {section: megmeet 2.2.2, match: {signal: 0xFFE}, access: [read], value: {type: III}}\nquantities:\n",
    ),
];

/// Returns the Rust, the dissector and the DBC of a spec, or its errors.
fn outputs(text: &str, bases: &Bases) -> Result<[String; 3], String> {
    let source = Source::new("spec.yaml", text.into()).and_then(|source| bases.add_to(source));
    let Outcome { protocol, diagnostics, .. } = compile(source.map_err(|errors| errors.concise())?);
    let protocol = protocol.ok_or_else(|| diagnostics.concise())?;
    Ok([emit::rust(&protocol, &Options::default()), emit::wireshark(&protocol), emit::dbc(&protocol, None).text])
}

#[test]
fn a_built_in_protocol_can_be_changed_in_a_few_lines() {
    let bases = Bases::from_iter([("megmeet", MEGMEET)]);
    let written_out = WRITTEN_OUT.iter().fold(MEGMEET.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    let [derived, written_out] =
        [DERIVED, &written_out].map(|text| outputs(text, &bases).unwrap_or_else(|errors| panic!("{errors}")));
    assert!(derived == written_out);
    assert!(derived[0].contains("Section megmeet 2.2.2"));
}

/// Returns a spec that is based on `base`, and the same written out.
///
/// They change what chooses the first two messages, take away all examples, and give the last message another name.
fn changed(tree: &Value) -> Option<[Value; 2]> {
    let messages = tree.get("messages")?.as_mapping()?;
    let names: Vec<&str> = messages.keys().filter_map(Value::as_str).collect();
    let [first, second, .., last] = names[..] else { return None };
    let document = Mapping::from_iter([("title".into(), "t".into()), ("version".into(), "1".into())]);
    let mut derived = Mapping::from_iter(["canspec", "protocol", "title"].map(|key| (key.into(), tree[key].clone())));
    derived.insert("document".into(), document.clone().into());
    derived.insert("based_on".into(), "base".into());
    let mut own = Mapping::new();
    let mut whole = tree.clone();
    let mut replaces = Vec::new();
    for (name, other) in [(first, second), (second, first)] {
        let pattern = messages[other].get("match")?;
        whole["messages"][name]["match"] = pattern.clone();
        own.insert(name.into(), Mapping::from_iter([("match".into(), pattern.clone())]).into());
        if messages[name].get("match").is_some() {
            replaces.push(format!("messages.{name}.match"));
        }
    }
    let mut removes = vec![format!("messages.{last}")];
    for name in names.iter().filter(|name| **name != last) {
        if whole["messages"][*name].as_mapping_mut()?.shift_remove("examples").is_some() {
            removes.push(format!("messages.{name}.examples"));
        }
    }
    if whole.as_mapping_mut()?.shift_remove("examples").is_some() {
        removes.push("examples".to_owned());
    }
    let mut renamed = whole["messages"].as_mapping_mut()?.shift_remove(last)?;
    renamed.as_mapping_mut()?.shift_remove("examples");
    own.insert("another_name".into(), renamed.clone());
    whole["messages"].as_mapping_mut()?.insert("another_name".into(), renamed);
    if let Some(known) = whole.as_mapping_mut()?.insert("document".into(), document.into()) {
        let others = whole.get("documents").and_then(Value::as_mapping).cloned().unwrap_or_default();
        let documents: Mapping = std::iter::once(("base".into(), known)).chain(others).collect();
        whole.as_mapping_mut()?.insert("documents".into(), documents.into());
    }
    for (key, value) in [("replaces", replaces), ("removes", removes)] {
        derived.insert(key.into(), value.into_iter().map(Value::from).collect::<Vec<_>>().into());
    }
    derived.insert("messages".into(), own.into());
    Some([derived.into(), whole])
}

/// Returns the Rust and the dissector, without the documentation, where sections have the name of their document.
fn code([rust, dissector, _]: [String; 3]) -> [String; 2] {
    let lines: Vec<_> = rust.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    [lines.join("\n"), dissector]
}

/// Tests whether a random spec can be changed and is then right, if it can be changed.
fn is_right_as_a_base(seed: u64) -> Option<bool> {
    let spec = Spec::new(seed);
    let [derived, whole] = changed(&spec.tree)?;
    let bases = Bases::from_iter([("base", spec.text.clone())]);
    let [derived, whole] = [derived, whole].map(|spec| outputs(&written(&spec), &bases).map(code));
    assert!(derived.is_ok() == whole.is_ok(), "{seed}: {derived:?}\n{whole:?}");
    let (Ok(derived), Ok(whole)) = (derived, whole) else { return Some(false) };
    for (derived, whole) in derived.iter().zip(&whole) {
        let different = derived.lines().zip(whole.lines()).find(|(derived, whole)| derived != whole);
        assert!(derived == whole, "{seed}: {different:?}");
    }
    Some(true)
}

#[test]
fn a_random_spec_can_be_changed_as_if_it_were_written_anew() {
    let tried: Vec<_> = (0..150).into_par_iter().filter_map(is_right_as_a_base).collect();
    let right = tried.iter().filter(|is_right| **is_right).count();
    assert!(right >= 20, "of {} specs {right} are right", tried.len());
}
