//! Says what the YAML parser complains about, and what to do.

use std::ops::Range;

use super::{DEPTH_LIMIT, cause};
use crate::read::syntax::rules;
use crate::report::diagnostic::Diagnostic;

/// A part of the parser's message, our message, and the help.
const TRANSLATIONS: [(&str, &str, &str); 18] = [
    ("tab", "a tab stands where only spaces may", "indent with spaces"),
    ("unexpected end of stream", "this quoted text is never closed", "close it with the same quote"),
    ("unknown anchor", "an alias may not stand in a spec", "write out what it stands for"),
    (
        "mapping values are not allowed",
        "a `:` that ends no key",
        "quote the text that holds it, or look at the line above: a quote may be open there",
    ),
    (
        "illegal placement of ':'",
        "a `:` that ends no key",
        "quote the text that holds it, or close the bracket before it",
    ),
    (
        "expected ',' or '}'",
        "expected `,` or `}` in this map",
        "separate entries by `,`, close the map, or quote the text that goes on here",
    ),
    (
        "expected ',' or ']'",
        "expected `,` or `]` in this list",
        "separate items by `,`, close the list, or quote the text that goes on here",
    ),
    ("did not find expected key", "expected a key at this indentation", "indent the line like the keys around it"),
    ("did not find expected '-'", "expected a `-` at this indentation", "indent the line like the items around it"),
    ("simple key expect", "a line without a `:`", "write `name: value`, or indent it under the text it belongs to"),
    (
        "unknown escape",
        "unknown escape in a text in double quotes",
        "write `\\\\` for a backslash, or use single quotes",
    ),
    ("<document start>", "text after the end of the spec", "indent it like the keys it belongs to, or remove it"),
    ("after double-quoted", "text after a closing quote", "put the whole text in quotes"),
    ("expected node content", "expected a value here", "write it, or remove the indicator before it"),
    ("misplaced bracket", "a closing bracket without an opening one", "remove it, or quote the text that holds it"),
    ("sequence entries", "a `-` that starts no item", "start a line with it, or quote the text"),
    ("only valid inside a block", "a `-` that starts no item", "start a line with it, or quote the text"),
    (
        "indentation",
        "this line is indented too little or too much",
        "indent it like the lines it belongs to, and look at the line above: a bracket or a quote may be open there",
    ),
];

/// Complaints whose cause may be in the line above.
const BEGUN_ABOVE: [&str; 3] = ["mapping values are not allowed", "simple key expect", "did not find expected key"];

/// Turns the parser's message into a diagnostic. `opened` is the bracket that the parser is in.
pub(super) fn translate(text: &str, at: usize, complaint: &str, opened: Option<usize>) -> Diagnostic {
    let span = at..at + text[at..].chars().next().filter(|character| *character != '\n').map_or(0, char::len_utf8);
    if complaint.contains("recursion limit") {
        return too_deep(span);
    }
    let is_begun_above = opened.is_none() && BEGUN_ABOVE.iter().any(|part| complaint.contains(part));
    cause::open_quote(text, at, complaint)
        .or_else(|| cause::open_bracket(text, span.clone(), opened))
        .or_else(|| cause::line_above(text, at).filter(|_| is_begun_above))
        .unwrap_or_else(|| {
            let diagnostic = translated(text, span, complaint, opened);
            match cause::without_braces(text, at).filter(|_| is_begun_above) {
                Some(help) => diagnostic.help(help),
                None => diagnostic,
            }
        })
}

fn translated(text: &str, span: Range<usize>, complaint: &str, opened: Option<usize>) -> Diagnostic {
    if complaint.contains("unexpected character") {
        return unstartable(text, span);
    }
    let diagnostic = match TRANSLATIONS.iter().find(|(part, ..)| complaint.contains(part)) {
        Some((_, message, help)) => Diagnostic::error(&rules::YAML, span, *message).help(*help),
        None => Diagnostic::error(&rules::YAML, span, format!("this is not YAML: {complaint}"))
            .help("quote the text, or look at the line above: a bracket or a quote may be open there"),
    };
    match opened.filter(|_| complaint.contains("expected ','")) {
        Some(start) => diagnostic.other(start..start + 1, "opened here"),
        None => diagnostic,
    }
}

/// Reports a character with which only a quoted text can start.
fn unstartable(text: &str, span: Range<usize>) -> Diagnostic {
    let message = format!("an unquoted text cannot start with `{}`", &text[span.clone()]);
    let rest = text[span.start..].split(['\n', ',', '}', ']']).next().unwrap_or_default();
    let rest = rest.split(" #").next().unwrap_or_default().trim_end();
    Diagnostic::error(&rules::YAML, span, message).help(format!("quote the text: `\"{rest}\"`"))
}

/// Reports nesting that no spec needs.
pub(super) fn too_deep(span: Range<usize>) -> Diagnostic {
    let message = format!("maps and lists are nested deeper than {DEPTH_LIMIT} levels");
    Diagnostic::error(&rules::YAML, span, message).help("check the brackets and the indentation")
}
