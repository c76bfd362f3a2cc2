//! Recognising frames.

use core::fmt::{self, Debug};

use embedded_can::Frame as _;

use crate::frame::{padded, raw_id};
use crate::{Addressing, Data, Error, Exchange, Filter, Frame, Kind, Layout, Mode, Payload, Place, Reading, Selector};

/// A protocol, implemented by the enum of its messages.
pub trait Protocol: Copy + Debug + 'static {
    /// The fields of the identifier.
    type Identifier: IdentifierFields;
    /// What every frame shows.
    const FRAME: Filter;
    /// What a reply shows that is no error reply.
    const NORMAL: Filter;
    /// All addressing modes.
    const MODES: &'static [Mode];
    /// Every frame of every message.
    const SHAPES: &'static [Shape<Self>];

    /// Returns what the message carries.
    fn layout(&self) -> &dyn Layout;
}

/// The identifier of a protocol, split into its fields.
pub trait IdentifierFields: Copy + Debug + PartialEq {
    /// Splits an identifier.
    fn from_raw(id: u32) -> Self;

    /// Joins the fields; bits that a field cannot hold are dropped.
    fn to_raw(self) -> u32;

    /// Tests whether an identifier belongs to somebody else on the bus.
    fn is_foreign(id: u32) -> bool;

    /// Tests whether an identifier goes towards a module.
    fn is_to_module(id: u32) -> bool;

    /// Tests whether an identifier goes towards the controller.
    fn is_to_controller(id: u32) -> bool;
}

/// One kind of frame of one message.
#[derive(Clone, Copy, Debug)]
pub struct Shape<M> {
    exchange: &'static Exchange,
    kind: Kind,
    decode: fn(&Data) -> M,
}

impl<M> Shape<M> {
    /// Returns the requests of an exchange.
    pub const fn request(exchange: &'static Exchange, decode: fn(&Data) -> M) -> Self {
        Self { exchange, kind: Kind::Request, decode }
    }

    /// Returns the replies of an exchange.
    pub const fn reply(exchange: &'static Exchange, decode: fn(&Data) -> M) -> Self {
        Self { exchange, kind: Kind::Reply, decode }
    }

    /// Returns the reports of an exchange.
    pub const fn report(exchange: &'static Exchange, decode: fn(&Data) -> M) -> Self {
        Self { exchange, kind: Kind::Report, decode }
    }

    fn filter(&self) -> Option<Filter> {
        self.exchange.filter(self.kind)
    }

    fn shows(&self, test: impl FnOnce(&Filter) -> bool) -> bool {
        self.filter().is_some_and(|filter| test(&filter))
    }
}

/// Why a frame is not recognised, in the order of the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Problem {
    /// It is no classic data frame.
    Frame,
    /// It belongs to somebody else on the bus.
    Foreign,
    /// The identifier has the wrong width or a wrong fixed bit, or does not show its direction.
    Identifier,
    /// No message has these selectors.
    UnknownMessage,
    /// It has too few or too many data bytes.
    Length,
}

impl fmt::Display for Problem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Frame => "it is no classic data frame",
            Self::Foreign => "it belongs to somebody else on the bus",
            Self::Identifier => "the identifier is none of this protocol",
            Self::UnknownMessage => "no message has these selectors",
            Self::Length => "it has too few or too many data bytes",
        })
    }
}

impl core::error::Error for Problem {}

/// A recognised frame.
#[derive(Clone, Copy, Debug)]
pub struct Received<P: Protocol> {
    /// The identifier.
    pub identifier: P::Identifier,
    /// The message.
    pub message: P,
    shape: &'static Shape<P>,
    frame: Frame,
}

impl<P: Protocol> Received<P> {
    /// Recognises a frame.
    ///
    /// # Errors
    ///
    /// Says why the frame is not recognised; the tests come in the order of [`Problem`], except that selectors in the
    /// data are looked at once the length is known to be right.
    pub fn decode(frame: &impl embedded_can::Frame) -> Result<Self, Problem> {
        let frame = classic(frame).ok_or(Problem::Frame)?;
        let is_request = direction::<P>(&frame)?;
        let shape = find::<P>(is_request, &frame)?;
        let identifier = P::Identifier::from_raw(frame.raw_id());
        Ok(Self { identifier, message: (shape.decode)(&frame.bytes()), shape, frame })
    }

    /// Returns the frame as it was received.
    pub const fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Returns what the frame is for.
    pub const fn kind(&self) -> Kind {
        self.shape.kind
    }

    /// Returns how the message travels: its name, its access, its selectors.
    pub const fn exchange(&self) -> &'static Exchange {
        self.shape.exchange
    }

    /// Returns the addressing mode that the identifier shows.
    pub fn addressing(&self) -> Option<Addressing> {
        self.shape.exchange.addressing(P::MODES, self.shape.kind, self.identifier.to_raw())
    }

    /// Tests whether the frame is an error reply.
    pub fn is_error_reply(&self) -> bool {
        self.shape.kind != Kind::Request && !self.is_normal()
    }

    fn is_normal(&self) -> bool {
        let has_normal_selectors = |filter: Filter| filter.has_normal_selectors(self.frame.bytes());
        P::NORMAL.matches(&self.frame) && self.shape.filter().is_none_or(has_normal_selectors)
    }

    /// Returns the selectors in the data, each with its raw value.
    pub fn selectors(&self) -> impl Iterator<Item = (&'static Selector, u64)> {
        let data = self.frame.bytes();
        let selectors = self.shape.filter().map_or(&[][..], |filter| filter.data_selectors());
        selectors.iter().map(move |selector| (selector, selector.place.get(&data)))
    }

    /// Shows the signals, by first byte.
    pub fn visit(&self, mut visitor: impl FnMut(Reading<'_>)) {
        for signal in self.message.layout().signals() {
            signal.read(&self.frame.bytes(), &mut visitor);
        }
    }

    /// Returns the set bits that neither signals nor selectors cover.
    pub fn reserved(&self) -> Data {
        let selectors = self.selectors().map(|(selector, _)| selector.place);
        let signals = self.message.layout().signals().iter().map(|signal| signal.place());
        selectors.chain(signals).fold(self.frame.bytes(), cleared)
    }

    /// Builds the frame anew, of [`identifier`](Self::identifier) and [`message`](Self::message).
    ///
    /// # Errors
    ///
    /// Refuses what the signals cannot hold and identifiers of another message; in a request also values outside their
    /// limits, addressing modes that the message does not have, and addresses that the document does not name.
    pub fn encode(&self) -> Result<Frame, Error> {
        let id = self.identifier.to_raw();
        let frame = Frame::new_raw(id, P::FRAME.is_extended(), self.data()?, self.exchange().data_length());
        let again = Self::decode(&frame).ok().filter(|again| again.identifier == self.identifier);
        let same = |again: &Self| core::ptr::eq(again.shape, self.shape);
        let again = again.filter(same).ok_or(Error::Identifier { message: self.exchange().message(), id })?;
        if self.kind() == Kind::Request {
            again.check_addressing(id)?;
        }
        Ok(frame)
    }

    /// Writes the signals over the frame as it was received.
    fn data(&self) -> Result<Data, Error> {
        let signals = self.message.layout().signals().iter();
        let data = signals.fold(self.frame.bytes(), |data, signal| cleared(data, signal.place()));
        let is_request = self.kind() == Kind::Request;
        let new = if is_request { Payload::within_limits } else { Payload::new };
        let mut payload = new(self.exchange().message(), data);
        self.message.layout().encode(&mut payload)?;
        Ok(*payload.data())
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

/// Copies a classic data frame.
fn classic(frame: &impl embedded_can::Frame) -> Option<Frame> {
    let (id, extended) = raw_id(frame.id());
    let length = u8::try_from(frame.data().len()).ok()?;
    let is_classic = !frame.is_remote_frame() && length <= 8;
    is_classic.then(|| Frame::new_raw(id, extended, padded(frame.data()), length))
}

/// Tests the identifier, and tells whether it goes towards a module.
fn direction<P: Protocol>(frame: &Frame) -> Result<bool, Problem> {
    let id = frame.raw_id();
    let has_width = frame.is_extended() == P::FRAME.is_extended();
    if has_width && P::Identifier::is_foreign(id) {
        return Err(Problem::Foreign);
    }
    match (P::Identifier::is_to_module(id), P::Identifier::is_to_controller(id)) {
        (to_module, to_controller) if has_width && P::FRAME.matches_id(id) && to_module != to_controller => {
            Ok(to_module)
        }
        _ => Err(Problem::Identifier),
    }
}

/// Finds the kind of frame whose constants all hold, and among several the one whose addresses fit best.
fn find<P: Protocol>(is_request: bool, frame: &Frame) -> Result<&'static Shape<P>, Problem> {
    let id = frame.raw_id();
    let by_id =
        |shape: &&Shape<_>| (shape.kind == Kind::Request) == is_request && shape.shows(|filter| filter.matches_id(id));
    let by_length = |shape: &&Shape<_>| usize::from(shape.exchange.data_length()) == frame.dlc();
    let by_data = |shape: &&Shape<_>| shape.shows(|filter| filter.matches_data(&frame.bytes()));
    if !P::SHAPES.iter().any(|shape| by_id(&shape)) {
        return Err(Problem::UnknownMessage);
    }
    if !P::SHAPES.iter().filter(by_id).any(|shape| by_length(&shape)) {
        return Err(Problem::Length);
    }
    let shapes = P::SHAPES.iter().filter(by_id).filter(by_length).filter(by_data);
    best::<P>(shapes, id).ok_or(Problem::UnknownMessage)
}

fn best<P: Protocol>(mut shapes: impl Iterator<Item = &'static Shape<P>>, id: u32) -> Option<&'static Shape<P>> {
    let rank =
        |shape: &Shape<P>| shape.exchange.addressing(P::MODES, shape.kind, id).map(|addressing| addressing.rank());
    let first = shapes.next()?;
    Some(shapes.fold(first, |best, next| if rank(next) > rank(best) { next } else { best }))
}
