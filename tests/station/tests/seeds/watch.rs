//! What must hold in each turn.

use std::collections::BTreeMap;

use canspec_runtime::client::Output;
use canspec_runtime::clock::has_come;
use canspec_runtime::sim::Faults;
use canspec_runtime::station::Limits;
use canspec_runtime::{Addressed, Frame, Quantities, Quantity, Received};
use canspec_station::{ADDRESSES, ROUND, pace};

use crate::bus::{Bus, Charger, rules};

/// How long a turn of the program takes at most, and how far what it does may be late for that.
pub const TURN: u32 = 15;
const LATE: u32 = 100;
/// How long a value counts.
const VALID: u32 = 3 * ROUND;
/// What is shown of a module.
const SHOWN: [Quantity; 3] = [Quantity::OUTPUT_VOLTAGE, Quantity::OUTPUT_CURRENT, Quantity::DELIVERING];

/// What is known of a bus with `N` modules, from outside of the station.
pub struct Watch<const N: usize> {
    /// Since when all is stopped, if it is.
    pub stopped: Option<u32>,
    /// When something last parted the program from its modules.
    pub parted: u32,
    /// From when until when a driver has last kept frames, if it has.
    pub kept: Option<(u32, u32)>,
    /// What another controller has switched on.
    pub woken: Option<u8>,
    /// The address that two modules have, if there are two.
    pub shared: Option<u8>,
    /// Since when each module is on, and since when it is said to be off meanwhile.
    on: [Option<u32>; N],
    denied: [Option<u32>; N],
    /// When it was last told to be off.
    told: [u32; N],
    /// How often modules have missed all switch-offs of a round.
    pub missed: u64,
    /// When each module last said what is shown.
    said: BTreeMap<u8, [Option<u32>; 3]>,
    /// How many frames were looked at, of those that were sent and of those that the driver keeps.
    seen: [usize; 2],
    turn: usize,
}

impl<const N: usize> Watch<N> {
    pub fn new() -> Self {
        let (on, denied, told) = ([None; N], [None; N], [0; N]);
        let (stopped, parted, woken, shared) = (None, 0, None, None);
        Self {
            stopped,
            parted,
            kept: None,
            woken,
            shared,
            on,
            denied,
            told,
            missed: 0,
            said: BTreeMap::new(),
            seen: [0; 2],
            turn: 0,
        }
    }

    /// Notes what the driver has received.
    pub fn received<P: Quantities + Addressed, const G: usize>(&mut self, bus: &Bus<P, N, G>) {
        for (frame, at) in bus.kept.get(self.seen[1]..).unwrap_or_default() {
            let Ok(received) = Received::<P>::decode(frame) else { continue };
            let node = received.node().filter(|_| !received.is_to_module()).and_then(|node| u8::try_from(node).ok());
            let Some(node) = node else { continue };
            let said = self.said.entry(node).or_default();
            for (said, quantity) in said.iter_mut().zip(SHOWN) {
                *said = received.quantity(quantity).map(|_| at.wrapping_sub(bus.ahead)).or(*said);
            }
        }
        self.seen[1] = if bus.is_stalled { bus.kept.len() } else { 0 };
    }

    /// Tests what the station has sent, and what the modules do.
    pub fn look<P, const G: usize>(&mut self, bus: &mut Bus<P, N, G>, limits: &Limits) -> Result<(), String>
    where
        P: Quantities + Addressed<Target: PartialEq>,
    {
        let first = std::mem::replace(&mut self.seen[0], bus.sent.len());
        for (_, frame) in bus.sent.get(first..).unwrap_or_default().to_vec() {
            self.sent(bus, &frame);
        }
        let (now, clock) = (bus.now, bus.clock());
        let Bus { bench, station, .. } = bus;
        let mut sums_ma = [0; 8];
        for (place, (node, device, faults)) in bench.devices().enumerate() {
            if self.is_caught_up::<P>(device, now) {
                device.was_bare = false;
            }
            self.obeys(node, device, limits)?;
            if !device.is_on || is_dead(faults, now) {
                (self.on[place], self.denied[place]) = (None, None);
                continue;
            }
            sums_ma[usize::from(device.group.0)] += device.delivered_ma();
            let is_denied = station.output(node, clock) == Output::Off;
            self.is_stopped_in_time::<P>(place, node, now)?;
            self.is_not_denied(place, node, is_denied, now)?;
        }
        if let Some(sum_ma) = sums_ma.into_iter().find(|sum| *sum > limits.group_ma).filter(|_| self.shared.is_none()) {
            return Err(format!("a group delivers {sum_ma} mA"));
        }
        self.turn += 1;
        self.is_fresh(bus)
    }

    /// Begins to count frames that are sent anew.
    pub fn forget_sent(&mut self) {
        self.seen[0] = 0;
    }

    /// Notes which modules are told to be off.
    fn sent<P: Quantities + Addressed<Target: PartialEq>, const G: usize>(
        &mut self,
        bus: &mut Bus<P, N, G>,
        frame: &Frame,
    ) {
        let Ok(received) = Received::<P>::decode(frame) else { return };
        if received.setting(Quantity::DELIVERING) != Some(0) {
            return;
        }
        let now = bus.now;
        for ((node, device, _), told) in bus.bench.devices().zip(&mut self.told) {
            let is_told = match received.node() {
                Some(asked) => asked == i32::from(node),
                None => received.target() == Some(device.group.1),
            };
            *told = if is_told { now } else { *told };
        }
    }

    /// Tests that a module is told nothing beyond a limit.
    fn obeys<P: Addressed>(&self, node: u8, device: &Charger<P>, limits: &Limits) -> Result<(), String> {
        let (voltage_mv, current_ma) = (device.voltage_mv, device.current_ma);
        if voltage_mv.is_some_and(|voltage| voltage < limits.least_mv || voltage > limits.most_mv) {
            return Err(format!("module {node} is told {voltage_mv:?} mV"));
        }
        if current_ma.is_some_and(|current| current > limits.most_ma) {
            return Err(format!("module {node} is told {current_ma:?} mA"));
        }
        if self.woken == Some(node) || self.shared == Some(node) {
            return Ok(());
        }
        if device.was_bare {
            return Err(format!("module {node} is switched on without its set-point"));
        }
        if device.steepest_ma > limits.rise_ma {
            return Err(format!("the output of module {node} rises by {} mA at once", device.steepest_ma));
        }
        Ok(())
    }

    /// Tests whether a module has started while a driver kept frames, and hears them now. It can be switched on without
    /// its set-point, since nobody knew of that when the frames were sent.
    fn is_caught_up<P: Quantities + Addressed>(&self, device: &Charger<P>, now: u32) -> bool {
        self.kept.is_some_and(|(from, until)| {
            let has_started = from <= device.started + rules::<P>().boot && device.started <= until;
            has_started && now <= until + stops::<P>()
        })
    }

    /// Tests that a module that is to be off is told so in each round. So it is on for longer than one only if it
    /// misses or refuses that. The stops of all addresses can go before that.
    fn is_stopped_in_time<P: Quantities>(&mut self, place: usize, node: u8, now: u32) -> Result<(), String> {
        let on = *self.on[place].get_or_insert(now);
        let Some(stopped) = self.stopped else { return Ok(()) };
        let since = stopped.max(self.parted).max(on);
        let told = self.told[place].max(since);
        let late = stops::<P>();
        if now > told + ROUND + late {
            return Err(format!("module {node} is on, and was not told to be off for {} ms", now - told));
        }
        if now > since + ROUND + late {
            self.missed += 1;
            self.on[place] = Some(now);
        }
        Ok(())
    }

    /// Tests that no module that delivers is said to be off while all is stopped. Two modules with one address are found
    /// to contradict each other within a round.
    fn is_not_denied(&mut self, place: usize, node: u8, is_denied: bool, now: u32) -> Result<(), String> {
        if !is_denied || self.stopped.is_none() {
            self.denied[place] = None;
            return Ok(());
        }
        let since = *self.denied[place].get_or_insert(now);
        let patience = if self.shared == Some(node) { 2 * ROUND + LATE } else { 0 };
        if since + patience <= now && !(self.shared == Some(node) && now < self.parted + VALID + ROUND) {
            return Err(format!("module {node} is on, and said to be off for {} ms", now - since));
        }
        Ok(())
    }

    /// Tests that nothing counts that a module has said longer ago than it may. Each turn looks at another module.
    fn is_fresh<P, const G: usize>(&self, bus: &mut Bus<P, N, G>) -> Result<(), String>
    where
        P: Quantities + Addressed<Target: PartialEq>,
    {
        let (now, clock) = (bus.now, bus.clock());
        let Some((node, ..)) = bus.bench.devices().nth(self.turn % N) else { return Ok(()) };
        let station = &bus.station;
        let counts = [
            station.voltage_mv(node, clock).fresh().is_some(),
            station.current_ma(node, clock).fresh().is_some(),
            station.output(node, clock) != Output::Unknown,
        ];
        let said = self.said.get(&node).copied().unwrap_or_default();
        for ((counts, said), shown) in counts.into_iter().zip(said).zip(SHOWN) {
            let is_old = said.is_none_or(|said| now > said + VALID + LATE);
            if counts && is_old {
                return Err(format!("`{}` of module {node} counts, and was last said at {said:?} ms", shown.name()));
            }
        }
        Ok(())
    }
}

/// Returns how long it takes to send a stop to each address and to each group, in turns of the program.
fn stops<P: Quantities>() -> u32 {
    let count = u32::try_from(ADDRESSES.len() + 2).expect("few");
    count * (pace::<P>().gap + TURN)
}

/// Tests whether a module is dead.
pub fn is_dead(faults: &Faults, now: u32) -> bool {
    faults.dies.is_some_and(|time| has_come(time, now))
}
