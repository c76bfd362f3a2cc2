//! Requests, and the frames that answer them.

use core::fmt;
use core::marker::PhantomData;
use core::ptr;

use crate::address::{Addressing, Kind, Mode, Who};
use crate::filter::IdFilter;
use crate::plumbing::{Continuation, Shown, Way};
use crate::protocol::{is_to_controller, own_id};
use crate::reply::has_error;
use crate::{Bits, Data, Error, Filter, Frame, Layout, Payload, Protocol, Reply, Selector};

/// A target that a request of a protocol can address. Generated code implements it.
pub trait Destination: Copy {
    /// The messages of the protocol.
    type Protocol: Protocol;

    /// Returns the mode as an index into [`Protocol::MODES`].
    fn mode(self) -> usize;

    /// Returns what the identifier of a request shows. `sender` is the sender's own address, unless it is the usual one.
    ///
    /// # Errors
    ///
    /// Refuses addresses that the document does not name.
    fn request(self, sender: Option<i32>) -> Result<IdFilter, Error>;

    /// Returns what the identifiers of replies to this request show, if `who` answers in this mode.
    fn replies(self, who: Who, sender: Option<i32>) -> Option<IdFilter>;

    /// Returns the route of a request, as its identifier or that of a reply shows it.
    #[doc(hidden)]
    fn shown(way: &Way) -> Option<Route<Self>>;
}

/// A target, and the sender's own address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Route<T> {
    target: T,
    sender: Option<i32>,
}

impl<T: Destination> From<T> for Route<T> {
    #[inline(always)]
    fn from(target: T) -> Self {
        Self { target, sender: None }
    }
}

impl<T: Destination> Route<T> {
    /// Returns the route from a sender's own address.
    #[inline(always)]
    pub const fn new(target: T, sender: i32) -> Self {
        Self { target, sender: Some(sender) }
    }

    /// Returns the target.
    pub const fn target(&self) -> T {
        self.target
    }

    /// Returns the sender's own address, unless it is the usual one.
    pub const fn sender(&self) -> Option<i32> {
        self.sender
    }
}

/// How a message travels by one access: its frames, what they show, and who answers.
#[derive(Clone, Copy, Debug)]
pub struct Exchange {
    message: &'static str,
    access: &'static str,
    length: u8,
    has_values: bool,
    is_from_controller: bool,
    answers: &'static [Option<Who>],
    /// The modes in which it is offered, as bits from the lowest on. Those beyond 8 have none.
    offered: u8,
    models: &'static [u8],
    set: Option<&'static str>,
    request: Option<Filter>,
    reply: Option<Filter>,
    report: Option<Filter>,
    refusal: Option<&'static Filter>,
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

    /// Says that a request carries values.
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

    /// Tests whether a request carries values.
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

    /// Builds the request that carries `message`. Generated code calls it.
    ///
    /// # Errors
    ///
    /// Refuses a mode that the message does not have, an address that the document does not name, and values outside
    /// their limits.
    #[doc(hidden)]
    #[inline]
    pub fn request_to<T: Destination, R>(
        &'static self,
        route: impl Into<Route<T>>,
        message: &impl Layout,
    ) -> Result<Request<T::Protocol, R>, Error> {
        self.built(route.into(), None, message)
    }

    /// Builds the request that carries `message` to a device model. Generated code calls it.
    ///
    /// # Errors
    ///
    /// The same as [`request_to`](Self::request_to), within the limits of the model.
    #[doc(hidden)]
    #[inline]
    pub fn request_within<T: Destination, R>(
        &'static self,
        model: impl Into<u8>,
        route: impl Into<Route<T>>,
        message: &impl Layout,
    ) -> Result<Request<T::Protocol, R>, Error> {
        self.built(route.into(), Some(model.into()), message)
    }

    #[inline(always)]
    fn built<T: Destination, R>(
        &'static self,
        Route { target, sender }: Route<T>,
        model: Option<u8>,
        message: &impl Layout,
    ) -> Result<Request<T::Protocol, R>, Error> {
        let who = self.answers.get(target.mode()).copied().flatten();
        let (Some(who), Some(request)) = (who, self.request) else {
            return Err(self.no_mode(T::Protocol::MODES.get(target.mode())));
        };
        let filter = request.narrowed(target.request(sender)?);
        let mut payload = Payload::within_limits(self.message, filter.data_value()).for_model(model);
        message.encode(&mut payload)?;
        let length = payload.length().unwrap_or(self.length);
        let frame = Frame::new_raw(filter.sent_id(), filter.is_extended(), *payload.data(), length);
        let replies = target.replies(who, sender);
        let shown = |filter: Option<&Filter>| match (filter, replies) {
            (Some(filter), Some(who)) => filter.id_narrowed(who),
            _ => IdFilter::NONE,
        };
        let (reply, refusal) = (shown(self.reply.as_ref()), shown(self.refusal));
        Ok(Request { frame, exchange: self, who, reply, refusal, carried: PhantomData })
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

/// The replies that a request gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Replies {
    /// None.
    Nobody,
    /// One, from the addressed module.
    One(Filter),
    /// One from each addressed module.
    Each(Filter),
    /// One, from the module that answers for all.
    Coordinator(Filter),
}

impl Replies {
    /// Returns what the replies show, as a filter that passes only them.
    pub const fn filter(self) -> Option<Filter> {
        match self {
            Self::Nobody => None,
            Self::One(filter) | Self::Each(filter) | Self::Coordinator(filter) => Some(filter),
        }
    }
}

/// A request ready to be sent, whose replies carry `R`.
#[must_use = "a request is only a frame; send it"]
pub struct Request<P, R> {
    frame: Frame,
    exchange: &'static Exchange,
    who: Who,
    /// What identifiers of replies show.
    reply: IdFilter,
    /// What identifiers of refusals show.
    refusal: IdFilter,
    carried: PhantomData<fn() -> (P, R)>,
}

impl<P, R> Request<P, R> {
    /// Returns the frame to send.
    #[must_use]
    #[inline]
    pub const fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Returns which replies it gets.
    #[inline]
    pub fn replies(&self) -> Replies {
        match (self.who, self.reply_filter()) {
            (Who::One, Some(filter)) => Replies::One(filter),
            (Who::Each, Some(filter)) => Replies::Each(filter),
            (Who::Coordinator, Some(filter)) => Replies::Coordinator(filter),
            (Who::Nobody, _) | (_, None) => Replies::Nobody,
        }
    }

    /// Returns what a refusal of this request shows, if there is one. A refusal is another
    /// message's reply.
    #[inline]
    pub fn refusal(&self) -> Option<Filter> {
        self.exchange.refusal.filter(|_| self.refusal != IdFilter::NONE).map(|refusal| refusal.narrowed(self.refusal))
    }

    #[inline]
    fn reply_filter(&self) -> Option<Filter> {
        self.exchange.reply.filter(|_| self.reply != IdFilter::NONE).map(|reply| reply.narrowed(self.reply))
    }

    /// Returns the same request, whatever its replies carry.
    pub const fn untyped(self) -> Request<P, ()> {
        let Self { frame, exchange, who, reply, refusal, .. } = self;
        Request { frame, exchange, who, reply, refusal, carried: PhantomData }
    }

    /// Tests whether a frame can answer both requests.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let answers = |request: &Self| [request.replies().filter(), request.refusal()];
        let others = answers(other);
        let overlaps = |own: Filter| others.iter().flatten().any(|other| own.overlaps(other));
        answers(self).into_iter().flatten().any(overlaps)
    }

    /// Makes the frame say that more follow. Generated code calls it.
    #[doc(hidden)]
    pub fn followed(mut self, continuation: &Continuation) -> Self {
        self.frame = continuation.put(&self.frame);
        self
    }
}

impl<P: Protocol, R> Request<P, R> {
    /// Decodes a frame if it answers this request, even with an error. Returns `None` for any other
    /// frame.
    #[inline]
    pub fn reply(&self, frame: &impl embedded_can::Frame) -> Option<Reply<P, R>>
    where
        R: Layout,
    {
        Some(match self.answer(frame)? {
            (Answer::Values(selectors), frame) => {
                Reply::decode(selectors, P::LENGTH.unwrap_or(self.exchange.length).into(), frame)
            }
            (Answer::Refusal(selectors), frame) => Reply::refused(selectors, frame),
        })
    }

    /// Tests whether a frame answers this request, even with an error.
    pub fn is_reply(&self, frame: &impl embedded_can::Frame) -> bool {
        self.answer(frame).is_some()
    }

    /// Tells whether a frame that answers this request refuses it. Returns `None` for any other frame.
    pub(crate) fn refuses(&self, frame: &impl embedded_can::Frame) -> Option<bool> {
        Some(match self.answer(frame)? {
            (Answer::Refusal(_), _) => true,
            (Answer::Values(selectors), frame) => has_error::<P>(selectors, &frame),
        })
    }

    /// Copies a frame that answers this request, and says how. Most frames on a bus fail at the identifier, which is
    /// tested first.
    #[inline(always)]
    fn answer(&self, frame: &impl embedded_can::Frame) -> Option<(Answer, Frame)> {
        let id = own_id::<P>(frame)?;
        let (is_reply, is_refusal) = (self.reply.matches(id), P::REFUSALS && self.refusal.matches(id));
        if !(is_reply || is_refusal) || !is_to_controller::<P>(id) {
            return None;
        }
        let frame = Frame::copied(id, P::FRAME.is_extended(), None, frame)?;
        let selectors = |filter: Option<&Filter>| selectors_of::<P>(filter, &frame);
        let refusal = is_refusal.then(|| selectors(self.exchange.refusal)).flatten().map(Answer::Refusal);
        let reply = || is_reply.then(|| selectors(self.exchange.reply.as_ref())).flatten().map(Answer::Values);
        Some((refusal.or_else(reply)?, frame))
    }
}

/// Returns the selectors in the data of a frame whose data shows what a filter requires.
#[inline(always)]
fn selectors_of<P: Protocol>(filter: Option<&Filter>, frame: &Frame) -> Option<&'static [Selector]> {
    if !P::DATA_SELECTORS {
        return Some(&[]);
    }
    filter.filter(|filter| filter.matches_data(&frame.bytes())).map(Filter::data_selectors)
}

/// How a frame with some selectors in its data answers a request.
enum Answer {
    /// As the reply.
    Values(&'static [Selector]),
    /// As another message, which refuses the request.
    Refusal(&'static [Selector]),
}

impl<P, R> fmt::Debug for Request<P, R> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fields = formatter.debug_struct("Request");
        fields
            .field("frame", &self.frame)
            .field("replies", &self.replies())
            .field("refusal", &self.refusal())
            .finish_non_exhaustive()
    }
}

impl<P, R> Clone for Request<P, R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<P, R> Copy for Request<P, R> {}
