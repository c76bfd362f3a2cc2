//! What a client says to do next.

use super::{Nodes, Ticket};
use crate::Frame;

/// What a program does next.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[must_use]
pub enum Step {
    /// It sends a frame now.
    Send {
        /// The request.
        ticket: Ticket,
        /// The frame. What answers it is known by what its message requires, and what is held is compared by its
        /// values. So a program may write a counter into it that no signal shows, each time that it sends it.
        frame: Frame,
    },
    /// A request is lost: it was sent as often as it may be, and no answer came. If it is held, none came
    /// that agrees.
    Lost(Ticket),
    /// A request is done that nobody answers, or that each module of several could answer. If the client
    /// knows [who they are](super::Client::members), all of them have.
    Done(Ticket),
    /// A request is lost: it was sent as often as it may be, and some of the modules that should answer did
    /// not. If it is held, they have not agreed.
    Missing {
        /// The request.
        ticket: Ticket,
        /// The modules.
        nodes: Nodes,
    },
    /// A module is silent: a request was lost, and nothing came from this module meanwhile.
    Silent(u8),
    /// A silent module has sent something.
    Back(u8),
    /// The clock has gone back by this number of milliseconds. No time counts as passed, and the client goes on.
    ClockBack(u32),
    /// It waits for a frame, and calls `poll` at this time at the latest, if there is one.
    Wait(Option<u32>),
}
