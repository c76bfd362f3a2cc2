//! The time for which a client has nothing to do, so that it need not look at each of its requests to know that.

use super::entry::State;
use super::{Bus, Client};
use crate::Protocol;
use crate::clock::{earlier, has_come, time_left};

/// Until when there is nothing to do, unless something happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quiet {
    /// When something is to do, if that is known.
    pub deadline: Option<u32>,
    /// When the client must look at its requests again, which is not after the deadline.
    pub until: Option<u32>,
}

impl Quiet {
    /// Tests whether the client must look at its requests again.
    pub fn is_over(&self, now: u32) -> bool {
        self.until.is_some_and(|until| has_come(until, now))
    }
}

impl<P: Protocol, const N: usize, const G: usize> Client<P, N, G> {
    /// Returns from when on nothing was sent for so long that nothing which was due then can still wait for answers.
    pub(super) fn idle_from(&self) -> Option<u32> {
        Some(self.busy?.wrapping_add(self.pace.wait).wrapping_add(self.pace.late).wrapping_add(1))
    }

    /// Returns how long there is nothing to do, as there is nothing now.
    pub(super) fn quiet_from(&self, now: u32) -> Quiet {
        let deadline = self.deadline(now);
        let times = [deadline, self.free, self.idle_from()].into_iter().flatten();
        let left = times.map(|time| time_left(time, now)).min();
        let until = left.map(|left| now.wrapping_add(left));
        Quiet { deadline, until }
    }

    /// Returns the next time at which something is to do. What is due and not sent waits for another entry.
    fn deadline(&self, now: u32) -> Option<u32> {
        let free = self.free.unwrap_or(now);
        let idle = self.idle_from().filter(|_| self.bus == Bus::On);
        let mut next: Option<u32> = None;
        let mut note = |time: u32| {
            let left = Some(time_left(time, now)).filter(|left| *left > 0);
            next = left.into_iter().chain(next).min();
        };
        for entry in self.entries.iter().flatten() {
            match entry.state {
                State::Due { .. } if entry.is_held_back() || self.bus == Bus::Off => {}
                State::Due { from } if earlier(from, free, now) => note(free),
                State::Due { from: time } | State::Waiting { until: time } | State::Resting { until: time, .. } => {
                    note(time);
                }
            }
            if entry.leader.is_some() && entry.due(now).is_some() {
                idle.into_iter().for_each(&mut note);
            }
            if entry.is_under_way() || entry.is_spare {
                entry.times().into_iter().flatten().for_each(&mut note);
            }
        }
        next.map(|left| now.wrapping_add(left))
    }
}
