//! How often what happened.

use std::fmt;
use std::ops::AddAssign;

use canspec_runtime::sim::Tally;

/// What happens in each run.
const WORK: [&str; 9] = [
    "runs",
    "minutes",
    "frames sent",
    "frames heard",
    "milliseconds of delay",
    "stops",
    "modules that miss or refuse the switch-offs of a round",
    "requests answered or refused",
    "requests lost",
];

/// What fails, and must do so at least once in ten minutes on average.
const FAULTS: [&str; 23] = [
    "frames lost",
    "frames repeated",
    "frames of a wrong length",
    "refusals",
    "modules that restart",
    "modules that die",
    "modules that hear something after silence",
    "modules that start by themselves after silence",
    "frames that come when the bus is back",
    "frames that are lost while it is away",
    "second answers of one address",
    "buses away, while the driver refuses frames",
    "buses away, which the driver says",
    "buses away, while the driver keeps frames",
    "buses away, while the driver drops frames",
    "programs that stand still",
    "clocks that go back",
    "other controllers that read",
    "other controllers that set an output",
    "other controllers that switch on",
    "modules with the address of another one",
    "modules whose answers to one request are always too short",
    "modules that always refuse one request",
];

/// How often what happened, in order of the names.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts([u64; WORK.len() + FAULTS.len()]);

/// Returns the names of what is counted.
fn names() -> impl Iterator<Item = &'static str> {
    WORK.into_iter().chain(FAULTS)
}

impl Counts {
    pub fn add(&mut self, name: &str, count: u64) {
        self.0[place(name)] += count;
    }

    /// Adds what a bench has counted.
    pub fn add_tally(&mut self, tally: &Tally) {
        let Tally { lost, twice, broken, refused, delay, wakes, doubles, blocked, delayed, .. } = *tally;
        self.add("frames lost", lost);
        self.add("frames repeated", twice);
        self.add("frames of a wrong length", broken);
        self.add("refusals", refused);
        self.add("milliseconds of delay", delay);
        self.add("modules that hear something after silence", wakes);
        self.add("frames that come when the bus is back", delayed);
        self.add("frames that are lost while it is away", blocked);
        self.add("second answers of one address", doubles);
    }

    /// Returns what has failed less often than once in ten minutes, on average of many runs.
    pub fn too_rare(&self) -> Option<&'static str> {
        let minutes = self.0[place("minutes")];
        FAULTS.into_iter().find(|fault| self.0[place(fault)] * 10 < minutes)
    }
}

/// Returns where something is counted.
fn place(name: &str) -> usize {
    names().position(|known| known == name).expect("it is one of the names")
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.0.iter_mut().zip(other.0).for_each(|(own, other)| *own += other);
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        names().zip(self.0).try_for_each(|(name, count)| writeln!(formatter, "{count:>12} {name}"))
    }
}
