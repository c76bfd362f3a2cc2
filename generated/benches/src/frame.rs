//! Frames as a driver has them.

use embedded_can::{ExtendedId, Id};

/// A data frame with a 29-bit identifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Frame {
    id: ExtendedId,
    length: u8,
    data: [u8; 8],
}

impl Frame {
    /// Returns a frame of eight bytes, unless the identifier has more than 29 bits.
    pub fn of(id: u32, data: [u8; 8]) -> Option<Self> {
        ExtendedId::new(id).map(|id| Self { id, length: 8, data })
    }

    /// Returns identifier and data of any frame.
    pub fn copy(frame: &impl embedded_can::Frame) -> Option<Self> {
        embedded_can::Frame::new(frame.id(), frame.data())
    }
}

impl embedded_can::Frame for Frame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        let Id::Extended(id) = id.into() else { return None };
        let length = u8::try_from(data.len()).ok().filter(|length| *length <= 8)?;
        let mut bytes = [0; 8];
        bytes[..data.len()].copy_from_slice(data);
        Some(Self { id, length, data: bytes })
    }

    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }

    #[inline]
    fn is_extended(&self) -> bool {
        true
    }

    #[inline]
    fn is_remote_frame(&self) -> bool {
        false
    }

    #[inline]
    fn id(&self) -> Id {
        Id::Extended(self.id)
    }

    #[inline]
    fn dlc(&self) -> usize {
        self.length.into()
    }

    #[inline]
    fn data(&self) -> &[u8] {
        self.data.get(..self.length.into()).unwrap_or(&self.data)
    }
}
