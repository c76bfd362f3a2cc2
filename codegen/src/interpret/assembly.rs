//! Puts the parts of long messages together, for many devices at a time.

mod begun;

use std::collections::HashMap;
use std::time::Duration;

use begun::{Begun, Link};

use super::assembled::{Assembled, Peers, Taken, module};
use super::long::{Joined, in_bytes};
use super::transfer::Transfers;
use super::{Decoded, Frame, Note};
use crate::model::{
    Kind, LongMessage, MessageId, ModelId, NoteRule, Parts, Protocol, Reserved, SelectorPlace, Side, SignalId,
};

/// The parts that came so far. `M` is what the caller remembers of each frame.
///
/// A device sends the parts of a message in their order. Another message begins with a part whose number is not greater
/// than that of the part before, or which has another counter. The device's next part after a plain request also starts a
/// new message. A frame that is repeated at once counts once. What goes to a device is never mixed with what
/// comes from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly<M> {
    begun: Begun<M>,
    by_transport: Transfers<M>,
    /// How many elements devices say that arrays have.
    counts: HashMap<(Peers, MessageId, SignalId), usize>,
    /// How many elements every array has that varies, whatever the device says.
    count: Option<usize>,
}

impl<M> Default for Assembly<M> {
    fn default() -> Self {
        Self { begun: Begun::default(), by_transport: Transfers::default(), counts: HashMap::new(), count: None }
    }
}

/// The parts of one message, up to now.
#[derive(Clone, Debug, PartialEq)]
struct Transfer<M> {
    link: Link,
    /// What all of its parts show.
    counter: Option<u64>,
    /// How many data bytes the first part announces.
    announced: Option<usize>,
    /// When silence ends it, in nanoseconds from any start, if that is known.
    deadline: Option<u64>,
    /// Each part that came: how many come before it, its data, and its frame.
    parts: Vec<(usize, Vec<u8>, M)>,
    /// Whether a frame said that no other follows.
    is_ended: bool,
    /// The last frame.
    frame: Frame,
    decoded: Decoded,
}

/// A part of a message.
struct Part {
    index: usize,
    data: Vec<u8>,
    /// What all parts of its message show.
    counter: Option<u64>,
    /// How many data bytes it announces.
    announced: Option<usize>,
    /// Whether the frame says that no other follows.
    is_last: bool,
}

impl<M: Clone> Assembly<M> {
    /// Sets how many elements an array of varying length has, whatever a device says.
    pub fn count_as(&mut self, count: Option<usize>) {
        self.count = count;
    }

    /// Takes a frame, and returns the messages that it ends.
    pub fn take(
        &mut self,
        protocol: &Protocol,
        model: Option<ModelId>,
        mark: M,
        frame: &Frame,
        decoded: &Decoded,
    ) -> Taken<M> {
        self.take_at(None, (protocol, model), mark, frame, decoded)
    }

    /// The same as [`take`](Self::take) at a time in nanoseconds from any start. It also returns messages that silence
    /// has ended before.
    pub fn take_at(
        &mut self,
        now: Option<u64>,
        (protocol, model): (&Protocol, Option<ModelId>),
        mark: M,
        frame: &Frame,
        decoded: &Decoded,
    ) -> Taken<M> {
        let silent = now.map_or_else(Vec::new, |now| self.begun.silent(now));
        let mut ended = self.silent(protocol, model, silent);
        let taken = self.take_part(now, (protocol, model), mark, frame, decoded);
        ended.extend(taken.ended);
        Taken { ended, ..taken }
    }

    /// Ends the messages that end by silence, since no frame follows.
    pub fn fall_silent(&mut self, protocol: &Protocol, model: Option<ModelId>) -> Vec<Assembled<M>> {
        let ends = |open: &Transfer<M>| protocol.silence(&protocol[open.link.long]).is_some();
        let silent = self.begun.entries().filter(|(_, open)| ends(open)).map(|(number, _)| number).collect();
        self.silent(protocol, model, silent)
    }

    fn silent(&mut self, protocol: &Protocol, model: Option<ModelId>, numbers: Vec<usize>) -> Vec<Assembled<M>> {
        let end = |number| {
            self.begun.get_mut(number)?.is_ended = true;
            self.end(protocol, model, number, None)
        };
        numbers.into_iter().filter_map(end).collect()
    }

    fn take_part(
        &mut self,
        now: Option<u64>,
        (protocol, model): (&Protocol, Option<ModelId>),
        mark: M,
        frame: &Frame,
        decoded: &Decoded,
    ) -> Taken<M> {
        if let Some(taken) = self.by_transport.take((protocol, model), mark.clone(), frame, decoded) {
            return taken;
        }
        let mut peers: Peers = decoded.addresses(protocol, frame.id).collect();
        peers.sort_unstable();
        if !decoded.is_error_reply() && decoded.addressing.is_some() {
            self.keep_counts(protocol, &peers, decoded);
        }
        // Without an addressing mode nobody knows who sends it.
        let found = protocol.long_message(&protocol[decoded.message]).filter(|_| decoded.addressing.is_some());
        let found = found.and_then(|(id, long)| Some((id, long, long.parts()?)));
        let Some((id, long, parts)) = found else { return Taken::NOTHING };
        let mut link = Link { long: id, peers, sender: Side::Module };
        let Some(part) = Part::of(protocol, (long, parts), model, frame, decoded) else {
            let open = self.begun.number(&link).filter(|_| decoded.kind == Kind::Request);
            let ended = open.and_then(|open| self.end(protocol, model, open, None));
            return Taken { is_part: false, ended: ended.into_iter().collect() };
        };
        link.sender = decoded.sender;
        let deadline = now.and_then(|now| now.checked_add(nanoseconds(protocol.silence(long)?)?));
        let ended = self.add((protocol, model), (link, deadline), (part, mark), (frame, decoded));
        Taken { is_part: true, ended }
    }

    /// Adds a part to the message of its link, or begins one. It returns the messages that end.
    fn add(
        &mut self,
        (protocol, model): (&Protocol, Option<ModelId>),
        (link, deadline): (Link, Option<u64>),
        (part, mark): (Part, M),
        (frame, decoded): (&Frame, &Decoded),
    ) -> Vec<Assembled<M>> {
        let mut ended = Vec::new();
        let known = self.begun.number(&link).and_then(|open| Some((open, self.begun.get(open)?)));
        let open = match known {
            Some((open, known)) if known.repeats(&part) => {
                self.begun.wait(open, deadline);
                return ended;
            }
            Some((open, known)) if known.is_before(&part) => open,
            other => {
                let other = other.map(|(open, _)| open);
                ended.extend(other.and_then(|open| self.end(protocol, model, open, None)));
                self.begun.begin(Transfer::new(link, &part, frame, decoded))
            }
        };
        self.begun.wait(open, deadline);
        let (next, is_last) = (part.index + 1, part.is_last);
        let Some(transfer) = self.begun.get_mut(open) else { return ended };
        transfer.add(part, mark, frame, decoded);
        let Some(transfer) = self.begun.get(open) else { return ended };
        let long = &protocol[transfer.link.long];
        let expected = if is_last { Some(next) } else { transfer.expected(long, self.count(protocol, transfer)) };
        if expected.unwrap_or(long.parts_of(long.longest())) <= next {
            ended.extend(self.end(protocol, model, open, expected));
        }
        ended
    }

    /// Ends all messages whose parts have begun to come.
    pub fn finish(&mut self, protocol: &Protocol, model: Option<ModelId>) -> Vec<Assembled<M>> {
        let open: Vec<_> = self.begun.entries().map(|(number, _)| number).collect();
        let mut ended: Vec<_> = open.into_iter().filter_map(|open| self.end(protocol, model, open, None)).collect();
        ended.extend(self.by_transport.finish(protocol, model));
        ended
    }

    /// Remembers how many elements a device says that its arrays have.
    fn keep_counts(&mut self, protocol: &Protocol, node: &Peers, decoded: &Decoded) {
        let wanted = protocol.long_messages.iter().filter_map(|long| long.parts()?.count);
        for (message, signal) in wanted.filter(|(message, _)| *message == decoded.message) {
            let Some(reading) = decoded.signals.iter().find(|reading| reading.signal == signal) else { continue };
            let value = usize::try_from(reading.bits).unwrap_or(usize::MAX);
            self.counts.insert((module(protocol, node), message, signal), value);
        }
    }

    /// Returns how many elements the array of a message really has, if the device has said it. What it is told may
    /// change that number.
    fn count(&self, protocol: &Protocol, transfer: &Transfer<M>) -> Option<usize> {
        if self.count.is_some() {
            return self.count;
        }
        let is_told = protocol.is_told(&protocol[transfer.decoded.frame]);
        let (message, signal) = protocol[transfer.link.long].parts()?.count.filter(|_| !is_told)?;
        self.counts.get(&(module(protocol, &transfer.link.peers), message, signal)).copied()
    }
}

impl<M: Clone> Assembly<M> {
    /// Ends a message. `expected` is the number of its parts, if the frames say it.
    fn end(
        &mut self,
        protocol: &Protocol,
        model: Option<ModelId>,
        open: usize,
        expected: Option<usize>,
    ) -> Option<Assembled<M>> {
        let transfer = self.begun.end(open)?;
        let long = &protocol[transfer.link.long];
        let count = self.count(protocol, &transfer);
        let expected = expected.or_else(|| transfer.expected(long, count));
        Some(transfer.assembled(protocol, (long, model), (expected, count)))
    }
}

impl<M: Clone> Transfer<M> {
    /// Returns a message that begins with a part.
    fn new(link: Link, part: &Part, frame: &Frame, decoded: &Decoded) -> Self {
        let Part { counter, announced, .. } = *part;
        let (parts, frame, decoded) = (Vec::new(), frame.clone(), decoded.clone());
        Self { link, counter, announced, deadline: None, parts, is_ended: false, frame, decoded }
    }

    fn add(&mut self, part: Part, mark: M, frame: &Frame, decoded: &Decoded) {
        (self.frame, self.decoded, self.is_ended) = (frame.clone(), decoded.clone(), part.is_last);
        self.parts.push((part.index, part.data, mark));
    }

    /// Tests whether a part is the last one once more.
    fn repeats(&self, part: &Part) -> bool {
        let is_last = self.parts.last().is_some_and(|(index, data, _)| *index == part.index && *data == part.data);
        is_last && self.counter == part.counter
    }

    /// Tests whether a part can follow those that came.
    fn is_before(&self, part: &Part) -> bool {
        self.parts.last().is_some_and(|(index, _, _)| *index < part.index) && self.counter == part.counter
    }

    /// Returns the number of parts, if it is known.
    fn expected(&self, long: &LongMessage, count: Option<usize>) -> Option<usize> {
        let announced = self.announced.map(|length| long.parts_of(length).min(long.parts_of(long.longest())));
        let is_known = long.varying().is_none() || count.is_some();
        announced.or_else(|| is_known.then(|| long.parts_of(long.bytes_with(count))))
    }

    fn assembled(
        self,
        protocol: &Protocol,
        (long, model): (&LongMessage, Option<ModelId>),
        (expected, count): (Option<usize>, Option<usize>),
    ) -> Assembled<M> {
        let (joined, rest) = self.joined(long, count);
        let missing = self.missing(long, model, expected);
        let incomplete = match (missing, self.wrong_length(long, joined.data.len())) {
            (Some(missing), Some(wrong)) if self.announced.is_some() => Some(format!("{missing}; {wrong}")),
            (missing, wrong) => missing.or(wrong),
        };
        let note = filling_note(long, &rest).filter(|_| incomplete.is_none());
        let said = joined.read(protocol, long.whole(), model);
        let of_addresses = |note: &&Note| matches!(note.rule, NoteRule::Addressing | NoteRule::Address);
        let notes = self.decoded.notes.iter().filter(of_addresses).cloned().chain(said.notes).chain(note).collect();
        let counter = self.counter.zip(long.parts().and_then(|parts| parts.counter));
        let counter = counter.map(|(value, signal)| (protocol[long.message][signal].name.clone(), value));
        let decoded =
            Decoded { long: Some(self.link.long), signals: said.signals, notes, reserved: [0; 8], ..self.decoded };
        let data = incomplete.is_none().then_some(joined.data);
        let marks = self.parts.into_iter().map(|(_, _, mark)| mark).collect();
        Assembled { marks, frame: self.frame, decoded, data, reserved: said.reserved, counter, incomplete }
    }

    /// Joins the data. It also returns what fills up the last part behind an announced end.
    fn joined(&self, long: &LongMessage, count: Option<usize>) -> (Joined, Vec<u8>) {
        let (size, parts) = (long.size(), self.parts.last().map_or(0, |(index, _, _)| index + 1));
        let (mut joined, mut came) = (vec![0; parts * size], vec![false; parts * size]);
        for (index, data, _) in &self.parts {
            let bytes = index * size..(index + 1) * size;
            joined[bytes.clone()].copy_from_slice(data);
            came[bytes].fill(true);
        }
        let head = long.parts().map_or(0, Parts::head);
        let (mut data, mut came) = (joined.split_off(head), came.split_off(head));
        let end = self.announced.unwrap_or(data.len()).min(data.len());
        let rest = data.split_off(end);
        came.truncate(end);
        let is_ended = self.is_ended || self.announced.is_some();
        let count = self.announced.map_or(count, |length| long.whole().elements_in(length));
        (Joined { data, came, count, is_ended }, rest)
    }

    /// Says that the message never has the announced number of bytes, or that it ended before its last field. `came` is
    /// the number of bytes in its parts.
    fn wrong_length(&self, long: &LongMessage, came: usize) -> Option<String> {
        let (length, how) = match self.announced {
            Some(length) => (length, "announced"),
            None if came < long.least() => (came, "came"),
            None => return None,
        };
        let known = long.whole().other_lengths(length)?;
        Some(format!("{} {how}, but the message has {known}", in_bytes(length)))
    }

    /// Says which parts did not come.
    fn missing(&self, long: &LongMessage, model: Option<ModelId>, expected: Option<usize>) -> Option<String> {
        let parts = expected.unwrap_or_else(|| self.parts.last().map_or(0, |(index, _, _)| index + 1));
        let first = usize::from(long.first(model).unwrap_or(0));
        let came = |index: &usize| self.parts.iter().any(|(known, _, _)| known == index);
        let missing: Vec<_> =
            (0..parts).filter(|index| !came(index)).map(|index| (first + index).to_string()).collect();
        match missing.as_slice() {
            [] => None,
            [one] => Some(format!("part {one} is missing")),
            several => Some(format!("the parts {} are missing", several.join(", "))),
        }
    }
}

impl Part {
    /// Returns the part that a frame carries, if its number is one of the message's.
    fn of(
        protocol: &Protocol,
        (long, parts): (&LongMessage, &Parts),
        model: Option<ModelId>,
        frame: &Frame,
        decoded: &Decoded,
    ) -> Option<Self> {
        if decoded.is_error_reply() {
            return None;
        }
        let bits = |signal| decoded.signals.iter().find(|reading| reading.signal == signal).map(|reading| reading.bits);
        let (number, data) = (bits(parts.number)?, parts.data.get(&frame.padded()));
        let index = number.checked_sub(long.first(model)?.into())?;
        let index = usize::try_from(index).ok().filter(|index| *index < long.parts_of(long.longest()))?;
        let data = data.to_be_bytes()[8 - long.size()..].to_vec();
        let counter = parts.counter.and_then(bits);
        let length = parts.length.filter(|_| index == 0).map(|length| length.place.get(&frame.padded()));
        let announced = length.map(|length| usize::try_from(length).unwrap_or(usize::MAX));
        let is_last = protocol.continuation().filter(|_| parts.length.is_none()).is_some_and(|continuation| {
            let found = match continuation.place {
                SelectorPlace::Identifier(field) => u64::from(protocol[field].get(frame.id)),
                SelectorPlace::Payload(place) => place.get(&frame.padded()),
            };
            found != continuation.raw
        });
        Some(Self { index, data, counter, announced, is_last })
    }
}

/// Notes bytes behind the end of a message that are not as they are sent.
fn filling_note(long: &LongMessage, rest: &[u8]) -> Option<Note> {
    let Reserved { are_ones, are_free, .. } = long.content.reserved;
    let fill = if are_ones { 0xFF } else { 0 };
    let is_odd = !are_free && rest.iter().any(|byte| *byte != fill);
    let text = || format!("bytes behind the end of the message are not all 0x{fill:02X}");
    is_odd.then(|| Note { rule: NoteRule::ReservedBit, text: text() })
}

fn nanoseconds(time: Duration) -> Option<u64> {
    u64::try_from(time.as_nanos()).ok()
}
