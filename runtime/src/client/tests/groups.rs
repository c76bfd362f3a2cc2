//! Requests to groups whose members the client knows.

use super::{PACE, Polled, answer, frame_sent};
use crate::client::{Client, Heard, NoMembers, Nodes, NotHeld, Step, Ticket, repeats};
use crate::tests::heaters::{Heat, Message, To, frame};
use crate::{Error, Frame, Request};

type Asking = Client<Message, 4, 2>;

const REFRESH: u32 = 1000;
const GROUP: To = To::Group(2);

fn power(target: To, power_w: f64) -> Request<Message, Heat> {
    Heat { power_w }.set(target).expect("a legal request")
}

/// The echo of 1500 W.
fn group() -> Request<Message, Heat> {
    power(To::Group(2), 1500.0)
}

fn echo(heater: u8, steps: u8) -> Frame {
    frame(0x0107_F000 | u32::from(heater), [2, 0xF0, 0, steps])
}

fn asking(members: &[u8]) -> Asking {
    let mut client = Asking::new(PACE);
    client.members(To::Group(2), members.iter().copied().collect::<Nodes>()).expect("room");
    client
}

fn hold(client: &mut Asking, target: To, power_w: f64, now: u32) -> Result<Ticket, NotHeld> {
    client.hold(power(target, power_w), REFRESH, repeats, now)
}

/// Asks heaters 1 and 4 as a group, and sends the request.
fn asked() -> (Asking, Ticket) {
    let mut client = asking(&[1, 4]);
    let ticket = client.ask(group(), 0).expect("room");
    assert_eq!(client.step(0), frame_sent(*group().frame()));
    (client, ticket)
}

fn is_answer(heard: &Heard<Message>, to: Ticket) -> bool {
    matches!(heard, Heard::Answer { ticket, .. } if *ticket == to)
}

fn is_twice(heard: &Heard<Message>) -> bool {
    matches!(heard, Heard::Twice { .. })
}

#[test]
fn a_group_is_done_as_soon_as_all_members_have_answered() {
    let (mut client, ticket) = asked();
    assert!(is_answer(&client.hear(&answer(4)), ticket));
    assert_eq!(client.step(10), Step::Wait(Some(100)));
    assert!(is_twice(&client.hear(&answer(4))));
    // Heater 7 is no member.
    assert!(matches!(client.hear(&answer(7)), Heard::Other(_)));
    assert_eq!(client.step(20), Step::Wait(Some(100)));
    assert!(is_answer(&client.hear(&answer(1)), ticket));
    assert_eq!([client.step(21), client.step(21)], [Step::Done(ticket), Step::Wait(Some(200))]);
}

#[test]
fn a_refusal_of_a_member_is_an_answer() {
    let (mut client, ticket) = asked();
    assert!(is_answer(&client.hear(&answer(4)), ticket));
    let refused = frame(0x0107_F001, [2, 0xF2, 0, 150]);
    assert!(matches!(client.hear(&refused), Heard::Refusal { ticket: of, .. } if of == ticket));
    assert_eq!(client.step(1), Step::Done(ticket));
}

#[test]
fn a_member_that_starts_is_missing_and_not_silent() {
    let (mut client, ticket) = asked();
    assert!(is_answer(&client.hear(&answer(4)), ticket));
    let starts = frame(0x1D07_F001, [2, 0xF0, 0, 0]);
    assert!(matches!(client.hear(&starts), Heard::Starting { ticket: of, .. } if of == ticket));
    assert_eq!(client.step(100), frame_sent(*group().frame()));
    let missing = Step::Missing { ticket, nodes: [1].into() };
    assert_eq!([client.step(200), client.step(200)], [missing, Step::Wait(Some(300))]);
}

#[test]
fn a_group_is_asked_again_while_members_are_missing_and_says_which() {
    let (mut client, ticket) = asked();
    assert!(is_answer(&client.hear(&answer(4)), ticket));
    assert_eq!(client.step(100), frame_sent(*group().frame()));
    assert!(is_twice(&client.hear(&answer(4))));
    assert_eq!(
        [client.step(199), client.step(200)],
        [Step::Wait(Some(200)), Step::Missing { ticket, nodes: [1].into() }]
    );
    assert_eq!([client.step(200), client.step(200)], [Step::Silent(1), Step::Wait(Some(300))]);
    assert!(matches!(client.hear(&answer(1)), Heard::Late { .. }));
    assert_eq!(client.step(201), Step::Back(1));
}

#[test]
fn a_member_that_answers_while_the_request_waits_to_be_sent_again_counts() {
    let (mut client, ticket) = asked();
    let all = client.ask(power(To::All, 0.0), 90).expect("room");
    assert_eq!([client.step(90), client.step(90)], [frame_sent(*power(To::All, 0.0).frame()), Step::Done(all)]);
    assert_eq!(client.step(100), Step::Wait(Some(110)));
    assert!(is_answer(&client.hear(&answer(4)), ticket));
    assert_eq!(client.step(109), Step::Wait(Some(110)));
    assert!(is_answer(&client.hear(&answer(1)), ticket));
    assert_eq!(client.step(110), Step::Done(ticket));
}

#[test]
fn each_round_waits_for_all_members_anew() {
    let mut client = asking(&[1, 4]);
    let ticket = client.every(300, group(), 0).expect("room");
    for round in [0, 300, 600] {
        assert_eq!(client.step(round), frame_sent(*group().frame()));
        assert!(is_answer(&client.hear(&answer(1)), ticket));
        assert_eq!(client.step(round), Step::Wait(Some(round + 100)));
        assert!(is_answer(&client.hear(&answer(4)), ticket));
        assert_eq!(client.step(round), Step::Done(ticket));
    }
}

#[test]
fn a_held_group_is_in_effect_when_all_members_agree() {
    let mut client = asking(&[1, 4]);
    let ticket = hold(&mut client, To::Group(2), 0.0, 0).expect("the members are known");
    let off = frame_sent(*power(To::Group(2), 0.0).frame());
    assert_eq!(client.step(0), off);
    assert!(is_answer(&client.hear(&echo(1, 0)), ticket));
    let refused = frame(0x0107_F004, [2, 0xF2, 0, 0]);
    assert!(matches!(client.hear(&refused), Heard::Refusal { .. }));
    assert_eq!(client.step(100), off);
    // One that agreed says something else now.
    assert!(matches!(client.hear(&echo(1, 50)), Heard::NotInEffect { .. }));
    assert!(is_answer(&client.hear(&echo(4, 0)), ticket));
    assert_eq!(client.step(200), Step::Missing { ticket, nodes: [1].into() });
    // It is not silent.
    assert_eq!(client.step(200), Step::Wait(Some(300)));
    assert_eq!([client.step(999), client.step(1000)], [Step::Wait(Some(1000)), off]);
    assert!(is_answer(&client.hear(&echo(1, 0)), ticket) && is_answer(&client.hear(&echo(4, 0)), ticket));
    assert_eq!(client.step(1000), Step::Done(ticket));
}

#[test]
fn a_stop_of_a_group_replaces_what_is_held_of_its_members_only() {
    let mut client = asking(&[1, 4]);
    for heater in [1, 4, 5] {
        hold(&mut client, To::Heater(heater), 500.0, 0).expect("room");
    }
    let steps = [0, 20, 40].map(|now| client.step(now));
    assert_eq!(steps, [1, 4, 5].map(|heater| frame_sent(*power(To::Heater(heater), 500.0).frame())));
    for heater in [1, 4, 5] {
        assert!(matches!(client.hear(&echo(heater, 50)), Heard::Answer { .. }));
    }
    let stop = hold(&mut client, To::Group(2), 0.0, 500).expect("it takes the room of its members");
    let mut sent = std::vec::Vec::new();
    for now in 500..3000 {
        if let Step::Send { frame, .. } = client.step(now) {
            sent.push(frame);
            for heater in if frame == *power(To::Group(2), 0.0).frame() { [1, 4] } else { [5; 2] } {
                assert!(!matches!(
                    client.hear(&echo(heater, if heater == 5 { 50 } else { 0 })),
                    Heard::NotInEffect { .. }
                ));
            }
        }
    }
    assert!(
        sent.iter()
            .all(|frame| [*power(To::Group(2), 0.0).frame(), *power(To::Heater(5), 500.0).frame()].contains(frame))
    );
    assert_eq!((sent.len(), hold(&mut client, To::Group(2), 0.0, 3000)), (5, Ok(stop)));
}

#[test]
fn no_member_is_held_otherwise_than_its_group() {
    let mut client = asking(&[1, 4]);
    client.members(To::Group(3), [4, 5]).expect("room");
    let stop = hold(&mut client, To::Group(2), 0.0, 0).expect("the members are known");
    assert_eq!(hold(&mut client, To::Heater(4), 500.0, 1), Err(NotHeld::Torn(stop)));
    assert_eq!(hold(&mut client, To::Group(3), 500.0, 1), Err(NotHeld::Torn(stop)));
    assert!(hold(&mut client, To::Heater(5), 500.0, 1).is_ok());
    client.cancel(stop);
    assert!(hold(&mut client, To::Heater(4), 500.0, 1).is_ok());
}

#[test]
fn an_answer_of_a_member_does_not_count_while_it_could_be_one_to_what_the_group_replaced() {
    let mut client = asking(&[1]);
    hold(&mut client, To::Heater(1), 0.0, 0).expect("room");
    assert!(matches!(client.step(0), Step::Send { .. }));
    let stop = hold(&mut client, To::Group(2), 0.0, 5).expect("room");
    let off = frame_sent(*power(To::Group(2), 0.0).frame());
    assert_eq!(client.step(20), off);
    assert!(matches!(client.hear(&echo(1, 0)), Heard::Late { ticket, .. } if ticket == stop));
    assert_eq!([client.step(199), client.step(200)], [Step::Wait(Some(200)), off]);
    assert!(is_answer(&client.hear(&echo(1, 0)), stop));
    assert_eq!(client.step(201), Step::Done(stop));
}

#[test]
fn there_is_room_for_some_targets_that_the_document_names() {
    let mut client = asking(&[1]);
    assert_eq!(client.members(To::Group(3), [2]), Ok(()));
    assert_eq!(client.members(To::Group(4), [3]), Err(NoMembers::Full));
    assert_eq!(client.members(To::Group(2), Nodes::NONE), Ok(()));
    assert_eq!(client.members(To::Group(4), [3]), Ok(()));
    assert!(matches!(client.members(To::Group(16), [3]), Err(NoMembers::Target(Error::Address { .. }))));
    assert_eq!(hold(&mut client, To::Group(2), 0.0, 0), Err(NotHeld::Unconfirmed));
}

#[test]
fn a_group_is_asked_although_its_members_are_asked_all_the_time() {
    let mut client = asking(&[1, 4]);
    let sent = (0..1000).find(|now| {
        match now {
            0 => assert!(client.every(300, power(To::Heater(1), 100.0), 0).is_ok()),
            10 => assert!(client.ask(group(), 10).is_ok()),
            150 => assert!(client.every(300, power(To::Heater(4), 100.0), 150).is_ok()),
            _ => {}
        }
        client.step(*now) == frame_sent(*group().frame())
    });
    // Heater 1 is sent at 0, its answer can come until 300 ms. Heater 4 is due at 150 and waits.
    assert_eq!(sent, Some(300));
}

#[test]
fn other_modules_are_asked_while_a_group_answers() {
    let (mut client, ticket) = asked();
    let other = client.ask(power(To::Heater(7), 1500.0), 1).expect("room");
    assert_eq!(client.step(20), frame_sent(*power(To::Heater(7), 1500.0).frame()));
    // An answer without a byte, which is no refusal, and one that is.
    let short = |result| Frame::new_raw(0x0107_F007, true, [2, result, 0, 0, 0, 0, 0, 0], 3);
    assert!(matches!(client.hear(&short(0xF0)), Heard::Broken(of) if of == other));
    assert!(matches!(client.hear(&short(0xF2)), Heard::ShortRefusal(of) if of == other));
    assert!(is_answer(&client.hear(&answer(4)), ticket) && is_answer(&client.hear(&answer(1)), ticket));
    assert_eq!(client.step(21), Step::Done(ticket));
}

#[test]
fn two_requests_that_replace_others_do_not_wait_for_each_other_for_ever() {
    let mut client = asking(&[4]);
    let both = |client: &mut Asking, power_w, now| {
        hold(client, To::Heater(1), power_w, now).expect("room");
        hold(client, GROUP, power_w, now).expect("room");
    };
    let sent = |target, power_w| frame_sent(*power(target, power_w).frame());
    both(&mut client, 500.0, 0);
    assert_eq!([0, 20].map(|now| client.step(now)), [sent(To::Heater(1), 500.0), sent(GROUP, 500.0)]);
    both(&mut client, 0.0, 21);
    client.members(GROUP, [1, 4]).expect("room");
    // Answers to the old requests can come until 200 and 220 ms.
    let next = (21..1000).find(|now| matches!(client.step(*now), Step::Send { .. }));
    assert_eq!(next, Some(200));
}

/// Two requests that were sent to a group before its members were known, after 30 ms.
fn two_before_members() -> (Asking, [Ticket; 2]) {
    let mut client = Asking::new(PACE);
    let tickets = [client.ask(group(), 0).expect("room"), client.ask(read(), 0).expect("room")];
    let frames = [*group().frame(), *read().frame()];
    assert_eq!([client.step(0), client.step(20)], frames.map(frame_sent));
    client.members(GROUP, [1, 4]).expect("room");
    (client, tickets)
}

fn read() -> Request<Message, Heat> {
    Heat::ask(GROUP).expect("a legal request")
}

#[test]
fn two_requests_under_way_when_members_are_noted_are_both_sent_again() {
    let (mut client, tickets) = two_before_members();
    let mut ends = std::vec::Vec::new();
    let mut sent = [0, 0];
    for now in 21..2000 {
        match client.poll(now) {
            Step::Send { ticket, .. } => sent[usize::from(ticket == tickets[1])] += 1,
            Step::Missing { ticket, nodes } => ends.push((ticket, nodes)),
            Step::Lost(_) | Step::Done(_) => panic!("the members are known when it is sent again"),
            Step::Silent(_) | Step::Back(_) | Step::ClockBack(_) | Step::Wait(_) => {}
        }
    }
    assert_eq!((sent, ends), ([1, 1], tickets.map(|ticket| (ticket, [1, 4].into())).into()));
}

#[test]
fn an_answer_to_one_of_two_requests_under_way_ends_the_other_neither_way() {
    let (mut client, [set, read]) = two_before_members();
    for heater in [1, 4] {
        assert!(is_answer(&client.hear(&answer(heater)), set));
    }
    let ends = |client: &mut Asking, times: core::ops::Range<u32>| {
        times.map(|now| client.step(now)).find(|step| matches!(step, Step::Done(_) | Step::Lost(_)))
    };
    assert_eq!(ends(&mut client, 21..110), Some(Step::Done(set)));
    // Nobody has answered the other one. So it is sent again.
    assert_eq!(client.step(120), frame_sent(*self::read().frame()));
    assert_eq!(client.step(220), Step::Missing { ticket: read, nodes: [1, 4].into() });
}
