//! Which message a frame carries: for each direction the rows of one `match` over its selectors.

use proc_macro2::Ident;

use super::message::Message;
use super::naming::ident;
use super::rows::{Arm, Row, joined, lengths, rows};

use super::types::Types;
use crate::model::{Course, FrameId, MessageId, Protocol, Table};

/// How the frames of one direction are recognised.
pub struct Direction {
    /// What a frame can be. Length, model and addresses tell several apart.
    pub frames: Cases<Vec<Candidate>>,
    /// How long frames should be, the shortest first.
    pub lengths: Cases<Vec<u8>>,
}

impl Direction {
    /// Returns how long frames should be.
    pub fn lengths(&self) -> impl Iterator<Item = u8> {
        self.lengths.arms.iter().map(|arm| &arm.outcome).chain(&self.lengths.rest).flatten().copied()
    }
}

/// A choice by the constants of selectors.
pub struct Cases<T> {
    /// The outcomes of constants that hold. The first one that fits counts.
    pub arms: Vec<Arm<T>>,
    /// The outcome of all other frames.
    pub rest: Option<T>,
}

/// A kind of frame that a frame can be.
pub struct Candidate {
    /// The function for its kind.
    pub kind: Ident,
    /// The struct that has its exchange.
    pub owner: Ident,
    /// The exchange.
    pub exchange: Ident,
    /// The variant.
    pub variant: Ident,
    /// Whether it carries values.
    pub carries: bool,
    /// The struct of its values, if the number of data bytes says which of them are there.
    pub sized: Option<Ident>,
}

/// What directions are planned from.
pub struct Planner<'a> {
    /// The protocol.
    pub protocol: &'a Protocol,
    /// Types of the module.
    pub types: &'a Types,
    /// Messages.
    pub messages: &'a Table<MessageId, Message>,
}

impl Planner<'_> {
    /// Plans how the frames of one direction are recognised; `None` if there are none.
    pub fn direction(&self, course: &Course) -> Option<Direction> {
        course.choice.as_ref()?;
        let (rest, frames) = split(rows(self.protocol, course));
        let frames = joined(frames).into_iter();
        let frames = frames.map(|arm| Arm { outcome: self.candidates(&arm.outcome), sets: arm.sets });
        let frames = Cases { arms: frames.collect(), rest: rest.map(|row| self.candidates(&row.outcome)) };
        let (rest, rows) = split(lengths(self.protocol, course));
        Some(Direction { frames, lengths: Cases { arms: joined(rows), rest: rest.map(|row| row.outcome) } })
    }

    fn candidates(&self, frames: &[FrameId]) -> Vec<Candidate> {
        frames.iter().map(|frame| self.candidate(*frame)).collect()
    }

    fn candidate(&self, id: FrameId) -> Candidate {
        let (layout, frame) = (&self.protocol[id], &self.types.frames[id]);
        let message = &self.messages[layout.message];
        Candidate {
            kind: ident(layout.kind.name()),
            owner: message.owner.clone(),
            exchange: message.exchanges[layout.exchange].constant.clone(),
            variant: frame.variant.clone(),
            carries: frame.carried.is_some(),
            sized: frame.carried.clone().filter(|_| layout.lengths.len() > 1),
        }
    }
}

/// Takes out the row without constants.
fn split<T>(rows: Vec<Row<T>>) -> (Option<Row<T>>, Vec<Row<T>>) {
    let (rest, rows): (Vec<_>, _) = rows.into_iter().partition(|row| row.constants.is_empty());
    (rest.into_iter().next(), rows)
}
