//! Transfers of long messages by a transport: puts their frames together, and makes them.

mod isotp;
mod j1939;

use super::assembled::{Assembled, Taken};
use super::decode::transported;
use super::long::{Joined, in_bytes};
use super::{Decoded, Frame, Note, Refusal, frame};
use crate::model::{
    FrameLayout, LongMessage, LongMessageId, ModelId, Protocol, Standard, Transport, TransportFrame, TransportId,
};

/// The transfers that have begun, by standard. `M` is what the caller remembers of each frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfers<M> {
    j1939: j1939::Transfers<M>,
    isotp: isotp::Transfers<M>,
}

impl<M> Default for Transfers<M> {
    fn default() -> Self {
        Self { j1939: j1939::Transfers::default(), isotp: isotp::Transfers::default() }
    }
}

impl<M: Clone> Transfers<M> {
    /// Takes a frame of a transport. It returns nothing if it is none.
    pub fn take(
        &mut self,
        (protocol, model): (&Protocol, Option<ModelId>),
        mark: M,
        frame: &Frame,
        decoded: &Decoded,
    ) -> Option<Taken<M>> {
        let (id, transport, kind) = protocol.transport_frame(decoded.message)?;
        let part = Part { protocol, model, id, frame, decoded };
        Some(match &transport.standard {
            Standard::J1939(groups) => self.j1939.take(&part, groups, kind, mark),
            Standard::Isotp(_) => self.isotp.take(&part, kind, mark),
        })
    }

    /// Ends all transfers that have begun.
    pub fn finish(&mut self, protocol: &Protocol, model: Option<ModelId>) -> Vec<Assembled<M>> {
        let mut ended = self.j1939.finish(protocol, model);
        ended.extend(self.isotp.finish(protocol, model));
        ended
    }
}

/// A frame of a transport, taken apart.
struct Part<'a> {
    protocol: &'a Protocol,
    model: Option<ModelId>,
    id: TransportId,
    frame: &'a Frame,
    decoded: &'a Decoded,
}

impl Part<'_> {
    /// Returns the greatest number of data bytes of a message.
    fn most_bytes(&self) -> usize {
        self.protocol[self.id].standard.most_bytes()
    }

    /// Returns the raw value of one of its signals.
    fn number(&self, name: &str) -> Option<usize> {
        let message = &self.protocol[self.decoded.message];
        let reading = self.decoded.signals.iter().find(|reading| message[reading.signal].name == name)?;
        usize::try_from(reading.bits).ok()
    }
}

/// A message whose transfer has begun.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Started {
    long: LongMessageId,
    /// Which of the long message's frames it would be if one were enough.
    layout: usize,
    /// The identifier of that frame.
    id: u32,
    /// Number of bytes that were announced.
    size: usize,
}

impl Started {
    /// Says that the message never has this number of bytes.
    fn wrong_length(&self, long: &LongMessage) -> Option<String> {
        let known = long.extent(&long.frames[self.layout]).other_lengths(self.size)?;
        Some(format!("{} came, but the message has {known}", in_bytes(self.size)))
    }
}

/// What came of a message.
struct Arrived<M> {
    started: Started,
    /// The bytes; 0 where one is missing.
    data: Vec<u8>,
    /// Which of the bytes came.
    came: Vec<bool>,
    marks: Vec<M>,
    /// What is missing, and why.
    incomplete: Option<String>,
    /// A note on how it came.
    note: Option<Note>,
}

impl<M> Arrived<M> {
    fn assembled(mut self, protocol: &Protocol, model: Option<ModelId>) -> Assembled<M> {
        let Started { long: id, layout, size, .. } = self.started;
        let long = &protocol[id];
        let layout = &long.frames[layout];
        self.data.truncate(size);
        self.came.truncate(size);
        let count = long.extent(layout).elements_in(size);
        let joined = Joined { data: self.data, came: self.came, count, is_ended: true };
        let said = joined.read(protocol, long.extent(layout), model);
        let head = joined.data.iter().copied().take(layout.head()).collect();
        let frame = frame(protocol, self.started.id, head);
        let decoded = transported(protocol, model, layout, &frame);
        let notes = decoded.notes.iter().cloned().chain(said.notes).chain(self.note).collect();
        Assembled {
            marks: self.marks,
            frame,
            decoded: Decoded { long: Some(id), signals: said.signals, notes, ..decoded },
            data: self.incomplete.is_none().then_some(joined.data),
            reserved: said.reserved,
            counter: None,
            incomplete: self.incomplete,
        }
    }
}

/// Makes the frames that carry a long message. `id` is the identifier that it would have as one frame.
pub fn frames(
    protocol: &Protocol,
    transport: &Transport,
    (layout, id): (&FrameLayout, u32),
    data: &[u8],
) -> Result<Vec<Frame>, Refusal> {
    match &transport.standard {
        Standard::J1939(groups) => j1939::frames(protocol, (transport, groups), (layout, id), data),
        Standard::Isotp(isotp) => isotp::frames(protocol, (transport, *isotp), (layout, id), data),
    }
}

/// Returns what frames of a transport send in fields of the identifier.
fn sending(protocol: &Protocol, transport: &Transport, kind: TransportFrame, id: u32) -> u32 {
    let sends = transport.message(kind).into_iter().flat_map(|message| &protocol[message].sends);
    sends.fold(id, |id, (field, value)| protocol[*field].put(id, *value))
}
