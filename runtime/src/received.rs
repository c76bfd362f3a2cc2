//! Recognised frames.

use core::mem::discriminant;

use crate::frame::classic;
use crate::layout::Signals;
use crate::protocol::{Recognised, is_to_module};
use crate::reply::{has_error, selected};
use crate::{
    Addressing, AnySignal, Data, Error, Exchange, Failure, Frame, IdentifierFields, Kind, Payload, Place, Problem,
    Protocol, Reading, Selector,
};

/// A recognised frame.
#[derive(Clone, Copy, Debug)]
pub struct Received<P: Protocol> {
    content: P,
    exchange: &'static Exchange,
    kind: Kind,
    model: Option<u8>,
    /// Another identifier than the frame's.
    identifier: Option<P::Identifier>,
    frame: Frame,
}

impl<P: Protocol> Received<P> {
    /// Recognises a frame. If messages look the same, it is the first one in the spec.
    ///
    /// # Errors
    ///
    /// Says why the frame is not recognised. The tests have the order of [`Problem`], with one
    /// exception: selectors in the data are tested after the length.
    #[inline]
    pub fn decode(frame: &impl embedded_can::Frame) -> Result<Self, Problem> {
        Self::decode_by(None, frame)
    }

    /// Recognises a frame of a device model. If messages look the same, it is the one that the
    /// model has.
    ///
    /// # Errors
    ///
    /// The same as [`decode`](Self::decode).
    #[inline]
    pub fn decode_for(model: impl Into<u8>, frame: &impl embedded_can::Frame) -> Result<Self, Problem> {
        Self::decode_by(Some(model.into()), frame)
    }

    #[inline]
    fn decode_by(model: Option<u8>, frame: &impl embedded_can::Frame) -> Result<Self, Problem> {
        let frame = classic(frame).ok_or(Problem::Frame)?;
        let is_request = is_to_module::<P>(&frame)?;
        match if is_request { P::request(&frame, model) } else { P::reply(&frame, model) } {
            Some(recognised) if recognised.has_length_of(&frame) => {
                let Recognised { exchange, kind, message: content } = recognised;
                Ok(Self { content, exchange, kind, model, identifier: None, frame })
            }
            _ => Err(problem::<P>(is_request, &frame)),
        }
    }

    /// Returns what a request asks for.
    #[must_use]
    pub fn request(&self) -> Option<&P> {
        (self.kind == Kind::Request).then_some(&self.content)
    }

    /// Returns what a reply says, or [`Failure::Error`] for an error reply.
    #[must_use]
    pub fn reply(&self) -> Option<Result<&P, Failure>> {
        let said = if self.is_error_reply() { Err(Failure::Error) } else { Ok(&self.content) };
        (self.kind == Kind::Reply).then_some(said)
    }

    /// Returns what a report says, unless it shows an error code.
    #[must_use]
    pub fn report(&self) -> Option<&P> {
        (self.kind == Kind::Report && !self.is_error_reply()).then_some(&self.content)
    }

    /// Returns the values of the frame, whatever its kind, for logs.
    ///
    /// This includes error replies, whose values mean nothing unless the document says so.
    pub const fn content(&self) -> &P {
        &self.content
    }

    /// Returns the identifier.
    #[inline]
    pub fn identifier(&self) -> P::Identifier {
        self.identifier.unwrap_or_else(|| P::Identifier::FROM_RAW(self.frame.raw_id()))
    }

    /// Returns the same message under another identifier. [`encode`](Self::encode) makes its frame.
    #[must_use]
    pub const fn with_identifier(self, identifier: P::Identifier) -> Self {
        Self { identifier: Some(identifier), ..self }
    }

    /// Returns other values under the same identifier. [`encode`](Self::encode) makes their frame.
    #[must_use]
    pub const fn with_content(self, content: P) -> Self {
        Self { content, ..self }
    }

    /// Returns the frame as it was received.
    pub const fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Returns what the frame is for.
    pub const fn kind(&self) -> Kind {
        self.kind
    }

    /// Returns how the message travels, with its name, its access and its selectors.
    pub const fn exchange(&self) -> &'static Exchange {
        self.exchange
    }

    /// Returns the addressing mode that the identifier shows.
    pub fn addressing(&self) -> Option<Addressing> {
        self.exchange.addressing(P::MODES, self.kind, P::Identifier::TO_RAW(self.identifier()))
    }

    /// Tests whether the frame goes to the controller and shows an error code.
    pub fn is_error_reply(&self) -> bool {
        !self.kind.is_to_module() && has_error::<P>(self.data_selectors(), &self.frame)
    }

    fn data_selectors(&self) -> &'static [Selector] {
        self.exchange.filter(self.kind).map_or(&[], |filter| filter.data_selectors())
    }

    /// Returns the selectors in the data, each with its raw value.
    pub fn selectors(&self) -> impl Iterator<Item = (&'static Selector, u64)> {
        selected(self.data_selectors(), self.frame)
    }

    /// Returns the signals, by first byte.
    pub fn signals(&self) -> &'static [&'static dyn AnySignal] {
        self.content.run(Signals)
    }

    /// Shows the signals to `visitor`, by first byte. Those of an error reply are marked, and have
    /// no value as a text.
    pub fn visit(&self, mut visitor: impl FnMut(Reading<'_>)) {
        let is_of_error_reply = self.is_error_reply();
        for signal in self.signals() {
            signal.read(&self.frame.bytes(), &mut |reading| visitor(Reading { is_of_error_reply, ..reading }));
        }
    }

    /// Returns the set bits that neither signals nor selectors cover.
    pub fn reserved(&self) -> Data {
        let selectors = self.selectors().map(|(selector, _)| selector.place);
        let signals = self.signals().iter().map(|signal| signal.place());
        selectors.chain(signals).fold(self.frame.bytes(), cleared)
    }

    /// Builds the frame again from [`identifier`](Self::identifier) and [`content`](Self::content).
    ///
    /// # Errors
    ///
    /// Refuses values that the signals cannot hold, and identifiers of another message.
    ///
    /// In a request it also refuses
    /// - values outside their limits,
    /// - messages that the device model does not have,
    /// - addressing modes that the message does not have,
    /// - addresses that the document does not name.
    pub fn encode(&self) -> Result<Frame, Error> {
        let id = P::Identifier::TO_RAW(self.identifier());
        let frame = Frame::new_raw(id, P::FRAME.is_extended(), self.data()?, self.exchange().data_length());
        match Self::decode_by(self.model, &frame) {
            Ok(again) if again.is_like(self) => again.check_request(id).map(|()| frame),
            _ => Err(Error::Identifier { message: self.exchange().message(), id }),
        }
    }

    /// Tests whether this is the same kind of frame of the same message under the same identifier.
    fn is_like(&self, other: &Self) -> bool {
        let is_same_variant = discriminant(&self.content) == discriminant(&other.content);
        let is_same_frame = is_same_variant && self.kind == other.kind && self.exchange.is(other.exchange);
        is_same_frame && self.identifier() == other.identifier()
    }

    /// Writes the signals over the received data.
    fn data(&self) -> Result<Data, Error> {
        let new = if self.kind.is_to_module() { Payload::within_limits } else { Payload::new };
        let mut payload = new(self.exchange().message(), self.frame.bytes()).for_model(self.model);
        self.content.run(&mut payload)?;
        Ok(*payload.data())
    }

    /// Refuses a request in a wrong addressing mode, to an undocumented address, or of a message
    /// that the device model does not have.
    fn check_request(&self, id: u32) -> Result<(), Error> {
        if !self.kind.is_to_module() {
            return Ok(());
        }
        self.check_addressing(id)?;
        let is_of_model = self.exchange.is_of(self.model);
        if is_of_model { Ok(()) } else { Err(Error::Model { message: self.exchange.message() }) }
    }

    fn check_addressing(&self, id: u32) -> Result<(), Error> {
        match self.addressing() {
            Some(addressing) if addressing.is_offered() => addressing.documented(id),
            other => Err(self.exchange().no_mode(other.map(|addressing| addressing.mode()))),
        }
    }
}

fn cleared(mut data: Data, place: Place) -> Data {
    place.put(&mut data, 0);
    data
}

/// Says whether the length or the selectors are wrong.
#[cold]
fn problem<P: Protocol>(is_request: bool, frame: &Frame) -> Problem {
    let lengths = if is_request { P::request_lengths } else { P::reply_lengths }(frame.raw_id());
    let is_right = lengths.iter().any(|length| usize::from(*length) == frame.length());
    if lengths.is_empty() || is_right { Problem::UnknownMessage } else { Problem::Length }
}
