//! Data bytes while they are written.

use crate::{Data, Exchange};

/// The data bytes of a message while they are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload {
    owner: Owner,
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
        Self::owned(Owner::Message(message), data)
    }

    /// Returns the bytes of the message that travels by an exchange, as [`new`](Self::new) does.
    #[inline(always)]
    pub(crate) const fn of(exchange: &'static Exchange, data: Data) -> Self {
        Self::owned(Owner::Exchange(exchange), data)
    }

    #[inline(always)]
    const fn owned(owner: Owner, data: Data) -> Self {
        Self { owner, data, keeps_limits: false, model: None, length: None, received: 0 }
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
        self.owner.name()
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

/// What has the name of a message. It is read only for an error.
#[derive(Clone, Copy, Debug)]
enum Owner {
    Message(&'static str),
    Exchange(&'static Exchange),
}

impl Owner {
    #[inline(always)]
    const fn name(self) -> &'static str {
        match self {
            Self::Message(name) => name,
            Self::Exchange(exchange) => exchange.message(),
        }
    }
}

impl PartialEq for Owner {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Owner {}
