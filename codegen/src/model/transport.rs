//! Transports: standards by which messages longer than a frame travel.

use serde::{Deserialize, Serialize};

use crate::model::{Doc, FieldId, MessageId, Protocol, TransportId};

/// A standard by which messages travel, as a protocol uses it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Transport {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// The standard.
    pub standard: Standard,
    /// The messages that are its frames, in the order of [`Standard::frames`].
    pub frames: Vec<MessageId>,
}

/// A standard of transports.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Standard {
    /// SAE J1939-21. It announces a message longer than a frame, and carries it in packets of seven bytes.
    J1939(Groups),
    /// ISO 15765-2. It carries messages of any length in frames of its own, which have the identifier of the message.
    Isotp(Isotp),
}

/// How J1939 numbers messages, and who sends them.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Groups {
    /// Fields of the identifier that are the number of a group of parameters, the highest bits first.
    pub group: Vec<FieldId>,
    /// The field with the address of the receiver. It is the last one of `group`.
    pub target: FieldId,
    /// The field with the address of the sender.
    pub source: FieldId,
}

/// How ISO-TP makes frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Isotp {
    /// The byte that fills frames up to eight bytes; `None` if they end with their data.
    pub fill: Option<u8>,
}

/// What a frame of a transport is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum TransportFrame {
    /// Announces a message to one node, which says when the packets may come.
    RequestToSend,
    /// Lets some packets come, or none yet.
    ClearToSend,
    /// Says that all packets came.
    EndOfMessage,
    /// Announces a message to all nodes.
    Broadcast,
    /// Ends a transfer before its time.
    Abort,
    /// Carries a packet.
    Data,
    /// Carries a whole message.
    Single,
    /// Announces a message, and carries its beginning.
    First,
    /// Carries the next bytes of a message.
    Consecutive,
    /// Says how the message may go on.
    FlowControl,
}

impl TransportFrame {
    /// Tests whether it carries bytes of a message.
    pub fn has_data(self) -> bool {
        matches!(self, Self::Data | Self::Single | Self::First | Self::Consecutive)
    }
}

impl Standard {
    /// Returns its frames, each with the end of its message's name.
    pub fn frames(&self) -> &'static [(TransportFrame, &'static str)] {
        match self {
            Self::J1939(_) => &[
                (TransportFrame::RequestToSend, "request_to_send"),
                (TransportFrame::ClearToSend, "clear_to_send"),
                (TransportFrame::EndOfMessage, "end_of_message"),
                (TransportFrame::Broadcast, "broadcast"),
                (TransportFrame::Abort, "abort"),
                (TransportFrame::Data, "data"),
            ],
            Self::Isotp(_) => &[
                (TransportFrame::Single, "single_frame"),
                (TransportFrame::First, "first_frame"),
                (TransportFrame::Consecutive, "consecutive_frame"),
                (TransportFrame::FlowControl, "flow_control"),
            ],
        }
    }

    /// Returns the greatest number of data bytes of a message.
    pub fn most_bytes(&self) -> usize {
        match self {
            Self::J1939(_) => 1785,
            Self::Isotp(_) => 4095,
        }
    }

    /// Tests whether a message of up to eight bytes is a frame of its own.
    pub fn has_plain_frames(&self) -> bool {
        matches!(self, Self::J1939(_))
    }
}

impl Transport {
    /// Returns the message of a frame.
    pub fn message(&self, frame: TransportFrame) -> Option<MessageId> {
        let place = self.standard.frames().iter().position(|(known, _)| *known == frame)?;
        self.frames.get(place).copied()
    }

    /// Returns which of its frames carries a message.
    pub fn frame(&self, message: MessageId) -> Option<TransportFrame> {
        let place = self.frames.iter().position(|known| *known == message)?;
        Some(self.standard.frames()[place].0)
    }
}

impl Groups {
    /// The address of all nodes.
    pub const EVERYBODY: u32 = 0xFF;

    /// Data bytes of a packet.
    pub const PACKET: usize = 7;

    /// Returns the number of the group that an identifier shows. The address of a receiver is no part of it.
    pub fn group_of(&self, protocol: &Protocol, id: u32) -> u32 {
        let group =
            self.group.iter().fold(0, |group, field| group << protocol[*field].width | protocol[*field].get(id));
        if self.has_receiver(group) { group & !Self::EVERYBODY } else { group }
    }

    /// Returns an identifier with the number of another group. The receiver stays, if the identifier has room for it.
    pub fn with_group(&self, protocol: &Protocol, id: u32, group: u32) -> u32 {
        let receiver = protocol[self.target].get(id);
        let group = if self.has_receiver(group) { group & !Self::EVERYBODY | receiver } else { group };
        let put = |(id, group): (u32, u32), field: &FieldId| {
            let field = &protocol[*field];
            (field.put(id, group & field.greatest()), group >> field.width)
        };
        self.group.iter().rev().fold((id, group), put).0
    }

    /// Tests whether the last byte of a group's number is the place of a receiver.
    pub fn has_receiver(&self, group: u32) -> bool {
        group >> 8 & 0xFF < 0xF0
    }
}

impl Protocol {
    /// Returns the transport that a message is a frame of, and which frame it is.
    pub fn transport_frame(&self, message: MessageId) -> Option<(TransportId, &Transport, TransportFrame)> {
        self.transports.entries().find_map(|(id, transport)| Some((id, transport, transport.frame(message)?)))
    }
}
