//! Replies: who sent them, and their values.

use core::fmt;
use core::marker::PhantomData;

use crate::{Frame, IdentifierFields, Layout, Protocol, Selector};

/// A frame that answers a request.
#[derive(Clone, Copy, PartialEq)]
#[must_use = "a reply can be an error; look at its `values`"]
pub struct Reply<P: Protocol, R> {
    /// The values, or why there are none.
    pub values: Result<R, Failure>,
    selectors: &'static [Selector],
    frame: Frame,
    protocol: PhantomData<P>,
}

impl<P: Protocol, R> Reply<P, R> {
    /// Returns the identifier. It shows who answers, and in some protocols the error code.
    #[inline]
    pub fn identifier(&self) -> P::Identifier {
        P::Identifier::FROM_RAW(self.frame.raw_id())
    }

    /// Returns the selectors in the data, each with its raw value. In some protocols one of them is
    /// the error code.
    pub fn selectors(&self) -> impl Iterator<Item = (&'static Selector, u64)> {
        selected(self.selectors, self.frame)
    }
}

impl<P: Protocol, R: Layout> Reply<P, R> {
    /// Decodes a reply, which should have `length` data bytes, or one of those of its layout.
    #[inline(always)]
    pub(crate) fn decode(selectors: &'static [Selector], length: usize, frame: Frame) -> Self {
        let values = match failure::<P>(selectors, frame.has_length(length, R::LENGTHS), &frame) {
            Some(failure) => Err(failure),
            None => Ok(R::read(&frame, None)),
        };
        Self { values, selectors, frame, protocol: PhantomData }
    }

    /// Returns the reply of a request that another message refuses.
    pub(crate) fn refused(selectors: &'static [Selector], frame: Frame) -> Self {
        Self { values: Err(Failure::Error), selectors, frame, protocol: PhantomData }
    }
}

impl<P: Protocol, R: fmt::Debug> fmt::Debug for Reply<P, R> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Reply")
            .field("identifier", &self.identifier())
            .field("values", &self.values)
            .field("selectors", &self.selectors)
            .field("frame", &self.frame)
            .finish()
    }
}

/// Why a reply has no values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Failure {
    /// The device reports an error: by a code in the identifier or a selector, or by a message that
    /// refuses the request.
    Error,
    /// It has too few or too many data bytes.
    Length,
}

impl fmt::Display for Failure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Error => "the device answers with an error code",
            Self::Length => "the reply has too few or too many data bytes",
        })
    }
}

impl core::error::Error for Failure {}

/// Says why a reply, which has a right length or not, has no values.
#[inline(always)]
fn failure<P: Protocol>(selectors: &'static [Selector], has_right_length: bool, frame: &Frame) -> Option<Failure> {
    if has_error::<P>(selectors, frame) { Some(Failure::Error) } else { (!has_right_length).then_some(Failure::Length) }
}

/// Tests whether identifier or selectors show an error code.
#[inline(always)]
pub fn has_error<P: Protocol>(selectors: &'static [Selector], frame: &Frame) -> bool {
    !P::NORMAL.matches_id(frame.raw_id()) || selected(selectors, *frame).any(|(selector, raw)| !selector.is_normal(raw))
}

/// Returns the error code that the identifier shows, or else a selector.
pub fn error_code<P: Protocol>(selectors: &'static [Selector], frame: &Frame) -> Option<u64> {
    let (id, fields) = (frame.raw_id(), P::NORMAL.id_mask() & !P::FRAME.id_mask());
    if P::NORMAL.matches_id(id) {
        return selected(selectors, *frame).find(|(selector, raw)| !selector.is_normal(*raw)).map(|(_, raw)| raw);
    }
    (id & fields).checked_shr(fields.trailing_zeros()).map(u64::from)
}

/// Returns the selectors that a frame is long enough to have, each with its raw value.
pub fn selected(selectors: &'static [Selector], frame: Frame) -> impl Iterator<Item = (&'static Selector, u64)> {
    let known = selectors.iter().filter(move |selector| selector.place.is_within(frame.length()));
    known.map(move |selector| (selector, selector.place.get(&frame.bytes())))
}
