//! How a message travels by an access.

mod particulars;

use core::ptr;

use crate::address::{Addressing, Kind, Mode, Who};
use crate::filter::Required;
use crate::plumbing::{Shown, Way};
use crate::{Bits, Data, Error, Filter, Layout, Payload, Place, Protocol};

pub use particulars::{Particulars, Sent};

/// How messages travel: the kinds of frames, what all of them show, and who answers.
#[derive(Clone, Copy, Debug)]
pub struct Access {
    name: &'static str,
    has_values: bool,
    is_from_controller: bool,
    answers: &'static [Option<Who>],
    set: Option<&'static str>,
    request: Option<&'static Filter>,
    reply: Option<&'static Filter>,
    report: Option<&'static Filter>,
}

impl Access {
    /// Returns an access without frames. `answers` says who answers in each mode.
    pub const fn new(name: &'static str, answers: &'static [Option<Who>]) -> Self {
        Self {
            name,
            has_values: false,
            is_from_controller: false,
            answers,
            set: None,
            request: None,
            reply: None,
            report: None,
        }
    }

    /// Says that a request carries values, or travels by a transport.
    #[must_use]
    pub const fn with_values(self) -> Self {
        Self { has_values: true, ..self }
    }

    /// Sets the name of the set of frames, if messages travel as its members.
    #[must_use]
    pub const fn member_of(self, set: &'static str) -> Self {
        Self { set: Some(set), ..self }
    }

    /// Adds what a request shows.
    #[must_use]
    pub const fn request(self, request: &'static Filter) -> Self {
        Self { request: Some(request), ..self }
    }

    /// Adds what a reply shows. A filter with selectors that tell errors is an [`accepting`](Filter::accepting) one.
    #[must_use]
    pub const fn reply(self, reply: &'static Filter) -> Self {
        Self { reply: Some(reply), ..self }
    }

    /// Adds what a report shows, as [`reply`](Self::reply) does.
    #[must_use]
    pub const fn report(self, report: &'static Filter) -> Self {
        Self { report: Some(report), ..self }
    }

    /// Says that the controller sends the report. It goes where a request would go, and is built like
    /// one.
    #[must_use]
    pub const fn from_controller(self) -> Self {
        Self { is_from_controller: true, request: self.report, ..self }
    }

    /// Returns how a message travels by this access, with eight data bytes.
    #[must_use]
    pub const fn of(&'static self, message: &'static str) -> Exchange {
        let offered = offered(self.answers);
        Exchange { access: self, message, own: Required::NOTHING, length: 8, offered, particulars: None }
    }

    /// Returns what a kind of frame shows, whatever the message.
    #[inline(always)]
    const fn filter(&self, kind: Kind) -> Option<&'static Filter> {
        match kind {
            Kind::Request => self.request,
            Kind::Reply => self.reply,
            Kind::Report => self.report,
        }
    }
}

/// How a message travels by one access: its frames, what they show, and who answers.
///
/// There is one for each message and access, so it is small. What messages share stands in the access.
#[derive(Clone, Copy, Debug)]
pub struct Exchange {
    access: &'static Access,
    pub(crate) message: &'static str,
    own: Required,
    pub(crate) length: u8,
    /// The modes in which it is offered, as bits from the lowest on. Those beyond 8 have none.
    offered: u8,
    particulars: Option<&'static Particulars>,
}

impl Exchange {
    /// Requires a value in a field of the identifier.
    #[must_use]
    pub const fn id(mut self, bits: Bits, value: u32) -> Self {
        self.own = self.own.id(bits, value);
        self
    }

    /// Requires a value in the data.
    #[must_use]
    pub const fn data(mut self, place: Place, value: u64) -> Self {
        self.own = self.own.data(place, value);
        self
    }

    /// Accepts any value of some bits of a place in the data.
    #[must_use]
    pub const fn open(mut self, place: Place, bits: u64) -> Self {
        self.own = self.own.open(place, bits);
        self
    }

    /// Sets the number of data bytes of its frames.
    #[must_use]
    pub const fn length(self, length: u8) -> Self {
        Self { length, ..self }
    }

    /// Sets what only some messages have.
    #[must_use]
    pub const fn with(self, particulars: &'static Particulars) -> Self {
        let offered = match particulars.answers {
            Some(answers) => offered(answers),
            None => self.offered,
        };
        Self { offered, particulars: Some(particulars), ..self }
    }

    /// Returns the name of the message.
    pub const fn message(&self) -> &'static str {
        self.message
    }

    /// Returns the name of the set of frames, if the message travels as its member.
    pub const fn set(&self) -> Option<&'static str> {
        self.access.set
    }

    /// Returns the number of data bytes, or the least one if there are several.
    pub const fn data_length(&self) -> u8 {
        self.length
    }

    /// Returns what a kind of frame shows.
    #[inline(always)]
    pub const fn filter(&self, kind: Kind) -> Option<Filter> {
        match (self.access.filter(kind), self.sent()) {
            (Some(filter), None) => Some(filter.requiring(self.own)),
            (Some(filter), Some(sent)) => Some(filter.requiring(self.own).sending(sent.id).filled(sent.ones(kind))),
            (None, _) => None,
        }
    }

    /// Returns who answers in each mode.
    #[inline(always)]
    pub(crate) const fn answers(&self) -> &'static [Option<Who>] {
        match self.particulars {
            Some(Particulars { answers: Some(answers), .. }) => answers,
            _ => self.access.answers,
        }
    }

    /// Returns the device models that have the message; none if every model has it.
    #[inline(always)]
    const fn models(&self) -> &'static [u8] {
        match self.particulars {
            Some(particulars) => particulars.models,
            None => &[],
        }
    }

    /// Returns what its frames have that are built, although any is accepted there.
    #[inline(always)]
    const fn sent(&self) -> Option<&'static Sent> {
        match self.particulars {
            Some(particulars) => particulars.sent,
            None => None,
        }
    }

    /// Returns what a refusal shows, which answers a request in place of the reply.
    #[inline(always)]
    pub(crate) const fn refusal(&self) -> Option<&'static Filter> {
        match self.particulars {
            Some(particulars) => particulars.refusal,
            None => None,
        }
    }

    /// Tests whether a request carries values, or travels by a transport.
    pub const fn has_values(&self) -> bool {
        self.access.has_values
    }

    /// Returns the name of the access.
    pub const fn access(&self) -> &'static str {
        self.access.name
    }

    /// Tests whether this access has a request without values.
    pub(crate) fn asks_by(&self, access: &str) -> bool {
        self.access.name == access && self.access.request.is_some() && !self.access.has_values
    }

    /// Tests whether a device model has the message. An unknown model has every message.
    #[inline]
    pub(crate) fn is_of(&self, model: Option<u8>) -> bool {
        model.is_none_or(|model| self.models().is_empty() || self.models().contains(&model))
    }

    /// Tests whether each device model has the message.
    #[inline(always)]
    pub(crate) const fn is_of_each(&self) -> bool {
        self.models().is_empty()
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
        ptr::eq(self, other) || (self.message, self.access()) == (other.message, other.access())
    }

    /// Tests whether a kind of its frames goes to a module. If it does, it keeps to the limits of what
    /// may be sent.
    #[inline(always)]
    pub(crate) fn is_to_module<P: Protocol>(&self, kind: Kind) -> bool {
        match kind {
            Kind::Request => true,
            Kind::Reply => false,
            Kind::Report => P::CONTROLLER_REPORTS && self.access.is_from_controller,
        }
    }

    /// Returns the data bits that a kind of frame has as 1 although nothing names them.
    #[inline(always)]
    pub(crate) fn ones<P: Protocol>(&self, kind: Kind) -> Data {
        let kind = if self.is_to_module::<P>(kind) { Kind::Request } else { kind };
        self.sent().map_or([0; 8], |sent| sent.ones(kind))
    }

    /// Returns who answers in a mode, if the message has it.
    pub(crate) fn who(&self, mode: usize) -> Option<Who> {
        self.answers().get(mode).copied().flatten()
    }

    /// Finds the way by which a frame with an identifier travels, if the message has it.
    #[inline(always)]
    pub(crate) fn way<P: Protocol>(&self, kind: Kind, id: u32) -> Option<Way> {
        P::way(&Shown::new(id, self.is_to_module::<P>(kind), self.answers()))
    }

    /// Returns the addressing mode that an identifier shows.
    pub(crate) fn addressing<P: Protocol>(&self, kind: Kind, id: u32) -> Option<Addressing> {
        Addressing::find(P::MODES, self.answers(), self.is_to_module::<P>(kind), id)
    }

    #[inline(always)]
    pub(crate) fn no_mode(&self, mode: Option<&Mode>) -> Error {
        Error::Mode { message: self.message, access: self.access(), mode: mode.map(|mode| mode.name) }
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
