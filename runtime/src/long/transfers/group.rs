//! Numbers of groups, and the frames that show them.

use super::{Grouped, is_to_module, put};
use crate::tp::{ALL, Link};
use crate::{Bits, Data, Exchange, Filter, Frame, Kind, Protocol};

/// The byte of a group's number that is the address of a receiver, if the group has one.
const RECEIVER: u32 = 0xFF;

/// Tests whether the last byte of a group's number is the place of a receiver.
fn has_receiver(group: u32) -> bool {
    group >> 8 & 0xFF < 0xF0
}

/// Returns the number of the group that an identifier shows. The address of a receiver is no part of it.
pub fn group_of<T: Grouped>(id: u32) -> u32 {
    let group = T::GROUP.iter().fold(0, |group: u32, bits| group.wrapping_shl(bits.width().into()) | bits.of(id));
    if has_receiver(group) { group & !RECEIVER } else { group }
}

/// Returns an identifier with the number of another group. The receiver stays, if the identifier has room for it.
pub fn with_group<T: Grouped>(id: u32, group: u32) -> u32 {
    let group = if has_receiver(group) { group & !RECEIVER | T::TARGET.of(id) } else { group };
    let put = |(id, group): (u32, u32), bits: &Bits| (put(id, *bits, group), group.wrapping_shr(bits.width().into()));
    T::GROUP.iter().rev().fold((id, group), put).0
}

/// Returns who sends a frame, and to whom. A group without a place for the receiver goes to all.
pub fn link<T: Grouped>(id: u32) -> Link {
    let byte = |bits: Bits| u8::try_from(bits.of(id)).unwrap_or(ALL);
    let target = if has_receiver(group_of::<T>(id)) { byte(T::TARGET) } else { ALL };
    Link { source: byte(T::SOURCE), target }
}

/// Returns a frame of the transport, with what `id` shows elsewhere.
pub fn frame<T: Grouped>(id: u32, group: u32, link: Link, data: Data) -> Frame {
    let id = put(put(id, T::SOURCE, link.source.into()), T::TARGET, link.target.into());
    let id = T::SENDS.iter().fold(with_group::<T>(id, group), |id, (bits, value)| put(id, *bits, *value));
    Frame::new_raw(id, T::Protocol::FRAME.is_extended(), data, 8)
}

/// A message of a group: how it travels, what for, and the identifier that it would have as one frame.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    pub exchange: &'static Exchange,
    pub kind: Kind,
    pub id: u32,
}

impl Carried {
    /// Finds the message of a group whose packets have such an identifier.
    pub fn find<T: Grouped>(id: u32, group: u32) -> Option<Self> {
        let (shown, is_to_module) = (with_group::<T>(id, group), is_to_module::<T>(id));
        T::CARRIES.iter().find_map(|(exchange, kind)| {
            let filter = exchange.filter(*kind)?;
            let is_sent = exchange.is_to_module::<T::Protocol>(*kind) == is_to_module && filter.matches_id(shown);
            is_sent.then(|| Self { exchange, kind: *kind, id: as_one_frame::<T>(&filter, shown) })
        })
    }
}

/// Returns the identifier that a message would have as one frame between the nodes that `shown` shows.
fn as_one_frame<T: Grouped>(filter: &Filter, shown: u32) -> u32 {
    let id = put(filter.sent_id(), T::SOURCE, T::SOURCE.of(shown));
    T::GROUP.iter().fold(id, |id, bits| put(id, *bits, bits.of(shown)))
}
