//! Where messages have quantities.

use crate::{Error, Exchange, Frame, Kind, Payload, Place, Protocol, Quantity, ReadNumber, Received, SetNumber};

/// Where a quantity is read.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct ReadPath {
    /// The quantity.
    pub quantity: Quantity,
    /// The unit, whose thousandths are counted.
    pub unit: Option<&'static str>,
    /// The frames that carry it.
    pub frames: &'static [(Kind, &'static Exchange)],
    /// What asks for it, unless devices only report it by themselves.
    pub request: Option<&'static Exchange>,
    pub(super) value: Value<&'static dyn ReadNumber>,
}

/// Where a quantity is set.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct SetPath {
    /// The quantity.
    pub quantity: Quantity,
    /// The unit, whose thousandths are counted.
    pub unit: Option<&'static str>,
    /// How the message travels that sets it.
    pub request: &'static Exchange,
    /// What a device does with a value out of range, if the document says it.
    pub out_of_range: Option<OutOfRange>,
    /// Whether a device keeps the value without power, if the document says it.
    pub is_kept: Option<bool>,
    /// The reply carries the value, too.
    pub(super) is_echoed: bool,
    pub(super) value: Value<&'static dyn SetNumber>,
    pub(super) others: &'static [(Place, u64)],
}

/// What a device does with a value that the document does not allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum OutOfRange {
    /// It answers the request with an error.
    Refused,
    /// It goes on with the value before.
    Ignored,
    /// It takes the nearest value that the document allows.
    Limited,
}

/// The value of a quantity in a frame.
#[derive(Clone, Copy)]
pub enum Value<N> {
    /// A signal that is a number.
    Number(N),
    /// The states of a switch.
    Switch(States),
}

/// The states of a switch, as bits.
#[derive(Clone, Copy, Debug)]
pub struct States {
    /// Where the bits stand.
    pub place: Place,
    /// What they are if it is off.
    pub inactive: u64,
    /// What they are if it is on.
    pub active: u64,
}

impl ReadPath {
    /// Returns the path to a number. Generated code calls it.
    #[doc(hidden)]
    pub const fn number(
        quantity: Quantity,
        unit: Option<&'static str>,
        frames: &'static [(Kind, &'static Exchange)],
        signal: &'static dyn ReadNumber,
    ) -> Self {
        Self { quantity, unit, frames, request: None, value: Value::Number(signal) }
    }

    /// Returns the path to a switch. Generated code calls it.
    #[doc(hidden)]
    pub const fn switch(quantity: Quantity, frames: &'static [(Kind, &'static Exchange)], states: States) -> Self {
        Self { quantity, unit: None, frames, request: None, value: Value::Switch(states) }
    }

    /// Adds what asks for it. Generated code calls it.
    #[doc(hidden)]
    #[must_use]
    pub const fn asked_by(self, request: &'static Exchange) -> Self {
        Self { request: Some(request), ..self }
    }

    /// Returns the name of the message.
    pub const fn message(&self) -> &'static str {
        match self.frames {
            [(_, exchange), ..] => exchange.message(),
            [] => "",
        }
    }

    /// Tests whether a request without values asks for it, or modules report it by themselves.
    pub(super) fn comes(&self) -> bool {
        self.request.is_some() || self.frames.iter().any(|(kind, _)| *kind == Kind::Report)
    }

    /// Tests whether a frame carries the quantity.
    pub(super) fn is_in<P: Protocol>(&self, received: &Received<P>) -> bool {
        let is_its =
            |(kind, exchange): &(Kind, &Exchange)| *kind == received.kind() && exchange.is(received.exchange());
        self.frames.iter().any(is_its)
    }
}

impl SetPath {
    /// Returns the path to a number. Generated code calls it.
    #[doc(hidden)]
    pub const fn number(
        quantity: Quantity,
        unit: Option<&'static str>,
        request: &'static Exchange,
        signal: &'static dyn SetNumber,
    ) -> Self {
        Self::new(quantity, unit, request, Value::Number(signal))
    }

    /// Returns the path to a switch. Generated code calls it.
    #[doc(hidden)]
    pub const fn switch(quantity: Quantity, request: &'static Exchange, states: States) -> Self {
        Self::new(quantity, None, request, Value::Switch(states))
    }

    const fn new(
        quantity: Quantity,
        unit: Option<&'static str>,
        request: &'static Exchange,
        value: Value<&'static dyn SetNumber>,
    ) -> Self {
        Self { quantity, unit, request, out_of_range: None, is_kept: None, is_echoed: false, value, others: &[] }
    }

    /// Says that a device refuses a request with a value out of range. Generated code calls it.
    #[doc(hidden)]
    #[must_use]
    pub const fn refusing(self) -> Self {
        Self { out_of_range: Some(OutOfRange::Refused), ..self }
    }

    /// Says that a device ignores a value out of range. Generated code calls it.
    #[doc(hidden)]
    #[must_use]
    pub const fn ignoring(self) -> Self {
        Self { out_of_range: Some(OutOfRange::Ignored), ..self }
    }

    /// Says that a device takes the nearest value inside its range. Generated code calls it.
    #[doc(hidden)]
    #[must_use]
    pub const fn limiting(self) -> Self {
        Self { out_of_range: Some(OutOfRange::Limited), ..self }
    }

    /// Says that a device keeps the value without power. Generated code calls it.
    #[doc(hidden)]
    #[must_use]
    pub const fn kept(self) -> Self {
        Self { is_kept: Some(true), ..self }
    }

    /// Says that a device loses the value without power. Generated code calls it.
    #[doc(hidden)]
    #[must_use]
    pub const fn lost(self) -> Self {
        Self { is_kept: Some(false), ..self }
    }

    /// Says that the reply carries the value, too. Generated code calls it.
    #[doc(hidden)]
    #[must_use]
    pub const fn echoed(self) -> Self {
        Self { is_echoed: true, ..self }
    }

    /// Adds the bits that the message has elsewhere. Generated code calls it.
    #[doc(hidden)]
    #[must_use]
    pub const fn with(self, others: &'static [(Place, u64)]) -> Self {
        Self { others, ..self }
    }

    /// Returns the name of the message.
    pub const fn message(&self) -> &'static str {
        self.request.message()
    }

    /// Tests whether a frame carries the value.
    pub(super) fn is_in<P: Protocol>(&self, received: &Received<P>) -> bool {
        let carries = match received.kind() {
            Kind::Reply => self.is_echoed,
            kind @ (Kind::Request | Kind::Report) => self.request.is_to_module::<P>(kind),
        };
        carries && self.request.is(received.exchange())
    }

    /// Reads the value in what sets it, or in a reply.
    pub(super) fn read(&self, frame: &Frame) -> Option<i32> {
        match self.value {
            Value::Number(signal) => signal.set_in(&frame.bytes(), frame.length()),
            Value::Switch(states) => states.shown(frame),
        }
    }

    /// Returns the value nearest to another one that may be set, on the way from one that may.
    pub(crate) fn limited(&self, value: i32, legal: i32) -> i32 {
        let may_be_set = |value| self.write(value, &mut Payload::within_limits(self.message(), [0; 8])).is_ok();
        if may_be_set(value) {
            return value;
        }
        let (mut inside, mut outside) = (legal, value);
        while inside.abs_diff(outside) > 1 {
            let middle = (inside & outside).wrapping_add((inside ^ outside).wrapping_shr(1));
            if may_be_set(middle) { inside = middle } else { outside = middle }
        }
        inside
    }

    /// Writes a value, and the bits that the message has elsewhere.
    pub(super) fn write(&self, value: i32, payload: &mut Payload) -> Result<(), Error> {
        match (self.value, value) {
            (Value::Number(signal), _) => signal.set_number(value, payload)?,
            (Value::Switch(states), 0) => put(states.place, states.inactive, payload),
            (Value::Switch(states), 1) => put(states.place, states.active, payload),
            (Value::Switch(_), _) => return Err(Error::State { quantity: self.quantity.name(), value }),
        }
        self.others.iter().for_each(|(place, bits)| put(*place, *bits, payload));
        Ok(())
    }
}

fn put(place: Place, bits: u64, payload: &mut Payload) {
    let mut data = *payload.data();
    place.put(&mut data, bits);
    payload.replace(data);
}

impl Value<&'static dyn ReadNumber> {
    /// Reads the value in a frame of a device model, if it shows one.
    pub(super) fn read(&self, frame: &Frame, model: Option<u8>) -> Option<i32> {
        let data = frame.bytes();
        let shows =
            |signal: &dyn ReadNumber| signal.place().is_within(frame.length()) && !signal.is_hidden(&data, model);
        match self {
            Self::Number(signal) => {
                if shows(*signal) {
                    signal.read_number(&data)
                } else {
                    None
                }
            }
            Self::Switch(states) => states.shown(frame),
        }
    }
}

impl States {
    /// Reads the state in a frame, if it shows one.
    fn shown(&self, frame: &Frame) -> Option<i32> {
        if !self.place.is_within(frame.length()) {
            return None;
        }
        let bits = self.place.get(&frame.bytes());
        if bits == self.active {
            return Some(1);
        }
        (bits == self.inactive).then_some(0)
    }
}
