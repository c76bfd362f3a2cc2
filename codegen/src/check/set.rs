#![doc = include_str!("../../docs/rules/set.md")]

use crate::model::{
    Access, Constant, Exchange, FrameLayout, IdentifierField, Kind, Message, MessageId, Protocol, SelectorPlace, Set,
};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::report::tree::Path;
use crate::resolve::rules;

/// Largest number of members in a set: one for each bit of an integer of 64 bits.
const MOST: usize = 64;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    check_fields(protocol, diagnostics);
    let sets = protocol.messages.entries().filter_map(|(id, message)| {
        let set = message.set.as_ref()?;
        Some(Checker { protocol, id, message, set })
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
            let diagnostic = Diagnostic::error(&rules::SET, other.path.key("continues").at_key(), text);
            let diagnostic = diagnostic.help("leave `continues` to one of the two");
            diagnostics.push(diagnostic.other(first.path.key("continues").at_key(), "the other field"));
        }
    }
    for field in fields {
        check_sent(field, diagnostics);
    }
    for selector in selectors.filter(|selector| selector.continues == Some(0)) {
        let text = format!(
            "`{}` is sent as 0, as all of the header, so every frame would say that more follow",
            selector.name
        );
        let help = "use a field of the identifier, or another value of `continues`";
        let at = selector.doc.path.key("continues").at_value();
        diagnostics.push(Diagnostic::error(&rules::SET, at, text).help(help));
    }
}

/// Tests that a single frame does not say that more follow.
fn check_sent(field: &IdentifierField, diagnostics: &mut Diagnostics) {
    let sent = field.sent();
    if field.continues == Some(sent) {
        let text = format!("`{}` is sent as {sent}, so every frame would say that more follow", field.name);
        let help = format!("give it another value to send, for instance `send: {}`", u32::from(sent == 0));
        let at = field.doc.path.key("continues").at_value();
        diagnostics.push(Diagnostic::error(&rules::SET, at, text).help(help));
    }
}

fn wrong(at: At, text: impl Into<String>) -> Diagnostic {
    Diagnostic::error(&rules::SET, at, text)
}

struct Checker<'a> {
    protocol: &'a Protocol,
    id: MessageId,
    message: &'a Message,
    set: &'a Set,
}

impl Checker<'_> {
    fn check(&self, diagnostics: &mut Diagnostics) {
        let Self { protocol, message, set, .. } = self;
        let members = self.key("members");
        if protocol.continuation().is_none() {
            let text = format!("nothing says which frame of `{}` is the last", message.name);
            let help = "give one field the key `continues`, the value that it has if more frames follow, \
                        as in `more: {bits: 0, continues: 1}`";
            diagnostics.push(wrong(members.at_value(), text).help(help));
        }
        if set.members.len() > MOST {
            let text = format!("`{}` has {} members, more than {MOST}", message.name, set.members.len());
            diagnostics.push(wrong(members.at_value(), text).help("make two sets of it"));
        }
        self.check_access(diagnostics);
        self.check_length(diagnostics);
        for (position, member) in set.members.iter().enumerate() {
            self.check_member(&protocol.messages[*member], &members.index(position), diagnostics);
        }
    }

    fn key(&self, key: &str) -> Path {
        self.message.doc.path.key(key)
    }

    fn check_access(&self, diagnostics: &mut Diagnostics) {
        let [exchange] = &*self.message.exchanges else {
            let text = format!("the set `{}` has more than one access", self.message.name);
            let help = "name the one by which it is asked for";
            return diagnostics.push(wrong(self.key("access").at_value(), text).help(help));
        };
        let known = &self.protocol[exchange.access];
        if let Some(diagnostic) = self.wrong_kinds().filter(|_| known.kinds.contains(&Kind::Reply)) {
            diagnostics.push(diagnostic);
        } else if let Some(diagnostic) = self.misfit(known) {
            diagnostics.push(diagnostic.other(known.doc.path.at_key(), "the access"));
        }
        if self.protocol.answering(exchange).is_none() {
            diagnostics.push(self.nameless(exchange));
        }
    }

    /// Says why a set cannot have these kinds of frames.
    fn wrong_kinds(&self) -> Option<Diagnostic> {
        let (set, kinds) = (&self.message.name, &self.set.kinds);
        if !kinds.contains(&Kind::Report) && kinds.contains(&Kind::Reply) {
            return None;
        }
        let names: Vec<_> = kinds.iter().map(|kind| kind.name()).collect();
        let text = format!("the set `{set}` has `in: [{}]`, but the frames of a set are replies", names.join(", "));
        let help = "write `in: [reply]`, or `in: [request, reply]` if each member has a request, too";
        Some(wrong(self.key("in").at_value(), text).help(help))
    }

    /// Says why a set cannot have an access.
    fn misfit(&self, access: &Access) -> Option<Diagnostic> {
        let (set, name) = (&self.message.name, &access.name);
        let at = self.key("access").index(0).at_value();
        if let Some(kind) = self.set.kinds.iter().find(|kind| !access.kinds.contains(kind)) {
            let text = format!("the set `{set}` has no {}: the access `{name}` has none", kind.name());
            return Some(wrong(at, text).help("name an access with `request` and `reply`"));
        }
        if access.carries.contains(&Kind::Request) {
            let text = format!("requests by the access `{name}` carry values, those of a set do not");
            return Some(wrong(at, text).help(format!("name an access with `in: [reply]`, or add that to `{name}`")));
        }
        if !access.carries.contains(&Kind::Reply) {
            let text = format!("replies by the access `{name}` carry no values, those of a set do");
            return Some(wrong(at, text).help(format!("name an access with `in: [reply]`, or add that to `{name}`")));
        }
        access.kinds.contains(&Kind::Report).then(|| {
            let text = format!("the access `{name}` has reports, but a set has only requests and replies");
            wrong(at, text).help("name an access without `report`")
        })
    }

    /// Says that replies do not show which node sends them. If one addressing mode is the reason,
    /// it is shown.
    fn nameless(&self, exchange: &Exchange) -> Diagnostic {
        let text = format!("the replies of the set `{}` do not show which node sends them", self.message.name);
        let help = "let each pattern of the replies name the address of who answers, the same in all addressing modes";
        let diagnostic = wrong(self.key("access").index(0).at_value(), text).help(help);
        let answers = self.protocol.modes.iter().zip(&exchange.answers);
        let silent = answers.filter_map(|(mode, who)| {
            mode.reply((*who)?).filter(|pattern| pattern.addresses.is_empty())?;
            Some(mode.doc.path.at_key())
        });
        silent.fold(diagnostic, |known, at| known.other(at, "its replies name no address"))
    }

    /// Tests that the set has as many data bytes as its members.
    fn check_length(&self, diagnostics: &mut Diagnostics) {
        let members =
            self.set.members.iter().enumerate().map(|(position, member)| (position, &self.protocol.messages[*member]));
        let mut other = members.filter(|(_, member)| member.lengths != self.message.lengths);
        let Some((position, first)) = other.next() else { return };
        let [of_set, of_member] = [self.message, first].map(|message| {
            let lengths: Vec<_> = message.lengths.iter().map(u8::to_string).collect();
            lengths.join(" or ")
        });
        let (set, member) = (&self.message.name, &first.name);
        let text = format!("the set `{set}` has {of_set} data bytes, its member `{member}` has {of_member}");
        let help = "give the set and its members the same `length`";
        let diagnostic = wrong(self.key("length").at_value(), text).help(help);
        let at = |position: usize| self.key("members").index(position).at_value();
        let diagnostic = diagnostic.other(at(position), "has another length");
        diagnostics.push(other.fold(diagnostic, |known, (position, _)| known.other(at(position), "this one too")));
    }

    fn check_member(&self, member: &Message, at: &Path, diagnostics: &mut Diagnostics) {
        let name = &member.name;
        let frames = self.protocol.frames_of(member).filter(|frame| frame.set == Some(self.id));
        let frames: Vec<_> = frames.collect();
        let reply = frames.iter().find(|frame| frame.kind == Kind::Reply);
        if reply.is_some_and(|reply| reply.signals.is_empty()) {
            let text = format!("a reply of `{name}` has no field, so it carries nothing");
            let help = "give it fields that a reply has, or take it out of the set";
            let fields = member.signals.iter().map(|signal| signal.doc.path.at_key());
            let diagnostic = wrong(at.at_value(), text).help(help);
            diagnostics.push(fields.fold(diagnostic, |known, at| known.other(at, "this is in no reply")));
        }
        if frames.iter().any(|frame| frame.kind == Kind::Request && !frame.signals.is_empty()) {
            let text = format!("a request of `{name}` in a set would carry values");
            diagnostics.push(wrong(at.at_value(), text).help("take `request` out of the `in` of its fields"));
        }
        if let Some(field) = frames.iter().find_map(|frame| self.fixed(frame)) {
            let text = format!("`{field}` is constant in frames of `{name}`, so it cannot end the set");
            let help =
                format!("take the constant of `{field}` out of `match`, of the access and of the addressing modes");
            let diagnostic = wrong(at.at_value(), text).help(help);
            let places = self.constants(member, field).into_iter().filter(|path| diagnostics.has(path));
            diagnostics.push(places.fold(diagnostic, |known, path| known.other(path.at_value(), "the constant")));
        }
        if !self.has_models(member) {
            diagnostics.push(self.lacking(member, at));
        }
    }

    /// Says that a device model has the set but lacks one of its members.
    fn lacking(&self, member: &Message, at: &Path) -> Diagnostic {
        let lacking = self.message.models.iter().find(|model| !member.is_of(**model));
        let who = lacking.map_or_else(
            || "any device model can have".to_owned(),
            |model| format!("the model `{}` has", self.protocol.models[*model].name),
        );
        let text = format!("{who} the set `{}`, but not its member `{}`", self.message.name, member.name);
        let diagnostic = wrong(at.at_value(), text).help("give the set the `models` that have all its members");
        diagnostic.other(member.doc.path.key("models").at_key(), "the models of the member")
    }

    /// Returns the places in the spec where frames of the set can get a constant of a field.
    fn constants(&self, member: &Message, field: &str) -> Vec<Path> {
        let accesses = self.message.exchanges.iter().map(|exchange| &self.protocol[exchange.access].doc.path);
        let of_access = accesses.flat_map(|path| [path.key("request"), path.key("reply")]);
        let of_messages = [&self.message.doc.path, &member.doc.path].map(|path| path.key("match"));
        let of_modes = self.protocol.modes.iter().map(|mode| &mode.doc.path);
        let of_modes = of_modes.flat_map(|path| ["request", "one", "each", "coordinator"].map(|key| path.key(key)));
        of_access.chain(of_messages).chain(of_modes).map(|path| path.key(field)).collect()
    }

    /// Returns the name of the field that ends the set, if a constant fixes it.
    fn fixed(&self, frame: &FrameLayout) -> Option<&str> {
        let continuation = self.protocol.continuation()?;
        let constant = frame.constants.iter().find(|constant| constant.place == continuation.place);
        let SelectorPlace::Identifier(field) = continuation.place else {
            return constant.map(|Constant { selector, .. }| self.protocol[*selector].name.as_str());
        };
        let field = &self.protocol[field];
        let is_fixed = field.constant.is_some() || self.is_addressed(field.mask()) || constant.is_some();
        is_fixed.then_some(field.name.as_str())
    }

    /// Tests whether an addressing mode of the set has a constant in a field.
    fn is_addressed(&self, field: u32) -> bool {
        let answers = self.message.exchanges.iter();
        let answers = answers.flat_map(|exchange| self.protocol.modes.iter().zip(&exchange.answers));
        let patterns = answers.filter_map(|(mode, who)| Some([mode.request.as_ref(), mode.reply((*who)?)]));
        patterns.flatten().flatten().any(|pattern| pattern.mask & field != 0)
    }

    /// Tests whether every device model that has the set has a member.
    fn has_models(&self, member: &Message) -> bool {
        let own = &self.message.models;
        member.models.is_empty() || !own.is_empty() && own.iter().all(|model| member.is_of(*model))
    }
}
