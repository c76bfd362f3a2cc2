//! Signals that a frame can lack, since it ends before them or since bits say that there is no value.

use super::Signal;
use crate::error::{Fault, Value};
use crate::physical::{Physical, Scaled};
use crate::raw::Raw;
use crate::{Data, Error, Payload};

impl<R: Raw, F: Physical<R>> Signal<R, F> {
    /// Returns the raw value, if a frame of `length` data bytes has it.
    #[inline(always)]
    pub fn get_some(&self, data: &Data, length: usize) -> Option<R> {
        self.is_there(*data, length).then(|| self.get(data))
    }

    /// Tests whether a frame of `length` data bytes has a value.
    #[inline(always)]
    fn is_there(&self, data: Data, length: usize) -> bool {
        self.place.is_within(length) && !(self.has_absent && self.place.get(&data) == self.absent_bits())
    }

    /// Returns the bits that say that there is no value.
    #[inline(always)]
    const fn absent_bits(&self) -> u64 {
        if R::SIGNED { self.place.max() >> 1 } else { self.place.max() }
    }

    /// Writes a raw value, if there is one.
    ///
    /// # Errors
    ///
    /// The same as [`put`](Self::put). It also refuses a value whose bits say that there is none.
    /// It refuses to leave out what the frame is long enough for, if no bits say so.
    #[inline(always)]
    pub fn put_some(&'static self, raw: Option<R>, payload: &mut Payload) -> Result<(), Error> {
        let Some(raw) = raw else { return self.left_out(payload) };
        let before = *payload.data();
        self.put(raw, payload)?;
        self.confirm(payload, before, Value::Raw(raw.to_bits()))
    }

    /// Takes back a value whose bits say that there is none.
    #[inline(always)]
    pub(super) fn confirm(&'static self, payload: &mut Payload, before: Data, value: Value) -> Result<(), Error> {
        if self.is_there(*payload.data(), before.len()) {
            return Ok(());
        }
        payload.replace(before);
        Err(self.refused(Fault::Special(value, None), payload))
    }

    /// Writes that there is no value, unless the frame ends before it.
    fn left_out(&'static self, payload: &mut Payload) -> Result<(), Error> {
        if payload.length().is_some_and(|length| !self.place.is_within(length.into())) {
            return Ok(());
        }
        let absent = self.has_absent.then(|| self.absent_bits());
        let bits = self.blank(payload.model()).or(absent).ok_or_else(|| self.refused(Fault::Missing, payload))?;
        payload.replace(self.with(*payload.data(), bits));
        Ok(())
    }
}

impl<R: Raw, F: Physical<R> + Scaled> Signal<R, F> {
    /// Returns the physical value, if a frame of `length` data bytes has it.
    #[inline(always)]
    pub fn decode_some(&self, data: &Data, length: usize) -> Option<F> {
        self.is_there(*data, length).then(|| self.decode(data))
    }

    /// Writes the raw value nearest to a physical value, if the frame has it.
    ///
    /// # Errors
    ///
    /// The same as [`encode`](Self::encode). It also refuses a value whose bits say that there is
    /// none. It refuses to leave out what the frame is long enough for, if no bits say so.
    #[inline(always)]
    pub fn encode_some(&'static self, physical: Option<F>, payload: &mut Payload) -> Result<(), Error> {
        let Some(physical) = physical else { return self.left_out(payload) };
        let before = *payload.data();
        self.encode(physical, payload)?;
        self.confirm(payload, before, physical.told())
    }
}
