//! What a received frame is to a client.

use super::Ticket;
use crate::{Problem, Protocol, Received};

/// What a received frame is to a client.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub enum Heard<P: Protocol> {
    /// It answers a request.
    Answer {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It answers a request that is [held](super::Client::hold), and says something else. The request waits on.
    NotInEffect {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It answers a request: the module [starts](Protocol::STARTING), and can be asked later. The request waits on, and
    /// is sent again as if nobody had answered. The module is not silent.
    Starting {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It refuses a request: it shows an error code, or is the message that says why.
    Refusal {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It refuses a request with another number of bytes than the message has, as an error reply may.
    ShortRefusal(Ticket),
    /// It would answer a request if it had the right length, or says that the module starts. The request waits on.
    Broken(Ticket),
    /// It answers a request that was lost or cancelled, or could answer what a held one replaced.
    Late {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It answers a request that has an answer already, as the further parts of a message in `parts`
    /// do. Give them to the assembler, too. A module of a group that answers after [`Step::Done`](super::Step::Done) is
    /// also here.
    Twice {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It goes to a module: a request or a report of another controller. A rival may only read. What it
    /// [sets](Received::setting) shows whether it does more.
    Rival(Received<P>),
    /// It comes from a module and answers nothing that was asked: a report, or a reply to somebody else.
    Other(Received<P>),
    /// It is not recognised.
    Unrecognised(Problem),
}
