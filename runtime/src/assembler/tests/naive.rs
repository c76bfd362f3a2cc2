//! What an assembler should say, found the slow way: all frames are kept, and looked through again each time.

use std::collections::BTreeMap;
use std::string::String;
use std::vec::Vec;

use super::ovens::All;
use crate::assembler::{Arrival, Partial, Progress};

/// What a frame says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Item {
    Value(usize, u16),
    Error(usize),
    Unlisted,
}

impl Item {
    fn position(self) -> Option<usize> {
        match self {
            Self::Value(position, _) | Self::Error(position) => Some(position),
            Self::Unlisted => None,
        }
    }
}

/// All that one node has sent since it was asked.
#[derive(Clone, Debug, Default)]
pub struct Story {
    items: Vec<Item>,
    last_seen: u64,
}

/// What came, with names in place of bits.
#[derive(Debug, PartialEq)]
pub struct Said {
    pub outcome: &'static str,
    pub node: i32,
    pub arrival: Option<Arrival>,
    pub values: Option<[Option<u16>; 6]>,
    pub missing: Vec<&'static str>,
    pub failed: Vec<&'static str>,
}

const NAMES: [&str; 6] = ["a", "b", "c", "d", "e", "f"];

impl Story {
    fn value(&self, position: usize) -> Option<u16> {
        self.items.iter().rev().find_map(|item| match item {
            Item::Value(known, value) if *known == position => Some(*value),
            Item::Value(..) | Item::Error(_) | Item::Unlisted => None,
        })
    }

    fn values(&self) -> [Option<u16>; 6] {
        [0, 1, 2, 3, 4, 5].map(|position| self.value(position))
    }

    fn is_mentioned(&self, position: usize) -> bool {
        self.items.iter().any(|item| item.position() == Some(position))
    }

    fn missing(&self) -> Vec<&'static str> {
        (0..6).filter(|position| !self.is_mentioned(*position)).map(|position| NAMES[position]).collect()
    }

    fn failed(&self) -> Vec<&'static str> {
        let has_failed = |position: &usize| self.is_mentioned(*position) && self.value(*position).is_none();
        (0..6).filter(has_failed).map(|position| NAMES[position]).collect()
    }

    fn arrival(&self, item: Item) -> Arrival {
        let (position, value) = match item {
            Item::Unlisted => return Arrival::Unlisted,
            Item::Error(_) => return Arrival::Failed,
            Item::Value(position, value) => (position, value),
        };
        let is_behind = self.items.iter().filter_map(|item| item.position()).any(|earlier| earlier > position);
        match self.value(position) {
            Some(before) if before == value => Arrival::Repeated,
            Some(_) => Arrival::Changed,
            None if is_behind => Arrival::OutOfOrder,
            None => Arrival::InOrder,
        }
    }

    pub fn partial(&self, node: i32) -> Said {
        let (missing, failed) = (self.missing(), self.failed());
        Said { outcome: "partial", node, arrival: None, values: Some(self.values()), missing, failed }
    }
}

/// What an assembler with room for `room` nodes knows.
pub struct Naive {
    pub stories: BTreeMap<i32, Story>,
    pub room: usize,
    pub patience: u64,
    pub is_listening: bool,
}

impl Naive {
    pub fn ask(&mut self, node: i32, now: u64) -> bool {
        let has_room = self.stories.contains_key(&node) || self.stories.len() < self.room;
        if has_room {
            self.stories.insert(node, Story { items: Vec::new(), last_seen: now });
        }
        has_room
    }

    pub fn receive(&mut self, node: i32, item: Item, more: bool, now: u64) -> Said {
        let nothing =
            |outcome| Said { outcome, node, arrival: None, values: None, missing: Vec::new(), failed: Vec::new() };
        if !self.stories.contains_key(&node) && !self.is_listening {
            return nothing("unasked");
        }
        if !self.stories.contains_key(&node) && !self.ask(node, now) {
            return nothing("full");
        }
        let mut story = self.stories.remove(&node).unwrap_or_default();
        let arrival = Some(story.arrival(item));
        story.items.push(item);
        story.last_seen = now;
        let whole = story.values().iter().all(Option::is_some);
        let said = match (more, whole) {
            (true, _) => Said { missing: story.missing(), arrival, ..nothing("pending") },
            (false, true) => Said { values: Some(story.values()), arrival, ..nothing("complete") },
            (false, false) => Said { outcome: "incomplete", arrival, ..story.partial(node) },
        };
        if more {
            self.stories.insert(node, story);
        }
        said
    }

    pub fn timed_out(&mut self, now: u64) -> Vec<Said> {
        let silent = |story: &Story| now - story.last_seen >= self.patience;
        let over: Vec<_> = self.stories.iter().filter(|(_, story)| silent(story)).map(|(node, _)| *node).collect();
        over.iter().filter_map(|node| Some(self.stories.remove(node)?.partial(*node))).collect()
    }
}

/// Shows what the assembler says in the same way.
pub fn said(progress: Progress<All>) -> Said {
    let nothing =
        |outcome, node| Said { outcome, node, arrival: None, values: None, missing: Vec::new(), failed: Vec::new() };
    match progress {
        Progress::Pending { node, arrival, missing } => {
            Said { arrival: Some(arrival), missing: missing.names().collect(), ..nothing("pending", node) }
        }
        Progress::Complete { node, arrival, set } => {
            Said { arrival: Some(arrival), values: Some(set.0), ..nothing("complete", node) }
        }
        Progress::Incomplete { arrival, partial } => {
            Said { outcome: "incomplete", arrival: Some(arrival), ..said_partial(&partial) }
        }
        Progress::Unasked { node } => nothing("unasked", node),
        Progress::Full { node } => nothing("full", node),
    }
}

pub fn said_partial(partial: &Partial<All>) -> Said {
    assert_eq!(partial.missing.is_empty(), partial.missing.names().next().is_none());
    Said {
        outcome: "partial",
        node: partial.node,
        arrival: None,
        values: Some(partial.set.0),
        missing: partial.missing.names().collect(),
        failed: partial.failed.names().collect(),
    }
}

/// Says which sequence went wrong.
pub fn story_of(items: &[(Item, bool)]) -> String {
    std::format!("{items:?}")
}
