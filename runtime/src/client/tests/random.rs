//! Random programs on a bus that loses and delays replies, but no longer than a pace says.
//!
//! The bus knows which frame each reply answers. Each program has two clients. One is polled each millisecond, and the
//! other only when something comes or [`Step::Wait`] says so. Both must send the same frames at the same times.
//! Times are shorter than on a real bus, so that much happens in few polls.
//!
//! The driver refuses frames, and keeps some that came for a while. The bus goes off and on. The program's clock starts
//! at any time, and goes back.

use std::string::String;
use std::vec::Vec;
use std::{env, format, println, vec};

use embedded_can::Frame as _;

use super::Polled as _;
use super::stale::GET;
use crate::client::{Bus, Client, Heard, Nodes, Pace, Step, Ticket, repeats};
use crate::sim::Random;
use crate::tests::heaters::{COMMAND, Heat, Message, TARGET, To, frame};
use crate::{Frame, Request};

/// How long a run takes.
const END: u32 = 500;
const GROUP: To = To::Group(2);
/// How many runs the tests make, unless the environment variable `CANSPEC_PROGRAMS` says how many.
const RUNS: u64 = 2000;

type Asking = Client<Message, 24, 1>;

/// What the client has sent.
#[derive(Clone, Copy)]
struct Sent {
    ticket: Ticket,
    is_to_group: bool,
    at: u32,
    /// Whether the bus went off while it waited for an answer.
    is_cut: bool,
}

/// A reply under way.
struct Reply {
    /// When it is received, and when the program sees it.
    at: u32,
    seen: u32,
    frame: Frame,
    /// What it answers, by its place in the list of what was sent.
    to: usize,
}

/// A switch-on that is held after a set-point.
#[derive(Clone, Copy)]
struct Order {
    /// Who gets the first one.
    target: To,
    first: Ticket,
    second: Ticket,
    /// When the first was sent last, if it has been in effect since and was not followed yet.
    confirmed: Option<u32>,
}

/// How often what was seen.
#[derive(Clone, Copy, Default, Debug)]
struct Counts {
    sent: u32,
    answered: u32,
    late: u32,
    followed: u32,
    stalls: u32,
    refused: u32,
    outages: u32,
    unread: u32,
    jumps: u32,
}

struct Run {
    random: Random,
    pace: Pace,
    refresh: u32,
    /// The client that is polled each millisecond, and the one that sleeps until a time.
    clients: [Asking; 2],
    wake: Option<u32>,
    /// How far the program's clock is ahead.
    clock: u32,
    /// When the clock was set back last.
    turned: Option<u32>,
    bus: Bus,
    /// Whether the driver refuses frames now.
    refuses: bool,
    /// What was asked once, and not cancelled.
    once: Vec<Ticket>,
    sent: Vec<Sent>,
    replies: Vec<Reply>,
    /// Everything that was asked and held, but for what was cancelled.
    tickets: Vec<Ticket>,
    orders: Vec<Order>,
    members: Nodes,
    counts: Counts,
    wrong: Vec<String>,
}

#[test]
#[expect(clippy::print_stdout, reason = "people read how much was tried")]
fn what_random_programs_are_told_is_true_and_in_time() {
    let runs = env::var("CANSPEC_PROGRAMS").map_or(RUNS, |runs| runs.parse().expect("a number of runs"));
    let (mut all, mut failed) = (Counts::default(), vec![]);
    for seed in 0..runs {
        let run = Run::new(seed).finished();
        if let Some(wrong) = run.wrong.first() {
            failed.push(format!("seed {seed}: {wrong}"));
        }
        let Counts { sent, answered, late, followed, stalls, refused, outages, unread, jumps } = run.counts;
        all.sent += sent;
        all.answered += answered;
        all.late += late;
        all.followed += followed;
        all.stalls += stalls;
        all.refused += refused;
        all.outages += outages;
        all.unread += unread;
        all.jumps += jumps;
    }
    println!("{runs} runs: {all:?}, {} failed", failed.len());
    assert!(failed.is_empty(), "{} of {runs}: {:#?}", failed.len(), &failed[..failed.len().min(10)]);
    let usual = [all.sent, all.answered, all.late, all.followed, all.stalls];
    let counts = usual.into_iter().chain([all.refused, all.outages, all.unread, all.jumps]);
    assert!(counts.into_iter().all(|count| u64::from(count) > runs / 2), "{all:?}");
}

impl Run {
    fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let (gap, wait) = (pick(&mut random, &[0, 1, 5, 5, 20]), 5 + random.below(20));
        let pace = Pace { gap, wait, tries: pick(&mut random, &[1, 2, 3]), late: random.below(3 * wait) };
        let mut client = Client::new(pace);
        let members = Nodes::from([4, 5]);
        if random.chance(80) {
            client.members(GROUP, members).expect("room");
        }
        Self {
            refresh: 2 * (wait + pace.late) + random.below(200),
            clock: pick(&mut random, &[0, 1 << 31, u32::MAX - END / 2]),
            random,
            turned: None,
            bus: Bus::On,
            refuses: false,
            once: vec![],
            pace,
            clients: [client; 2],
            wake: Some(0),
            sent: vec![],
            replies: vec![],
            tickets: vec![],
            orders: vec![],
            members,
            counts: Counts::default(),
            wrong: vec![],
        }
    }

    fn finished(mut self) -> Self {
        let mut now = 0;
        while now < END && self.wrong.is_empty() {
            self.millisecond(now);
            let is_stalled = self.random.below(150) == 0;
            self.counts.stalls += u32::from(is_stalled);
            if !is_stalled && self.random.below(150) == 0 {
                self.turn_back(now);
            }
            now += if is_stalled { 1 + self.random.below(4 * self.refresh) } else { 1 };
        }
        self
    }

    fn wrong(&mut self, now: u32, what: &str) {
        self.wrong.push(format!("{now} ms: {what}, {:?}", self.pace));
    }

    /// Returns what the program's clock shows.
    const fn shown(&self, now: u32) -> u32 {
        now.wrapping_add(self.clock)
    }

    /// Sets the program's clock back. The client that sleeps is woken, so that it misses no time. What the driver kept
    /// unread has times of the old clock, so it is lost.
    fn turn_back(&mut self, now: u32) {
        let same = self.poll(1, now);
        if !same.is_empty() {
            self.wrong(now, "one that sleeps sends something at the end of a millisecond");
        }
        self.clock = self.clock.wrapping_sub(2 + self.random.below(100_000));
        (self.wake, self.turned) = (Some(now), Some(now));
        self.replies.retain(|reply| reply.at > now);
        self.counts.jumps += 1;
    }

    /// Lets the bus go off or on.
    fn turn(&mut self, now: u32) {
        let shown = self.shown(now);
        self.bus = if self.bus == Bus::On { Bus::Off } else { Bus::On };
        let bus = self.bus;
        self.both(|client| client.bus(bus, shown));
        self.orders.iter_mut().for_each(|order| order.confirmed = order.confirmed.filter(|_| bus == Bus::Off));
        if bus == Bus::Off {
            self.counts.outages += 1;
            let longest = self.pace.wait;
            self.sent.iter_mut().filter(|sent| sent.at + longest >= now).for_each(|sent| sent.is_cut = true);
        }
    }

    fn millisecond(&mut self, now: u32) {
        let turns = self.random.below(if self.bus == Bus::On { 300 } else { 30 }) == 0;
        if turns {
            self.turn(now);
        }
        self.refuses = self.random.below(10) == 0;
        let mut come: Vec<Reply> = self.replies.extract_if(.., |reply| reply.seen <= now).collect();
        come.sort_by_key(|reply| reply.at);
        for reply in &come {
            self.hear(reply, now);
        }
        let acts = self.random.below(8) == 0;
        if acts {
            self.act(now);
        }
        let sent = self.poll(0, now);
        let is_awake = acts || turns || !come.is_empty() || self.wake.is_some_and(|wake| wake <= now);
        let same = if is_awake { self.poll(1, now) } else { vec![] };
        if sent != same {
            self.wrong(now, &format!("one that sleeps sends {same:?} and not {sent:?}"));
        }
        for (ticket, frame) in sent {
            self.send(ticket, frame, now);
        }
    }

    /// Polls one of the clients, and returns what it sends.
    fn poll(&mut self, place: usize, now: u32) -> Vec<(Ticket, Frame)> {
        let mut sent = vec![];
        let shown = self.shown(now);
        loop {
            match self.clients[place].polled(shown) {
                Step::Send { ticket, .. } if self.refuses => {
                    self.clients[place].not_sent(ticket, shown);
                    self.counts.refused += 1;
                }
                Step::Send { ticket, frame } => sent.push((ticket, frame)),
                Step::Done(ticket) => self.confirm(ticket),
                Step::Lost(ticket) => self.lose(ticket, now),
                Step::Missing { .. } | Step::Silent(_) => self.fall_silent(now),
                Step::Back(_) | Step::ClockBack(_) => {}
                Step::Wait(wake) => {
                    // What the clock showed is as far from now as it was.
                    let wake = wake.map(|wake| now.wrapping_add(wake.wrapping_sub(shown)));
                    self.wake = if place == 1 { wake } else { self.wake };
                    return sent;
                }
            }
        }
    }

    fn fall_silent(&mut self, now: u32) {
        if self.bus == Bus::Off {
            self.wrong(now, "somebody is missing while the bus is off");
        }
    }

    /// Tests that what is lost was sent as often as it may be, and the bus was on.
    fn lose(&mut self, ticket: Ticket, now: u32) {
        self.fall_silent(now);
        let sent = self.sent.iter().filter(|sent| sent.ticket == ticket && !sent.is_cut).count();
        if self.once.contains(&ticket) && sent < usize::from(self.pace.tries) {
            self.wrong(now, "what was asked is lost too early");
        }
    }

    /// Does the same with both clients.
    fn both<T: PartialEq>(&mut self, act: impl Fn(&mut Asking) -> T) -> T {
        let [result, other] = self.clients.each_mut().map(act);
        assert!(result == other, "two clients that were told the same differ");
        result
    }

    fn heater(&mut self) -> u8 {
        pick(&mut self.random, &[3, 4, 5])
    }

    fn target(&mut self) -> To {
        let heater = self.heater();
        if self.random.chance(30) { GROUP } else { To::Heater(heater) }
    }

    fn set(&mut self, target: To) -> Request<Message, Heat> {
        let power_w = pick(&mut self.random, &[0.0, 100.0, 200.0]);
        Heat { power_w }.set(target).expect("a legal request")
    }

    fn request(&mut self) -> Request<Message, Heat> {
        let target = self.target();
        match self.random.below(4) {
            0 => Heat::ask(target).expect("a legal request"),
            1 => GET.request_to(target, &()).expect("a legal request"),
            _ => self.set(target),
        }
    }

    /// Lets the program do something.
    fn act(&mut self, now: u32) {
        let shown = self.shown(now);
        match self.random.below(12) {
            0..3 => {
                let request = self.request();
                let asked = self.both(|client| client.ask(request, shown)).ok();
                self.once.extend(asked);
                self.note(asked, now);
            }
            3..7 => self.hold(now),
            7 | 8 => self.order(now),
            9 => self.repeat(now),
            10 if !self.tickets.is_empty() => {
                let ticket = pick(&mut self.random, &self.tickets);
                self.tickets.retain(|known| *known != ticket);
                self.both(|client| client.cancel(ticket));
            }
            _ if self.random.chance(20) => {
                let members = pick(&mut self.random, &[[4, 5], [3, 4], [3, 5]]).into();
                self.members = members;
                self.both(|client| client.members(GROUP, members).is_ok());
            }
            _ => {}
        }
    }

    /// Notes a request, and hurries some.
    fn note(&mut self, ticket: Option<Ticket>, now: u32) {
        let Some(ticket) = ticket else { return };
        if !self.tickets.contains(&ticket) {
            self.tickets.push(ticket);
        }
        if self.random.chance(30) {
            let shown = self.shown(now);
            self.both(|client| client.hurry(ticket, shown));
        }
    }

    fn hold(&mut self, now: u32) {
        let (target, refresh) = (self.target(), self.refresh);
        let request = self.set(target);
        let shown = self.shown(now);
        let held = self.both(|client| client.hold(request, refresh, repeats, shown)).ok();
        if let Some(ticket) = held {
            self.lead_instead(target, ticket);
        }
        self.note(held, now);
    }

    /// Notes what leads in place of what it replaces.
    fn lead_instead(&mut self, target: To, ticket: Ticket) {
        if self.tickets.contains(&ticket) {
            return;
        }
        let members = self.members;
        let is_member = |of: To| matches!(of, To::Heater(heater) if target == GROUP && members.contains(heater));
        let led = self.orders.iter_mut().filter(|order| order.target == target || is_member(order.target));
        led.for_each(|order| (order.target, order.first, order.confirmed) = (target, ticket, None));
    }

    fn repeat(&mut self, now: u32) {
        let (heater, request, refresh) = (self.heater(), self.request(), self.refresh);
        let alive = Heat::ask(To::Heater(heater)).expect("a legal request");
        let (is_alive, shown) = (self.random.chance(50), self.shown(now));
        let repeated = self.both(|client| {
            if is_alive { client.keep_alive(alive, refresh, shown) } else { client.every(refresh, request, shown) }
        });
        self.note(repeated.ok(), now);
    }

    /// Holds a switch-on, for which a read stands, after a set-point.
    fn order(&mut self, now: u32) {
        let (heater, refresh) = (self.heater(), self.refresh);
        let target = To::Heater(heater);
        let set = Heat { power_w: 100.0 }.set(target).expect("a legal request");
        let on = Heat::ask(target).expect("a legal request");
        let shown = self.shown(now);
        let Ok(first) = self.both(|client| client.hold(set, refresh, repeats, shown)) else { return };
        self.lead_instead(target, first);
        self.note(Some(first), now);
        let Ok(second) = self.both(|client| client.hold_after(first, on, |_, _| true, shown)) else { return };
        if !self.orders.iter().any(|order| (order.first, order.second) == (first, second)) {
            self.orders.retain(|order| order.second != second);
            self.orders.push(Order { target, first, second, confirmed: None });
        }
    }

    fn send(&mut self, ticket: Ticket, frame: Frame, now: u32) {
        self.counts.sent += 1;
        let idle = self.sent.last().map(|last| now - last.at);
        if self.bus == Bus::Off {
            self.wrong(now, "it sends while the bus is off");
        }
        if idle.is_some_and(|idle| idle < self.pace.gap) {
            self.wrong(now, "it sends within the gap");
        }
        if let Some(place) = self.orders.iter().position(|order| order.second == ticket) {
            self.follow(place, idle, now);
        }
        self.orders.iter_mut().filter(|order| order.first == ticket).for_each(|order| order.confirmed = None);
        let target = TARGET.of(frame.raw_id());
        self.sent.push(Sent { ticket, is_to_group: target > 9, at: now, is_cut: false });
        for heater in 3..=5 {
            if target == u32::from(heater) || target > 9 && self.members.contains(heater) {
                self.answer(heater, &frame, now);
            }
        }
    }

    /// Lets a heater answer what was sent last, if the bus loses nothing.
    fn answer(&mut self, heater: u8, request: &Frame, now: u32) {
        if self.random.chance(30) {
            return;
        }
        let longest = self.pace.wait + self.pace.late;
        let most = if self.random.chance(60) { self.pace.wait } else { longest };
        let result = if self.random.chance(10) { 0xF2 } else { 0xF0 };
        let command = COMMAND.of(request.raw_id());
        let data = if command == 0x0C { [0; 4] } else { [2, result, request.data()[2], request.data()[3]] };
        let answer = frame(0x0100_F000 | command << 16 | u32::from(heater), data);
        let at = now + 1 + self.random.below(most);
        // When the last answer can come, the next request may be sent. So it must be read at once.
        let unread = if at < now + longest && self.random.chance(10) { self.random.below(2 * longest) } else { 0 };
        self.replies.push(Reply { at, seen: at + unread, frame: answer, to: self.sent.len() - 1 });
    }

    fn hear(&mut self, reply: &Reply, now: u32) {
        let received_at = self.shown(reply.at);
        let [heard, _] = self.clients.each_mut().map(|client| client.handle(&reply.frame, received_at));
        let lay_unread = reply.seen > reply.at;
        self.counts.unread += u32::from(lay_unread);
        // Until the client hears of the new clock, what is received by it seems to be old.
        let is_old = lay_unread || self.turned == Some(now - 1);
        let (ticket, counts) = match heard {
            Heard::Answer { ticket, .. } | Heard::Refusal { ticket, .. } | Heard::NotInEffect { ticket, .. } => {
                (ticket, true)
            }
            Heard::Late { ticket, .. } | Heard::Twice { ticket, .. } => (ticket, false),
            Heard::Other(_) if is_old => return,
            Heard::Starting { .. }
            | Heard::ShortRefusal(_)
            | Heard::Broken(_)
            | Heard::Rival(_)
            | Heard::Other(_)
            | Heard::Unrecognised(_) => {
                self.wrong(now, "an answer is taken for something else");
                return;
            }
        };
        if counts && ticket != self.sent[reply.to].ticket {
            self.wrong(now, "an answer is taken for one to another request");
        }
        self.counts.answered += u32::from(counts);
        self.counts.late += u32::from(!counts);
        // A group is in effect when it is done.
        if matches!(heard, Heard::Answer { .. }) && !self.is_of_group(ticket) {
            self.confirm(ticket);
        }
    }

    fn is_of_group(&self, ticket: Ticket) -> bool {
        self.sent.iter().any(|sent| sent.ticket == ticket && sent.is_to_group)
    }

    /// Notes that what is held is in effect.
    fn confirm(&mut self, ticket: Ticket) {
        let sent = self.sent.iter().rfind(|sent| sent.ticket == ticket).map(|sent| sent.at);
        self.orders.iter_mut().filter(|order| order.first == ticket).for_each(|order| order.confirmed = sent);
    }

    /// Tests that what follows was led, and not long ago.
    fn follow(&mut self, place: usize, idle: Option<u32>, now: u32) {
        // A clock that goes back costs the client a millisecond.
        let longest = self.pace.gap + self.pace.wait + self.pace.late + self.counts.jumps;
        self.counts.followed += 1;
        match self.orders[place].confirmed {
            None => self.wrong(now, "a second is sent before its first is in effect"),
            Some(sent) if now - sent >= self.refresh => self.wrong(now, "a second is sent before its first is renewed"),
            Some(_) if idle.is_some_and(|idle| idle > longest) => self.wrong(now, "a second is sent after a stall"),
            Some(_) => self.orders[place].confirmed = None,
        }
    }
}

fn pick<T: Copy>(random: &mut Random, from: &[T]) -> T {
    from[random.below(u32::try_from(from.len()).expect("few")) as usize]
}
