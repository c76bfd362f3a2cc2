//! Any bytes as a spec: whatever is said about them can be shown, and a spec without errors is of use.

use canspec_codegen::compile;
use canspec_codegen::diagnostic::{Diagnostic, Diagnostics};
use canspec_codegen::source::Source;

use super::emitted;
use super::specs::BASES;

/// Compiles the bytes, and uses what comes of them.
pub fn run(data: &[u8]) {
    let source = Source::new("spec.yaml", data.to_vec()).and_then(|source| BASES.add_to(source));
    let outcome = match source {
        Ok(source) => compile(source),
        Err(diagnostics) => return shown(&diagnostics),
    };
    shown(&outcome.diagnostics);
    match &outcome.protocol {
        Some(protocol) => emitted::check(protocol),
        None => assert!(outcome.diagnostics.has_errors(), "there is neither a protocol nor an error"),
    }
}

/// Tests that diagnostics are of known rules and about places of the text, and that people and programs can read them.
fn shown(diagnostics: &Diagnostics) {
    let items = diagnostics.sorted();
    for item in &items {
        placed(diagnostics, item);
    }
    let drawn = diagnostics.render(false);
    assert!(!drawn.contains(|letter: char| letter.is_control() && letter != '\n'), "{drawn:?}");
    assert!(diagnostics.render(true).len() >= drawn.len());
    assert_eq!(diagnostics.concise().lines().count(), items.len(), "{}", diagnostics.concise());
    for located in diagnostics.located() {
        let written = serde_json::to_string(&located).expect("a diagnostic is JSON");
        assert!(
            serde_json::from_str::<serde_json::Value>(&written).is_ok_and(|read| read["message"] == located.message)
        );
    }
}

fn placed(diagnostics: &Diagnostics, item: &Diagnostic) {
    for at in std::iter::once(&item.at).chain(item.others.iter().map(|(at, _)| at)) {
        let is_inside = diagnostics.span(at).is_none_or(|span| diagnostics.source().text().get(span).is_some());
        assert!(is_inside, "{item:?} is not inside the text");
    }
}
