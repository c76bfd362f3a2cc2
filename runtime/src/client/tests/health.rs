//! Modules that are kept alive, that fall silent and that come back.

use super::{Asking, PACE, Polled, answer, frame_sent, heat};
use crate::client::{Client, Heard, Nodes, Pace, Step, repeats};
use crate::tests::heaters::{HEAT, Heat, Message, To, frame};

fn sent(heater: u8) -> Step {
    frame_sent(*heat(heater).frame())
}

#[test]
fn a_module_that_hears_nothing_else_is_kept_alive() {
    let mut client = Asking::new(PACE);
    client.keep_alive(heat(3), 3000, 0).expect("room");
    for round in [0, 3000, 6000] {
        assert_eq!(client.step(round), sent(3));
        assert!(matches!(client.hear(&answer(3)), Heard::Answer { .. }));
        assert_eq!(client.step(round + 2999), Step::Wait(Some(round + 3000)));
    }
}

#[test]
fn an_answered_request_puts_off_what_keeps_a_module_alive_and_a_lost_one_does_not() {
    let sent_at = |is_answered: bool, asked: u8| {
        let mut client = Asking::new(PACE);
        client.keep_alive(heat(3), 3000, 0).expect("room");
        assert_eq!(client.step(0), sent(3));
        assert!(matches!(client.hear(&answer(3)), Heard::Answer { .. }));
        client.ask(heat(asked), 2000).expect("room");
        assert_eq!(client.step(2000), sent(asked));
        if is_answered {
            assert!(matches!(client.hear(&answer(asked)), Heard::Answer { .. }));
        }
        (2001..9000).find(|now| matches!(client.step(*now), Step::Send { .. }) && *now > 2300)
    };
    assert_eq!([sent_at(true, 3), sent_at(false, 3), sent_at(true, 4)], [Some(5000), Some(3000), Some(3000)]);
}

#[test]
fn what_keeps_a_module_alive_waits_for_what_was_answered_just_before() {
    let mut client = Asking::new(PACE);
    let ask = client.ask(heat(3), 0).expect("room");
    client.keep_alive(heat(3), 3000, 5).expect("room");
    assert_eq!(client.step(5), sent(3));
    assert!(matches!(client.hear(&answer(3)), Heard::Answer { ticket, .. } if ticket == ask));
    assert_eq!((6..9000).find(|now| matches!(client.step(*now), Step::Send { .. })), Some(3005));
}

#[test]
fn all_modules_together_are_kept_alive_in_each_period() {
    let mut client = Asking::new(PACE);
    let all = HEAT.set(To::All).expect("a legal request");
    let ticket = client.keep_alive(all, 3000, 0).expect("room");
    client.every(500, heat(3), 0).expect("room");
    let mut rounds = 0;
    for now in 0..9000 {
        let step = client.step(now);
        if step == sent(3) {
            assert!(matches!(client.hear(&answer(3)), Heard::Answer { .. }));
        }
        rounds += u32::from(step == Step::Done(ticket));
    }
    assert_eq!(rounds, 3);
}

#[test]
fn a_module_is_silent_when_a_request_is_lost_and_back_when_it_sends_anything() {
    let mut client = Asking::new(PACE);
    let ticket = client.ask(heat(3), 0).expect("room");
    let steps = [0, 100, 200, 200].map(|now| client.step(now));
    assert_eq!(steps, [sent(3), sent(3), Step::Lost(ticket), Step::Silent(3)]);
    assert_eq!(*client.silent(), Nodes::from([3]));
    // The frame of another module changes nothing.
    assert!(matches!(client.hear(&frame(0x010B_F004, [0; 4])), Heard::Other(_)));
    assert_eq!(client.step(201), Step::Wait(Some(300)));
    assert!(matches!(client.hear(&frame(0x0107_F003, [2, 0xF0, 0, 0])), Heard::Late { .. }));
    assert_eq!([client.step(202), client.step(202)], [Step::Back(3), Step::Wait(Some(300))]);
    assert!(client.silent().is_empty());
}

#[test]
fn a_module_that_says_something_else_is_not_silent() {
    let mut client = Asking::new(PACE);
    let ticket = client.hold(heat(3), 1000, |_, _| false, 0).expect("room");
    for now in [0, 100] {
        assert_eq!(client.step(now), sent(3));
        assert!(matches!(client.hear(&answer(3)), Heard::NotInEffect { .. }));
    }
    assert_eq!([client.step(200), client.step(200)], [Step::Lost(ticket), Step::Wait(Some(300))]);
}

#[test]
fn a_module_that_answers_the_first_of_an_order_and_not_the_second_is_not_silent() {
    let mut client = Asking::new(PACE);
    let first = client.hold(heat(3), 1000, repeats, 0).expect("room");
    let on = Heat::ask(To::Heater(3)).expect("a legal request");
    let second = client.hold_after(first, on, |_, _| true, 0).expect("room");
    for (round, now) in [(0, 20), (200, 220)] {
        assert_eq!(client.step(round), sent(3));
        assert!(matches!(client.hear(&answer(3)), Heard::Answer { .. }));
        assert_eq!(client.step(now), frame_sent(*on.frame()));
        let end = client.step(now + 100);
        assert_eq!(end == Step::Lost(second), round == 200);
    }
    assert!(matches!(client.step(320), Step::Wait(_)));
}

#[test]
fn a_program_is_to_poll_when_what_keeps_a_module_alive_goes_before_others() {
    let mut client: Client<Message, 4, 1> = Client::new(Pace { gap: 50, wait: 100, tries: 3, late: 200 });
    client.members(To::Group(2), [4, 5]).expect("room");
    let [single, group, alive] =
        [To::Heater(5), To::Group(2), To::Heater(4)].map(|target| Heat::ask(target).expect("a legal request"));
    client.ask(single, 0).expect("room");
    assert_eq!(client.step(0), frame_sent(*single.frame()));
    assert!(matches!(client.hear(&frame(0x010C_F005, [0; 4])), Heard::Answer { .. }));
    // The group waits until 300 ms, when nothing can still answer what heater 5 was asked.
    client.ask(group, 5).expect("room");
    client.keep_alive(alive, 5000, 60).expect("room");
    assert_eq!([client.step(60), client.step(109)], [Step::Wait(Some(110)); 2]);
    assert_eq!(client.step(110), frame_sent(*alive.frame()));
}
