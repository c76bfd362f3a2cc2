//! Resolves messages: their signals and their frames.

use super::Resolver;
use super::access::{Modes, Times, pattern_of};
use super::head::Head;
use super::leaves::Leaves;
use super::lengths::lengths_with;
use super::long::Carried;
use super::patterns::{distinct, entries};
use super::texts::remarks;
use crate::model::{
    Access, AccessId, Answers, Constant, Doc, Exchange, ExchangeId, FixedField, FrameId, FrameLayout, Id, Identifier,
    Kind, LongMessageId, Message, MessageId, ModelId, Reserved, SelectorPlace, Signal, SignalId, Table, Travel,
};
use crate::read::syntax::ast;
use crate::report::diagnostic::{At, Diagnostic};
use crate::report::tree::Path;
use crate::resolve::rules;

/// The tables that messages refer to.
pub struct Surroundings<'a> {
    pub identifier: &'a Identifier,
    pub modes: &'a Modes,
    pub accesses: &'a Accesses,
    timing: &'a Times,
    length: u8,
    reserved: Reserved,
}

/// The accesses of the protocol.
type Accesses = Table<AccessId, Access>;

/// A message and its frames.
pub struct Draft {
    pub message: Message,
    pub frames: Vec<FrameLayout>,
    pub choice: Choice,
}

/// The exchange whose frames are made, and its message.
pub struct Owner<'a> {
    pub message: MessageId,
    pub id: ExchangeId,
    pub exchange: &'a Exchange,
    pub lengths: &'a [u8],
    pub signals: &'a Table<SignalId, Signal>,
}

/// The constants that choose the frames of a message, whatever the access.
pub struct Choice {
    /// Constants of `match`.
    pub matched: Vec<Constant>,
    /// Constants that replies show because of the message's fields.
    pub replies: Vec<Constant>,
    /// Constant fields, each with the only kinds of frames that have it.
    fixed: Vec<(Constant, Vec<Kind>)>,
    /// The same, each with what the spec says beside it.
    fields: Vec<FixedField>,
    /// All of these constants, and where they are written.
    written: Vec<Written>,
}

/// A constant of a message, and where it is written.
struct Written {
    constant: Constant,
    at: At,
    part: Part,
}

/// The part of a spec that gives a frame a constant.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Match,
    Field,
    /// The `reply` of a field or of its type.
    Reply,
    Access,
}

impl Part {
    fn name(self) -> &'static str {
        match self {
            Self::Match => "the `match`",
            Self::Field => "the field",
            Self::Reply => "the `reply` of the value",
            Self::Access => "the access",
        }
    }
}

impl Resolver<'_> {
    pub fn messages(
        &mut self,
        identifier: &Identifier,
        modes: &Modes,
        accesses: &Accesses,
        timing: &Times,
    ) -> (Table<MessageId, Message>, Table<FrameId, FrameLayout>) {
        let spec = self.spec;
        let length = self.length(&Path::default().key("length"), &spec.length).unwrap_or(8);
        let reserved = self.reserved(&Path::default(), spec.reserved.as_ref(), Reserved::default());
        let surroundings = Surroundings { identifier, modes, accesses, timing, length, reserved };
        let root = Path::default().key("messages");
        let entries = spec.messages.iter().enumerate();
        let mut drafts: Table<MessageId, Draft> = entries
            .map(|(place, (name, message))| {
                self.message(MessageId::new(place), &root.key(name), name, message, &surroundings)
            })
            .collect();
        self.sets(&surroundings, &mut drafts);
        let (messages, frames) = self.complete(drafts, modes);
        self.count_elements(&messages);
        self.check_travel(&messages);
        (messages, frames)
    }

    fn message(
        &mut self,
        id: MessageId,
        path: &Path,
        name: &str,
        message: &ast::Message,
        surroundings: &Surroundings,
    ) -> Draft {
        self.check_name(path, name);
        self.check_not_empty(path, &["answers", "models", "members", "in"]);
        let doc = remarks!(message).doc(path, None);
        let contents = self.contents(path, name, message, &doc);
        let exchanges = self.exchanges(path, message, surroundings);
        let models = self.models_named(&path.key("models"), &message.models);
        let reserved = self.reserved(path, message.reserved.as_ref(), surroundings.reserved);
        let head = Head { name, doc: &doc, models: &models, reserved };
        let Carried { leaves, long, lengths } = self.carried(id, path, message, contents, head, surroundings.length);
        let choice = self.choice(path, message, leaves.constants, &leaves.replies, surroundings.identifier);
        let set = self.set(path, message);
        self.tables.given_up.insert(name.to_owned(), leaves.given_up.into_iter().collect());
        let split = set.as_ref().map_or(&[][..], |set| &set.kinds);
        let signals = leaves.signals.into_iter().collect();
        let arrays = self.arrays(leaves.arrays, &signals);
        let whole = long.filter(|_| message.via.is_some());
        let is_joined = whole.is_some_and(|long| self.is_joined(long));
        let joined = whole.map(|long| self.tables.long_messages[long].content.signals.clone()).unwrap_or_default();
        let (mut frames, mut refusals) = (Vec::new(), Vec::new());
        for (exchange_id, exchange) in exchanges.entries() {
            let owner = Owner { message: id, id: exchange_id, exchange, lengths: &lengths, signals: &signals };
            let bare = Owner { lengths: &[surroundings.length], ..owner };
            for kind in surroundings.accesses[exchange.access].kinds.iter().filter(|kind| !split.contains(kind)) {
                let travel = self.access_constants(exchange.access, *kind, surroundings);
                let carries = surroundings.accesses[exchange.access].carries.contains(kind);
                let is_bare = message.via.is_some() && !carries;
                let frame = self.layout(if is_bare { &bare } else { &owner }, *kind, &choice, &travel, surroundings);
                self.check_constants(&frame, kind.name(), &choice);
                if let Some(long) = whole.filter(|_| carries || is_joined) {
                    let owner = Owner { signals: &joined, ..owner };
                    let signals = self.layout(&owner, *kind, &choice, &travel, surroundings).signals;
                    let frame = FrameLayout { long: Some(long), signals, ..frame.clone() };
                    self.tables.long_messages[long].frames.push(frame);
                }
                if !(is_joined || carries && lengths.is_empty()) {
                    frames.push(frame);
                }
            }
            refusals.extend(self.refusal(&owner, &choice, surroundings));
        }
        if let Some(parts) = &message.parts {
            let data = long.and_then(|long| Some(self.tables.long_messages[long].parts()?.data));
            self.check_whole(path, data, (&frames, &signals));
            if let Some(data) = data {
                self.check_elements(path, parts, data, (&frames, &signals));
            }
            if let Some(long) = long {
                self.silence(long, &path.key("parts"), parts, surroundings.timing);
            }
        }
        let always = choice.fixed.iter().filter(|(_, kinds)| kinds.is_empty()).map(|(constant, _)| *constant);
        let constants = choice.matched.iter().copied().chain(always).collect();
        let every = self.every(path, message.every.as_deref(), surroundings.timing);
        let reports = |exchange: &Exchange| surroundings.accesses[exchange.access].kinds.contains(&Kind::Report);
        if message.every.is_some() && exchanges.len() == message.access.len() && !exchanges.iter().any(reports) {
            self.misplaced_every(path, "a message", "name an access that has a `report`");
        }
        let sends = self.own_sends(&path.key("send"), &message.send, &frames, surroundings);
        let name = name.to_owned();
        let message = Message {
            name,
            doc,
            lengths,
            signals,
            arrays,
            constants,
            exchanges,
            frames: Vec::new(),
            refusals,
            every,
            models,
            set,
            long,
            sends,
            fixed: choice.fields.clone(),
            reserved,
        };
        Draft { message, frames, choice }
    }

    /// Numbers the frames, and adds what depends on all of them.
    fn complete(
        &mut self,
        drafts: Table<MessageId, Draft>,
        modes: &Modes,
    ) -> (Table<MessageId, Message>, Table<FrameId, FrameLayout>) {
        let (mut messages, mut frames) = (Table::default(), Table::default());
        for Draft { mut message, frames: drafted, .. } in drafts {
            let complete = |frame: FrameLayout| FrameLayout {
                covered: self.covered(&message, &frame),
                reserved: message.reserved,
                travels: travels(modes, frame.is_to_module(), &message[frame.exchange].answers),
                ..frame
            };
            let whole = message.long.map(|long| (long, &self.tables.long_messages[long].frames));
            let whole = whole.map(|(long, frames)| (long, frames.iter().cloned().map(complete).collect::<Vec<_>>()));
            let refusals = message.refusals.iter().cloned().map(complete).collect();
            let drafted: Vec<_> = drafted.into_iter().map(complete).collect();
            message.refusals = refusals;
            message.frames = drafted.into_iter().map(|frame| frames.push(frame)).collect();
            messages.push(message);
            if let Some((long, frames)) = whole {
                self.tables.long_messages[long].frames = frames;
            }
        }
        (messages, frames)
    }

    /// Tests whether the frames of a long message are all those of its transport.
    pub fn is_joined(&self, long: LongMessageId) -> bool {
        let transport = self.tables.long_messages[long].transport();
        transport.is_some_and(|transport| !self.tables.transports[transport].standard.has_plain_frames())
    }

    /// Returns the payload bits of a frame's selectors and of the message's signals, byte 0 highest.
    fn covered(&self, message: &Message, frame: &FrameLayout) -> u64 {
        let own = frame.signals.iter().filter(|_| frame.long.is_none());
        let signals = own.map(|signal| message[*signal].place);
        let selectors = frame.selectors.iter().filter_map(|selector| match self.tables.selectors[*selector].place {
            SelectorPlace::Payload(place) => Some(place),
            SelectorPlace::Identifier(_) => None,
        });
        signals.chain(selectors).fold(0, |mask, place| mask | u64::from_be_bytes(place.mask()))
    }

    /// Tests that every message has an access, or is a member of a set.
    fn check_travel(&mut self, messages: &Table<MessageId, Message>) {
        let spec = self.spec;
        let lacking = messages.iter().zip(spec.messages.values()).filter(|(_, written)| written.access.is_empty());
        for (message, _) in lacking.filter(|(message, _)| message.set.is_some() || message.exchanges.is_empty()) {
            let text = format!("`{}` has no access, so it has no frames", message.name);
            let known = spec.access.keys().next().map_or("read", String::as_str);
            let help = format!("name at least one access, for instance `access: [{known}]`");
            self.error_with_help(&rules::ACCESS, message.doc.path.key("access").at_key(), text, help);
        }
    }

    /// Finds the device models that have a message, a field or a status bit.
    pub fn models_named(&mut self, path: &Path, names: &[String]) -> Vec<ModelId> {
        self.each_named(path, "model", names, &self.spec.models.keys().map(String::as_str))
    }

    /// Resolves the constants that choose the frames of a message.
    fn choice(
        &mut self,
        path: &Path,
        message: &ast::Message,
        fields: Vec<(Signal, u64)>,
        replies: &[(Path, ast::Pattern)],
        identifier: &Identifier,
    ) -> Choice {
        let matched = self.written(&path.key("match"), &message.pattern, Part::Match, identifier);
        let replies: Vec<_> =
            replies.iter().flat_map(|(path, pattern)| self.written(path, pattern, Part::Reply, identifier)).collect();
        let (mut fixed, mut described, mut written) = (Vec::new(), Vec::new(), Vec::new());
        for (signal, value) in fields {
            let (at, doc) = (signal.doc.path.at_key(), signal.doc.clone());
            let (constant, kinds) = self.fixed(signal, value);
            described.push(FixedField { selector: constant.selector, value, doc });
            fixed.push((constant, kinds));
            written.push(Written { constant, at, part: Part::Field });
        }
        let constants = |written: &[Written]| distinct(written.iter().map(|known| known.constant).collect());
        let (of_match, of_replies) = (constants(&matched), constants(&replies));
        written.extend(matched.into_iter().chain(replies));
        Choice { matched: of_match, replies: of_replies, fixed, fields: described, written }
    }

    /// Reads a pattern of numbers, and keeps the place of each.
    fn written(&mut self, path: &Path, pattern: &ast::Pattern, part: Part, identifier: &Identifier) -> Vec<Written> {
        let constants = self.constants(path, entries(pattern), identifier);
        let at = |constant: &Constant| path.key(&self.tables.selectors[constant.selector].name).at_value();
        constants.into_iter().map(|constant| Written { constant, at: at(&constant), part }).collect()
    }

    /// Resolves `fields` or `value`.
    fn contents(&mut self, path: &Path, name: &str, message: &ast::Message, doc: &Doc) -> Leaves {
        let is_long = message.parts.is_some() || message.via.is_some();
        match &message.value {
            Some(value) if !message.fields.is_empty() => {
                let text = format!("`{name}` has both `fields` and `value`");
                let help = "`value` is the short form of one field called `value`; write one of the two";
                self.error_with_help(&rules::TYPE, path.key("value").at_key(), text, help);
                let fields = self.message_leaves(&path.key("fields"), &message.fields, doc, name, is_long);
                let value = self.value_leaf(&path.key("value"), value, doc, name, is_long);
                let written = [fields, value].into_iter().flat_map(Leaves::names);
                Leaves { given_up: written.collect(), ..Leaves::default() }
            }
            Some(value) => self.value_leaf(&path.key("value"), value, doc, name, is_long),
            None => self.message_leaves(&path.key("fields"), &message.fields, doc, name, is_long),
        }
    }

    /// Makes a selector of a constant field. It is in the kinds of frames that the field names.
    fn fixed(&mut self, signal: Signal, value: u64) -> (Constant, Vec<Kind>) {
        self.check_header_name(&signal);
        let kinds = signal.kinds.clone();
        let place = SelectorPlace::Payload(signal.place);
        (Constant { selector: self.add_selector(signal, None), place, value, open: 0 }, kinds)
    }

    /// Tests that a constant field does not have the name of a header field in another place.
    fn check_header_name(&mut self, signal: &Signal) {
        let mut header = self.tables.header.iter().map(|id| &self.tables.selectors[*id]);
        let named = header.find(|known| known.name == signal.name);
        let Some(known) = named.filter(|known| known.place != SelectorPlace::Payload(signal.place)) else { return };
        let text =
            format!("a frame would have two values called `{}`, since the header has a field of that name", known.name);
        let help = "choose another name, or the place of the header's field";
        let diagnostic = Diagnostic::error(&rules::MATCH, signal.doc.path.at_key(), text).help(help);
        self.diagnostics.push(diagnostic.other(known.doc.path.at_key(), "the field of the header"));
    }

    fn exchanges(
        &mut self,
        path: &Path,
        message: &ast::Message,
        surroundings: &Surroundings,
    ) -> Table<ExchangeId, Exchange> {
        let mut exchanges: Table<ExchangeId, Exchange> = Table::default();
        for (index, name) in message.access.iter().enumerate() {
            let at = path.key("access").index(index);
            let found = self.lookup_in(&at, "access", name, surroundings.accesses, |access| &access.name);
            let Some(access) = found else { continue };
            if exchanges.iter().any(|earlier| earlier.access == access) {
                let text = format!("the access `{name}` is named twice");
                self.error_with_help(&rules::ACCESS, at.at_value(), text, "take one of the two out");
                continue;
            }
            let known = &surroundings.accesses[access];
            let answers = if message.answers.is_empty() {
                known.answers.clone()
            } else {
                self.answers(&path.key("answers"), &message.answers, surroundings.modes, known)
            };
            exchanges.push(Exchange { access, answers, set: None });
        }
        exchanges
    }

    /// Returns the constants that a kind of frame shows because of its access.
    pub fn access_constants(&mut self, access: AccessId, kind: Kind, surroundings: &Surroundings) -> Vec<Constant> {
        let spec = self.spec;
        let Some((name, access)) = spec.access.get_index(access.place()) else { return Vec::new() };
        let Some(entries) = pattern_of(access, kind) else { return Vec::new() };
        let path = Path::default().key("access").key(name).key(kind.name());
        self.constants(&path, entries, surroundings.identifier)
    }

    /// Makes the frame of one kind of a message. `travel` has the constants of its access.
    pub fn layout(
        &self,
        owner: &Owner,
        kind: Kind,
        choice: &Choice,
        travel: &[Constant],
        surroundings: &Surroundings,
    ) -> FrameLayout {
        let carries = surroundings.accesses[owner.exchange.access].carries.contains(&kind);
        let present = |kinds: &[Kind]| if kinds.is_empty() { carries } else { kinds.contains(&kind) };
        let mut constants = [&choice.matched, travel].concat();
        if kind == Kind::Reply {
            constants.extend(&choice.replies);
        }
        let header = constants.iter().any(|constant| constant.in_payload().is_some());
        let fixed = choice.fixed.iter().filter(|(_, kinds)| kinds.is_empty() || kinds.contains(&kind));
        constants.extend(fixed.map(|(constant, _)| *constant));
        let mut selectors = if header { self.tables.header.clone() } else { Vec::new() };
        let payload = constants.iter().filter(|constant| constant.in_payload().is_some());
        selectors.extend(payload.map(|constant| constant.selector));
        selectors.sort_unstable();
        selectors.dedup();
        let signals = owner.signals.entries().filter(|(_, signal)| present(&signal.kinds));
        let signals: Vec<_> = signals.map(|(id, _)| id).collect();
        FrameLayout {
            message: owner.message,
            exchange: owner.id,
            access: owner.exchange.access,
            set: owner.exchange.set,
            kind,
            sender: surroundings.accesses[owner.exchange.access].sender(kind),
            lengths: lengths_with(owner.lengths, &signals.iter().map(|id| owner.signals[*id].end())),
            constants,
            selectors,
            long: None,
            signals,
            covered: 0,
            reserved: Reserved::default(),
            travels: Vec::new(),
        }
    }

    /// Returns the frame that refuses a request of the message. It carries none of the message's
    /// fields.
    fn refusal(&mut self, owner: &Owner, choice: &Choice, surroundings: &Surroundings) -> Option<FrameLayout> {
        let spec = self.spec;
        let (name, known) = spec.access.get_index(owner.exchange.access.place())?;
        let pattern = known.refusal.as_ref()?;
        let path_of_pattern = Path::default().key("access").key(name).key("refusal");
        let travel = self.constants(&path_of_pattern, entries(pattern), surroundings.identifier);
        let bare_choice = Choice {
            matched: choice.matched.clone(),
            replies: Vec::new(),
            fixed: Vec::new(),
            fields: Vec::new(),
            written: Vec::new(),
        };
        let bare = Owner { signals: &Table::default(), ..*owner };
        let frame = self.layout(&bare, Kind::Reply, &bare_choice, &travel, surroundings);
        self.check_constants(&frame, "refusal", choice);
        Some(frame)
    }

    /// Tests that no selector has two values. `key` is that of the frame in its access.
    fn check_constants(&mut self, frame: &FrameLayout, key: &str, choice: &Choice) {
        for (index, constant) in frame.constants.iter().enumerate() {
            let mut earlier = frame.constants[..index].iter();
            if let Some(twice) = earlier.find(|known| known.selector == constant.selector && known != &constant) {
                self.report_twice(frame, key, [twice, constant], choice);
            }
        }
    }

    /// Reports that a selector has two values.
    fn report_twice(&mut self, frame: &FrameLayout, key: &str, constants: [&Constant; 2], choice: &Choice) {
        let access = self.spec.access.get_index(frame.access.place()).map_or("", |(name, _)| name.as_str());
        let name = &self.tables.selectors[constants[0].selector].name;
        let pattern = Path::default().key("access").key(access).key(key).key(name);
        let [one, other] = constants.map(|constant| {
            let known = choice.written.iter().find(|known| known.constant == *constant);
            known.map_or_else(|| (Part::Access, pattern.at_value()), |known| (known.part, known.at.clone()))
        });
        let (first, second) = if other.0 == Part::Access { (one, other) } else { (other, one) };
        let help = match (first.0, second.0) {
            (Part::Reply, Part::Access) => format!(
                "a message that is also written takes a type without `reply`; \
                 name `{name}` in the `reply` of each of its accesses"
            ),
            (Part::Match, Part::Access) => {
                format!("take `{name}` out of `match` or out of the access, or correct one of the two")
            }
            _ => format!("take `{name}` out of one of the two places, or correct one of them"),
        };
        let [low, high] = constants.map(Constant::text);
        let text = format!("in a {key} by `{access}`, `{name}` would have to be both {low} and {high}");
        let diagnostic = Diagnostic::error(&rules::MATCH, first.1, text).help(help);
        self.diagnostics.push(diagnostic.other(second.1, second.0.name()));
    }
}

/// Returns the ways in which a kind of frame is sent.
fn travels(modes: &Modes, is_to_module: bool, answers: &Answers) -> Vec<Travel> {
    let ways = answers.entries().filter_map(|(mode, who)| Some(Travel { mode, who: (*who)? }));
    ways.filter(|Travel { mode, who }| modes[*mode].pattern(is_to_module, *who).is_some()).collect()
}
