//! What is known of a value, and how old that is.

use super::module::{self, Module};
use super::{Goal, SetPoint, Settings, Station, Task};
use crate::client::Output;
use crate::clock::{has_come, has_lasted};
use crate::{Addressed, Quantities, Received, Severity};

/// What is known of a value at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Known<T> {
    /// A module has said it, and not longer ago than values count.
    Fresh(T),
    /// A module has said it longer ago than values count.
    Stale {
        /// What it was.
        value: T,
        /// When it was said, in milliseconds of the program's clock.
        since: u32,
    },
    /// No module has said it.
    Unknown,
}

impl<T> Known<T> {
    /// Returns the value if it still counts.
    pub fn fresh(self) -> Option<T> {
        if let Self::Fresh(value) = self { Some(value) } else { None }
    }
}

/// A value that a module has said at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Said<T> {
    pub value: T,
    pub at: u32,
}

impl<T: Copy> Said<T> {
    /// Returns the value if it is not older than it may be.
    pub fn fresh(self, valid: u32, now: u32) -> Option<T> {
        (!has_lasted(self.at, valid.saturating_add(1), now)).then_some(self.value)
    }
}

impl<P: Quantities + Addressed, const M: usize, const G: usize, const R: usize> Station<P, M, G, R> {
    /// Returns the addresses of the modules that answer.
    pub fn modules(&self) -> impl Iterator<Item = u8> {
        self.modules.iter().filter(|module| module.heard.is_some()).map(Module::node)
    }

    /// Returns the group of a module, if it has said it, or the program.
    pub fn group(&self, node: u8) -> Option<u8> {
        self.module(node)?.group
    }

    /// Returns what is known of the output of a module. It is only off if it has said so since it confirmed what it was
    /// told last, and not longer ago than values count. One that has tripped says so, too, and is switched on again.
    pub fn output(&self, node: u8, now: u32) -> Output {
        let now = self.clock.steady(now);
        self.module(node).map_or(Output::Unknown, |module| module.output(self.settings.valid, now))
    }

    /// Returns the voltage at the output of a module, in mV.
    pub fn voltage_mv(&self, node: u8, now: u32) -> Known<i32> {
        self.known(self.module(node).and_then(|module| module.voltage_mv), now)
    }

    /// Returns the current at the output of a module, in mA.
    pub fn current_ma(&self, node: u8, now: u32) -> Known<i32> {
        self.known(self.module(node).and_then(|module| module.current_ma), now)
    }

    /// Returns the worst of what a module reports. It is `None` if it reports nothing that has a severity.
    pub fn severity(&self, node: u8, now: u32) -> Known<Option<Severity>> {
        let status = self.module(node).and_then(|module| module.status);
        let worst = status.map(|said| Said { value: module::severity(&said.value), at: said.at });
        self.known(worst, now)
    }

    /// Returns what a module has said of its state last, for [`Received::conditions`].
    pub fn status(&self, node: u8) -> Option<&Received<P>> {
        self.module(node)?.status.as_ref().map(|said| &said.value)
    }

    /// Returns what a module is told to deliver now, if it is.
    pub fn told(&self, node: u8) -> Option<SetPoint> {
        match self.module(node)?.goal {
            Goal::Output { point, .. } => Some(point),
            Goal::Off | Goal::Read | Goal::Leave => None,
        }
    }

    /// Tests whether a group is known to be off: it is not to deliver, it has modules, and each has said that it is off
    /// since it was told so. What was said longer ago than values count does not count. A module whose group is not
    /// known counts for each group.
    pub fn is_off(&self, group: u8, now: u32) -> bool {
        let now = self.clock.steady(now);
        let delivers = self.groups.iter().any(|known| known.number == group && matches!(known.task, Task::Deliver(_)));
        let is_off = |module: &Module<P>| {
            !matches!(module.goal, Goal::Output { .. }) && module.output(self.settings.valid, now) == Output::Off
        };
        !delivers && self.members(group).next().is_some() && self.possible_members(group).all(is_off)
    }

    /// Tests whether a contactor at the output of a group may open. What was never found does not count, so compare
    /// [`modules`](Self::modules) with those that are built in. Each of its modules is known to be off, and has
    /// measured less than [`open_mv`](super::Limits::open_mv) since it says so.
    pub fn is_safe_to_open(&self, group: u8, now: u32) -> bool {
        let Settings { valid, limits, .. } = self.settings;
        let at = self.clock.steady(now);
        let is_low = |module: &Module<P>| {
            // What was measured before it was off says nothing of the time after that.
            let said = module.voltage_mv.filter(|said| has_come(module.off_since, said.at));
            let voltage = said.and_then(|said| said.fresh(valid, at));
            voltage.is_some_and(|voltage| voltage.saturating_abs() < limits.open_mv)
        };
        self.is_off(group, now) && self.possible_members(group).all(is_low)
    }

    fn known<T: Copy>(&self, said: Option<Said<T>>, now: u32) -> Known<T> {
        let Some(said) = said else { return Known::Unknown };
        let stale = Known::Stale { value: said.value, since: self.clock.of_program(said.at) };
        said.fresh(self.settings.valid, self.clock.steady(now)).map_or(stale, Known::Fresh)
    }

    pub(super) fn module(&self, node: u8) -> Option<&Module<P>> {
        self.modules.iter().find(|module| module.node() == node)
    }

    fn members(&self, group: u8) -> impl Iterator<Item = &Module<P>> {
        self.modules.iter().filter(move |module| module.group == Some(group))
    }

    /// Returns the members of a group, and what answers and can be one.
    pub(super) fn possible_members(&self, group: u8) -> impl Iterator<Item = &Module<P>> {
        let is_known = |module: &&Module<P>| module.group.is_some() || module.heard.is_some();
        self.modules.iter().filter(move |module| module.hears(group)).filter(is_known)
    }
}
