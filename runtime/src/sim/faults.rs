//! Faults of a device and of its frames.

use super::Random;

/// Faults of one device: how many of a hundred frames have each, and when the device fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Faults {
    /// Requests that do not reach it.
    pub deaf: u8,
    /// Replies that get lost.
    pub lost: u8,
    /// Replies that come twice.
    pub twice: u8,
    /// Replies with a byte less or more than they should have.
    pub broken: u8,
    /// Replies that show another sender.
    pub disguised: u8,
    /// Requests that it refuses, with `code`.
    pub refused: u8,
    /// The error code of a refusal.
    pub code: u64,
    /// The message whose requests it always refuses, with `code`. They count as refused.
    pub always_refused: Option<&'static str>,
    /// The message whose replies always have a byte less than they should have. They count as broken.
    pub always_short: Option<&'static str>,
    /// Replies whose values [drift](super::Device::drift).
    pub drifted: u8,
    /// The longest time in milliseconds until a reply comes. The shortest is 1. No reply comes before an earlier frame
    /// of the device, so it can take longer.
    pub slowest: u32,
    /// Whether it says nothing while it starts, also if the document has a code for that.
    pub is_mute_at_start: bool,
    /// When it starts anew by itself.
    pub restarts: Option<u32>,
    /// When it dies. It neither hears nor says anything from then on.
    pub dies: Option<u32>,
}

impl Faults {
    /// No faults.
    pub const NONE: Self = Self {
        deaf: 0,
        lost: 0,
        twice: 0,
        broken: 0,
        disguised: 0,
        refused: 0,
        code: 0,
        always_refused: None,
        always_short: None,
        drifted: 0,
        slowest: 1,
        is_mute_at_start: false,
        restarts: None,
        dies: None,
    };

    /// Draws faults: up to `most` of a hundred frames have each. One device of four starts anew, and one
    /// of eight dies, at a time before `end`. One of two says nothing while it starts.
    pub fn random(random: &mut Random, most: u8, end: u32) -> Self {
        let mut draw = || u8::try_from(random.below(u32::from(most).saturating_add(1))).unwrap_or(most);
        let [deaf, lost, twice, broken, disguised, refused, drifted] =
            [draw(), draw(), draw(), draw(), draw(), draw(), draw()];
        let restarts = random.chance(25).then(|| random.below(end));
        let dies = random.chance(12).then(|| random.below(end));
        let is_mute_at_start = random.chance(50);
        let failing = Self { is_mute_at_start, restarts, dies, ..Self::NONE };
        Self { deaf, lost, twice, broken, disguised, refused, drifted, ..failing }
    }
}
