//! Resolves accesses: which frames exist, which of them carry the signals, and who answers.

use super::Resolver;
use super::patterns::{Entries, entries};
use super::texts::remarks;
use crate::model::keywords::{ANSWERS, SIDES};
use crate::model::{Access, AccessId, Answers, Kind, Mode, ModeId, Side, Table, Timing, TimingId, Who};
use crate::read::syntax::ast;
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;
use crate::resolve::rules;

/// The addressing modes.
pub type Modes = Table<ModeId, Mode>;
/// The times that the document states.
pub type Times = Table<TimingId, Timing>;

impl Resolver<'_> {
    pub fn accesses(&mut self, modes: &Modes, timing: &Times) -> Table<AccessId, Access> {
        let root = Path::default().key("access");
        let spec = self.spec;
        spec.access.iter().map(|(name, access)| self.access(&root.key(name), name, access, modes, timing)).collect()
    }

    fn access(&mut self, path: &Path, name: &str, access: &ast::Access, modes: &Modes, timing: &Times) -> Access {
        self.check_name(path, name);
        let kinds: Vec<_> = Kind::ALL.into_iter().filter(|kind| pattern_of(access, *kind).is_some()).collect();
        if kinds.is_empty() {
            let help = "write `request: {}`, `reply: {}` or `report: {}`";
            self.error_with_help(&rules::ACCESS, path.at_key(), format!("the access `{name}` has no frames"), help);
        }
        self.check_not_empty(path, &["in"]);
        let named = self.kinds(&path.key("in"), &access.kinds);
        let carries = if access.kinds.is_empty() { kinds.clone() } else { named };
        self.check_carries(path, name, access, &kinds);
        let from = self.sender(path, name, access);
        let every = self.every(path, access.every.as_deref(), timing);
        if access.every.is_some() && access.report.is_none() {
            self.misplaced_every(path, "an access", "add `report: {}`");
        }
        let (doc, answers) = (remarks!(access).doc(path, None), modes.map(|_| None));
        let mut known = Access { name: name.to_owned(), doc, kinds, carries, answers, every, from };
        known.answers = self.answers(&path.key("answers"), &access.answers, modes, &known);
        known
    }

    /// Reads who sends the reports. A controller's report shares neither modes nor answers with another frame.
    fn sender(&mut self, path: &Path, name: &str, access: &ast::Access) -> Side {
        let at = path.key("from");
        let Some(written) = &access.from else { return Side::Module };
        if access.report.is_none() {
            let text = format!("`from` means nothing for `{name}`, which has no report");
            let help =
                "take it out, or add `report: {}`; a request comes from the controller, and a reply from a module";
            self.error_with_help(&rules::MISPLACED_KEY, at.at_key(), text, help);
            return Side::Module;
        }
        let Some(word) = self.lookup(&at, "side", written, SIDES.iter().map(|(word, _)| *word)) else {
            return Side::Module;
        };
        let side = SIDES[word].1;
        if side == Side::Controller && (access.request.is_some() || access.reply.is_some()) {
            let other = if access.request.is_some() { "request" } else { "reply" };
            let text = format!("`{name}` has a report of the controller beside a {other}");
            let help = "give the report an access of its own, so that its `answers` are clear";
            let diagnostic = Diagnostic::error(&rules::ACCESS, at.at_value(), text).help(help);
            self.diagnostics.push(diagnostic.other(path.key(other).at_key(), format!("the {other}")));
            return Side::Module;
        }
        side
    }

    /// Tests that the frames that carry the signals exist.
    fn check_carries(&mut self, path: &Path, name: &str, access: &ast::Access, kinds: &[Kind]) {
        for (index, word) in access.kinds.iter().enumerate() {
            let kind = Kind::ALL.into_iter().find(|kind| kind.name() == word);
            if kind.is_some_and(|kind| !kinds.contains(&kind)) {
                let help = format!("add `{word}: {{}}` to the access, or take it out of `in`");
                let at = path.key("in").index(index).at_value();
                self.error_with_help(&rules::ACCESS, at, format!("the access `{name}` has no {word}"), help);
            }
        }
    }

    /// Reads `{mode: who}`, by the modes of the protocol.
    pub fn answers(&mut self, path: &Path, answers: &ast::Map<String>, modes: &Modes, access: &Access) -> Answers {
        let mut resolved = modes.map(|_| None);
        for (name, who) in answers {
            let at = path.key(name);
            let Some(mode) = self.lookup_key_in(&at, "addressing mode", name, modes, |mode| &mode.name) else {
                continue;
            };
            let words = ANSWERS.iter().map(|(word, _)| *word);
            let Some(word) = self.lookup(&at, "way to answer", who, words) else { continue };
            resolved[mode] = Some(ANSWERS[word].1);
            self.check_answer(&at, &modes[mode], ANSWERS[word], access);
        }
        resolved
    }

    fn check_answer(&mut self, at: &Path, mode: &Mode, (word, who): (&str, Who), access: &Access) {
        if access.from == Side::Controller {
            self.check_receiver(at, who, &access.name);
        } else if who == Who::Nobody && access.kinds == [Kind::Report] {
            self.refuse_no_sender(at, mode, &access.name);
        } else if who != Who::Nobody && mode.reply(who).is_none() {
            let message = format!("the addressing mode `{}` has no `{word}`", mode.name);
            let others: Vec<_> = ANSWERS.iter().filter(|(_, who)| mode.reply(*who).is_some()).collect();
            let help = match others.as_slice() {
                [] => format!("add `{word}:` to `addressing.{}`, or write `nobody`", mode.name),
                [(other, _), ..] => format!("write `{other}`, or add `{word}:` to `addressing.{}`", mode.name),
            };
            let diagnostic = Diagnostic::error(&rules::ADDRESSING, at.at_value(), message).help(help);
            self.diagnostics.push(diagnostic.other(mode.doc.path.at_key(), "the mode"));
        }
        if access.has_to_module() && mode.request.is_none() {
            let message = format!("the addressing mode `{}` has no request", mode.name);
            let help = format!("add `request:` to `addressing.{}`, or leave the mode out here", mode.name);
            self.error_with_help(&rules::ADDRESSING, at.at_key(), message, help);
        }
        if who != Who::Nobody && access.kinds == [Kind::Request] {
            let help = "add `reply: {}` to the access, or write `nobody`";
            self.error_with_help(
                &rules::ACCESS,
                at.at_value(),
                format!("`{word}` answers, but there is no reply"),
                help,
            );
        }
    }

    /// Refuses a report of the controller that nobody gets.
    fn check_receiver(&mut self, at: &Path, who: Who, access: &str) {
        if who == Who::Nobody {
            let message = format!("nobody gets the report `{access}` of the controller");
            let help = "say who gets it: `one` module, or `each` of several";
            self.error_with_help(&rules::ACCESS, at.at_value(), message, help);
        }
    }

    /// Refuses a report of a module that nobody sends. The words say who answers, or who reports unasked.
    fn refuse_no_sender(&mut self, at: &Path, mode: &Mode, access: &str) {
        let message = format!("nobody sends the report `{access}`");
        let senders: Vec<_> = ANSWERS.iter().filter(|(_, who)| mode.reply(*who).is_some()).collect();
        let help = match senders.as_slice() {
            [] => format!("add `one:` to `addressing.{}`, and write `one` here for a report of one module", mode.name),
            [(sender, _), ..] => format!("say who sends it: write `{sender}`"),
        };
        self.error_with_help(&rules::ACCESS, at.at_value(), message, help);
    }

    /// Refuses `every` if there is no report.
    pub fn misplaced_every(&mut self, path: &Path, what: &str, otherwise: &str) {
        let text = format!("`every` means nothing for {what} without a report");
        let help = format!("take it out, or {otherwise}");
        self.error_with_help(&rules::MISPLACED_KEY, path.key("every").at_key(), text, help);
    }

    /// Finds the time of a cyclic report.
    pub fn every(&mut self, path: &Path, name: Option<&str>, timing: &Times) -> Option<TimingId> {
        let name = name?;
        let names = self.spec.timing.keys().map(String::as_str);
        self.lookup_or(&path.key("every"), "timing", name, names, "add the time to `timing` and write its name")?;
        timing.position(|known| known.name == name)
    }
}

/// Returns the constants that an access gives to a kind of frame.
pub fn pattern_of(access: &ast::Access, kind: Kind) -> Option<Entries<'_>> {
    match kind {
        Kind::Request => access.request.as_ref().map(entries),
        Kind::Reply => access
            .reply
            .as_ref()
            .map(|reply| reply.iter().map(|(name, values)| (name.as_str(), &values.0[..])).collect()),
        Kind::Report => access.report.as_ref().map(entries),
    }
}
