//! What happens to the bus, to the program and to its clock in a phase, and what other controllers do.

use canspec_runtime::sim::{Driver, Outage, Random};

/// What happens to the bus, to the program or to its clock.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    /// The driver refuses each frame.
    Refused,
    /// The driver refuses each frame, and says that the bus is off.
    Off,
    Kept,
    Dropped,
    Still,
    Clock,
}

impl Kind {
    const ALL: [Self; 6] = [Self::Refused, Self::Off, Self::Kept, Self::Dropped, Self::Still, Self::Clock];

    /// Returns its name among those of what happened.
    pub fn name(self) -> &'static str {
        match self {
            Self::Refused => "buses away, while the driver refuses frames",
            Self::Off => "buses away, which the driver says",
            Self::Kept => "buses away, while the driver keeps frames",
            Self::Dropped => "buses away, while the driver drops frames",
            Self::Still => "programs that stand still",
            Self::Clock => "clocks that go back",
        }
    }

    /// Tests whether the driver takes no frame, and gives none.
    pub fn is_away(self) -> bool {
        matches!(self, Self::Refused | Self::Off)
    }
}

/// What another controller does.
#[derive(Clone, Copy, PartialEq)]
pub enum Other {
    Reads,
    Sets,
    SwitchesOn,
}

impl Other {
    const ALL: [Self; 3] = [Self::Reads, Self::Sets, Self::SwitchesOn];

    /// Returns its name among those of what happened.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reads => "other controllers that read",
            Self::Sets => "other controllers that set an output",
            Self::SwitchesOn => "other controllers that switch on",
        }
    }
}

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
    pub kind: Kind,
    begins: u32,
    pub ends: u32,
    stage: Stage,
    pub other: Other,
    /// When another controller does something. One that reads goes on until the trouble ends.
    pub other_at: Option<u32>,
}

/// How far a trouble is.
#[derive(Clone, Copy, PartialEq)]
enum Stage {
    Before,
    During,
    After,
}

/// What changes in a trouble.
pub enum Change {
    Begins,
    Ends,
}

impl Trouble {
    pub const NONE: Self =
        Self { kind: Kind::Still, begins: 0, ends: 0, stage: Stage::After, other: Other::Reads, other_at: None };

    /// Draws what happens in a phase. Where all is stopped, it lasts as long as a watchdog in half of the cases.
    pub fn draw(random: &mut Random, watchdog: Option<u32>, is_stopped: bool, now: u32) -> Self {
        let kind = one_of(random, &Kind::ALL);
        let begins = now + random.below(LATEST);
        let lasts = match watchdog.filter(|_| is_stopped && random.chance(50)) {
            Some(watchdog) => watchdog + random.below(LONGEST - 10_000),
            None => 1 + random.below(LONGEST),
        };
        let ends = begins + lasts;
        // While it delivers, to switch a module on changes nothing.
        let other = one_of(random, if is_stopped { &Other::ALL } else { &Other::ALL[..2] });
        let other_at = if other == Other::Reads { now } else { ends + SOONEST + random.below(AFTER - SOONEST) };
        Self { kind, begins, ends, stage: Stage::Before, other, other_at: Some(other_at) }
    }

    /// Returns how long a phase takes at least from one trouble to a quiet bus.
    pub fn longest(watchdog: Option<u32>) -> u32 {
        LATEST + LONGEST.max(watchdog.unwrap_or_default() + LONGEST - 10_000) + AFTER
    }

    /// Returns what changes at a time.
    pub fn change(&mut self, now: u32) -> Option<Change> {
        let (stage, change) = match self.stage {
            Stage::Before if now >= self.begins => (Stage::During, Change::Begins),
            Stage::During if now >= self.ends => (Stage::After, Change::Ends),
            _ => return None,
        };
        self.stage = stage;
        Some(change)
    }

    /// Tests whether nothing passes between the program and the modules now.
    pub fn parts(&self) -> bool {
        self.stage == Stage::During && self.kind != Kind::Clock
    }

    /// Returns the time in which the bus is away, and the driver does not say it.
    pub fn outage(&self, now: u32) -> Option<Outage> {
        let driver = match self.kind {
            Kind::Kept => Driver::Buffers,
            Kind::Dropped => Driver::Drops,
            _ => return None,
        };
        Some(Outage { from: now, until: self.ends, driver })
    }
}

/// Draws one of several things.
pub fn one_of<T: Copy>(random: &mut Random, things: &[T]) -> T {
    let count = u32::try_from(things.len()).expect("few");
    things[usize::try_from(random.below(count)).expect("few")]
}
