//! Resolves messages longer than a frame, which travel in numbered parts or by a transport.

use canspec_runtime::Place;

use super::Resolver;
use super::head::Head;
use super::leaves::Leaves;
use super::parts::{PART, numbers};
use super::window::{MOST_BYTES, Windowed, in_frame};
use crate::model::{
    Array, ArrayId, Carrier, LongMessage, LongMessageId, Message, MessageId, Signal, SignalId, Table, TransportId,
    Varying,
};
use crate::read::syntax::ast;
use crate::report::rule::Rule;
use crate::report::tree::Path;
use crate::resolve::rules;

/// Data bytes that the first frame of ISO-TP has.
const FIRST_BYTES: usize = 6;

/// Most data bytes of a frame.
const ONE_FRAME: usize = 8;

/// The fields of a message's frames, and what several frames carry together.
pub struct Carried {
    pub leaves: Leaves,
    pub long: Option<LongMessageId>,
    /// The numbers of data bytes that a frame can have; empty if none carries the fields.
    pub lengths: Vec<u8>,
}

impl Resolver<'_> {
    /// Takes the fields of a message apart: into those of its frames, and those of all frames together.
    pub fn carried(
        &mut self,
        id: MessageId,
        path: &Path,
        message: &ast::Message,
        mut contents: Leaves,
        head: Head,
        length: u8,
    ) -> Carried {
        let at = path.key("length");
        let is_long = message.parts.is_some() || message.via.is_some();
        let (range, written) = match &message.length.0[..] {
            [range] if is_long && range.contains("..") => (Some(range), &[][..]),
            written => (None, written),
        };
        self.bound(&at, range, &mut contents);
        if let (Some(_), Some(_)) = (&message.parts, &message.via) {
            let text = format!("`{}` has both `parts` and `via`", head.name);
            let help = "numbered parts need no transport; write one of the two";
            self.error_with_help(&rules::TRANSPORT, path.key("via").at_key(), text, help);
        }
        if let Some(name) = &message.via {
            let lengths = self.long_lengths(&at, written);
            let Some(transport) = self.transport(&path.key("via"), name) else {
                let given_up = contents.names().collect();
                return Carried { leaves: Leaves { given_up, ..Leaves::default() }, long: None, lengths: Vec::new() };
            };
            if !self.tables.transports[transport].standard.has_plain_frames() {
                return self.joined(id, path, (transport, lengths), contents, head);
            }
            self.refuse_constants(&contents);
            let (leaves, long) = self.transported(id, path, (transport, lengths), contents, head);
            let known = long.map(|long| &self.tables.long_messages[long]);
            let lengths = known.map(|long| (0..=8).filter(|bytes| long.has_length(usize::from(*bytes))).collect());
            return Carried { leaves, long, lengths: lengths.unwrap_or_default() };
        }
        let Some(parts) = &message.parts else {
            return Carried { leaves: contents, long: None, lengths: self.lengths(&at, written, length) };
        };
        self.refuse_constants(&contents);
        // Where the first part announces a length, those of the message are meant.
        let (of_whole, of_frames) = if parts.length.is_some() { (written, &[][..]) } else { (&[][..], written) };
        let whole = self.long_lengths(&at, of_whole);
        let lengths = self.lengths(&at, of_frames, length);
        let (leaves, long) = self.long_message(id, path, (parts, whole), contents, head);
        Carried { leaves, long, lengths }
    }

    /// Reads `bytes` that count in the data of several frames.
    pub fn window(&mut self, path: &Path, text: &str) -> Option<Windowed> {
        let (first, last) = self.ends(path, text, "12..13")?;
        let [first, last] = [first, last].map(|end| self.integer(path, end, 0, MOST_BYTES - 1));
        let (first, last) = (first?, last?);
        let window = first.min(last);
        let [Ok(from @ 0..8), Ok(to @ 0..8)] = [first - window, last - window].map(u8::try_from) else {
            let text = format!("`{text}` has {} bytes", first.abs_diff(last) + 1);
            let help = "only a text and raw bytes have more than 8; make two fields of any other";
            self.error_with_help(&rules::PLACE, path.at_value(), text, help);
            return None;
        };
        Some((window, Place::bytes(from, to)))
    }

    /// Refuses a field that a long message cannot have.
    pub fn refuse_in_long(&mut self, path: &Path, (what, help): (&str, &str)) {
        let text = format!("{what} cannot stand in this message of several frames");
        self.error_with_help(&rules::PARTS, path.at_key(), text, help);
    }

    /// Refuses constants, since no frame of the message would show them.
    fn refuse_constants(&mut self, leaves: &Leaves) {
        for (constant, _) in &leaves.constants {
            let help = "`match` chooses the frames; if the code of a maker stands here, name it in `values` instead, and \
                        any other gets the note `unknown_value`";
            self.refuse_in_long(&constant.doc.path, ("a constant", help));
        }
    }

    /// Makes a long message of what its parts carry together. It returns the fields of the frames.
    pub fn long_message(
        &mut self,
        message: MessageId,
        path: &Path,
        (parts, lengths): (&ast::Parts, Vec<u16>),
        whole: Leaves,
        head: Head,
    ) -> (Leaves, Option<LongMessageId>) {
        let mut frame = self.part_leaves(&path.key("parts"), parts, head.doc, head.name);
        let data = self.part_data(&path.key("parts"), parts, &whole, &mut frame);
        frame.replies.extend(whole.replies);
        frame.given_up.extend(whole.given_up);
        let signals: Table<SignalId, Signal> = whole.signals.into_iter().collect();
        let arrays = self.arrays(whole.arrays, &signals);
        let content = content(head, signals, arrays);
        let at = path.key("length");
        let path = path.key("parts");
        let carrier = data.and_then(|data| self.parts(&path, parts, (&frame, data), head)).map(Carrier::Parts);
        let long = carrier.map(|carrier| LongMessage { message, content, carrier, lengths, frames: Vec::new() });
        let is_sound = frame.given_up.is_empty();
        let long = long.filter(|long| {
            self.check_long(&rules::PARTS, &path, long, is_sound).is_some()
                && self.check_cuts(&rules::PARTS, &at, long).is_some()
        });
        let id = long.map(|long| {
            self.check_announced(&path, &long);
            let numbers = numbers(&long);
            if let Some(signal) = frame.signals.iter_mut().find(|signal| signal.name == PART) {
                self.set_numbers(&path.key("number"), signal, numbers);
            }
            self.tables.long_messages.push(long)
        });
        (frame, id)
    }

    /// Makes a long message of what a transport carries. It returns the fields of the message if it is one frame.
    pub fn transported(
        &mut self,
        message: MessageId,
        path: &Path,
        (transport, lengths): (TransportId, Vec<u16>),
        whole: Leaves,
        head: Head,
    ) -> (Leaves, Option<LongMessageId>) {
        let is_sound = whole.given_up.is_empty();
        let one_frame = lengths.iter().copied().filter(|length| *length <= 8).max().unwrap_or(8);
        let (signals, arrays) = whole.in_one_frame(0, one_frame.into());
        let plain = Leaves { signals, arrays, constants: Vec::new(), replies: whole.replies, given_up: whole.given_up };
        let signals: Table<SignalId, Signal> = whole.signals.into_iter().collect();
        let arrays = self.arrays(whole.arrays, &signals);
        let (content, carrier) = (content(head, signals, arrays), Carrier::Transport(transport));
        let long = LongMessage { message, content, carrier, lengths, frames: Vec::new() };
        let at = path.key("via");
        let is_right = self.check_long(&rules::TRANSPORT, &at, &long, is_sound).is_some()
            && self.check_lengths(path, transport, &long).is_some();
        let plain = if long.shortest() <= 8 {
            plain
        } else {
            Leaves { replies: plain.replies, given_up: plain.given_up, ..Leaves::default() }
        };
        (plain, is_right.then(|| self.tables.long_messages.push(long)))
    }

    /// Makes a long message of what a transport carries in frames of its own. Its first frame shows the constants.
    fn joined(
        &mut self,
        message: MessageId,
        path: &Path,
        (transport, lengths): (TransportId, Vec<u16>),
        whole: Leaves,
        head: Head,
    ) -> Carried {
        let constants = whole.constants.into_iter();
        let constants = constants.filter_map(|(signal, value)| Some((self.in_first_frame(&signal)?, value))).collect();
        let is_sound = whole.given_up.is_empty();
        let leaves = Leaves { constants, replies: whole.replies, given_up: whole.given_up, ..Leaves::default() };
        let signals: Table<SignalId, Signal> = whole.signals.into_iter().collect();
        let arrays = self.arrays(whole.arrays, &signals);
        let (content, carrier) = (content(head, signals, arrays), Carrier::Transport(transport));
        let long = LongMessage { message, content, carrier, lengths, frames: Vec::new() };
        let at = path.key("via");
        let is_bare = long.content.signals.is_empty();
        let is_right = (is_bare || self.check_long(&rules::TRANSPORT, &at, &long, is_sound).is_some())
            && self.check_lengths(path, transport, &long).is_some();
        Carried { leaves, long: is_right.then(|| self.tables.long_messages.push(long)), lengths: Vec::new() }
    }

    /// Returns a constant with its place in the payload, if the first frame of a transfer shows it.
    fn in_first_frame(&mut self, signal: &Signal) -> Option<Signal> {
        if signal.reach() <= FIRST_BYTES {
            return in_frame(signal);
        }
        let text =
            format!("`{}` reaches byte {}, and the first frame has {FIRST_BYTES}", signal.name, signal.reach() - 1);
        let help = "a constant tells the messages apart before the whole is there; take it out, or make a value of it";
        self.error_with_help(&rules::TRANSPORT, signal.doc.path.at_key(), text, help);
        None
    }

    /// Tests that a transport can carry a message of these lengths, and that none of them cuts a field.
    fn check_lengths(&mut self, path: &Path, transport: TransportId, long: &LongMessage) -> Option<()> {
        let most = self.tables.transports[transport].standard.most_bytes();
        if long.longest() > most {
            let text =
                format!("`{}` has up to {} bytes, and a transport carries {most}", long.content.name, long.longest());
            let help = "take fields out, or make `repeat` smaller";
            self.error_with_help(&rules::TRANSPORT, path.key("via").at_value(), text, help);
            return None;
        }
        let at = path.key("length");
        let is_plain = long.shortest() <= ONE_FRAME && self.tables.transports[transport].standard.has_plain_frames();
        if let Some((signal, _)) = long.open_text().filter(|_| is_plain) {
            let text = format!("a message of up to 8 bytes is one frame, in which `{}` cannot be open", signal.name);
            let help =
                "let the length begin at 9 or more, or make an array of it: `{bytes: 0, repeat: 1..400, as: text}`";
            self.error_with_help(&rules::TRANSPORT, at.at_value(), text, help);
            return None;
        }
        self.check_cuts(&rules::TRANSPORT, &at, long)
    }

    /// Tests that no length of a message cuts a field, and that its fields do not say how long it is.
    fn check_cuts(&mut self, rule: &'static Rule, at: &Path, long: &LongMessage) -> Option<()> {
        if let (Some(_), Some(array)) = (long.lengths.first(), long.varying()) {
            let text = format!("the length follows from the elements of `{}`", array.name);
            self.error_with_help(rule, at.at_key(), text, "take `length` out");
            return None;
        }
        let cut = long.lengths.iter().find_map(|length| {
            let is_cut = |signal: &&Signal| (signal.bytes().start + 1..signal.reach()).contains(&usize::from(*length));
            Some((length, long.content.signals.iter().find(is_cut)?))
        });
        let beyond = || {
            let last = long.lengths.last()?;
            Some((last, long.content.signals.iter().find(|signal| signal.reach() > usize::from(*last))?))
        };
        let Some((length, signal)) = cut.or_else(beyond) else { return Some(()) };
        let text = format!("`{}` does not end within {length} bytes", signal.name);
        let help = "correct the lengths or the places; a field may lie behind a length, but not across it";
        self.error_with_help(rule, at.at_key(), text, help);
        None
    }

    /// Tests what the frames carry together. `is_sound` tells that no field has an error of its own.
    fn check_long(&mut self, rule: &'static Rule, path: &Path, long: &LongMessage, is_sound: bool) -> Option<()> {
        let content = &long.content;
        let mut refuse = |path: &Path, text: String, help: &str| {
            self.error_with_help(rule, path.at_key(), text, help);
            None
        };
        if content.signals.is_empty() {
            let text = format!("the frames of `{}` carry no field", content.name);
            return if is_sound {
                refuse(path, text, "write its `fields`; their bytes count through all frames")
            } else {
                None
            };
        }
        let mut varying = long.all_varying();
        let Some(field) = varying.next() else { return Some(()) };
        let at = field.doc.path.key(if field.is_text { "bytes" } else { "repeat" });
        // A text ends where the message ends, so it is the only one.
        let is_alike = |other: &Varying| !other.is_text && (other.least, other.most) == (field.least, field.most);
        if let Some(other) = varying.find(|other| !is_alike(other)) {
            let text = format!("`{}` and `{}` vary in length, each in its own way", field.name, other.name);
            return refuse(
                &at,
                text,
                "arrays that vary have the same `repeat`, an open text varies alone, and both stand last",
            );
        }
        let of_it = content.signals.iter().filter(|signal| long.varies(signal));
        let start = of_it.map(|signal| signal.bytes().start).min().unwrap_or(0);
        let mut others = content.signals.iter().filter(|signal| !long.varies(signal));
        if let Some(other) = others.find(|signal| signal.reach() > start) {
            let text = format!("`{}` stands behind `{}`, whose length varies", other.name, field.name);
            return refuse(&at, text, "a field of varying length stands last");
        }
        Some(())
    }
}

/// Makes the message that the parts carry together.
fn content(head: Head, signals: Table<SignalId, Signal>, arrays: Table<ArrayId, Array>) -> Message {
    Message {
        name: head.name.to_owned(),
        doc: head.doc.clone(),
        lengths: Vec::new(),
        signals,
        arrays,
        constants: Vec::new(),
        exchanges: Table::default(),
        frames: Vec::new(),
        refusals: Vec::new(),
        every: None,
        models: head.models.to_vec(),
        set: None,
        long: None,
        sends: Vec::new(),
        fixed: Vec::new(),
        reserved: head.reserved,
    }
}
