//! Recognised frames.

mod display;

use core::mem::discriminant;

use crate::incoming::Incoming;
use crate::layout::{Signals, Task};
use crate::plumbing::{Headed, Way};
use crate::protocol::head;
use crate::reply::{error_code, has_error, selected};
use crate::status::set_bits;
use crate::{
    Addressed, Addressing, AnySignal, Data, Destination, Error, Exchange, Failure, Frame, IdentifierFields, Kind,
    Layout, Meaning, Payload, Place, Problem, Protocol, Reading, Route, Selector, Severity, StatusBit,
};

/// Stands for the number of no device model.
const NO_MODEL: u16 = 1 << 8;

/// A recognised frame.
#[derive(Clone, Copy, Debug)]
pub struct Received<P: Protocol> {
    content: P,
    exchange: &'static Exchange,
    frame: Frame,
    /// The number of the device model, or [`NO_MODEL`]. It is written at once with the bytes beside it.
    model: u16,
    kind: Kind,
    /// Whether the content or the identifier is another than that of the received frame.
    is_other: bool,
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
    pub(crate) fn decode_by(model: Option<u8>, frame: &impl embedded_can::Frame) -> Result<Self, Problem> {
        let incoming = Incoming::read::<P>(model, frame)?;
        let (id, frame) = (incoming.raw_id(), incoming.of::<P>());
        if P::IN_ONE_PLACE { frame.to(head::<P>(id)) } else { P::Identifier::head(id, frame) }
    }

    #[inline(always)]
    pub(crate) fn new(content: P, exchange: &'static Exchange, kind: Kind, frame: Frame, model: Option<u8>) -> Self {
        let model = model.map_or(NO_MODEL, u16::from);
        Self { content, exchange, frame, model, kind, is_other: false }
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
        P::Identifier::FROM_RAW(self.frame.raw_id())
    }

    /// Returns the same message under another identifier. [`encode`](Self::encode) makes its frame.
    #[must_use]
    pub fn with_identifier(self, identifier: P::Identifier) -> Self {
        let frame = self.frame.with_id(P::Identifier::TO_RAW(identifier).into());
        Self { is_other: self.is_other || frame != self.frame, frame, ..self }
    }

    /// Returns other values under the same identifier. [`encode`](Self::encode) makes their frame.
    #[must_use]
    pub fn with_content(self, content: P) -> Self {
        let is_other = self.is_other || discriminant(&self.content) != discriminant(&content);
        Self { content, is_other, ..self }
    }

    /// Returns the frame as it was received, or under the identifier that it was given since.
    pub const fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Returns what the frame is for.
    pub const fn kind(&self) -> Kind {
        self.kind
    }

    /// Tests whether the frame goes to a module: a request, or a report of the controller. If it does,
    /// it keeps to the limits of what may be sent.
    pub fn is_to_module(&self) -> bool {
        self.exchange.is_to_module::<P>(self.kind)
    }

    /// Returns how the message travels, with its name, its access and its selectors.
    pub const fn exchange(&self) -> &'static Exchange {
        self.exchange
    }

    /// Returns the addressing mode that the identifier shows.
    pub fn addressing(&self) -> Option<Addressing> {
        self.exchange.addressing::<P>(self.kind, self.frame.raw_id())
    }

    /// Returns the number of the module that sent the frame, or that it goes to: its address in the
    /// way that the document counts.
    ///
    /// It is `None` where the identifier does not show one module, as in
    /// - a request to many modules,
    /// - the reply of one module for all,
    /// - a mode that the message does not have.
    pub fn node(&self) -> Option<i32> {
        P::node(&self.way()?)
    }

    /// Returns the module that has sent the frame, if the identifier shows it.
    pub(crate) fn sender(&self) -> Option<u8> {
        let node = self.node().filter(|_| !self.is_to_module())?;
        u8::try_from(node).ok()
    }

    /// Returns the reply of this exchange that carries `content`. Encoding tests that it is one.
    pub(crate) const fn reply_with(&self, frame: Frame, content: P) -> Self {
        Self { content, frame, kind: Kind::Reply, is_other: true, ..*self }
    }

    /// Returns the device model for which the frame was recognised, by number.
    #[inline(always)]
    pub(crate) fn model(&self) -> Option<u8> {
        u8::try_from(self.model).ok()
    }

    fn way(&self) -> Option<Way> {
        self.exchange.way::<P>(self.kind, self.frame.raw_id())
    }

    /// Tests whether the frame goes to the controller and shows an error code.
    pub fn is_error_reply(&self) -> bool {
        !self.is_to_module() && has_error::<P>(self.data_selectors(), &self.frame)
    }

    /// Returns the error code of an error reply, as [`refuse`](Self::refuse) takes it.
    pub fn error_code(&self) -> Option<u64> {
        if self.is_to_module() { None } else { error_code::<P>(self.data_selectors(), &self.frame) }
    }

    /// Tests whether a device answers that it starts, and can be asked later.
    pub fn is_starting(&self) -> bool {
        P::STARTING.is_some() && self.error_code() == P::STARTING
    }

    fn data_selectors(&self) -> &'static [Selector] {
        if !P::DATA_SELECTORS {
            return &[];
        }
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
    ///
    /// It leaves out what the device model does not have, unless bits show it.
    pub fn visit(&self, mut visitor: impl FnMut(Reading<'_>)) {
        let is_of_error_reply = self.is_error_reply();
        for signal in self.shown() {
            signal.read(&self.frame.bytes(), &mut |reading| visitor(Reading { is_of_error_reply, ..reading }));
        }
    }

    /// Returns the signals that the frame has, and the device model too, unless bits show others.
    fn shown(&self) -> impl Iterator<Item = &'static dyn AnySignal> {
        let (data, length, model) = (self.frame.bytes(), self.frame.length(), self.model());
        let signals = self.signals().iter().filter(move |signal| signal.place().is_within(length));
        signals.copied().filter(move |signal| !signal.is_hidden(&data, model))
    }

    /// Returns the set bits of all status words that have a name, whatever their severity. An error
    /// reply has none, since its values mean nothing.
    pub fn conditions(&self) -> impl Iterator<Item = &'static StatusBit> {
        let (data, is_of_error_reply) = (self.frame.bytes(), self.is_error_reply());
        let words =
            self.shown().filter(move |_| !is_of_error_reply).filter_map(move |signal| status_word(signal, data));
        words.flat_map(|(bits, known)| set_bits(bits, known))
    }

    /// Returns the set bits that report a defect.
    pub fn faults(&self) -> impl Iterator<Item = &'static StatusBit> {
        self.conditions().filter(|bit| bit.severity == Some(Severity::Fault))
    }

    /// Returns the set bits that warn of something that the device recovers from.
    pub fn alarms(&self) -> impl Iterator<Item = &'static StatusBit> {
        self.conditions().filter(|bit| bit.severity == Some(Severity::Alarm))
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
    #[inline]
    pub fn encode(&self) -> Result<Frame, Error> {
        let plain = if self.is_plain() { self.content.run(Writing(self)).ok() } else { None };
        let (data, length) = match plain {
            Some(written) => written,
            None => self.checked()?,
        };
        Ok(self.frame.with(data, P::LENGTH.or(length).unwrap_or(self.exchange.data_length())))
    }

    /// Tests whether only the values can be refused.
    #[inline(always)]
    fn is_plain(&self) -> bool {
        if self.is_other {
            return false;
        }
        if !self.is_to_module() {
            return true;
        }
        let is_offered = self.exchange.is_offered(P::Identifier::documented_modes(self.frame.raw_id()));
        is_offered && (self.model == NO_MODEL || self.exchange.is_of_each())
    }

    /// Writes the values with all tests.
    #[cold]
    #[inline(never)]
    fn checked(&self) -> Result<(Data, Option<u8>), Error> {
        let (data, length) = self.content.run(Writing(self))?;
        let frame = self.frame.with(data, P::LENGTH.or(length).unwrap_or(self.exchange.data_length()));
        if self.is_other {
            self.check_recognised(frame)?;
        }
        self.check_request().map(|()| (data, length))
    }

    /// Refuses a frame that would not be recognised as what it was made from.
    ///
    /// A re-encoded frame with the received identifier is always recognised, because signals never share bits with
    /// selectors.
    #[cold]
    fn check_recognised(&self, frame: Frame) -> Result<(), Error> {
        match Self::decode_by(self.model(), &frame) {
            Ok(again) if again.is_like(self) => Ok(()),
            _ => Err(Error::Identifier { message: self.exchange.message(), id: self.frame.raw_id() }),
        }
    }

    /// Tests whether this is the same kind of frame of the same message under the same identifier.
    fn is_like(&self, other: &Self) -> bool {
        let is_same_variant = discriminant(&self.content) == discriminant(&other.content);
        let is_same_frame = is_same_variant && self.kind == other.kind && self.exchange.is(other.exchange);
        is_same_frame && self.identifier() == other.identifier()
    }

    /// Returns the received data, over which the signals are written. Beyond their end, bits that nothing names are as
    /// they are sent.
    #[inline(always)]
    fn payload(&self) -> Payload {
        let beyond = if P::LENGTH.is_some() { [0; 8] } else { self.exchange.ones::<P>(self.kind) };
        let payload = Payload::of(self.exchange, self.frame.bytes_before(beyond)).for_model(self.model());
        let payload = payload.received_with(self.frame.byte_count());
        if self.is_to_module() { payload.keeping_limits() } else { payload }
    }

    /// Refuses a request in a wrong addressing mode, to an undocumented address, or of a message
    /// that the device model does not have.
    fn check_request(&self) -> Result<(), Error> {
        if !self.is_to_module() {
            return Ok(());
        }
        if !self.exchange.is_offered(P::Identifier::documented_modes(self.frame.raw_id())) {
            self.check_addressing()?;
        }
        let is_of_model = self.exchange.is_of(self.model());
        if is_of_model { Ok(()) } else { Err(Error::Model { message: self.exchange.message() }) }
    }

    fn check_addressing(&self) -> Result<(), Error> {
        match self.addressing() {
            Some(addressing) if addressing.is_offered() => addressing.documented(self.frame.raw_id()),
            other => Err(self.exchange.no_mode(other.map(|addressing| addressing.mode()))),
        }
    }
}

impl<P: Addressed> Received<P> {
    /// Returns whom a request or a report of the controller addresses. Of a reply it is whom its
    /// request addressed, and of a report whom a request in the same mode would address.
    ///
    /// An address that the document does not name is shown, too. It is `None` where the identifier does
    /// not show it, as in
    /// - the reply of one module to a request that went to its group,
    /// - a mode without requests,
    /// - a mode that the message does not have.
    pub fn target(&self) -> Option<P::Target> {
        self.route().map(|route| route.target())
    }

    /// Returns the [`target`](Self::target), and the address of the controller that sent the request.
    pub fn route(&self) -> Option<Route<P::Target>> {
        P::Target::shown(&self.way()?)
    }
}

/// Writes the values of a message over the data that were received. It returns the data, and their number if the message
/// can have several.
///
/// Each message has a payload of its own, so none has to be in memory.
struct Writing<'a, P: Protocol>(&'a Received<P>);

impl<P: Protocol> Task for Writing<'_, P> {
    type Output = Result<(Data, Option<u8>), Error>;

    #[inline(always)]
    fn run<L: Layout>(self, values: &L) -> Self::Output {
        let mut payload = self.0.payload();
        values.encode(&mut payload)?;
        Ok((*payload.data(), payload.length()))
    }
}

/// Returns the bits of a status word, and those that have a name.
fn status_word(signal: &dyn AnySignal, data: Data) -> Option<(u64, &'static [StatusBit])> {
    let mut word = None;
    signal.read(&data, &mut |reading| {
        if let Meaning::Status(bits, known) = reading.meaning {
            word = Some((bits, known));
        }
    });
    word
}

fn cleared(mut data: Data, place: Place) -> Data {
    place.put(&mut data, 0);
    data
}
