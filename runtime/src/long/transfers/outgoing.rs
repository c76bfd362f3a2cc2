//! A message on its way, in memory of its own, with the times of J1939.

use super::j1939::Packets;
use super::{Answer, Grouped, Memory, Reason, Sender, Transferred};
use crate::clock::has_lasted;
use crate::{Error, Frame};

/// How long a sender waits for an answer after its last frame, in milliseconds: T3 of the standard.
const ANSWER: u32 = 1250;

/// How long a sender waits after an answer that asks it to: T4 of the standard.
const HELD: u32 = 1050;

/// The time between the frames of a message to all.
const SPACE: u32 = 50;

/// Sends one long message after the other, in memory of its own, and keeps the times of J1939.
///
/// Between two nodes only one message may be on its way. So a program needs one for each node that it
/// sends long messages to.
#[derive(Clone, Debug)]
pub struct Outgoing<T: Grouped, M: Memory = <T as super::Transport>::Memory> {
    memory: M,
    course: Option<Course<T>>,
}

/// The course of a message.
#[derive(Clone, Debug)]
struct Course<T: Grouped> {
    /// What sends the message, without its data.
    sender: Sender<'static, T>,
    length: usize,
    /// When the last frame was sent or came.
    since: u32,
    /// How long the receiver may be silent from then on.
    patience: u32,
    /// Why the message is given up, if it is.
    reason: Option<Reason>,
}

/// What a program does next for a long message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Next {
    /// It sends a frame now.
    Send(Frame),
    /// The message comes to nothing: the receiver was silent for too long, or asked for what the message does
    /// not have. Or it asked for the same packets too often. The program sends a frame that says so.
    Lost(Frame),
    /// It waits for a frame, and calls `poll` at this time at the latest, if there is one.
    Wait(Option<u32>),
}

impl<T: Grouped, M: Memory> Default for Outgoing<T, M> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Grouped, M: Memory> Outgoing<T, M> {
    /// Returns what sends no message yet.
    pub const fn new() -> Self {
        Self { memory: M::BLANK, course: None }
    }

    /// Tests whether a message is on its way.
    pub const fn is_busy(&self) -> bool {
        self.course.is_some()
    }

    /// Begins a message, in place of the one that is on its way. `blank` is the same as for
    /// [`sender`](Transferred::sender).
    ///
    /// # Errors
    ///
    /// The same as [`sender`](Transferred::sender). It also refuses a message for which the memory is too
    /// small. Nothing is on its way then.
    pub fn begin<L: Transferred<Transport = T>>(&mut self, values: &L, blank: &Frame, now: u32) -> Result<(), Error> {
        self.course = None;
        let sender = values.sender(blank, self.memory.as_mut())?;
        let length = sender.frames.data().len();
        let sender = sender.over(&[]);
        self.course = Some(Course { sender, length, since: now.wrapping_sub(SPACE), patience: ANSWER, reason: None });
        Ok(())
    }

    /// Gives up the message that is on its way, without a frame.
    pub fn cancel(&mut self) {
        self.course = None;
    }

    /// Takes a frame of the bus. After [`Answer::Done`] and [`Answer::Aborted`] no message is on its way.
    pub fn receive(&mut self, frame: &impl embedded_can::Frame, now: u32) -> Answer {
        let Some((course, data)) = self.course() else { return Answer::Other };
        let mut sender = course.sender.over(data);
        let answer = sender.receive(frame);
        course.sender = sender.over(&[]);
        match answer {
            Answer::Allowed(packets) => {
                (course.since, course.patience) = (now, if packets == 0 { HELD } else { ANSWER });
            }
            Answer::Done | Answer::Aborted(_) => self.course = None,
            Answer::Wrong => course.reason = Some(course.sender.frames.wrong()),
            Answer::Other => {}
        }
        answer
    }

    /// Says what to do next. Call it until it waits.
    pub fn poll(&mut self, now: u32) -> Next {
        let Some((course, data)) = self.course() else { return Next::Wait(None) };
        let mut sender = course.sender.over(data);
        let abort = sender.abort(course.reason.unwrap_or(Reason::TIMEOUT));
        if abort.is_none() && !has_lasted(course.since, SPACE, now) {
            return Next::Wait(Some(course.since.wrapping_add(SPACE)));
        }
        if let Some(frame) = sender.next().filter(|_| course.reason.is_none()) {
            let is_over = abort.is_none() && sender.clone().next().is_none();
            (course.sender, course.since) = (sender.over(&[]), now);
            self.course = self.course.take().filter(|_| !is_over);
            return Next::Send(frame);
        }
        let is_lost = course.reason.is_some() || has_lasted(course.since, course.patience, now);
        let Some(abort) = abort.filter(|_| is_lost) else {
            return Next::Wait(Some(course.since.wrapping_add(course.patience)));
        };
        self.course = None;
        Next::Lost(abort)
    }

    /// Returns the course of the message and its data.
    fn course(&mut self) -> Option<(&mut Course<T>, &[u8])> {
        let course = self.course.as_mut()?;
        let data = self.memory.as_ref().get(..course.length)?;
        Some((course, data))
    }
}

impl<T: Grouped> Sender<'_, T> {
    /// Returns what goes on with the same message, whose data lie elsewhere.
    fn over<'a>(&self, data: &'a [u8]) -> Sender<'a, T> {
        let frames = match &self.frames {
            Packets::One(frame) => Packets::One(*frame),
            Packets::Several { packets, is_announced } => {
                Packets::Several { packets: packets.over(data), is_announced: *is_announced }
            }
        };
        Sender { id: self.id, frames }
    }
}

impl Packets<'_> {
    /// Returns the data that packets carry.
    const fn data(&self) -> &[u8] {
        match self {
            Self::One(_) => &[],
            Self::Several { packets, .. } => packets.data(),
        }
    }

    /// Returns why the message is given up after an answer that is wrong.
    const fn wrong(&self) -> Reason {
        match self {
            Self::One(_) => Reason::OTHER,
            Self::Several { packets, .. } => packets.wrong(),
        }
    }
}
