//! Finds where a mistake begins. The parser often notices it only further on.

use std::ops::Range;

use crate::read::syntax::rules;
use crate::report::diagnostic::Diagnostic;

/// Finds a quote without an end. The parser stops at its start.
pub(super) fn open_quote(text: &str, at: usize, complaint: &str) -> Option<Diagnostic> {
    let is_open = complaint.contains("indentation in quoted") || complaint.contains("unexpected end of stream");
    let quote = text[at..].chars().next().filter(|character| is_open && matches!(character, '"' | '\''))?;
    let message = format!("this `{quote}` is not closed");
    Some(Diagnostic::error(&rules::YAML, at..at + 1, message).help(format!("close it with another `{quote}`")))
}

/// Finds out whether the map or the list that starts at `opened` has no end, or the wrong one.
pub(super) fn open_bracket(text: &str, at: Range<usize>, opened: Option<usize>) -> Option<Diagnostic> {
    let start = opened?;
    let (bracket, end) = if text[start..].starts_with('{') { ('{', '}') } else { ('[', ']') };
    let found = text[at.clone()].chars().next();
    if let Some(wrong) = found.filter(|found| matches!(found, ']' | '}') && *found != end) {
        let message = format!("`{wrong}` does not close this `{bracket}`");
        let diagnostic = Diagnostic::error(&rules::YAML, at, message).other(start..start + 1, "opened here");
        return Some(diagnostic.help(format!("write `{end}`, or add the bracket that is missing")));
    }
    if !goes_on_outside(text, start, at.start) {
        return None;
    }
    let diagnostic = Diagnostic::error(&rules::YAML, start..start + 1, format!("this `{bracket}` is not closed"));
    let diagnostic = match comment_within(text, start..at.start, end) {
        Some(comment) => {
            let help = format!("quote the text that holds ` #`, or put `{end}` before the comment");
            diagnostic.other(comment, "` #` begins a comment, up to the end of the line").help(help)
        }
        None => {
            diagnostic.other(at, format!("here `,` or `{end}` was expected")).help(format!("close it with `{end}`"))
        }
    };
    Some(diagnostic)
}

/// Finds the sign that makes a comment of the end of a bracket.
fn comment_within(text: &str, within: Range<usize>, end: char) -> Option<Range<usize>> {
    let line = line_from(text, within.start);
    let (before, comment) = line.split_once(" #")?;
    let is_quoted = before.matches('"').count() % 2 == 1;
    let at = within.start + before.len() + 1;
    (comment.contains(end) && !is_quoted && within.contains(&at)).then_some(at..at + 1)
}

/// Tests whether the text ends, or goes on no deeper than the line that opens a bracket.
fn goes_on_outside(text: &str, start: usize, at: usize) -> bool {
    let depth = indentation(line_of(text, start));
    let end = at + line_from(text, at).len();
    let mut after = text[start..end].lines().skip(1).filter(|line| says_something(line));
    text[at..].trim().is_empty() || after.any(|line| indentation(line) <= depth)
}

/// Finds what is missing in the line above, which the parser has taken for the start of a longer text.
pub(super) fn line_above(text: &str, at: usize) -> Option<Diagnostic> {
    let here = text[..at].rfind('\n').map_or(0, |end| end + 1);
    if text[here..at].contains(": ") {
        return None;
    }
    let (start, item) = entry_above(text, here)?;
    if let Some(rest) = item.strip_prefix('-').filter(|rest| !rest.starts_with(['-', ' '])) {
        let diagnostic = Diagnostic::error(&rules::YAML, start..start + 1, "no blank after the `-`");
        return Some(diagnostic.help(format!("write `- {rest}`")));
    }
    let name = item.split(|letter: char| !letter.is_alphanumeric() && letter != '_').next()?;
    let rest = &item[name.len()..];
    if name.is_empty() || rest.contains(": ") || rest.ends_with(':') {
        return None;
    }
    if let Some(value) = rest.strip_prefix(':') {
        let colon = start + name.len();
        let diagnostic =
            Diagnostic::error(&rules::YAML, colon..colon + 1, format!("no blank after the `:` of `{name}`"));
        return Some(diagnostic.help(format!("write `{name}: {value}`")));
    }
    let diagnostic = Diagnostic::error(&rules::YAML, start..start + item.len(), format!("`{item}` has no `:`"));
    let entry = format!("{name}: {}", rest.trim_start());
    Some(diagnostic.help(format!("write `{}`, or quote the text that it belongs to", entry.trim_end())))
}

/// Says how to write a map in one line that lacks braces, as `temperature: bytes: 4`.
pub(super) fn without_braces(text: &str, at: usize) -> Option<String> {
    let (name, value) = line_of(text, at).trim().split_once(": ")?;
    let (key, _) = value.split_once(": ")?;
    let is_name = |word: &str| !word.is_empty() && word.chars().all(|letter| letter.is_alphanumeric() || letter == '_');
    let has_names = is_name(name) && is_name(key);
    has_names.then(|| format!("write `{name}: {{{value}}}`, or quote the text: `{name}: \"{value}\"`"))
}

/// Returns the last entry of a map or a list that starts before the line at `here`, without the `-` of an item.
fn entry_above(text: &str, here: usize) -> Option<(usize, &str)> {
    let mut end = here;
    for line in text[..here].split_inclusive('\n').rev() {
        end -= line.len();
        if says_something(line) {
            let written = line.trim();
            let item = written.strip_prefix("- ").unwrap_or(written).trim_start();
            return Some((end + indentation(line) + written.len() - item.len(), item));
        }
    }
    None
}

/// Tests whether there is more in a line than blanks and a comment.
fn says_something(line: &str) -> bool {
    !line.trim_start().is_empty() && !line.trim_start().starts_with('#')
}

fn indentation(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

fn line_of(text: &str, at: usize) -> &str {
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    line_from(text, start)
}

fn line_from(text: &str, at: usize) -> &str {
    text[at..].split('\n').next().unwrap_or_default()
}
