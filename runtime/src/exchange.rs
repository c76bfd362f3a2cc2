//! How a message travels by an access.

use core::ptr;

use crate::address::{Addressing, Kind, Mode, Who};
use crate::plumbing::{Shown, Way};
use crate::{Bits, Data, Error, Filter, Layout, Payload, Protocol};

/// How a message travels by one access: its frames, what they show, and who answers.
#[derive(Clone, Copy, Debug)]
pub struct Exchange {
    pub(crate) message: &'static str,
    access: &'static str,
    pub(crate) length: u8,
    has_values: bool,
    is_from_controller: bool,
    pub(crate) answers: &'static [Option<Who>],
    /// The modes in which it is offered, as bits from the lowest on. Those beyond 8 have none.
    offered: u8,
    models: &'static [u8],
    set: Option<&'static str>,
    pub(crate) request: Option<Filter>,
    pub(crate) reply: Option<Filter>,
    report: Option<Filter>,
    pub(crate) refusal: Option<&'static Filter>,
}

impl Exchange {
    /// Returns an access without a message and without frames. `answers` says who answers in each
    /// mode.
    pub const fn new(access: &'static str, answers: &'static [Option<Who>]) -> Self {
        Self {
            message: "",
            access,
            length: 8,
            has_values: false,
            is_from_controller: false,
            answers,
            offered: offered(answers),
            models: &[],
            set: None,
            request: None,
            reply: None,
            report: None,
            refusal: None,
        }
    }

    /// Returns this access for a message, whose frames also show what `own` requires.
    #[must_use]
    pub const fn of(self, message: &'static str, own: Filter) -> Self {
        let Self { request, reply, report, .. } = self;
        let [request, reply, report] = [narrowed(request, own), narrowed(reply, own), narrowed(report, own)];
        Self { message, request, reply, report, ..self }
    }

    /// Sets who answers in each mode.
    #[must_use]
    pub const fn answers(self, answers: &'static [Option<Who>]) -> Self {
        Self { answers, offered: offered(answers), ..self }
    }

    /// Says that a request carries values, or travels by a transport.
    #[must_use]
    pub const fn with_values(self) -> Self {
        Self { has_values: true, ..self }
    }

    /// Sets the number of data bytes of its frames.
    #[must_use]
    pub const fn length(self, length: u8) -> Self {
        Self { length, ..self }
    }

    /// Sets the device models that have the message, by number. Without them every model has it.
    #[must_use]
    pub const fn models(self, models: &'static [u8]) -> Self {
        Self { models, ..self }
    }

    /// Sets the name of the set of frames, if the message travels as its member.
    #[must_use]
    pub const fn member_of(self, set: &'static str) -> Self {
        Self { set: Some(set), ..self }
    }

    /// Adds what a request shows.
    #[must_use]
    pub const fn request(self, request: Filter) -> Self {
        Self { request: Some(request), ..self }
    }

    /// Adds what a reply shows.
    #[must_use]
    pub const fn reply(self, reply: Filter) -> Self {
        Self { reply: Some(reply.accepting()), ..self }
    }

    /// Adds what a report shows.
    #[must_use]
    pub const fn report(self, report: Filter) -> Self {
        Self { report: Some(report.accepting()), ..self }
    }

    /// Says that the controller sends the report. It goes where a request would go, and is built like
    /// one.
    #[must_use]
    pub const fn from_controller(self) -> Self {
        Self { is_from_controller: true, request: self.report, ..self }
    }

    /// Sets the value that its frames have in a field of the identifier when they are built. Any is
    /// accepted.
    #[must_use]
    pub const fn send_id(self, bits: Bits, value: u32) -> Self {
        let Self { request, reply, report, .. } = self;
        let [request, reply, report] =
            [sending(request, bits, value), sending(reply, bits, value), sending(report, bits, value)];
        Self { request, reply, report, ..self }
    }

    /// Sets data bits that a request has as 1 although nothing names them. Any are accepted.
    #[must_use]
    pub const fn fill_request(self, ones: Data) -> Self {
        let request = match self.request {
            Some(request) => Some(request.filled(ones)),
            None => None,
        };
        Self { request, ..self }
    }

    /// Sets data bits that a reply has as 1 although nothing names them. Any are accepted.
    #[must_use]
    pub const fn fill_reply(self, ones: Data) -> Self {
        let reply = match self.reply {
            Some(reply) => Some(reply.filled(ones)),
            None => None,
        };
        Self { reply, ..self }
    }

    /// Sets data bits that a report has as 1 although nothing names them. Any are accepted.
    #[must_use]
    pub const fn fill_report(self, ones: Data) -> Self {
        let report = match self.report {
            Some(report) => Some(report.filled(ones)),
            None => None,
        };
        Self { report, ..self }
    }

    /// Adds the refusal, which answers a request in place of the reply. It is another message's
    /// reply and says why.
    #[must_use]
    pub const fn refusal(self, refusal: &'static Filter) -> Self {
        Self { refusal: Some(refusal), ..self }
    }

    /// Returns the name of the message.
    pub const fn message(&self) -> &'static str {
        self.message
    }

    /// Returns the name of the set of frames, if the message travels as its member.
    pub const fn set(&self) -> Option<&'static str> {
        self.set
    }

    /// Returns the number of data bytes, or the least one if there are several.
    pub const fn data_length(&self) -> u8 {
        self.length
    }

    /// Returns what a kind of frame shows.
    pub const fn filter(&self, kind: Kind) -> Option<Filter> {
        match kind {
            Kind::Request => self.request,
            Kind::Reply => self.reply,
            Kind::Report => self.report,
        }
    }

    /// Tests whether a request carries values, or travels by a transport.
    pub const fn has_values(&self) -> bool {
        self.has_values
    }

    /// Returns the name of the access.
    pub const fn access(&self) -> &'static str {
        self.access
    }

    /// Tests whether this access has a request without values.
    pub(crate) fn asks_by(&self, access: &str) -> bool {
        self.access == access && self.request.is_some() && !self.has_values
    }

    /// Tests whether a device model has the message. An unknown model has every message.
    #[inline]
    pub(crate) fn is_of(&self, model: Option<u8>) -> bool {
        model.is_none_or(|model| self.models.is_empty() || self.models.contains(&model))
    }

    /// Tests whether each device model has the message.
    #[inline(always)]
    pub(crate) const fn is_of_each(&self) -> bool {
        self.models.is_empty()
    }

    /// Tests the values of a request against the limits of a device model. Generated code calls it.
    ///
    /// # Errors
    ///
    /// Refuses a message that the model does not have, and values outside its limits.
    #[doc(hidden)]
    pub fn within(&self, model: impl Into<u8>, message: &impl Layout) -> Result<(), Error> {
        let model = Some(model.into());
        if !self.is_of(model) {
            return Err(Error::Model { message: self.message });
        }
        message.encode(&mut Payload::within_limits(self.message, [0; 8]).for_model(model))
    }

    /// Tests whether the message travels by this access in one of some modes, which are bits.
    #[inline(always)]
    pub(crate) const fn is_offered(&self, modes: u8) -> bool {
        modes & self.offered != 0
    }

    /// Tests whether this is the same access to the same message.
    pub(crate) fn is(&self, other: &Self) -> bool {
        ptr::eq(self, other) || (self.message, self.access) == (other.message, other.access)
    }

    /// Tests whether a kind of its frames goes to a module. If it does, it keeps to the limits of what
    /// may be sent.
    #[inline(always)]
    pub(crate) fn is_to_module<P: Protocol>(&self, kind: Kind) -> bool {
        match kind {
            Kind::Request => true,
            Kind::Reply => false,
            Kind::Report => P::CONTROLLER_REPORTS && self.is_from_controller,
        }
    }

    /// Returns who answers in a mode, if the message has it.
    pub(crate) fn who(&self, mode: usize) -> Option<Who> {
        self.answers.get(mode).copied().flatten()
    }

    /// Finds the way by which a frame with an identifier travels, if the message has it.
    #[inline(always)]
    pub(crate) fn way<P: Protocol>(&self, kind: Kind, id: u32) -> Option<Way> {
        P::way(&Shown::new(id, self.is_to_module::<P>(kind), self.answers))
    }

    /// Returns the addressing mode that an identifier shows.
    pub(crate) fn addressing<P: Protocol>(&self, kind: Kind, id: u32) -> Option<Addressing> {
        Addressing::find(P::MODES, self.answers, self.is_to_module::<P>(kind), id)
    }

    #[cold]
    pub(crate) fn no_mode(&self, mode: Option<&Mode>) -> Error {
        Error::Mode { message: self.message, access: self.access, mode: mode.map(|mode| mode.name) }
    }
}

/// Returns the modes that are offered, as bits.
const fn offered(mut answers: &[Option<Who>]) -> u8 {
    let (mut bits, mut bit) = (0, 1);
    while let [answer, others @ ..] = answers {
        if answer.is_some() {
            bits |= bit;
        }
        (answers, bit) = (others, bit << 1);
    }
    bits
}

const fn narrowed(filter: Option<Filter>, own: Filter) -> Option<Filter> {
    match filter {
        Some(filter) => Some(filter.and(own)),
        None => None,
    }
}

const fn sending(filter: Option<Filter>, bits: Bits, value: u32) -> Option<Filter> {
    match filter {
        Some(filter) => Some(filter.send_id(bits, value)),
        None => None,
    }
}
