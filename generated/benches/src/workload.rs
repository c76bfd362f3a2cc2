//! All that is measured.

use crate::frame::Frame;
use crate::work::Work;
use crate::{client, infy, supply};

/// Frames, and the codecs that work on them.
#[derive(Clone, Copy)]
pub struct Workload {
    /// Name of the protocol.
    pub name: &'static str,
    /// Kinds of frames, which are measured one after the other.
    pub kinds: &'static [Kind],
    /// The codecs, with the same works in the same order.
    pub codecs: &'static [Measured],
    /// The pattern of the functions that are counted, if a pass does more than the work. Then it is not timed.
    pub counted: Option<&'static str>,
}

/// A kind of frames.
#[derive(Clone, Copy)]
pub struct Kind {
    /// Name in the table.
    pub name: &'static str,
    /// Returns that many different frames.
    pub frames: fn(usize) -> Vec<Frame>,
}

/// A codec with its works.
#[derive(Clone, Copy)]
pub struct Measured {
    /// Name in the table.
    pub codec: &'static str,
    /// What it does.
    pub works: &'static [Work],
}

impl Workload {
    /// All workloads.
    pub const ALL: [Self; 3] = [infy::WORKLOAD, supply::WORKLOAD, client::WORKLOAD];
    /// How many frames of a kind valgrind sees.
    pub const COUNTED: usize = 20_000;
    /// How many frames of a kind are timed.
    pub const TIMED: usize = 1_000_000;
    /// The sets of frames that are timed, with their sizes: distinct frames, and a loop that stays in the cache.
    pub const SETS: [(&'static str, usize); 2] = [("distinct", Self::TIMED), ("loop", 16)];

    /// Returns the workloads that are timed.
    pub fn timed() -> impl Iterator<Item = &'static Self> {
        Self::ALL.iter().filter(|workload| workload.counted.is_none())
    }

    /// Returns the names of the works.
    pub fn works(&self) -> impl Iterator<Item = &'static str> {
        self.codecs[0].works.iter().map(|work| work.name)
    }

    /// Returns the names by which a set of frames of each kind is timed, for each work.
    pub fn groups(&self) -> impl Iterator<Item = String> {
        let kinds = || self.kinds.iter().flat_map(|kind| Self::SETS.map(|(set, _)| (kind, set)));
        self.works().flat_map(move |work| kinds().map(move |(kind, set)| self.group(work, kind, set)))
    }

    /// Returns the name by which a work on a set of frames is timed.
    pub fn group(&self, work: &str, kind: &Kind, set: &str) -> String {
        format!("{} {work} {} {set}", self.name, kind.name)
    }
}
