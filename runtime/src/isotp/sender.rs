//! Takes a message apart into frames.

use super::pdu::{CONSECUTIVE, FIRST, Flow, Packet, Pdu, SINGLE, Separation};
use super::{PADDING, SIZES};

/// Makes the frames of one message. As an iterator it gives those that may be sent now.
#[derive(Clone, Debug)]
pub struct Sender<'a> {
    /// What is not sent yet.
    rest: &'a [u8],
    padding: Option<u8>,
    /// The low four bits of the next frame's number.
    number: u8,
    state: State,
}

/// What comes next.
#[derive(Clone, Copy, Debug)]
enum State {
    /// The single frame, or the first one.
    Begin,
    /// A flow control.
    Waiting,
    /// Consecutive frames: a number of them until the next flow control, or all.
    Sending(Option<u8>),
    /// Nothing.
    Over,
}

/// What a frame of the receiver changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Frames may be sent, with at least a time between them.
    Allowed(Separation),
    /// The receiver asks to wait for its next flow control.
    Wait,
    /// The receiver has no room for the message, which comes to nothing.
    Overflow,
    /// The flow control has a reserved status. The message comes to nothing.
    Wrong,
    /// It is no flow control, or none was awaited.
    Other,
}

impl<'a> Sender<'a> {
    /// Returns the sender of a message, whose frames [`PADDING`] fills up. Returns `None` unless
    /// there are 1 to 4,095 bytes.
    pub fn new(data: &'a [u8]) -> Option<Self> {
        let is_size = SIZES.contains(&data.len());
        is_size.then_some(Self { rest: data, padding: Some(PADDING), number: 0, state: State::Begin })
    }

    /// Fills frames up to eight bytes with another byte, or not at all.
    #[must_use]
    pub const fn padded(self, padding: Option<u8>) -> Self {
        Self { padding, ..self }
    }

    /// Tests whether a flow control is awaited. If none comes in [`PATIENCE`](super::PATIENCE), the
    /// message comes to nothing.
    pub const fn is_waiting(&self) -> bool {
        matches!(self.state, State::Waiting)
    }

    /// Tests whether all data bytes are sent.
    pub const fn is_done(&self) -> bool {
        self.rest.is_empty()
    }

    /// Takes the data bytes of a frame of the receiver.
    pub fn control(&mut self, data: &[u8]) -> Answer {
        let Some(Pdu::Flow(flow)) = Pdu::decode(data).filter(|_| self.is_waiting()) else { return Answer::Other };
        let (state, answer) = match flow {
            Flow::Continue { block, separation } => {
                (State::Sending((block > 0).then_some(block)), Answer::Allowed(separation))
            }
            Flow::Wait => (State::Waiting, Answer::Wait),
            Flow::Overflow => (State::Over, Answer::Overflow),
            Flow::Reserved(_) => (State::Over, Answer::Wrong),
        };
        self.state = state;
        answer
    }

    fn begin(&mut self) -> Packet {
        let size = self.rest.len();
        if size <= SINGLE {
            self.state = State::Over;
            return Pdu::Single(self.cut(SINGLE)).encode(self.padding);
        }
        self.state = State::Waiting;
        let size = u32::try_from(size).unwrap_or_default();
        Pdu::First { size, data: self.cut(FIRST) }.encode(self.padding)
    }

    fn go_on(&mut self, left: Option<u8>) -> Packet {
        let number = self.number;
        let packet = Pdu::Consecutive { number, data: self.cut(CONSECUTIVE) }.encode(self.padding);
        self.state = match left {
            _ if self.rest.is_empty() => State::Over,
            Some(0 | 1) => State::Waiting,
            Some(left) => State::Sending(left.checked_sub(1)),
            None => State::Sending(None),
        };
        packet
    }

    /// Takes the next bytes away.
    fn cut(&mut self, size: usize) -> &'a [u8] {
        let (data, rest) = self.rest.split_at_checked(size).unwrap_or((self.rest, &[]));
        self.rest = rest;
        self.number = self.number.wrapping_add(1);
        data
    }
}

impl Iterator for Sender<'_> {
    type Item = Packet;

    fn next(&mut self) -> Option<Packet> {
        match self.state {
            State::Begin => Some(self.begin()),
            State::Sending(left) => Some(self.go_on(left)),
            State::Waiting | State::Over => None,
        }
    }
}
