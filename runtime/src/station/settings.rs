//! How a station works, and what it never exceeds.

use core::fmt;

use crate::client::Pace;
use crate::{Error, Quantity};

/// How a station works. Times are in milliseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// How fast it asks.
    pub pace: Pace,
    /// The time from one round of a module to the next. All that is read and held is sent once in it. It is at most a
    /// third of the watchdog of the document.
    pub round: u32,
    /// How long a value counts after a module has said it. It is at most the watchdog of the document.
    pub valid: u32,
    /// What becomes of modules that it finds, until the program says more.
    pub found: Found,
    /// What it does when another controller sets something.
    pub rivals: Rivals,
    /// What it never exceeds.
    pub limits: Limits,
    /// The device model, if the limits and the messages of one count.
    pub model: Option<u8>,
}

impl Settings {
    /// Returns settings with values that count for three rounds, and a station that leaves the modules to other
    /// controllers.
    pub const fn new(pace: Pace, round: u32, found: Found, limits: Limits) -> Self {
        let (valid, rivals) = (round.saturating_mul(3), Rivals::Leave);
        Self { pace, round, valid, found, rivals, limits, model: None }
    }
}

/// What a station does with modules that it finds, until the program lets their group deliver or stops it.
///
/// Some modules come back as they were as soon as they [hear anything](crate::AfterSilence). A controller that
/// has restarted does not know what they did. So there is no default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Found {
    /// It switches them off. The first frame to each is the switch-off.
    Off,
    /// It sets this before anything else. What delivers then goes on with it, and the rest is switched off. Where one
    /// message also switches on and off, it reads first, which [`MayWake`](super::Event::MayWake) says.
    Adopt(SetPoint),
    /// It only reads. That can wake their outputs, which [`MayWake`](super::Event::MayWake) says.
    Watch,
}

/// What a station does when another controller sets an output. What is stopped is stopped in any case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Rivals {
    /// It sends nothing more to the modules. So it does not keep them on when the other controller stops.
    #[default]
    Leave,
    /// It only reads. That keeps outputs on, which [`KeptOn`](super::Event::KeptOn) says.
    Watch,
}

/// What a module is to deliver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SetPoint {
    /// The voltage in mV.
    pub voltage_mv: i32,
    /// The greatest current in mA, if the protocol can set it.
    pub current_ma: Option<i32>,
}

/// What no output ever exceeds, whatever the program asks for.
///
/// Voltage, current and power are those of one module. Where the protocol cannot set the current, only
/// the module itself limits current and power.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The least voltage that is set, in mV.
    pub least_mv: i32,
    /// The greatest voltage that is set, in mV.
    pub most_mv: i32,
    /// The greatest current that is set, in mA.
    pub most_ma: i32,
    /// The greatest product of both, in mW.
    pub most_mw: i32,
    /// The greatest sum of the currents that are set in a group, in mA.
    pub group_ma: i32,
    /// How far the current rises from one round to the next, in mA, however often the set-point changes. A module that
    /// restarts between two rounds is told its last step once more before it says that it is off.
    pub rise_ma: i32,
    /// Below this voltage a contactor may open, in mV.
    pub open_mv: i32,
}

/// A value beyond a limit of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Beyond {
    /// What it is.
    pub quantity: Quantity,
    /// The value in thousandths of the unit.
    pub value: i32,
    /// The limit in thousandths of the unit.
    pub limit: i32,
}

impl fmt::Display for Beyond {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, value, limit } = self;
        write!(formatter, "`{}` is {value} thousandths, but the limit of the program is {limit}", quantity.name())
    }
}

impl Limits {
    /// Tests a set-point.
    ///
    /// # Errors
    ///
    /// Refuses the first value that is beyond its limit.
    pub fn allow(&self, point: SetPoint) -> Result<(), Beyond> {
        let SetPoint { voltage_mv, current_ma } = point;
        let current = current_ma.unwrap_or_default();
        let beyond = |quantity, value, limit| Err(Beyond { quantity, value, limit });
        let power = i64::from(voltage_mv) * i64::from(current) / 1000;
        if voltage_mv < self.least_mv {
            return beyond(Quantity::OUTPUT_VOLTAGE, voltage_mv, self.least_mv);
        }
        if voltage_mv > self.most_mv {
            return beyond(Quantity::OUTPUT_VOLTAGE, voltage_mv, self.most_mv);
        }
        if current < 0 || current > self.most_ma {
            return beyond(Quantity::OUTPUT_CURRENT, current, self.most_ma);
        }
        if power > i64::from(self.most_mw) {
            return beyond(Quantity::OUTPUT_POWER, i32::try_from(power).unwrap_or(i32::MAX), self.most_mw);
        }
        Ok(())
    }

    /// Tests whether something can be set, and no limit contradicts another.
    pub(super) const fn let_something_be_set(&self) -> bool {
        let Self { least_mv, most_mv, most_ma, most_mw, group_ma, rise_ma, .. } = *self;
        least_mv <= most_mv && most_ma > 0 && most_mw > 0 && group_ma > 0 && rise_ma > 0
    }

    /// Returns the current that one of several modules of a group may have.
    pub(super) fn share(&self, members: i32) -> i32 {
        self.group_ma.checked_div(members).unwrap_or(self.group_ma)
    }
}

/// Why there is no such station.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unfit {
    /// The round is too short for as many modules or for an answer, or too long for the watchdog. It must be between
    /// these times.
    Round {
        /// The least time.
        least: u32,
        /// The greatest time.
        most: u32,
    },
    /// Values count for longer than the watchdog, in which a module changes by itself, or for less than a round.
    Valid {
        /// The least time.
        least: u32,
        /// The greatest time.
        most: u32,
    },
    /// No module is asked by this address.
    Address(u8),
    /// No module answers when it is switched off. So nothing shows whether it has heard that.
    Unanswered,
    /// No request reads whether a module delivers. What modules report by themselves shows nothing of what they heard.
    Unread,
    /// An address or a group is named twice.
    Twice(u8),
    /// The limits contradict each other, or let nothing be set: the least voltage is above the greatest, or a current
    /// or the power is not greater than 0.
    Limits,
    /// The document does not allow what the station needs.
    Document(Error),
    /// What it is to adopt would be refused.
    Adopt(Refused),
}

impl fmt::Display for Unfit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Round { least, most } => write!(formatter, "the round must be from {least} to {most} ms"),
            Self::Valid { least, most } => write!(formatter, "values must count from {least} to {most} ms"),
            Self::Address(node) => write!(formatter, "no module is asked by the address {node}"),
            Self::Unanswered => formatter.write_str("no module answers when it is switched off"),
            Self::Unread => formatter.write_str("no request reads whether a module delivers"),
            Self::Twice(number) => write!(formatter, "{number} is named twice"),
            Self::Limits => formatter.write_str("the limits contradict each other, or let nothing be set"),
            Self::Document(error) => error.fmt(formatter),
            Self::Adopt(refused) => refused.fmt(formatter),
        }
    }
}

impl core::error::Error for Unfit {}

/// Why a station does not do something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refused {
    /// It does not know the group.
    Group(u8),
    /// It does not know the address.
    Address(u8),
    /// The document does not allow the output.
    Output(Error),
    /// The output is beyond a limit of the program.
    Beyond(Beyond),
    /// The protocol can set the current, so without one no limit of the program would hold.
    NoCurrent,
    /// Nobody answers what sets the output. So nothing would show whether it is in effect.
    Unanswered,
    /// The module is not known to be off, so it cannot change its group.
    NotOff,
    /// There was an emergency, which the program has not [ended](super::Station::end_emergency).
    Emergency,
}

impl fmt::Display for Refused {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Group(number) => write!(formatter, "the station has no group {number}"),
            Self::Address(node) => write!(formatter, "the station has no module at the address {node}"),
            Self::Output(error) => error.fmt(formatter),
            Self::Beyond(beyond) => beyond.fmt(formatter),
            Self::NoCurrent => formatter.write_str("the protocol can set the current, so say which one"),
            Self::Unanswered => formatter.write_str("nobody answers what sets the output"),
            Self::NotOff => formatter.write_str("the module is not known to be off, so stop it first"),
            Self::Emergency => formatter.write_str("there was an emergency, which must be ended first"),
        }
    }
}

impl core::error::Error for Refused {}
