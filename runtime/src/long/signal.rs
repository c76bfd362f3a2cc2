//! Signals of long messages: each has its place in eight bytes of the data.

use core::{array, slice};

use crate::frame::padded;
use crate::plumbing::{ByteOrder, Physical, Raw};
use crate::{AnySignal as _, Data, Elements, Error, Payload, Signal};

/// Most elements of an array.
const MOST: usize = 256;

/// A signal of a long message, or an array of equal signals in a row.
///
/// The place of the [`signal`](Self::signal) counts in eight bytes of the data,
/// [`window`](Self::window).
#[derive(Clone, Copy, Debug)]
pub struct LongSignal<R: 'static, F: 'static = R> {
    signal: Signal<R, F>,
    start: u16,
    bytes: i16,
    bits: i8,
}

impl<R: Raw, F: Physical<R>> LongSignal<R, F> {
    /// Returns a signal whose place counts from byte `start` of the data on.
    pub const fn new(start: u16, signal: Signal<R, F>) -> Self {
        Self { signal, start, bytes: 0, bits: 0 }
    }

    /// Makes it an array: each next element stands this many bytes behind the one before.
    #[must_use]
    pub const fn every(self, bytes: i16) -> Self {
        Self { bytes, ..self }
    }

    /// Makes it an array: each next element stands this many bits above the one before. All stand in
    /// the same eight bytes, which are read in the order of the place.
    #[must_use]
    pub const fn every_bits(self, bits: i8) -> Self {
        Self { bits, ..self }
    }

    /// Returns what is known of the signal, or of each element.
    pub const fn signal(&self) -> &Signal<R, F> {
        &self.signal
    }

    /// Returns the eight bytes in which the signal has its place, or an element by its number from
    /// 0. An element is moved to the place of the first one. Missing bytes are 0.
    pub fn window(&self, data: &[u8], index: usize) -> Data {
        self.moved(padded(data.get(self.start(index)..).unwrap_or_default()), self.distance(index).wrapping_neg())
    }

    /// Returns how many bytes the data have at least with some number of elements.
    pub fn reach(&self, elements: usize) -> usize {
        let Some(last) = elements.checked_sub(1) else { return 0 };
        self.end(0).max(self.end(last))
    }

    /// Returns how many elements data of some length hold whole.
    pub fn fitting(&self, length: usize) -> usize {
        (0..MOST).take_while(|index| self.end(*index) <= length).count()
    }

    /// Reads the value of the signal. `get` is a method of [`Signal`].
    pub fn read<T>(&self, data: &[u8], get: impl Fn(&Signal<R, F>, &Data) -> T) -> T {
        get(&self.signal, &self.window(data, 0))
    }

    /// Reads the values of `N` elements.
    pub fn read_array<T, const N: usize>(&self, data: &[u8], get: impl Fn(&Signal<R, F>, &Data) -> T) -> [T; N] {
        array::from_fn(|index| get(&self.signal, &self.window(data, index)))
    }

    /// Reads the value of a signal that short data lack. `get` is a method of [`Signal`].
    pub fn read_optional<T>(&self, data: &[u8], get: impl Fn(&Signal<R, F>, &Data, usize) -> T) -> T {
        get(&self.signal, &self.window(data, 0), self.there(data, 0))
    }

    /// Reads the values of `N` elements. Short data lack some of them.
    pub fn read_optional_array<T, const N: usize>(
        &self,
        data: &[u8],
        get: impl Fn(&Signal<R, F>, &Data, usize) -> T,
    ) -> [T; N] {
        array::from_fn(|index| get(&self.signal, &self.window(data, index), self.there(data, index)))
    }

    /// Reads the values of the first elements.
    pub fn read_some<T, const N: usize>(
        &self,
        data: &[u8],
        count: usize,
        get: impl Fn(&Signal<R, F>, &Data) -> T,
    ) -> Elements<T, N> {
        Elements::from_fn(count, |index| get(&self.signal, &self.window(data, index)))
    }

    /// Leaves out the value of the signal if the device model does not have it and no bit shows it. Generated code calls
    /// it.
    #[doc(hidden)]
    pub fn hide<T>(&self, value: &mut Option<T>, data: &[u8], model: Option<u8>) {
        self.hide_all(slice::from_mut(value), data, model);
    }

    /// The same for the values of an array.
    #[doc(hidden)]
    pub fn hide_all<T>(&self, values: &mut [Option<T>], data: &[u8], model: Option<u8>) {
        for (index, value) in values.iter_mut().enumerate() {
            if self.signal.is_hidden(&self.window(data, index), model) {
                *value = None;
            }
        }
    }

    /// Writes the value of the signal. `put` is a method of [`Signal`].
    ///
    /// # Errors
    ///
    /// The same as those of `put`.
    pub fn write<T: Copy>(
        &'static self,
        value: T,
        payload: &mut LongPayload<'_>,
        put: impl Fn(&'static Signal<R, F>, T, &mut Payload) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.write_all(&[value], payload, put)
    }

    /// Writes the values of an array that varies in length.
    ///
    /// # Errors
    ///
    /// The same as those of `put`. It also refuses another number of elements than the document
    /// allows, or than the arrays have that are written already.
    pub fn write_some<T: Copy>(
        &'static self,
        values: &[T],
        payload: &mut LongPayload<'_>,
        put: impl Fn(&'static Signal<R, F>, T, &mut Payload) -> Result<(), Error>,
    ) -> Result<(), Error> {
        payload.count(self.signal.own_name(), values.len())?;
        self.write_all(values, payload, put)
    }

    /// Writes the values of an array.
    ///
    /// # Errors
    ///
    /// The same as those of `put`.
    pub fn write_all<T: Copy>(
        &'static self,
        values: &[T],
        payload: &mut LongPayload<'_>,
        put: impl Fn(&'static Signal<R, F>, T, &mut Payload) -> Result<(), Error>,
    ) -> Result<(), Error> {
        values.iter().enumerate().try_for_each(|(index, value)| {
            let mut window = payload.rules;
            window.replace(self.window(payload.data, index));
            if payload.length.is_some_and(|length| self.end(index) > length) {
                window.end_after(0);
            }
            put(&self.signal, *value, &mut window)?;
            let bytes = self.moved(*window.data(), self.distance(index));
            let places = payload.data.iter_mut().skip(self.start(index));
            places.zip(bytes).for_each(|(place, byte)| *place = byte);
            Ok(())
        })
    }

    /// Returns how many bytes of its window there are, all or none.
    fn there(&self, data: &[u8], index: usize) -> usize {
        if self.end(index) <= data.len() { 8 } else { 0 }
    }

    /// Returns the byte from which the place of an element counts.
    fn start(&self, index: usize) -> usize {
        let moved = i32::from(self.bytes).wrapping_mul(i32::try_from(index).unwrap_or(i32::MAX));
        usize::try_from(i32::from(self.start).wrapping_add(moved)).unwrap_or(usize::MAX)
    }

    /// Returns how many bits an element stands above the first one.
    fn distance(&self, index: usize) -> i32 {
        i32::from(self.bits).wrapping_mul(i32::try_from(index).unwrap_or(i32::MAX))
    }

    /// Returns the number of data bytes up to the end of an element.
    fn end(&self, index: usize) -> usize {
        let mask = u64::from_be_bytes(self.moved(self.signal.place().mask(), self.distance(index)));
        let unused = usize::try_from(mask.trailing_zeros() / 8).unwrap_or(8);
        self.start(index).saturating_add(8_usize.saturating_sub(unused))
    }

    /// Moves bits up. Those that leave the eight bytes come in again at the other end.
    fn moved(&self, data: Data, bits: i32) -> Data {
        let bits = bits.rem_euclid(64).unsigned_abs();
        match self.signal.place().order() {
            ByteOrder::Big => u64::from_be_bytes(data).rotate_left(bits).to_be_bytes(),
            ByteOrder::Little => u64::from_le_bytes(data).rotate_left(bits).to_le_bytes(),
        }
    }
}

/// The data of a long message while they are written.
#[derive(Debug)]
pub struct LongPayload<'a> {
    /// The message, and the limits that its values keep to.
    pub(super) rules: Payload,
    pub(super) data: &'a mut [u8],
    /// The number of bytes, if the message can have several.
    length: Option<usize>,
    /// The least and the greatest number of elements of arrays that vary in length, if there are any.
    limits: Option<(usize, usize)>,
    /// How many elements they have.
    elements: Option<usize>,
}

impl<'a> LongPayload<'a> {
    /// Returns the bytes of a message that takes the values that `rules` do. `limits` are the least
    /// and the greatest number of elements of arrays that vary in length.
    pub const fn new(rules: Payload, limits: Option<(usize, usize)>, data: &'a mut [u8]) -> Self {
        Self { rules, data, length: None, limits, elements: None }
    }

    /// Sets the number of data bytes, of a message that can have several.
    pub const fn end_after(&mut self, length: usize) {
        self.length = Some(length);
    }

    /// Tests whether the message is as long as a signal needs although that has no value: a request to a device model
    /// that has it, unlike others, is refused without it.
    pub fn reaches<R: Raw, F: Physical<R>>(&self, signal: &Signal<R, F>) -> bool {
        self.rules.reaches(signal, 0)
    }

    /// Returns the number of data bytes, if the message can have several.
    pub(crate) const fn length(&self) -> Option<usize> {
        self.length
    }

    /// Returns how many elements the arrays have that vary in length, if there are any.
    pub(crate) const fn elements(&self) -> Option<usize> {
        self.elements
    }

    /// Takes the number of elements of an array, or of bytes of a text.
    pub(super) fn count(&mut self, signal: &'static str, count: usize) -> Result<(), Error> {
        let (minimum, maximum) = match self.elements {
            Some(elements) => (elements, elements),
            None => self.limits.unwrap_or((0, usize::MAX)),
        };
        if !(minimum..=maximum).contains(&count) {
            return Err(Error::Elements { message: self.rules.message(), signal, count, minimum, maximum });
        }
        self.elements = Some(count);
        Ok(())
    }
}
