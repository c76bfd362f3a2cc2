//! What the front end reads, refuses and says.

mod families;
mod gate;
mod hostile;
mod places;
mod reader;
#[cfg(feature = "render")]
mod rendered;
mod text;

use canspec_codegen::diagnostic::Diagnostics;
use canspec_codegen::rules::{self, Rule};
use canspec_codegen::source::Source;
use canspec_codegen::syntax::{ast, parse};

/// Finds a rule.
fn rule(name: &str) -> &'static Rule {
    rules::find(name).unwrap_or_else(|| panic!("there is no rule `{name}`"))
}

/// Seven lines that are a whole spec; what a test adds starts at line 8.
const WHOLE: &str = "\
canspec: 1
protocol: mini
title: Mini
document: {title: Mini CAN, version: V1}
length: 8
identifier: {command: {bits: 10..0}}
access: {read: {request: {}, reply: {}}}
";

fn source(text: &str) -> Source {
    Source::new("mini.yaml", text.as_bytes().to_vec()).expect("the text is accepted")
}

fn refusal(bytes: &[u8]) -> String {
    Source::new("mini.yaml", bytes.to_vec()).expect_err("the bytes are refused").concise()
}

fn errors(text: &str) -> Vec<String> {
    let (spec, diagnostics) = parse(source(text));
    assert_eq!(spec.is_none(), diagnostics.has_errors());
    diagnostics.concise().lines().map(str::to_owned).collect()
}

fn errors_after_whole(added: &str) -> Vec<String> {
    errors(&format!("{WHOLE}{added}"))
}

fn spec(added: &str) -> ast::Spec {
    let (spec, diagnostics) = parse(source(&format!("{WHOLE}{added}")));
    assert_eq!(diagnostics.concise(), "");
    spec.expect("a spec without errors")
}

fn lines(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(line).collect::<Vec<_>>().concat()
}

fn first(text: &str) -> Diagnostics {
    parse(source(text)).1
}

#[test]
fn a_whole_spec_is_read() {
    let spec = spec("messages:\n  one: {access: [read], fields: {voltage: {bytes: 0..3, as: float, unit: V}}}\n");
    assert_eq!(spec.protocol, "mini");
    assert_eq!(spec.messages["one"].fields["voltage"].bytes.as_deref(), Some("0..3"));
    assert!(matches!(&spec.identifier["command"], ast::IdentifierEntry::Field(field) if field.bits.is_some()));
}

#[test]
fn every_leaf_is_the_text_of_the_file() {
    let spec = spec(
        "timing: {a: {time: 0x10}, b: {time: 16}, c: {time: 18E5}, d: {time: 1_000}, e: {time: 010}, f: {time: .inf}}\n\
         types: {a: {values: {0x10: 1.50, 16: 2024-05-13, 0: \"on\"}}}\n",
    );
    let times: Vec<_> = spec.timing.values().map(|timing| timing.time.as_str()).collect();
    assert_eq!(times, ["0x10", "16", "18E5", "1_000", "010", ".inf"]);
    let values: Vec<_> =
        spec.types["a"].values.iter().map(|(raw, value)| (raw.as_str(), value.name.as_str())).collect();
    assert_eq!(values, [("0x10", "1.50"), ("16", "2024-05-13"), ("0", "on")]);
}

#[test]
fn texts_of_several_lines_and_comments_are_read() {
    let spec = spec(
        "# a ? in a comment\nprocedures:\n  start:\n    steps: # ?\n    - |\n      one\n      two\n    - >-\n      three\n      four\n    - five\n      six?\n",
    );
    let steps: Vec<_> = spec.procedures["start"].steps.iter().map(|step| step.0.as_str()).collect();
    assert_eq!(steps, ["one\ntwo\n", "three four", "five six?"]);
}

#[test]
fn one_document_with_its_mark_is_read() {
    assert_eq!(errors(&format!("---\n{WHOLE}...\n")), [""; 0]);
}
