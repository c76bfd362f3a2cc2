//! Data bytes while they are written.

use crate::Data;

/// The data bytes of a message while they are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Payload {
    message: &'static str,
    data: Data,
    keeps_limits: bool,
    model: Option<u8>,
    length: Option<u8>,
    received: u8,
}

impl Payload {
    /// Returns the bytes of a message that takes all values that fit its signals, as in a reply.
    #[inline(always)]
    pub const fn new(message: &'static str, data: Data) -> Self {
        Self { message, data, keeps_limits: false, model: None, length: None, received: 0 }
    }

    /// Returns the bytes of a message that only takes values within their documented limits, as in a request.
    #[inline(always)]
    pub const fn within_limits(message: &'static str, data: Data) -> Self {
        Self::new(message, data).keeping_limits()
    }

    /// Returns the same bytes of a message that only takes values within their documented limits.
    #[must_use]
    #[inline(always)]
    pub(crate) const fn keeping_limits(self) -> Self {
        Self { keeps_limits: true, ..self }
    }

    /// Returns the same bytes for a device model, by its number. The model's limits then replace
    /// the general ones.
    #[must_use]
    #[inline(always)]
    pub const fn for_model(self, model: Option<u8>) -> Self {
        Self { model, ..self }
    }

    /// Says how many data bytes the frame had from which the bytes are.
    #[must_use]
    #[inline(always)]
    pub(crate) const fn received_with(self, received: u8) -> Self {
        Self { received, ..self }
    }

    /// Tests whether the bytes are from a frame with at least `length` data bytes.
    #[inline(always)]
    pub const fn had(&self, length: u8) -> bool {
        self.received >= length
    }

    /// Sets the number of data bytes, of a message that can have several.
    #[inline(always)]
    pub const fn end_after(&mut self, length: u8) {
        self.length = Some(length);
    }

    /// Returns the number of data bytes, if the message can have several.
    #[inline(always)]
    pub(crate) const fn length(&self) -> Option<u8> {
        self.length
    }

    /// Returns the bytes written so far.
    #[inline(always)]
    pub const fn data(&self) -> &Data {
        &self.data
    }

    /// Returns the name of the message.
    #[inline(always)]
    pub const fn message(&self) -> &'static str {
        self.message
    }

    #[inline(always)]
    pub(crate) const fn keeps_limits(&self) -> bool {
        self.keeps_limits
    }

    #[inline(always)]
    pub(crate) const fn model(&self) -> Option<u8> {
        self.model
    }

    #[inline(always)]
    pub(crate) const fn replace(&mut self, data: Data) {
        self.data = data;
    }
}
