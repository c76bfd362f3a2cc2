//! The frames that carry a long message in parts.

use core::fmt;

use super::{Memory, Parted, first, head, parts_of, size, word};
use crate::protocol::{Heading, heading};
use crate::{Destination, Error, Exchange, Frame, Payload, Request, Route};

/// The frames that carry a long message in parts, in their order.
#[derive(Clone)]
pub struct Frames<L: Parted> {
    data: L::Memory,
    blank: Frame,
    length: usize,
    first: u16,
    next: usize,
    count: usize,
}

impl<L: Parted> Frames<L> {
    /// Returns the frames, which are like `blank`.
    pub(super) fn new(values: &L, blank: &Frame, model: Option<u8>) -> Result<Self, Error> {
        Self::keeping(values, blank, model, is_to_module::<L>(blank))
    }

    /// Returns frames whose values keep to limits if they can go to a module.
    pub(super) fn anywhere(values: &L) -> Result<Self, Error> {
        Self::keeping(values, &Frame::new_raw(0, true, [0; 8], 8), None, !L::TO_MODULE.is_empty())
    }

    fn keeping(values: &L, blank: &Frame, model: Option<u8>, is_to_module: bool) -> Result<Self, Error> {
        let Some(first) = first::<L>(model) else { return Err(Error::Model { message: L::MESSAGE }) };
        let mut data = L::Memory::BLANK;
        let length = values.encode_by(rules::<L>(model, is_to_module)?, 0, data.as_mut())?.len();
        Ok(Self { data, blank: *blank, length, first, next: 0, count: parts_of::<L>(length) })
    }

    /// Gives the frames another counter than that of the blank frame, if the message has one. Bits
    /// that it cannot hold are dropped, so a number may count on and on.
    #[must_use]
    pub fn with_counter(mut self, counter: u8) -> Self {
        if let Some(place) = L::COUNTER {
            let mut data = self.blank.bytes();
            place.put(&mut data, u64::from(counter) & place.max());
            self.blank = self.blank.with_data(data);
        }
        self
    }

    /// Returns the frame with a part.
    fn frame(&self, index: usize) -> Option<Frame> {
        let start = index.checked_mul(size::<L>())?;
        let places = (start..).take(size::<L>()).map(|place| place.checked_sub(head::<L>()));
        let byte = |place: Option<usize>| place.and_then(|place| self.data.as_ref().get(place)).copied();
        let mut data = self.blank.bytes();
        L::NUMBER.put(&mut data, u64::try_from(usize::from(self.first).checked_add(index)?).ok()?);
        L::DATA.put(&mut data, word(places.map(|place| byte(place).unwrap_or_default())));
        if let (Some(place), 0) = (L::LENGTH, index) {
            place.put(&mut data, u64::try_from(self.length).ok()?);
        }
        let frame = self.blank.with_data(data);
        let is_last = index.checked_add(1) == Some(self.count);
        Some(L::CONTINUATION.filter(|_| !is_last).map_or(frame, |continuation| continuation.put(&frame)))
    }
}

impl<L: Parted> Iterator for Frames<L> {
    type Item = Frame;

    fn next(&mut self) -> Option<Frame> {
        let index = self.next;
        let frame = (index < self.count).then(|| self.frame(index)).flatten()?;
        self.next = index.saturating_add(1);
        Some(frame)
    }
}

impl<L: Parted> fmt::Debug for Frames<L> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(self.clone()).finish()
    }
}

impl Exchange {
    /// Builds the request whose signals are 0, or such a report of the controller. The parts of a
    /// [long message](crate::parts::Parted::frames) are made like it.
    ///
    /// # Errors
    ///
    /// Refuses a mode that the message does not have, and an address that the document does not name.
    pub fn blank_request<T: Destination>(&'static self, route: impl Into<Route<T>>) -> Result<Frame, Error> {
        let blank: Request<T::Protocol, ()> = self.request_to(route, &())?;
        Ok(*blank.frame())
    }

    /// Returns the frames that carry `message` to a module in parts. Generated code calls it.
    ///
    /// # Errors
    ///
    /// The same as [`request_to`](Self::request_to).
    #[doc(hidden)]
    pub fn parts_to<T: Destination, L: Parted<Protocol = T::Protocol>>(
        &'static self,
        route: impl Into<Route<T>>,
        message: &L,
    ) -> Result<Frames<L>, Error> {
        message.frames(&self.blank_request(route)?)
    }
}

/// Returns the rules by which the values of a message are written.
fn rules<L: Parted>(model: Option<u8>, is_to_module: bool) -> Result<Payload, Error> {
    let payload = Payload::new(L::MESSAGE, [0; 8]).for_model(model);
    if !is_to_module {
        return Ok(payload);
    }
    let is_of_model = L::TO_MODULE.iter().all(|(exchange, _)| exchange.is_of(model));
    if is_of_model { Ok(payload.keeping_limits()) } else { Err(Error::Model { message: L::MESSAGE }) }
}

/// Tests whether frames like `blank` go to a module.
fn is_to_module<L: Parted>(blank: &Frame) -> bool {
    let shows = || L::TO_MODULE.iter().filter_map(|(exchange, kind)| exchange.filter(*kind));
    match heading::<L::Protocol>(blank.raw_id()) {
        Heading::Module => true,
        Heading::Either => shows().any(|filter| filter.matches(blank)),
        Heading::Controller | Heading::Neither => false,
    }
}
