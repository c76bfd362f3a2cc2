//! Texts of long messages: whole bytes that no place can hold.

use core::marker::PhantomData;

use super::LongPayload;
use crate::{AnySignal as _, Elements, Error, Signal};

/// Whole bytes as the value of a field.
pub trait ByteRun: Copy {
    /// The greatest number of bytes.
    const MOST: usize;
    /// The byte that fills a text up; `None` if each byte is one of the value.
    const FILL: Option<u8>;

    /// Takes bytes, at most [`MOST`](Self::MOST) of them. Those that are missing fill it up.
    fn from_slice(bytes: &[u8]) -> Self;

    /// Returns the bytes, with those that fill it up.
    fn as_slice(&self) -> &[u8];
}

impl<const N: usize> ByteRun for Elements<u8, N> {
    const MOST: usize = N;
    const FILL: Option<u8> = None;

    fn from_slice(bytes: &[u8]) -> Self {
        Self::from_fn(bytes.len(), |index| bytes.get(index).copied().unwrap_or_default())
    }

    fn as_slice(&self) -> &[u8] {
        self
    }
}

/// A text of a long message that has more than eight bytes, or any number of them. The same are raw
/// bytes.
///
/// The value is a [`Text`](crate::Text), [`Bytes`](crate::Bytes), or [`Elements`] if their number
/// varies.
#[derive(Clone, Copy, Debug)]
pub struct LongText<T: 'static> {
    byte: Signal<u8>,
    start: u16,
    least: Option<u16>,
    value: PhantomData<fn() -> T>,
}

impl<T: ByteRun> LongText<T> {
    /// Returns a text from byte `start` of the data on. `byte` is what each of its bytes is.
    pub const fn new(start: u16, byte: Signal<u8>) -> Self {
        Self { byte, start, least: None, value: PhantomData }
    }

    /// Lets it end where the data end, with at least this number of bytes.
    #[must_use]
    pub const fn at_least(self, least: u16) -> Self {
        Self { least: Some(least), ..self }
    }

    /// Returns what is known of each byte.
    pub const fn byte(&self) -> &Signal<u8> {
        &self.byte
    }

    /// Returns how many bytes the data have at least with some number of bytes of the text.
    pub fn reach(&self, bytes: usize) -> usize {
        usize::from(self.start).saturating_add(bytes)
    }

    /// Reads the text.
    pub fn read(&self, data: &[u8]) -> T {
        T::from_slice(data.get(self.start.into()..).unwrap_or_default())
    }

    /// Reads a text that short data lack.
    pub fn read_optional(&self, data: &[u8]) -> Option<T> {
        (self.reach(T::MOST) <= data.len()).then(|| self.read(data))
    }

    /// Leaves out a text if the device model does not have it and no bit shows it. Generated code calls it.
    #[doc(hidden)]
    pub fn hide(&self, text: &mut Option<T>, data: &[u8], model: Option<u8>) {
        let is_blank = |byte: &u8| self.byte.is_hidden(&[*byte, 0, 0, 0, 0, 0, 0, 0], model);
        if data.iter().skip(self.start.into()).take(T::MOST).all(is_blank) {
            *text = None;
        }
    }

    /// Writes the text. If it ends where the data end, only as many filling bytes are written as the
    /// document wants.
    ///
    /// # Errors
    ///
    /// Refuses bytes that the device model does not have, and too few bytes if none fills them up.
    pub fn write(&'static self, text: &T, payload: &mut LongPayload<'_>) -> Result<(), Error> {
        let (bytes, sent) = (text.as_slice(), self.sent(text));
        if self.least.is_some() {
            payload.count(self.byte.own_name(), sent)?;
        }
        let LongPayload { rules, data, .. } = payload;
        for byte in bytes.iter().take(sent) {
            let mut alone = *rules;
            self.byte.put(*byte, &mut alone)?;
        }
        data.iter_mut().skip(self.start.into()).zip(bytes).for_each(|(place, byte)| *place = *byte);
        Ok(())
    }

    /// Returns how many of its bytes must be sent.
    fn sent(&self, text: &T) -> usize {
        let bytes = text.as_slice();
        let Some(least) = self.least.filter(|_| T::FILL.is_some()) else { return bytes.len() };
        let end = bytes.iter().rposition(|byte| Some(*byte) != T::FILL);
        end.map_or(0, |end| end.saturating_add(1)).max(least.into())
    }

    /// Writes a text, if the message is long enough for it.
    ///
    /// # Errors
    ///
    /// The same as [`write`](Self::write). It also refuses to leave out what the message is long
    /// enough for, if the device model has it.
    pub fn write_optional(&'static self, text: &Option<T>, payload: &mut LongPayload<'_>) -> Result<(), Error> {
        match (text, payload.length()) {
            (Some(text), _) => self.write(text, payload),
            (None, Some(length)) if self.reach(T::MOST) > length => Ok(()),
            (None, _) => {
                // What is blank stands there already.
                let mut alone = payload.rules;
                self.byte.put_some(None, &mut alone)
            }
        }
    }
}
