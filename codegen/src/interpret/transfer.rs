//! Transfers of long messages by a transport: puts their packets together, and makes their frames.

use super::assembly::{Assembled, Taken};
use super::content::blank_data;
use super::decode::transported;
use super::encode::{frame, refuse};
use super::long::Joined;
use super::{Decoded, Form, Frame, Note, Refusal};
use crate::model::{
    FieldId, FrameLayout, LongMessage, LongMessageId, MessageId, ModelId, NoteRule, Protocol, Transport,
    TransportFrame, TransportId,
};

/// The transfers that have begun. `M` is what the caller remembers of each frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfers<M>(Vec<Transfer<M>>);

impl<M> Default for Transfers<M> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

/// The raw addresses of the sender and the receiver of a message.
type Ends = (u32, u32);

/// One message, as far as its packets came.
#[derive(Clone, Debug, PartialEq)]
struct Transfer<M> {
    transport: TransportId,
    ends: Ends,
    long: LongMessageId,
    /// Which of the long message's frames it would be if one were enough.
    layout: usize,
    /// The identifier of that frame.
    id: u32,
    /// Number of bytes that were announced.
    size: usize,
    announcement: M,
    packets: Vec<Option<(Vec<u8>, M)>>,
    /// The packet from which the receiver lets them come once more.
    again: Option<usize>,
    /// Whether the message ended. Only the receiver has something to say then.
    is_done: bool,
}

/// A frame of a transport, taken apart.
struct Part<'a> {
    protocol: &'a Protocol,
    model: Option<ModelId>,
    id: TransportId,
    transport: &'a Transport,
    frame: &'a Frame,
    decoded: &'a Decoded,
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
        let part = Part { protocol, model, id, transport, frame, decoded };
        Some(match kind {
            TransportFrame::RequestToSend | TransportFrame::Broadcast => self.begin(&part, mark),
            TransportFrame::Data => self.packet(&part, mark),
            TransportFrame::ClearToSend => self.allow(&part),
            TransportFrame::EndOfMessage => self.acknowledge(&part),
            TransportFrame::Abort => self.abort(&part),
        })
    }

    /// Ends all transfers that have begun.
    pub fn finish(&mut self, protocol: &Protocol, model: Option<ModelId>) -> Vec<Assembled<M>> {
        let open = std::mem::take(&mut self.0).into_iter().filter(|transfer| !transfer.is_done);
        open.map(|transfer| transfer.assembled(protocol, model, None)).collect()
    }

    fn place(&self, part: &Part, ends: Ends) -> Option<usize> {
        self.0.iter().position(|known| (known.transport, known.ends) == (part.id, ends))
    }

    /// Ends the transfer at a place, and says why if it is not whole.
    fn end(&mut self, part: &Part, place: usize, why: &str) -> Option<Assembled<M>> {
        let transfer = self.0.swap_remove(place);
        (!transfer.is_done).then(|| transfer.assembled(part.protocol, part.model, Some(why.to_owned())))
    }

    fn begin(&mut self, part: &Part, mark: M) -> Taken<M> {
        let open = self.place(part, part.ends());
        let mut ended: Vec<_> =
            open.and_then(|open| self.end(part, open, "another message begins")).into_iter().collect();
        let (Some(size), Some(packets), Some(group)) =
            (part.number("size"), part.number("packets"), part.number("group"))
        else {
            return Taken { is_part: false, ended };
        };
        let Some((long, layout, id)) = part.message(group) else { return Taken { is_part: false, ended } };
        let is_right = part.decoded.notes.iter().all(|note| note.rule != NoteRule::OutOfRange)
            && size.div_ceil(Transport::PACKET) == packets;
        let transfer = Transfer {
            transport: part.id,
            ends: part.ends(),
            long,
            layout,
            id,
            size,
            announcement: mark,
            packets: vec![None; if is_right { packets } else { 0 }],
            again: None,
            is_done: false,
        };
        if is_right {
            self.0.push(transfer);
        } else {
            let why = format!("{size} bytes in {packets} packets are announced");
            ended.push(transfer.assembled(part.protocol, part.model, Some(why)));
        }
        Taken { is_part: true, ended }
    }

    fn packet(&mut self, part: &Part, mark: M) -> Taken<M> {
        let nothing = Taken { is_part: false, ended: Vec::new() };
        let open = self.place(part, part.ends()).filter(|open| !self.0[*open].is_done);
        let (Some(open), Some(number)) = (open, part.number("number")) else { return nothing };
        let transfer = &mut self.0[open];
        let Some(index) = number.checked_sub(1).filter(|index| *index < transfer.packets.len()) else { return nothing };
        let data = part.frame.data.iter().skip(1).copied().collect::<Vec<_>>();
        let is_again = transfer.again.is_some_and(|first| index >= first);
        let why = match &transfer.packets[index] {
            _ if is_again => None,
            Some((known, _)) if *known == data => return Taken { is_part: true, ended: Vec::new() },
            Some(_) => Some(format!("packet {number} came twice, with other data")),
            None => {
                let later = transfer.packets.iter().skip(index).position(Option::is_some);
                later.map(|later| format!("packet {number} came after packet {}", number + later))
            }
        };
        if let Some(why) = why {
            return Taken { is_part: true, ended: self.end(part, open, &why).into_iter().collect() };
        }
        transfer.packets[index] = Some((data, mark));
        let is_last = transfer.ends.1 == Transport::EVERYBODY && number == transfer.packets.len();
        let is_whole = transfer.packets.iter().all(Option::is_some);
        if !is_whole && !is_last {
            return Taken { is_part: true, ended: Vec::new() };
        }
        let whole = transfer.clone().assembled(part.protocol, part.model, None);
        transfer.is_done = true;
        Taken { is_part: true, ended: vec![whole] }
    }

    /// Takes what the receiver lets come. It can ask for packets once more.
    fn allow(&mut self, part: &Part) -> Taken<M> {
        let open = self.place(part, part.ends_of_answer());
        let next = part.number("next").and_then(|next| next.checked_sub(1));
        if let (Some(open), Some(next)) = (open, next) {
            let transfer = &mut self.0[open];
            let is_again = transfer.packets.iter().skip(next).any(Option::is_some);
            transfer.again = is_again.then_some(next);
        }
        Taken { is_part: open.is_some(), ended: Vec::new() }
    }

    fn acknowledge(&mut self, part: &Part) -> Taken<M> {
        let Some(open) = self.place(part, part.ends_of_answer()) else {
            return Taken { is_part: false, ended: Vec::new() };
        };
        let ended = self.end(part, open, "the receiver says that it came whole");
        Taken { is_part: true, ended: ended.into_iter().collect() }
    }

    fn abort(&mut self, part: &Part) -> Taken<M> {
        let ends = [part.ends(), part.ends_of_answer()];
        let group = part.number("group");
        let is_meant = |open: &usize| {
            let transfer = &self.0[*open];
            Some(transfer.group(part.protocol, part.transport)) == group
        };
        let Some(open) = ends.into_iter().filter_map(|ends| self.place(part, ends)).find(is_meant) else {
            return Taken { is_part: false, ended: Vec::new() };
        };
        let reason = part.number("reason").unwrap_or_default();
        let ended = self.end(part, open, &format!("the transfer is aborted for reason {reason}"));
        Taken { is_part: true, ended: ended.into_iter().collect() }
    }
}

impl Part<'_> {
    /// Returns the raw value of one of its signals.
    fn number(&self, name: &str) -> Option<usize> {
        let message = &self.protocol[self.decoded.message];
        let reading = self.decoded.signals.iter().find(|reading| message[reading.signal].name == name)?;
        usize::try_from(reading.bits).ok()
    }

    /// Returns the ends of the transfer that the sender's frame belongs to.
    fn ends(&self) -> Ends {
        let Transport { source, target, .. } = *self.transport;
        let [sender, receiver] = [source, target].map(|field| self.protocol[field].get(self.frame.id));
        (sender, receiver)
    }

    /// Returns the ends of the transfer that the receiver's frame belongs to.
    fn ends_of_answer(&self) -> Ends {
        let (sender, receiver) = self.ends();
        (receiver, sender)
    }

    /// Finds the long message of a group, which frame it would be if one were enough, and the identifier of that.
    fn message(&self, group: usize) -> Option<(LongMessageId, usize, u32)> {
        let protocol = self.protocol;
        let shown = self.transport.with_group(protocol, self.frame.id, u32::try_from(group).ok()?);
        let is_shown = |layout: &FrameLayout| {
            let mut constants = layout.identifier();
            layout.sender == self.decoded.sender && constants.all(|(field, value)| protocol[field].get(shown) == value)
        };
        let carried = protocol.long_messages.entries().filter(|(_, long)| long.transport() == Some(self.id));
        let mut found = carried.filter_map(|(id, long)| Some((id, long, long.frames.iter().position(is_shown)?)));
        let (id, long, layout) = found.next()?;
        let is_free = |field: &FieldId| *field != self.transport.source && !self.transport.group.contains(field);
        let fields = protocol.identifier.fields.entries().filter(|(field, _)| is_free(field));
        let defaults = fields.filter_map(|(field, known)| Some((field, known.send?)));
        let sends = defaults.chain(protocol[long.message].sends.iter().copied());
        Some((id, layout, sends.fold(shown, |id, (field, value)| protocol[field].put(id, value))))
    }
}

impl<M: Clone> Transfer<M> {
    /// Returns the number of its group.
    fn group(&self, protocol: &Protocol, transport: &Transport) -> usize {
        usize::try_from(transport.group_of(protocol, self.id)).unwrap_or(usize::MAX)
    }

    /// Reads what came. `why` says what ended it before its time.
    fn assembled(self, protocol: &Protocol, model: Option<ModelId>, why: Option<String>) -> Assembled<M> {
        let long = &protocol[self.long];
        let mut joined =
            Joined { data: Vec::new(), came: Vec::new(), count: long.elements_in(self.size), is_ended: true };
        for packet in &self.packets {
            joined.data.extend(packet.as_ref().map_or(&[0; Transport::PACKET][..], |(data, _)| data));
            joined.came.extend([packet.is_some(); Transport::PACKET]);
        }
        let is_filled = joined.data.iter().skip(self.size).all(|byte| *byte == 0xFF);
        joined.data.truncate(self.size);
        joined.came.truncate(self.size);
        let incomplete = self.missing(long, why);
        let said = joined.read(protocol, long, model);
        let layout = &long.frames[self.layout];
        let frame = Frame { id: self.id, extended: protocol.identifier.extended, data: Vec::new(), form: Form::Data };
        let decoded = transported(protocol, model, layout, &frame);
        let mut notes: Vec<_> = decoded.notes.iter().cloned().chain(said.notes).collect();
        if incomplete.is_none() && !is_filled {
            let text = "bytes behind the end of the message are not all 0xFF".to_owned();
            notes.push(Note { rule: NoteRule::ReservedBit, text });
        }
        let marks = self.packets.into_iter().flatten().map(|(_, mark)| mark);
        Assembled {
            marks: std::iter::once(self.announcement).chain(marks).collect(),
            frame,
            decoded: Decoded { long: Some(self.long), signals: said.signals, notes, ..decoded },
            data: incomplete.is_none().then_some(joined.data),
            reserved: said.reserved,
            incomplete,
        }
    }

    /// Says what is missing, and why.
    fn missing(&self, long: &LongMessage, why: Option<String>) -> Option<String> {
        let missing = self.packets.iter().enumerate().filter(|(_, packet)| packet.is_none());
        let missing: Vec<_> = missing.map(|(index, _)| (index + 1).to_string()).collect();
        let what = match missing.as_slice() {
            [] if self.packets.is_empty() => None,
            [] if !long.has_length(self.size) => Some(format!("{} bytes came, which the message never has", self.size)),
            [] => return None,
            [one] => Some(format!("packet {one} is missing")),
            several => Some(format!("the packets {} are missing", several.join(", "))),
        };
        Some([what, why].into_iter().flatten().collect::<Vec<_>>().join("; "))
    }
}

/// Makes the frames that carry a long message: one, or an announcement and packets. `id` is the identifier that it would
/// have as one frame.
pub fn frames(
    protocol: &Protocol,
    transport: &Transport,
    (layout, id): (&FrameLayout, u32),
    data: &[u8],
) -> Result<Vec<Frame>, Refusal> {
    if data.len() <= 8 {
        return Ok(vec![frame(protocol, id, data.to_vec())]);
    }
    let group = transport.group_of(protocol, id);
    let receiver =
        if transport.has_receiver(group) { protocol[transport.target].get(id) } else { Transport::EVERYBODY };
    let announcement =
        if receiver == Transport::EVERYBODY { TransportFrame::Broadcast } else { TransportFrame::RequestToSend };
    let packets = data.chunks(Transport::PACKET);
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
        let id = identifier(protocol, (message, own), protocol[transport.target].put(id, receiver));
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
