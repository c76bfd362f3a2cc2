//! Messages, how they travel, and the frames that exist of them.

use crate::model::{Doc, Set, Signal};

/// What a frame is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Towards a module: reads and sets alike.
    Request,
    /// Towards the controller, echoes and failures included.
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

/// Who answers a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

/// How a message travels.
#[derive(Clone, Debug)]
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
    /// Who answers, by [`Protocol::modes`](crate::model::Protocol::modes); `None` where the mode is not allowed.
    pub answers: Vec<Option<Who>>,
    /// Index into [`Protocol::timing`](crate::model::Protocol::timing): how often a report comes.
    pub every: Option<usize>,
}

/// A message.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Message {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Data bytes of its frames.
    pub length: u8,
    /// Signals by first byte, then as written.
    pub signals: Vec<Signal>,
    /// What chooses each of its frames, whatever the access: selectors (index into
    /// [`Protocol::selectors`](crate::model::Protocol::selectors)) and their values.
    pub constants: Vec<(usize, u64)>,
    /// Accesses by which it travels.
    pub accesses: Vec<MessageAccess>,
    /// The frames that exist: one for each access and kind.
    pub shapes: Vec<Shape>,
    /// The frames that refuse its requests in place of a reply, one for each access that has them: replies of another message.
    pub refusals: Vec<Shape>,
    /// Index into [`Protocol::timing`](crate::model::Protocol::timing): how often its report comes, if not as its access says.
    pub every: Option<usize>,
    /// The only device models that have it, by [`Protocol::models`](crate::model::Protocol::models); empty if every
    /// model has it.
    pub models: Vec<usize>,
    /// What it consists of, if it travels as several frames.
    pub set: Option<Set>,
}

impl Message {
    /// Tests whether a device model has the message.
    pub fn is_of(&self, model: usize) -> bool {
        self.models.is_empty() || self.models.contains(&model)
    }

    /// Tests whether no device model has this message and the other one.
    pub fn is_apart_from(&self, other: &Self) -> bool {
        !self.models.is_empty() && !other.models.is_empty() && !self.models.iter().any(|model| other.is_of(*model))
    }
}

/// An access as one message has it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MessageAccess {
    /// Index into [`Protocol::accesses`](crate::model::Protocol::accesses).
    pub access: usize,
    /// Who answers, by [`Protocol::modes`](crate::model::Protocol::modes); `None` where the mode is not allowed.
    pub answers: Vec<Option<Who>>,
    /// Index into [`Protocol::messages`](crate::model::Protocol::messages): the set as a member of which the message
    /// travels so.
    pub set: Option<usize>,
}

/// One kind of frame of one message.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Shape {
    /// Index into [`Message::accesses`].
    pub access: usize,
    /// What the frame is for.
    pub kind: Kind,
    /// What chooses this frame: selectors (index into [`Protocol::selectors`](crate::model::Protocol::selectors)) and their values.
    pub constants: Vec<(usize, u64)>,
    /// Payload selectors that this frame has, constants included.
    pub selectors: Vec<usize>,
    /// Signals that this frame carries: indices into [`Message::signals`].
    pub signals: Vec<usize>,
}
