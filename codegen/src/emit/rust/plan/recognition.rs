//! Which message a frame carries: the rows of a `match` over its selectors, one for each direction or one for all.

use proc_macro2::Ident;

use super::message::Message;
use super::naming::ident;
use super::rows::{Arm, Row, joined, lengths, rows};
use super::types::Types;
use crate::model::{self, Course, FrameId, MessageId, Protocol, Table};

/// How frames are recognised.
pub struct Recognition {
    /// What a frame can be: for each direction, or for both together.
    pub frames: Vec<Named<Outcome>>,
    /// How long frames should be, the shortest first.
    pub lengths: Vec<Named<Vec<u8>>>,
}

/// A choice, with the name of its function.
pub type Named<T> = (&'static str, Cases<T>);

impl Recognition {
    /// Tests whether one choice serves both directions.
    pub fn is_of_both_directions(&self) -> bool {
        let mut outcomes = self.frames.iter().flat_map(|(_, choice)| choice.outcomes());
        outcomes.any(|outcome| matches!(outcome, Outcome::Pair(_)))
    }

    /// Returns how long frames should be.
    pub fn all_lengths(&self) -> impl Iterator<Item = u8> {
        self.lengths.iter().flat_map(|(_, choice)| choice.outcomes()).flatten().copied()
    }
}

/// A choice by the constants of selectors.
#[derive(PartialEq)]
pub struct Cases<T> {
    /// The outcomes of constants that hold. The first one that fits counts.
    pub arms: Vec<Arm<T>>,
    /// The outcome of all other frames.
    pub rest: Option<T>,
}

impl<T> Cases<T> {
    fn outcomes(&self) -> impl Iterator<Item = &T> {
        self.arms.iter().map(|arm| &arm.outcome).chain(&self.rest)
    }
}

/// What frames can be that show the constants of a row.
pub enum Outcome {
    /// One of these. Length, model and addresses tell several apart.
    Frames(Vec<Candidate>),
    /// A request, or the reply of the same exchange.
    Pair(Box<[Candidate; 2]>),
}

/// A kind of frame that a frame can be.
#[derive(Clone)]
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

impl Candidate {
    /// Tests whether these are a request and its reply, which have the same numbers of data bytes.
    fn is_answered_by(&self, reply: &Self) -> bool {
        let exchange = |of: &Self| (of.owner.clone(), of.exchange.clone(), of.sized.clone());
        self.kind == "request" && reply.kind == "reply" && exchange(self) == exchange(reply)
    }
}

/// What recognition is planned from.
pub struct Planner<'a> {
    /// The protocol.
    pub protocol: &'a Protocol,
    /// Types of the module.
    pub types: &'a Types,
    /// Messages.
    pub messages: &'a Table<MessageId, Message>,
}

impl Planner<'_> {
    /// Plans how frames are recognised: requests and replies together, if they have the same selectors.
    pub fn recognition(&self) -> Recognition {
        let model::Recognition { requests, replies, either, alike, .. } = &self.protocol.recognition;
        let courses = [
            ("request", "request_lengths", requests),
            ("reply", "reply_lengths", replies),
            ("either", "either_lengths", either),
        ];
        let courses = courses.into_iter().filter(|(.., course)| course.choice.is_some());
        let frames: Vec<_> = courses.clone().map(|(name, _, course)| (name, self.frames(course))).collect();
        let lengths: Vec<_> = courses.map(|(_, name, course)| (name, self.lengths(course))).collect();
        let each_shows_direction = alike.is_empty();
        if each_shows_direction {
            Recognition { frames: paired(&frames).unwrap_or_else(|| apart(frames)), lengths: shared(lengths) }
        } else {
            Recognition { frames: apart(frames), lengths }
        }
    }

    fn frames(&self, course: &Course) -> Cases<Vec<Candidate>> {
        let (rest, frames) = split(rows(self.protocol, course));
        let arms = joined(frames).into_iter();
        let arms = arms.map(|arm| Arm { outcome: self.candidates(&arm.outcome), sets: arm.sets }).collect();
        Cases { arms, rest: rest.map(|row| self.candidates(&row.outcome)) }
    }

    fn lengths(&self, course: &Course) -> Cases<Vec<u8>> {
        let (rest, rows) = split(lengths(self.protocol, course));
        Cases { arms: joined(rows), rest: rest.map(|row| row.outcome) }
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

/// Makes one choice of requests and replies, if each request has the selectors of its reply.
fn paired(choices: &[Named<Vec<Candidate>>]) -> Option<Vec<Named<Outcome>>> {
    let [(_, requests), (_, replies)] = choices else { return None };
    let rest = match (&requests.rest, &replies.rest) {
        (None, None) => None,
        (request, reply) => Some(pair(request.as_ref()?, reply.as_ref()?)?),
    };
    if requests.arms.len() != replies.arms.len() {
        return None;
    }
    let arms = requests.arms.iter().zip(&replies.arms).map(|(request, reply)| {
        let outcome = pair(&request.outcome, &reply.outcome).filter(|_| request.sets == reply.sets)?;
        Some(Arm { sets: request.sets.clone(), outcome })
    });
    Some(vec![("recognise", Cases { arms: arms.collect::<Option<_>>()?, rest })])
}

/// Returns a request and its reply as one outcome, if no other frame looks like one of them.
fn pair(requests: &[Candidate], replies: &[Candidate]) -> Option<Outcome> {
    let ([request], [reply]) = (requests, replies) else { return None };
    request.is_answered_by(reply).then(|| Outcome::Pair(Box::new([request.clone(), reply.clone()])))
}

/// Leaves the choices as they are.
fn apart(choices: Vec<Named<Vec<Candidate>>>) -> Vec<Named<Outcome>> {
    let choices = choices.into_iter().map(|(name, Cases { arms, rest })| {
        let arms = arms.into_iter().map(|Arm { sets, outcome }| Arm { sets, outcome: Outcome::Frames(outcome) });
        (name, Cases { arms: arms.collect(), rest: rest.map(Outcome::Frames) })
    });
    choices.collect()
}

/// Makes one choice of two that are the same.
fn shared(choices: Vec<Named<Vec<u8>>>) -> Vec<Named<Vec<u8>>> {
    match choices.as_slice() {
        [(_, requests), (_, replies)] if requests == replies => {
            choices.into_iter().take(1).map(|(_, lengths)| ("lengths", lengths)).collect()
        }
        _ => choices,
    }
}

/// Takes out the row without constants.
fn split<T>(rows: Vec<Row<T>>) -> (Option<Row<T>>, Vec<Row<T>>) {
    let (rest, rows): (Vec<_>, _) = rows.into_iter().partition(|row| row.constants.is_empty());
    (rest.into_iter().next(), rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Id, SelectorId};

    fn candidate(kind: &str, exchange: &str, variant: &str, sized: Option<&str>) -> Vec<Candidate> {
        let [kind, exchange, variant] = [kind, exchange, variant].map(ident);
        let (owner, sized) = (ident("Output"), sized.map(ident));
        vec![Candidate { kind, owner, exchange, variant, carries: true, sized }]
    }

    fn read() -> Vec<Candidate> {
        candidate("request", "READ", "ReadOutput", None)
    }

    fn reply() -> Vec<Candidate> {
        candidate("reply", "READ", "Output", None)
    }

    fn choice<T, const N: usize>(arms: [(u64, T); N], rest: Option<T>) -> Cases<T> {
        let set = |value| [(SelectorId::new(0), value)].into();
        Cases { arms: arms.map(|(value, outcome)| Arm { sets: vec![set(value)], outcome }).into(), rest }
    }

    fn names<T>(choices: &[Named<T>]) -> Vec<&str> {
        choices.iter().map(|(name, _)| *name).collect()
    }

    fn is_paired(requests: Cases<Vec<Candidate>>, replies: Cases<Vec<Candidate>>) -> bool {
        let paired = paired(&[("request", requests), ("reply", replies)]);
        paired.is_some_and(|choices| names(&choices) == ["recognise"])
    }

    #[test]
    fn requests_and_replies_with_the_same_selectors_are_one_choice() {
        assert!(is_paired(choice([(3, read())], None), choice([(3, reply())], None)));
        assert!(is_paired(choice([], Some(read())), choice([], Some(reply()))));
    }

    #[test]
    fn requests_and_replies_with_other_selectors_are_two_choices() {
        assert!(!is_paired(choice([(3, read())], None), choice([(4, reply())], None)));
        assert!(!is_paired(choice([(3, read())], None), choice([(3, reply()), (4, reply())], None)));
        assert!(!is_paired(choice([(3, read())], None), choice([(3, reply())], Some(reply()))));
        assert!(!is_paired(choice([(3, read())], Some(read())), choice([(3, reply())], None)));
    }

    #[test]
    fn only_a_request_and_its_own_reply_are_a_pair() {
        assert!(pair(&read(), &reply()).is_some());
        assert!(pair(&read(), &candidate("reply", "SET", "Output", None)).is_none());
        assert!(pair(&read(), &candidate("report", "READ", "Output", None)).is_none());
        assert!(pair(&candidate("report", "READ", "Output", None), &reply()).is_none());
        assert!(pair(&read(), &candidate("reply", "READ", "Output", Some("Output"))).is_none());
        assert!(pair(&read(), &[reply(), reply()].concat()).is_none());
    }

    #[test]
    fn lengths_that_are_the_same_are_one_choice() {
        let [short, long] = [vec![4], vec![8]].map(|lengths| move || choice([(3, lengths.clone())], None));
        let shared_names = |requests, replies| {
            let choices = shared(vec![("request_lengths", requests), ("reply_lengths", replies)]);
            names(&choices).into_iter().map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(shared_names(short(), short()), ["lengths"]);
        assert_eq!(shared_names(short(), long()), ["request_lengths", "reply_lengths"]);
    }
}
