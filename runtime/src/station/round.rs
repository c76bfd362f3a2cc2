//! What a station asks in each round.

use super::fit::watchdog;
use super::module::{Goal, Module, Placed, Read, Task};
use super::{Event, Found, SetPoint, Settings, Station, request};
use crate::client::{Full, NotHeld, Output, Pace};
use crate::clock::{has_come, has_lasted, time_left};
use crate::{Addressed, Quantities, Received, Request};

/// How far an echo may differ, in thousandths of a unit. Documents print echoes that differ by 15.
const TOLERANCE: u32 = 100;

impl<P: Quantities + Addressed, const M: usize, const G: usize, const R: usize> Station<P, M, G, R> {
    /// Begins the round of a module when it is due, and gives up one that has not answered in time.
    pub(super) fn look_after(&mut self, place: usize, now: u32) {
        let Settings { pace, round, .. } = self.settings;
        let patience = patience::<P>(&self.settings);
        let Some(module) = self.modules.get_mut(place) else { return };
        if module.heard.is_some_and(|heard| has_lasted(heard, patience, now)) {
            module.lose(&mut self.client);
        }
        module.expire(now);
        self.hurry_stop(place, now);
        let Some(module) = self.modules.get_mut(place) else { return };
        if module.due.is_some_and(|due| !has_come(due, now)) {
            return;
        }
        module.due = Some(now.wrapping_add(round));
        if self.ask(place, now).is_err() {
            // There is room again when no answer to an earlier request can come any more.
            let soon = now.wrapping_add(pace.wait).wrapping_add(pace.late).wrapping_add(1);
            self.modules.get_mut(place).into_iter().for_each(|module| module.due = Some(soon));
        }
    }

    /// Lets what switches a module off go before what is read, in each round until it is off. A stop of its whole group
    /// that is to be sent goes before that.
    fn hurry_stop(&mut self, place: usize, now: u32) {
        let Some(module) = self.modules.get(place) else { return };
        let mut stops =
            self.groups.iter().filter(|group| module.group == Some(group.number)).filter_map(|group| group.stop);
        if module.goal == Goal::Off
            && module.duty.output() != Output::Off
            && !stops.any(|ticket| self.client.is_due(ticket, now))
        {
            module.duty.last().into_iter().for_each(|ticket| self.client.hurry(ticket, now));
        }
    }

    /// Reads a module and tells it what it is to do. One that does not answer is only told.
    fn ask(&mut self, place: usize, now: u32) -> Result<(), NotHeld> {
        let Some(module) = self.modules.get_mut(place) else { return Ok(()) };
        let Some(target) = P::module(module.node().into()) else { return Ok(()) };
        // What waits for the driver since the last round may not be what is wanted now.
        module.once.take().into_iter().for_each(|ticket| self.client.cancel(ticket));
        let Some(module) = self.modules.get(place) else { return Ok(()) };
        let (goal, heard) = (self.goal(module), module.heard);
        let goal = self.limited(place, goal, now);
        match (self.possible(place, goal, target), heard) {
            (Goal::Leave, _) => {
                self.modules.get_mut(place).into_iter().for_each(|module| module.end(&mut self.client));
                Ok(())
            }
            (goal, None) => self.probe(place, goal, target, now),
            (goal, Some(_)) => {
                // What it is to do goes first.
                self.tell(place, goal, target, now)?;
                self.read(place, target, now)
            }
        }
    }

    /// Returns what a module is to do.
    fn goal(&self, module: &Module<P>) -> Goal {
        if module.has_left {
            return Goal::Off;
        }
        let group = self.groups.iter().find(|group| module.group == Some(group.number));
        let (point, is_on) = match (group.map_or(self.others, |group| group.task), self.settings.found) {
            (Task::Leave, _) => return Goal::Leave,
            (Task::Watch, _) | (Task::AsFound, Found::Watch) => return Goal::Read,
            (Task::Stop, _) | (Task::AsFound, Found::Off) => return Goal::Off,
            (Task::AsFound, Found::Adopt(_)) if module.was_on == Some(false) => return Goal::Off,
            (Task::AsFound, Found::Adopt(point)) => (point, module.was_on == Some(true)),
            (Task::Deliver(point), _) => (point, true),
        };
        Goal::Output { point, is_on }
    }

    /// Returns what a module can be asked for. It is off if the document does not allow the output of this round.
    fn possible(&mut self, place: usize, goal: Goal, target: P::Target) -> Goal {
        let is_possible = match goal {
            Goal::Output { point, .. } => request::deliver::<P>(&self.settings, target, point).is_ok(),
            Goal::Leave | Goal::Read | Goal::Off => true,
        };
        let Some(module) = self.modules.get_mut(place) else { return goal };
        module.is_impossible = !is_possible;
        if is_possible {
            return goal;
        }
        module.told.unmet.begin();
        Goal::Off
    }

    /// Returns what a module is to do in this round: its current rises by a step, and the group does not exceed its
    /// limit. While its group is not known, all modules can be in one.
    fn limited(&mut self, place: usize, goal: Goal, now: u32) -> Goal {
        let (Goal::Output { point, is_on }, Some(module)) = (goal, self.modules.get(place)) else { return goal };
        let members = match module.group {
            Some(group) => self.possible_members(group).count(),
            None if module.placed == Placed::ByProgram => 1,
            None => M,
        };
        let Settings { limits, round, .. } = self.settings;
        let share = limits.share(i32::try_from(members).unwrap_or(i32::MAX));
        let Some(module) = self.modules.get_mut(place) else { return goal };
        let current_ma = point.current_ma.map(|current| {
            let current = current.min(share);
            if current > module.reached_ma { current.min(module.step(limits.rise_ma, round, now)) } else { current }
        });
        Goal::Output { point: SetPoint { current_ma, ..point }, is_on }
    }

    /// Tells a module that does not answer what it is to do, once. So it does not come back as it was.
    fn probe(&mut self, place: usize, goal: Goal, target: P::Target, now: u32) -> Result<(), NotHeld> {
        let settings = &self.settings;
        let reading = || request::readings::<P>(target).into_iter().flatten().next();
        let request = match goal {
            Goal::Leave => None,
            Goal::Read => reading(),
            Goal::Off => request::switch_off::<P>(settings, target).ok().flatten(),
            Goal::Output { point, is_on } => {
                let [first, ..] = output::<P>(settings, target, point, is_on);
                first.or_else(reading)
            }
        };
        let Some(request) = request else { return Ok(()) };
        let is_stop = goal == Goal::Off;
        let once = Pace { tries: 1, ..settings.pace };
        if !is_stop {
            self.has_room(1)?;
        }
        let ticket = self.client.ask_at(once, request, now).map_err(|Full| NotHeld::Full)?;
        if is_stop {
            self.client.hurry(ticket, now);
        }
        let Some(module) = self.modules.get_mut(place) else { return Ok(()) };
        let [first, ..] = &mut module.reads;
        (*first, module.once) = (Read::of(ticket), Some(ticket));
        Ok(())
    }

    /// Reads a module again and again, and its group if that is not known.
    fn read(&mut self, place: usize, target: P::Target, now: u32) -> Result<(), NotHeld> {
        let Settings { pace, round, .. } = self.settings;
        let Some(module) = self.modules.get(place) else { return Ok(()) };
        let group = request::group::<P>(target).filter(|_| module.placed == Placed::Unknown);
        if let Some(request) = group {
            self.has_room(1)?;
            let once = Pace { tries: 1, ..pace };
            let ticket = self.client.ask_at(once, request, now).map_err(|Full| NotHeld::Full)?;
            self.modules.get_mut(place).into_iter().for_each(|module| module.once = Some(ticket));
        }
        for (index, request) in request::readings::<P>(target).into_iter().enumerate() {
            let is_read = self.modules.get(place).and_then(|module| module.reads.get(index)).is_some_and(Read::is_on);
            let Some(request) = request.filter(|_| !is_read) else { continue };
            self.has_room(1)?;
            let ticket = self.client.every(round, request, now).map_err(|_| NotHeld::Full)?;
            if let Some(read) = self.modules.get_mut(place).and_then(|module| module.reads.get_mut(index)) {
                *read = Read::of(ticket);
            }
        }
        Ok(())
    }

    /// Holds what a module is to do.
    fn tell(&mut self, place: usize, goal: Goal, target: P::Target, now: u32) -> Result<(), NotHeld> {
        let is_output = matches!(goal, Goal::Output { .. });
        let Some(node) = self.modules.get(place).map(Module::node) else { return Ok(()) };
        let settings = &self.settings;
        let requests = match goal {
            Goal::Leave | Goal::Read => [None; 3],
            Goal::Off => [request::switch_off::<P>(settings, target).ok().flatten(), None, None],
            Goal::Output { point, is_on } => output::<P>(settings, target, point, is_on),
        };
        if is_output {
            // What is held already is replaced.
            self.has_room(requests.iter().flatten().count().saturating_sub(self.client.held_by(node)))?;
        }
        let Self { client, settings, .. } = self;
        let Some(module) = self.modules.get_mut(place) else { return Ok(()) };
        let is_new = module.goal != goal;
        if is_new && !is_output {
            module.duty.end(client);
            // What delivers again begins with the first step.
            module.rise_anew();
        }
        if is_new {
            (module.goal, module.is_met) = (Goal::Read, false);
        }
        module.duty.hold(client, requests.into_iter().flatten(), settings.round, agrees, now)?;
        module.goal = goal;
        self.hurry_stop(place, now);
        Ok(())
    }

    /// Tests whether there is room for more requests beside that for stops.
    fn has_room(&self, count: usize) -> Result<(), NotHeld> {
        let stops = self.groups.iter().filter(|group| group.stop.is_none()).count();
        if self.client.room() >= M + stops + count { Ok(()) } else { Err(NotHeld::Full) }
    }

    /// Returns when there is something to do, if the client has nothing to do before.
    pub(super) fn deadline(&self, client: Option<u32>, now: u32) -> u32 {
        let settings = &self.settings;
        let times = self.modules.iter().flat_map(|module| {
            let lost = module.heard.map(|heard| heard.wrapping_add(patience::<P>(settings)));
            let stale = module.said_at.wrapping_add(settings.valid).wrapping_add(1);
            [module.due, lost, Some(stale).filter(|_| module.output(settings.valid, now) != Output::Unknown)]
        });
        let left = times.flatten().chain(client).map(|time| time_left(time, now).max(1)).min();
        now.wrapping_add(left.map_or(settings.round, |left| left.min(settings.round)))
    }

    /// Returns what the program was not told.
    pub(super) fn event(&mut self, now: u32) -> Option<Event> {
        let (news, valid) = (&mut self.news, self.settings.valid);
        let of_bus = news.rival.take().map(Event::Rival);
        let of_bus = of_bus.or_else(|| core::mem::take(&mut news.is_kept_on).then_some(Event::KeptOn));
        let of_bus = of_bus.or_else(|| core::mem::take(&mut news.may_wake).then_some(Event::MayWake));
        of_bus.or_else(|| self.modules.iter_mut().find_map(|module| module.news(valid, now)))
    }
}

/// Builds what sets the output of a module, and then what switches it on if it is to be.
fn output<P: Quantities + Addressed>(
    settings: &Settings,
    target: P::Target,
    point: SetPoint,
    is_on: bool,
) -> [Option<Request<P, ()>>; 3] {
    if is_on {
        request::deliver::<P>(settings, target, point).unwrap_or_default()
    } else {
        request::prepare::<P>(settings, target, point)
    }
}

/// Returns how long a module may not answer until it may act by itself: the watchdog without the wait for an answer,
/// or three rounds.
fn patience<P: Quantities>(settings: &Settings) -> u32 {
    let Settings { pace, round, .. } = settings;
    let wait = pace.wait.saturating_add(pace.late);
    watchdog::<P>().map_or(round.saturating_mul(3), |watchdog| watchdog.saturating_sub(wait))
}

/// Tests whether an echo says what was asked for.
fn agrees<P: Quantities>(asked: &Received<P>, said: &Received<P>) -> bool {
    said.confirms(asked, TOLERANCE)
}
