//! Requests that are held.

use std::vec::Vec;

use super::{Asking, PACE, Polled, answer, frame_sent};
use crate::client::{Client, Full, Heard, NotHeld, Pace, Step, Ticket, repeats};
use crate::tests::heaters::{HEAT, Heat, Message, To, frame};
use crate::{Frame, Received, Request};

/// The renewal of these tests.
const REFRESH: u32 = 1000;

fn power(heater: u8, power_w: f64) -> Request<Message, Heat> {
    Heat { power_w }.set(To::Heater(heater)).expect("a legal request")
}

/// The echo of heater 3, in steps of 10 W.
fn echo(steps: u8) -> Frame {
    frame(0x0107_F003, [2, 0xF0, 0, steps])
}

fn hold(client: &mut Asking, power_w: f64, now: u32) -> Ticket {
    client.hold(power(3, power_w), REFRESH, repeats, now).expect("room")
}

/// Holds heater 3 at 1500 W, and sends the request.
fn held(now: u32) -> (Asking, Ticket) {
    let mut client = Asking::new(PACE);
    let ticket = hold(&mut client, 1500.0, now);
    assert_eq!(client.step(now), sent(1500.0));
    (client, ticket)
}

fn sent(power_w: f64) -> Step {
    frame_sent(*power(3, power_w).frame())
}

fn is_in_effect(heard: &Heard<Message>, held: Ticket) -> bool {
    matches!(heard, Heard::Answer { ticket, .. } if *ticket == held)
}

fn is_late(heard: &Heard<Message>, held: Ticket) -> bool {
    matches!(heard, Heard::Late { ticket, .. } if *ticket == held)
}

#[test]
fn a_held_request_is_renewed_after_its_echo_agrees() {
    let (mut client, ticket) = held(7);
    assert!(is_in_effect(&client.hear(&echo(150)), ticket));
    assert_eq!([client.step(206), client.step(207)], [Step::Wait(Some(207)), Step::Wait(Some(1007))]);
    assert_eq!([client.step(1006), client.step(1007)], [Step::Wait(Some(1007)), sent(1500.0)]);
    assert!(is_in_effect(&client.hear(&echo(150)), ticket));
    assert_eq!([client.step(2006), client.step(2007)], [Step::Wait(Some(2007)), sent(1500.0)]);
}

#[test]
fn an_echo_of_something_else_lets_the_request_be_sent_again() {
    let (mut client, ticket) = held(0);
    assert!(matches!(client.hear(&echo(149)), Heard::NotInEffect { ticket: of, .. } if of == ticket));
    assert_eq!([client.step(99), client.step(100)], [Step::Wait(Some(100)), sent(1500.0)]);
    assert!(is_in_effect(&client.hear(&echo(150)), ticket));
    assert_eq!([client.step(999), client.step(1000)], [Step::Wait(Some(1000)), sent(1500.0)]);
}

#[test]
fn an_echo_that_never_agrees_is_lost_until_the_next_renewal() {
    let (mut client, ticket) = held(0);
    let is_other = |heard| matches!(heard, Heard::NotInEffect { ticket: of, .. } if of == ticket);
    assert!(is_other(client.hear(&echo(0))));
    assert_eq!(client.step(100), sent(1500.0));
    assert!(is_other(client.hear(&echo(0))));
    assert_eq!([client.step(199), client.step(200)], [Step::Wait(Some(200)), Step::Lost(ticket)]);
    assert_eq!([client.step(999), client.step(1000)], [Step::Wait(Some(1000)), sent(1500.0)]);
}

#[test]
fn the_program_says_how_far_an_echo_may_differ() {
    let near = |asked: &Received<Message>, said: &Received<Message>| match (asked.content(), said.content()) {
        (Message::Heat(asked), Message::Heat(said)) => (asked.power_w - said.power_w).abs() <= 20.0,
        _ => false,
    };
    let hear = |steps| {
        let mut client = Asking::new(PACE);
        let ticket = client.hold(power(3, 1500.0), REFRESH, near, 0).expect("room");
        assert_eq!(client.step(0), sent(1500.0));
        is_in_effect(&client.hear(&echo(steps)), ticket)
    };
    assert_eq!([147, 148, 152, 153].map(hear), [false, true, true, false]);
}

#[test]
fn a_refusal_ends_a_round_and_the_renewal_tries_again() {
    let (mut client, ticket) = held(0);
    let refused = frame(0x0107_F003, [2, 0xF2, 0, 150]);
    assert!(matches!(client.hear(&refused), Heard::Refusal { ticket: of, .. } if of == ticket));
    assert_eq!([client.step(200), client.step(999)], [Step::Wait(Some(1000)); 2]);
    assert_eq!(client.step(1000), sent(1500.0));
}

#[test]
fn what_replaces_a_held_request_is_sent_at_once_and_the_old_one_never_again() {
    let (mut client, old) = held(0);
    assert!(is_in_effect(&client.hear(&echo(150)), old));
    let new = hold(&mut client, 0.0, 700);
    assert_ne!(new, old);
    assert_eq!(client.step(700), sent(0.0));
    assert!(is_in_effect(&client.hear(&echo(0)), new));
    for round in 1..5 {
        let due = 700 + round * REFRESH;
        assert_eq!([client.step(due - 1), client.step(due)], [Step::Wait(Some(due)), sent(0.0)]);
        assert!(is_in_effect(&client.hear(&echo(0)), new));
    }
}

#[test]
fn no_answer_counts_while_one_to_the_replaced_request_can_come() {
    // 500 W, then 0 W, then 500 W again: the echo of the first must not count for the third.
    let mut client = Asking::new(PACE);
    hold(&mut client, 500.0, 0);
    assert_eq!(client.step(0), sent(500.0));
    hold(&mut client, 0.0, 5);
    assert_eq!([client.step(19), client.step(20)], [Step::Wait(Some(20)), sent(0.0)]);
    let last = hold(&mut client, 500.0, 30);
    assert!(is_late(&client.hear(&echo(50)), last));
    assert_eq!(client.step(40), sent(500.0));
    // The answer to 500 W of 0 ms can come until 200 ms, and that to 0 W of 20 ms until 220 ms.
    assert!(is_late(&client.hear(&echo(50)), last));
    assert_eq!([client.step(219), client.step(220)], [Step::Wait(Some(220)), sent(500.0)]);
    assert!(is_in_effect(&client.hear(&echo(50)), last));
}

#[test]
fn a_refusal_counts_no_more_than_an_answer_while_it_could_be_one_to_the_replaced_request() {
    let (mut client, _) = held(0);
    let new = hold(&mut client, 0.0, 5);
    assert_eq!(client.step(20), sent(0.0));
    assert!(is_late(&client.hear(&frame(0x0107_F003, [2, 0xF2, 0, 150])), new));
    let short = Frame::new_raw(0x0107_F003, true, [2, 0xF2, 0, 0, 0, 0, 0, 0], 2);
    assert!(matches!(client.hear(&short), Heard::Broken(of) if of == new));
    assert_eq!([client.step(199), client.step(200)], [Step::Wait(Some(200)), sent(0.0)]);
}

#[test]
fn to_hold_the_same_in_a_loop_changes_nothing() {
    let (mut client, ticket) = held(0);
    for now in 1..100 {
        assert_eq!(hold(&mut client, 1500.0, now), ticket);
        assert_eq!(client.step(now), Step::Wait(Some(100)));
    }
    assert!(is_in_effect(&client.hear(&echo(150)), ticket));
}

#[test]
fn what_is_replaced_faster_than_it_can_be_answered_is_lost_if_nobody_answers() {
    let lost = |answers: bool| {
        let mut client = Asking::new(PACE);
        let mut lost = Vec::new();
        for now in 0..1000 {
            if now % 30 == 0 {
                hold(&mut client, f64::from(now), now);
            }
            match client.step(now) {
                Step::Send { .. } if answers => {
                    let heard = client.hear(&echo(201));
                    assert!(matches!(heard, Heard::Late { .. } | Heard::NotInEffect { .. }));
                }
                Step::Lost(_) => lost.push(now),
                Step::Send { .. } | Step::Silent(_) | Step::Back(_) | Step::ClockBack(_) | Step::Wait(_) => {}
                Step::Done(_) | Step::Missing { .. } => panic!("a held request is never done"),
            }
        }
        lost
    };
    assert_eq!(lost(true), []);
    assert_eq!(lost(false).first(), Some(&100));
    assert!(lost(false).len() > 5);
}

#[test]
fn a_program_is_to_poll_when_what_is_replaced_fast_is_lost() {
    let (mut client, _) = held(0);
    let new = hold(&mut client, 0.0, 50);
    assert_eq!([client.step(50), client.step(50)], [sent(0.0), Step::Wait(Some(100))]);
    assert_eq!(client.step(100), Step::Lost(new));
}

#[test]
fn what_replaces_a_waiting_request_takes_its_place_in_the_queue() {
    let mut client = Asking::new(PACE);
    for (heater, now) in [(1, 1), (3, 2), (2, 3)] {
        client.hold(power(heater, 100.0), REFRESH, repeats, now).expect("room");
    }
    let stop = power(3, 0.0);
    client.hold(stop, REFRESH, repeats, 5).expect("room");
    let steps = [5, 25, 45].map(|now| client.step(now));
    assert_eq!(steps, [power(1, 100.0), stop, power(2, 100.0)].map(|request| frame_sent(*request.frame())));
}

#[test]
fn what_must_be_hurried_is_sent_first() {
    let mut client = Asking::new(PACE);
    for heater in [1, 2] {
        client.ask(power(heater, 100.0), 0).expect("room");
    }
    let stop = hold(&mut client, 0.0, 5);
    client.hurry(stop, 5);
    assert_eq!([client.step(5), client.step(25)], [sent(0.0), frame_sent(*power(1, 100.0).frame())]);
}

#[test]
fn a_replaced_request_that_is_cancelled_keeps_its_room_until_no_answer_can_come() {
    let (mut client, _) = held(0);
    let new = hold(&mut client, 0.0, 5);
    client.cancel(new);
    assert!(is_late(&client.hear(&echo(150)), new));
    assert_eq!(
        [client.step(10), client.step(199), client.step(200)],
        [Step::Wait(Some(200)), Step::Wait(Some(200)), Step::Wait(None)]
    );
}

#[test]
fn what_is_held_again_after_it_was_cancelled_does_not_wait_for_late_answers() {
    let (mut client, old) = held(0);
    client.cancel(old);
    let new = hold(&mut client, 1500.0, 30);
    assert_eq!(client.step(30), sent(1500.0));
    assert!(is_late(&client.hear(&echo(150)), new));
    assert_eq!([client.step(199), client.step(200)], [Step::Wait(Some(200)), sent(1500.0)]);
    assert!(is_in_effect(&client.hear(&echo(150)), new));
}

#[test]
fn a_request_that_nobody_is_known_to_answer_is_not_held() {
    let mut client = Asking::new(PACE);
    for target in [To::All, To::Group(2)] {
        let request = HEAT.set(target).expect("a legal request");
        assert_eq!(client.hold(request, REFRESH, repeats, 0), Err(NotHeld::Unconfirmed));
    }
    assert_eq!(client.step(0), Step::Wait(None));
}

#[test]
fn to_replace_what_is_held_needs_no_room() {
    let mut client: Client<Message, 1> = Client::new(Pace { gap: 0, ..PACE });
    assert!(client.hold(power(3, 100.0), REFRESH, repeats, 0).is_ok());
    assert_eq!(client.hold(power(4, 0.0), REFRESH, repeats, 0), Err(NotHeld::Full));
    assert_eq!(client.ask(power(3, 0.0), 0), Err(Full));
    assert!(client.hold(power(3, 0.0), REFRESH, repeats, 0).is_ok());
    assert_eq!(client.step(0), sent(0.0));
    assert!(matches!(client.hear(&answer(3)), Heard::NotInEffect { .. }));
}
