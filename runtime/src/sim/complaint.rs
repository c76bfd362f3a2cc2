//! What a client does wrong.

use core::fmt;

use crate::{Error, Frame, Problem};

/// What a client does wrong.
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
}

impl fmt::Display for Complaint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gap { frame, after } => write!(formatter, "{frame} comes {after} ms after the frame before"),
            Self::Unrecognised { frame, problem } => write!(formatter, "{frame}: {problem}"),
            Self::Direction(frame) => write!(formatter, "{frame} goes to no module"),
            Self::Illegal { frame, error } => write!(formatter, "{frame}: {error}"),
            Self::Unfed { node } => write!(formatter, "module {node} has heard nothing until its watchdog ran out"),
        }
    }
}
