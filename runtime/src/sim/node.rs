//! A device on the bus.

use super::tally::count;
use super::wire::{Sender, Wire};
use super::{Answer, Device, Faults, Random, Rules, Tally};
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
    /// Since when the client could have fed it.
    fed: u32,
    /// Whether it has gone unfed since.
    is_unfed: bool,
}

impl<D> Node<D> {
    pub const fn new(number: u8, device: D) -> Self {
        let (faults, tally) = (Faults::NONE, Tally::NONE);
        let (is_dead, is_alone, is_unfed) = (false, false, false);
        Self { number, device, faults, tally, is_dead, heard: 0, boots: None, is_alone, fed: 0, is_unfed }
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
        self.boots = Some(now.wrapping_add(boot));
        self.hear(now);
    }

    /// Begins to wait for the next request.
    const fn hear(&mut self, now: u32) {
        (self.heard, self.is_alone) = (now, false);
        (self.fed, self.is_unfed) = (now, false);
    }

    /// Lets time pass, and tells whether the client has just left it unfed for too long. The bus may be `cut`.
    pub fn tick<P: Protocol>(&mut self, rules: &Rules, cut: bool, now: u32) -> bool
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
            self.boots = None;
            self.hear(now);
        }
        self.device.tick(now);
        if cut {
            self.fed = now;
        }
        let has_waited = |since| rules.watchdog.is_some_and(|longest| now.wrapping_sub(since) > longest);
        if self.is_up() && !self.is_alone && has_waited(self.heard) {
            self.is_alone = true;
            self.device.silence(now);
        }
        let is_unfed = self.is_up() && !self.is_unfed && has_waited(self.fed);
        self.is_unfed |= is_unfed;
        is_unfed
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
        if self.is_alone {
            count(&mut self.tally.wakes, true);
            self.device.wake(now);
        }
        self.hear(now);
        let answer = if self.boots.is_some() {
            if self.faults.is_mute_at_start { Answer::Silence } else { Answer::Starting }
        } else if self.refuses(request, random) {
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

    /// Draws whether it refuses a request.
    fn refuses<P: Protocol>(&mut self, request: &Received<P>, random: &mut Random) -> bool {
        let percent = if is_of(request, self.faults.always_refused) { 100 } else { self.faults.refused };
        happens(random, percent, &mut self.tally.refused)
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
        if is_of(request, self.faults.always_short) {
            count(&mut self.tally.broken, true);
            self.deliver(shorter(reply), random, wire, now);
        } else {
            self.carry(reply, random, wire, now);
        }
    }

    /// Puts the other faults of frames into one, and sends it as often as it comes.
    pub fn carry<const W: usize>(&mut self, reply: Frame, random: &mut Random, wire: &mut Wire<W>, now: u32) {
        let is_broken = happens(random, self.faults.broken, &mut self.tally.broken);
        self.deliver(if is_broken { cut(reply, random) } else { reply }, random, wire, now);
    }

    /// Sends a frame as often as it comes.
    fn deliver<const W: usize>(&mut self, reply: Frame, random: &mut Random, wire: &mut Wire<W>, now: u32) {
        let Faults { lost, twice, slowest, .. } = self.faults;
        for _ in 0..=u8::from(happens(random, twice, &mut self.tally.twice)) {
            let delay = random.below(slowest.max(1)).saturating_add(1);
            if !happens(random, lost, &mut self.tally.lost) {
                let at = wire.send(now.wrapping_add(delay), Sender::Device(self.number), reply);
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

/// Tests whether a request is of the message with a name.
fn is_of<P: Protocol>(request: &Received<P>, message: Option<&str>) -> bool {
    message == Some(request.exchange().message())
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
    if length == 8 || random.chance(50) { shorter(frame) } else { frame.with(frame.bytes(), length.saturating_add(1)) }
}

/// Takes a byte away.
fn shorter(frame: Frame) -> Frame {
    frame.with(frame.bytes(), frame.byte_count().saturating_sub(1))
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
