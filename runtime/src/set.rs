//! Sets: replies of several frames, each with one member.

use crate::address::AddressType;
use crate::{Bits, Exchange, Frame, Place, Protocol};

/// The field that says whether more frames of a set follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Continuation {
    field: Field,
    raw: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Field {
    Identifier(Bits),
    Data(Place),
}

impl Continuation {
    /// Returns a field of the identifier, and its value if more frames follow.
    pub const fn identifier(bits: Bits, raw: u64) -> Self {
        Self { field: Field::Identifier(bits), raw }
    }

    /// Returns a field of the data, and its value if more frames follow.
    pub const fn data(place: Place, raw: u64) -> Self {
        Self { field: Field::Data(place), raw }
    }

    /// Tests whether a frame says that more follow. Otherwise it is the last.
    pub fn is_in(&self, frame: &Frame) -> bool {
        let raw = match self.field {
            Field::Identifier(bits) => bits.of(frame.raw_id()).into(),
            Field::Data(place) => place.get(&frame.bytes()),
        };
        raw == self.raw
    }

    /// Returns the frame that says that more follow.
    pub(crate) fn put(&self, frame: &Frame) -> Frame {
        match self.field {
            Field::Identifier(bits) => frame.with_id(bits.put(frame.raw_id().into(), self.raw)),
            Field::Data(place) => {
                let mut data = frame.bytes();
                place.put(&mut data, self.raw);
                frame.with_data(data)
            }
        }
    }
}

/// What a set consists of. Generated code implements it, and an
/// [`Assembler`](crate::assembler::Assembler) needs it.
pub trait FrameSet: Copy + Default + 'static {
    /// The messages of the protocol.
    type Protocol: Protocol;
    /// How the set travels. Every frame of the set shows what its reply shows.
    const EXCHANGE: &'static Exchange;
    /// The kind of address that shows who sends a reply.
    const NODE: &'static AddressType;
    /// The field that says whether more frames follow.
    const CONTINUATION: Continuation;
    /// Names of at most 64 members, in the order of their frames.
    const MEMBERS: &'static [&'static str];

    /// Returns which member a message is.
    fn position(message: &Self::Protocol) -> Option<usize>;

    /// Keeps the values of a member. Returns whether they were there already.
    fn put(&mut self, message: &Self::Protocol) -> bool;
}
