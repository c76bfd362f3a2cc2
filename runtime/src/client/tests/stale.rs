//! Answers that come after something else was asked.

use std::vec;
use std::vec::Vec;

use super::{Polled, frame_sent};
use crate::client::{Client, Heard, Pace, Step, Ticket, repeats};
use crate::plumbing::Who;
use crate::tests::heaters::{COMMAND, FRAME, FUNCTION, Heat, Message, RESULT, To, frame};
use crate::{Access, Exchange, Frame, Request};

type Asking = Client<Message, 6, 1>;

const PACE: Pace = Pace { gap: 50, wait: 100, tries: 3, late: 200 };
const REFRESH: u32 = 1000;
const GROUP: To = To::Group(2);

/// Reads what was set. Its answers look like echoes.
pub(super) static GET: Exchange = Access::new("get", &[Some(Who::One), Some(Who::Each), None])
    .request(&FRAME.selectors(&[FUNCTION]).data(FUNCTION.place, 3))
    .reply(&FRAME.selectors(&[FUNCTION, RESULT]).data(FUNCTION.place, 2).accepting())
    .of("heat")
    .id(COMMAND, 7)
    .length(4);

fn power(target: To, power_w: f64) -> Request<Message, Heat> {
    Heat { power_w }.set(target).expect("a legal request")
}

fn get() -> Request<Message, Heat> {
    GET.request_to(To::Heater(3), &()).expect("a legal request")
}

fn read(heater: u8) -> Request<Message, Heat> {
    Heat::ask(To::Heater(heater)).expect("a legal request")
}

fn sent(request: &Request<Message, Heat>) -> Step {
    frame_sent(*request.frame())
}

/// The echo of a heater, in steps of 10 W.
fn echo(heater: u8, steps: u8) -> Frame {
    frame(0x0107_F000 | u32::from(heater), [2, 0xF0, 0, steps])
}

fn refusal(heater: u8) -> Frame {
    frame(0x0107_F000 | u32::from(heater), [2, 0xF2, 0, 0])
}

fn hold(client: &mut Asking, target: To, power_w: f64, now: u32) -> Ticket {
    client.hold(power(target, power_w), REFRESH, repeats, now).expect("room")
}

/// Holds heater 3 at a power and at 250 ms at another one, whose echo does not come before 360 ms.
///
/// It can come until 550 ms.
fn replaced(old_w: f64, new_w: f64) -> (Asking, Ticket) {
    let mut client = Asking::new(PACE);
    hold(&mut client, To::Heater(3), old_w, 0);
    assert_eq!(client.step(0), sent(&power(To::Heater(3), old_w)));
    let steps = if old_w > 0.0 { 10 } else { 0 };
    assert!(matches!(client.hear(&echo(3, steps)), Heard::Answer { .. }));
    assert_eq!(client.step(50), Step::Wait(Some(300)));
    let held = hold(&mut client, To::Heater(3), new_w, 250);
    assert_eq!(client.step(250), sent(&power(To::Heater(3), new_w)));
    client.ask(read(1), 349).expect("room");
    assert_eq!(client.step(349), sent(&read(1)));
    assert!(matches!(client.hear(&frame(0x010C_F001, [0; 4])), Heard::Answer { .. }));
    assert_eq!(client.step(360), Step::Wait(Some(399)));
    (client, held)
}

/// Polls each millisecond, and returns when something was sent.
fn times_of(client: &mut Asking, request: &Request<Message, Heat>, times: core::ops::Range<u32>) -> Vec<u32> {
    times
        .filter(|now| core::iter::repeat_with(|| client.step(*now)).take(4).any(|step| step == sent(request)))
        .collect()
}

#[test]
fn an_echo_of_what_was_held_is_no_answer_to_a_stop_that_is_lost() {
    let (mut client, on) = replaced(0.0, 1500.0);
    let off = power(To::Heater(3), 0.0);
    let stop = client.ask(off, 361).expect("room");
    client.hurry(stop, 361);
    assert_eq!(times_of(&mut client, &off, 361..450), []);
    assert!(matches!(client.hear(&echo(3, 150)), Heard::Late { ticket, .. } if ticket == on));
    // No echo of the switch-on can come from 550 ms on. The bus loses the first frame.
    assert_eq!(times_of(&mut client, &off, 450..700), [550, 650]);
    assert!(matches!(client.hear(&echo(3, 0)), Heard::Answer { ticket, .. } if ticket == stop));
}

#[test]
fn a_set_point_is_not_answered_by_an_older_one() {
    let (mut client, old) = replaced(100.0, 200.0);
    let new = client.ask(power(To::Heater(3), 300.0), 361).expect("room");
    client.hurry(new, 361);
    assert_eq!(times_of(&mut client, &power(To::Heater(3), 300.0), 361..450), []);
    assert!(matches!(client.hear(&echo(3, 20)), Heard::Late { ticket, .. } if ticket == old));
    assert_eq!(times_of(&mut client, &power(To::Heater(3), 300.0), 450..560), [550]);
}

#[test]
fn a_read_is_not_refused_by_the_refusal_of_a_write() {
    let (mut client, held) = replaced(0.0, 1500.0);
    let read = client.ask(get(), 361).expect("room");
    client.hurry(read, 361);
    assert_eq!(times_of(&mut client, &get(), 361..450), []);
    assert!(matches!(client.hear(&refusal(3)), Heard::Late { ticket, .. } if ticket == held));
    assert_eq!(times_of(&mut client, &get(), 450..640), [550]);
}

#[test]
fn a_refusal_of_what_was_held_does_not_end_the_round_of_a_stop() {
    let (mut client, _) = replaced(0.0, 1500.0);
    let stop = hold(&mut client, To::Heater(3), 0.0, 361);
    let off = power(To::Heater(3), 0.0);
    assert_eq!(times_of(&mut client, &off, 361..450), [399]);
    assert!(matches!(client.hear(&refusal(3)), Heard::Late { ticket, .. } if ticket == stop));
    assert_eq!(times_of(&mut client, &off, 450..600), [550]);
    assert!(matches!(client.hear(&echo(3, 0)), Heard::Answer { ticket, .. } if ticket == stop));
}

#[test]
fn an_answer_that_comes_before_the_request_is_sent_once_more_is_late() {
    let (mut client, held) = replaced(0.0, 1500.0);
    assert!(matches!(client.hear(&echo(3, 150)), Heard::Late { ticket, .. } if ticket == held));
    let short = Frame::new_raw(0x0107_F003, true, [2, 0xF2, 0, 0, 0, 0, 0, 0], 2);
    assert!(matches!(client.hear(&short), Heard::Broken(ticket) if ticket == held));
    assert_eq!(client.step(399), sent(&power(To::Heater(3), 1500.0)));
    assert!(matches!(client.hear(&echo(3, 150)), Heard::Answer { ticket, .. } if ticket == held));
}

/// Lets what is held listen, and then wait for something that is never in effect.
fn held_back() -> Asking {
    let (mut client, held) = replaced(0.0, 1500.0);
    let first = hold(&mut client, To::Heater(5), 500.0, 360);
    assert_eq!(client.hold_after(first, power(To::Heater(3), 1500.0), repeats, 360), Ok(held));
    client
}

#[test]
fn others_wait_for_answers_to_what_is_not_sent_again() {
    let mut client = held_back();
    let get = get();
    client.ask(get, 400).expect("room");
    let mut now = 400;
    let steps: Vec<_> = core::iter::from_fn(|| {
        let step = client.step(now);
        if let Step::Wait(wake) = step {
            now = wake?;
        }
        (now < 600).then_some((now, step))
    })
    .filter(|(_, step)| *step == sent(&get))
    .collect();
    assert_eq!(steps, vec![(550, sent(&get))]);
}

#[test]
fn others_do_not_wait_for_answers_to_what_is_not_sent_again_for_25_days() {
    let mut client = held_back();
    let mut now = 400;
    while now < 25 * 24 * 3_600_000 {
        if let Step::Wait(wake) = client.step(now) {
            now = wake.expect("it is renewed").max(now + 900_000);
        }
    }
    let get = get();
    let read = client.ask(get, now).expect("room");
    client.hurry(read, now);
    assert!(times_of(&mut client, &get, now..now + 60).len() == 1);
}

#[test]
fn an_answer_is_for_what_was_sent_and_not_for_what_waits() {
    let mut client = Asking::new(PACE);
    client.members(GROUP, [4, 5]).expect("room");
    hold(&mut client, To::Heater(4), 1500.0, 0);
    assert_eq!(client.step(0), sent(&power(To::Heater(4), 1500.0)));
    let asked = client.ask(power(To::Heater(5), 0.0), 1).expect("room");
    assert_eq!(client.step(50), sent(&power(To::Heater(5), 0.0)));
    // It takes the room of the first, and is deaf until 300 ms.
    hold(&mut client, GROUP, 0.0, 60);
    assert!(matches!(client.hear(&echo(5, 0)), Heard::Answer { ticket, .. } if ticket == asked));
}

/// Asks a group whose members are not known, and tells the client who they are.
fn asked_before_members() -> (Asking, Ticket) {
    let mut client = Asking::new(PACE);
    let ticket = client.ask(power(GROUP, 1500.0), 0).expect("room");
    assert_eq!(client.step(0), sent(&power(GROUP, 1500.0)));
    client.members(GROUP, [1, 4]).expect("room");
    (client, ticket)
}

#[test]
fn a_module_that_is_no_member_any_more_can_still_answer_what_the_group_was_asked() {
    let (mut client, group) = asked_before_members();
    client.ask(power(To::Heater(7), 0.0), 1).expect("room");
    assert_eq!(times_of(&mut client, &power(To::Heater(7), 0.0), 1..90), []);
    assert!(matches!(client.hear(&echo(7, 150)), Heard::Answer { ticket, .. } if ticket == group));
    assert_eq!(client.step(100), Step::Done(group));
    assert_eq!(times_of(&mut client, &power(To::Heater(7), 0.0), 100..400), [300]);
}

#[test]
fn a_stranger_is_not_missing() {
    let (mut client, group) = asked_before_members();
    assert_eq!(client.step(100), sent(&power(GROUP, 1500.0)));
    for (heater, is_new) in [(1, true), (7, false), (4, true)] {
        let answer = if heater == 7 { refusal(7) } else { echo(heater, 150) };
        let heard = client.hear(&answer);
        assert_eq!(matches!(heard, Heard::Answer { ticket, .. } if ticket == group), is_new);
        assert_eq!(matches!(heard, Heard::Twice { .. }), !is_new);
    }
    assert_eq!(client.step(101), Step::Done(group));
}

#[test]
fn what_replaces_a_request_to_a_group_is_open_to_those_who_were_its_members() {
    let (mut client, _) = asked_before_members();
    let stop = hold(&mut client, GROUP, 0.0, 10);
    client.ask(power(To::Heater(7), 0.0), 11).expect("room");
    assert_eq!(times_of(&mut client, &power(To::Heater(7), 0.0), 11..150), []);
    assert!(matches!(client.hear(&echo(7, 150)), Heard::Late { ticket, .. } if ticket == stop));
}

#[test]
fn only_what_was_sent_before_is_open_to_those_who_are_no_members() {
    let mut client = Asking::new(PACE);
    client.members(GROUP, [1, 4]).expect("room");
    let group = client.every(1000, power(GROUP, 1500.0), 0).expect("room");
    let is_answered_by = |client: &mut Asking, heater| matches!(client.hear(&echo(heater, 150)), Heard::Answer { ticket, .. } if ticket == group);
    assert_eq!(client.step(0), sent(&power(GROUP, 1500.0)));
    let other = client.every(1000, power(To::Heater(2), 1500.0), 0).expect("room");
    // The same members again, other ones, and those again.
    client.members(GROUP, [1, 4]).expect("room");
    assert!(!is_answered_by(&mut client, 7));
    client.members(GROUP, [1, 4, 7]).expect("room");
    client.members(GROUP, [1, 4]).expect("room");
    assert!(is_answered_by(&mut client, 7));
    assert!(matches!(client.hear(&echo(2, 150)), Heard::Answer { ticket, .. } if ticket != other));
    let _ = times_of(&mut client, &power(GROUP, 1500.0), 1..1001);
    assert!(!is_answered_by(&mut client, 7));
    assert!(is_answered_by(&mut client, 1));
}
