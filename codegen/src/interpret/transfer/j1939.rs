//! Transfers by SAE J1939-21: an announcement, packets with numbers, and the receiver's answers.

use std::collections::BTreeMap;

use indexmap::IndexMap;

use super::{Arrived, Part, Started};
use crate::interpret::assembled::{Assembled, Taken};
use crate::interpret::content::blank_data;
use crate::interpret::refusal::refuse;
use crate::interpret::{Frame, Note, Refusal, frame};
use crate::model::{
    FieldId, FrameLayout, Groups, LongMessage, MessageId, ModelId, NoteRule, Protocol, Transport, TransportFrame,
    TransportId,
};

/// The transfers that have begun, by their ends. `M` is what the caller remembers of each frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfers<M>(IndexMap<Link, Transfer<M>>);

impl<M> Default for Transfers<M> {
    fn default() -> Self {
        Self(IndexMap::new())
    }
}

type Link = (TransportId, Ends);

/// The raw addresses of the sender and the receiver of a message.
type Ends = (u32, u32);

/// One message, as far as its packets came.
#[derive(Clone, Debug, PartialEq)]
struct Transfer<M> {
    started: Started,
    announcement: M,
    /// How many packets are announced.
    count: usize,
    /// The data of those that came, by their place.
    packets: BTreeMap<usize, Vec<u8>>,
    /// The place of each packet that is kept, and its frame, in the order in which they came.
    marks: Vec<(usize, M)>,
    /// The packet from which the receiver lets them come once more.
    again: Option<usize>,
    /// Whether the message ended. Only the receiver has something to say then.
    is_done: bool,
}

impl<M: Clone> Transfers<M> {
    /// Takes a frame of the transport.
    pub fn take(&mut self, part: &Part, groups: &Groups, kind: TransportFrame, mark: M) -> Taken<M> {
        match kind {
            TransportFrame::RequestToSend | TransportFrame::Broadcast => self.begin(part, groups, mark),
            TransportFrame::Data => self.packet(part, groups, mark),
            TransportFrame::ClearToSend => self.allow(part, groups),
            TransportFrame::EndOfMessage => self.acknowledge(part, groups),
            TransportFrame::Abort => self.abort(part, groups),
            TransportFrame::Single
            | TransportFrame::First
            | TransportFrame::Consecutive
            | TransportFrame::FlowControl => Taken::NOTHING,
        }
    }

    /// Ends all transfers that have begun.
    pub fn finish(&mut self, protocol: &Protocol, model: Option<ModelId>) -> Vec<Assembled<M>> {
        let open = std::mem::take(&mut self.0).into_values().filter(|transfer| !transfer.is_done);
        open.map(|transfer| transfer.assembled(protocol, model, None)).collect()
    }

    /// Ends a transfer, and says why if it is not whole.
    fn end(&mut self, part: &Part, link: Link, why: &str) -> Option<Assembled<M>> {
        let transfer = self.0.swap_remove(&link)?;
        (!transfer.is_done).then(|| transfer.assembled(part.protocol, part.model, Some(why.to_owned())))
    }

    fn begin(&mut self, part: &Part, groups: &Groups, mark: M) -> Taken<M> {
        let link = link(part, groups);
        let mut ended: Vec<_> = self.end(part, link, "another message begins").into_iter().collect();
        let (Some(size), Some(packets), Some(group)) =
            (part.number("size"), part.number("packets"), part.number("group"))
        else {
            return Taken { is_part: false, ended };
        };
        let Some(started) = message(part, groups, group).map(|known| Started { size, ..known }) else {
            return Taken { is_part: false, ended };
        };
        let is_right = part.decoded.notes.iter().all(|note| note.rule != NoteRule::OutOfRange)
            && size.div_ceil(Groups::PACKET) == packets;
        let transfer = Transfer {
            started,
            announcement: mark,
            count: if is_right { packets } else { 0 },
            packets: BTreeMap::new(),
            marks: Vec::new(),
            again: None,
            is_done: false,
        };
        if is_right {
            self.0.insert(link, transfer);
        } else {
            let why = format!("{size} bytes in {packets} packets are announced");
            ended.push(transfer.assembled(part.protocol, part.model, Some(why)));
        }
        Taken { is_part: true, ended }
    }

    fn packet(&mut self, part: &Part, groups: &Groups, mark: M) -> Taken<M> {
        let link = link(part, groups);
        let open = self.0.get_mut(&link).filter(|open| !open.is_done);
        let (Some(transfer), Some(number)) = (open, part.number("number")) else { return Taken::NOTHING };
        let Some(index) = number.checked_sub(1).filter(|index| *index < transfer.count) else {
            return Taken::NOTHING;
        };
        let data = part.frame.data.iter().skip(1).copied().collect::<Vec<_>>();
        let is_again = transfer.again.is_some_and(|first| index >= first);
        let why = match transfer.packets.get(&index) {
            _ if is_again => None,
            Some(known) if *known == data => return Taken { is_part: true, ended: Vec::new() },
            Some(_) => Some(format!("packet {number} came twice, with other data")),
            None => {
                let later = transfer.packets.range(index..).next();
                later.map(|(later, _)| format!("packet {number} came after packet {}", later + 1))
            }
        };
        if let Some(why) = why {
            return Taken { is_part: true, ended: self.end(part, link, &why).into_iter().collect() };
        }
        transfer.packets.insert(index, data);
        transfer.marks.retain(|(known, _)| *known != index);
        transfer.marks.push((index, mark));
        let (_, (_, receiver)) = link;
        let is_last = receiver == Groups::EVERYBODY && number == transfer.count;
        let is_whole = transfer.packets.len() == transfer.count;
        if !is_whole && !is_last {
            return Taken { is_part: true, ended: Vec::new() };
        }
        let whole = transfer.clone().assembled(part.protocol, part.model, None);
        transfer.is_done = true;
        Taken { is_part: true, ended: vec![whole] }
    }

    /// Takes what the receiver lets come. It can ask for packets once more.
    fn allow(&mut self, part: &Part, groups: &Groups) -> Taken<M> {
        let Some(transfer) = self.0.get_mut(&link_of_answer(part, groups)) else { return Taken::NOTHING };
        if let Some(next) = part.number("next").and_then(|next| next.checked_sub(1)) {
            let is_again = transfer.packets.range(next..).next().is_some();
            transfer.again = is_again.then_some(next);
        }
        Taken { is_part: true, ended: Vec::new() }
    }

    fn acknowledge(&mut self, part: &Part, groups: &Groups) -> Taken<M> {
        let link = link_of_answer(part, groups);
        if !self.0.contains_key(&link) {
            return Taken::NOTHING;
        }
        let ended = self.end(part, link, "the receiver says that it came whole");
        Taken { is_part: true, ended: ended.into_iter().collect() }
    }

    fn abort(&mut self, part: &Part, groups: &Groups) -> Taken<M> {
        let group = part.number("group");
        let is_meant =
            |link: &Link| self.0.get(link).is_some_and(|open| Some(open.group(part.protocol, groups)) == group);
        let links = [link(part, groups), link_of_answer(part, groups)];
        let Some(link) = links.into_iter().find(is_meant) else { return Taken::NOTHING };
        let reason = part.number("reason").unwrap_or_default();
        let ended = self.end(part, link, &format!("the transfer is aborted for reason {reason}"));
        Taken { is_part: true, ended: ended.into_iter().collect() }
    }
}

/// Returns the link of the transfer that the sender's frame belongs to.
fn link(part: &Part, groups: &Groups) -> Link {
    let [sender, receiver] = [groups.source, groups.target].map(|field| part.protocol[field].get(part.frame.id));
    (part.id, (sender, receiver))
}

/// Returns the link of the transfer that the receiver's frame belongs to.
fn link_of_answer(part: &Part, groups: &Groups) -> Link {
    let (transport, (sender, receiver)) = link(part, groups);
    (transport, (receiver, sender))
}

/// Finds the long message of a group, which frame it would be if one were enough, and the identifier of that.
fn message(part: &Part, groups: &Groups, group: usize) -> Option<Started> {
    let protocol = part.protocol;
    let shown = groups.with_group(protocol, part.frame.id, u32::try_from(group).ok()?);
    let is_shown = |layout: &FrameLayout| {
        let mut constants = layout.identifier();
        layout.sender == part.decoded.sender && constants.all(|(field, value)| protocol[field].get(shown) == value)
    };
    let carried = protocol.long_messages.entries().filter(|(_, long)| long.transport() == Some(part.id));
    let mut found = carried.filter_map(|(id, long)| Some((id, long, long.frames.iter().position(is_shown)?)));
    let (id, long, layout) = found.next()?;
    let is_free = |field: &FieldId| *field != groups.source && !groups.group.contains(field);
    let fields = protocol.identifier.fields.entries().filter(|(field, _)| is_free(field));
    let defaults = fields.filter_map(|(field, known)| Some((field, known.send?)));
    let sends = defaults.chain(protocol[long.message].sends.iter().copied());
    let as_one_frame = sends.fold(shown, |id, (field, value)| protocol[field].put(id, value));
    Some(Started { long: id, layout, id: as_one_frame, size: 0 })
}

impl<M: Clone> Transfer<M> {
    /// Returns the number of its group.
    fn group(&self, protocol: &Protocol, groups: &Groups) -> usize {
        usize::try_from(groups.group_of(protocol, self.started.id)).unwrap_or(usize::MAX)
    }

    /// Reads what came. `why` says what ended it before its time.
    fn assembled(self, protocol: &Protocol, model: Option<ModelId>, why: Option<String>) -> Assembled<M> {
        let incomplete = self.missing(&protocol[self.started.long], why);
        let (mut data, mut came) = (Vec::new(), Vec::new());
        for index in 0..self.count {
            let packet = self.packets.get(&index);
            data.extend(packet.map_or(&[0; Groups::PACKET][..], Vec::as_slice));
            came.extend([packet.is_some(); Groups::PACKET]);
        }
        let is_filled = data.iter().skip(self.started.size).all(|byte| *byte == 0xFF);
        let note = (incomplete.is_none() && !is_filled).then(|| {
            let text = "bytes behind the end of the message are not all 0xFF".to_owned();
            Note { rule: NoteRule::ReservedBit, text }
        });
        let marks = self.marks.into_iter().map(|(_, mark)| mark);
        let marks = std::iter::once(self.announcement).chain(marks).collect();
        Arrived { started: self.started, data, came, marks, incomplete, note }.assembled(protocol, model)
    }

    /// Says what is missing, and why.
    fn missing(&self, long: &LongMessage, why: Option<String>) -> Option<String> {
        let missing = (0..self.count).filter(|index| !self.packets.contains_key(index));
        let missing: Vec<_> = missing.map(|index| (index + 1).to_string()).collect();
        let what = match missing.as_slice() {
            [] if self.count == 0 => None,
            [] => Some(self.started.wrong_length(long)?),
            [one] => Some(format!("packet {one} is missing")),
            several => Some(format!("the packets {} are missing", several.join(", "))),
        };
        Some([what, why].into_iter().flatten().collect::<Vec<_>>().join("; "))
    }
}

/// Makes the frames that carry a long message: one, or an announcement and packets.
pub fn frames(
    protocol: &Protocol,
    (transport, groups): (&Transport, &Groups),
    (layout, id): (&FrameLayout, u32),
    data: &[u8],
) -> Result<Vec<Frame>, Refusal> {
    if data.len() <= 8 {
        return Ok(vec![frame(protocol, id, data.to_vec())]);
    }
    let group = groups.group_of(protocol, id);
    let receiver = if groups.has_receiver(group) { protocol[groups.target].get(id) } else { Groups::EVERYBODY };
    let announcement =
        if receiver == Groups::EVERYBODY { TransportFrame::Broadcast } else { TransportFrame::RequestToSend };
    let packets = data.chunks(Groups::PACKET);
    let whole = |number: usize| u64::try_from(number).unwrap_or(u64::MAX);
    let numbers =
        [("size", whole(data.len())), ("packets", whole(packets.len())), ("most", 0xFF), ("group", group.into())];
    let make = |kind, numbers: &[(&str, u64)]| {
        let message = transport.message(kind).map(|message| (message, &protocol[message]));
        let known = message.and_then(|(id, message)| {
            let own = protocol.frames_of(message).find(|own| own.sender == layout.sender)?;
            Some((id, message, own))
        });
        let (message, content, own) =
            known.ok_or_else(|| refuse(&protocol[layout.message], "its transport has no such frame"))?;
        let id = identifier(protocol, (message, own), protocol[groups.target].put(id, receiver));
        let mut data = blank_data(own);
        for (name, number) in numbers {
            if let Some(signal) = content.signals.iter().find(|signal| signal.name == *name) {
                signal.place.put(&mut data, *number);
            }
        }
        Ok((id, data))
    };
    let (id, head) = make(announcement, &numbers)?;
    let mut frames = vec![frame(protocol, id, head.to_vec())];
    for (number, packet) in (1..).zip(packets) {
        let (id, mut data) = make(TransportFrame::Data, &[("number", number), ("data", u64::MAX >> 8)])?;
        data.iter_mut().skip(1).zip(packet).for_each(|(byte, given)| *byte = *given);
        frames.push(frame(protocol, id, data.to_vec()));
    }
    Ok(frames)
}

/// Returns the identifier of a transport's frame between the nodes of another identifier.
fn identifier(protocol: &Protocol, (message, layout): (MessageId, &FrameLayout), id: u32) -> u32 {
    let sends = protocol[message].sends.iter().copied();
    layout.identifier().chain(sends).fold(id, |id, (field, value)| protocol[field].put(id, value))
}
