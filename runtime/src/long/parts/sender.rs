//! The frames that carry a long message in parts.

use core::fmt;

use super::{Memory, Parted, first, head, parts_of, size, word};
use crate::{Error, Frame};

/// The frames that carry a long message in parts, in their order.
#[derive(Clone)]
pub struct Frames<L: Parted> {
    data: L::Memory,
    blank: Frame,
    length: usize,
    first: u16,
    next: usize,
    count: usize,
}

impl<L: Parted> Frames<L> {
    pub(super) fn new(values: &L, blank: &Frame, model: Option<u8>) -> Result<Self, Error> {
        let Some(first) = first::<L>(model) else { return Err(Error::Model { message: L::MESSAGE }) };
        let mut data = L::Memory::BLANK;
        let length = values.encode(data.as_mut())?.len();
        Ok(Self { data, blank: *blank, length, first, next: 0, count: parts_of::<L>(length) })
    }

    /// Gives the frames another counter than that of the blank frame, if the message has one. Bits
    /// that it cannot hold are dropped, so a number may count on and on.
    #[must_use]
    pub fn with_counter(mut self, counter: u8) -> Self {
        if let Some(place) = L::COUNTER {
            let mut data = self.blank.bytes();
            place.put(&mut data, u64::from(counter) & place.max());
            self.blank = self.blank.with_data(data);
        }
        self
    }

    /// Returns the frame with a part.
    fn frame(&self, index: usize) -> Option<Frame> {
        let start = index.checked_mul(size::<L>())?;
        let places = (start..).take(size::<L>()).map(|place| place.checked_sub(head::<L>()));
        let byte = |place: Option<usize>| place.and_then(|place| self.data.as_ref().get(place)).copied();
        let mut data = self.blank.bytes();
        L::NUMBER.put(&mut data, u64::try_from(usize::from(self.first).checked_add(index)?).ok()?);
        L::DATA.put(&mut data, word(places.map(|place| byte(place).unwrap_or_default())));
        if let (Some(place), 0) = (L::LENGTH, index) {
            place.put(&mut data, u64::try_from(self.length).ok()?);
        }
        let frame = self.blank.with_data(data);
        let is_last = index.checked_add(1) == Some(self.count);
        Some(L::CONTINUATION.filter(|_| !is_last).map_or(frame, |continuation| continuation.put(&frame)))
    }
}

impl<L: Parted> Iterator for Frames<L> {
    type Item = Frame;

    fn next(&mut self) -> Option<Frame> {
        let index = self.next;
        let frame = (index < self.count).then(|| self.frame(index)).flatten()?;
        self.next = index.saturating_add(1);
        Some(frame)
    }
}

impl<L: Parted> fmt::Debug for Frames<L> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(self.clone()).finish()
    }
}
