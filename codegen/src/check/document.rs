#![doc = include_str!("../../docs/rules/document.md")]

use crate::model::Protocol;
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;
use crate::words::text::Text;

rules! {
    DOCUMENT "document" Check EITHER;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    if protocol.documents.is_empty() {
        let text = "the spec names no document";
        let help = "write `document: {title: .., version: ..}`, or several by name in `documents`";
        let at = Path::default().key("title").at_value();
        diagnostics.push(Diagnostic::error(&DOCUMENT, at, text).help(help));
        return;
    }
    let names: Vec<&str> = protocol.documents.iter().filter_map(|document| document.name.as_deref()).collect();
    if names.is_empty() {
        return;
    }
    let sections = sections(protocol, diagnostics);
    let is_of = |name: &str, section: &Text| documents(section).any(|word| word == name);
    let root = Path::default().key("documents");
    for name in names.iter().filter(|name| !sections.iter().any(|(_, section)| is_of(name, section))) {
        let text = format!("no section begins with `{name}`");
        let help = format!("write where the document has a fact, as in `section: \"{name} 2.1\"`, or take it out");
        let at = root.key(*name).at_key();
        // What has no section there may have none here.
        if !diagnostics.is_taken_over(&at) {
            diagnostics.push(Diagnostic::warning(&DOCUMENT, at, text).help(help));
        }
    }
    if protocol.documents.iter().any(|document| document.name.is_none()) {
        return;
    }
    let known = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    for (path, section) in sections {
        if !documents(&section).all(|word| names.contains(&word)) {
            let text = format!("`{}` is a section of no document", section.for_people());
            let help = format!("begin it with the name of its document: {known}");
            diagnostics.push(Diagnostic::error(&DOCUMENT, path.at_value(), text).help(help));
        }
    }
}

/// Returns the sections that the spec writes, each with its place.
fn sections(protocol: &Protocol, diagnostics: &Diagnostics) -> Vec<(Path, Text)> {
    let of_items = protocol.docs().into_iter().map(|doc| (&doc.path, &doc.section));
    let of_errata = protocol.errata.iter().map(|erratum| (&erratum.path, &erratum.section));
    let written = of_items.chain(of_errata);
    let written = written.filter_map(|(path, section)| Some((path.key("section"), section.clone()?)));
    written.filter(|(path, _)| diagnostics.has(path)).collect()
}

/// Returns the first word of each place that a section names, as in `P 2.1; C 4`.
fn documents(section: &Text) -> impl Iterator<Item = &str> {
    section.for_people().split(';').filter_map(|place| place.split_whitespace().next())
}
