//! Requests, and the frames that answer them.

use core::fmt;
use core::marker::PhantomData;

use crate::address::{Kind, Who};
use crate::filter::IdFilter;
use crate::plumbing::Continuation;
use crate::protocol::{is_to_controller, own_id};
use crate::reply::has_error;
use crate::{Destination, Error, Exchange, Filter, Frame, Layout, Payload, Protocol, Reply, Route, Selector};

impl Exchange {
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

    /// The same as [`request_to`](Self::request_to), for programs that are optimized for speed.
    ///
    /// # Errors
    ///
    /// The same.
    #[doc(hidden)]
    #[inline(always)]
    pub fn inlined_request_to<T: Destination, R>(
        &'static self,
        route: impl Into<Route<T>>,
        message: &impl Layout,
    ) -> Result<Request<T::Protocol, R>, Error> {
        self.inlined_built(route.into(), None, message)
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

    /// The same as [`request_within`](Self::request_within), for programs that are optimized for speed.
    ///
    /// # Errors
    ///
    /// The same.
    #[doc(hidden)]
    #[inline(always)]
    pub fn inlined_request_within<T: Destination, R>(
        &'static self,
        model: impl Into<u8>,
        route: impl Into<Route<T>>,
        message: &impl Layout,
    ) -> Result<Request<T::Protocol, R>, Error> {
        self.inlined_built(route.into(), Some(model.into()), message)
    }

    #[inline]
    fn built<T: Destination, R>(
        &'static self,
        route: Route<T>,
        model: Option<u8>,
        message: &impl Layout,
    ) -> Result<Request<T::Protocol, R>, Error> {
        self.inlined_built(route, model, message)
    }

    #[inline(always)]
    fn inlined_built<T: Destination, R>(
        &'static self,
        Route { target, sender }: Route<T>,
        model: Option<u8>,
        message: &impl Layout,
    ) -> Result<Request<T::Protocol, R>, Error> {
        let who = self.answers().get(target.mode()).copied().flatten();
        let (Some(who), Some(request)) = (who, self.filter(Kind::Request)) else {
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
        let (reply, refusal) = (shown(self.filter(Kind::Reply).as_ref()), shown(self.refusal()));
        Ok(Request { frame, exchange: self, who, reply, refusal, carried: PhantomData })
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
        self.exchange.refusal().filter(|_| self.refusal != IdFilter::NONE).map(|refusal| refusal.narrowed(self.refusal))
    }

    #[inline]
    fn reply_filter(&self) -> Option<Filter> {
        let reply = self.exchange.filter(Kind::Reply).filter(|_| self.reply != IdFilter::NONE)?;
        Some(reply.narrowed(self.reply))
    }

    /// Returns the same request, whatever its replies carry.
    pub const fn untyped(self) -> Request<P, ()> {
        let Self { frame, exchange, who, reply, refusal, .. } = self;
        Request { frame, exchange, who, reply, refusal, carried: PhantomData }
    }

    /// Returns the same request, to which no frame counts as an answer. So it waits for none, and none waits for it.
    pub(crate) fn unanswered(self) -> Self {
        Self { who: Who::Nobody, reply: IdFilter::NONE, refusal: IdFilter::NONE, ..self }
    }

    /// Tests whether a frame can answer both requests.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let answers = |request: &Self| [request.replies().filter(), request.refusal()];
        let others = answers(other);
        let overlaps = |own: Filter| others.iter().flatten().any(|other| own.overlaps(other));
        answers(self).into_iter().flatten().any(overlaps)
    }

    /// Tests whether each of several modules answers.
    pub(crate) fn has_many_answers(&self) -> bool {
        self.who == Who::Each && self.reply != IdFilter::NONE
    }

    /// Tests whether both carry the same message by the same access.
    pub(crate) fn is_of_same_exchange(&self, other: &Self) -> bool {
        self.exchange.is(other.exchange)
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

    /// Returns the number of the one module that it goes to.
    pub(crate) fn module(&self) -> Option<i32> {
        self.module_of(Kind::Request, self.frame.raw_id())
    }

    /// Returns the number of the module that sends an answer, if it is below 256.
    pub(crate) fn sender(&self, answer: &impl embedded_can::Frame) -> Option<u8> {
        u8::try_from(self.module_of(Kind::Reply, own_id::<P>(answer)?)?).ok()
    }

    fn module_of(&self, kind: Kind, id: u32) -> Option<i32> {
        P::node(&self.exchange.way::<P>(kind, id)?)
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
        let refusal = || selectors_of::<P>(|| self.exchange.refusal().copied(), &frame).map(Answer::Refusal);
        let values = || selectors_of::<P>(|| self.exchange.filter(Kind::Reply), &frame).map(Answer::Values);
        let refused = is_refusal.then(refusal).flatten();
        let answer = refused.or_else(|| is_reply.then(values).flatten());
        Some((answer?, frame))
    }
}

/// Returns the selectors in the data of a frame whose data shows what a filter requires.
#[inline(always)]
fn selectors_of<P: Protocol>(filter: impl FnOnce() -> Option<Filter>, frame: &Frame) -> Option<&'static [Selector]> {
    if !P::DATA_SELECTORS {
        return Some(&[]);
    }
    filter().filter(|filter| filter.matches_data(&frame.bytes())).map(|filter| filter.data_selectors())
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
