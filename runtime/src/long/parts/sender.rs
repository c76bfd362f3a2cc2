//! The frames that carry a long message in parts.

use core::fmt;

use super::{Memory, Parted, first, parts_of, size};
use crate::{Error, Frame};

/// The frames that carry a long message in parts, in their order.
#[derive(Clone)]
pub struct Frames<L: Parted> {
    data: L::Memory,
    blank: Frame,
    first: u16,
    next: usize,
    count: usize,
}

impl<L: Parted> Frames<L> {
    pub(super) fn new(values: &L, blank: &Frame, model: Option<u8>) -> Result<Self, Error> {
        let Some(first) = first::<L>(model) else { return Err(Error::Model { message: L::MESSAGE }) };
        let mut data = L::Memory::BLANK;
        let count = parts_of::<L>(values.encode(data.as_mut())?.len());
        Ok(Self { data, blank: *blank, first, next: 0, count })
    }

    /// Returns the frame with a part.
    fn frame(&self, index: usize) -> Option<Frame> {
        let start = index.checked_mul(size::<L>())?;
        let chunk = self.data.as_ref().get(start..)?.iter().take(size::<L>());
        let bits = chunk.fold(0, |bits, byte| bits << 8 | u64::from(*byte));
        let mut data = self.blank.bytes();
        L::NUMBER.put(&mut data, u64::try_from(usize::from(self.first).checked_add(index)?).ok()?);
        L::DATA.put(&mut data, bits);
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
