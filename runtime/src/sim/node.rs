//! A device on the bus.

use super::{Answer, Device, Faults, Random, Rules, Tally, Wire};
use crate::clock::has_come;
use crate::plumbing::Who;
use crate::{Addressed, Destination, Error, Frame, Protocol, Received};

/// A device on the bus.
#[derive(Clone, Copy, Debug)]
pub struct Node<D> {
    pub number: u8,
    pub device: D,
    pub faults: Faults,
    pub tally: Tally,
    /// Whether it has died. It stays so when time wraps around.
    is_dead: bool,
    /// When it heard a request last.
    heard: u32,
    /// Until when it starts, if it does.
    boots: Option<u32>,
    /// Whether its watchdog has run out since.
    is_alone: bool,
}

impl<D> Node<D> {
    pub const fn new(number: u8, device: D) -> Self {
        let (faults, tally) = (Faults::NONE, Tally::NONE);
        Self { number, device, faults, tally, is_dead: false, heard: 0, boots: None, is_alone: false }
    }

    /// Tests whether it is on, and has started.
    pub const fn is_up(&self) -> bool {
        !self.is_dead && self.boots.is_none()
    }

    /// Tests whether it has died by now.
    fn is_dead_at(&mut self, now: u32) -> bool {
        let dies = !self.is_dead && self.faults.dies.is_some_and(|time| has_come(time, now));
        self.is_dead |= dies;
        count(&mut self.tally.deaths, dies);
        self.is_dead
    }

    /// Starts anew.
    pub fn restart<P: Protocol>(&mut self, boot: u32, now: u32)
    where
        D: Device<P>,
    {
        self.device.power_on(now);
        count(&mut self.tally.restarts, true);
        self.faults.dies = self.faults.dies.filter(|time| !has_come(*time, now));
        self.is_dead = false;
        (self.boots, self.heard, self.is_alone) = (Some(now.wrapping_add(boot)), now, false);
    }

    /// Lets time pass, and tells whether the watchdog has just run out.
    pub fn tick<P: Protocol>(&mut self, rules: &Rules, now: u32) -> bool
    where
        D: Device<P>,
    {
        if self.is_dead_at(now) {
            return false;
        }
        if self.faults.restarts.is_some_and(|time| has_come(time, now)) {
            self.faults.restarts = None;
            self.restart(rules.boot, now);
        }
        if self.boots.is_some_and(|time| has_come(time, now)) {
            (self.boots, self.heard) = (None, now);
        }
        self.device.tick(now);
        let silence = now.wrapping_sub(self.heard);
        let is_out = !self.is_alone && self.is_up() && rules.watchdog.is_some_and(|longest| silence > longest);
        if is_out {
            self.is_alone = true;
            self.device.silence(now);
        }
        is_out
    }

    /// Returns what it sends by itself.
    pub fn report<P: Protocol>(&mut self, now: u32) -> Option<Frame>
    where
        D: Device<P>,
    {
        if self.is_up() { self.device.report(self.number, now) } else { None }
    }

    /// Tests whether it is the module that a request addresses, or one of many.
    pub fn is_asked<P: Protocol>(&self, request: &Received<P>, module: Option<i32>) -> bool
    where
        D: Device<P>,
    {
        match module {
            Some(module) => module == i32::from(self.number),
            None => self.device.is_asked(request),
        }
    }

    /// Takes a request, and returns what it answers. Fails if that is no reply to the request.
    pub fn answer<P: Addressed>(
        &mut self,
        request: &Received<P>,
        random: &mut Random,
        now: u32,
    ) -> Result<Option<Frame>, Error>
    where
        D: Device<P>,
    {
        if self.is_dead_at(now) || happens(random, self.faults.deaf, &mut self.tally.lost) {
            return Ok(None);
        }
        (self.heard, self.is_alone) = (now, false);
        let answer = if self.boots.is_some() {
            if self.faults.is_mute_at_start { Answer::Silence } else { Answer::Starting }
        } else if happens(random, self.faults.refused, &mut self.tally.refused) {
            Answer::Refusal(self.faults.code)
        } else {
            self.device.answer(request, now)
        };
        let reply = match answer {
            Answer::Values(values) if happens(random, self.faults.drifted, &mut self.tally.drifted) => {
                request.answer(self.number, self.device.drift(values))
            }
            Answer::Values(values) => request.answer(self.number, values),
            Answer::Refusal(code) => request.refuse(self.number, code),
            Answer::Starting => match P::STARTING {
                Some(code) => request.refuse(self.number, code),
                None => return Ok(None),
            },
            Answer::Silence => return Ok(None),
        };
        match reply {
            Err(Error::Unanswered { .. }) => Ok(None),
            reply => reply.map(Some),
        }
    }

    /// Puts the faults of frames into a reply, and sends it.
    pub fn spoil<P: Addressed, const W: usize>(
        &mut self,
        request: &Received<P>,
        reply: Frame,
        random: &mut Random,
        wire: &mut Wire<W>,
        now: u32,
    ) {
        let is_disguised = happens(random, self.faults.disguised, &mut self.tally.disguised);
        let reply = if is_disguised { self.disguise(request, reply, random) } else { reply };
        self.carry(reply, random, wire, now);
    }

    /// Puts the other faults of frames into one, and sends it as often as it comes.
    pub fn carry<const W: usize>(&mut self, reply: Frame, random: &mut Random, wire: &mut Wire<W>, now: u32) {
        let Faults { lost, twice, broken, slowest, .. } = self.faults;
        let is_broken = happens(random, broken, &mut self.tally.broken);
        let reply = if is_broken { cut(reply, random) } else { reply };
        for _ in 0..=u8::from(happens(random, twice, &mut self.tally.twice)) {
            let delay = random.below(slowest.max(1)).saturating_add(1);
            if !happens(random, lost, &mut self.tally.lost) {
                let at = wire.send(now.wrapping_add(delay), Some(self.number), reply);
                self.tally.delay = self.tally.delay.wrapping_add(at.wrapping_sub(now).into());
            }
        }
    }

    /// Puts the address of another module where a reply shows its sender.
    fn disguise<P: Addressed>(&self, request: &Received<P>, reply: Frame, random: &mut Random) -> Frame {
        let other = self.number.wrapping_add(1).wrapping_add(u8::try_from(random.below(3)).unwrap_or_default());
        let pattern = way(request).and_then(|(mode, who)| P::MODES.get(mode)?.reply(who));
        let mut addresses = pattern.map_or(&[][..], |pattern| pattern.addresses).iter();
        let sender = addresses
            .find(|address| !address.kind().is_sent() && address.number(reply.raw_id()) == i32::from(self.number));
        let id =
            sender.map(|address| address.bits().put(reply.raw_id().into(), address.kind().raw(other.into()).into()));
        id.map_or(reply, |id| reply.with_id(id))
    }
}

/// Counts something that happens.
fn count(counter: &mut u64, happens: bool) {
    *counter = counter.wrapping_add(happens.into());
}

/// Draws whether something happens, and counts it.
fn happens(random: &mut Random, percent: u8, counter: &mut u64) -> bool {
    let happens = random.chance(percent);
    count(counter, happens);
    happens
}

/// Takes a byte away or adds one.
fn cut(frame: Frame, random: &mut Random) -> Frame {
    let length = frame.byte_count();
    let other = if length == 8 || random.chance(50) { length.saturating_sub(1) } else { length.saturating_add(1) };
    frame.with(frame.bytes(), other)
}

/// Returns the mode of a request, and who answers.
fn way<P: Addressed>(request: &Received<P>) -> Option<(usize, Who)> {
    let mode = request.target()?.mode();
    Some((mode, request.exchange().who(mode)?))
}

/// Tests whether one module alone answers a request for all.
pub fn has_coordinator<P: Addressed>(request: &Received<P>) -> bool {
    way(request).is_some_and(|(_, who)| who == Who::Coordinator)
}
