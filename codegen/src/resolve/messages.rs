//! Messages: their signals, and the frames that exist of each.

use super::Resolver;
use super::access::pattern_of;
use super::patterns::Constant;
use super::signals::Leaves;
use super::texts::remarks;
use crate::diagnostic::Diagnostic;
use crate::model::{Access, Doc, Identifier, Kind, Message, MessageAccess, Mode, SelectorPlace, Shape, Signal, Timing};
use crate::syntax::ast;
use crate::syntax::tree::Path;

/// What messages refer to.
pub struct Surroundings<'a> {
    pub identifier: &'a Identifier,
    modes: &'a [Mode],
    pub accesses: &'a [Access],
    timing: &'a [Timing],
    length: u8,
}

/// What chooses the frames of a message, whatever its access.
pub struct Choice {
    /// Constants of `match`.
    pub matched: Vec<Constant>,
    /// Constants that replies show because of the message's fields.
    pub replies: Vec<Constant>,
    /// Constant fields, each with the only kinds of frames that have it.
    fixed: Vec<(Constant, Vec<Kind>)>,
}

impl Resolver<'_> {
    pub fn messages(
        &mut self,
        identifier: &Identifier,
        modes: &[Mode],
        accesses: &[Access],
        timing: &[Timing],
    ) -> Vec<Message> {
        let spec = self.spec;
        let length = self.integer(&Path::default().key("length"), &spec.length, 0, 8).unwrap_or(8);
        let surroundings = Surroundings { identifier, modes, accesses, timing, length };
        let root = Path::default().key("messages");
        let entries = spec.messages.iter();
        let resolved = entries.map(|(name, message)| self.message(&root.key(name), name, message, &surroundings));
        let (mut messages, choices): (Vec<_>, Vec<_>) = resolved.unzip();
        self.sets(&choices, &surroundings, &mut messages);
        self.check_travel(&messages);
        messages
    }

    fn message(
        &mut self,
        path: &Path,
        name: &str,
        message: &ast::Message,
        surroundings: &Surroundings,
    ) -> (Message, Choice) {
        self.check_name(path, name);
        let doc = remarks!(message).doc(path, None);
        let leaves = self.contents(path, name, message, &doc);
        let length = message.length.as_ref().and_then(|text| self.integer(&path.key("length"), text, 0, 8));
        let accesses = self.message_accesses(path, message, surroundings);
        let matched = self.constants(&path.key("match"), &message.pattern, surroundings.identifier);
        let fixed: Vec<_> = leaves.constants.into_iter().map(|(signal, value)| self.fixed(signal, value)).collect();
        let replies = self.reply_constants(&leaves.replies, surroundings.identifier);
        let choice = Choice { matched, replies, fixed };
        let set = self.set(path, message);
        self.tables.given_up.insert(name.to_owned(), leaves.given_up.into_iter().collect());
        let split = set.as_ref().map_or(&[][..], |set| &set.kinds);
        let mut shapes = Vec::new();
        for (index, access) in accesses.iter().enumerate() {
            let known = &surroundings.accesses[access.access];
            for kind in known.kinds.iter().filter(|kind| !split.contains(kind)) {
                let travel = self.access_constants(access.access, *kind, surroundings);
                let shape = self.shape(index, *kind, &choice, &travel, (&leaves.signals, known));
                self.check_constants(path, &shape.constants, (access.access, *kind));
                shapes.push(shape);
            }
        }
        let refused = accesses.iter().enumerate();
        let refusals = refused
            .filter_map(|(index, access)| self.refusal(path, index, &choice.matched, access, surroundings))
            .collect();
        let always = choice.fixed.iter().filter(|(_, kinds)| kinds.is_empty()).map(|(constant, _)| *constant);
        let constants = choice.matched.iter().copied().chain(always).collect();
        let every = self.every(path, message.every.as_deref(), surroundings.timing);
        let length = length.unwrap_or(surroundings.length);
        let models = self.message_models(&path.key("models"), &message.models);
        let name = name.to_owned();
        let signals = leaves.signals;
        let message = Message { name, doc, length, signals, constants, accesses, shapes, refusals, every, models, set };
        (message, choice)
    }

    /// Tests that every message has an access, or is a member of a set.
    fn check_travel(&mut self, messages: &[Message]) {
        let spec = self.spec;
        let lacking = messages.iter().zip(spec.messages.values()).filter(|(_, written)| written.access.is_empty());
        for (message, _) in lacking.filter(|(message, _)| message.set.is_some() || message.accesses.is_empty()) {
            let text = format!("`{}` has no access, so it has no frames", message.name);
            let known = spec.access.keys().next().map_or("read", String::as_str);
            let help = format!("name at least one access, for instance `access: [{known}]`");
            self.error_with_help("access", message.doc.path.key("access").at_key(), text, help);
        }
    }

    /// Finds the device models that have a message.
    fn message_models(&mut self, path: &Path, names: &[String]) -> Vec<usize> {
        let mut models = Vec::new();
        for (index, name) in names.iter().enumerate() {
            let at = path.index(index);
            let Some(model) = self.device_model(&at, name) else { continue };
            if models.contains(&model) {
                let text = format!("the model `{name}` is named twice");
                self.error_with_help("name", at.at_value(), text, "take one of the two out");
            } else {
                models.push(model);
            }
        }
        models
    }

    /// Returns what a reply shows because of the message's fields.
    fn reply_constants(&mut self, patterns: &[(Path, ast::Pattern)], identifier: &Identifier) -> Vec<Constant> {
        let mut constants: Vec<Constant> = Vec::new();
        for (path, pattern) in patterns {
            for constant in self.constants(path, pattern, identifier) {
                if !constants.contains(&constant) {
                    constants.push(constant);
                }
            }
        }
        constants
    }

    /// Resolves `fields` or `value`.
    fn contents(&mut self, path: &Path, name: &str, message: &ast::Message, doc: &Doc) -> Leaves {
        match &message.value {
            Some(value) if !message.fields.is_empty() => {
                let text = format!("`{name}` has both `fields` and `value`");
                let help = "`value` is the short form of one field called `value`; write one of the two";
                self.error_with_help("type", path.key("value").at_key(), text, help);
                let fields = self.message_leaves(&path.key("fields"), &message.fields, doc, name);
                let value = self.value_leaf(&path.key("value"), value, doc, name);
                let written = [fields, value].into_iter().flat_map(Leaves::names);
                Leaves { given_up: written.collect(), ..Leaves::default() }
            }
            Some(value) => self.value_leaf(&path.key("value"), value, doc, name),
            None => self.message_leaves(&path.key("fields"), &message.fields, doc, name),
        }
    }

    /// Makes a selector of a constant field; it is in the kinds of frames that the field names.
    fn fixed(&mut self, signal: Signal, value: u64) -> (Constant, Vec<Kind>) {
        let kinds = signal.kinds.clone();
        ((self.add_selector(signal, None), value), kinds)
    }

    fn message_accesses(
        &mut self,
        path: &Path,
        message: &ast::Message,
        surroundings: &Surroundings,
    ) -> Vec<MessageAccess> {
        let mut accesses: Vec<MessageAccess> = Vec::new();
        for (index, name) in message.access.iter().enumerate() {
            let names = surroundings.accesses.iter().map(|access| access.name.as_str());
            let Some(access) = self.lookup(&path.key("access").index(index), "access", name, names) else { continue };
            if accesses.iter().any(|earlier| earlier.access == access) {
                let text = format!("the access `{name}` is named twice");
                let at = path.key("access").index(index).at_value();
                self.error_with_help("access", at, text, "take one of the two out");
                continue;
            }
            let known = &surroundings.accesses[access];
            let answers = if message.answers.is_empty() {
                known.answers.clone()
            } else {
                self.answers(&path.key("answers"), &message.answers, surroundings.modes, &known.kinds)
            };
            accesses.push(MessageAccess { access, answers, set: None });
        }
        accesses
    }

    /// Returns what a kind of frame shows because of its access.
    pub fn access_constants(&mut self, access: usize, kind: Kind, surroundings: &Surroundings) -> Vec<Constant> {
        let spec = self.spec;
        let Some((name, access)) = spec.access.get_index(access) else { return Vec::new() };
        let Some(pattern) = pattern_of(access, kind) else { return Vec::new() };
        let path = Path::default().key("access").key(name).key(kind.name());
        self.constants(&path, pattern, surroundings.identifier)
    }

    /// Makes the frame of one kind of a message; `travel` is what it shows because of its access.
    pub fn shape(
        &self,
        index: usize,
        kind: Kind,
        choice: &Choice,
        travel: &[Constant],
        (signals, access): (&[Signal], &Access),
    ) -> Shape {
        let carries = access.carries.contains(&kind);
        let present = |kinds: &[Kind]| if kinds.is_empty() { carries } else { kinds.contains(&kind) };
        let mut constants = [&choice.matched, travel].concat();
        if kind == Kind::Reply {
            constants.extend(&choice.replies);
        }
        let header = constants.iter().any(|(selector, _)| self.is_payload(*selector));
        let fixed = choice.fixed.iter().filter(|(_, kinds)| kinds.is_empty() || kinds.contains(&kind));
        constants.extend(fixed.map(|(constant, _)| *constant));
        let mut selectors = if header { self.header() } else { Vec::new() };
        selectors.extend(constants.iter().map(|(selector, _)| *selector).filter(|selector| self.is_payload(*selector)));
        selectors.sort_unstable();
        selectors.dedup();
        let signals = signals.iter().enumerate().filter(|(_, signal)| present(&signal.kinds));
        Shape { access: index, kind, constants, selectors, signals: signals.map(|(index, _)| index).collect() }
    }

    /// Returns the frame that refuses a request of the message; it carries none of the message's fields.
    fn refusal(
        &mut self,
        path: &Path,
        index: usize,
        matched: &[Constant],
        access: &MessageAccess,
        surroundings: &Surroundings,
    ) -> Option<Shape> {
        let spec = self.spec;
        let (name, known) = spec.access.get_index(access.access)?;
        let pattern = known.refusal.as_ref()?;
        let path_of_pattern = Path::default().key("access").key(name).key("refusal");
        let travel = self.constants(&path_of_pattern, pattern, surroundings.identifier);
        let choice = Choice { matched: matched.to_vec(), replies: Vec::new(), fixed: Vec::new() };
        let known = &surroundings.accesses[access.access];
        let shape = self.shape(index, Kind::Reply, &choice, &travel, (&[], known));
        self.check_constants(path, &shape.constants, (access.access, Kind::Reply));
        Some(shape)
    }

    fn is_payload(&self, selector: usize) -> bool {
        matches!(self.tables.selectors[selector].place, SelectorPlace::Payload(_))
    }

    /// Returns the selectors that the header declares.
    pub fn header(&self) -> Vec<usize> {
        let root = Path::default().key("header");
        let selectors = self.tables.selectors.iter().enumerate();
        selectors
            .filter(|(_, selector)| selector.doc.path.ancestors().any(|outer| *outer == root))
            .map(|(index, _)| index)
            .collect()
    }

    /// Tests that no selector has two values.
    fn check_constants(&mut self, path: &Path, constants: &[Constant], (access, kind): (usize, Kind)) {
        let access = self.spec.access.get_index(access).map_or("", |(name, _)| name.as_str());
        for (index, (selector, value)) in constants.iter().enumerate() {
            let twice = constants[..index].iter().find(|(known, other)| known == selector && other != value);
            if let Some((_, other)) = twice {
                let name = &self.tables.selectors[*selector].name;
                let kind = kind.name();
                let message =
                    format!("in a {kind} by `{access}`, `{name}` would have to be both {other:#04X} and {value:#04X}");
                let pattern = Path::default().key("access").key(access).key(kind).key(name);
                let help = format!("take `{name}` out of `match` or out of the access, or correct one of the two");
                let diagnostic = Diagnostic::error("match", path.key("match").key(name).at_value(), message).help(help);
                self.diagnostics.push(diagnostic.other(pattern.at_value(), "the access"));
            }
        }
    }
}
