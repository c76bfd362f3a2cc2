//! What a client or a simulated device does wrong.

use core::fmt;

use crate::{Error, Frame, Problem};

/// How many complaints wait to be taken. More are dropped.
const MOST: usize = 4;

/// What a client does wrong, or a simulated device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Complaint {
    /// It sends a frame too soon after the one before.
    Gap {
        /// The frame.
        frame: Frame,
        /// The milliseconds since the one before.
        after: u32,
    },
    /// It sends a frame that is none of the protocol.
    Unrecognised {
        /// The frame.
        frame: Frame,
        /// Why it is none.
        problem: Problem,
    },
    /// It sends a frame that goes to no module.
    Direction(Frame),
    /// It sends a request that the document forbids.
    Illegal {
        /// The frame.
        frame: Frame,
        /// What the document forbids.
        error: Error,
    },
    /// A module has heard nothing for so long that its watchdog has run out.
    Unfed {
        /// The module.
        node: u8,
    },
    /// The program lets a module answer with what is no reply to the request. It is another message, or has
    /// values or an error code that it cannot carry. The client hears nothing.
    Answer {
        /// The module.
        node: u8,
        /// Why there is no reply.
        error: Error,
    },
}

/// Complaints that wait to be taken.
#[derive(Clone, Copy, Debug)]
pub struct Complaints([Option<Complaint>; MOST]);

impl Complaints {
    pub const NONE: Self = Self([None; MOST]);

    pub fn add(&mut self, complaint: Complaint) {
        if let Some(slot) = self.0.iter_mut().find(|slot| slot.is_none()) {
            *slot = Some(complaint);
        }
    }

    pub fn take(&mut self) -> Option<Complaint> {
        self.0.iter_mut().find(|slot| slot.is_some())?.take()
    }
}

impl fmt::Display for Complaint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gap { frame, after } => write!(formatter, "{frame} comes {after} ms after the frame before"),
            Self::Unrecognised { frame, problem } => write!(formatter, "{frame}: {problem}"),
            Self::Direction(frame) => write!(formatter, "{frame} goes to no module"),
            Self::Illegal { frame, error } => write!(formatter, "{frame}: {error}"),
            Self::Unfed { node } => write!(formatter, "module {node} has heard nothing until its watchdog ran out"),
            Self::Answer { node, error } => write!(formatter, "module {node} has no such answer: {error}"),
        }
    }
}
