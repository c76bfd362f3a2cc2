//! What a frame says: the protocol data units.

use crate::Data;

/// The greatest number of data bytes in a single frame.
pub const SINGLE: usize = 7;

/// Data bytes in a first frame.
pub const FIRST: usize = 6;

/// Data bytes in a consecutive frame.
pub const CONSECUTIVE: usize = 7;

/// The greatest number of data bytes of a message.
pub const LONGEST: usize = 0xFFF;

/// What a frame says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Pdu<'a> {
    /// A whole message.
    Single(&'a [u8]),
    /// The beginning of a message.
    First {
        /// Data bytes of the message.
        size: u32,
        /// The first six of them; two if there are more than 4,095.
        data: &'a [u8],
    },
    /// The next bytes of a message.
    Consecutive {
        /// The low four bits of the frame's number. The first frame has number 0.
        number: u8,
        /// Up to seven data bytes, and what fills the last frame up.
        data: &'a [u8],
    },
    /// An answer of the receiver.
    Flow(Flow),
}

/// A flow control, by which the receiver answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Flow {
    /// The sender may go on.
    Continue {
        /// How many frames may come before the next flow control; 0 means all.
        block: u8,
        /// The least time between them.
        separation: Separation,
    },
    /// The sender is to wait for another flow control.
    Wait,
    /// The receiver has no room for the message.
    Overflow,
    /// A status that the standard reserves.
    Reserved(u8),
}

/// The least time between two consecutive frames, as its code: `STmin` of the standard.
///
/// 0 to 127 are milliseconds. `0xF1` to `0xF9` are 100 to 900 microseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Separation(pub u8);

impl Separation {
    /// Returns the time in microseconds. A reserved code means the longest time.
    pub const fn micros(self) -> u32 {
        match self.0 {
            code @ 0..=0x7F => code as u32 * 1000,
            code @ 0xF1..=0xF9 => (code & 0xF) as u32 * 100,
            _ => 127_000,
        }
    }
}

/// The data bytes of a frame that is to be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Packet {
    bytes: Data,
    length: usize,
}

impl Packet {
    /// Puts a frame together, and fills it up if there is a byte for that.
    fn new(head: &[u8], data: &[u8], padding: Option<u8>) -> Self {
        let mut bytes = [padding.unwrap_or_default(); 8];
        bytes.iter_mut().zip(head.iter().chain(data)).for_each(|(place, byte)| *place = *byte);
        let length = if padding.is_some() { bytes.len() } else { head.len().saturating_add(data.len()) };
        Self { bytes, length }
    }

    /// Returns the data bytes, at most eight.
    pub fn data(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or(&self.bytes)
    }
}

impl<'a> Pdu<'a> {
    /// Reads the data bytes of a frame. Returns `None` for what a receiver has to ignore. That is an
    /// unknown kind, a size that travels by another kind, or a frame that ends too early. A frame
    /// of CAN FD is ignored, too.
    pub fn decode(data: &'a [u8]) -> Option<Self> {
        let ([first, rest @ ..], ..=8) = (data, data.len()) else { return None };
        let low = first & 0xF;
        match first >> 4 {
            0 if low != 0 => rest.get(..low.into()).map(Self::Single),
            1 => Self::first(low, rest.first_chunk()?),
            2 => Some(Self::Consecutive { number: low, data: rest }),
            3 => Flow::decode(low, rest).map(Self::Flow),
            _ => None,
        }
    }

    fn first(high: u8, [low, data @ ..]: &'a [u8; 7]) -> Option<Self> {
        let size = u32::from_be_bytes([0, 0, high, *low]);
        if size > 0 {
            return (size > 7).then_some(Self::First { size, data });
        }
        // More than twelve bits of size stand in four bytes of their own.
        let (size, data) = data.split_first_chunk()?;
        let size = u32::from_be_bytes(*size);
        (size > 0xFFF).then_some(Self::First { size, data })
    }

    /// Returns the data bytes of a frame, filled up if there is a byte for that.
    pub(super) fn encode(self, padding: Option<u8>) -> Packet {
        match self {
            Self::Single(data) => Packet::new(&[u8::try_from(data.len()).unwrap_or_default()], data, padding),
            Self::First { size, data } => {
                let [low, high, ..] = size.to_le_bytes();
                Packet::new(&[0x10 | high & 0xF, low], data, padding)
            }
            Self::Consecutive { number, data } => Packet::new(&[0x20 | number & 0xF], data, padding),
            Self::Flow(flow) => flow.encode(padding),
        }
    }
}

impl Flow {
    fn decode(status: u8, rest: &[u8]) -> Option<Self> {
        let [block, separation, ..] = *rest else { return None };
        Some(match status {
            0 => Self::Continue { block, separation: Separation(separation) },
            1 => Self::Wait,
            2 => Self::Overflow,
            _ => Self::Reserved(status),
        })
    }

    /// Returns the data bytes of its frame, filled up if there is a byte for that.
    ///
    /// An assembler makes its own answers, and asks nobody to wait. A receiver that needs time sends
    /// [`Wait`](Self::Wait) in place of the answer, and gives it to the assembler too. Then the
    /// assembler waits longer. The answer follows when the receiver is ready.
    pub fn encode(self, padding: Option<u8>) -> Packet {
        let head = match self {
            Self::Continue { block, separation } => [0x30, block, separation.0],
            Self::Wait => [0x31, 0, 0],
            Self::Overflow => [0x32, 0, 0],
            Self::Reserved(status) => [0x30 | status & 0xF, 0, 0],
        };
        Packet::new(&head, &[], padding)
    }
}
