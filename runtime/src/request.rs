//! Requests, and the frames that answer them.

use core::fmt;
use core::marker::PhantomData;
use core::ptr;

use crate::address::{AddressType, Addressing, Kind, Mode, Pattern, Who};
use crate::plumbing::Continuation;
use crate::reply::answer;
use crate::{Error, Filter, Frame, Layout, Payload, Protocol, Reply};

/// A target that a request of a protocol can address.
pub trait Destination: Copy {
    /// The messages of the protocol.
    type Protocol: Protocol;

    /// Returns the mode as an index into [`Protocol::MODES`].
    fn mode(self) -> usize;

    /// Returns the address, if the mode lets the caller choose one.
    fn number(self) -> Option<i32>;
}

/// A target, and the sender's own address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Route<T> {
    target: T,
    sender: Option<i32>,
}

impl<T: Destination> From<T> for Route<T> {
    fn from(target: T) -> Self {
        Self { target, sender: None }
    }
}

impl<T: Destination> Route<T> {
    /// Returns the route from a sender's own address.
    pub const fn new(target: T, sender: i32) -> Self {
        Self { target, sender: Some(sender) }
    }

    /// Forgets the protocol, so that all messages share the code behind it.
    fn choice(&self) -> Choice {
        let mode = T::Protocol::MODES.get(self.target.mode());
        Choice { index: self.target.mode(), mode, target: self.target.number(), sender: self.sender }
    }
}

/// The mode and the addresses that a route chooses.
struct Choice {
    index: usize,
    mode: Option<&'static Mode>,
    target: Option<i32>,
    sender: Option<i32>,
}

impl Choice {
    /// Returns the number that a kind of address has in a request.
    fn number(&self, kind: &AddressType) -> i32 {
        let target = self.mode.and_then(|mode| mode.target);
        let chosen = if target.is_some_and(|target| target.is(kind)) { self.target } else { self.sender };
        chosen.unwrap_or(kind.sent_number())
    }
}

/// How a message travels by one access: its frames, what they show, and who answers.
#[derive(Clone, Copy, Debug)]
pub struct Exchange {
    message: &'static str,
    access: &'static str,
    length: u8,
    has_values: bool,
    answers: &'static [Option<Who>],
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
            answers,
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
        Self { answers, ..self }
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

    /// Returns the number of data bytes.
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
    pub(crate) fn is_of(&self, model: Option<u8>) -> bool {
        self.models.is_empty() || model.is_none_or(|model| self.models.contains(&model))
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

    /// Tests whether this is the same access to the same message.
    pub(crate) fn is(&self, other: &Self) -> bool {
        ptr::eq(self, other) || (self.message, self.access) == (other.message, other.access)
    }

    /// Returns the addressing mode that an identifier shows.
    pub(crate) fn addressing(&self, modes: &'static [Mode], kind: Kind, id: u32) -> Option<Addressing> {
        Addressing::find(modes, self.answers, kind, id)
    }

    /// Builds the request that carries `message`. Generated code calls it.
    ///
    /// # Errors
    ///
    /// Refuses a mode that the message does not have, an address that the document does not name, and values outside
    /// their limits.
    #[doc(hidden)]
    pub fn request_to<T: Destination, R>(
        &self,
        route: impl Into<Route<T>>,
        message: &impl Layout,
    ) -> Result<Request<T::Protocol, R>, Error> {
        let choice = route.into().choice();
        let built = self.built(&choice, None, &|payload| message.encode(payload));
        built.map(|built| Request { built, reply: PhantomData })
    }

    /// Builds the request that carries `message` to a device model. Generated code calls it.
    ///
    /// # Errors
    ///
    /// The same as [`request_to`](Self::request_to), within the limits of the model.
    #[doc(hidden)]
    pub fn request_within<T: Destination, R>(
        &self,
        model: impl Into<u8>,
        route: impl Into<Route<T>>,
        message: &impl Layout,
    ) -> Result<Request<T::Protocol, R>, Error> {
        let choice = route.into().choice();
        let built = self.built(&choice, Some(model.into()), &|payload| message.encode(payload));
        built.map(|built| Request { built, reply: PhantomData })
    }

    /// Builds a request whose values `encode` writes. All messages share this code.
    fn built(
        &self,
        choice: &Choice,
        model: Option<u8>,
        encode: &dyn Fn(&mut Payload) -> Result<(), Error>,
    ) -> Result<Built, Error> {
        let Addressed { request: filter, replies, refusal } = self.addressed(choice)?;
        let mut payload = Payload::within_limits(self.message, filter.data_value()).for_model(model);
        encode(&mut payload)?;
        let frame = Frame::new_raw(filter.sent_id(), filter.is_extended(), *payload.data(), self.length);
        Ok(Built { frame, replies, refusal })
    }

    /// Returns what the request and its replies show.
    fn addressed(&self, choice: &Choice) -> Result<Addressed, Error> {
        let (mode, who, pattern, request) = self.way(choice)?;
        for address in pattern.addresses {
            address.kind().documented(choice.number(address.kind()))?;
        }
        let filter = pattern.narrow(request, |kind| Some(choice.number(kind)));
        let number = |kind: &AddressType| pattern.has(kind).then(|| choice.number(kind));
        let replies = self.replies(mode, who, number);
        let refusal = self.refusal.zip(mode.reply(who)).map(|(refusal, pattern)| pattern.narrow(refusal, number));
        Ok(Addressed { request: filter, replies, refusal })
    }

    fn way(&self, choice: &Choice) -> Result<(&'static Mode, Who, &'static Pattern, &Filter), Error> {
        let mode = choice.mode;
        let who = self.answers.get(choice.index).copied().flatten();
        match (mode, who, mode.and_then(|mode| mode.request.as_ref()), &self.request) {
            (Some(mode), Some(who), Some(pattern), Some(request)) => Ok((mode, who, pattern, request)),
            _ => Err(self.no_mode(mode)),
        }
    }

    pub(crate) fn no_mode(&self, mode: Option<&Mode>) -> Error {
        Error::Mode { message: self.message, access: self.access, mode: mode.map(|mode| mode.name) }
    }

    fn replies(&self, mode: &Mode, who: Who, number: impl Fn(&AddressType) -> Option<i32>) -> Replies {
        let filter = self.reply.as_ref().zip(mode.reply(who)).map(|(reply, pattern)| pattern.narrow(reply, number));
        match (who, filter) {
            (Who::One, Some(filter)) => Replies::One(filter),
            (Who::Each, Some(filter)) => Replies::Each(filter),
            (Who::Coordinator, Some(filter)) => Replies::Coordinator(filter),
            _ => Replies::Nobody,
        }
    }
}

/// What a request to an address shows, and what answers it.
struct Addressed {
    request: Filter,
    replies: Replies,
    refusal: Option<Filter>,
}

const fn narrowed(filter: Option<Filter>, own: Filter) -> Option<Filter> {
    match filter {
        Some(filter) => Some(filter.and(own)),
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
    pub const fn filter(&self) -> Option<&Filter> {
        match self {
            Self::Nobody => None,
            Self::One(filter) | Self::Each(filter) | Self::Coordinator(filter) => Some(filter),
        }
    }
}

/// What the requests of all messages share.
#[derive(Clone, Copy, Debug)]
struct Built {
    frame: Frame,
    replies: Replies,
    refusal: Option<Filter>,
}

/// A request ready to be sent, whose replies carry `R`.
#[must_use = "a request is only a frame; send it"]
pub struct Request<P, R> {
    built: Built,
    reply: PhantomData<fn() -> (P, R)>,
}

impl<P, R> Request<P, R> {
    /// Returns the frame to send.
    #[must_use]
    pub const fn frame(&self) -> &Frame {
        &self.built.frame
    }

    /// Returns which replies it gets.
    pub const fn replies(&self) -> &Replies {
        &self.built.replies
    }

    /// Returns what a refusal of this request shows, if there is one. A refusal is another
    /// message's reply.
    pub const fn refusal(&self) -> Option<&Filter> {
        self.built.refusal.as_ref()
    }

    /// Makes the frame say that more follow. Generated code calls it.
    #[doc(hidden)]
    pub fn followed(mut self, continuation: &Continuation) -> Self {
        self.built.frame = continuation.put(&self.built.frame);
        self
    }
}

impl<P: Protocol, R> Request<P, R> {
    /// Decodes a frame if it answers this request, even with an error. Returns `None` for any other
    /// frame.
    pub fn reply(&self, frame: &impl embedded_can::Frame) -> Option<Reply<P, R>>
    where
        R: Layout,
    {
        let filter = self.built.replies.filter()?;
        let refused = self.refusal().and_then(|refusal| Some((refusal, answer::<P>(refusal, frame)?)));
        if let Some((refusal, frame)) = refused {
            return Some(Reply::refused(refusal.data_selectors(), frame));
        }
        let frame = answer::<P>(filter, frame)?;
        Some(Reply::decode(filter.data_selectors(), self.built.frame.length(), frame))
    }

    /// Tests whether a frame answers this request, even with an error.
    pub fn is_reply(&self, frame: &impl embedded_can::Frame) -> bool {
        let mut filters = self.built.replies.filter().into_iter().chain(self.refusal());
        filters.any(|filter| answer::<P>(filter, frame).is_some())
    }
}

impl<P, R> fmt::Debug for Request<P, R> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Built { frame, replies, refusal } = &self.built;
        let mut fields = formatter.debug_struct("Request");
        fields.field("frame", frame).field("replies", replies).field("refusal", refusal).finish()
    }
}

impl<P, R> Clone for Request<P, R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<P, R> Copy for Request<P, R> {}
