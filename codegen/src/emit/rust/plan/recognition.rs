//! Which message a frame carries: for each direction the rows of one `match` over its selectors.

use proc_macro2::Ident;

use super::message::Message;
use super::naming::ident;
use super::rows::{Arm, Row, joined, lengths, rows};
use super::selector::{Selectors, Source};
use super::types::Types;
use crate::model::{Course, FrameId, MessageId, Protocol, Table};

/// How the frames of one direction are recognised.
pub struct Direction {
    /// What a frame is.
    pub frames: Cases<Outcome>,
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

/// The meaning of a frame with some constants.
pub struct Outcome {
    /// The kinds of frames, which are told apart by length, model and addresses.
    pub frames: Vec<Recognised>,
    /// What is read to tell them apart.
    pub reads: Reads,
}

/// A kind of frame.
pub struct Recognised {
    /// The function for its kind.
    pub kind: Ident,
    /// The struct that has its exchange.
    pub home: Ident,
    /// The exchange.
    pub exchange: Ident,
    /// The variant.
    pub variant: Ident,
    /// Whether it carries values.
    pub carries: bool,
    /// The struct of its values, if the number of data bytes says which of them are there.
    pub sized: Option<Ident>,
}

/// What code reads: parts of the frame, and the device model.
#[derive(Clone, Copy, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each says whether one thing is read")]
pub struct Reads {
    /// The identifier.
    pub id: bool,
    /// The data.
    pub data: bool,
    /// The frame as a whole.
    pub frame: bool,
    /// The frame as a whole, and the device model.
    pub model: bool,
}

impl Reads {
    /// Returns what two pieces of code read together.
    pub fn or(self, other: Self) -> Self {
        Self {
            id: self.id || other.id,
            data: self.data || other.data,
            frame: self.frame || other.frame,
            model: self.model || other.model,
        }
    }
}

/// What directions are planned from.
pub struct Planner<'a> {
    /// The protocol.
    pub protocol: &'a Protocol,
    /// Types of the module.
    pub types: &'a Types,
    /// Selectors.
    pub selectors: &'a Selectors,
    /// Messages.
    pub messages: &'a Table<MessageId, Message>,
}

impl Planner<'_> {
    /// Plans how the frames of one direction are recognised; `None` if there are none.
    pub fn direction(&self, course: &Course) -> Option<Direction> {
        course.choice.as_ref()?;
        let (rest, frames) = split(rows(self.protocol, course));
        let frames = frames.into_iter().map(|row| {
            let outcome = self.outcome(&row);
            Arm { sets: vec![row.constants], outcome }
        });
        let frames = Cases { arms: frames.collect(), rest: rest.map(|row| self.outcome(&row)) };
        let (rest, rows) = split(lengths(self.protocol, course));
        Some(Direction { frames, lengths: Cases { arms: joined(rows), rest: rest.map(|row| row.outcome) } })
    }

    fn outcome(&self, row: &Row<Vec<FrameId>>) -> Outcome {
        let frames: Vec<_> = row.outcome.iter().map(|frame| self.recognised(*frame)).collect();
        let sources = || row.constants.keys().map(|selector| &self.selectors[*selector].source);
        let id = sources().any(|source| matches!(source, Source::Identifier(_)));
        let data = sources().any(|source| matches!(source, Source::Data(_)));
        let carries = |is_sized: bool| frames.iter().any(|frame| frame.carries && frame.sized.is_some() == is_sized);
        let reads = Reads { id, data: data || carries(false), frame: carries(true), model: frames.len() > 1 };
        Outcome { frames, reads }
    }

    fn recognised(&self, id: FrameId) -> Recognised {
        let (layout, frame) = (&self.protocol[id], &self.types.frames[id]);
        let message = &self.messages[layout.message];
        Recognised {
            kind: ident(layout.kind.name()),
            home: message.home.clone(),
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
