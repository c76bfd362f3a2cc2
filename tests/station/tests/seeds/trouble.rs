//! What happens to the bus, to the program and to its clock in a phase, and what other controllers do.

use canspec_runtime::sim::{Driver, Outage, Random};

/// What happens to the bus, to the program or to its clock.
pub const TROUBLES: [&str; 5] = [
    "buses away, which the driver says",
    "buses away, while the driver keeps frames",
    "buses away, while the driver drops frames",
    "programs that stand still",
    "clocks that go back",
];
const AWAY: usize = 0;
const KEPT: usize = 1;
const DROPPED: usize = 2;
const STILL: usize = 3;

/// What another controller does.
pub const OTHERS: [&str; 3] =
    ["other controllers that read", "other controllers that set an output", "other controllers that switch on"];

/// How long a trouble lasts at most where no watchdog takes longer, and when it begins at the latest.
const LONGEST: u32 = 14_000;
const LATEST: u32 = 6000;
/// Between these times after the trouble another controller sets something. The frames that a driver has kept have passed
/// by then, and the answers to them.
const SOONEST: u32 = 500;
const AFTER: u32 = 2000;

/// What happens in a phase. The seed decides it.
#[derive(Clone, Copy)]
pub struct Trouble {
    pub kind: usize,
    begins: u32,
    pub ends: u32,
    /// Whether it has begun, and whether it has ended.
    has: (bool, bool),
    pub other: usize,
    /// When another controller does something. One that reads goes on until the trouble ends.
    pub other_at: Option<u32>,
}

/// What changes in a trouble.
pub enum Change {
    Begins,
    Ends,
}

impl Trouble {
    pub const NONE: Self = Self { kind: 0, begins: 0, ends: 0, has: (true, true), other: 0, other_at: None };

    /// Draws what happens in a phase. Where all is stopped, it lasts as long as a watchdog in half of the cases.
    pub fn draw(random: &mut Random, watchdog: Option<u32>, is_stopped: bool, now: u32) -> Self {
        let draw = |random: &mut Random, names: &[&str]| random.below(u32::try_from(names.len()).expect("few"));
        let kind = usize::try_from(draw(random, &TROUBLES)).expect("few");
        let begins = now + random.below(LATEST);
        let lasts = match watchdog.filter(|_| is_stopped && random.chance(50)) {
            Some(watchdog) => watchdog + random.below(LONGEST - 10_000),
            None => 1 + random.below(LONGEST),
        };
        let ends = begins + lasts;
        // While it delivers, to switch a module on changes nothing.
        let other = usize::try_from(draw(random, if is_stopped { &OTHERS } else { &OTHERS[..2] })).expect("few");
        let other_at = if other == 0 { now } else { ends + SOONEST + random.below(AFTER - SOONEST) };
        Self { kind, begins, ends, has: (false, false), other, other_at: Some(other_at) }
    }

    /// Returns how long a phase takes at least from one trouble to a quiet bus.
    pub fn longest(watchdog: Option<u32>) -> u32 {
        LATEST + LONGEST.max(watchdog.unwrap_or_default() + LONGEST - 10_000) + AFTER
    }

    /// Returns what changes at a time.
    pub fn change(&mut self, now: u32) -> Option<Change> {
        if !self.has.0 && now >= self.begins {
            self.has.0 = true;
            return Some(Change::Begins);
        }
        let ends = self.has == (true, false) && now >= self.ends;
        self.has.1 |= ends;
        ends.then_some(Change::Ends)
    }

    /// Tests whether nothing passes between the program and the modules now.
    pub fn parts(&self) -> bool {
        self.has == (true, false) && self.kind <= STILL
    }

    pub fn is_away(&self) -> bool {
        self.kind == AWAY
    }

    pub fn is_kept(&self) -> bool {
        self.kind == KEPT
    }

    pub fn is_still(&self) -> bool {
        self.kind == STILL
    }

    /// Returns the time in which the bus is away, and the driver does not say it.
    pub fn outage(&self, now: u32) -> Option<Outage> {
        let driver = match self.kind {
            KEPT => Driver::Buffers,
            DROPPED => Driver::Drops,
            _ => return None,
        };
        Some(Outage { from: now, until: self.ends, driver })
    }

    pub fn is_clock(&self) -> bool {
        self.kind > STILL
    }
}
