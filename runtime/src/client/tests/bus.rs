//! A bus on which frames get lost, come late, come twice and have a wrong length.

use std::vec::Vec;

use crate::client::{Client, Heard, Pace, Step, Ticket};
use crate::tests::heaters::{COMMAND, FRAME, Heat, Message, SOURCE, TARGET, To, decode};
use crate::tests::random::Random;
use crate::{Filter, Frame};

/// Requests of a run.
const REQUESTS: usize = 60;

/// What came of a run.
pub struct Outcome {
    /// How often each request ended.
    pub ends: Vec<u32>,
    /// How many requests were answered, refused and lost.
    pub counts: [u32; 3],
    /// Answers with the value of another request.
    pub wrong: u32,
    /// The shortest time between two requests.
    pub shortest_gap: u32,
}

/// A bus with heaters that set what they are asked to set.
struct Bus {
    random: Random,
    /// Frames under way to the client, with the time at which they come.
    frames: Vec<(u32, Frame)>,
    /// How many of a hundred frames have each fault.
    lost: u64,
    twice: u64,
    broken: u64,
    refused: u64,
    slowest: u64,
}

/// Asks heaters at random for one run.
pub fn run(seed: u64, pace: Pace) -> Outcome {
    let mut random = Random(seed);
    let [lost, twice, broken] = [(); 3].map(|()| random.below(31));
    let slowest = 2 * u64::from(pace.wait);
    let mut bus = Bus { random, frames: Vec::new(), lost, twice, broken, refused: 5, slowest };
    let mut client: Client<Message, 8> = Client::new(pace);
    let mut outcome = Outcome { ends: Vec::new(), counts: [0; 3], wrong: 0, shortest_gap: u32::MAX };
    let mut asked: Vec<(Ticket, Heat)> = Vec::new();
    let mut sent = None;
    for now in 0..60_000 {
        if asked.len() < REQUESTS && bus.random.below(40) == 0 {
            let heat = Heat { power_w: 10.0 * f64::from(u32::try_from(asked.len()).expect("few")) };
            let heater = 1 + u8::try_from(bus.random.below(3)).expect("few");
            if let Ok(ticket) = client.ask(heat.set(To::Heater(heater)).expect("a legal request"), now) {
                asked.push((ticket, heat));
                outcome.ends.push(0);
            }
        }
        while let Some(frame) = bus.arrived(now) {
            let (ticket, end, content) = match client.handle(&frame) {
                Heard::Answer { ticket, received } => (ticket, 0, Some(*received.content())),
                Heard::Refusal { ticket, received } => (ticket, 1, Some(*received.content())),
                Heard::ShortRefusal(ticket) => (ticket, 1, None),
                Heard::NotInEffect { .. }
                | Heard::Broken(_)
                | Heard::Late { .. }
                | Heard::Twice { .. }
                | Heard::Other(_)
                | Heard::Unrecognised(_) => continue,
            };
            outcome.end(&asked, ticket, end, content);
        }
        loop {
            match client.poll(now) {
                Step::Send(frame) => {
                    let gap = sent.map_or(u32::MAX, |sent| now - sent);
                    outcome.shortest_gap = outcome.shortest_gap.min(gap);
                    sent = Some(now);
                    bus.answer(&frame, now);
                }
                Step::Lost(ticket) | Step::Done(ticket) => outcome.end(&asked, ticket, 2, None),
                Step::Silent(_) | Step::Back(_) | Step::Missing { .. } => {}
                Step::Wait(_) => break,
            }
        }
    }
    outcome
}

impl Outcome {
    fn end(&mut self, asked: &[(Ticket, Heat)], ticket: Ticket, end: usize, content: Option<Message>) {
        let place = asked.iter().position(|(known, _)| *known == ticket).expect("a request");
        self.ends[place] += 1;
        self.counts[end] += 1;
        self.wrong += u32::from(content.is_some_and(|content| content != Message::Heat(asked[place].1)));
    }
}

impl Bus {
    fn chance(&mut self, percent: u64) -> bool {
        self.random.below(100) < percent
    }

    /// Lets a heater answer a request.
    fn answer(&mut self, request: &Frame, now: u32) {
        let asked = decode(request).expect("a request");
        let id = asked.frame().raw_id();
        let reply: Filter = FRAME.id(COMMAND, 7).id(TARGET, SOURCE.of(id)).id(SOURCE, TARGET.of(id));
        let [_, _, high, low, ..] = asked.frame().bytes();
        let result = if self.chance(self.refused) { 0xF2 } else { 0xF0 };
        let length = if self.chance(self.broken) { 5 } else { 4 };
        let reply = Frame::new_raw(reply.frame(4).raw_id(), true, [2, result, high, low, 0, 0, 0, 0], length);
        for _ in 0..=u8::from(self.chance(self.twice)) {
            let delay = u32::try_from(1 + self.random.below(self.slowest)).expect("short");
            if !self.chance(self.lost) {
                self.frames.push((now + delay, reply));
            }
        }
    }

    /// Returns the next frame that has come.
    fn arrived(&mut self, now: u32) -> Option<Frame> {
        let place = self.frames.iter().position(|(time, _)| *time <= now)?;
        Some(self.frames.swap_remove(place).1)
    }
}
