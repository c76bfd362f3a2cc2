//! Frames that the driver refuses, and a bus that goes away.

use std::vec::Vec;

use super::order::{Asking, on, sent, set};
use super::{PACE, Polled, answer, frame_sent, heat, is_answer};
use crate::client::{Bus, Heard, Pace, Step, Ticket, repeats};
use crate::tests::heaters::{HEAT, Message, To, frame};
use crate::{Frame, Request};

/// Polls once, and lets the driver refuse what is sent.
fn refused(client: &mut Asking, now: u32) -> Frame {
    let step = client.poll(now);
    let Step::Send { ticket, frame } = step else { panic!("{step:?}") };
    client.not_sent(ticket, now);
    frame
}

#[test]
fn a_frame_that_the_driver_refuses_is_no_try_and_is_due_after_the_gap() {
    let mut client = Asking::new(PACE);
    let ticket = client.ask(heat(3), 0).expect("room");
    for now in [0, 20, 40] {
        assert_eq!(refused(&mut client, now), *heat(3).frame());
        assert_eq!(client.step(now), Step::Wait(Some(now + 20)));
    }
    assert_eq!([client.step(60), client.step(160)], [frame_sent(*heat(3).frame()); 2]);
    assert_eq!(client.step(260), Step::Lost(ticket));
}

#[test]
fn a_driver_that_refuses_all_frames_does_not_keep_a_program_in_its_loop() {
    let mut client = Asking::new(Pace { gap: 0, ..PACE });
    client.ask(heat(3), 5).expect("room");
    client.ask(heat(4), 5).expect("room");
    assert_eq!(refused(&mut client, 5), *heat(3).frame());
    assert_eq!(client.step(5), Step::Wait(Some(6)));
    assert_eq!([client.step(6), client.step(6)], [3, 4].map(|heater| frame_sent(*heat(heater).frame())));
}

#[test]
fn what_the_driver_refused_keeps_its_place() {
    let mut client = Asking::new(PACE);
    client.ask(heat(3), 0).expect("room");
    client.ask(heat(4), 1).expect("room");
    assert_eq!(refused(&mut client, 2), *heat(3).frame());
    assert_eq!([client.step(22), client.step(42)], [3, 4].map(|heater| frame_sent(*heat(heater).frame())));
    // A stop that was hurried is still first.
    let mut client = Asking::new(PACE);
    client.ask(heat(3), 0).expect("room");
    let stop = client.ask(heat(4), 1).expect("room");
    client.hurry(stop, 1);
    assert_eq!(refused(&mut client, 2), *heat(4).frame());
    assert_eq!([client.step(22), client.step(42)], [4, 3].map(|heater| frame_sent(*heat(heater).frame())));
    // After that it waits for its turn.
    client.cancel(stop);
    client.ask(heat(5), 43).expect("room");
    assert_eq!(client.step(62), frame_sent(*heat(5).frame()));
}

#[test]
fn only_what_was_sent_last_is_taken_back_and_only_before_the_next_poll() {
    let mut client = Asking::new(PACE);
    let [first, second] = [3, 4].map(|heater| client.ask(heat(heater), 0).expect("room"));
    assert_eq!(client.step(0), frame_sent(*heat(3).frame()));
    client.not_sent(second, 0);
    assert_eq!(client.step(0), Step::Wait(Some(20)));
    client.not_sent(first, 0);
    assert_eq!(client.step(20), frame_sent(*heat(4).frame()));
    assert_eq!(client.step(20), Step::Wait(Some(100)));
}

#[test]
fn what_was_not_sent_is_not_answered() {
    let mut client = Asking::new(PACE);
    let ticket = client.ask(heat(3), 0).expect("room");
    refused(&mut client, 0);
    assert!(matches!(client.handle(&answer(3), 10), Heard::Other(_)));
    assert_eq!(client.step(20), frame_sent(*heat(3).frame()));
    assert!(is_answer(&client.handle(&answer(3), 30), ticket));
    // The second frame is refused. The answer to the first one counts.
    let (mut client, ticket) = asked(3, 0);
    assert_eq!(refused(&mut client, 100), *heat(3).frame());
    assert!(is_answer(&client.handle(&answer(3), 110), ticket));
    assert_eq!([client.step(199), client.step(200)], [Step::Wait(Some(200)), Step::Wait(None)]);
}

#[test]
fn an_answer_that_comes_before_the_driver_refuses_ends_a_request() {
    let (mut client, ticket) = asked(3, 0);
    let step = client.poll(100);
    assert!(matches!(step, Step::Send { ticket: of, .. } if of == ticket));
    assert!(is_answer(&client.handle(&answer(3), 100), ticket));
    client.not_sent(ticket, 100);
    assert_eq!(sent(&mut client, 100..1000), []);
}

/// Asks a heater, and sends the request.
fn asked(heater: u8, now: u32) -> (Asking, Ticket) {
    let mut client = Asking::new(PACE);
    let ticket = client.ask(heat(heater), now).expect("room");
    assert_eq!(client.step(now), frame_sent(*heat(heater).frame()));
    (client, ticket)
}

/// Holds a set-point and a switch-on after it. The set-point is in effect at 10 ms.
fn led() -> (Asking, [Ticket; 2]) {
    let mut client = Asking::new(PACE);
    let first = client.hold(set(1500.0), 1000, repeats, 0).expect("room");
    let second = client.hold_after(first, on(3), |_, _| true, 0).expect("room");
    assert_eq!(client.step(0), frame_sent(*set(1500.0).frame()));
    assert!(matches!(client.handle(&answer(3), 10), Heard::Answer { ticket, .. } if ticket == first));
    (client, [first, second])
}

#[test]
fn a_follower_that_the_driver_refuses_is_sent_soon_or_after_what_it_follows() {
    let (mut client, _) = led();
    assert_eq!([20, 40].map(|now| refused(&mut client, now)), [*on(3).frame(); 2]);
    assert_eq!(sent(&mut client, 41..100), [(60, *on(3).frame())]);
    // The gap after the set-point ends at 20 ms, so it is old from 221 ms on.
    let (mut client, _) = led();
    for now in (20..=220).step_by(20) {
        assert_eq!(refused(&mut client, now), *on(3).frame());
    }
    assert_eq!(sent(&mut client, 221..300), [(240, *set(1500.0).frame())]);
}

#[test]
fn a_leader_that_the_driver_refuses_goes_before_what_follows_it() {
    let (mut client, [first, _]) = led();
    assert_eq!(sent(&mut client, 20..21), [(20, *on(3).frame())]);
    assert!(matches!(client.handle(&frame(0x010C_F003, [0; 4]), 30), Heard::Answer { .. }));
    assert_eq!(sent(&mut client, 31..1000), []);
    assert_eq!(refused(&mut client, 1000), *set(1500.0).frame());
    assert_eq!(sent(&mut client, 1001..1040), [(1020, *set(1500.0).frame())]);
    assert!(matches!(client.handle(&answer(3), 1040), Heard::Answer { ticket, .. } if ticket == first));
    assert_eq!(sent(&mut client, 1040..1050), [(1040, *on(3).frame())]);
}

#[test]
fn nothing_is_sent_or_lost_while_the_bus_is_off() {
    let (mut client, ticket) = asked(3, 0);
    let other = client.ask(heat(4), 10).expect("room");
    client.bus(Bus::Off, 50);
    assert_eq!(
        [50, 100, 10_000].map(|now| client.step(now)),
        [Step::Wait(Some(200)), Step::Wait(Some(200)), Step::Wait(None)]
    );
    client.bus(Bus::Off, 10_000);
    client.bus(Bus::On, 10_000);
    // Heater 3 has all its tries again.
    let steps = [10_000, 10_020, 10_100, 10_120, 10_200, 10_220].map(|now| client.step(now));
    let frames = [3, 4].map(|heater| frame_sent(*heat(heater).frame()));
    assert_eq!(steps, [frames[0], frames[1], frames[0], frames[1], Step::Lost(ticket), Step::Lost(other)]);
    assert_eq!([10_220; 2].map(|now| client.step(now)), [Step::Silent(3), Step::Silent(4)]);
}

#[test]
fn an_answer_that_was_under_way_when_the_bus_went_off_counts() {
    let (mut client, ticket) = asked(3, 0);
    client.bus(Bus::Off, 50);
    assert!(is_answer(&client.handle(&answer(3), 60), ticket));
    client.bus(Bus::On, 300);
    assert_eq!(sent(&mut client, 300..1000), []);
    // From 200 ms on, none can come.
    let (mut client, _) = asked(3, 0);
    client.bus(Bus::Off, 50);
    assert_eq!([client.step(199), client.step(200)], [Step::Wait(Some(200)), Step::Wait(None)]);
    assert!(matches!(client.handle(&answer(3), 201), Heard::Other(_)));
}

#[test]
fn others_wait_for_answers_that_were_under_way_when_the_bus_went_off() {
    let (mut client, first) = asked(3, 0);
    client.bus(Bus::Off, 50);
    client.cancel(first);
    let stop = client.ask(heat(3), 60).expect("room");
    client.hurry(stop, 60);
    client.bus(Bus::On, 70);
    assert_eq!(sent(&mut client, 70..250), [(200, *heat(3).frame())]);
}

#[test]
fn a_module_that_was_lost_before_the_bus_went_off_is_not_silent() {
    let (mut client, ticket) = asked(3, 0);
    assert_eq!([client.step(100), client.step(200)], [frame_sent(*heat(3).frame()), Step::Lost(ticket)]);
    client.bus(Bus::Off, 200);
    assert_eq!(client.step(200), Step::Wait(Some(300)));
    assert!(client.silent().is_empty());
}

#[test]
fn what_is_replaced_again_and_again_is_not_lost_while_the_bus_is_off() {
    let mut client = Asking::new(PACE);
    for now in [0, 20, 40] {
        client.hold(set(f64::from(now)), 1000, repeats, now).expect("room");
        assert!(matches!(client.step(now), Step::Send { .. }));
    }
    client.bus(Bus::Off, 50);
    assert!([60, 100, 200, 300, 1000].iter().all(|now| matches!(client.step(*now), Step::Wait(_))));
}

#[test]
fn a_stop_that_was_hurried_goes_first_when_the_bus_is_back() {
    let mut client = Asking::new(PACE);
    client.ask(heat(4), 0).expect("room");
    let stop = client.ask(heat(3), 5).expect("room");
    client.hurry(stop, 5);
    assert_eq!(client.step(5), frame_sent(*heat(3).frame()));
    client.bus(Bus::Off, 10);
    let next = client.ask(heat(5), 20).expect("room");
    client.hurry(next, 20);
    client.bus(Bus::On, 500);
    assert_eq!([500, 520, 540].map(|now| client.step(now)), [3, 5, 4].map(|heater| frame_sent(*heat(heater).frame())));
}

#[test]
fn rounds_that_were_missed_while_the_bus_was_off_are_left_out() {
    let mut client = Asking::new(PACE);
    client.every(300, heat(3), 0).expect("room");
    assert_eq!(client.step(0), frame_sent(*heat(3).frame()));
    assert!(matches!(client.handle(&answer(3), 1), Heard::Answer { .. }));
    client.bus(Bus::Off, 2);
    assert_eq!(sent(&mut client, 2..1000), []);
    client.bus(Bus::On, 1000);
    assert_eq!(sent(&mut client, 1000..1050), [(1000, *heat(3).frame())]);
    assert!(matches!(client.handle(&answer(3), 1050), Heard::Answer { .. }));
    assert_eq!(sent(&mut client, 1050..1300), [(1200, *heat(3).frame())]);
}

#[test]
fn what_follows_waits_anew_after_the_bus_was_off() {
    let requests = |sent: &[(u32, Frame)]| -> Vec<Frame> { sent.iter().map(|(_, frame)| *frame).collect() };
    let expected: [Frame; 1] = [*set(1500.0).frame()];
    // It was to be sent, and a confirmation came while the bus was off.
    let (mut client, _) = led();
    client.bus(Bus::Off, 15);
    client.bus(Bus::On, 20);
    assert_eq!(requests(&sent(&mut client, 20..200)), []);
    assert_eq!(requests(&sent(&mut client, 200..300)), expected);
    // It was sent, and nobody knows whether it arrived.
    let (mut client, _) = led();
    assert_eq!(sent(&mut client, 20..21), [(20, *on(3).frame())]);
    client.bus(Bus::Off, 30);
    client.bus(Bus::On, 40);
    assert_eq!(requests(&sent(&mut client, 40..300)), expected);
}

#[test]
fn a_group_is_asked_anew_after_the_bus_was_off() {
    let mut client = Asking::new(PACE);
    client.members(To::Group(2), [1, 4]).expect("room");
    let request: Request<Message, _> = HEAT.set(To::Group(2)).expect("a legal request");
    let ticket = client.ask(request, 0).expect("room");
    assert_eq!(refused(&mut client, 0), *request.frame());
    assert_eq!(client.step(20), frame_sent(*request.frame()));
    client.bus(Bus::Off, 30);
    client.bus(Bus::On, 300);
    assert_eq!(client.step(300), frame_sent(*request.frame()));
    assert!([1, 4].iter().all(|heater| is_answer(&client.handle(&answer(*heater), 310), ticket)));
    assert_eq!(client.step(310), Step::Done(ticket));
}
