//! Hours of a station whose modules fail by a seed.
//!
//! Groups deliver, are stopped, and are left in peace, again and again. A run asserts what the station promises:
//! - no request comes sooner after another one than the document allows, and none is forbidden,
//! - each live module that was found is fed before its watchdog runs out, while the bus is there and the station has not
//!   given way,
//! - each request of a client ends once, as answered, refused, lost or done,
//! - after a stop no module delivers for longer than two rounds after it has heard anything. It is never on while it is
//!   known to be off. In peace, each is known to be off, or is unknown if it is dead,
//! - no value counts that is older than it may be, and no output is beyond a limit.
//!
//! Meanwhile the bus goes away, the program stands still while the driver keeps frames, the clock goes back, and other
//! controllers read and set. No module is ever switched on without its set-point, and each delivers if its answers are not too poor.

use std::collections::HashMap;
use std::fmt;
use std::ops::AddAssign;

use canspec_runtime::client::{Client, Heard, Output, Step, Ticket};
use canspec_runtime::sim::{Event, Faults, Random, Tally};
use canspec_runtime::{Addressed, Quantities, Quantity, Request};

use crate::bus::Bus;
use canspec_station::{LIMITS, ROUND, output, pace};

/// The voltage in mV, and the current in mA.
const OUTPUT: (i32, i32) = (500_000, 2 * LIMITS.rise_ma);
/// How long a cycle delivers, is stopped while modules fail, and is left in peace.
const DELIVER: u32 = 60_000;
const STOP: u32 = 30_000;
const PEACE: u32 = 20_000;
pub const CYCLE: u32 = DELIVER + STOP + PEACE;
/// After this time a module with fair answers delivers.
const SETTLED: u32 = 25_000;
/// How many of a hundred frames have a fault, at most, in fair and in poor cycles.
const FAIR: u8 = 5;
const POOR: u8 = 30;

/// How often what happened.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts([u64; NAMES.len()]);

const NAMES: [&str; 19] = [
    "runs",
    "frames sent",
    "frames heard",
    FAULTS[0],
    FAULTS[1],
    FAULTS[2],
    FAULTS[3],
    FAULTS[4],
    FAULTS[5],
    FAULTS[6],
    TROUBLES[0],
    TROUBLES[1],
    TROUBLES[2],
    TROUBLES[3],
    "stops",
    "modules found off",
    "dead modules unknown",
    "requests answered or refused",
    "requests lost",
];

/// What happens at least once in each run.
const FAULTS: [&str; 7] = [
    "frames lost",
    "frames repeated",
    "frames of a wrong length",
    "refusals",
    "milliseconds of delay",
    "restarts",
    "deaths",
];

/// What happens to the bus, to the program and by others.
const TROUBLES: [&str; 4] =
    ["buses away", "programs that stand still", "clocks that go back", "other controllers that set"];

/// How long a trouble lasts at most.
const LONGEST_TROUBLE: u32 = 14_000;

impl Counts {
    fn add(&mut self, name: &str, count: u64) {
        let place = NAMES.iter().position(|known| *known == name).expect("it is one of the names");
        self.0[place] += count;
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.0.iter_mut().zip(other.0).for_each(|(own, other)| *own += other);
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        NAMES.iter().zip(self.0).try_for_each(|(name, count)| writeln!(formatter, "{count:>12} {name}"))
    }
}

/// A run.
pub struct Run<P: Quantities + Addressed, const N: usize, const G: usize> {
    pub bus: Bus<P, N, G>,
    pub groups: [u8; G],
    pub nodes: [u8; N],
    /// The error code of a refusal.
    pub code: u64,
    pub random: Random,
    pub counts: Counts,
    /// When the trouble of this phase begins and ends, and which one it is.
    pub trouble: (u32, u32, usize),
}

impl<P: Quantities + Addressed<Target: PartialEq>, const N: usize, const G: usize> Run<P, N, G> {
    /// Runs until a time, in milliseconds, and says what the station does wrong.
    pub fn until(mut self, end: u32) -> Result<Counts, String> {
        self.counts.add("runs", 1);
        let cycles = end.div_ceil(CYCLE);
        for cycle in 0..cycles {
            self.cycle(cycle).map_err(|wrong| format!("at {} ms: {wrong}", self.bus.now))?;
            self.counts.add("frames sent", u64::try_from(self.bus.sent.len()).expect("few"));
            self.bus.sent.clear();
        }
        self.counts.add("frames heard", self.bus.heard);
        self.requests()?;
        let Tally { lost, twice, broken, refused, delay, restarts, deaths, .. } = self.bus.bench.tally();
        let faults = [lost, twice, broken, refused, delay, restarts, deaths];
        FAULTS.iter().zip(faults).for_each(|(name, count)| self.counts.add(name, count));
        match FAULTS.iter().zip(faults).find(|(_, count)| *count == 0) {
            Some((name, _)) => Err(format!("no {name} in the whole run")),
            None => Ok(self.counts),
        }
    }

    fn cycle(&mut self, cycle: u32) -> Result<(), String> {
        let start = self.bus.now;
        let is_fair = self.draw_faults(cycle);
        // What another controller has switched on does not count.
        self.nodes.into_iter().for_each(|node| self.bus.device(node).was_bare = false);
        self.deliver()?;
        self.draw_trouble(false);
        self.pass(start + DELIVER / 2, false)?;
        // What has given way delivers again.
        self.deliver()?;
        self.pass(start + DELIVER, false)?;
        if is_fair {
            self.check_output()?;
        }
        for group in self.groups {
            self.bus.station.stop(group, self.bus.clock()).map_err(|refused| format!("{refused:?}"))?;
            self.counts.add("stops", 1);
        }
        for node in self.nodes {
            self.bus.device(node).on_heard = None;
        }
        self.draw_trouble(true);
        self.pass(start + DELIVER + STOP, true)?;
        self.check_off()?;
        for node in self.nodes {
            let faults = self.bus.faults(node);
            *faults = Faults { dies: faults.dies, ..Faults::NONE };
        }
        self.pass(start + CYCLE, true)?;
        self.check_off()?;
        self.check_states()
    }

    fn deliver(&mut self) -> Result<(), String> {
        let now = self.bus.clock();
        self.groups.into_iter().try_for_each(|group| {
            let point = output(OUTPUT.0, OUTPUT.1);
            self.bus.station.deliver(group, point, now).map_err(|refused| format!("{refused:?}"))
        })
    }

    /// Draws the trouble of a phase.
    fn draw_trouble(&mut self, is_stopped: bool) {
        let kind = usize::try_from(self.random.below(4)).expect("below 4");
        // What another controller sets while a group delivers ends that, as one of the tests shows.
        let kind = if !is_stopped && kind == 3 { 0 } else { kind };
        let begins = self.bus.now + self.random.below(10_000);
        self.trouble = (begins, begins + 1 + self.random.below(LONGEST_TROUBLE), kind);
    }

    /// Lets the trouble begin and end.
    fn trouble(&mut self) {
        let (begins, ends, kind) = self.trouble;
        if self.bus.now < begins {
            return;
        }
        let is_over = self.bus.now >= ends;
        match kind {
            0 => self.bus.is_down = !is_over,
            1 => self.bus.is_stalled = !is_over,
            2 => self.bus.ahead = self.bus.ahead.wrapping_sub(self.random.below(60_000)),
            _ => self.another_controller(),
        }
        if kind < 2 {
            // Modules that were not fed meanwhile are found again in the next rounds.
            self.bus.excused = self.bus.now + 3 * ROUND;
            // Nobody can tell them anything.
            self.nodes.into_iter().for_each(|node| self.bus.device(node).on_heard = None);
        }
        if is_over || kind >= 2 {
            self.trouble.0 = u32::MAX;
            self.counts.add(TROUBLES[kind], 1);
        }
    }

    /// Lets another controller switch a module on, once.
    fn another_controller(&mut self) {
        let node = self.nodes[usize::try_from(self.random.below(2)).expect("below 2")];
        self.bus.device(node).was_bare = false;
        let target = P::module(node.into()).expect("a module");
        let switch = P::set(&[(Quantity::DELIVERING, 1)], target).expect("it is legal").next().expect("one message");
        let _ = self.bus.bench.another_controller(*switch.frame(), u32::MAX / 4, self.bus.now);
    }

    /// Lets time pass, in turns of the program that take up to 15 ms.
    fn pass(&mut self, until: u32, is_stopped: bool) -> Result<(), String> {
        while self.bus.now < until {
            self.trouble();
            self.bus.turn()?;
            for node in self.nodes {
                let now = self.bus.now;
                let device = *self.bus.device(node);
                let was_told = |at: u32| is_stopped && now > at + 2 * ROUND && self.bus.bench.is_up(node);
                if device.on_heard.is_some_and(was_told) {
                    return Err(format!("module {node} has heard something since the stop, and is on"));
                }
                let is_others = self.trouble.2 == 3 && is_stopped;
                if device.was_bare && !is_others {
                    return Err(format!("module {node} is switched on without its set-point"));
                }
                if is_stopped && device.is_on && self.bus.state(node) == Some(Output::Off) {
                    return Err(format!("module {node} is on, and said to be off"));
                }
            }
            self.bus.now += 1 + self.random.below(15);
        }
        Ok(())
    }

    /// Draws the faults of a cycle, and revives modules. Each kind happens in the first cycle.
    fn draw_faults(&mut self, cycle: u32) -> bool {
        let now = self.bus.now;
        let is_fair = cycle % 2 == 1;
        for (place, node) in self.nodes.into_iter().enumerate() {
            if self.bus.faults(node).dies.is_some() {
                self.bus.bench.restart(node, now);
            }
            let random = &mut self.random;
            let drawn = Faults::random(random, if is_fair { FAIR } else { POOR }, DELIVER + STOP);
            let (restarts, dies) = match (cycle, place) {
                (0, 0) => (Some(random.below(DELIVER)), None),
                (0, 1) => (None, Some(random.below(DELIVER))),
                _ => (drawn.restarts, drawn.dies),
            };
            let slowest = 1 + random.below(if is_fair { 1 } else { 2 } * pace::<P>().wait);
            *self.bus.faults(node) = Faults {
                // Half of what is lost is lost on the way to the module.
                deaf: drawn.deaf / 2,
                lost: drawn.lost / 2,
                refused: drawn.refused / 3,
                // A reply under another address says of one module what is true of another. Nothing shows that.
                disguised: 0,
                code: self.code,
                slowest,
                restarts: restarts.map(|time| now + time),
                dies: dies.map(|time| now + time),
                ..drawn
            };
            if (cycle, place) == (0, 2) {
                self.make_mute(node);
            }
        }
        is_fair
    }

    /// Lets a module deliver that hears all and says nothing, as one that was switched on before and is not found.
    fn make_mute(&mut self, node: u8) {
        let Faults { code, .. } = *self.bus.faults(node);
        *self.bus.faults(node) = Faults { lost: 100, code, ..Faults::NONE };
        let device = self.bus.device(node);
        (device.voltage_mv, device.current_ma, device.is_on) = (Some(OUTPUT.0), Some(OUTPUT.1), true);
    }

    /// Tests that each module delivers that has had the time.
    fn check_output(&mut self) -> Result<(), String> {
        for node in self.nodes {
            let dies = self.bus.faults(node).dies;
            let device = *self.bus.device(node);
            if dies.is_none() && device.started + SETTLED < self.bus.now && !device.is_on {
                return Err(format!("module {node} does not deliver"));
            }
        }
        Ok(())
    }

    /// Tests that each live module is off.
    fn check_off(&mut self) -> Result<(), String> {
        for node in self.nodes {
            if self.bus.bench.is_up(node) && self.bus.device(node).is_on {
                return Err(format!("module {node} is on after a stop"));
            }
        }
        Ok(())
    }

    /// Tests that each live module is known to be off, and each dead one unknown.
    fn check_states(&mut self) -> Result<(), String> {
        for node in self.nodes {
            let (state, is_dead) = (self.bus.state(node), self.bus.faults(node).dies.is_some());
            let expected = if is_dead { Output::Unknown } else { Output::Off };
            if state != Some(expected) && !(is_dead && state.is_none()) {
                return Err(format!("module {node} is {state:?}, not {expected:?}"));
            }
            if is_dead && self.bus.station.voltage_mv(node, self.bus.clock()).fresh().is_some() {
                return Err(format!("the voltage of the dead module {node} counts"));
            }
            self.counts.add(if is_dead { "dead modules unknown" } else { "modules found off" }, 1);
        }
        Ok(())
    }

    /// Asks modules at random while they fail. Each request ends once, by its own answer or after all tries.
    fn requests(&mut self) -> Result<(), String> {
        let start = self.bus.now;
        self.draw_faults(0);
        let mut client: Client<P, 12> = Client::new(pace::<P>());
        let mut asked: HashMap<Ticket, Asked> = HashMap::new();
        for now in start..start + 20_000 {
            while let Some(event) = self.bus.bench.poll(now) {
                let Event::Frame { frame, at } = event else { continue };
                match client.handle(&frame, at) {
                    Heard::Answer { ticket, received } => {
                        let said = received.setting(Quantity::OUTPUT_VOLTAGE);
                        let own = asked.get_mut(&ticket).ok_or("an answer to what was not asked")?;
                        if said != Some(own.voltage_mv) {
                            return Err(format!("an answer to {} mV says {said:?}", own.voltage_mv));
                        }
                        own.answered += 1;
                    }
                    Heard::Refusal { ticket, .. } | Heard::ShortRefusal(ticket) => {
                        asked.get_mut(&ticket).ok_or("a refusal of what was not asked")?.answered += 1;
                    }
                    _ => {}
                }
            }
            loop {
                match client.poll(now) {
                    Step::Send { frame, ticket } => {
                        asked.get_mut(&ticket).ok_or("what was not asked is sent")?.sent += 1;
                        self.bus.bench.send(&frame, now);
                    }
                    Step::Lost(ticket) => asked.get_mut(&ticket).ok_or("what was not asked is lost")?.lost += 1,
                    Step::Done(_) | Step::Missing { .. } | Step::Silent(_) | Step::Back(_) => {}
                    Step::ClockBack(_) => return Err("the clock goes back".into()),
                    Step::Wait(_) => break,
                }
            }
            if now < start + 8000 && self.random.chance(5) {
                let voltage_mv = 300_000 + 100 * i32::try_from(asked.len()).expect("few");
                if let Ok(ticket) = client.ask(self.request(voltage_mv), now) {
                    asked.insert(ticket, Asked { voltage_mv, sent: 0, answered: 0, lost: 0 });
                }
            }
        }
        let tries = pace::<P>().tries.into();
        let ends_once = |own: &Asked| own.answered + own.lost == 1 && (own.lost == 0 || own.sent == tries);
        if asked.len() < 20 || !asked.values().all(ends_once) {
            return Err(format!("of {} requests, one does not end once, or is lost too early", asked.len()));
        }
        self.counts.add("requests answered or refused", asked.values().map(|own| own.answered).sum());
        self.counts.add("requests lost", asked.values().map(|own| own.lost).sum());
        Ok(())
    }

    /// Sets the voltage of one of two modules.
    fn request(&mut self, voltage_mv: i32) -> Request<P, ()> {
        let node = self.nodes[usize::try_from(self.random.below(2)).expect("below 2")];
        let target = P::module(node.into()).expect("a module");
        let values = [(Quantity::OUTPUT_VOLTAGE, voltage_mv), (Quantity::OUTPUT_CURRENT, 1000)];
        P::set(&values, target).expect("it is legal").next().expect("one message has the voltage")
    }
}

/// A request, and how often it was sent and ended.
struct Asked {
    voltage_mv: i32,
    sent: u64,
    answered: u64,
    lost: u64,
}

/// Runs a station of INFY modules, or of Maxwell ones, by a seed.
pub fn run(seed: u64, end: u32) -> Result<Counts, String> {
    let (random, counts) = (Random::new(!seed), Counts::default());
    if seed.is_multiple_of(2) {
        let (bus, nodes) = (crate::bus::fleets::infies(seed), [0, 1, 2, 3, 4, 5, 6, 7]);
        Run { bus, groups: [1, 2], nodes, code: 4, random, counts, trouble: (u32::MAX, 0, 0) }.until(end)
    } else {
        let (bus, nodes) = (crate::bus::fleets::maxwells(seed), [3, 4, 5, 6]);
        Run { bus, groups: [5], nodes, code: 0xF2, random, counts, trouble: (u32::MAX, 0, 0) }.until(end)
    }
}
