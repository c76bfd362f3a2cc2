//! Hours of a station whose modules fail by a seed.
//!
//! Groups deliver, are stopped, and are left in peace, again and again. A run asserts what the station promises:
//! - no request comes sooner after another one than the document allows, and none is forbidden,
//! - each live module that was found is fed before its watchdog runs out, while the bus is there and the station has not
//!   given way,
//! - each request of a client ends once, as answered, refused, lost or done,
//! - after a stop each module that is on is told to be off within a round, and again in each round, later only by the
//!   stops of other addresses. So none delivers for longer than that from the first frame that arrives, unless it misses
//!   or refuses the switch-offs of a round. That holds for modules that another controller has switched on, and for those
//!   that have started by themselves, too. In peace each is off and known to be off, or unknown if it is dead,
//! - while all is stopped no module is on that is said to be off. Two modules with one address are known to contradict
//!   each other within two rounds,
//! - no value is shown as fresh that was said longer ago than values count,
//! - no limit is passed: of the voltage, of the current, of a group, and of how far the current rises at once,
//! - no module is switched on without its set-point, unless it started while a driver kept the switch-on, and each
//!   delivers whose answers are not too poor,
//! - another controller that sets something is an event, and one that reads is none.
//!
//! `watch.rs` has what must hold in each turn, and `counts.rs` what happens meanwhile.

mod counts;
mod fleet;
mod requests;
mod trouble;
mod watch;

use canspec_runtime::client::{self, Output};
use canspec_runtime::sim::{Faults, Random};
use canspec_runtime::station::Event;
use canspec_runtime::{Addressed, Exchange, Quantities, Quantity, Request};
use canspec_station::{ROUND, pace};

use crate::bus::{Charger, ONCE, rules};
pub use counts::Counts;
use fleet::Fleet;
use trouble::{Change, Kind, Other, Trouble, one_of};
use watch::{TURN, Watch};

/// How long a cycle delivers, and is left in peace. Between that it is stopped while modules fail.
const DELIVER: u32 = 60_000;
const PEACE: u32 = 20_000;
/// How long a stop takes at least after the trouble.
const QUIET: u32 = 8000;
/// How long a cycle takes where no watchdog takes longer.
pub const CYCLE: u32 = 110_000;
/// After this time a module with fair answers delivers.
const SETTLED: u32 = 25_000;
/// How many of a hundred frames have a fault, at most, in fair and in poor cycles.
const FAIR: u8 = 5;
const POOR: u8 = 30;

/// A run.
struct Run<P: Quantities + Addressed, const N: usize, const G: usize> {
    fleet: Fleet<P, N, G>,
    /// The addresses of the modules. The last one has two modules in some cycles.
    nodes: Vec<u8>,
    random: Random,
    counts: Counts,
    watch: Watch<N>,
    trouble: Trouble,
    /// Whether the station has given way to another controller.
    has_given_way: bool,
    /// How often another controller has set something in this cycle.
    rivals: usize,
}

impl<P: Quantities + Addressed<Target: PartialEq>, const N: usize, const G: usize> Run<P, N, G> {
    fn new(mut fleet: Fleet<P, N, G>, seed: u64) -> Self {
        let mut nodes: Vec<_> = fleet.bus.bench.devices().map(|(node, ..)| node).collect();
        nodes.pop();
        let (random, counts, watch) = (Random::new(!seed), Counts::default(), Watch::new());
        Self { fleet, nodes, random, counts, watch, trouble: Trouble::NONE, has_given_way: false, rivals: 0 }
    }

    /// Runs until a time, in milliseconds, and says what the station does wrong.
    fn until(mut self, end: u32) -> Result<Counts, String> {
        self.counts.add("runs", 1);
        self.twin_leaves();
        for cycle in 0..end.div_ceil(CYCLE) {
            self.cycle(cycle).map_err(|wrong| format!("at {} ms: {wrong}", self.fleet.bus.now))?;
            self.counts.add("frames sent", u64::try_from(self.fleet.bus.sent.len()).expect("few"));
            self.fleet.bus.sent.clear();
            self.fleet.bus.events.clear();
            self.watch.forget_sent();
        }
        self.counts.add("minutes", u64::from(self.fleet.bus.now / 60_000));
        self.counts.add("frames heard", self.fleet.bus.heard);
        self.counts.add("modules that miss or refuse the switch-offs of a round", self.watch.missed);
        let starts = self.fleet.bus.bench.devices().map(|(_, device, _)| device.starts).sum();
        self.counts.add("modules that start by themselves after silence", starts);
        self.requests()?;
        self.counts.add_tally(&self.fleet.bus.bench.tally());
        Ok(self.counts)
    }

    fn cycle(&mut self, cycle: u32) -> Result<(), String> {
        let start = self.fleet.bus.now;
        let is_fair = self.draw_faults(cycle);
        self.begin();
        self.deliver()?;
        self.draw_trouble(false);
        self.pass(start + DELIVER / 2)?;
        // What has given way delivers again.
        self.deliver()?;
        self.pass(start + DELIVER)?;
        if is_fair {
            self.check_output()?;
        }
        self.stop()?;
        self.draw_trouble(true);
        let watchdog = rules::<P>().watchdog;
        let quiet = self.fleet.bus.now + Trouble::longest(watchdog) + QUIET;
        // A module can miss each switch-off of these rounds. The watch sees that it is told.
        self.pass(quiet)?;
        self.count_fates(start);
        self.twin_leaves();
        self.nodes.clone().into_iter().for_each(|node| {
            let faults = self.fleet.bus.faults(node);
            *faults = Faults { dies: faults.dies, ..Faults::NONE };
        });
        self.pass(quiet + PEACE)?;
        self.check_off()?;
        self.check_states()?;
        self.check_rivals()
    }

    /// Forgets what other controllers have done to modules.
    fn begin(&mut self) {
        (self.watch.stopped, self.watch.woken, self.rivals) = (None, None, 0);
        for (_, device, _) in self.fleet.bus.bench.devices() {
            (device.was_bare, device.steepest_ma) = (false, 0);
        }
    }

    fn deliver(&mut self) -> Result<(), String> {
        let Fleet { bus, groups, point, .. } = &mut self.fleet;
        let now = bus.clock();
        self.has_given_way = false;
        groups
            .iter()
            .try_for_each(|group| bus.station.deliver(*group, *point, now).map_err(|refused| format!("{refused:?}")))
    }

    fn stop(&mut self) -> Result<(), String> {
        let Fleet { bus, groups, .. } = &mut self.fleet;
        for group in *groups {
            bus.station.stop(group, bus.clock()).map_err(|refused| format!("{refused:?}"))?;
            self.counts.add("stops", 1);
        }
        self.watch.stopped = Some(bus.now);
        Ok(())
    }

    fn draw_trouble(&mut self, is_stopped: bool) {
        let watchdog = rules::<P>().watchdog;
        self.trouble = Trouble::draw(&mut self.random, watchdog, is_stopped, self.fleet.bus.now);
    }

    /// Lets the trouble begin and end.
    fn trouble(&mut self) {
        let bus = &mut self.fleet.bus;
        let now = bus.now;
        match self.trouble.change(now) {
            Some(Change::Begins) => {
                let kind = self.trouble.kind;
                self.counts.add(kind.name(), 1);
                (bus.is_down, bus.is_stalled) = (kind.is_away(), kind == Kind::Still);
                self.trouble.outage(now).into_iter().for_each(|outage| bus.bench.cut(outage));
                match kind {
                    Kind::Off => bus.station.bus(client::Bus::Off, bus.clock()),
                    Kind::Kept => self.watch.kept = Some((now, self.trouble.ends)),
                    Kind::Clock => bus.ahead = bus.ahead.wrapping_sub(self.random.below(60_000)),
                    Kind::Refused | Kind::Dropped | Kind::Still => {}
                }
            }
            Some(Change::Ends) => {
                (bus.is_down, bus.is_stalled) = (false, false);
                bus.station.bus(client::Bus::On, bus.clock());
                bus.bench.no_other_controllers();
            }
            None => {}
        }
        if self.trouble.parts() {
            self.watch.parted = now;
        }
        if self.trouble.parts() || self.has_given_way {
            // Modules that were not fed meanwhile are found again in the next rounds.
            bus.excused = now + 3 * ROUND;
        }
        if self.trouble.other_at.is_some_and(|at| now >= at) {
            self.trouble.other_at = None;
            self.another_controller();
        }
    }

    /// Lets another controller do something with a module.
    fn another_controller(&mut self) {
        let other = self.trouble.other;
        let node = one_of(&mut self.random, &self.nodes);
        let target = P::module(node.into()).expect("a module");
        let one = |requests: Option<Request<P, ()>>| *requests.expect("there is a message").frame();
        let read = P::read(&[Quantity::OUTPUT_VOLTAGE], target).expect("it is read").next();
        let switch = P::set(&[(Quantity::DELIVERING, 1)], target).expect("it is legal").next();
        let (frame, every) = match other {
            Other::Reads => (one(read), 100 + self.random.below(900)),
            Other::Sets => (one(Some(self.sets(node, self.fleet.other_mv))), ONCE),
            Other::SwitchesOn => (one(switch), ONCE),
        };
        let bus = &mut self.fleet.bus;
        if other != Other::Reads {
            bus.bench.no_other_controllers();
            self.rivals += 1;
        }
        self.has_given_way = other != Other::Reads && self.watch.stopped.is_none();
        self.watch.woken = (other == Other::SwitchesOn).then_some(node).or(self.watch.woken);
        bus.bench.another_controller(frame, every, bus.now).expect("there is no other one");
        self.counts.add(other.name(), 1);
    }

    /// Sets the voltage of a module, and its current if that can be set.
    fn sets(&self, node: u8, voltage_mv: i32) -> Request<P, ()> {
        let target = P::module(node.into()).expect("a module");
        let values = [(Quantity::OUTPUT_VOLTAGE, voltage_mv), (Quantity::OUTPUT_CURRENT, 1000)];
        let values = if self.fleet.point.current_ma.is_some() { &values[..] } else { &values[..1] };
        P::set(values, target).expect("it is legal").next().expect("one message has the voltage")
    }

    /// Lets time pass, in turns of the program.
    fn pass(&mut self, until: u32) -> Result<(), String> {
        while self.fleet.bus.now < until {
            self.trouble();
            let Fleet { bus, limits, .. } = &mut self.fleet;
            bus.receive()?;
            self.watch.received(bus);
            bus.act();
            self.watch.look(bus, limits)?;
            bus.now += 1 + self.random.below(TURN);
        }
        Ok(())
    }

    /// Draws the faults of a cycle, and revives modules. A restart, a death and a mute module happen in the first one.
    fn draw_faults(&mut self, cycle: u32) -> bool {
        let now = self.fleet.bus.now;
        let is_fair = cycle % 2 == 1;
        let stop = Trouble::longest(rules::<P>().watchdog) + QUIET;
        for (place, node) in self.nodes.clone().into_iter().enumerate() {
            if self.fleet.bus.faults(node).dies.is_some() {
                self.fleet.bus.bench.restart(node, now);
            }
            let random = &mut self.random;
            let drawn = Faults::random(random, if is_fair { FAIR } else { POOR }, DELIVER + stop);
            let (restarts, dies) = match (cycle, place) {
                (0, 0) => (Some(random.below(DELIVER)), None),
                (0, 1) => (None, Some(random.below(DELIVER))),
                _ => (drawn.restarts, drawn.dies),
            };
            let slowest = 1 + random.below(if is_fair { 1 } else { 2 } * pace::<P>().wait);
            *self.fleet.bus.faults(node) = Faults {
                // Half of what is lost is lost on the way to the module.
                deaf: drawn.deaf / 2,
                lost: drawn.lost / 2,
                refused: drawn.refused / 3,
                // A reply under another address says of one module what is true of another. Nothing shows that.
                disguised: 0,
                code: self.fleet.code,
                slowest,
                restarts: restarts.map(|time| now + time),
                dies: dies.map(|time| now + time),
                ..drawn
            };
        }
        if cycle == 0 {
            self.make_mute(self.nodes[2]);
        }
        self.draw_lasting(cycle);
        self.twin_leaves();
        if cycle > 0 && self.random.chance(50) {
            self.twin_comes();
        }
        is_fair
    }

    /// Draws what a module does with one request for the whole cycle: an answer that is too short, or a refusal. It is none
    /// that fails otherwise.
    fn draw_lasting(&mut self, cycle: u32) {
        let messages: Vec<_> = messages::<P>();
        let fit = if cycle == 0 { 3..self.nodes.len() } else { 0..self.nodes.len() - 1 };
        let fit = self.nodes[fit].to_vec();
        let [first, second] = [0; 2].map(|_| one_of(&mut self.random, &fit));
        let [short, refused] = [0; 2].map(|_| one_of(&mut self.random, &messages));
        self.fleet.bus.faults(first).always_short = Some(short);
        self.fleet.bus.faults(second).always_refused = Some(refused);
        self.counts.add("modules whose answers to one request are always too short", 1);
        self.counts.add("modules that always refuse one request", 1);
    }

    /// Lets a module deliver that hears all and says nothing, as one that was switched on before and is not found.
    fn make_mute(&mut self, node: u8) {
        let Fleet { bus, point, .. } = &mut self.fleet;
        let Faults { code, .. } = *bus.faults(node);
        *bus.faults(node) = Faults { lost: 100, code, ..Faults::NONE };
        let device = bus.device(node);
        (device.voltage_mv, device.current_ma, device.is_on) = (Some(point.voltage_mv), point.current_ma, true);
    }

    /// Adds a module with the address of the last one, both without faults. In half of the cases it is on whatever it is
    /// told.
    fn twin_comes(&mut self) {
        let Fleet { bus, point, .. } = &mut self.fleet;
        let now = bus.now;
        let Some(node) = self.nodes.last().copied() else { return };
        let is_stuck = self.random.chance(50);
        bus.bench.restart(node, now);
        for (_, _, faults) in bus.bench.devices().filter(|(known, ..)| *known == node) {
            *faults = Faults { slowest: pace::<P>().wait / 2, ..Faults::NONE };
        }
        let Some((_, twin, _)) = bus.bench.devices().last() else { return };
        (twin.is_stuck, twin.is_on) = (is_stuck, is_stuck);
        if is_stuck {
            (twin.voltage_mv, twin.current_ma) = (Some(point.voltage_mv), point.current_ma);
        }
        self.watch.shared = Some(node);
        self.counts.add("modules with the address of another one", 1);
    }

    /// Takes that module away.
    fn twin_leaves(&mut self) {
        let now = self.fleet.bus.now;
        let Some((_, twin, faults)) = self.fleet.bus.bench.devices().last() else { return };
        twin.is_stuck = false;
        faults.dies = Some(now);
        self.watch.shared = None;
    }

    /// Counts the modules that have started anew by themselves since a time, and those that have died.
    fn count_fates(&mut self, start: u32) {
        let now = self.fleet.bus.now;
        for node in self.nodes.clone() {
            let has_died = watch::is_dead(self.fleet.bus.faults(node), now);
            self.counts.add("modules that restart", u64::from(self.fleet.bus.device(node).started > start));
            self.counts.add("modules that die", u64::from(has_died));
        }
    }

    /// Returns the current that each module of a full group has at least, if currents are set, in mA.
    fn share_ma(&self) -> Option<i32> {
        self.fleet.point.current_ma.map(|current_ma| current_ma.min(self.fleet.limits.group_ma / 4))
    }

    /// Tests that each module delivers what it is to that has had the time, and refuses nothing for ever.
    fn check_output(&mut self) -> Result<(), String> {
        for node in self.nodes.clone() {
            let Faults { dies, always_short, always_refused, .. } = *self.fleet.bus.faults(node);
            let device = *self.fleet.bus.device(node);
            let is_fit = (dies, always_short, always_refused) == (None, None, None);
            let has_settled = device.started + SETTLED < self.fleet.bus.now;
            let delivers = device.is_on
                && device.voltage_mv == Some(self.fleet.point.voltage_mv)
                && device.current_ma >= self.share_ma();
            if is_fit && has_settled && !delivers {
                let Charger { is_on, voltage_mv, current_ma, .. } = device;
                return Err(format!("module {node} delivers {voltage_mv:?} mV and {current_ma:?} mA, on: {is_on}"));
            }
        }
        Ok(())
    }

    /// Tests that each live module is off that does not refuse it for ever.
    fn check_off(&mut self) -> Result<(), String> {
        let now = self.fleet.bus.now;
        for (node, device, faults) in self.fleet.bus.bench.devices() {
            let is_deaf = device.is_stuck || faults.always_refused == switch::<P>() || watch::is_dead(faults, now);
            if device.is_on && !is_deaf {
                return Err(format!("module {node} is on after a stop"));
            }
        }
        Ok(())
    }

    /// Tests that each live module is known to be off, and each dead one unknown.
    fn check_states(&mut self) -> Result<(), String> {
        let bus = &mut self.fleet.bus;
        for node in self.nodes.clone() {
            let (state, is_dead) = (bus.state(node), bus.faults(node).dies.is_some());
            let expected = if is_dead { Output::Unknown } else { Output::Off };
            if state != Some(expected) && !(is_dead && state.is_none()) {
                return Err(format!("module {node} is {state:?}, not {expected:?}"));
            }
        }
        Ok(())
    }

    /// Tests that the program was told of each controller that has set something.
    fn check_rivals(&mut self) -> Result<(), String> {
        let told = self.fleet.bus.events.iter().filter(|(_, event)| matches!(event, Event::Rival(_))).count();
        if told != self.rivals {
            return Err(format!("other controllers have set something {} times, and {told} were told", self.rivals));
        }
        Ok(())
    }

    /// Lets a module answer every request.
    fn answer_all(&mut self, node: u8) {
        let faults = self.fleet.bus.faults(node);
        (faults.always_short, faults.always_refused) = (None, None);
    }
}

/// Returns the message that switches a module off.
fn switch<P: Quantities>() -> Option<&'static str> {
    P::SETS.iter().find(|path| path.quantity == Quantity::DELIVERING).map(|path| path.request.message())
}

/// Returns the messages that a station sends to each module.
fn messages<P: Quantities>() -> Vec<&'static str> {
    let is_used =
        |quantity| [Quantity::OUTPUT_VOLTAGE, Quantity::OUTPUT_CURRENT, Quantity::DELIVERING].contains(&quantity);
    let reads = P::READS.iter().filter(|path| is_used(path.quantity)).filter_map(|path| path.request);
    let sets = P::SETS.iter().filter(|path| is_used(path.quantity)).map(|path| path.request);
    let mut messages: Vec<_> = reads.chain(sets).map(Exchange::message).collect();
    messages.sort_unstable();
    messages.dedup();
    messages
}

/// Runs a station of INFY modules, of Maxwell ones or of MEGMEET ones, by a seed, for so many milliseconds or longer.
pub fn run(seed: u64, end: u32) -> Result<Counts, String> {
    match seed % 3 {
        0 => Run::new(fleet::infies(seed), seed).until(end),
        1 => Run::new(fleet::maxwells(seed), seed).until(end),
        _ => Run::new(fleet::megmeets(seed), seed).until(end),
    }
}
