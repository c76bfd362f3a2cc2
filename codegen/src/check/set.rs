#![doc = include_str!("../rules/set.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{IdentifierField, Kind, Message, Protocol, Selector, SelectorPlace, Set, Shape};
use crate::syntax::tree::Path;

/// The most members that a set can have: one bit each in the machine's widest integer.
const MOST: usize = 64;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    check_fields(protocol, diagnostics);
    let sets = protocol.messages.iter().enumerate().filter_map(|(index, message)| {
        let set = message.set.as_ref()?;
        Some(Checker { protocol, index, message, set })
    });
    for checker in sets {
        checker.check(diagnostics);
    }
}

/// Tests the fields that say whether more frames follow.
fn check_fields(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let fields = protocol.identifier.fields.iter().filter(|field| field.continues.is_some());
    let selectors = protocol.selectors.iter().filter(|selector| selector.continues.is_some());
    let fields: Vec<_> = fields.collect();
    let mut docs = fields.iter().map(|field| &field.doc).chain(selectors.clone().map(|selector| &selector.doc));
    if let Some(first) = docs.next() {
        for other in docs {
            let text = "two fields say whether more frames follow";
            let diagnostic = Diagnostic::error("set", other.path.key("continues").at_key(), text);
            let diagnostic = diagnostic.help("leave `continues` to one of the two");
            diagnostics.push(diagnostic.other(first.path.key("continues").at_key(), "the other field"));
        }
    }
    for field in fields {
        check_sent(field, diagnostics);
    }
    for selector in selectors.filter(|selector| selector.continues == Some(0)) {
        report_sent(&selector.name, &selector.doc.path, 0, diagnostics);
    }
}

/// Tests that a single frame does not say that more follow.
fn check_sent(field: &IdentifierField, diagnostics: &mut Diagnostics) {
    let sent = field.constant.or(field.send).or(field.normal).unwrap_or(0);
    if field.continues == Some(sent) {
        report_sent(&field.name, &field.doc.path, sent, diagnostics);
    }
}

fn report_sent(name: &str, path: &Path, sent: u32, diagnostics: &mut Diagnostics) {
    let text = format!("`{name}` is sent as {sent}, so every frame would say that more follow");
    let help = "give the field of the identifier another value to `send`";
    diagnostics.push(Diagnostic::error("set", path.key("continues").at_value(), text).help(help));
}

struct Checker<'a> {
    protocol: &'a Protocol,
    index: usize,
    message: &'a Message,
    set: &'a Set,
}

impl Checker<'_> {
    fn check(&self, diagnostics: &mut Diagnostics) {
        let mut report = |path: Path, text: String, help: &str| {
            diagnostics.push(Diagnostic::error("set", path.at_value(), text).help(help));
        };
        if self.protocol.continuation().is_none() {
            let text = format!("nothing says which frame of `{}` is the last", self.message.name);
            report(self.key("members"), text, "give a field of the identifier or the header `continues`");
        }
        if self.set.members.len() > MOST {
            let text = format!("`{}` has {} members, more than {MOST}", self.message.name, self.set.members.len());
            report(self.key("members"), text, "make two sets of it");
        }
        self.check_access(&mut report);
        for (position, member) in self.set.members.iter().enumerate() {
            self.check_member(&self.protocol.messages[*member], self.key("members").index(position), &mut report);
        }
    }

    fn key(&self, key: &str) -> Path {
        self.message.doc.path.key(key)
    }

    fn check_access(&self, report: &mut impl FnMut(Path, String, &str)) {
        let [access] = self.message.accesses.as_slice() else {
            let text = format!("the set `{}` has more than one access", self.message.name);
            return report(self.key("access"), text, "name the one by which it is asked for");
        };
        let known = &self.protocol.accesses[access.access];
        let name = &known.name;
        let lacking = self.set.kinds.iter().find(|kind| !known.kinds.contains(kind));
        if let Some(kind) = lacking {
            let text = format!("`{name}` has no {}", kind.name());
            report(self.key("in"), text, "name kinds of frames that the access of the set has");
        } else if self.set.kinds.contains(&Kind::Report) || !self.set.kinds.contains(&Kind::Reply) {
            let text = "a set of frames is a reply".to_owned();
            report(
                self.key("in"),
                text,
                "write `in: [reply]`, or `in: [request, reply]` if it is asked for in as many frames",
            );
        } else if !known.carries.contains(&Kind::Reply) || known.carries.contains(&Kind::Request) {
            let text = format!("`{name}` does not carry values in the reply alone, as a set does");
            report(self.key("access"), text, "name an access with `in: [reply]`");
        } else if known.kinds.contains(&Kind::Report) {
            report(
                self.key("access"),
                format!("`{name}` has reports, which are no set"),
                "name an access without `report`",
            );
        }
        if self.protocol.answering(access).is_none() {
            let text = format!("the replies of `{}` do not show which node sends them", self.message.name);
            let help = "use addressing modes whose replies hold the same one address that has no `send`";
            report(self.key("access"), text, help);
        }
    }

    fn check_member(&self, member: &Message, at: Path, report: &mut impl FnMut(Path, String, &str)) {
        let name = &member.name;
        let shapes: Vec<_> = member.shapes.iter().filter(|shape| self.is_of_set(member, shape)).collect();
        let reply = shapes.iter().find(|shape| shape.kind == Kind::Reply);
        if reply.is_some_and(|reply| reply.signals.is_empty()) {
            let text = format!("a reply of `{name}` carries nothing");
            report(at.clone(), text, "give it fields that a reply has, or take it out of the set");
        }
        if shapes.iter().any(|shape| shape.kind == Kind::Request && !shape.signals.is_empty()) {
            let text = format!("a request of `{name}` in a set would carry values");
            report(at.clone(), text, "take `request` out of the `in` of its fields");
        }
        if let Some(field) = shapes.iter().find_map(|shape| self.fixed(shape)) {
            let text = format!("frames of `{name}` always have the same value in `{field}`, so it cannot end the set");
            report(at.clone(), text, "take this constant out of `match`, of the access and of the addressing modes");
        }
        if member.length != self.message.length {
            let (found, wanted) = (member.length, self.message.length);
            let text = format!("`{name}` has {found} data bytes, the other frames of the set {wanted}");
            report(at.clone(), text, "give the set and its members the same `length`");
        }
        if !self.has_models(member) {
            let text = format!("a device model that has the set does not have `{name}`");
            report(at, text, "give the set the `models` that have all its members");
        }
    }

    fn is_of_set(&self, member: &Message, shape: &Shape) -> bool {
        member.accesses[shape.access].set == Some(self.index)
    }

    /// Returns the name of the field that ends the set if it has one value only.
    fn fixed(&self, shape: &Shape) -> Option<&str> {
        let continuation = self.protocol.continuation()?;
        let is_constant = |(index, _): &(usize, u64)| self.protocol.selectors[*index].place == continuation.place;
        let SelectorPlace::Identifier(field) = continuation.place else {
            let mut constants = shape.constants.iter().filter(|known| is_constant(known));
            let selector = |(index, _): &(usize, u64)| &self.protocol.selectors[*index];
            return constants.next().map(selector).map(|known: &Selector| known.name.as_str());
        };
        let field = &self.protocol.identifier.fields[field];
        let is_fixed =
            field.constant.is_some() || self.is_addressed(field.mask()) || shape.constants.iter().any(is_constant);
        is_fixed.then_some(field.name.as_str())
    }

    /// Tests whether an addressing mode of the set has a constant in a field.
    fn is_addressed(&self, field: u32) -> bool {
        let answers = self.message.accesses.iter().flat_map(|access| self.protocol.modes.iter().zip(&access.answers));
        let patterns = answers.filter_map(|(mode, who)| Some([mode.request.as_ref(), mode.reply((*who)?)]));
        patterns.flatten().flatten().any(|pattern| pattern.mask & field != 0)
    }

    /// Tests whether every device model that has the set has a member.
    fn has_models(&self, member: &Message) -> bool {
        let own = &self.message.models;
        member.models.is_empty() || !own.is_empty() && own.iter().all(|model| member.is_of(*model))
    }
}
