//! Resolves how the frames of a long message are numbered, and where they say what belongs together.

mod data;

use std::ops::Range as Span;

use canspec_runtime::Place;

use super::Resolver;
use super::access::Times;
use super::head::Head;
use super::leaves::Leaves;
use super::window::MOST_BYTES;
use crate::model::{
    Announcement, Carrier, FrameLayout, Id, LongMessage, LongMessageId, Message, MessageId, Numeral, OfModel, Parts,
    Range, Signal, SignalId, Table,
};
use crate::read::syntax::ast::{self, ByModel, Key};
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::number::Rational;

/// Name of the signal with the number of a part.
pub const PART: &str = "part";

/// Name of the signal that all parts of a message share.
pub const COUNTER: &str = "counter";

/// Name of the field with the number of data bytes, for errors.
pub const LENGTH: &str = "length";

/// Name of the signal with the data of a part.
pub const DATA: &str = "data";

/// Keys of a field that say where it stands, and what it is for people.
const PLACE: [Key; 6] = [Key::Bytes, Key::Bits, Key::Title, Key::Note, Key::Section, Key::Erratum];

impl Resolver<'_> {
    /// Reads `parts`, but for `count`.
    pub fn parts(
        &mut self,
        path: &Path,
        parts: &ast::Parts,
        (frame, data): (&Leaves, Place),
        head: Head,
    ) -> Option<Parts> {
        let number = self.plain(&path.key("number"), frame, PART)?;
        let counter = match &parts.counter {
            Some(field) => {
                self.check_no_selector(&path.key("counter"));
                self.check_place_alone(&path.key("counter"), field)?;
                Some(self.plain(&path.key("counter"), frame, COUNTER)?)
            }
            None => None,
        };
        let length = match &parts.length {
            Some(field) => {
                self.check_place_alone(&path.key("length"), field)?;
                Some(self.announcing(&path.key("length"), field, data, head)?)
            }
            None => None,
        };
        let at = path.key("first");
        let (first, model_firsts) = match &parts.first {
            ByModel::Every(text) => (Some(self.integer(&at, text, 0, u16::MAX - MOST_BYTES)?), Vec::new()),
            ByModel::Each(numbers) => (None, self.model_firsts(&at, numbers)),
        };
        Some(Parts {
            number: Id::new(number),
            counter: counter.map(Id::new),
            data,
            size: data.width() / 8,
            length,
            first,
            model_firsts,
            count: None,
            silence: None,
        })
    }

    /// Tests that a field beside the data of a part only says where it stands.
    fn check_place_alone(&mut self, path: &Path, field: &ast::Field) -> Option<()> {
        let Some(key) = field.keys().find(|key| !PLACE.contains(key)) else { return Some(()) };
        let text = format!("`{}` means nothing here", key.name());
        self.error_with_help(&rules::PARTS, path.key(key).at_key(), text, "write a place alone, as in `{bytes: 1}`");
        None
    }

    /// Tests that each frame with a part has all of its fields, and all of the data.
    pub fn check_whole(
        &mut self,
        path: &Path,
        data: Option<Place>,
        (frames, signals): (&[FrameLayout], &Table<SignalId, Signal>),
    ) {
        let carrying = frames.iter().filter(|frame| !frame.signals.is_empty());
        let Some(shortest) = carrying.flat_map(|frame| &frame.lengths).min() else { return };
        let ends = signals.iter().map(|signal| (signal.name.as_str(), signal.end().into()));
        let ends = ends.chain(data.map(|data| (DATA, in_bytes(data).end)));
        for (name, _) in ends.filter(|(_, end)| *end > usize::from(*shortest)).take(1) {
            let text = format!("a frame of length {shortest} would have no `{name}`");
            let help = "let every `length` of the message have room for the whole part";
            self.error_with_help(&rules::PARTS, path.key("parts").at_key(), text, help);
        }
    }

    /// Finds a number beside the data of a part.
    fn plain(&mut self, path: &Path, frame: &Leaves, name: &str) -> Option<usize> {
        let number = frame.signals.iter().position(|signal| signal.name == name && is_plain(signal));
        if number.is_none() && frame.given_up.is_empty() {
            let text = match name {
                PART => "the number of a part is one plain number",
                _ => "what tells one message from the next is one plain number",
            };
            let help = "write a place alone, as in `{bytes: 0}` or `{bytes: 0, bits: 4..0}`";
            self.error_with_help(&rules::PARTS, path.at_key(), text.to_owned(), help);
        }
        number
    }

    /// Tests that no field of the header is called like the counter, since both stand in `selectors`.
    fn check_no_selector(&mut self, path: &Path) {
        let words = self.spec.header.values().flat_map(|word| word.fields.keys());
        if self.spec.header.keys().chain(words).any(|name| name == COUNTER) {
            let text = format!("a field of the header is called `{COUNTER}`, too");
            let help = "give the field of the header another name";
            self.error_with_help(&rules::PARTS, path.at_key(), text, help);
        }
    }

    /// Reads where the first part says how many data bytes there are.
    fn announcing(&mut self, path: &Path, field: &ast::Field, data: Place, head: Head) -> Option<Announcement> {
        let signal = self.length_leaf(path, field, head.doc, head.name)?;
        let (of_length, of_data) = (signal.bytes(), in_bytes(data));
        let is_whole = usize::from(signal.place.width()) == 8 * of_length.len() && is_plain(&signal);
        if is_whole && of_length.start == of_data.start && of_length.end < of_data.end {
            return Some(Announcement { place: signal.place });
        }
        let text = if of_length.end >= of_data.end {
            "the length leaves no room for data in the first part"
        } else {
            "the length is a plain number in whole bytes at the front of the data"
        };
        let first = of_data.start;
        let help =
            format!("let `data` begin with the length, as in `length: {{bytes: {first}}}` for `data: {first}..7`");
        self.error_with_help(&rules::PARTS, path.at_key(), text.to_owned(), help);
        None
    }

    /// Tests that the first part can say how many data bytes there are.
    pub fn check_announced(&mut self, path: &Path, long: &LongMessage) {
        let Some(Announcement { place }) = long.parts().and_then(|parts| parts.length) else { return };
        if u64::try_from(long.longest()).is_ok_and(|longest| longest > place.max()) {
            let text = format!(
                "`{}` has up to {} bytes, and {} bits for that",
                long.content.name,
                long.longest(),
                place.width()
            );
            let help = "correct the place of the length, or make the message shorter";
            self.error_with_help(&rules::PARTS, path.key("length").at_key(), text, help);
        }
    }

    /// Reads the number of the first part for each device model.
    fn model_firsts(&mut self, path: &Path, numbers: &ast::Map<String>) -> Vec<OfModel<u16>> {
        let mut firsts = Vec::new();
        for (name, text) in numbers {
            let path = path.key(name);
            let names = self.spec.models.keys().map(String::as_str);
            let Some(place) = self.lookup_key(&path, "model", name, names) else { continue };
            let Some(value) = self.integer(&path, text, 0, u16::MAX - MOST_BYTES) else { continue };
            firsts.push(OfModel { model: Id::new(place), value, path });
        }
        firsts
    }

    /// Lets the number of a part be one of those that its message has.
    pub fn set_numbers(&mut self, path: &Path, signal: &mut Signal, numbers: Option<(u16, u16)>) {
        let Some((first, last)) = numbers else { return };
        if u64::from(last) > signal.place.max() {
            let text =
                format!("the parts have the numbers {first} to {last}, and {} bits for them", signal.place.width());
            let help = "correct the place of the number, or the length of the message";
            self.error_with_help(&rules::PARTS, path.at_key(), text, help);
        }
        let [minimum, maximum] = [first, last].map(|end| Rational::integer(end.into()));
        if signal.range.is_none() {
            (signal.range, signal.range_path) = (Some(Range { minimum, maximum }), Path::default());
        }
    }

    /// Finds the signals that say how many elements there are.
    pub fn count_elements(&mut self, messages: &Table<MessageId, Message>) {
        for id in self.tables.long_messages.ids() {
            let long = &self.tables.long_messages[id];
            let (path, is_varying) = (long.content.doc.path.key("parts").key("count"), long.varying().is_some());
            let written = self.spec.messages.get(&long.content.name).and_then(|message| message.parts.as_ref());
            let Some(text) = written.and_then(|parts| parts.count.clone()) else { continue };
            if long.parts().is_some_and(|parts| parts.length.is_some()) {
                let text = "`count` means nothing beside `length`, which says how many elements come";
                self.error_with_help(&rules::PARTS, path.at_key(), text.to_owned(), "take it out");
            } else if is_varying {
                let count = self.counting(&path, &text, messages);
                if let Carrier::Parts(parts) = &mut self.tables.long_messages[id].carrier {
                    parts.count = count;
                }
            } else {
                let text = "`count` means nothing here: no field of the message varies".to_owned();
                let help = "take it out; or write the least and the greatest number, as in `repeat: 1..48`, or end a text \
                            open: `bytes: 9..`";
                self.error_with_help(&rules::PARTS, path.at_key(), text, help);
            }
        }
    }

    /// Finds the silence that ends a message.
    pub fn silence(&mut self, id: LongMessageId, path: &Path, written: &ast::Parts, timing: &Times) {
        let Some(name) = &written.silence else { return };
        let path = path.key("silence");
        let names = self.spec.timing.keys().map(String::as_str);
        self.lookup_or(&path, "timing", name, names, "add the time to `timing` and write its name");
        let silence = timing.position(|known| known.name == *name);
        if silence.is_some_and(|silence| timing[silence].ends()[1].is_zero()) {
            let text = format!("`{name}` is no time, so each part would end its message");
            self.error_with_help(&rules::PARTS, path.at_value(), text, "name a time that is longer");
        }
        if let Carrier::Parts(parts) = &mut self.tables.long_messages[id].carrier {
            parts.silence = silence;
        }
    }

    /// Finds a signal by the names of its message and its own: `status.cells`.
    fn counting(
        &mut self,
        path: &Path,
        text: &str,
        messages: &Table<MessageId, Message>,
    ) -> Option<(MessageId, SignalId)> {
        let Some((message, signal)) = text.split_once('.') else {
            let help = "write the message and its signal: `status.cells`";
            self.error_with_help(&rules::PARTS, path.at_value(), format!("`{text}` is not a signal"), help);
            return None;
        };
        let id = self.lookup_in(path, "message", message, messages, |message| &message.name)?;
        let found = self.lookup_in(path, "signal", signal, &messages[id].signals, |signal| &signal.name)?;
        let known = &messages[id][found];
        if is_plain(known) {
            return Some((id, found));
        }
        let problem = Diagnostic::error(&rules::PARTS, path.at_value(), format!("`{text}` is no plain number"));
        let help = "name a signal without scale, offset and names for its values";
        self.diagnostics.push(problem.other(known.doc.path.at_key(), "the signal").help(help));
        None
    }
}

/// Tests whether the bits of a signal are its value.
fn is_plain(signal: &Signal) -> bool {
    signal.encoding.is_unscaled() && signal.encoding.numeral() == Numeral::Unsigned
}

/// Returns the bytes of a frame in which a place has bits.
fn in_bytes(place: Place) -> Span<usize> {
    let touched = || (0..8).filter(|byte| place.mask()[*byte] != 0);
    touched().next().unwrap_or(0)..touched().next_back().map_or(0, |last| last + 1)
}

/// Returns the least and the greatest number that a part can have.
pub fn numbers(long: &LongMessage) -> Option<(u16, u16)> {
    let parts = long.parts()?;
    let firsts = parts.model_firsts.iter().map(|own| own.value).chain(parts.first);
    let others = u16::try_from(long.parts_of(long.longest())).unwrap_or(u16::MAX) - 1;
    Some((firsts.clone().min()?, firsts.max()? + others))
}
