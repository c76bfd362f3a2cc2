//! Protocols: what generated code knows and recognises.

use core::fmt::{self, Debug};

use crate::frame::raw_id;
use crate::layout::Task;
use crate::plumbing::{Incoming, Shown, Way};
use crate::{AfterSilence, Destination, Entry, Filter, Mode, Received, Timing};

/// A protocol, implemented by the enum of its messages.
pub trait Protocol: Copy + Debug + 'static {
    /// The fields of the identifier.
    type Identifier: IdentifierFields;
    /// What every frame shows.
    const FRAME: Filter;
    /// What a reply shows if it reports no error.
    const NORMAL: Filter;
    /// All addressing modes.
    const MODES: &'static [Mode];
    /// The error code of replies while a device starts, if the document has one.
    const STARTING: Option<u64> = None;
    /// The number of data bytes that every frame has, if all have as many.
    const LENGTH: Option<u8> = None;
    /// Whether the controller sends reports.
    const CONTROLLER_REPORTS: bool = false;
    /// Whether frames have selectors in their data.
    const DATA_SELECTORS: bool = false;
    /// Whether foreign identifiers can show what chooses a message. If not, none needs a test of its own.
    const FOREIGN_LIKE_OWN: bool = false;
    /// Whether the code that recognises frames stands once for both directions. That is smaller, and slower.
    const IN_ONE_PLACE: bool = false;
    /// Whether requests can be refused by other messages than their replies.
    const REFUSALS: bool = false;
    /// The times that the document states, by their roles.
    const TIMING: Timing = Timing::NONE;
    /// What a device does after the controller was silent for as long as its watchdog waits.
    const AFTER_SILENCE: AfterSilence = AfterSilence::Unknown;
    /// All messages.
    const MESSAGES: &'static [Entry<Self>] = &[];

    /// Recognises a frame by its selectors.
    ///
    /// This is one choice where all requests have the selectors of their replies. Otherwise each
    /// direction has its own.
    ///
    /// # Errors
    ///
    /// Says why it is not recognised.
    #[inline(always)]
    fn recognise(frame: &Incoming) -> Result<Received<Self>, Problem> {
        match frame.heading() {
            Heading::Module => Self::request(frame),
            Heading::Controller => Self::reply(frame),
            Heading::Either => Self::either(frame),
            Heading::Neither => frame.unknown(),
        }
    }

    /// Recognises a frame to a module by its selectors.
    ///
    /// # Errors
    ///
    /// Says why it is not recognised.
    #[inline(always)]
    fn request(frame: &Incoming) -> Result<Received<Self>, Problem> {
        frame.unknown()
    }

    /// Recognises a frame to the controller by its selectors.
    ///
    /// # Errors
    ///
    /// Says why it is not recognised.
    #[inline(always)]
    fn reply(frame: &Incoming) -> Result<Received<Self>, Problem> {
        frame.unknown()
    }

    /// Recognises a frame whose identifier does not show whether it goes to a module or to the
    /// controller. Its selectors do.
    ///
    /// # Errors
    ///
    /// Says why it is not recognised.
    #[inline(always)]
    fn either(frame: &Incoming) -> Result<Received<Self>, Problem> {
        frame.unknown()
    }

    /// Returns the numbers of data bytes of the frames whose selectors an identifier shows.
    fn lengths(frame: &Incoming) -> &'static [u8] {
        match frame.heading() {
            Heading::Module => Self::request_lengths(frame),
            Heading::Controller => Self::reply_lengths(frame),
            Heading::Either => Self::either_lengths(frame),
            Heading::Neither => &[],
        }
    }

    /// Returns the numbers of data bytes of the requests whose selectors an identifier shows.
    fn request_lengths(_: &Incoming) -> &'static [u8] {
        &[]
    }

    /// Returns the numbers of data bytes of the replies and reports whose selectors an identifier
    /// shows.
    fn reply_lengths(_: &Incoming) -> &'static [u8] {
        &[]
    }

    /// Returns the numbers of data bytes of the frames whose selectors an identifier shows that does
    /// not show the direction.
    fn either_lengths(_: &Incoming) -> &'static [u8] {
        &[]
    }

    /// Finds the way by which a frame travels.
    #[doc(hidden)]
    fn way(_: &Shown) -> Option<Way> {
        None
    }

    /// Returns the number of the module that sends a frame, or that it goes to.
    #[doc(hidden)]
    fn node(_: &Way) -> Option<i32> {
        None
    }

    /// Runs a task on the values of the message.
    fn run<T: Task>(&self, task: T) -> T::Output;
}

/// A protocol with requests, or with reports of the controller.
pub trait Addressed: Protocol {
    /// Whom such frames address.
    type Target: Destination<Protocol = Self>;

    /// Returns the target of one module by its number, as [`Received::node`] returns it.
    ///
    /// It is that of the first addressing mode in which a module is asked alone and answers. A request refuses a number
    /// that the document does not name.
    ///
    /// It is `None` if no mode has modules with such numbers.
    fn module(_number: i32) -> Option<Self::Target> {
        None
    }
}

/// The identifier of a protocol, split into its fields.
pub trait IdentifierFields: Copy + Debug + PartialEq {
    /// Splits an identifier.
    const FROM_RAW: fn(u32) -> Self;
    /// Joins the fields. Bits that a field cannot hold are dropped.
    const TO_RAW: fn(Self) -> u32;

    /// Tests whether an identifier belongs to another device on the bus.
    fn is_foreign(_: u32) -> bool {
        false
    }

    /// Goes on with a frame by where its identifier shows that it goes.
    fn head<H: Headed>(id: u32, frame: H) -> H::Output;

    /// Returns the [`Protocol::MODES`] in which an identifier is a request, as bits from the lowest on. The document
    /// names all addresses in it.
    ///
    /// Bits can lack. A mode without one is then found by its [`Pattern`](crate::plumbing::Pattern), which takes longer.
    #[inline]
    fn documented_modes(_: u32) -> u8 {
        0
    }
}

/// Why a frame is not recognised, in the order of the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Problem {
    /// It is no classic data frame.
    Frame,
    /// It belongs to another device on the bus.
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

/// Returns the identifier of a frame if it has the right width.
#[inline(always)]
pub fn own_id<P: Protocol>(frame: &impl embedded_can::Frame) -> Option<u32> {
    let (id, extended) = raw_id(frame.id());
    (extended == P::FRAME.is_extended()).then_some(id)
}

/// Where a frame goes, as far as its identifier shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Heading {
    /// To a module.
    Module,
    /// To the controller.
    Controller,
    /// To a module or to the controller. The data show to which.
    Either,
    /// To none of both.
    Neither,
}

/// What is done with a frame, by where it goes.
pub trait Headed: Sized {
    /// What comes of it.
    type Output;

    /// The frame goes there.
    fn to(self, heading: Heading) -> Self::Output;
}

/// Only asks where a frame goes.
struct Asked;

impl Headed for Asked {
    type Output = Heading;

    #[inline(always)]
    fn to(self, heading: Heading) -> Heading {
        heading
    }
}

/// Tells where a frame with an identifier goes. It goes nowhere if it does not belong to the protocol.
#[inline(always)]
pub fn heading<P: Protocol>(id: u32) -> Heading {
    if is_own::<P>(id) { head::<P>(id) } else { Heading::Neither }
}

/// Tells where a frame with an identifier of the protocol goes.
#[inline(always)]
pub fn head<P: Protocol>(id: u32) -> Heading {
    P::Identifier::head(id, Asked)
}

/// Tests whether a frame with an identifier can go to the controller.
#[inline(always)]
pub fn is_to_controller<P: Protocol>(id: u32) -> bool {
    matches!(heading::<P>(id), Heading::Controller | Heading::Either)
}

/// Tests whether an identifier has the fixed bits of the protocol and is not foreign.
#[inline(always)]
pub fn is_own<P: Protocol>(id: u32) -> bool {
    P::FRAME.matches_id(id) && !(P::FOREIGN_LIKE_OWN && P::Identifier::is_foreign(id))
}
