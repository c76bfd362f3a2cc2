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
struct Surroundings<'a> {
    identifier: &'a Identifier,
    modes: &'a [Mode],
    accesses: &'a [Access],
    timing: &'a [Timing],
    length: u8,
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
        spec.messages
            .iter()
            .map(|(name, message)| self.message(&root.key(name), name, message, &surroundings))
            .collect()
    }

    fn message(&mut self, path: &Path, name: &str, message: &ast::Message, surroundings: &Surroundings) -> Message {
        self.check_name(path, name);
        let doc = remarks!(message).doc(path, None);
        let leaves = self.contents(path, name, message, &doc);
        let length = message.length.as_ref().and_then(|text| self.integer(&path.key("length"), text, 0, 8));
        let accesses = self.message_accesses(path, message, surroundings);
        let matched = self.constants(&path.key("match"), &message.pattern, surroundings.identifier);
        let fixed: Vec<_> = leaves.constants.into_iter().map(|(signal, value)| self.fixed(signal, value)).collect();
        let replies = self.reply_constants(&leaves.replies, surroundings.identifier);
        let mut shapes = Vec::new();
        for (index, access) in accesses.iter().enumerate() {
            for kind in &surroundings.accesses[access.access].kinds {
                let mut constants =
                    [matched.clone(), self.access_constants(access.access, *kind, surroundings)].concat();
                if *kind == Kind::Reply {
                    constants.extend(&replies);
                }
                shapes.push(self.shape(path, (index, *kind), constants, &fixed, &leaves.signals, access, surroundings));
            }
        }
        let refused = accesses.iter().enumerate();
        let refusals =
            refused.filter_map(|(index, access)| self.refusal(path, index, &matched, access, surroundings)).collect();
        let fixed = fixed.into_iter().filter(|(_, kinds)| kinds.is_empty()).map(|(constant, _)| constant);
        let constants = matched.into_iter().chain(fixed).collect();
        let every = self.every(path, message.every.as_deref(), surroundings.timing);
        let length = length.unwrap_or(surroundings.length);
        let models = self.message_models(&path.key("models"), &message.models);
        let name = name.to_owned();
        let signals = leaves.signals;
        Message { name, doc, length, signals, constants, accesses, shapes, refusals, every, models }
    }

    /// Finds the device models that have a message.
    fn message_models(&mut self, path: &Path, names: &[String]) -> Vec<usize> {
        let mut models = Vec::new();
        for (index, name) in names.iter().enumerate() {
            let at = path.index(index);
            let Some(model) = self.device_model(&at, name) else { continue };
            if models.contains(&model) {
                self.error("name", at.at_value(), format!("the model `{name}` is named twice"));
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
            Some(_) if !message.fields.is_empty() => {
                let text = format!("`{name}` has both `fields` and `value`");
                let help = "`value` is the short form of one field called `value`; write one of the two";
                self.error_with_help("type", path.key("value").at_key(), text, help);
                Leaves::default()
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
        if message.access.is_empty() {
            let text = "the message has no access, so it has no frames".to_owned();
            self.error_with_help("access", path.key("access").at_key(), text, "name at least one access");
        }
        for (index, name) in message.access.iter().enumerate() {
            let names = surroundings.accesses.iter().map(|access| access.name.as_str());
            let Some(access) = self.lookup(&path.key("access").index(index), "access", name, names) else { continue };
            if accesses.iter().any(|earlier| earlier.access == access) {
                let text = format!("the access `{name}` is named twice");
                self.error("access", path.key("access").index(index).at_value(), text);
                continue;
            }
            let known = &surroundings.accesses[access];
            let answers = if message.answers.is_empty() {
                known.answers.clone()
            } else {
                self.answers(&path.key("answers"), &message.answers, surroundings.modes, &known.kinds)
            };
            accesses.push(MessageAccess { access, answers });
        }
        accesses
    }

    fn access_constants(&mut self, access: usize, kind: Kind, surroundings: &Surroundings) -> Vec<Constant> {
        let spec = self.spec;
        let Some((name, access)) = spec.access.get_index(access) else { return Vec::new() };
        let Some(pattern) = pattern_of(access, kind) else { return Vec::new() };
        let path = Path::default().key("access").key(name).key(kind.name());
        self.constants(&path, pattern, surroundings.identifier)
    }

    #[allow(clippy::too_many_arguments, reason = "a shape is the product of these")]
    fn shape(
        &mut self,
        path: &Path,
        (index, kind): (usize, Kind),
        mut constants: Vec<Constant>,
        fixed: &[(Constant, Vec<Kind>)],
        signals: &[Signal],
        access: &MessageAccess,
        surroundings: &Surroundings,
    ) -> Shape {
        let carries = surroundings.accesses[access.access].carries.contains(&kind);
        let present = |kinds: &[Kind]| if kinds.is_empty() { carries } else { kinds.contains(&kind) };
        let header = constants.iter().any(|(selector, _)| self.is_payload(*selector));
        let fixed = fixed.iter().filter(|(_, kinds)| kinds.is_empty() || kinds.contains(&kind));
        constants.extend(fixed.map(|(constant, _)| *constant));
        self.check_constants(path, &constants, (access.access, kind));
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
        let constants = [matched.to_vec(), self.constants(&path_of_pattern, pattern, surroundings.identifier)].concat();
        Some(self.shape(path, (index, Kind::Reply), constants, &[], &[], access, surroundings))
    }

    fn is_payload(&self, selector: usize) -> bool {
        matches!(self.tables.selectors[selector].place, SelectorPlace::Payload(_))
    }

    /// Returns the selectors that the header declares.
    fn header(&self) -> Vec<usize> {
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
                    format!("in a {kind} by `{access}`, `{name}` would have to be both {other:#X} and {value:#X}");
                let pattern = Path::default().key("access").key(access).key(kind).key(name);
                let diagnostic = Diagnostic::error("match", path.key("match").key(name).at_value(), message);
                self.diagnostics.push(diagnostic.other(pattern.at_value(), "the access"));
            }
        }
    }
}
