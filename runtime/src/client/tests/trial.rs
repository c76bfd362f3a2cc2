//! Half a minute with six heaters on a simulated bus with faults.
//!
//! Heaters 1 and 2 are asked at random. Something is held of the others, and in the end a stop: of heater 3,
//! and of heaters 4 to 6 as a group. All are kept alive.

use std::string::String;
use std::vec::Vec;
use std::{format, vec};

use super::Polled as _;
use crate::client::{Client, Heard, Nodes, Pace, Step, Ticket, repeats};
use crate::sim::tests::Heater;
use crate::sim::{Bench, Complaint, Event, Faults, Random, Rules};
use crate::tests::heaters::{Heat, Message, To};
use crate::{Frame, Request, Route};

/// How long a run takes, and when it stops the heaters.
const END: u32 = 30_000;
const STOP: u32 = 20_000;
const REFRESH: u32 = 500;
/// After this time without a change, what is held is in effect.
const SETTLED: u32 = 4000;
const GROUP: To = To::Group(2);
/// The ways in which a stop ends, by their places in [`Outcome::stops`].
const IN_EFFECT: usize = 0;
const REFUSED: usize = 1;
const LOST: usize = 2;
const MISSING: usize = 3;

/// What came of a run.
#[derive(Debug, Default)]
pub struct Outcome {
    /// What the client did wrong.
    pub wrong: Vec<String>,
    /// How many requests were answered, refused and lost.
    pub ends: [u32; 3],
    /// How often a stop was in effect, was refused, was lost, and was missed by some of a group.
    pub stops: [u32; 4],
    /// How many echoes were late, and said something else.
    pub echoes: [u32; 2],
}

/// What is held of a target.
struct Wish {
    target: To,
    ticket: Ticket,
    power_w: f64,
    since: u32,
    /// Whether the heaters have confirmed it.
    is_confirmed: bool,
}

/// What was asked once.
struct Asked {
    ticket: Ticket,
    frame: Frame,
    power_w: f64,
    sent: u8,
    ends: u32,
}

struct Trial {
    pace: Pace,
    random: Random,
    bench: Bench<Message, Heater, 6, 64>,
    client: Client<Message, 32, 1>,
    asked: Vec<Asked>,
    wishes: Vec<Wish>,
    /// The heaters that are reported silent.
    silent: Nodes,
    /// The heaters that were stopped, and are reported not to be off.
    doubtful: Nodes,
    outcome: Outcome,
}

/// Runs half a minute by a seed.
pub fn run(seed: u64, pace: Pace) -> Outcome {
    let mut trial = Trial::new(seed, pace);
    (0..END).for_each(|now| trial.millisecond(now));
    trial.finish();
    trial.outcome
}

fn set(target: To, power_w: f64) -> Request<Message, Heat> {
    Heat { power_w }.set(target).expect("a legal request")
}

/// Draws a power that differs from others by more than an echo drifts.
fn power(random: &mut Random) -> f64 {
    50.0 * f64::from(1 + random.below(30))
}

impl Trial {
    fn new(seed: u64, pace: Pace) -> Self {
        let mut random = Random::new(seed);
        let rules = Rules { gap: pace.gap, watchdog: Some(5000), boot: 300 };
        let heater = |number| (number, Heater { group: (number > 3).then_some(2), ..Heater::default() });
        let mut bench = Bench::new([1, 2, 3, 4, 5, 6].map(heater), rules, seed);
        let mut client = Client::new(pace);
        client.members(GROUP, [4, 5, 6]).expect("room");
        for number in 1..=6 {
            let drawn = Faults { slowest: 2 * pace.wait, code: 5, ..Faults::random(&mut random, 30, END) };
            let (deaf, refused) = (drawn.deaf / 3, drawn.refused / 3);
            let drifted = if number < 3 { 0 } else { drawn.drifted };
            // Another sender than heaters 7 to 9 could not be told from the right one.
            let disguised = if number < 6 { 0 } else { drawn.disguised };
            *bench.faults(number).expect("a heater") = Faults { deaf, disguised, refused, drifted, ..drawn };
            client.keep_alive(Heat::ask(To::Heater(number)).expect("a legal request"), 1000, 0).expect("room");
        }
        if random.chance(50) {
            let other = Heat::ask(Route::new(To::Heater(3), 0xF1)).expect("a legal request");
            bench.another_controller(*other.frame(), 70, 0).expect("room");
        }
        let (silent, doubtful, outcome) = (Nodes::NONE, Nodes::NONE, Outcome::default());
        Self { pace, random, bench, client, asked: vec![], wishes: vec![], silent, doubtful, outcome }
    }

    fn millisecond(&mut self, now: u32) {
        self.ask(now);
        self.wish(now);
        while let Some(event) = self.bench.poll(now) {
            match event {
                Event::Frame { frame, .. } => self.hear(&frame, now),
                Event::Complaint(complaint) => self.complain(now, &complaint),
            }
        }
        loop {
            match self.client.polled(now) {
                Step::Send { frame, .. } => self.send(&frame, now),
                Step::Lost(ticket) => {
                    self.end(ticket, 2, None, now);
                    self.report(ticket, LOST, Nodes::from([3, 4, 5, 6]), now);
                }
                Step::Missing { ticket, nodes } => self.report(ticket, MISSING, nodes, now),
                Step::Done(ticket) => self.report(ticket, IN_EFFECT, Nodes::NONE, now),
                Step::Silent(node) if self.silent.contains(node) => self.wrong(now, "silent twice"),
                Step::Silent(node) => self.silent.insert(node),
                Step::Back(node) => {
                    if !self.silent.remove(node) {
                        self.wrong(now, "back twice");
                    }
                }
                Step::ClockBack(_) => self.wrong(now, "the clock goes back"),
                Step::Wait(_) => break,
            }
        }
        self.check_stops(now);
    }

    fn wrong(&mut self, now: u32, what: &str) {
        self.outcome.wrong.push(format!("{now} ms: {what}"));
    }

    fn complain(&mut self, now: u32, complaint: &Complaint) {
        self.outcome.wrong.push(format!("{now} ms: {complaint}"));
    }

    /// Asks heater 1 or 2 now and then, each time for another power.
    fn ask(&mut self, now: u32) {
        if now < END - 5000 && self.random.below(400) == 0 {
            let power_w = 10.0 * f64::from(u32::try_from(self.asked.len() % 200).expect("few"));
            let heater = 1 + u8::try_from(self.random.below(2)).expect("few");
            let request = set(To::Heater(heater), power_w);
            if let Ok(ticket) = self.client.ask(request, now) {
                self.asked.push(Asked { ticket, frame: *request.frame(), power_w, sent: 0, ends: 0 });
            }
        }
    }

    /// Holds something else of heaters 3 to 6 now and then, and stops them in the end.
    fn wish(&mut self, now: u32) {
        if now == STOP {
            self.hold(To::Heater(3), 0.0, now);
            self.wishes.retain(|wish| wish.target == To::Heater(3));
            self.hold(GROUP, 0.0, now);
        }
        for heater in 3..=6 {
            let odds = if now < 5000 { 100 } else { 3000 };
            if now == 0 || now < STOP && self.random.below(odds) == 0 {
                let power_w = power(&mut self.random);
                self.hold(To::Heater(heater), power_w, now);
            }
        }
    }

    fn hold(&mut self, target: To, power_w: f64, now: u32) {
        let ticket = self.client.hold(set(target, power_w), REFRESH, repeats, now).expect("room");
        if self.wishes.iter().any(|wish| wish.ticket == ticket) {
            return;
        }
        self.wishes.retain(|wish| wish.target != target);
        self.wishes.push(Wish { target, ticket, power_w, since: now, is_confirmed: false });
    }

    fn send(&mut self, request: &Frame, now: u32) {
        self.bench.send(request, now);
        let asked = self.asked.iter_mut().filter(|asked| asked.ends == 0 && asked.frame == *request);
        asked.for_each(|asked| asked.sent += 1);
        let is_set = |target| set(target, 0.0).frame().raw_id() == request.raw_id();
        let Some(target) = [3, 4, 5, 6].map(To::Heater).into_iter().chain([GROUP]).find(|target| is_set(*target))
        else {
            return;
        };
        let wish = self.wishes.iter().find(|wish| wish.target == target);
        if wish.is_none_or(|wish| set(target, wish.power_w).frame() != request) {
            self.wrong(now, "it sends what was replaced");
        }
    }

    fn hear(&mut self, frame: &Frame, now: u32) {
        match self.client.handle(frame, now) {
            Heard::Answer { ticket, received } => {
                self.end(ticket, 0, Some(*received.content()), now);
                self.confirm(ticket, now);
            }
            Heard::Refusal { ticket, received } => {
                self.end(ticket, 1, None, now);
                let node = received.node().and_then(|node| u8::try_from(node).ok());
                self.report(ticket, REFUSED, node.into_iter().collect(), now);
            }
            Heard::ShortRefusal(ticket) => self.end(ticket, 1, None, now),
            Heard::NotInEffect { .. } => self.outcome.echoes[1] += 1,
            Heard::Late { .. } => self.outcome.echoes[0] += 1,
            Heard::Starting { .. }
            | Heard::Broken(_)
            | Heard::Twice { .. }
            | Heard::Rival(_)
            | Heard::Other(_)
            | Heard::Unrecognised(_) => {}
        }
    }

    /// Notes how a request ends that was asked once.
    fn end(&mut self, ticket: Ticket, end: usize, content: Option<Message>, now: u32) {
        let Some(asked) = self.asked.iter_mut().find(|asked| asked.ticket == ticket) else { return };
        asked.ends += 1;
        self.outcome.ends[end] += 1;
        let is_right = content.is_none_or(|content| content == Message::Heat(Heat { power_w: asked.power_w }));
        let is_tried = end < 2 || asked.sent == self.pace.tries;
        if !is_right {
            self.wrong(now, "an answer is taken for one to another request");
        }
        if !is_tried {
            self.wrong(now, "a request is lost that was not sent as often as it may be");
        }
    }

    fn is_stop(&self, ticket: Ticket) -> bool {
        self.wishes.iter().any(|wish| wish.ticket == ticket && wish.since == STOP)
    }

    /// Tests that a single heater was told last what the client says is in effect.
    fn confirm(&mut self, ticket: Ticket, now: u32) {
        let Some(wish) = self.wishes.iter().find(|wish| wish.ticket == ticket) else { return };
        let (To::Heater(heater), power_w) = (wish.target, wish.power_w) else { return };
        let told = self.bench.device(heater).and_then(|heater| heater.told.last().copied());
        if told.is_none_or(|(_, told)| told.to_bits() != power_w.to_bits()) {
            self.wrong(now, "what is reported to be in effect is not");
        }
        self.report(ticket, IN_EFFECT, Nodes::NONE, now);
    }

    /// Notes that a stop has ended in one of the ways of [`Outcome::stops`], and is not in effect for some heaters.
    fn report(&mut self, ticket: Ticket, way: usize, but: Nodes, now: u32) {
        if !self.is_stop(ticket) {
            return;
        }
        self.outcome.stops[way] += 1;
        let Some(wish) = self.wishes.iter_mut().find(|wish| wish.ticket == ticket) else { return };
        wish.is_confirmed |= way == IN_EFFECT;
        let heaters: &[u8] = if wish.target == GROUP { &[4, 5, 6] } else { &[3] };
        for heater in heaters {
            // One refusal says nothing of the others.
            if but.contains(*heater) {
                self.doubtful.insert(*heater);
            } else if way != REFUSED {
                self.doubtful.remove(*heater);
            }
            if !self.doubtful.contains(*heater) && way != REFUSED && self.is_hot(*heater) {
                self.wrong(now, "a heater delivers although its stop is confirmed");
            }
        }
    }

    fn is_hot(&mut self, heater: u8) -> bool {
        self.bench.is_up(heater) && self.bench.device(heater).is_some_and(|heater| heater.power_w > 0.0)
    }

    /// Tests that what was stopped and confirmed stays off.
    fn check_stops(&mut self, now: u32) {
        let confirmed = self.wishes.iter().filter(|wish| wish.since == STOP && wish.is_confirmed);
        let groups: Vec<&[u8]> =
            confirmed.map(|wish| if wish.target == GROUP { &[4, 5, 6][..] } else { &[3] }).collect();
        if groups.concat().into_iter().any(|heater| self.is_hot(heater)) {
            self.wrong(now, "a heater that was stopped delivers again");
        }
        if now + 1 == STOP {
            self.check_wishes(now);
        }
    }

    /// Tests that heaters do what has been held for a while, also after they started anew.
    fn check_wishes(&mut self, now: u32) {
        for place in 0..self.wishes.len() {
            let Wish { target: To::Heater(heater), power_w, since, .. } = self.wishes[place] else { continue };
            let is_up = self.bench.is_up(heater);
            let Some(device) = self.bench.device(heater) else { continue };
            let last = device.events.last().map_or(0, |(time, _)| *time).max(since);
            if is_up && now - last > SETTLED && device.power_w.to_bits() != power_w.to_bits() {
                self.wrong(now, "a heater does not do what is held");
            }
        }
    }

    fn finish(&mut self) {
        let now = END;
        if self.asked.iter().any(|asked| asked.ends != 1) {
            self.wrong(now, "a request does not end once");
        }
        for heater in 1..=6 {
            let died = self.bench.faults(heater).and_then(|faults| faults.dies);
            if died.is_some_and(|died| died < END - SETTLED) && !self.client.silent().contains(heater) {
                self.wrong(now, "a dead heater is not reported");
            }
        }
        for heater in 3..=6 {
            if self.is_hot(heater) && !self.doubtful.contains(heater) {
                self.wrong(now, "a heater delivers after the stop, and nobody says so");
            }
        }
    }
}
