//! Resolves sets: messages whose frames carry a member each. A set is one more way for a member to
//! travel, like an access.

use super::Resolver;
use super::messages::{Draft, Owner, Surroundings};
use super::patterns::distinct;
use crate::model::{Constant, Exchange, Id, Kind, Message, MessageId, SelectorId, Set, Table};
use crate::read::syntax::ast;
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;
use crate::resolve::rules;

/// The most sets that a message can be a member of.
const MOST_SETS: usize = 64;

impl Resolver<'_> {
    /// Reads `members` and `in` of a message. The members are looked up when all messages are
    /// known.
    pub fn set(&mut self, path: &Path, message: &ast::Message) -> Option<Set> {
        if message.members.is_empty() {
            if !message.kinds.is_empty() {
                let help = "take it out, or list `members`; to say which frames carry the fields, write `in` in the access or in a field";
                let text = "`in` means nothing for a message without `members`".to_owned();
                self.error_with_help(&rules::MISPLACED_KEY, path.key("in").at_key(), text, help);
            }
            return None;
        }
        let other = if message.value.is_some() { "value" } else { "fields" };
        if message.value.is_some() || !message.fields.is_empty() {
            let text = format!("a message with `members` has `{other}` of its own");
            let help =
                "a frame of a set carries one of its members; put the fields into a message, and name it in `members`";
            self.error_with_help(&rules::SET, path.key(other).at_key(), text, help);
        }
        let named = self.kinds(&path.key("in"), &message.kinds);
        let kinds = if message.kinds.is_empty() { vec![Kind::Reply] } else { named };
        Some(Set { members: Vec::new(), kinds, replies: Vec::new() })
    }

    /// Finds the members of each set, and gives them their frames in the set.
    pub fn sets(&mut self, surroundings: &Surroundings, drafts: &mut Table<MessageId, Draft>) {
        for id in drafts.ids() {
            let Some(mut set) = drafts[id].message.set.clone() else { continue };
            set.members = self.members(&drafts[id].message, drafts);
            for exchange in drafts[id].message.exchanges.clone() {
                for member in &set.members {
                    self.join((id, &set.kinds), *member, &exchange, surroundings, drafts);
                }
                let travel = self.access_constants(exchange.access, Kind::Reply, surroundings);
                set.replies = distinct([&drafts[id].choice.matched, &travel[..]].concat());
            }
            drafts[id].message.set = Some(set);
        }
    }

    /// Finds the members of a set.
    fn members(&mut self, set: &Message, drafts: &Table<MessageId, Draft>) -> Vec<MessageId> {
        let spec = self.spec;
        let written = spec.messages.get(&set.name).map_or(&[][..], |set| &set.members);
        let mut members = Vec::new();
        for (index, name) in written.iter().enumerate() {
            let at = set.doc.path.key("members").index(index);
            let Some(member) = spec.messages.get_index_of(name).map(MessageId::new) else {
                let offered = drafts.iter().map(|draft| &draft.message).filter(|message| message.set.is_none());
                let offered: Vec<_> = offered.map(|message| message.name.as_str()).collect();
                self.report_name(at.at_value(), "message", name, &offered, None);
                continue;
            };
            if members.contains(&member) {
                let text = format!("the member `{name}` is named twice");
                self.error_with_help(&rules::SET, at.at_value(), text, "take one of the two out");
            } else if drafts[member].message.set.is_some() {
                let help = "name its members instead";
                self.error_with_help(&rules::SET, at.at_value(), format!("`{name}` is a set of frames itself"), help);
            } else if drafts[member].message.exchanges.iter().filter(|known| known.set.is_some()).count() >= MOST_SETS {
                let text = format!("`{name}` is a member of more than {MOST_SETS} sets");
                let help = "describe the member once more under another name, or leave out sets that nobody asks for";
                self.error_with_help(&rules::SET, at.at_value(), text, help);
            } else {
                members.push(member);
            }
        }
        members
    }

    /// Lets a member travel as part of a set.
    fn join(
        &mut self,
        (set, kinds): (MessageId, &[Kind]),
        member: MessageId,
        exchange: &Exchange,
        surroundings: &Surroundings,
        drafts: &mut Table<MessageId, Draft>,
    ) {
        let exchange = Exchange { set: Some(set), ..exchange.clone() };
        let id = drafts[member].message.exchanges.push(exchange.clone());
        for kind in surroundings.accesses[exchange.access].kinds.iter().filter(|kind| kinds.contains(kind)) {
            let travel = self.access_constants(exchange.access, *kind, surroundings);
            let travel = [&drafts[set].choice.matched, &travel[..]].concat();
            let Draft { message: known, choice, .. } = &drafts[member];
            let owner =
                Owner { message: member, id, exchange: &exchange, lengths: &known.lengths, signals: &known.signals };
            let mut frame = self.layout(&owner, *kind, choice, &travel, surroundings);
            self.check_member(&drafts[set].message, &known.name, &frame.constants);
            frame.constants = distinct(frame.constants);
            frame.selectors.extend(self.continuing_header());
            frame.selectors.sort_unstable();
            frame.selectors.dedup();
            drafts[member].frames.push(frame);
        }
    }

    /// Returns the header if it says whether more frames follow. Every frame of a set then has it.
    fn continuing_header(&self) -> Vec<SelectorId> {
        let is_in_header = self.tables.selectors.iter().any(|selector| selector.continues.is_some());
        if is_in_header { self.tables.header.clone() } else { Vec::new() }
    }

    /// Tests that no selector has one value for the set and another one for its member.
    fn check_member(&mut self, set: &Message, member: &str, constants: &[Constant]) {
        let other =
            |one: &Constant| constants.iter().find(|other| other.selector == one.selector && *other != one).copied();
        let contrary = constants.iter().find_map(|one| Some((one, other(one)?)));
        let Some((one, other)) = contrary else { return };
        let name = &self.tables.selectors[one.selector].name;
        let (value, other) = (one.text(), other.text());
        let text = format!("in a frame of `{}`, `{name}` would have to be both {value} and {other}", set.name);
        let position =
            self.spec.messages.get(&set.name).and_then(|set| set.members.iter().position(|name| name == member));
        let at = set.doc.path.key("members").index(position.unwrap_or(0));
        let help = format!("take `{name}` out of the `match` of `{member}` or of the set");
        self.diagnostics.push(Diagnostic::error(&rules::MATCH, at.at_value(), text).help(help));
    }
}

#[cfg(test)]
mod tests {
    use crate::read::source::Source;
    use crate::{Outcome, compile};

    /// Compiles a spec of `count` sets of one member.
    fn sets(count: usize) -> Outcome {
        let set = |number| {
            format!("  s{number}: {{section: \"1\", match: {{command: {number}}}, access: [scan], members: [m]}}\n")
        };
        let spec = format!(
            "canspec: 1\nprotocol: p\ntitle: T\ndocument: {{title: T, version: V}}\nlength: 8\n\
             identifier: {{direction: {{bits: 10}}, command: {{bits: 9..3}}, node: {{bits: 2..1}}, more: {{bits: 0, continues: 1}}}}\n\
             types: {{module: {{range: 0..3}}}}\n\
             addressing: {{single: {{request: {{direction: 0, node: module}}, one: {{direction: 1, node: module}}}}}}\n\
             access: {{scan: {{request: {{}}, reply: {{}}, in: [reply], answers: {{single: one}}}}}}\n\
             messages:\n  m: {{section: \"1\", value: {{bytes: 0}}}}\n{}",
            (0..count).map(set).collect::<Vec<_>>().concat()
        );
        compile(Source::new("sets.yaml", spec.into()).expect("plain text"))
    }

    #[test]
    fn a_message_is_a_member_of_64_sets_and_no_more() {
        assert_eq!(sets(64).diagnostics.concise(), "");
        let errors = sets(65).diagnostics.concise();
        assert!(errors.contains("error[set]: `m` is a member of more than 64 sets"), "{errors}");
    }
}
