//! Resolves transports: makes messages of their frames, and says what carries a message longer than
//! a frame.

mod isotp;
mod j1939;

use super::Resolver;
use super::texts::remarks;
use crate::model::{Id, Identifier, MessageId, Standard, Transport, TransportId};
use crate::read::syntax::ast::{self, Map};
use crate::report::tree::Path;
use crate::resolve::rules;

/// The kinds of transports.
static KINDS: [Kind; 2] = [j1939::KIND, isotp::KIND];

/// A kind of transport: what a standard says of its frames.
struct Kind {
    /// Its word in a spec.
    name: &'static str,
    /// Its messages, in the order of [`Standard::frames`].
    messages: &'static str,
    /// Finds what is wrong with a transport of this kind.
    flaw: fn(&ast::Spec, &str, &ast::Transport) -> Option<Flaw>,
    /// Makes the accesses of the sides that send its frames.
    accesses: fn(&ast::Spec, &str, &ast::Transport) -> Map<ast::Access>,
    /// Completes the message of a frame.
    complete: fn(&ast::Spec, &ast::Transport, &str, &mut ast::Message),
    /// Returns the standard as a sound transport uses it.
    standard: fn(&Identifier, &ast::Transport) -> Option<Standard>,
}

/// What is wrong with a transport: at the key of this name, in one sentence, and what to do.
struct Flaw {
    key: &'static str,
    text: String,
    help: String,
}

impl Flaw {
    fn new(key: &'static str, text: String, help: &str) -> Self {
        Self { key, text, help: help.to_owned() }
    }
}

impl Kind {
    /// Finds the kind of a transport.
    fn of(transport: &ast::Transport) -> Option<&'static Self> {
        KINDS.iter().find(|kind| kind.name == transport.kind)
    }

    /// Returns the names of the messages of a transport.
    fn names(&self, transport: &str) -> Vec<String> {
        self.frames().into_keys().map(|frame| named(transport, &frame)).collect()
    }

    /// Returns the messages of its frames, as the standard describes them.
    fn frames(&self) -> Map<ast::Message> {
        serde_yaml::from_str(self.messages).unwrap_or_default()
    }

    /// Finds what is wrong with a transport.
    fn flaw(&self, spec: &ast::Spec, name: &str, transport: &ast::Transport) -> Option<Flaw> {
        (self.flaw)(spec, name, transport)
            .or_else(|| {
                let accesses = (self.accesses)(spec, name, transport);
                let lacks_a_side = accesses.iter().any(|(_, access)| access.answers.is_empty());
                let text = "a transport needs a way to each side".to_owned();
                let help = "write a mode in `addressing` with `request` and `one`";
                lacks_a_side.then(|| Flaw::new("kind", text, help))
            })
            .or_else(|| {
                let taken = self.names(name).into_iter().find(|added| spec.messages.contains_key(added))?;
                let text = format!("a message has the name `{taken}`, which a frame of the transport has");
                Some(Flaw::new("kind", text, "rename the message or the transport"))
            })
    }

    /// Makes the messages of a transport's frames.
    fn messages(&self, spec: &ast::Spec, name: &str, transport: &ast::Transport) -> Map<ast::Message> {
        let made = self.frames().into_iter().map(|(frame, mut message)| {
            message.access = (self.accesses)(spec, name, transport).into_keys().collect();
            message.send.clone_from(&transport.send);
            message.section.clone_from(&transport.section);
            (self.complete)(spec, transport, &frame, &mut message);
            if spec.absent.as_deref() == Some("ones") {
                have_no_absent(&mut message.fields);
            }
            (named(name, &frame), message)
        });
        made.collect()
    }
}

/// Returns the spec with the frames of its transports as messages, behind its own.
pub fn expanded(spec: &ast::Spec) -> ast::Spec {
    let mut all = spec.clone();
    for (name, transport) in &spec.transports {
        let Some(kind) = Kind::of(transport) else { continue };
        if kind.flaw(spec, name, transport).is_none() {
            all.access.extend((kind.accesses)(spec, name, transport));
            all.messages.extend(kind.messages(spec, name, transport));
        }
    }
    all
}

impl Resolver<'_> {
    /// Reads the transports. Their messages are those that `expanded` has added.
    pub fn transports(&mut self, identifier: &Identifier) {
        let spec = self.spec;
        for (name, transport) in &spec.transports {
            let path = Path::default().key("transports").key(name);
            self.check_name(&path, name);
            let kinds = KINDS.iter().map(|kind| kind.name);
            let found = self.lookup(&path.key("kind"), "kind of transport", &transport.kind, kinds);
            let Some(kind) = found.map(|place| &KINDS[place]) else { continue };
            // The messages of a sound transport are there already.
            let places: Option<Vec<_>> =
                kind.names(name).iter().map(|message| spec.messages.get_index_of(message)).collect();
            let flaw = kind.flaw(spec, name, transport).filter(|_| places.is_none());
            if let Some(Flaw { key, text, help }) = flaw {
                let key = path.key(key);
                let at = if self.diagnostics.has(&key) { key.at_value() } else { path.at_key() };
                self.error_with_help(&rules::TRANSPORT, at, text, help);
                continue;
            }
            let Some(standard) = (kind.standard)(identifier, transport) else { continue };
            self.tables.transports.push(Transport {
                name: name.clone(),
                doc: remarks!(transport).doc(&path, None),
                standard,
                frames: places.unwrap_or_default().into_iter().map(MessageId::new).collect(),
            });
        }
    }

    /// Finds the transport of a message. One with an error of its own is not there.
    pub fn transport(&mut self, path: &Path, name: &str) -> Option<TransportId> {
        let names = self.spec.transports.keys().map(String::as_str);
        self.lookup_or(path, "transport", name, names, "describe it in `transports`")?;
        self.tables.transports.position(|known| known.name == name)
    }
}

/// Returns the name of a frame's message.
fn named(transport: &str, frame: &str) -> String {
    format!("{transport}_{frame}")
}

/// Makes an access by which a side sends frames of a transport.
fn access(side: &str, pattern: ast::Pattern, answers: Map<String>, transport: &ast::Transport) -> ast::Access {
    ast::Access {
        report: Some(pattern),
        from: Some(side.to_owned()),
        answers,
        title: Some(ast::Words(format!("Frames of the transport, sent by the {side}"))),
        section: transport.section.clone(),
        ..ast::Access::default()
    }
}

/// Lets all values of numbers mean themselves.
fn have_no_absent(fields: &mut Map<ast::Field>) {
    for field in fields.values_mut() {
        have_no_absent(&mut field.fields);
        if field.constant.is_none() && field.format_of_number.is_none() && field.fields.is_empty() {
            field.absent = Some("none".to_owned());
        }
    }
}
