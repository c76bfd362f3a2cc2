//! Control frames: TP.CM.

use crate::Data;

/// What a control frame says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Control {
    /// Somebody wants to send a message to one receiver.
    Rts {
        /// Data bytes of the message.
        size: u16,
        /// Number of packets.
        packets: u8,
        /// The greatest number of packets that one [`Cts`](Self::Cts) may allow; 255 means any.
        limit: u8,
    },
    /// The receiver allows packets.
    Cts {
        /// How many; 0 asks to wait.
        packets: u8,
        /// The first of them, which counts from 1.
        next: u8,
    },
    /// The receiver has the whole message.
    EndOfMsgAck {
        /// Data bytes of the message.
        size: u16,
        /// Number of packets.
        packets: u8,
    },
    /// One of both gives up.
    Abort(Reason),
    /// Somebody sends a message to all.
    Bam {
        /// Data bytes of the message.
        size: u16,
        /// Number of packets.
        packets: u8,
    },
}

/// Why a transfer is given up. Later editions of the standard and devices have more reasons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Reason(pub u8);

impl Reason {
    /// The node has a session already.
    pub const BUSY: Self = Self(1);
    /// The node needs its resources elsewhere.
    pub const RESOURCES: Self = Self(2);
    /// The other node was silent for too long.
    pub const TIMEOUT: Self = Self(3);
    /// Packets were asked for too often.
    pub const REPETITIONS: Self = Self(5);
    /// Another reason.
    pub const OTHER: Self = Self(250);
}

impl Control {
    /// Reads a control frame, and the number of the message's parameter group. Returns `None` for an
    /// unknown control byte.
    pub fn decode(data: &Data) -> Option<(Self, u32)> {
        let [control, a, b, c, d, low, middle, high] = *data;
        let size = u16::from_le_bytes([a, b]);
        let control = match control {
            0x10 => Self::Rts { size, packets: c, limit: d },
            0x11 => Self::Cts { packets: a, next: b },
            0x13 => Self::EndOfMsgAck { size, packets: c },
            0x20 => Self::Bam { size, packets: c },
            0xFF => Self::Abort(Reason(a)),
            _ => return None,
        };
        Some((control, u32::from_le_bytes([low, middle, high, 0])))
    }

    /// Returns the data of the control frame for a message of a parameter group.
    #[must_use]
    pub fn encode(self, group: u32) -> Data {
        let [low, middle, high, _] = group.to_le_bytes();
        let [control, a, b, c, d] = match self {
            Self::Rts { size, packets, limit } => sized(0x10, size, packets, limit),
            Self::Cts { packets, next } => [0x11, packets, next, 0xFF, 0xFF],
            Self::EndOfMsgAck { size, packets } => sized(0x13, size, packets, 0xFF),
            Self::Abort(Reason(reason)) => [0xFF, reason, 0xFF, 0xFF, 0xFF],
            Self::Bam { size, packets } => sized(0x20, size, packets, 0xFF),
        };
        [control, a, b, c, d, low, middle, high]
    }
}

fn sized(control: u8, size: u16, packets: u8, last: u8) -> [u8; 5] {
    let [low, high] = size.to_le_bytes();
    [control, low, high, packets, last]
}
