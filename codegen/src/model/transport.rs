//! Transports: standards by which messages longer than a frame travel.

use serde::{Deserialize, Serialize};

use crate::model::{Doc, FieldId, MessageId, Protocol, TransportId};

/// A transport of SAE J1939-21. It announces a message, and carries it in packets of seven bytes.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Transport {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Fields of the identifier that are the number of a group of parameters, the highest bits first.
    pub group: Vec<FieldId>,
    /// The field with the address of the receiver. It is the last one of `group`.
    pub target: FieldId,
    /// The field with the address of the sender.
    pub source: FieldId,
    /// The messages that are its frames, in the order of [`TransportFrame::ALL`].
    pub frames: Vec<MessageId>,
}

/// What a frame of a transport is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
}

impl TransportFrame {
    /// Every frame, with the end of its message's name.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::RequestToSend, "request_to_send"),
        (Self::ClearToSend, "clear_to_send"),
        (Self::EndOfMessage, "end_of_message"),
        (Self::Broadcast, "broadcast"),
        (Self::Abort, "abort"),
        (Self::Data, "data"),
    ];
}

impl Transport {
    /// The address of all nodes.
    pub const EVERYBODY: u32 = 0xFF;

    /// Data bytes of a packet.
    pub const PACKET: usize = 7;

    /// Returns the message of a frame.
    pub fn message(&self, frame: TransportFrame) -> Option<MessageId> {
        let place = TransportFrame::ALL.iter().position(|(known, _)| *known == frame)?;
        self.frames.get(place).copied()
    }

    /// Returns which of its frames carries a message.
    pub fn frame(&self, message: MessageId) -> Option<TransportFrame> {
        let place = self.frames.iter().position(|known| *known == message)?;
        Some(TransportFrame::ALL[place].0)
    }

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
