//! Resolves transports: makes messages of their frames, and says what carries a message longer than
//! a frame.

use super::Resolver;
use super::texts::remarks;
use crate::model::{Id, Identifier, MessageId, Transport, TransportFrame, TransportId};
use crate::number::Rational;
use crate::resolve::rules;
use crate::syntax::ast::{self, IdentifierEntry, Map, Pattern};
use crate::syntax::tree::Path;

/// The only kind of transport.
pub const J1939: &str = "j1939";

/// Its messages, in the order of [`TransportFrame::ALL`].
const MESSAGES: &str = include_str!("j1939.yaml");

/// The numbers of the groups of its frames: those that manage a transfer, and those with packets.
const GROUPS: [u32; 2] = [0xEC00, 0xEB00];

/// Bits of the number of a group.
const GROUP_BITS: u8 = 18;

/// The ways to answer, in the order in which a transport takes them.
const ANSWERS: [&str; 3] = ["one", "each", "coordinator"];

/// What is wrong with a transport: at the key of this name, in one sentence, and what to do.
struct Flaw {
    key: &'static str,
    text: String,
    help: String,
}

/// Returns the spec with the frames of its transports as messages, behind its own.
pub fn expanded(spec: &ast::Spec) -> ast::Spec {
    let mut all = spec.clone();
    for (name, transport) in &spec.transports {
        if flaw(spec, name, transport).is_none() {
            all.access.extend(accesses(spec, name, transport));
            all.messages.extend(messages(spec, name, transport));
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
            let kinds = std::iter::once(J1939);
            if self.lookup(&path.key("kind"), "kind of transport", &transport.kind, kinds).is_none() {
                continue;
            }
            // The messages of a sound transport are there already.
            let is_sound = TransportFrame::ALL.iter().all(|(_, frame)| spec.messages.contains_key(&named(name, frame)));
            if let Some(Flaw { key, text, help }) = flaw(spec, name, transport).filter(|_| !is_sound) {
                self.error_with_help(&rules::TRANSPORT, path.key(key).at_value(), text, help);
                continue;
            }
            let field = |name: &String| identifier.fields.position(|field| field.name == *name);
            let (Some(target), Some(source)) = (field(&transport.target), field(&transport.source)) else { continue };
            let frame = |(_, frame): &(_, &str)| spec.messages.get_index_of(&named(name, frame)).map(MessageId::new);
            self.tables.transports.push(Transport {
                name: name.clone(),
                doc: remarks!(transport).doc(&path, None),
                group: transport.group.0.iter().filter_map(field).collect(),
                target,
                source,
                frames: TransportFrame::ALL.iter().filter_map(frame).collect(),
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

/// Finds what is wrong with a transport, but for its kind.
fn flaw(spec: &ast::Spec, name: &str, transport: &ast::Transport) -> Option<Flaw> {
    let flaw = |key, text, help: &str| Some(Flaw { key, text, help: help.to_owned() });
    let fields = [("target", &transport.target), ("source", &transport.source)];
    let fields = fields.into_iter().chain(transport.group.0.iter().map(|field| ("group", field)));
    for (key, field) in fields {
        let Some(width) = bits(spec, field).map(|(high, low)| high - low + 1) else {
            return flaw(key, format!("the identifier has no field `{field}`"), "name a field of `identifier`");
        };
        if key != "group" && width != 8 {
            let text = format!("`{field}` has {width} bits, and an address of J1939 has 8");
            return flaw(key, text, "name the field of the identifier with that address");
        }
    }
    let width: u8 =
        transport.group.0.iter().filter_map(|field| bits(spec, field)).map(|(high, low)| high - low + 1).sum();
    if width != GROUP_BITS {
        let text = format!("the fields of `group` have {width} bits, and the number of a group has {GROUP_BITS}");
        return flaw(
            "group",
            text,
            "name the two bits of the page, the format and the target: `[page, format, target]`",
        );
    }
    if transport.group.0.last() != Some(&transport.target) {
        let text = format!("the last field of `group` is not `{}`", transport.target);
        return flaw("group", text, "the field of the receiver stands last");
    }
    if GROUPS.iter().any(|group| matched(spec, transport, *group).is_none()) {
        let text = "a constant field of `group` keeps the frames of the transport out".to_owned();
        return flaw("group", text, "their page is 0, and their formats are 0xEB and 0xEC");
    }
    if accesses(spec, name, transport).iter().any(|(_, access)| access.answers.is_empty()) {
        let text = "a transport needs a way to each side".to_owned();
        return flaw("kind", text, "write a mode in `addressing` with `request` and `one`");
    }
    let added = TransportFrame::ALL.iter().map(|(_, frame)| named(name, frame));
    let taken = added.into_iter().find(|added| spec.messages.contains_key(added));
    taken.and_then(|taken| {
        let text = format!("a message has the name `{taken}`, which a frame of the transport has");
        flaw("kind", text, "rename the message or the transport")
    })
}

/// Returns the highest and the lowest bit of a field of the identifier.
fn bits(spec: &ast::Spec, name: &str) -> Option<(u8, u8)> {
    let IdentifierEntry::Field(field) = spec.identifier.get(name)? else { return None };
    let text = field.bits.as_ref()?;
    let (high, low) = text.split_once("..").unwrap_or((text, text));
    let (high, low) = (high.trim().parse().ok()?, low.trim().parse().ok()?);
    (low <= high && high < 29).then_some((high, low))
}

/// Returns what the identifier of a group must show, but for the address in its last byte. It is nothing if a constant
/// field shows something else.
fn matched(spec: &ast::Spec, transport: &ast::Transport, group: u32) -> Option<Pattern> {
    let mut pattern = Pattern::new();
    let mut rest = group;
    for name in transport.group.0.iter().rev() {
        let (high, low) = bits(spec, name)?;
        let width = high - low + 1;
        let value = rest & u32::MAX >> (32 - width);
        rest >>= width;
        let IdentifierEntry::Field(field) = spec.identifier.get(name)? else { return None };
        match &field.constant {
            _ if *name == transport.target => {}
            Some(constant) if Rational::parse(constant) != Some(Rational::integer(value.into())) => return None,
            Some(_) => {}
            None => {
                pattern.insert(name.clone(), value.to_string());
            }
        }
    }
    Some(pattern)
}

/// Makes an access for each side that sends the frames of a transport.
fn accesses(spec: &ast::Spec, name: &str, transport: &ast::Transport) -> Map<ast::Access> {
    let ways = |mode: &ast::Mode| [mode.one.is_some(), mode.each.is_some(), mode.coordinator.is_some()];
    let way =
        |mode: &ast::Mode| ANSWERS.into_iter().zip(ways(mode)).find(|(_, is_there)| *is_there).map(|(way, _)| way);
    let of_module = spec.addressing.iter().filter_map(|(name, mode)| Some((name.clone(), way(mode)?.to_owned())));
    let asked = spec.addressing.iter().filter(|(_, mode)| mode.request.is_some());
    let of_controller = asked.map(|(name, mode)| (name.clone(), way(mode).unwrap_or("each").to_owned()));
    let access = |side: &str, answers: Map<String>| {
        let access = ast::Access {
            report: Some(Pattern::new()),
            from: Some(side.to_owned()),
            answers,
            title: Some(format!("Frames of the transport, sent by the {side}")),
            section: transport.section.clone(),
            ..ast::Access::default()
        };
        (format!("{name}_of_{side}"), access)
    };
    Map::from_iter([access("module", of_module.collect()), access("controller", of_controller.collect())])
}

/// Makes the messages of a transport's frames.
fn messages(spec: &ast::Spec, name: &str, transport: &ast::Transport) -> Map<ast::Message> {
    let known: Map<ast::Message> = serde_yaml::from_str(MESSAGES).unwrap_or_default();
    let has_absent = spec.absent.as_deref() == Some("ones");
    let made = known.into_iter().map(|(frame, mut message)| {
        let group = if frame == "data" { GROUPS[1] } else { GROUPS[0] };
        message.pattern = matched(spec, transport, group).unwrap_or_default();
        message.access = accesses(spec, name, transport).into_keys().collect();
        message.length = ast::Names(vec!["8".to_owned()]);
        message.send.clone_from(&transport.send);
        message.reserved = Some(ast::Reserved { send: Some("1".to_owned()), expect: None });
        message.section.clone_from(&transport.section);
        let is_number = |field: &&mut ast::Field| field.constant.is_none() && field.format_of_number.is_none();
        for field in message.fields.values_mut().filter(|field| has_absent && is_number(field)) {
            field.absent = Some("none".to_owned());
        }
        (named(name, &frame), message)
    });
    made.collect()
}
