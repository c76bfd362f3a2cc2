//! Times of receipt, clocks that go back, and starts at any time.

use std::string::ToString;
use std::vec::Vec;

use super::{Asking, PACE, Polled, answer, asked, frame_sent, heat, is_answer};
use crate::Frame;
use crate::client::{Client, Heard, NotHeld, NotRepeated, Pace, Step, Ticket, repeats};
use crate::tests::heaters::{HEAT, Heat, Message, To, frame};

const GROUP: To = To::Group(2);

/// What another controller asks of heater 3.
fn foreign() -> Frame {
    *HEAT.set(crate::Route::new(To::Heater(3), 0xF1)).expect("a legal request").frame()
}

#[test]
fn a_frame_that_was_received_before_a_request_was_sent_does_not_answer_it() {
    let (mut client, ticket) = asked(3, 1000);
    assert!(matches!(client.handle(&answer(3), 999), Heard::Other(_)));
    assert!(is_answer(&client.handle(&answer(3), 1000), ticket));
    assert!(matches!(client.handle(&answer(3), 999), Heard::Other(_)), "nor does it repeat the answer");
    assert!(matches!(client.handle(&answer(3), 1000), Heard::Twice { .. }));
    let short = Frame::new_raw(0x0107_F003, true, [2, 0xF2, 0, 0, 0, 0, 0, 0], 2);
    let (mut client, ticket) = asked(3, 1000);
    assert!(matches!(client.handle(&short, 999), Heard::Unrecognised(_)));
    assert!(matches!(client.handle(&short, 1000), Heard::ShortRefusal(of) if of == ticket));
}

#[test]
fn an_answer_that_was_received_between_two_sendings_counts() {
    let (mut client, ticket) = asked(3, 1000);
    assert_eq!(client.step(1100), frame_sent(*heat(3).frame()));
    assert!(is_answer(&client.handle(&answer(3), 1050), ticket));
}

#[test]
fn an_answer_that_lay_unread_is_not_for_the_next_request() {
    let (mut client, first) = asked(3, 0);
    assert_eq!(client.step(100), frame_sent(*heat(3).frame()));
    assert_eq!([client.step(200), client.step(200)], [Step::Lost(first), Step::Silent(3)]);
    let second = client.ask(heat(3), 300).expect("room");
    assert_eq!(client.step(300), frame_sent(*heat(3).frame()));
    assert!(matches!(client.handle(&answer(3), 299), Heard::Other(_)));
    assert!(is_answer(&client.handle(&answer(3), 300), second));
}

#[test]
fn an_answer_that_lay_unread_is_late_to_what_is_held_instead() {
    let mut client = Asking::new(Pace { tries: 3, ..PACE });
    let hold = |client: &mut Asking, power_w, now| {
        let request = Heat { power_w }.set(To::Heater(3)).expect("a legal request");
        client.hold(request, 1000, repeats, now).expect("room")
    };
    hold(&mut client, 500.0, 0);
    assert!(matches!(client.step(0), Step::Send { .. }));
    let new = hold(&mut client, 0.0, 150);
    assert!(matches!((client.step(150), client.step(200)), (Step::Send { .. }, Step::Wait(Some(250)))));
    // No answer to 500 W can come from 200 ms on. So the stop is sent once more, and listens.
    assert!(matches!(client.step(250), Step::Send { .. }));
    let off = frame(0x0107_F003, [2, 0xF0, 0, 0]);
    // The answer to its first frame can come until 350 ms, and counts if it comes after the second one was sent.
    assert!(matches!(client.handle(&off, 249), Heard::Late { ticket, .. } if ticket == new));
    assert!(is_held(&client.handle(&off, 250), new));
    assert!(matches!(client.handle(&off, 249), Heard::Late { ticket, .. } if ticket == new));
}

fn is_held(heard: &Heard<Message>, held: Ticket) -> bool {
    matches!(heard, Heard::Answer { ticket, .. } if *ticket == held)
}

#[test]
fn a_module_that_was_heard_before_a_request_was_sent_is_silent_if_it_does_not_answer() {
    let silent = |received_at| {
        let (mut client, ticket) = asked(3, 1000);
        assert!(matches!(client.handle(&frame(0x010C_F003, [0; 4]), received_at), Heard::Other(_)));
        assert_eq!([client.step(1100), client.step(1200)], [frame_sent(*heat(3).frame()), Step::Lost(ticket)]);
        client.step(1200) == Step::Silent(3)
    };
    assert_eq!([999, 1000, 1199].map(silent), [true, false, false]);
}

#[test]
fn a_member_that_was_heard_before_a_group_was_asked_is_silent_if_it_does_not_answer() {
    let silent = |received_at| {
        let mut client = Client::<Message, 4, 1>::new(PACE);
        client.members(GROUP, [1, 4]).expect("room");
        let ticket = client.ask(HEAT.set(GROUP).expect("a legal request"), 1000).expect("room");
        assert!(matches!(client.step(1000), Step::Send { .. }));
        assert!(is_answer(&client.handle(&answer(1), 1001), ticket));
        assert!(matches!(client.handle(&frame(0x010C_F004, [0; 4]), received_at), Heard::Other(_)));
        assert!(matches!(client.step(1100), Step::Send { .. }));
        assert!(matches!(client.step(1200), Step::Missing { nodes, .. } if nodes == [4].into()));
        client.step(1200) == Step::Silent(4)
    };
    assert_eq!([999, 1000, 1199].map(silent), [true, false, false]);
}

#[test]
fn another_controller_is_a_rival_and_its_answers_are_not() {
    let mut client = Asking::new(PACE);
    assert!(matches!(client.handle(&foreign(), 0), Heard::Rival(received) if received.node() == Some(3)));
    let answer_to_rival = frame(0x0107_F103, [2, 0xF0, 0, 150]);
    assert!(matches!(client.handle(&answer_to_rival, 0), Heard::Other(_)));
}

#[test]
fn a_clock_that_goes_back_is_an_event_and_nothing_is_sent_later_for_it() {
    let (mut client, ticket) = asked(3, 60_000);
    assert_eq!(client.step(60_040), Step::Wait(Some(60_100)));
    // The clock is set back by a minute. The answer may take 60 ms more.
    assert_eq!([client.step(40), client.step(40)], [Step::ClockBack(60_000), Step::Wait(Some(100))]);
    assert_eq!([client.step(99), client.step(100)], [Step::Wait(Some(100)), frame_sent(*heat(3).frame())]);
    assert!(is_answer(&client.handle(&answer(3), 100), ticket));
    assert_eq!(client.step(100), Step::Wait(Some(300)));
}

#[test]
fn whatever_tells_a_client_the_time_tells_it_that_the_clock_went_back() {
    let all = HEAT.set(To::All).expect("a legal request");
    let acts: [fn(&mut Asking, Ticket, u32); 6] = [
        |client, _, now| assert!(client.ask(heat(4), now).is_ok()),
        |client, _, now| assert!(client.every(1000, heat(4), now).is_ok()),
        |client, _, now| assert!(client.keep_alive(heat(4), 1000, now).is_ok()),
        |client, _, now| assert!(client.hold(heat(4), 1000, repeats, now).is_ok()),
        |client, held, now| assert!(client.hold_after(held, heat(4), repeats, now).is_ok()),
        |client, held, now| client.hurry(held, now),
    ];
    for act in acts {
        let mut client = Asking::new(PACE);
        let held = client.hold(heat(3), 1000, repeats, 5000).expect("room");
        client.ask(all, 5000).expect("room");
        act(&mut client, held, 4000);
        assert_eq!(client.step(4000), Step::ClockBack(1000));
        assert!(matches!(client.step(4000), Step::Send { .. }));
    }
}

#[test]
fn a_program_may_start_at_any_time() {
    let trace = |start: u32| -> Vec<(u32, Step)> {
        let mut client = Client::<Message, 6, 1>::new(PACE);
        let at = |now: u32| start.wrapping_add(now);
        client.members(GROUP, [4, 5]).expect("room");
        let first = client.hold(heat(3), 700, repeats, at(0)).expect("room");
        client.hold_after(first, Heat::ask(To::Heater(3)).expect("legal"), |_, _| true, at(0)).expect("room");
        client.hold(HEAT.set(GROUP).expect("legal"), 900, repeats, at(0)).expect("members are known");
        client.keep_alive(heat(1), 400, at(0)).expect("room");
        let mut steps = Vec::new();
        for now in 0..3000 {
            loop {
                let step = client.step(at(now));
                if let Step::Wait(until) = step {
                    steps.push((now, Step::Wait(until.map(|until| until.wrapping_sub(start)))));
                    break;
                }
                steps.push((now, step));
                if now % 7 > 3 {
                    let _ = client.handle(&answer(3), at(now));
                    let _ = client.handle(&answer(4), at(now));
                }
            }
        }
        steps
    };
    let expected = trace(0);
    assert!(expected.iter().filter(|(_, step)| matches!(step, Step::Send { .. })).count() > 20);
    for start in [1, (1 << 31) - 1500, (1 << 31) - 1, 1 << 31, u32::MAX - 1500, u32::MAX] {
        assert!(trace(start) == expected, "{start}");
    }
}

#[test]
fn a_period_of_nothing_is_refused() {
    let mut client = Asking::new(PACE);
    assert_eq!(client.every(0, heat(3), 0), Err(NotRepeated::Period));
    assert_eq!(client.keep_alive(heat(3), 0, 0), Err(NotRepeated::Period));
    assert_eq!(client.hold(heat(3), 0, repeats, 0), Err(NotHeld::Period));
    assert_eq!(client.step(0), Step::Wait(None));
    let text = "the period is 0 ms, which would fill the bus: it is at least 1 ms";
    assert_eq!([NotRepeated::Period.to_string(), NotHeld::Period.to_string()], [text; 2]);
    let mut full = Client::<Message, 0>::new(PACE);
    assert_eq!(full.every(1000, heat(3), 0), Err(NotRepeated::Full));
    assert_eq!(NotRepeated::Full.to_string(), "there is no room for another request");
}
