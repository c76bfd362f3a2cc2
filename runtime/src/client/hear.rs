//! What a frame is to a client: an answer, or what others say.

use super::entry::{Answered, Asked};
use super::{Client, Heard};
use crate::{Problem, Protocol, Received};

impl<P: Protocol, const N: usize, const G: usize> Client<P, N, G> {
    /// Says what a frame is that was received at a time. It answers nothing that was sent after that.
    ///
    /// An adapter that knows when a frame came gives that time. Otherwise the program gives the time at which it
    /// reads the frame. When the clock goes back, only the next [`poll`](Self::poll) tells the client. What was received
    /// since then counts as old until that. A driver that hands back what it has sent must not pass it on: it would be a
    /// [rival](Heard::Rival).
    pub fn handle(&mut self, frame: &impl embedded_can::Frame, received_at: u32) -> Heard<P> {
        let received_at = self.clock.steady(received_at);
        let received = match Received::decode_by(self.model, frame) {
            Ok(received) => received,
            Err(Problem::Length) => return self.answered_short(frame, received_at),
            Err(problem) => return Heard::Unrecognised(problem),
        };
        let node = received.sender();
        let (heard, answered) = match self.asking(frame, received_at) {
            Some(place) => self.answered(place, frame, received, received_at),
            None if received.is_to_module() => (Heard::Rival(received), None),
            None => (Heard::Other(received), None),
        };
        if let Some(node) = node {
            if self.health.heard(node) {
                self.quiet = None;
            }
            self.groups.heard(node, received_at);
        }
        let asked = node.map(Asked::One);
        let first = answered.and_then(|answered| Some((answered.ended?, answered.begun)));
        for entry in self.entries.iter_mut().flatten() {
            if asked == Some(entry.asked) {
                entry.has_heard(received_at, answered);
            }
            if let Some((first, begun)) = first {
                entry.led_by(first, Some(begun));
            }
        }
        heard
    }

    /// Takes a frame for the answer to the request at a place. Also says what that changes for other requests.
    fn answered(
        &mut self,
        place: usize,
        frame: &impl embedded_can::Frame,
        received: Received<P>,
        received_at: u32,
    ) -> (Heard<P>, Option<Answered>) {
        self.quiet = None;
        let Some(Some(entry)) = self.entries.get_mut(place) else { return (Heard::Other(received), None) };
        if let Some(heard) = entry.too_late(received, received_at) {
            return (heard, None);
        }
        let is_refusal = entry.request.refuses(frame) == Some(true);
        let group = self.groups.asked_by(entry);
        let heard = entry.answered(received, is_refusal, self.model, received_at, group);
        let is_over = matches!(heard, Heard::Answer { .. }) && entry.is_resting();
        let answered = Answered { begun: entry.begun, ended: is_over.then_some(entry.ticket) };
        let is_heard = matches!(heard, Heard::Answer { .. } | Heard::Refusal { .. } | Heard::NotInEffect { .. });
        (heard, is_heard.then_some(answered))
    }

    /// Takes a frame that is too short or too long for the answer to a request, if there is one.
    fn answered_short(&mut self, frame: &impl embedded_can::Frame, received_at: u32) -> Heard<P> {
        let asking = self.asking(frame, received_at);
        match asking.and_then(|place| self.entries.get_mut(place)?.as_mut()) {
            Some(entry) if entry.awaits() => {
                self.quiet = None;
                let is_group_known = self.groups.is_asked_by(entry);
                entry.answered_short(frame, received_at, is_group_known)
            }
            _ => Heard::Unrecognised(Problem::Length),
        }
    }

    /// Returns the place of the request that a frame answers.
    fn asking(&self, frame: &impl embedded_can::Frame, received_at: u32) -> Option<usize> {
        let mut first: Option<(u8, usize)> = None;
        for (place, slot) in self.entries.iter().enumerate() {
            let Some(entry) = slot else { continue };
            // Most requests wait for nothing.
            if !entry.is_under_way() {
                continue;
            }
            let claim = entry.claim(received_at).filter(|claim| first.is_none_or(|(first, _)| *claim < first));
            match claim.filter(|_| self.groups.is_answer(entry, frame)) {
                // Nothing is surer.
                Some(0) => return Some(place),
                Some(claim) => first = Some((claim, place)),
                None => {}
            }
        }
        first.map(|(_, place)| place)
    }
}
