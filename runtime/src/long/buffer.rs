//! The bytes of a long message that came, and what is missing.

use core::fmt::Debug;

/// Memory for the data of a long message: an array of bytes.
pub trait Memory: Copy + Debug + AsRef<[u8]> + AsMut<[u8]> + 'static {
    /// Bytes that are all 0.
    const BLANK: Self;
}

impl<const N: usize> Memory for [u8; N] {
    const BLANK: Self = [0; N];
}

/// Returns how many bytes of memory some chunks need: their data, and a bit for each.
pub const fn room(chunks: usize, size: usize) -> usize {
    chunks.saturating_mul(size).saturating_add(chunks.div_ceil(8))
}

/// Data that come in chunks of equal size.
///
/// The chunks stand at the front of the memory. A bit for each that came stands at its end, the
/// first one in the last byte.
#[derive(Clone, Copy, Debug)]
pub struct Buffer<M> {
    memory: M,
    size: usize,
    end: usize,
}

impl<M: Memory> Buffer<M> {
    /// Returns a buffer for chunks of `size` bytes, at least one.
    pub const fn new(size: usize) -> Self {
        Self { memory: M::BLANK, size, end: 0 }
    }

    /// Keeps a chunk by its number from 0, if there is room for it and it has the right size.
    /// Returns whether it is kept.
    pub fn put(&mut self, index: usize, chunk: &[u8]) -> bool {
        let Some((start, end)) = self.places(index) else { return false };
        let Some(place) = self.memory.as_mut().get_mut(start..end).filter(|place| place.len() == chunk.len()) else {
            return false;
        };
        place.iter_mut().zip(chunk).for_each(|(place, byte)| *place = *byte);
        if let Some(marks) = self.memory.as_mut().iter_mut().rev().nth(index / 8) {
            *marks |= 1 << (index % 8);
        }
        self.end = self.end.max(index.saturating_add(1));
        true
    }

    /// Returns a chunk that came.
    pub fn get(&self, index: usize) -> Option<&[u8]> {
        let (start, end) = self.places(index).filter(|_| self.has(index))?;
        self.memory.as_ref().get(start..end)
    }

    /// Tests whether a chunk came.
    pub fn has(&self, index: usize) -> bool {
        let marks = self.memory.as_ref().iter().rev().nth(index / 8);
        index < self.end && marks.is_some_and(|marks| marks & 1 << (index % 8) != 0)
    }

    /// Returns how many chunks there are up to the last one that came.
    pub const fn end(&self) -> usize {
        self.end
    }

    /// Returns the data up to the end of the last chunk that came. Those of missing chunks are 0.
    pub fn data(&self) -> &[u8] {
        self.memory.as_ref().get(..self.end.saturating_mul(self.size)).unwrap_or_default()
    }

    /// Returns the numbers of the chunks that did not come, of the first `expected`.
    pub fn missing(&self, expected: usize) -> impl Iterator<Item = usize> {
        (0..expected).filter(|index| !self.has(*index))
    }

    /// Returns where a chunk stands, if there is room for it and all before it.
    fn places(&self, index: usize) -> Option<(usize, usize)> {
        let count = index.checked_add(1).filter(|count| room(*count, self.size) <= self.memory.as_ref().len())?;
        let (start, end) = (index.checked_mul(self.size)?, count.checked_mul(self.size)?);
        Some((start, end))
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;

    #[test]
    fn what_came_is_kept_and_what_did_not_is_known() {
        let mut buffer = Buffer::<[u8; room(10, 2)]>::new(2);
        assert_eq!((buffer.end(), buffer.data().len(), buffer.missing(2).collect::<Vec<_>>()), (0, 0, [0, 1].into()));
        assert!(buffer.put(9, &[19, 20]));
        assert_eq!(buffer.missing(buffer.end()).count(), 9);
        assert!(buffer.put(1, &[3, 4]));
        assert_eq!(buffer.data(), [&[0, 0, 3, 4][..], &[0; 14], &[19, 20]].concat());
        assert_eq!(buffer.missing(buffer.end()).collect::<Vec<_>>(), [0, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!([0, 1, 9, 10].map(|index| buffer.get(index)), [None, Some(&[3, 4][..]), Some(&[19, 20]), None]);
    }

    #[test]
    fn there_is_room_for_each_chunk_and_for_no_further_one() {
        let mut buffer = Buffer::<[u8; room(17, 7)]>::new(7);
        for index in 0..17_u8 {
            assert!(buffer.put(index.into(), &[0xFF; 7]), "{index}");
            assert_eq!(buffer.missing(17).count(), 16 - usize::from(index));
        }
        assert_eq!(buffer.data(), [0xFF; 119]);
        assert!(![17, usize::MAX].into_iter().any(|index| buffer.put(index, &[1; 7])));
        assert!(!buffer.put(3, &[1; 6]), "another size");
        assert_eq!(buffer.data(), [0xFF; 119]);
    }
}
