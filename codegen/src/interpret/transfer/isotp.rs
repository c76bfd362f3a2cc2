//! Transfers by ISO 15765-2: a single frame, or a first frame and consecutive ones, and the receiver's flow control.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use indexmap::IndexMap;

use super::{Arrived, Part, Started, sending};
use crate::interpret::assembled::{Assembled, Peers, Taken, module};
use crate::interpret::refusal::refuse;
use crate::interpret::{Frame, Refusal, frame, padded};
use crate::model::{
    Constant, FrameLayout, Isotp, LongMessage, ModeId, ModelId, Protocol, Side, Transport, TransportFrame, TransportId,
};

/// Data bytes of a single and of a consecutive frame, of a first one, and of the longest message.
const SINGLE: usize = 7;
const FIRST: usize = 6;

/// How a receiver says that it has no room for a message.
const OVERFLOW: usize = 2;

/// The messages of several frames that have begun, by who sends them. `M` is what the caller remembers of each frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfers<M> {
    open: IndexMap<Link, Transfer<M>>,
    /// Their links, by what a flow control must show that answers them.
    links: HashMap<Answered, HashSet<Link>>,
}

impl<M> Default for Transfers<M> {
    fn default() -> Self {
        Self { open: IndexMap::new(), links: HashMap::new() }
    }
}

/// One message, as far as its frames came.
#[derive(Clone, Debug, PartialEq)]
struct Transfer<M> {
    started: Started,
    data: Vec<u8>,
    marks: Vec<M>,
}

/// Who sends a frame.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Link {
    transport: TransportId,
    id: u32,
    sender: Side,
    mode: Option<ModeId>,
    peers: Peers,
}

impl Link {
    fn of(part: &Part) -> Self {
        let Part { protocol, id, frame, decoded, .. } = part;
        let mut peers: Peers = decoded.addresses(protocol, frame.id).collect();
        peers.sort_unstable();
        let mode = decoded.addressing.map(|travel| travel.mode);
        Self { transport: *id, id: frame.id, sender: decoded.sender, mode, peers }
    }

    /// Returns what a frame of the receiver shows that answers a frame of this sender. Its mode can be another one, if
    /// addresses show who they are.
    fn answered(&self, protocol: &Protocol, sender: Side) -> Answered {
        let named = module(protocol, &self.peers);
        let mode = self.mode.filter(|_| named.is_empty());
        Answered { transport: self.transport, sender, mode, named }
    }

    /// Tests whether the addresses contradict those of another frame. One that everybody sends can lack.
    fn contradicts(&self, other: &Self) -> bool {
        let differs = |(kind, number): &(_, _)| other.peers.iter().any(|known| known.0 == *kind && known.1 != *number);
        self.peers.iter().any(differs)
    }
}

/// What frames of the sender and of the receiver have in common.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Answered {
    transport: TransportId,
    /// Who sends the message.
    sender: Side,
    mode: Option<ModeId>,
    /// The addresses that are not sent by everybody.
    named: Peers,
}

impl<M: Clone> Transfers<M> {
    /// Takes a frame of the transport. One that the standard tells receivers to ignore changes nothing.
    pub fn take(&mut self, part: &Part, kind: TransportFrame, mark: M) -> Taken<M> {
        match kind {
            TransportFrame::Single => self.single(part, mark),
            TransportFrame::First => self.first(part, mark),
            TransportFrame::Consecutive => self.consecutive(part, mark),
            TransportFrame::FlowControl => self.flow(part),
            TransportFrame::RequestToSend
            | TransportFrame::ClearToSend
            | TransportFrame::EndOfMessage
            | TransportFrame::Broadcast
            | TransportFrame::Abort
            | TransportFrame::Data => Taken::NOTHING,
        }
    }

    /// Ends all transfers that have begun.
    pub fn finish(&mut self, protocol: &Protocol, model: Option<ModelId>) -> Vec<Assembled<M>> {
        let open = std::mem::take(self).open.into_values();
        open.map(|transfer| transfer.assembled(protocol, model, None)).collect()
    }

    /// Ends the message of a sender, if one has begun, and says why if it is not whole.
    fn end(&mut self, part: &Part, link: &Link, why: Option<&str>) -> Vec<Assembled<M>> {
        let open = self.open.swap_remove(link).into_iter();
        if let Entry::Occupied(mut links) = self.links.entry(link.answered(part.protocol, link.sender)) {
            links.get_mut().remove(link);
            if links.get().is_empty() {
                links.remove();
            }
        }
        open.map(|open| open.assembled(part.protocol, part.model, why.map(str::to_owned))).collect()
    }

    /// Ends the message that the sender has begun before.
    fn restarted(&mut self, part: &Part, link: &Link) -> Vec<Assembled<M>> {
        self.end(part, link, Some("another message begins"))
    }

    fn single(&mut self, part: &Part, mark: M) -> Taken<M> {
        let size = part.number("size").filter(|size| *size > 0);
        let Some(data) = size.and_then(|size| part.frame.data.get(1..=size)) else { return Taken::NOTHING };
        let link = Link::of(part);
        let mut ended = self.restarted(part, &link);
        let Some(started) = message(part, data, data.len()) else { return Taken { is_part: false, ended } };
        let transfer = Transfer { started, data: data.to_vec(), marks: vec![mark] };
        ended.push(transfer.assembled(part.protocol, part.model, None));
        Taken { is_part: true, ended }
    }

    fn first(&mut self, part: &Part, mark: M) -> Taken<M> {
        let Some((size, data)) = announced(part) else { return Taken::NOTHING };
        let link = Link::of(part);
        let ended = self.restarted(part, &link);
        let started = message(part, data, size).filter(|_| size <= part.most_bytes());
        let is_part = started.is_some();
        if let Some(started) = started {
            self.links.entry(link.answered(part.protocol, link.sender)).or_default().insert(link.clone());
            self.open.insert(link, Transfer { started, data: data.to_vec(), marks: vec![mark] });
        }
        Taken { is_part, ended }
    }

    fn consecutive(&mut self, part: &Part, mark: M) -> Taken<M> {
        let link = Link::of(part);
        let (Some(transfer), Some(number)) = (self.open.get_mut(&link), part.number("number")) else {
            return Taken::NOTHING;
        };
        let wanted = transfer.marks.len() % 16;
        if number != wanted {
            let why = format!("frame number {number} came in place of {wanted}");
            return Taken { is_part: true, ended: self.end(part, &link, Some(&why)) };
        }
        let missing = transfer.started.size - transfer.data.len();
        let Some(data) = part.frame.data.get(1..=missing.min(SINGLE)) else { return Taken::NOTHING };
        transfer.data.extend(data);
        transfer.marks.push(mark);
        let is_whole = missing <= SINGLE;
        Taken { is_part: true, ended: if is_whole { self.end(part, &link, None) } else { Vec::new() } }
    }

    /// Finds the message that a frame of its receiver answers, the first one if there are several.
    fn answered(&self, protocol: &Protocol, own: &Link) -> Option<Link> {
        let links = self.links.get(&own.answered(protocol, own.sender.other()))?;
        let answered = links.iter().filter(|link| !own.contradicts(link));
        answered.min_by_key(|link| self.open.get_index_of(*link)).cloned()
    }

    /// Takes what the receiver answers.
    fn flow(&mut self, part: &Part) -> Taken<M> {
        let own = Link::of(part);
        let Some(link) = self.answered(part.protocol, &own) else { return Taken::NOTHING };
        let is_over = part.number("status") == Some(OVERFLOW);
        let ended = if is_over { self.end(part, &link, Some("the receiver has no room for it")) } else { Vec::new() };
        Taken { is_part: true, ended }
    }
}

impl<M: Clone> Transfer<M> {
    /// Reads what came. `why` says what ended it before its time.
    fn assembled(mut self, protocol: &Protocol, model: Option<ModelId>, why: Option<String>) -> Assembled<M> {
        let incomplete = self.missing(&protocol[self.started.long], why);
        let came = vec![true; self.data.len()];
        let came = [came, vec![false; self.started.size - self.data.len()]].concat();
        self.data.resize(self.started.size, 0);
        let Self { started, data, marks, .. } = self;
        Arrived { started, data, came, marks, incomplete, note: None }.assembled(protocol, model)
    }

    /// Says what is missing, and why.
    fn missing(&self, long: &LongMessage, why: Option<String>) -> Option<String> {
        let (came, size) = (self.data.len(), self.started.size);
        if came == size {
            return self.started.wrong_length(long);
        }
        let what = format!("{came} of {size} bytes came");
        Some([Some(what), why].into_iter().flatten().collect::<Vec<_>>().join("; "))
    }
}

/// Returns how many data bytes a first frame announces, and the first of them. A size of more than twelve bits stands in
/// four bytes of its own.
fn announced<'a>(part: &Part<'a>) -> Option<(usize, &'a [u8])> {
    let (size, data) = (part.number("size")?, part.frame.data.get(2..)?);
    if size > 0 {
        return (size > SINGLE).then_some((size, data));
    }
    let (size, data) = data.split_first_chunk()?;
    let size = usize::try_from(u32::from_be_bytes(*size)).ok()?;
    (size > part.most_bytes()).then_some((size, data))
}

/// Tests whether the data show a constant that stands there.
fn shows(constant: &Constant, data: [u8; 8]) -> bool {
    constant.in_payload().is_none_or(|(place, _)| constant.admits(place.get(&data)))
}

/// Finds the message whose data begin so.
fn message(part: &Part, data: &[u8], size: usize) -> Option<Started> {
    let Part { protocol, model, id, frame, decoded } = *part;
    let head = padded(data);
    let is_shown = |layout: &FrameLayout| {
        layout.sender == decoded.sender
            && layout.identifier().all(|(field, value)| protocol[field].get(frame.id) == value)
            && layout.constants.iter().all(|constant| shows(constant, head))
            && layout.head() <= size
    };
    let has_model = |long: &LongMessage| model.is_none_or(|model| long.content.is_of(model));
    let carried = protocol.long_messages.entries().filter(|(_, long)| long.transport() == Some(id));
    let mut shown = carried.filter_map(|(id, long)| Some((id, long, long.frames.iter().position(is_shown)?)));
    let (long, _, layout) = shown.clone().find(|(_, long, _)| has_model(long)).or_else(|| shown.next())?;
    Some(Started { long, layout, id: frame.id, size })
}

/// Makes the frames that carry a message: a single one, or a first and consecutive ones.
pub fn frames(
    protocol: &Protocol,
    (transport, isotp): (&Transport, Isotp),
    (layout, id): (&FrameLayout, u32),
    data: &[u8],
) -> Result<Vec<Frame>, Refusal> {
    let make = |kind, head: &[u8], data: &[u8]| {
        let mut bytes = [head, data].concat();
        if let Some(fill) = isotp.fill {
            bytes.resize(8, fill);
        }
        frame(protocol, sending(protocol, transport, kind, id), bytes)
    };
    let low = |number: usize| u8::try_from(number % 256).unwrap_or_default();
    match data.len() {
        0 => Err(refuse(&protocol[layout.message], "a message without data bytes cannot be sent")),
        size @ 1..=SINGLE => Ok(vec![make(TransportFrame::Single, &[low(size)], data)]),
        size => {
            let (beginning, rest) = data.split_at(FIRST);
            let first = make(TransportFrame::First, &[0x10 | low(size / 256), low(size)], beginning);
            let others = (1..).zip(rest.chunks(SINGLE));
            let others =
                others.map(|(number, chunk)| make(TransportFrame::Consecutive, &[0x20 | low(number % 16)], chunk));
            Ok(std::iter::once(first).chain(others).collect())
        }
    }
}
