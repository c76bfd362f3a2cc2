//! Data bytes while they are written.

use crate::physical::{Physical, Scaled};
use crate::raw::Raw;
use crate::{Data, Error, Exchange, Signal};

/// The data bytes of a message while they are written.
///
/// Each method that writes a value returns whether it is taken. Such answers can be joined by `&&`, which compiles faster
/// than a `?` after each value.
///
/// ```
/// use canspec_runtime::{Payload, Place, Signal};
///
/// const VOLTAGE: Signal<u16, f64> =
///     Signal::new("voltage", Place::bytes(0, 1)).unit("V").scale(1, 10).limits(0.0, 750.0);
/// const FAN: Signal<u8> = Signal::new("fan", Place::byte(2));
///
/// let mut payload = Payload::within_limits("set_output", [0; 8]);
/// let is_taken = payload.encode(&VOLTAGE, 500.0) && payload.put(&FAN, 3);
/// assert!(is_taken);
/// assert_eq!(payload.data(), &[0x13, 0x88, 3, 0, 0, 0, 0, 0]);
///
/// // The fan keeps its value, since the voltage before it is refused.
/// let is_taken = payload.encode(&VOLTAGE, 800.0) && payload.put(&FAN, 4);
/// assert!(!is_taken);
/// assert_eq!(payload.data(), &[0x13, 0x88, 3, 0, 0, 0, 0, 0]);
///
/// let error = payload.outcome().unwrap_err();
/// assert_eq!(error.to_string(), "`voltage` of `set_output` is 800 V, but its limits are 0 and 750 V");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload {
    owner: Owner,
    data: Data,
    keeps_limits: bool,
    model: Option<u8>,
    length: Option<u8>,
    /// How many data bytes the frame had from which the bytes are, if they are from one.
    received: Option<u8>,
    outcome: Result<(), Error>,
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
        Self { owner, data, keeps_limits: false, model: None, length: None, received: None, outcome: Ok(()) }
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
        Self { received: Some(received), ..self }
    }

    /// Tests whether the bytes are from a frame with at least `length` data bytes.
    #[inline(always)]
    pub const fn had(&self, length: u8) -> bool {
        matches!(self.received, Some(received) if received >= length)
    }

    /// Tests whether a frame of `length` data bytes is made although a signal at its end has no value. Only some device
    /// models have the signal.
    /// - A request to such a model is refused without it.
    /// - A frame that was received with it comes from a model that does not have it.
    #[inline(always)]
    pub fn reaches<R: Raw, F: Physical<R>>(&self, signal: &Signal<R, F>, length: u8) -> bool {
        match (signal.blank(self.model), self.received) {
            (None, None) => self.keeps_limits && self.model.is_some(),
            (Some(_), Some(received)) => received >= length,
            _ => false,
        }
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

    /// Writes a raw value as [`Signal::put`] does. Returns whether it is taken.
    #[must_use]
    #[inline(always)]
    pub fn put<R: Raw, F: Physical<R>>(&mut self, signal: &'static Signal<R, F>, raw: R) -> bool {
        let written = signal.put(raw, self);
        self.takes(written)
    }

    /// The same for a raw value that the frame can lack, as [`Signal::put_some`] writes it.
    #[must_use]
    #[inline(always)]
    pub fn put_some<R: Raw, F: Physical<R>>(&mut self, signal: &'static Signal<R, F>, raw: Option<R>) -> bool {
        let written = signal.put_some(raw, self);
        self.takes(written)
    }

    /// The same for the raw value of a part of a long message, as [`Signal::keep`] writes it.
    #[must_use]
    #[inline(always)]
    pub fn keep<R: Raw, F: Physical<R>>(&mut self, signal: &'static Signal<R, F>, raw: R) -> bool {
        let written = signal.keep(raw, self);
        self.takes(written)
    }

    /// The same for a physical value, as [`Signal::encode`] writes it.
    #[must_use]
    #[inline(always)]
    pub fn encode<R: Raw, F: Physical<R> + Scaled>(&mut self, signal: &'static Signal<R, F>, physical: F) -> bool {
        let written = signal.encode(physical, self);
        self.takes(written)
    }

    /// The same for a physical value that the frame can lack, as [`Signal::encode_some`] writes it.
    #[must_use]
    #[inline(always)]
    pub fn encode_some<R: Raw, F: Physical<R> + Scaled>(
        &mut self,
        signal: &'static Signal<R, F>,
        physical: Option<F>,
    ) -> bool {
        let written = signal.encode_some(physical, self);
        self.takes(written)
    }

    #[inline(always)]
    fn takes(&mut self, written: Result<(), Error>) -> bool {
        match written {
            Ok(()) => true,
            Err(error) => {
                self.outcome = Err(error);
                false
            }
        }
    }

    /// Returns why one of these methods refused a value: the last one that was refused.
    ///
    /// # Errors
    ///
    /// The same as those of the signal's method.
    #[inline(always)]
    pub const fn outcome(&self) -> Result<(), Error> {
        self.outcome
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Place;

    const FAN: Signal<u8> = Signal::new("fan", Place::byte(0)).limits(0, 3);
    const VALVE: Signal<u8> = Signal::new("valve", Place::byte(1)).limits(0, 3).absent();
    const VOLTAGE: Signal<u8, f64> = Signal::new("voltage", Place::byte(2)).scale(1, 10).limits(0.0, 3.0);
    const CURRENT: Signal<u8, f64> = Signal::new("current", Place::byte(3)).scale(1, 10).limits(0.0, 3.0).absent();

    #[test]
    fn what_is_taken_is_written_and_what_is_not_has_an_outcome() {
        let mut payload = Payload::within_limits("set", [0; 8]);
        assert!(payload.put(&FAN, 1) && payload.put_some(&VALVE, Some(2)));
        assert!(payload.encode(&VOLTAGE, 0.3) && payload.encode_some(&CURRENT, None) && payload.keep(&FAN, 1));
        assert_eq!((payload.data(), payload.outcome()), (&[1, 2, 3, 0xFF, 0, 0, 0, 0], Ok(())));
        let refused = |write: fn(&mut Payload) -> bool| {
            let mut payload = payload;
            let is_taken = write(&mut payload);
            (is_taken, payload.outcome().map_err(|error| error.reason().is_some()), *payload.data())
        };
        for write in [
            |payload: &mut Payload| payload.put(&FAN, 4),
            |payload: &mut Payload| payload.put_some(&VALVE, Some(4)),
            |payload: &mut Payload| payload.keep(&FAN, 2),
            |payload: &mut Payload| payload.encode(&VOLTAGE, 3.1),
            |payload: &mut Payload| payload.encode_some(&CURRENT, Some(3.1)),
        ] {
            assert_eq!(refused(write), (false, Err(true), [1, 2, 3, 0xFF, 0, 0, 0, 0]));
        }
    }
}
