//! Messages, how they travel, and their frames.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use canspec_runtime::Place;

use crate::model::{
    AccessId, Array, ArrayId, Doc, ExchangeId, FieldId, FrameId, LongMessageId, MessageId, ModeId, ModelId, SelectorId,
    SelectorPlace, Set, Signal, SignalId, Table, TimingId,
};

/// What a frame is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Kind {
    /// Goes to a module, to read or to set.
    Request,
    /// Goes to the controller, echoes and failures included.
    Reply,
    /// Sent unasked.
    Report,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Request, Self::Reply, Self::Report];

    /// Returns the word of the spec language.
    pub fn name(self) -> &'static str {
        match self {
            Self::Request => "request",
            Self::Reply => "reply",
            Self::Report => "report",
        }
    }
}

/// One of the two ends of a bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Side {
    /// One of the modules.
    Module,
    /// The controller, which asks the modules.
    Controller,
}

impl Side {
    /// Returns the side that a frame of this one goes to.
    pub(crate) fn other(self) -> Self {
        match self {
            Self::Module => Self::Controller,
            Self::Controller => Self::Module,
        }
    }
}

/// Who answers a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Who {
    /// The module addressed.
    One,
    /// Each module addressed.
    Each,
    /// One module for all.
    Coordinator,
    /// Nobody.
    Nobody,
}

/// Who answers a request, by addressing mode; `None` if the mode is not allowed.
pub type Answers = Table<ModeId, Option<Who>>;

/// How a message travels.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Access {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// The kinds of frames that exist.
    pub kinds: Vec<Kind>,
    /// The kinds of frames that carry the message's signals.
    pub carries: Vec<Kind>,
    /// Who answers; `None` if the mode is not allowed.
    pub answers: Answers,
    /// How often a report comes.
    pub every: Option<TimingId>,
    /// Who sends its reports.
    pub from: Side,
}

impl Access {
    /// Returns who sends a kind of its frames.
    pub fn sender(&self, kind: Kind) -> Side {
        match kind {
            Kind::Request => Side::Controller,
            Kind::Reply => Side::Module,
            Kind::Report => self.from,
        }
    }

    /// Tests whether some of its frames go to a module.
    pub fn has_to_module(&self) -> bool {
        self.kinds.iter().any(|kind| self.sender(*kind) == Side::Controller)
    }
}

/// What the bits are that nothing in a frame names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Reserved {
    /// Whether frames that are built send them as 1, and not as 0.
    pub are_ones: bool,
    /// Whether received ones may have any value without a note.
    pub are_free: bool,
}

/// A message.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Message {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// The numbers of data bytes that its frames can have, the least first.
    pub lengths: Vec<u8>,
    /// Signals by first byte, then as written.
    pub signals: Table<SignalId, Signal>,
    /// The signals that are elements of one field, by field.
    pub arrays: Table<ArrayId, Array>,
    /// What chooses each of its frames, whatever the access.
    pub constants: Vec<Constant>,
    /// How it travels: one exchange for each of its accesses, alone or as a member of a set.
    pub exchanges: Table<ExchangeId, Exchange>,
    /// Its frames: one for each exchange and kind.
    pub frames: Vec<FrameId>,
    /// The frames that refuse its requests in place of a reply, one for each exchange that has
    /// them. They are replies of another message.
    pub refusals: Vec<FrameLayout>,
    /// How often its report comes, if not as its access says.
    pub every: Option<TimingId>,
    /// The only device models that have it; empty if every model has it.
    pub models: Vec<ModelId>,
    /// What it consists of, if it travels as several frames.
    pub set: Option<Set>,
    /// What its frames say together, if they carry parts.
    pub long: Option<LongMessageId>,
    /// Fields of the identifier that it sends with a value of its own. Received ones may have any.
    pub sends: Vec<(FieldId, u32)>,
    /// Constants among its fields.
    pub fixed: Vec<FixedField>,
    /// What the bits are that nothing names.
    pub reserved: Reserved,
}

/// A field that has one value in a message.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FixedField {
    /// The selector that it is.
    pub selector: SelectorId,
    /// Its value.
    pub value: u64,
    /// What the spec says beside it here. Other messages may say something else of the same selector.
    pub doc: Doc,
}

impl Message {
    /// Returns the least number of data bytes.
    pub fn shortest(&self) -> u8 {
        self.lengths.first().copied().unwrap_or(8)
    }

    /// Returns the greatest number of data bytes.
    pub fn longest(&self) -> u8 {
        self.lengths.last().copied().unwrap_or(8)
    }

    /// Returns the message with its signals as a device model has them.
    pub fn on(&self, model: Option<ModelId>) -> Cow<'_, Self> {
        if self.signals.iter().all(|signal| signal.encoding.by_model().is_empty()) {
            return Cow::Borrowed(self);
        }
        Cow::Owned(Self { signals: self.signals.map(|signal| signal.on(model).clone()), ..self.clone() })
    }

    /// Tests whether a device model has the message.
    pub fn is_of(&self, model: ModelId) -> bool {
        self.models.is_empty() || self.models.contains(&model)
    }

    /// Tests whether no device model has this message and the other one.
    pub fn is_apart_from(&self, other: &Self) -> bool {
        !self.models.is_empty() && !other.models.is_empty() && !self.models.iter().any(|model| other.is_of(*model))
    }
}

/// How a message travels by one of its accesses.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Exchange {
    /// The access.
    pub access: AccessId,
    /// Who answers the message's requests.
    pub answers: Answers,
    /// The set, if the message travels as its member.
    pub set: Option<MessageId>,
}

/// A value that a selector must have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Constant {
    /// The selector.
    pub selector: SelectorId,
    /// Where it stands.
    pub place: SelectorPlace,
    /// Its value. If it can have several, it is the one whose open bits are 0, and which is sent.
    pub value: u64,
    /// The bits that do not count: the selector can have any value that differs in them alone.
    pub open: u64,
}

impl Constant {
    /// Tests whether it is a value that the selector can have.
    pub fn admits(&self, value: u64) -> bool {
        (self.value ^ value) & !self.open == 0
    }

    /// Tests whether another constant of the selector has values of this one alone.
    pub fn covers(&self, other: &Self) -> bool {
        self.selector == other.selector && self.admits(other.value) && other.open & !self.open == 0
    }

    /// Tests whether no value is one of both constants of a selector.
    pub fn excludes(&self, other: &Self) -> bool {
        self.selector == other.selector && (self.value ^ other.value) & !(self.open | other.open) != 0
    }

    /// Returns every value that the selector can have, the least first.
    pub fn values(&self) -> impl Iterator<Item = u64> + use<> {
        let value = self.value;
        submasks(self.open).map(move |bits| value | bits)
    }

    /// Shows the values that the selector can have: `0x43 or 0x4B`.
    pub(crate) fn text(&self) -> String {
        self.values().map(|value| format!("{value:#04X}")).collect::<Vec<_>>().join(" or ")
    }

    /// Returns the field of the identifier and its value, if it stands there.
    pub fn in_identifier(&self) -> Option<(FieldId, u32)> {
        match self.place {
            SelectorPlace::Identifier(field) => Some((field, u32::try_from(self.value).unwrap_or(u32::MAX))),
            SelectorPlace::Payload(_) => None,
        }
    }

    /// Returns the bits of the payload and their value, if it stands there.
    pub fn in_payload(&self) -> Option<(Place, u64)> {
        match self.place {
            SelectorPlace::Identifier(_) => None,
            SelectorPlace::Payload(place) => Some((place, self.value)),
        }
    }
}

/// One kind of frame of one message: all that an engine or an emitter needs of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FrameLayout {
    /// The message that it carries.
    pub message: MessageId,
    /// The exchange of the message to which it belongs.
    pub exchange: ExchangeId,
    /// The access of that exchange.
    pub access: AccessId,
    /// The set of that exchange, if there is one.
    pub set: Option<MessageId>,
    /// What the frame is for.
    pub kind: Kind,
    /// Who sends it.
    pub sender: Side,
    /// The numbers of data bytes that it can have, the least first. Signals that end beyond the least
    /// are optional.
    pub lengths: Vec<u8>,
    /// What chooses this frame, in identifier and payload.
    pub constants: Vec<Constant>,
    /// Payload selectors that this frame has, constants included.
    pub selectors: Vec<SelectorId>,
    /// The long message whose signals these are, if a transport carries them; `None` for those of the message.
    pub long: Option<LongMessageId>,
    /// Signals that this frame carries.
    pub signals: Vec<SignalId>,
    /// Payload bits of selectors and of the message's signals, byte 0 highest.
    pub covered: u64,
    /// What the bits are that nothing covers.
    pub reserved: Reserved,
    /// The addressing modes by which it is sent, and who answers or sends it.
    pub travels: Vec<Travel>,
}

/// Returns every number whose bits are among those of a mask, the least first.
pub(crate) fn submasks(mask: u64) -> impl Iterator<Item = u64> {
    std::iter::successors(Some(0), move |bits: &u64| Some(bits.wrapping_sub(mask) & mask).filter(|next| *next != 0))
}

impl FrameLayout {
    /// Returns the constants of the identifier.
    pub fn identifier(&self) -> impl Iterator<Item = (FieldId, u32)> {
        self.constants.iter().filter_map(Constant::in_identifier)
    }

    /// Returns the constants of the payload.
    pub fn payload(&self) -> impl Iterator<Item = (Place, u64)> {
        self.constants.iter().filter_map(Constant::in_payload)
    }

    /// Returns the least number of data bytes.
    pub fn shortest(&self) -> u8 {
        self.lengths.first().copied().unwrap_or(8)
    }

    /// Returns the greatest number of data bytes.
    pub fn longest(&self) -> u8 {
        self.lengths.last().copied().unwrap_or(8)
    }

    /// Tests whether it goes to a module. If it does, it keeps to the limits of what may be sent.
    pub fn is_to_module(&self) -> bool {
        self.sender == Side::Controller
    }

    /// Tests whether it can have `length` data bytes.
    pub fn has_length(&self, length: usize) -> bool {
        self.lengths.iter().any(|known| usize::from(*known) == length)
    }

    /// Returns the payload bits that nothing covers, byte 0 highest.
    pub fn uncovered(&self) -> u64 {
        !self.covered & first_bytes(self.longest())
    }

    /// Returns the payload bits that are sent as 1 although nothing covers them, byte 0 highest.
    pub fn filled(&self) -> u64 {
        if self.reserved.are_ones { self.uncovered() } else { 0 }
    }

    /// Returns how many data bytes reach to the last bit that is covered.
    pub fn head(&self) -> usize {
        usize::try_from((u64::BITS - self.covered.trailing_zeros()).div_ceil(8)).unwrap_or(8)
    }

    /// Tests whether another frame is the same kind of frame of the same message.
    pub fn is_kind_of(&self, other: &Self) -> bool {
        (self.message, self.exchange, self.kind) == (other.message, other.exchange, other.kind)
    }

    /// Tests whether another frame belongs to the same access, alone or of the same set.
    pub fn is_exchanged_with(&self, other: &Self) -> bool {
        (self.access, self.set) == (other.access, other.set)
    }
}

/// Returns the bits of the first data bytes, byte 0 highest.
pub(crate) fn first_bytes(count: u8) -> u64 {
    u64::MAX.checked_shl(64 - 8 * u32::from(count)).unwrap_or(0)
}

/// A way in which a frame is sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Travel {
    /// The addressing mode.
    pub mode: ModeId,
    /// Who answers a request, or sends a reply or report.
    pub who: Who,
}
