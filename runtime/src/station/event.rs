//! What a station tells.

use crate::client::{Output, Ticket};
use crate::{Frame, Severity};

/// What a program does next.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub enum Step {
    /// It sends a frame now.
    Send {
        /// Names the request, for [`not_sent`](super::Station::not_sent).
        ticket: Ticket,
        /// The frame.
        frame: Frame,
    },
    /// Something has happened.
    Event(Event),
    /// It waits for a frame, and polls at this time at the latest.
    Wait(u32),
}

/// What has happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Event {
    /// A module answers for the first time, or again.
    Found {
        /// Its address.
        node: u8,
    },
    /// A module has not answered for so long that it may act by itself.
    Lost {
        /// Its address.
        node: u8,
    },
    /// A module says that it starts.
    Starting {
        /// Its address.
        node: u8,
    },
    /// What is known of the output of a module has changed.
    Output {
        /// Its address.
        node: u8,
        /// What is known now.
        output: Output,
    },
    /// The worst of what a module reports has changed.
    Alarm {
        /// Its address.
        node: u8,
        /// The severity, unless it reports nothing that has one.
        severity: Option<Severity>,
    },
    /// Answers to one request contradict each other, so two modules may have one address. Nothing is known of them
    /// until they do not. A stop goes on.
    Conflict {
        /// The address.
        node: u8,
    },
    /// A module delivers that was off and is to be. It is stopped again.
    Woke {
        /// Its address.
        node: u8,
    },
    /// A module refuses what it is to do, or says that it does something else. Or the document does not allow what it
    /// could do now. It is told again.
    Unmet {
        /// Its address.
        node: u8,
    },
    /// Another controller sets an output. If it has set several things since the last poll, this is the last one.
    Rival(Rival),
    /// The station has given way to another controller, and goes on reading. That keeps outputs on.
    KeptOn,
    /// The station reads modules before it sets anything. That can wake outputs of those that it has not heard.
    MayWake,
    /// The clock of the program has gone back, in milliseconds. That counts as no time passed.
    ClockBack {
        /// How far.
        by: u32,
    },
}

/// What another controller sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rival {
    /// The module, if it is one.
    pub node: Option<u8>,
    /// The voltage in mV, if it sets it.
    pub voltage_mv: Option<i32>,
    /// The current in mA, if it sets it.
    pub current_ma: Option<i32>,
    /// Whether it switches the output on or off, if it does.
    pub is_on: Option<bool>,
}
