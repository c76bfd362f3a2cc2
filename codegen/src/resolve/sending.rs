//! Resolves what frames show beside their values. These are bits that nothing names, and fields of
//! the identifier that one message sends with a value of its own.

use super::Resolver;
use super::messages::Surroundings;
use crate::model::keywords::EXPECTED;
use crate::model::{FieldId, FrameLayout, IdentifierField, Reserved};
use crate::read::syntax::ast;
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;
use crate::resolve::rules;

impl Resolver<'_> {
    /// Reads what reserved bits are. A message takes the keys that it lacks from the protocol.
    pub fn reserved(&mut self, path: &Path, written: Option<&ast::Reserved>, outer: Reserved) -> Reserved {
        let Some(ast::Reserved { send, expect }) = written else { return outer };
        self.check_not_empty(path, &["reserved"]);
        let path = path.key("reserved");
        let sent: Option<u8> = send.as_ref().and_then(|text| self.integer(&path.key("send"), text, 0, 1));
        let expected = expect.as_ref().and_then(|word| {
            self.lookup(&path.key("expect"), "expectation", word, EXPECTED.iter().map(|(word, _)| *word))
        });
        Reserved {
            are_ones: sent.map_or(outer.are_ones, |sent| sent == 1),
            are_free: expected.map_or(outer.are_free, |index| EXPECTED[index].1),
        }
    }

    /// Reads the fields of the identifier that a message sends with a value of its own.
    pub fn own_sends(
        &mut self,
        path: &Path,
        pattern: &ast::Pattern,
        frames: &[FrameLayout],
        surroundings: &Surroundings,
    ) -> Vec<(FieldId, u32)> {
        let fields = &surroundings.identifier.fields;
        let mut sends = Vec::new();
        for (name, text) in pattern {
            let path = path.key(name);
            let Some(id) = self.lookup_key_in(&path, "field of the identifier", name, fields, |field| &field.name)
            else {
                continue;
            };
            let field = &fields[id];
            let is_matched = frames.iter().any(|frame| frame.identifier().any(|(known, _)| known == id));
            match decided(field, is_matched, surroundings) {
                None => sends.extend(self.integer(&path, text, 0, field.greatest()).map(|value| (id, value))),
                Some(by) => {
                    let text = format!("a message cannot choose `{name}`, since {by} says what it is");
                    let problem = Diagnostic::error(&rules::MATCH, path.at_key(), text);
                    let problem = problem.other(field.doc.path.at_key(), "the field");
                    self.diagnostics.push(problem.help("take it out of the message's `send`"));
                }
            }
        }
        sends
    }
}

/// Returns what else gives a field of the identifier its value.
fn decided(field: &IdentifierField, is_matched: bool, surroundings: &Surroundings) -> Option<&'static str> {
    let patterns = surroundings.modes.iter().flat_map(|mode| [&mode.request, &mode.one, &mode.each, &mode.coordinator]);
    let mut patterns = patterns.flatten();
    if field.constant.is_some() {
        Some("its `const`")
    } else if is_matched {
        Some("a `match` or an access")
    } else if patterns.any(|pattern| pattern.fixes(field, &surroundings.identifier.fields)) {
        Some("the addressing")
    } else {
        None
    }
}
