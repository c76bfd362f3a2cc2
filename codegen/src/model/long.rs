//! Messages that are longer than a frame.

use std::time::Duration;

use canspec_runtime::Place;
use serde::{Deserialize, Serialize};

use crate::model::{
    ByteRun, Doc, FrameLayout, Groups, Kind, LongMessageId, Message, MessageId, ModelId, OfModel, Protocol, Signal,
    SignalId, TimingId, Transport, TransportId, place,
};

/// What the data of several frames say together.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LongMessage {
    /// The message in the spec.
    pub message: MessageId,
    /// What the frames carry together. Its signals have windows; it has no frames of its own.
    pub content: Message,
    /// How the frames carry it.
    pub carrier: Carrier,
    /// The numbers of data bytes that it can have with its signals, the least first; empty if these decide.
    pub lengths: Vec<u16>,
    /// What its frames would be if one were enough, for a message by a transport. Their signals are those of `content`,
    /// and their payload is the beginning of the joined data.
    pub frames: Vec<FrameLayout>,
}

/// How frames carry a long message.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Carrier {
    /// The frames of the message itself have numbers.
    Parts(Parts),
    /// The frames are those of a transport.
    Transport(TransportId),
}

/// How the parts of a long message are numbered and joined.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Parts {
    /// The signal of the frames that numbers them.
    pub number: SignalId,
    /// The signal of the frames that all parts of a message share, and the next message does not.
    pub counter: Option<SignalId>,
    /// Where the frames carry the data of a part: whole bytes, the first one highest.
    #[serde(with = "place")]
    pub data: Place,
    /// Number of data bytes in a part, those of the length included.
    pub size: u8,
    /// What the first part says of the number of data bytes.
    pub length: Option<Announcement>,
    /// Number of the first part, if it is the same for every model.
    pub first: Option<u16>,
    /// Numbers of the first part by device model, if each has its own.
    pub model_firsts: Vec<OfModel<u16>>,
    /// Where a device says how many elements the array of varying length has.
    pub count: Option<(MessageId, SignalId)>,
    /// How long no part comes behind the last one, if that is how a message ends.
    pub silence: Option<TimingId>,
}

/// Where the first part says how many data bytes there are.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Announcement {
    /// Whole bytes of the frame, at the front of its data.
    #[serde(with = "place")]
    pub place: Place,
}

impl Announcement {
    /// Returns how many bytes say it.
    pub fn bytes(self) -> usize {
        usize::from(self.place.width() / 8)
    }
}

/// A field that has any number of elements, or of bytes if it is a text.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Varying<'a> {
    /// Its name.
    pub name: &'a str,
    /// What the spec says beside it.
    pub doc: &'a Doc,
    /// Whether it is a text.
    pub is_text: bool,
    /// The least number.
    pub least: usize,
    /// The greatest number.
    pub most: usize,
}

impl Parts {
    /// Returns how many bytes before the data say how many there are.
    pub fn head(&self) -> usize {
        self.length.map_or(0, Announcement::bytes)
    }
}

impl LongMessage {
    /// Returns its numbered parts, if it travels in them.
    pub fn parts(&self) -> Option<&Parts> {
        match &self.carrier {
            Carrier::Parts(parts) => Some(parts),
            Carrier::Transport(_) => None,
        }
    }

    /// Returns the transport by which it travels.
    pub fn transport(&self) -> Option<TransportId> {
        match self.carrier {
            Carrier::Parts(_) => None,
            Carrier::Transport(transport) => Some(transport),
        }
    }

    /// Returns how many of its data bytes a frame carries.
    pub fn size(&self) -> usize {
        self.parts().map_or(Groups::PACKET, |parts| parts.size.into())
    }

    /// Returns the greatest number of data bytes.
    pub fn longest(&self) -> usize {
        self.whole().longest()
    }

    /// Returns the least number of data bytes.
    pub fn shortest(&self) -> usize {
        self.whole().shortest()
    }

    /// Returns the least number of data bytes that its frames carry, with those that fill up the last part.
    pub(crate) fn shortest_sent(&self) -> usize {
        let shortest = self.shortest();
        let is_filled = self.parts().is_some_and(|parts| parts.length.is_none());
        if is_filled { self.parts_of(shortest) * self.size() } else { shortest }
    }

    /// Returns the number of data bytes up to the end of the last field that is always there.
    pub fn least(&self) -> usize {
        let text = self.open_text().map_or(0, |(_, run)| run.least.into());
        self.lengths.first().map_or_else(|| self.whole().reach(Some(text)), |length| usize::from(*length))
    }

    /// Tests whether it can have some number of data bytes.
    pub fn has_length(&self, length: usize) -> bool {
        self.whole().has_length(length)
    }

    /// Returns how many data bytes it has with some number of elements in fields of varying length, or with all.
    pub fn bytes_with(&self, elements: Option<usize>) -> usize {
        self.whole().bytes_with(elements)
    }

    /// Tests whether a signal is there if arrays of varying length have some number of elements.
    pub fn is_among(&self, elements: Option<usize>, signal: &Signal) -> bool {
        let known = elements.zip(self.counted(signal));
        known.is_none_or(|(elements, index)| index < elements)
    }

    /// Returns how many elements come before a signal in its array, if the length of that varies.
    pub fn counted(&self, signal: &Signal) -> Option<usize> {
        let element = signal.element?;
        self.content[element.array].least.map(|_| element.index.into())
    }

    /// Tests whether a signal is one of those whose number or length varies.
    pub(crate) fn varies(&self, signal: &Signal) -> bool {
        self.counted(signal).is_some() || signal.run.is_some_and(ByteRun::varies)
    }

    /// Returns the first field whose length varies, if there is one. Others vary with it.
    pub fn varying(&self) -> Option<Varying<'_>> {
        self.all_varying().next()
    }

    /// Returns the fields whose length varies, the arrays first.
    pub fn all_varying(&self) -> impl Iterator<Item = Varying<'_>> {
        let arrays = self.content.arrays.iter().filter_map(|array| {
            let (name, most) = (array.name.as_str(), array.elements.len());
            Some(Varying { name, doc: &array.doc, is_text: false, least: array.least?, most })
        });
        let texts = self.content.signals.iter().filter_map(|text| {
            let run = text.run.filter(|run| run.varies())?;
            let [least, most] = [run.least, run.most].map(usize::from);
            Some(Varying { name: &text.name, doc: &text.doc, is_text: true, least, most })
        });
        arrays.chain(texts)
    }

    /// Returns the text whose length varies, if there is one.
    pub fn open_text(&self) -> Option<(&Signal, ByteRun)> {
        let mut texts = self.content.signals.iter().filter_map(|signal| Some((signal, signal.run?)));
        texts.find(|(_, run)| run.varies())
    }

    /// Returns how many frames carry some number of bytes.
    pub fn parts_of(&self, bytes: usize) -> usize {
        let head = self.parts().map_or(0, Parts::head);
        head.saturating_add(bytes).div_ceil(self.size()).max(1)
    }

    /// Returns the number of the first part, if that is known of the device model.
    pub fn first(&self, model: Option<ModelId>) -> Option<u16> {
        let Some(parts) = self.parts() else { return Some(1) };
        let own = parts.model_firsts.iter().find(|own| Some(own.model) == model);
        own.map(|own| own.value).or(parts.first)
    }
}

impl Protocol {
    /// Returns the long message whose parts a message carries.
    pub fn long_message(&self, message: &Message) -> Option<(LongMessageId, &LongMessage)> {
        let id = message.long?;
        Some((id, &self[id]))
    }

    /// Returns what a message says: alone, or in several frames together.
    pub(crate) fn whole<'a>(&'a self, message: &'a Message) -> &'a Message {
        self.long_message(message).map_or(message, |(_, long)| &long.content)
    }

    /// Tests whether a signal of what a message says goes to a module, alone or in parts.
    pub(crate) fn is_sent(&self, message: &Message, signal: SignalId) -> bool {
        let mut sent = self.layouts_of(message).filter(|frame| frame.is_to_module());
        sent.any(|frame| self.part_of(frame).is_some() || frame.signals.contains(&signal))
    }

    /// Returns the long message whose numbered parts a message's frames carry.
    pub fn in_parts(&self, message: &Message) -> Option<LongMessageId> {
        message.long.filter(|long| self[*long].parts().is_some())
    }

    /// Returns the long message whose part a frame carries.
    pub fn part_of(&self, frame: &FrameLayout) -> Option<LongMessageId> {
        self.in_parts(&self[frame.message]).filter(|_| !frame.signals.is_empty())
    }

    /// Tests whether a frame says what a module is told: it goes there, or confirms a request with values.
    pub(crate) fn is_told(&self, frame: &FrameLayout) -> bool {
        let has_values = |other: &FrameLayout| other.is_to_module() && !other.signals.is_empty();
        let mut exchanged = self.frames_of(&self[frame.message]).filter(|other| other.exchange == frame.exchange);
        frame.is_to_module() || frame.kind == Kind::Reply && exchanged.any(has_values)
    }

    /// Returns the long message that a transport carries, if the message travels so.
    pub fn by_transport(&self, message: &Message) -> Option<LongMessageId> {
        message.long.filter(|long| self[*long].transport().is_some())
    }

    /// Returns the silence that ends a message, if one does.
    pub fn silence(&self, long: &LongMessage) -> Option<Duration> {
        let [_, longest] = self.timing[long.parts()?.silence?].ends();
        Some(longest)
    }

    /// Returns the frames of a message. Of a message by a transport, they are what its frames would be if one were
    /// enough.
    pub fn layouts_of<'a>(&'a self, message: &'a Message) -> impl Iterator<Item = &'a FrameLayout> + Clone {
        let whole = self.long_message(message).map_or(&[][..], |(_, long)| &long.frames);
        let is_whole = |frame: &&FrameLayout| !whole.iter().any(|known| known.is_kind_of(frame));
        whole.iter().chain(self.frames_of(message).filter(is_whole))
    }

    /// Returns the transport that carries a frame, and the long message.
    pub fn carried<'a>(&'a self, frame: &FrameLayout) -> Option<(&'a Transport, &'a LongMessage)> {
        let long = &self[frame.long?];
        Some((&self[long.transport()?], long))
    }

    /// Returns the message whose signals a frame carries: its own, or what several frames carry together.
    pub fn content_of(&self, frame: &FrameLayout) -> &Message {
        frame.long.map_or(&self[frame.message], |long| &self[long].content)
    }

    /// Returns what the frames of each message carry, then what the parts of each long message carry
    /// together.
    pub fn contents(&self) -> impl Iterator<Item = &Message> {
        self.messages.iter().chain(self.long_messages.iter().map(|long| &long.content))
    }
}
