//! Frames as a driver has them.

use embedded_can::{ExtendedId, Id, StandardId};

/// Linux marks identifiers of 29 bits and remote frames so.
const EXTENDED: u32 = 1 << 31;
const REMOTE: u32 = 1 << 30;

/// A frame of at most eight bytes, whose type stands in the identifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Frame {
    id: u32,
    length: u8,
    data: [u8; 8],
}

impl Frame {
    /// Returns a frame of eight bytes with the low 29 bits of an identifier.
    #[inline]
    pub fn of(id: u32, data: [u8; 8]) -> Self {
        Self { id: id & 0x1FFF_FFFF | EXTENDED, length: 8, data }
    }

    /// Returns identifier and data of any frame.
    pub fn copy(frame: &impl embedded_can::Frame) -> Option<Self> {
        embedded_can::Frame::new(frame.id(), frame.data())
    }

    /// Returns the low bits of the identifier.
    #[inline]
    pub fn raw_id(&self) -> u32 {
        self.id & 0x1FFF_FFFF
    }

    /// Returns eight bytes; those beyond the length are 0.
    #[inline]
    pub fn bytes(&self) -> [u8; 8] {
        self.data
    }
}

impl embedded_can::Frame for Frame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        let id = raw(id.into());
        let length = u8::try_from(data.len()).ok().filter(|length| *length <= 8)?;
        let mut bytes = [0; 8];
        bytes[..data.len()].copy_from_slice(data);
        Some(Self { id, length, data: bytes })
    }

    fn new_remote(id: impl Into<Id>, length: usize) -> Option<Self> {
        let length = u8::try_from(length).ok().filter(|length| *length <= 8)?;
        Some(Self { id: raw(id.into()) | REMOTE, length, data: [0; 8] })
    }

    #[inline]
    fn is_extended(&self) -> bool {
        self.id & EXTENDED != 0
    }

    #[inline]
    fn is_remote_frame(&self) -> bool {
        self.id & REMOTE != 0
    }

    #[inline]
    fn id(&self) -> Id {
        if self.is_extended() {
            Id::Extended(ExtendedId::new(self.id & 0x1FFF_FFFF).unwrap_or(ExtendedId::ZERO))
        } else {
            Id::Standard(u16::try_from(self.id & 0x7FF).ok().and_then(StandardId::new).unwrap_or(StandardId::ZERO))
        }
    }

    #[inline]
    fn dlc(&self) -> usize {
        self.length.into()
    }

    #[inline]
    fn data(&self) -> &[u8] {
        if self.is_remote_frame() { &[] } else { self.data.get(..self.length.into()).unwrap_or(&self.data) }
    }
}

fn raw(id: Id) -> u32 {
    match id {
        Id::Standard(id) => id.as_raw().into(),
        Id::Extended(id) => id.as_raw() | EXTENDED,
    }
}
