//! A client on a bus with faults, and in single situations.

mod conflicts;
mod duties;
mod groups;
mod health;
mod holds;
mod order;
mod outage;
mod random;
mod stale;
mod times;
mod trial;

use super::{Client, Duty, Full, Heard, Pace, Step, Ticket};
use crate::tests::heaters::{HEAT, Heat, Message, To, frame};
use crate::{Frame, Problem, Protocol, Request, Time, Timing};
use core::time::Duration;

const PACE: Pace = Pace { gap: 20, wait: 100, tries: 2, late: 100 };

type Asking = Client<Message, 4>;

fn heat(heater: u8) -> Request<Message, Heat> {
    HEAT.set(To::Heater(heater)).expect("a legal request")
}

pub trait Polled {
    type Protocol: Protocol;

    /// Polls a client without a look at the tickets of what is sent.
    fn step(&mut self, now: u32) -> Step;

    /// Polls a client, and tests that one which looks at each of its requests would say the same.
    fn polled(&mut self, now: u32) -> Step;

    /// Gives a client a frame that comes at the last time that it was told.
    fn hear(&mut self, frame: &Frame) -> Heard<Self::Protocol>;
}

impl<P: Protocol, const N: usize, const G: usize> Polled for Client<P, N, G> {
    type Protocol = P;

    fn hear(&mut self, frame: &Frame) -> Heard<P> {
        self.handle(frame, self.clock.last().expect("a time was told"))
    }

    fn step(&mut self, now: u32) -> Step {
        let step = self.polled(now);
        if let Step::Send { frame, .. } = step { frame_sent(frame) } else { step }
    }

    fn polled(&mut self, now: u32) -> Step {
        let mut careful = Self { quiet: None, ..*self };
        let step = self.poll(now);
        assert_eq!(careful.poll(now), step, "at {now}");
        step
    }
}

/// What is sent, with any ticket.
const fn frame_sent(frame: Frame) -> Step {
    Step::Send { ticket: Ticket(u32::MAX), frame }
}

fn answer(heater: u8) -> Frame {
    frame(0x0107_F000 | u32::from(heater), [2, 0xF0, 0, 150])
}

/// Asks a heater, and sends the request.
fn asked(heater: u8, now: u32) -> (Asking, Ticket) {
    let mut client = Asking::new(PACE);
    let ticket = client.ask(heat(heater), now).expect("room");
    assert_eq!(client.step(now), frame_sent(*heat(heater).frame()));
    (client, ticket)
}

fn is_answer(heard: &Heard<Message>, to: Ticket) -> bool {
    matches!(heard, Heard::Answer { ticket, received } if *ticket == to && *received.content() == Message::Heat(HEAT))
}

#[test]
fn an_answer_ends_a_request() {
    let (mut client, ticket) = asked(3, 0);
    assert_eq!(client.step(0), Step::Wait(Some(100)));
    assert!(is_answer(&client.hear(&answer(3)), ticket));
    assert_eq!(client.step(99), Step::Wait(Some(200)));
    assert_eq!(client.step(200), Step::Wait(None));
}

#[test]
fn a_request_is_sent_again_and_then_lost() {
    let (mut client, ticket) = asked(3, u32::MAX - 50);
    assert_eq!(client.step(48), Step::Wait(Some(49)));
    assert_eq!(client.step(49), frame_sent(*heat(3).frame()));
    assert_eq!(client.step(148), Step::Wait(Some(149)));
    assert_eq!([client.step(149), client.step(149)], [Step::Lost(ticket), Step::Silent(3)]);
    assert_eq!(client.step(149), Step::Wait(Some(249)));
}

#[test]
fn what_is_sent_names_its_ticket() {
    let mut client = Asking::new(PACE);
    let tickets = [3, 4].map(|heater| client.ask(heat(heater), 0).expect("room"));
    let sent = [(0, 3, 0), (20, 4, 1), (100, 3, 0), (120, 4, 1)];
    for (now, heater, place) in sent {
        assert_eq!(client.poll(now), Step::Send { ticket: tickets[place], frame: *heat(heater).frame() });
    }
}

#[test]
fn an_answer_to_the_first_frame_ends_a_request_that_is_to_be_sent_again() {
    let (mut client, ticket) = asked(3, 0);
    let other = client.ask(heat(4), 90).expect("room");
    assert_eq!(client.step(90), frame_sent(*heat(4).frame()));
    assert_eq!(client.step(100), Step::Wait(Some(110)));
    assert!(is_answer(&client.hear(&answer(3)), ticket));
    assert_eq!(client.step(110), Step::Wait(Some(190)));
    assert!(is_answer(&client.hear(&answer(4)), other));
}

#[test]
fn no_frame_is_sent_before_the_gap_is_over_and_the_oldest_goes_first() {
    let mut client = Asking::new(PACE);
    let spare = client.ask(heat(4), 0).expect("room");
    for (heater, now) in [(1, 1), (2, 2)] {
        client.ask(heat(heater), now).expect("room");
    }
    // It takes the first place of the table.
    client.cancel(spare);
    client.ask(heat(3), 3).expect("room");
    assert_eq!(client.step(10), frame_sent(*heat(1).frame()));
    assert_eq!(client.step(10), Step::Wait(Some(30)));
    assert_eq!(client.step(29), Step::Wait(Some(30)));
    assert_eq!(client.step(30), frame_sent(*heat(2).frame()));
    assert_eq!(client.step(50), frame_sent(*heat(3).frame()));
}

#[test]
fn late_and_repeated_answers_are_no_answers() {
    let (mut client, ticket) = asked(3, 0);
    assert!(is_answer(&client.hear(&answer(3)), ticket));
    assert!(matches!(client.hear(&answer(3)), Heard::Twice { ticket: of, .. } if of == ticket));
    assert!(matches!(client.hear(&answer(4)), Heard::Other(_)));
    let (mut client, ticket) = asked(3, 0);
    assert_eq!([client.step(100), client.step(200)], [frame_sent(*heat(3).frame()), Step::Lost(ticket)]);
    assert!(matches!(client.hear(&answer(3)), Heard::Late { ticket: of, .. } if of == ticket));
    assert_eq!(client.step(300), Step::Wait(None));
    assert!(matches!(client.hear(&answer(3)), Heard::Other(_)));
}

#[test]
fn a_request_waits_until_no_answer_to_one_like_it_can_come() {
    let (mut client, first) = asked(3, 0);
    let second = client.ask(heat(3), 1).expect("room");
    let other = client.ask(heat(4), 2).expect("room");
    assert_eq!(client.step(20), frame_sent(*heat(4).frame()));
    assert!(is_answer(&client.hear(&answer(3)), first));
    assert!(is_answer(&client.hear(&answer(4)), other));
    assert_eq!(client.step(199), Step::Wait(Some(200)));
    assert_eq!(client.step(200), frame_sent(*heat(3).frame()));
    assert!(is_answer(&client.hear(&answer(3)), second));
}

#[test]
fn a_refusal_ends_a_request_and_a_broken_answer_does_not() {
    let (mut client, ticket) = asked(3, 0);
    let broken = Frame::new_raw(0x0107_F003, true, [2, 0xF0, 0, 150, 0, 0, 0, 0], 5);
    assert!(matches!(client.hear(&broken), Heard::Broken(of) if of == ticket));
    let refused = frame(0x0107_F003, [2, 0xF2, 0, 150]);
    assert!(matches!(client.hear(&refused), Heard::Refusal { ticket: of, .. } if of == ticket));
    assert!(matches!(client.hear(&answer(3)), Heard::Twice { .. }));
    assert!(matches!(client.hear(&broken), Heard::Unrecognised(Problem::Length)));
    let foreign = frame(0x0455_0000, [0; 4]);
    assert!(matches!(client.hear(&foreign), Heard::Unrecognised(Problem::Identifier)));
}

#[test]
fn a_refusal_of_any_length_ends_a_request() {
    let (mut client, ticket) = asked(3, 0);
    let short = Frame::new_raw(0x0107_F003, true, [2, 0xF2, 0, 0, 0, 0, 0, 0], 2);
    assert!(matches!(client.hear(&short), Heard::ShortRefusal(of) if of == ticket));
    assert_eq!([client.step(100), client.step(200)], [Step::Wait(Some(200)), Step::Wait(None)]);
}

#[test]
fn a_module_that_starts_is_asked_again_and_is_not_silent() {
    let starts = frame(0x1D07_F003, [2, 0xF0, 0, 0]);
    let (mut client, ticket) = asked(3, 0);
    assert!(is_starting(&client.hear(&starts), ticket));
    assert_eq!([client.step(99), client.step(100)], [Step::Wait(Some(100)), frame_sent(*heat(3).frame())]);
    let short = Frame::new_raw(0x1D07_F003, true, [2, 0xF0, 0, 0, 0, 0, 0, 0], 2);
    assert!(matches!(client.hear(&short), Heard::Broken(of) if of == ticket));
    assert!(is_answer(&client.hear(&answer(3)), ticket));

    let (mut client, ticket) = asked(3, 0);
    assert!(is_starting(&client.hear(&starts), ticket));
    assert_eq!(client.step(100), frame_sent(*heat(3).frame()));
    assert_eq!([client.step(200), client.step(200)], [Step::Lost(ticket), Step::Wait(Some(300))]);
}

fn is_starting(heard: &Heard<Message>, of: Ticket) -> bool {
    matches!(heard, Heard::Starting { ticket, received } if *ticket == of && received.error_code() == Some(7))
}

#[test]
fn nobody_answers_all_and_each_module_answers_a_group() {
    let mut client = Asking::new(PACE);
    let all = client.ask(HEAT.set(To::All).expect("a legal request"), 0).expect("room");
    let group = client.ask(HEAT.set(To::Group(2)).expect("a legal request"), 0).expect("room");
    assert!(matches!(client.step(0), Step::Send { .. }));
    assert_eq!(client.step(0), Step::Done(all));
    assert!(matches!(client.step(20), Step::Send { .. }));
    assert!(is_answer(&client.hear(&answer(1)), group));
    assert!(is_answer(&client.hear(&answer(2)), group));
    assert_eq!([client.step(119), client.step(120)], [Step::Wait(Some(120)), Step::Done(group)]);
    assert!(matches!(client.hear(&answer(5)), Heard::Twice { .. }));
}

#[test]
fn a_group_that_does_not_answer_is_asked_again() {
    let mut client = Asking::new(PACE);
    let request = HEAT.set(To::Group(2)).expect("a legal request");
    let ticket = client.ask(request, 0).expect("room");
    let steps = [0, 100, 200].map(|now| client.step(now));
    assert_eq!(steps, [frame_sent(*request.frame()), frame_sent(*request.frame()), Step::Lost(ticket)]);
}

#[test]
fn a_group_that_answers_before_it_is_asked_again_is_not() {
    let mut client = Asking::new(PACE);
    let group = client.ask(HEAT.set(To::Group(2)).expect("a legal request"), 0).expect("room");
    assert!(matches!(client.step(0), Step::Send { .. }));
    let other = client.ask(HEAT.set(To::All).expect("a legal request"), 90).expect("room");
    assert!(matches!(client.step(90), Step::Send { .. }));
    assert_eq!([client.step(90), client.step(100)], [Step::Done(other), Step::Wait(Some(110))]);
    assert!(is_answer(&client.hear(&answer(1)), group));
    assert_eq!([client.step(110), client.step(110)], [Step::Done(group), Step::Wait(Some(200))]);
}

#[test]
fn a_request_is_asked_again_and_again_and_missed_rounds_are_left_out() {
    let mut client = Asking::new(PACE);
    let ticket = client.every(300, heat(3), 0).expect("room");
    assert_eq!(client.step(0), frame_sent(*heat(3).frame()));
    assert!(is_answer(&client.hear(&answer(3)), ticket));
    assert_eq!(client.step(299), Step::Wait(Some(300)));
    assert_eq!(client.step(300), frame_sent(*heat(3).frame()));
    assert!(is_answer(&client.hear(&answer(3)), ticket));
    assert_eq!(client.step(1000), frame_sent(*heat(3).frame()));
    assert!(is_answer(&client.hear(&answer(3)), ticket));
    assert_eq!(client.step(1200), frame_sent(*heat(3).frame()));
    client.cancel(ticket);
    assert!(matches!(client.hear(&answer(3)), Heard::Late { ticket: of, .. } if of == ticket));
    assert_eq!([client.step(1399), client.step(1400)], [Step::Wait(Some(1400)), Step::Wait(None)]);
}

#[test]
fn a_period_is_no_longer_than_time_can_be_told() {
    let rounds = |period, now: [u32; 3]| {
        let mut client: Client<Message, 1> = Client::new(Pace { gap: 0, wait: 0, tries: 1, late: 0 });
        let ticket = client.every(period, HEAT.set(To::All).expect("a legal request"), 0).expect("room");
        now.map(|now| matches!(client.step(now), Step::Send { .. }) && client.step(now) == Step::Done(ticket))
    };
    assert_eq!(rounds(1, [0, 1, 2]), [true; 3]);
    let days = (1 << 31) - 1;
    assert_eq!(rounds(u32::MAX, [0, days - 1, days]), [true, false, true]);
    assert_eq!(rounds(1 << 31, [0, 1, days]), [true, false, true]);
}

#[test]
fn a_pace_whose_times_are_too_long_is_none() {
    let time = |milliseconds| Time::of(Duration::from_millis(milliseconds));
    let pace = |gap, wait, late| {
        let timing = Timing::NONE.with_request_gap(time(gap)).with_reply_timeout(time(wait)).with_tries(1);
        Pace::of(&timing, late).is_some()
    };
    assert!(pace((1 << 31) - 1, 100, (1 << 31) - 101));
    assert!(!pace(1 << 31, 100, 0));
    assert!(!pace(0, 1 << 31, 0));
    assert!(!pace(0, 100, (1 << 31) - 100));
    assert!(!pace(0, 100, u32::MAX));
}

#[test]
fn a_client_for_a_model_reads_frames_as_those_of_the_model() {
    let report = frame(0x010A_F003, [0; 4]);
    let access = |mut client: Asking| {
        assert_eq!(client.step(0), Step::Wait(None));
        if let Heard::Other(received) = client.hear(&report) { Some(received.exchange().access()) } else { None }
    };
    assert_eq!(access(Asking::new(PACE)), Some("report"));
    assert_eq!(access(Asking::new(PACE).for_model(1)), Some("report"));
    assert_eq!(access(Asking::new(PACE).for_model(2)), Some("report of model 2"));
}

#[test]
fn a_cancelled_request_that_was_not_sent_is_forgotten() {
    let mut client = Asking::new(PACE);
    let ticket = client.ask(heat(3), 0).expect("room");
    client.cancel(ticket);
    assert_eq!(client.step(0), Step::Wait(None));
}

#[test]
fn a_full_table_refuses_a_request_until_one_has_ended() {
    let mut client: Client<Message, 1> = Client::new(PACE);
    let slow = Pace { tries: 1, gap: 0, ..PACE };
    let ticket = client.ask_at(slow, heat(3), 0).expect("room");
    assert_eq!(client.ask(heat(4), 0), Err(Full));
    assert!(matches!(client.step(0), Step::Send { .. }));
    assert_eq!(
        [client.step(100), client.step(100), client.step(200)],
        [Step::Lost(ticket), Step::Silent(3), Step::Wait(None)]
    );
    assert!(client.ask(heat(4), 200).is_ok_and(|other| other != ticket));
}

#[test]
fn a_client_with_nothing_to_do_looks_at_no_request_until_it_has() {
    let mut client = Client::<Message, 4>::new(PACE);
    client.ask(heat(3), 0).expect("room");
    assert_eq!(client.step(0), frame_sent(*heat(3).frame()));
    let Step::Wait(Some(until)) = client.step(0) else { panic!("it waits for the answer") };
    // Nobody but a test can take a request away without a word.
    client.entries = [None; 4];
    assert_eq!([1, PACE.gap - 1].map(|now| client.poll(now)), [Step::Wait(Some(until)); 2]);
    assert_eq!(client.poll(until), Step::Wait(None));
}

#[test]
fn a_client_takes_no_more_memory_than_its_documentation_says() {
    let [none, request, group] =
        [size_of::<Client<Message, 0>>(), size_of::<Client<Message, 1>>(), size_of::<Client<Message, 0, 1>>()];
    // Only the pointers of a request are larger on a processor of 64 bits.
    assert!(none <= 168 && request - none <= 136 && group - none <= 120, "{none}, {request}, {group}");
    assert!(size_of::<Duty>() <= 24);
}

#[test]
fn on_a_bus_with_faults_the_client_does_nothing_wrong() {
    let mut outcomes = [0; 9];
    for seed in 1..=300 {
        let outcome = trial::run(seed, PACE);
        assert!(outcome.wrong.is_empty(), "seed {seed}: {:#?}", &outcome.wrong[..outcome.wrong.len().min(5)]);
        let counts = outcome.ends.into_iter().chain(outcome.stops).chain(outcome.echoes);
        outcomes.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
    }
    assert!(outcomes.iter().all(|count| *count > 300), "ends, stops and echoes: {outcomes:?}");
}

#[test]
fn a_client_that_does_not_wait_for_late_answers_takes_them_for_others() {
    let careless = Pace { late: 0, ..PACE };
    assert!((1..=30).any(|seed| !trial::run(seed, careless).wrong.is_empty()));
}
