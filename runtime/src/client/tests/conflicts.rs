//! Requests that contradict what is held, or stand in the way of others.

use std::ops::Range;
use std::vec;
use std::vec::Vec;

use embedded_can::Frame as _;

use super::{PACE, Polled, frame_sent};
use crate::client::{Client, Full, Heard, Nodes, NotHeld, Pace, Step, Ticket, repeats};
use crate::plumbing::Who;
use crate::tests::heaters::{COMMAND, FRAME, FUNCTION, Heat, Message, To, frame};
use crate::{Access, Exchange, Frame, Request, Route};

type Asking = Client<Message, 6, 2>;

const REFRESH: u32 = 1000;
const GROUP: To = To::Group(2);

/// Sets a power, and one module answers for a group, under the number of the group.
static SET_BY_ONE: Exchange = Access::new("set by one", &[Some(Who::One), Some(Who::Coordinator), None])
    .with_values()
    .request(&FRAME.selectors(&[FUNCTION]).data(FUNCTION.place, 1))
    .reply(&FRAME.selectors(&[FUNCTION]).data(FUNCTION.place, 2))
    .of("heat")
    .id(COMMAND, 7)
    .length(4);

fn power(route: impl Into<Route<To>>, power_w: f64) -> Request<Message, Heat> {
    Heat { power_w }.set(route).expect("a legal request")
}

fn power_by_one(target: To, power_w: f64) -> Request<Message, Heat> {
    SET_BY_ONE.request_to(target, &Heat { power_w }).expect("a legal request")
}

fn read(target: To) -> Request<Message, Heat> {
    Heat::ask(target).expect("a legal request")
}

fn sent(request: &Request<Message, Heat>) -> Step {
    frame_sent(*request.frame())
}

fn echo(heater: u8, steps: u8) -> Frame {
    frame(0x0107_F000 | u32::from(heater), [2, 0xF0, 0, steps])
}

fn said(heater: u8) -> Frame {
    frame(0x010C_F000 | u32::from(heater), [0; 4])
}

fn is_read(request: &Frame) -> bool {
    COMMAND.of(request.raw_id()) == 0x0C
}

/// What heaters answer to a request, of those that are on the bus.
fn answers(request: &Frame, heaters: &[u8]) -> Vec<Frame> {
    let answer = |heater: &u8| if is_read(request) { said(*heater) } else { echo(*heater, request.data()[3]) };
    heaters.iter().map(answer).collect()
}

fn asking() -> Asking {
    let mut client = Asking::new(PACE);
    client.members(GROUP, [4, 5]).expect("room");
    client
}

fn hold<const N: usize, const G: usize>(
    client: &mut Client<Message, N, G>,
    request: Request<Message, Heat>,
    now: u32,
) -> Result<Ticket, NotHeld> {
    client.hold(request, REFRESH, repeats, now)
}

/// Polls each millisecond, and gives the answers to what is sent. Returns the other steps, and when they came.
fn run<const N: usize, const G: usize>(
    client: &mut Client<Message, N, G>,
    time: Range<u32>,
    reply: impl Fn(&Frame) -> Vec<Frame>,
) -> Vec<(u32, Step)> {
    let mut steps = Vec::new();
    for now in time {
        loop {
            let step = client.step(now);
            match step {
                Step::Wait(_) => break,
                Step::Send { frame, .. } => reply(&frame).iter().for_each(|answer| {
                    let _ = client.hear(answer);
                }),
                Step::Done(_)
                | Step::Lost(_)
                | Step::Missing { .. }
                | Step::Silent(_)
                | Step::Back(_)
                | Step::ClockBack(_) => {}
            }
            steps.push((now, step));
        }
    }
    steps
}

fn when(steps: &[(u32, Step)], step: Step) -> Vec<u32> {
    steps.iter().filter(|(_, other)| *other == step).map(|(now, _)| *now).collect()
}

#[test]
fn a_group_that_one_module_answers_for_replaces_what_is_held_of_its_members() {
    let mut client = asking();
    let old = hold(&mut client, power_by_one(To::Heater(4), 500.0), 0).expect("room");
    hold(&mut client, power_by_one(To::Heater(7), 100.0), 0).expect("room");
    assert_eq!(client.step(0), sent(&power_by_one(To::Heater(4), 500.0)));
    let off = power_by_one(GROUP, 0.0);
    let stop = hold(&mut client, off, 1).expect("room");
    // The group answers under another number, so an echo of heater 4 is still known as late.
    assert!(matches!(client.hear(&echo(4, 50)), Heard::Late { ticket, .. } if ticket == old));
    let steps = run(&mut client, 1..5000, |_| vec![]);
    assert_eq!(when(&steps, sent(&power_by_one(To::Heater(4), 500.0))), []);
    assert_eq!(when(&steps, sent(&off)).len(), 10);
    assert_eq!(when(&steps, sent(&power_by_one(To::Heater(7), 100.0))).len(), 10);
    let torn = hold(&mut client, power_by_one(To::Heater(4), 500.0), 5000);
    assert_eq!(torn, Err(NotHeld::Torn(stop)));
}

#[test]
fn to_replace_what_is_held_of_a_member_needs_no_room_although_it_still_waits() {
    let mut client: Client<Message, 1, 1> = Client::new(PACE);
    client.members(GROUP, [4]).expect("room");
    hold(&mut client, power_by_one(To::Heater(4), 500.0), 0).expect("room");
    assert!(matches!(client.step(0), Step::Send { .. }));
    assert!(hold(&mut client, power_by_one(GROUP, 0.0), 1).is_ok());
    assert_eq!(client.step(20), sent(&power_by_one(GROUP, 0.0)));
}

#[test]
fn what_another_own_address_holds_is_replaced_too() {
    let mut client = asking();
    hold(&mut client, power(To::Heater(3), 1500.0), 0).expect("room");
    let off = power(Route::new(To::Heater(3), 0xF1), 0.0);
    hold(&mut client, off, 1).expect("room");
    let steps = run(&mut client, 1..2500, |_| vec![]);
    assert_eq!(when(&steps, sent(&power(To::Heater(3), 1500.0))), []);
    assert_eq!(when(&steps, sent(&off)), [1, 101, 1001, 1101, 2001, 2101]);
}

#[test]
fn nothing_else_is_held_of_modules_that_may_be_the_same() {
    let mut client = Asking::new(PACE);
    let held = hold(&mut client, power_by_one(To::Heater(4), 500.0), 0).expect("room");
    let group = power_by_one(GROUP, 0.0);
    assert_eq!(hold(&mut client, group, 1), Err(NotHeld::Torn(held)));
    client.cancel(held);
    let held = hold(&mut client, group, 1).expect("room");
    assert_eq!(hold(&mut client, power_by_one(To::Group(3), 100.0), 1), Err(NotHeld::Torn(held)));
}

#[test]
fn what_replaces_a_held_group_is_sent_although_a_read_of_the_group_is_due_again() {
    let mut client = asking();
    hold(&mut client, power(GROUP, 1500.0), 0).expect("room");
    client.every(500, read(GROUP), 0).expect("room");
    // Heater 5 does not answer reads.
    let reply = |request: &Frame| answers(request, if is_read(request) { &[4] } else { &[4, 5] });
    let _ = run(&mut client, 0..110, reply);
    let stop = hold(&mut client, power(GROUP, 0.0), 110).expect("room");
    client.hurry(stop, 110);
    let steps = run(&mut client, 110..5000, reply);
    // The read is under way until 220 ms.
    assert_eq!(when(&steps, sent(&power(GROUP, 0.0))).first(), Some(&220));
    assert!(when(&steps, Step::Done(stop)).len() >= 4);
    assert!(when(&steps, sent(&read(GROUP))).len() >= 8);
}

#[test]
fn what_replaces_a_held_group_is_sent_after_a_read_of_the_group_is_lost() {
    let mut client = asking();
    hold(&mut client, power(GROUP, 1500.0), 0).expect("room");
    client.ask(read(GROUP), 0).expect("room");
    let _ = run(&mut client, 0..30, |request| answers(request, if is_read(request) { &[4] } else { &[4, 5] }));
    let stop = hold(&mut client, power(GROUP, 0.0), 30).expect("room");
    let steps = run(&mut client, 30..1000, |request| answers(request, if is_read(request) { &[] } else { &[4, 5] }));
    assert!(when(&steps, sent(&power(GROUP, 0.0))).first().is_some_and(|now| *now <= 240));
    assert!(!when(&steps, Step::Done(stop)).is_empty());
}

#[test]
fn a_client_waits_no_longer_than_until_what_is_held_listens() {
    let mut client = Asking::new(PACE);
    client.members(GROUP, [4]).expect("room");
    for (power_w, now) in [(500.0, 0), (0.0, 20)] {
        hold(&mut client, power(To::Heater(1), power_w), now).expect("room");
        hold(&mut client, power(GROUP, power_w), now).expect("room");
        if power_w > 0.0 {
            assert!(matches!((client.step(0), client.step(20)), (Step::Send { .. }, Step::Send { .. })));
        }
    }
    client.members(GROUP, [1, 4]).expect("room");
    assert_eq!(client.step(40), Step::Wait(Some(200)));
}

/// Holds heater 4, asks five others, and stops a group of heater 4. From then on, nobody answers.
fn stopped_while_others_wait() -> (Client<Message, 12, 1>, Ticket) {
    let mut client = Client::new(Pace { gap: 50, wait: 100, tries: 3, late: 50 });
    client.members(GROUP, [4, 5]).expect("room");
    client.ask(read(GROUP), 0).expect("room");
    let _ = run(&mut client, 0..400, |request| answers(request, &[4, 5]));
    hold(&mut client, power(To::Heater(4), 1500.0), 400).expect("room");
    assert_eq!(client.step(400), sent(&power(To::Heater(4), 1500.0)));
    for heater in [1, 2, 3, 6, 7] {
        client.ask(read(To::Heater(heater)), 401).expect("room");
    }
    let stop = hold(&mut client, power(GROUP, 0.0), 410).expect("room");
    (client, stop)
}

#[test]
fn a_stop_of_a_group_is_not_done_because_of_older_answers() {
    let (mut client, stop) = stopped_while_others_wait();
    let steps = run(&mut client, 410..1405, |_| vec![]);
    assert_eq!(when(&steps, Step::Done(stop)), []);
    assert_eq!(when(&steps, Step::Missing { ticket: stop, nodes: [4, 5].into() }).len(), 1);
}

#[test]
fn a_new_value_is_sent_as_often_as_the_pace_says() {
    let (mut client, _) = stopped_while_others_wait();
    let steps = run(&mut client, 410..1405, |_| vec![]);
    assert_eq!(when(&steps, sent(&power(GROUP, 0.0))).len(), 3);
}

#[test]
fn a_request_ends_what_is_held_that_it_contradicts() {
    let mut client = asking();
    hold(&mut client, power(To::Heater(3), 1500.0), 0).expect("room");
    hold(&mut client, power(GROUP, 1500.0), 0).expect("room");
    let _ = run(&mut client, 0..300, |request| answers(request, &[3, 4, 5]));
    let off = client.ask(power(To::All, 0.0), 300).expect("room");
    let steps = run(&mut client, 300..5000, |request| answers(request, &[3, 4, 5]));
    assert_eq!(steps, [(300, sent(&power(To::All, 0.0))), (300, Step::Done(off))]);
}

#[test]
fn what_is_asked_again_and_again_ends_what_is_held_that_it_contradicts() {
    let mut client = asking();
    hold(&mut client, power(To::Heater(3), 1500.0), 0).expect("room");
    client.every(500, power(To::Heater(3), 0.0), 1).expect("room");
    let steps = run(&mut client, 1..3000, |request| answers(request, &[3]));
    assert_eq!(when(&steps, sent(&power(To::Heater(3), 1500.0))), []);
    assert_eq!(when(&steps, sent(&power(To::Heater(3), 0.0))).len(), 6);
}

#[test]
fn a_request_ends_nothing_that_it_does_not_contradict() {
    let mut client: Client<Message, 3> = Client::new(PACE);
    let on = power(To::Heater(3), 1500.0);
    hold(&mut client, on, 0).expect("room");
    client.ask(read(To::Heater(3)), 1).expect("room");
    client.ask(power(To::Heater(4), 0.0), 1).expect("room");
    // There is no room for it.
    assert_eq!(client.ask(power(To::All, 0.0), 1), Err(Full));
    let steps = run(&mut client, 1..2500, |request| answers(request, &[3, 4]));
    assert_eq!(when(&steps, sent(&on)), [1, 1000, 2000]);
}

#[test]
fn a_ramp_does_not_keep_a_request_like_it_waiting() {
    let mut client = asking();
    let ramp = |client: &mut Asking, now: u32| {
        hold(client, power(To::Heater(3), f64::from(now)), now).expect("room");
        run(client, now..now + 50, |request| answers(request, &[3]))
    };
    let _ = ramp(&mut client, 50);
    // Its answers look the same, and another access sets the value.
    let off = power_by_one(To::Heater(3), 0.0);
    let ticket = client.ask(off, 99).expect("room");
    client.hurry(ticket, 99);
    let steps: Vec<_> = (2..30).flat_map(|step| ramp(&mut client, 50 * step)).collect();
    // An answer to the value of 50 ms can come until 250 ms.
    assert_eq!(when(&steps, sent(&off)), [250]);
    let last = steps.iter().rfind(|(_, step)| matches!(step, Step::Send { .. }));
    assert!(last.is_some_and(|(now, _)| *now >= 1400));
}

#[test]
fn what_is_held_and_not_sent_takes_no_answer_to_another_request() {
    let mut client: Client<Message, 12, 1> = Client::new(Pace { gap: 50, wait: 100, tries: 2, late: 50 });
    client.members(GROUP, [3, 4]).expect("room");
    for heater in [1, 2, 6] {
        client.ask(read(To::Heater(heater)), 0).expect("room");
    }
    let asked = client.ask(power(GROUP, 300.0), 5).expect("room");
    hold(&mut client, power(To::Heater(3), 0.0), 10).expect("room");
    for now in [10, 60, 110] {
        assert!(matches!(client.step(now), Step::Send { .. }));
    }
    assert_eq!(client.step(160), sent(&power(GROUP, 300.0)));
    assert!(matches!(client.hear(&echo(3, 30)), Heard::Answer { ticket, .. } if ticket == asked));
}

#[test]
fn a_stop_that_is_held_is_sent_at_once_and_no_switch_on_that_was_asked_comes_after_it() {
    let (on, off) = (power(To::Heater(4), 1500.0), power(To::Heater(4), 0.0));
    for target in [To::Heater(4), GROUP] {
        // The switch-on waits to be sent, waits for its answer, or has had it.
        for (stopped, is_sent) in [(0, false), (30, true), (90, true)] {
            let mut client = asking();
            client.ask(read(To::Heater(1)), 0).expect("room");
            client.ask(on, 0).expect("room");
            let steps =
                run(&mut client, 0..stopped, |request| answers(request, if stopped == 90 { &[4] } else { &[] }));
            assert_eq!(when(&steps, sent(&on)).len(), usize::from(is_sent));
            let off = if target == GROUP { power(GROUP, 0.0) } else { off };
            let stop = hold(&mut client, off, stopped).expect("room");
            client.hurry(stop, stopped);
            let steps = run(&mut client, stopped..3000, |request| answers(request, &[4, 5]));
            let expected = if stopped == 30 { 40 } else { stopped };
            assert_eq!(when(&steps, sent(&off)).first(), Some(&expected), "{target:?} at {stopped} ms");
            assert_eq!(when(&steps, sent(&on)), []);
        }
    }
}

#[test]
fn what_is_asked_again_and_again_ends_when_something_else_is_held() {
    let mut client = asking();
    client.every(500, power(To::Heater(3), 1500.0), 0).expect("room");
    let _ = run(&mut client, 0..1200, |request| answers(request, &[3]));
    hold(&mut client, power(To::Heater(3), 0.0), 1200).expect("room");
    let steps = run(&mut client, 1200..4000, |request| answers(request, &[3]));
    assert_eq!(when(&steps, sent(&power(To::Heater(3), 1500.0))), []);
}

#[test]
fn a_hurried_stop_of_all_ends_what_was_asked_before_and_is_not_sent() {
    let mut client = asking();
    client.ask(read(To::Heater(1)), 0).expect("room");
    let (on, off) = (power(GROUP, 1500.0), power(GROUP, 0.0));
    client.ask(on, 0).expect("room");
    client.ask(power(To::Heater(4), 1500.0), 0).expect("room");
    let others = power(To::Heater(3), 500.0);
    client.ask(others, 0).expect("room");
    let stop = client.ask(off, 1).expect("room");
    client.hurry(stop, 1);
    let steps = run(&mut client, 1..3000, |request| answers(request, &[1, 3, 4, 5]));
    assert_eq!(when(&steps, sent(&off)), [1]);
    assert_eq!([on, power(To::Heater(4), 1500.0)].map(|on| when(&steps, sent(&on)).len()), [0, 0]);
    assert_eq!(when(&steps, sent(&others)).len(), 1);
}

#[test]
fn a_hurried_stop_is_not_undone_by_a_switch_on_that_was_asked_before() {
    // The stop covers the switch-on, perhaps covers it, or perhaps is covered by it.
    let targets =
        [(To::Heater(4), GROUP), (To::Heater(4), To::Group(3)), (To::Heater(4), To::All), (GROUP, To::Heater(4))];
    for (of_on, of_off) in targets {
        for stopped in [0, 50] {
            let mut client = asking();
            let (on, off) = (power(of_on, 1500.0), power(of_off, 0.0));
            client.ask(on, 0).expect("room");
            let before = run(&mut client, 0..stopped, |_| vec![]);
            assert_eq!(when(&before, sent(&on)).len(), usize::from(stopped > 0));
            let stop = client.ask(off, stopped).expect("room");
            client.hurry(stop, stopped);
            let steps = run(&mut client, stopped..3000, |request| answers(request, &[4, 5]));
            assert_eq!(when(&steps, sent(&on)), [], "{of_on:?}, {of_off:?} at {stopped} ms");
            assert_eq!(when(&steps, sent(&off)).len(), 1);
        }
    }
}

#[test]
fn a_hurried_stop_ends_nothing_of_other_modules_and_no_other_message() {
    let mut client = asking();
    let others = [power(To::Heater(3), 500.0), read(To::Heater(4)), power(To::Heater(5), 0.0)];
    for other in others {
        client.ask(other, 0).expect("room");
    }
    let stop = client.ask(power(GROUP, 0.0), 0).expect("room");
    client.hurry(stop, 0);
    let steps = run(&mut client, 0..3000, |request| answers(request, &[3, 4, 5]));
    assert_eq!(others.map(|other| when(&steps, sent(&other)).len()), [1; 3]);
}

#[test]
fn to_hurry_a_request_does_not_let_its_late_answers_be_taken_for_others() {
    let mut client = asking();
    let first = client.ask(power(To::Heater(3), 1500.0), 0).expect("room");
    assert!(matches!(client.step(0), Step::Send { .. }));
    client.ask(power(To::Heater(1), 100.0), 95).expect("room");
    assert!(matches!(client.step(95), Step::Send { .. }));
    // It is to be sent again at 100 ms, and waits for the gap.
    assert_eq!(client.step(100), Step::Wait(Some(115)));
    client.hurry(first, 101);
    client.cancel(first);
    client.ask(power(To::Heater(3), 0.0), 102).expect("room");
    assert!(matches!(client.step(115), Step::Wait(_)));
    assert!(matches!(client.hear(&echo(3, 150)), Heard::Late { ticket, .. } if ticket == first));
}

#[test]
fn a_module_that_answers_other_requests_is_not_silent() {
    let mut client = asking();
    client.every(50, read(To::Heater(3)), 0).expect("room");
    let held = hold(&mut client, power(To::Heater(3), 1500.0), 0).expect("room");
    let steps = run(&mut client, 0..700, |request| answers(request, if is_read(request) { &[3] } else { &[] }));
    assert!(!when(&steps, Step::Lost(held)).is_empty());
    assert_eq!(when(&steps, Step::Silent(3)), []);
    assert_eq!(*client.silent(), Nodes::NONE);
}

#[test]
fn a_module_is_kept_alive_although_others_fill_the_bus() {
    let mut client: Client<Message, 32> = Client::new(Pace { gap: 200, wait: 300, tries: 3, late: 100 });
    let alive = read(To::Heater(3));
    client.keep_alive(alive, 1600, 0).expect("room");
    for heater in [1, 2, 4, 5, 6, 7, 8, 9] {
        client.every(1000, read(To::Heater(heater)), 1).expect("room");
        hold(&mut client, power(To::Heater(heater), 100.0), 1).expect("room");
    }
    let steps = run(&mut client, 0..60_000, |request| if *request == *alive.frame() { vec![said(3)] } else { vec![] });
    let times = when(&steps, sent(&alive));
    let longest = times.windows(2).map(|pair| pair[1] - pair[0]).max();
    assert!(longest.is_some_and(|longest| longest <= 1600 + 2 * 200), "{longest:?}");
}

#[test]
fn what_says_the_same_is_no_contradiction() {
    let mut client = asking();
    let off = power(To::Heater(4), 0.0);
    client.every(REFRESH, power(GROUP, 0.0), 0).expect("room");
    hold(&mut client, off, 1).expect("room");
    client.ask(power(To::All, 0.0), 2).expect("room");
    let steps = run(&mut client, 2..3500, |request| answers(request, &[4, 5]));
    assert_eq!([off, power(GROUP, 0.0)].map(|request| when(&steps, sent(&request)).len()), [4, 4]);
}
