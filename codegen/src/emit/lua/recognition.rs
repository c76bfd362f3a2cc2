//! Writes the plan to recognise frames as nested tables.

use super::signal::wide;
use super::table::Value;
use crate::model::{Choice, Course, FrameId, Group, SelectorId, SelectorPlace};

/// Returns the choice among the frames of one direction.
pub fn course(course: &Course) -> Value {
    course.choice.as_ref().map_or_else(Value::record, |by_identifier| choice(by_identifier, &group))
}

fn group(group: &Group) -> Value {
    let lengths = group.lengths.iter().map(|(length, scope)| (Value::number(*length), selectors(&scope.selectors)));
    Value::record()
        .with("selectors", selectors(&group.all.selectors))
        .with("lengths", Value::map(lengths))
        .maybe("choice", group.choice.as_ref().map(|by_payload| choice(by_payload, &frames)))
}

fn selectors(ids: &[SelectorId]) -> Value {
    Value::list(ids, |id| Value::id(*id))
}

fn frames(frames: &Vec<FrameId>) -> Value {
    Value::record().with("frames", Value::list(frames, |id| Value::id(*id)))
}

/// Returns a choice by one selector after another. `end` writes each outcome.
fn choice<T>(known: &Choice<T>, end: &impl Fn(&T) -> Value) -> Value {
    let (selector, place, cases, otherwise) = match known {
        Choice::End(outcome) => return end(outcome),
        Choice::By { selector, place, cases, otherwise } => (selector, place, cases, otherwise),
    };
    let (record, width) = match place {
        SelectorPlace::Identifier(field) => (Value::record().with("field", Value::id(*field)), 32),
        SelectorPlace::Payload(place) => (Value::record().with("selector", Value::id(*selector)), place.width()),
    };
    let cases = cases.iter().map(|(value, next)| (wide(*value, width), choice(next, end)));
    record.with("cases", Value::map(cases)).maybe("otherwise", otherwise.as_ref().map(|next| choice(next, end)))
}
