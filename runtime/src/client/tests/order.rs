//! Requests that are sent only after others are in effect.
//!
//! The heaters have one message to set. So a read takes the part of the switch-on.

use std::vec::Vec;

use super::{PACE, Polled, frame_sent};
use crate::client::{Client, Heard, NotHeld, Pace, Step, Ticket, repeats};
use crate::sim::Random;
use crate::tests::heaters::{COMMAND, Heat, Message, To, frame};
use crate::{Frame, Request};

pub(super) type Asking = Client<Message, 6, 1>;

pub(super) const REFRESH: u32 = 1000;

pub(super) fn set(power_w: f64) -> Request<Message, Heat> {
    Heat { power_w }.set(To::Heater(3)).expect("a legal request")
}

pub(super) fn on(heater: u8) -> Request<Message, Heat> {
    Heat::ask(To::Heater(heater)).expect("a legal request")
}

pub(super) fn echo(steps: u8) -> Frame {
    frame(0x0107_F003, [2, 0xF0, 0, steps])
}

fn is_on(heater: u8) -> Frame {
    frame(0x010C_F000 | u32::from(heater), [0; 4])
}

/// Holds a set-point, and then a switch-on.
fn held() -> (Asking, [Ticket; 2]) {
    let mut client = Asking::new(PACE);
    let first = client.hold(set(1500.0), REFRESH, repeats, 0).expect("room");
    let second = client.hold_after(first, on(3), |_, _| true, 0).expect("room");
    (client, [first, second])
}

/// Polls until a time, and returns when what was sent.
pub(super) fn sent(client: &mut Asking, times: core::ops::Range<u32>) -> Vec<(u32, Frame)> {
    let mut sent = Vec::new();
    for now in times {
        loop {
            match client.poll(now) {
                Step::Send { frame, .. } => sent.push((now, frame)),
                Step::Wait(_) => break,
                Step::Lost(_)
                | Step::Done(_)
                | Step::Missing { .. }
                | Step::Silent(_)
                | Step::Back(_)
                | Step::ClockBack(_) => {}
            }
        }
    }
    sent
}

fn answers(client: &mut Asking, frame: &Frame, to: Ticket) -> bool {
    matches!(client.hear(frame), Heard::Answer { ticket, .. } if ticket == to)
}

#[test]
fn what_follows_a_set_point_that_rises_slowly_enough_is_sent_after_each_step() {
    let sent_by = |step: u32| {
        let (mut client, [mut first, _]) = held();
        let (mut due, mut count) = (None, 0);
        for now in 0..2000 {
            if now % step == 0 {
                first = client.hold(set(f64::from(10 * (now / step))), REFRESH, repeats, now).expect("it is held");
            }
            if let Some((_, frame)) = due.take_if(|(at, _)| *at == now) {
                let _ = client.handle(&frame, now);
            }
            for (_, frame) in sent(&mut client, now..now + 1) {
                count += u32::from(frame == *on(3).frame());
                let steps = if frame == *on(3).frame() { None } else { Some(frame.bytes()[3]) };
                due = Some((now + 30, steps.map_or(is_on(3), echo)));
            }
        }
        assert!(client.hold(set(0.0), REFRESH, repeats, 2000).is_ok_and(|stop| stop != first));
        count
    };
    // The set-points of 0, 220 and so on to 1760 ms are in effect 30 ms later, and the switch-on is sent then.
    let slow = PACE.between_values();
    assert_eq!(slow, 220);
    assert_eq!(sent_by(slow), 9);
    // No answer counts, since each could be one to the step before.
    assert_eq!(sent_by(PACE.gap), 0);
}

#[test]
fn the_second_is_sent_as_soon_as_the_first_is_in_effect_and_again_after_each_renewal() {
    let (mut client, [first, second]) = held();
    for round in [0, 1000, 2000] {
        assert_eq!(client.step(round), frame_sent(*set(1500.0).frame()));
        assert_eq!(sent(&mut client, round..round + 50), []);
        assert!(answers(&mut client, &echo(150), first));
        assert_eq!(sent(&mut client, round + 50..round + 60), [(round + 50, *on(3).frame())]);
        assert!(answers(&mut client, &is_on(3), second));
        assert_eq!(sent(&mut client, round + 60..round + 1000), []);
    }
}

#[test]
fn the_second_is_not_sent_while_the_first_is_not_in_effect() {
    for wrong in [None, Some(echo(149)), Some(frame(0x0107_F003, [2, 0xF2, 0, 150]))] {
        let (mut client, _) = held();
        for now in 0..5000 {
            if let Step::Send { frame, .. } = client.poll(now) {
                assert_eq!(frame, *set(1500.0).frame());
                assert!(!wrong.is_some_and(|wrong| matches!(client.hear(&wrong), Heard::Answer { .. })));
            }
        }
    }
}

#[test]
fn a_second_that_nobody_answers_is_sent_again_after_the_first_is_in_effect_anew() {
    let (mut client, [first, second]) = held();
    let (set, on) = (frame_sent(*set(1500.0).frame()), frame_sent(*on(3).frame()));
    assert_eq!(client.step(0), set);
    assert!(answers(&mut client, &echo(150), first));
    // No answer to the set-point can come from 200 ms on.
    assert_eq!(
        [20, 120, 199, 200].map(|now| client.step(now)),
        [on, Step::Wait(Some(200)), Step::Wait(Some(200)), set]
    );
    assert_eq!(sent(&mut client, 201..210), []);
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!([220, 320].map(|now| client.step(now)), [on, Step::Lost(second)]);
    // The pace allows two tries. The next renewal is one period after the last round.
    assert_eq!(sent(&mut client, 320..1250), [(1200, *self::set(1500.0).frame())]);
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!(sent(&mut client, 1250..1260), [(1250, *self::on(3).frame())]);
}

#[test]
fn what_a_module_hears_while_it_starts_is_said_again_from_the_first_on() {
    let (mut client, [first, second]) = held();
    let (set, on) = (frame_sent(*set(1500.0).frame()), frame_sent(*on(3).frame()));
    let starts = |client: &mut Asking, frame: &Frame, first| {
        let heard = client.hear(frame);
        matches!(heard, Heard::Starting { ticket, .. } if ticket == first)
    };
    assert_eq!(client.step(0), set);
    assert!(starts(&mut client, &frame(0x1D07_F003, [2, 0xF0, 0, 0]), first));
    assert_eq!([client.step(99), client.step(100)], [Step::Wait(Some(100)), set]);
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!(client.step(120), on);
    assert!(starts(&mut client, &frame(0x1D0C_F003, [0; 4]), second));
    assert_eq!([220, 299, 300].map(|now| client.step(now)), [Step::Wait(Some(300)), Step::Wait(Some(300)), set]);
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!(client.step(320), on);
}

#[test]
fn a_second_that_was_not_sent_when_the_first_is_renewed_waits_for_it_anew() {
    let (mut client, [first, _]) = held();
    assert_eq!(client.step(0), frame_sent(*set(1500.0).frame()));
    // The first is replaced while the second waits for the gap.
    assert!(answers(&mut client, &echo(150), first));
    let new = client.hold(set(500.0), REFRESH, repeats, 10).expect("it takes the room");
    assert_eq!(sent(&mut client, 10..201), [(20, *set(500.0).frame()), (200, *set(500.0).frame())]);
    assert!(answers(&mut client, &echo(50), new));
    assert_eq!(sent(&mut client, 201..300), [(220, *on(3).frame())]);
}

#[test]
fn an_answer_of_the_second_to_the_old_first_is_late() {
    let (mut client, [first, second]) = held();
    let third = client.hold_after(second, on(4), |_, _| true, 0).expect("room");
    assert_eq!(client.step(0), frame_sent(*set(1500.0).frame()));
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!(client.step(20), frame_sent(*on(3).frame()));
    let new = client.hold(set(500.0), REFRESH, repeats, 30).expect("it takes the room");
    assert!(matches!(client.hear(&is_on(3)), Heard::Late { ticket, .. } if ticket == second));
    assert_eq!(sent(&mut client, 30..230), [(40, *set(500.0).frame()), (200, *set(500.0).frame())]);
    assert!(answers(&mut client, &echo(50), new));
    assert_eq!(sent(&mut client, 230..240), [(230, *on(3).frame())]);
    assert!(answers(&mut client, &is_on(3), second));
    assert_eq!(sent(&mut client, 240..260), [(250, *on(4).frame())]);
    assert!(answers(&mut client, &is_on(4), third));
}

#[test]
fn what_follows_ends_with_what_it_follows() {
    let ends: [fn(&mut Asking, Ticket); 2] = [
        |client, first| client.cancel(first),
        |client, _| assert!(client.ask(Heat { power_w: 0.0 }.set(To::All).expect("a legal request"), 0).is_ok()),
    ];
    for end in ends {
        let (mut client, [first, second]) = held();
        client.hold_after(second, on(4), |_, _| true, 0).expect("room");
        end(&mut client, first);
        let frames = sent(&mut client, 0..5000);
        assert!(frames.iter().all(|(_, frame)| [3, 4].iter().all(|heater| frame != on(*heater).frame())));
        assert_eq!(client.hold_after(second, on(5), |_, _| true, 5000), Err(NotHeld::First));
    }
}

#[test]
fn what_is_held_without_an_order_replaces_what_follows_and_is_sent_at_once() {
    let (mut client, [first, _]) = held();
    let other = |power_w| Heat { power_w }.set(To::Heater(4)).expect("a legal request");
    let second = client.hold_after(first, other(500.0), repeats, 0).expect("room");
    let off = client.hold(other(0.0), REFRESH, repeats, 0).expect("it takes the room");
    assert_ne!(off, second);
    assert_eq!(sent(&mut client, 0..50), [(0, *set(1500.0).frame()), (20, *other(0.0).frame())]);
}

#[test]
fn what_is_held_again_keeps_its_order() {
    let (mut client, [first, second]) = held();
    for now in 0..50 {
        assert_eq!(client.hold(on(3), REFRESH, |_, _| true, now), Ok(second));
        assert_eq!(client.hold_after(first, on(3), |_, _| true, now), Ok(second));
    }
    assert_eq!(client.hold(on(3), REFRESH, |_, _| true, 50), Ok(second));
    assert_eq!(sent(&mut client, 50..150), [(50, *set(1500.0).frame())]);
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!(sent(&mut client, 150..200), [(150, *on(3).frame())]);
}

#[test]
fn what_follows_a_group_is_sent_when_all_of_its_members_agree() {
    let mut client = Asking::new(PACE);
    client.members(To::Group(2), [3, 4]).expect("room");
    let group = Heat { power_w: 1500.0 }.set(To::Group(2)).expect("a legal request");
    let first = client.hold(group, REFRESH, repeats, 0).expect("the members are known");
    client.hold_after(first, on(3), |_, _| true, 0).expect("room");
    assert_eq!(sent(&mut client, 0..30), [(0, *group.frame())]);
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!(sent(&mut client, 30..60), []);
    assert!(answers(&mut client, &frame(0x0107_F004, [2, 0xF0, 0, 150]), first));
    assert_eq!(client.step(60), Step::Done(first));
    assert_eq!(client.step(60), frame_sent(*on(3).frame()));
}

#[test]
fn what_follows_goes_before_others_that_wait() {
    let (mut client, [first, _]) = held();
    assert_eq!(client.step(0), frame_sent(*set(1500.0).frame()));
    for heater in [1, 2] {
        client.ask(on(heater), 0).expect("room");
    }
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!([20, 40].map(|now| client.step(now)), [on(3), on(1)].map(|request| frame_sent(*request.frame())));
}

/// Lets a program poll a client, each millisecond or only as [`Step::Wait`] says. Answers come after 5 ms.
fn trace<const N: usize, const G: usize>(
    mut client: Client<Message, N, G>,
    sleeps: bool,
    reply: impl Fn(u32, &Frame) -> Vec<Frame>,
) -> Vec<(u32, Step)> {
    let (mut trace, mut coming, mut wake) = (Vec::new(), Vec::new(), Some(0));
    for now in 0..9000 {
        let mut has_come = false;
        for (_, answer) in coming.extract_if(.., |(time, _)| *time == now) {
            let _ = client.hear(&answer);
            has_come = true;
        }
        if sleeps && !has_come && wake.is_none_or(|wake| wake > now) {
            continue;
        }
        wake = loop {
            match client.step(now) {
                Step::Wait(wake) => break wake,
                step @ (Step::Send { .. }
                | Step::Lost(_)
                | Step::Done(_)
                | Step::Missing { .. }
                | Step::Silent(_)
                | Step::Back(_)
                | Step::ClockBack(_)) => {
                    if let Step::Send { frame, .. } = step {
                        coming.extend(reply(now, &frame).into_iter().map(|answer| (now + 5, answer)));
                    }
                    trace.push((now, step));
                }
            }
        };
    }
    trace
}

/// Holds a set-point of a group, and then what takes the part of its switch-on.
fn held_of_a_group() -> (Asking, [Request<Message, Heat>; 2]) {
    let mut client = Asking::new(PACE);
    client.members(To::Group(2), [3, 4]).expect("room");
    let set = Heat { power_w: 1500.0 }.set(To::Group(2)).expect("a legal request");
    let on = Heat::ask(To::Group(2)).expect("a legal request");
    let first = client.hold(set, REFRESH, repeats, 0).expect("the members are known");
    client.hold_after(first, on, |_, _| true, 0).expect("the members are known");
    (client, [set, on])
}

/// What the heaters of the group answer.
fn members_say(is_set: bool, heaters: &[u8]) -> Vec<Frame> {
    let id = if is_set { 0x0107_F000 } else { 0x010C_F000 };
    let said = |heater: &u8| frame(id | u32::from(*heater), if is_set { [2, 0xF0, 0, 150] } else { [0; 4] });
    heaters.iter().map(said).collect()
}

#[test]
fn one_lost_answer_to_a_second_of_a_group_does_not_keep_the_group_waiting() {
    let (client, [set, on]) = held_of_a_group();
    let steps = trace(client, false, |now, request| {
        let is_set = request == set.frame();
        members_say(is_set, if !is_set && now < 100 { &[3] } else { &[3, 4] })
    });
    let when = |request: &Request<Message, Heat>| -> Vec<u32> {
        let its = steps.iter().filter(|(_, step)| *step == frame_sent(*request.frame()));
        its.map(|(now, _)| *now).take(4).collect()
    };
    // No answer to the set-point can come from 200 ms on, and none to the first switch-on from 220 ms on.
    assert_eq!([when(&set), when(&on)], [[0, 200, 1200, 2200], [20, 220, 1220, 2220]]);
}

#[test]
fn what_was_sent_without_an_order_keeps_no_first_waiting() {
    let (_, [set, on]) = held_of_a_group();
    let mut client = Asking::new(PACE);
    client.members(To::Group(2), [3, 4]).expect("room");
    let second = client.hold(on, REFRESH, |_, _| true, 0).expect("the members are known");
    assert_eq!(client.step(0), frame_sent(*on.frame()));
    client.ask(self::on(1), 90).expect("room");
    assert_eq!(client.step(90), frame_sent(*self::on(1).frame()));
    // It is to be sent again at 100 ms, and waits for the gap.
    assert_eq!(client.step(100), Step::Wait(Some(110)));
    let first = client.hold(set, REFRESH, repeats, 100).expect("the members are known");
    assert_eq!(client.hold_after(first, on, |_, _| true, 100), Ok(second));
    assert_eq!(sent(&mut client, 100..190), [(110, *set.frame())]);
}

#[test]
fn a_program_that_sleeps_until_it_is_to_poll_does_the_same_as_one_that_polls_each_millisecond() {
    let at = |sleeps| {
        (1..=40).map(move |seed| {
            let (single, _) = held();
            let (of_group, _) = held_of_a_group();
            let random = core::cell::RefCell::new(Random::new(seed));
            let lost = |frames: Vec<Frame>| -> Vec<Frame> {
                frames.into_iter().filter(|_| random.borrow_mut().chance(60)).collect()
            };
            let is_set = |request: &Frame| COMMAND.of(request.raw_id()) == 7;
            let alone = trace(single, sleeps, |_, request| lost(members_say(is_set(request), &[3])));
            let group = trace(of_group, sleeps, |_, request| lost(members_say(is_set(request), &[3, 4])));
            (alone, group)
        })
    };
    for (seed, (slept, polled)) in at(true).zip(at(false)).enumerate() {
        assert_eq!(slept, polled, "seed {}", seed + 1);
    }
}

#[test]
fn nothing_follows_what_it_would_replace_or_what_follows_that() {
    let (mut client, [_, second]) = held();
    let third = client.hold_after(second, on(4), |_, _| true, 0).expect("room");
    for last in [second, third] {
        for power_w in [1500.0, 500.0] {
            assert_eq!(client.hold_after(last, set(power_w), repeats, 0), Err(NotHeld::First));
        }
        assert_eq!(client.hold_after(last, on(3), |_, _| true, 0), Err(NotHeld::First));
    }
    assert_eq!(sent(&mut client, 0..2500), [0, 100, 1000, 1100, 2000, 2100].map(|now| (now, *set(1500.0).frame())));
}

#[test]
fn what_stops_a_second_counts_although_its_module_has_been_dead_for_25_days() {
    const HOUR: u32 = 3_600_000;
    let power = |power_w| Heat { power_w }.set(To::Heater(4)).expect("a legal request");
    for is_held in [false, true] {
        let mut client = Asking::new(PACE);
        let first = client.hold(set(1500.0), HOUR, repeats, 0).expect("room");
        client.hold_after(first, power(500.0), repeats, 0).expect("room");
        assert_eq!(client.step(0), frame_sent(*set(1500.0).frame()));
        assert!(answers(&mut client, &echo(150), first));
        let mut now = 20;
        assert_eq!(client.step(now), frame_sent(*power(500.0).frame()));
        while now < 25 * 24 * HOUR {
            let step = client.step(now);
            assert_ne!(step, frame_sent(*power(500.0).frame()));
            if let Step::Wait(wake) = step {
                now = wake.expect("it is renewed");
            }
        }
        let stop = if is_held {
            client.hold(power(0.0), HOUR, repeats, now).expect("it takes the room")
        } else {
            client.ask(power(0.0), now).expect("room")
        };
        client.hurry(stop, now);
        assert_eq!(client.step(now), frame_sent(*power(0.0).frame()));
        assert!(answers(&mut client, &frame(0x0107_F004, [2, 0xF0, 0, 0]), stop));
    }
}

/// Five minutes, in which a program does not call `poll`.
const STALL: u32 = 300_000;

#[test]
fn after_a_stall_a_second_is_not_sent_before_its_first() {
    // The renewal of the first is overdue, or it is long since it was in effect.
    for refresh in [REFRESH, 10 * STALL] {
        let mut client = Asking::new(PACE);
        let first = client.hold(set(1500.0), refresh, repeats, 0).expect("room");
        let second = client.hold_after(first, on(3), |_, _| true, 0).expect("room");
        assert_eq!(client.step(0), frame_sent(*set(1500.0).frame()));
        assert!(answers(&mut client, &echo(150), first));
        assert_eq!(sent(&mut client, STALL..STALL + 50), [(STALL, *set(1500.0).frame())]);
        assert!(answers(&mut client, &echo(150), first));
        assert_eq!(sent(&mut client, STALL + 50..STALL + 60), [(STALL + 50, *on(3).frame())]);
        assert!(answers(&mut client, &is_on(3), second));
        let next = STALL + refresh;
        assert_eq!(sent(&mut client, STALL + 60..next + 1), [(next, *set(1500.0).frame())]);
    }
}

#[test]
fn after_a_stall_all_that_follows_waits_for_the_first_of_an_order() {
    let (mut client, [first, second]) = held();
    let third = client.hold_after(second, on(4), |_, _| true, 0).expect("room");
    assert_eq!(client.step(0), frame_sent(*set(1500.0).frame()));
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!(client.step(20), frame_sent(*on(3).frame()));
    assert!(answers(&mut client, &is_on(3), second));
    assert_eq!(sent(&mut client, STALL..STALL + 20), [(STALL, *set(1500.0).frame())]);
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!(sent(&mut client, STALL + 20..STALL + 40), [(STALL + 20, *on(3).frame())]);
    assert!(answers(&mut client, &is_on(3), second));
    assert_eq!(sent(&mut client, STALL + 40..STALL + 60), [(STALL + 40, *on(4).frame())]);
    assert!(answers(&mut client, &is_on(4), third));
}

#[test]
fn a_second_that_waits_for_answers_to_others_is_sent_as_soon_as_none_can_come() {
    // Something like the second was asked, so it waits until 200 ms: as long as it may.
    let mut client = Asking::new(Pace { gap: 0, ..PACE });
    client.ask(on(3), 0).expect("room");
    assert_eq!(client.step(0), frame_sent(*on(3).frame()));
    assert!(matches!(client.hear(&is_on(3)), Heard::Answer { .. }));
    let first = client.hold(set(1500.0), REFRESH, repeats, 0).expect("room");
    client.hold_after(first, on(3), |_, _| true, 0).expect("room");
    assert_eq!(client.step(0), frame_sent(*set(1500.0).frame()));
    assert!(answers(&mut client, &echo(150), first));
    assert_eq!(sent(&mut client, 1..250), [(200, *on(3).frame())]);
}
