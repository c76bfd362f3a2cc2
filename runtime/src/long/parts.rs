//! Long messages whose frames carry numbered parts.
//!
//! An [`Assembler`] puts the parts together, for many nodes at a time and without allocation. It is
//! given every frame of the bus. A message is one of [`Outcome`]: whole, or incomplete with what is
//! missing. Parts of two nodes are never mixed.
//!
//! A node sends the parts of a message in their order. Another message begins with a part whose
//! number is not greater than that of the part before, or which has another counter. After a request
//! that carries no part, the next part of the node begins one, too. A frame that is repeated at once
//! counts once. What goes to a node is never mixed with what comes from it.
//!
//! Where a message ends by silence, the document says how long that is, whatever the patience of the
//! assembler. Then [`timed_out`](Assembler::timed_out) gives whole messages.
//!
//! Time is a number of milliseconds from any start, and may wrap around. Call
//! [`timed_out`](Assembler::timed_out) at least once in 24 days, or it may miss a silent node.

mod assembler;
mod peers;
mod sender;

use core::fmt;

use super::buffer::Buffer;
use super::{LongLayout, has_size};
use crate::plumbing::Continuation;
use crate::{Exchange, Frame, IdentifierFields, Kind, Layout, Place, Protocol};

pub use super::buffer::Memory;
pub use assembler::{Assembler, Outcomes};
pub use sender::Frames;

#[cfg(test)]
mod tests;

/// How frames carry a long message in numbered parts. Generated code implements it, and an
/// [`Assembler`] needs it.
pub trait Parted: LongLayout {
    /// The messages of the protocol.
    type Protocol: Protocol;
    /// What a frame carries.
    type Part: Layout;
    /// Memory for all parts.
    type Memory: Memory;
    /// Where a frame has the number of its part.
    const NUMBER: Place;
    /// Where a frame has the data of its part: whole bytes, the first one highest.
    const DATA: Place;
    /// Where a frame has the number that all parts of a message share, if there is one. The next
    /// message has another one.
    const COUNTER: Option<Place> = None;
    /// Where the first part says how many data bytes there are, if it does. These are whole bytes at
    /// the front of its data, and do not count.
    const LENGTH: Option<Place> = None;
    /// The numbers of data bytes that the message can have, if the spec lists them.
    const SIZES: &'static [usize] = &[];
    /// How many milliseconds of silence behind a part end a message, if it ends so.
    const SILENCE: Option<u32> = None;
    /// Number of the first part, if it is the same on every device model.
    const FIRST: Option<u16>;
    /// Numbers of the first part by device model, if they differ.
    const MODEL_FIRSTS: &'static [(u8, u16)] = &[];
    /// The field that says whether more parts follow, if there is one.
    const CONTINUATION: Option<Continuation> = None;
    /// How the message travels to a module, and what its frames are for.
    const TO_MODULE: &'static [(&'static Exchange, Kind)] = &[];

    /// Returns what a frame says about such a message.
    const SAID: fn(&Self::Protocol) -> Said;

    /// Returns the frames that carry the message in parts. Each is like `blank`, a frame of the
    /// message: received, or made by [`Filter::frame`](crate::Filter::frame).
    ///
    /// All but the last say that more follow, if the protocol has a field for that. Where messages
    /// have a counter, it is that of `blank`; [`with_counter`](Frames::with_counter) sets another.
    ///
    /// # Errors
    ///
    /// The same as [`encode`](LongLayout::encode). In frames to a module it also refuses values outside
    /// their limits. It refuses a message whose first part has another number on each device model;
    /// [`frames_for`](Self::frames_for) builds that.
    fn frames(&self, blank: &Frame) -> Result<Frames<Self>, crate::Error> {
        Frames::new(self, blank, None)
    }

    /// Returns the frames that carry the message in parts, as a device model numbers them. Values have
    /// the scales and the limits of that model.
    ///
    /// # Errors
    ///
    /// The same as [`frames`](Self::frames). It also refuses a model without such a message.
    fn frames_for(&self, model: impl Into<u8>, blank: &Frame) -> Result<Frames<Self>, crate::Error> {
        Frames::new(self, blank, Some(model.into()))
    }

    /// Returns the parts as frames carry them.
    ///
    /// # Errors
    ///
    /// The same as [`encode`](LongLayout::encode). If the message can go to a module, it also refuses
    /// values outside their limits. It refuses a message whose first part has another number on each
    /// device model.
    fn parts(&self) -> Result<impl Iterator<Item = Self::Part>, crate::Error> {
        Ok(Frames::anywhere(self)?.map(|frame| Self::Part::decode(&frame.bytes())))
    }
}

/// What a frame says about a long message in parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Said {
    /// A part of it.
    Part,
    /// How many elements its arrays have, at this place of the data.
    Count(Place),
    /// Nothing.
    Nothing,
}

/// What became of a message.
#[derive(Clone, Copy, Debug)]
pub enum Outcome<L: Parted> {
    /// It came whole.
    Whole(Whole<L>),
    /// Something of it did not come.
    Incomplete(Incomplete<L>),
    /// A message begins, and there is no room for it. Nothing of this frame is kept.
    Full(Frame),
}

/// A message that came whole.
#[derive(Clone, Copy)]
pub struct Whole<L: Parted> {
    /// The values.
    pub values: L,
    /// Whether it is known how many elements the arrays have that vary in length. The node tells it,
    /// marks the last part, or is silent behind it. Otherwise all elements are there that the parts
    /// have room for.
    pub is_counted: bool,
    frame: Frame,
    is_to_module: bool,
}

/// A message that did not come whole.
#[derive(Clone, Copy)]
pub struct Incomplete<L: Parted> {
    buffer: Buffer<L::Memory>,
    first: u16,
    expected: usize,
    frame: Frame,
    is_to_module: bool,
}

impl<L: Parted> Whole<L> {
    /// Returns the identifier of the last frame. It shows who sends the message.
    pub fn identifier(&self) -> <L::Protocol as Protocol>::Identifier {
        IdentifierFields::FROM_RAW(self.frame.raw_id())
    }

    /// Returns the last frame.
    pub const fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Tests whether it goes to a module.
    pub const fn is_to_module(&self) -> bool {
        self.is_to_module
    }
}

impl<L: Parted> Incomplete<L> {
    /// Returns the identifier of the last frame. It shows who sends the message.
    pub fn identifier(&self) -> <L::Protocol as Protocol>::Identifier {
        IdentifierFields::FROM_RAW(self.frame.raw_id())
    }

    /// Returns the last frame.
    pub const fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Tests whether it goes to a module.
    pub const fn is_to_module(&self) -> bool {
        self.is_to_module
    }

    /// Returns the numbers of the parts that did not come, as far as it is known how many there are.
    ///
    /// There are none if the node marks a part as the last one before the message has all its
    /// fields. There are none, either, if it [announces](Self::announced) a length that the message
    /// never has.
    pub fn missing(&self) -> impl Iterator<Item = u16> {
        let first = usize::from(self.first);
        self.buffer.missing(self.expected).filter_map(move |index| u16::try_from(first.checked_add(index)?).ok())
    }

    /// Returns how many data bytes the first part announces, if it came and says that.
    pub fn announced(&self) -> Option<usize> {
        announced::<L>(&self.buffer)
    }

    /// Returns the data of a part that came, by its number. Those of the first part begin with the
    /// length, if it has one.
    pub fn part(&self, number: u16) -> Option<&[u8]> {
        self.buffer.get(number.checked_sub(self.first)?.into())
    }

    /// Returns the joined data up to the last part that came, without a length before them. Those of
    /// missing parts are 0.
    pub fn data(&self) -> &[u8] {
        data::<L>(&self.buffer)
    }
}

impl<L: Parted + fmt::Debug> fmt::Debug for Whole<L> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { values, is_counted, .. } = self;
        formatter
            .debug_struct("Whole")
            .field("identifier", &self.identifier())
            .field("values", values)
            .field("is_counted", is_counted)
            .finish()
    }
}

impl<L: Parted> fmt::Debug for Incomplete<L> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Incomplete")
            .field("identifier", &self.identifier())
            .field("data", &self.data())
            .finish_non_exhaustive()
    }
}

/// Returns the number of data bytes in a part, at least one.
fn size<L: Parted>() -> usize {
    usize::from(L::DATA.width() / 8).max(1)
}

/// Returns how many bytes before the data say how many there are.
fn head<L: Parted>() -> usize {
    L::LENGTH.map_or(0, |place| usize::from(place.width() / 8))
}

/// Returns how many parts carry some number of bytes.
fn parts_of<L: Parted>(bytes: usize) -> usize {
    bytes.saturating_add(head::<L>()).div_ceil(size::<L>()).max(1)
}

/// Returns how many data bytes the first part announces, if it came and says that.
fn announced<L: Parted>(buffer: &Buffer<L::Memory>) -> Option<usize> {
    let (place, mut frame) = (L::LENGTH?, [0; 8]);
    L::DATA.put(&mut frame, word(buffer.get(0)?.iter().copied()));
    Some(usize::try_from(place.get(&frame)).unwrap_or(usize::MAX))
}

/// Tests whether a message can have the number of data bytes that its first part announces.
fn has_length<L: Parted>(length: usize) -> bool {
    if L::SIZES.is_empty() { has_size::<L>(0, length) } else { L::SIZES.contains(&length) }
}

/// Returns the data up to the last part that came, without a length before them.
fn data<L: Parted>(buffer: &Buffer<L::Memory>) -> &[u8] {
    buffer.data().get(head::<L>()..).unwrap_or_default()
}

/// Returns the number that some bytes make, the first one highest.
fn word(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0, |word, byte| word << 8 | u64::from(byte))
}

/// Returns the number of the first part, if that is known of the device model.
fn first<L: Parted>(model: Option<u8>) -> Option<u16> {
    let own = L::MODEL_FIRSTS.iter().find(|(known, _)| Some(*known) == model);
    own.map(|(_, first)| *first).or(L::FIRST)
}
