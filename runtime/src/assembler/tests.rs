//! The assembler against one that keeps everything, over all orders, losses and repetitions, and what it makes of frames
//! that are none of its own.

mod naive;
mod ovens;

use std::string::ToString;
use std::vec::Vec;

use naive::{Item, Naive, Said, said, said_partial, story_of};
use ovens::{All, Pair, reply};

use super::{Arrival, Assembler, Full, Members, Progress};
use crate::Frame;

/// A time shortly before the clock wraps around.
const START: u64 = u32::MAX as u64 - 300;

fn clock(now: u64) -> u32 {
    u32::try_from(now % (1 << 32)).expect("the rest of a division by 2^32")
}

fn frame(node: i32, item: Item, more: bool) -> Frame {
    let node = u32::try_from(node).expect("a small number");
    let signal = |position: usize| u8::try_from(position).expect("a small number") + 1;
    match item {
        Item::Value(position, value) => reply(5, node, more, signal(position), value),
        Item::Error(position) => {
            let mut data = reply(5, node, more, signal(position), 0).bytes();
            data[1] = 3;
            Frame::new_raw(0x400 | 5 << 5 | node << 1 | u32::from(more), false, data, 4)
        }
        Item::Unlisted => reply(5, node, more, 77, 0),
    }
}

/// Sends one node's frames to both assemblers, and compares what they say of each.
fn compare(items: &[(Item, bool)]) {
    let mut assembler = Assembler::<All, 1>::new(100);
    let mut naive = Naive { stories: [].into(), room: 1, patience: 100, is_listening: false };
    assert_eq!(assembler.ask(7, 0).is_ok(), naive.ask(7, 0));
    for (item, more) in items {
        let progress = assembler.receive(&frame(7, *item, *more), 1).expect("a frame of the set");
        assert_eq!(said(progress), naive.receive(7, *item, *more, 1), "{}", story_of(items));
        let left = naive.stories.get(&7).map(|story| story.partial(7));
        assert_eq!(assembler.partial(7).as_ref().map(said_partial), left, "{}", story_of(items));
    }
}

/// Returns every order of every choice of the six members.
fn arrangements() -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = Vec::from([Vec::new()]);
    let mut next = 0;
    while let Some(known) = all.get(next).cloned() {
        next += 1;
        let longer = (0..6).filter(|position| !known.contains(position)).map(|position| {
            let mut longer = known.clone();
            longer.push(position);
            longer
        });
        all.extend(longer);
    }
    all
}

fn value(position: usize) -> Item {
    Item::Value(position, 100 + u16::try_from(position).expect("a small number"))
}

#[test]
fn all_orders_and_losses_with_the_end_in_any_place_are_told_apart() {
    let all = arrangements();
    assert_eq!(all.len(), 1 + 6 + 30 + 120 + 360 + 720 + 720);
    for order in &all {
        for end in 0..=order.len() {
            let items: Vec<_> = order.iter().enumerate().map(|(at, place)| (value(*place), at != end)).collect();
            compare(&items);
        }
    }
}

#[test]
fn one_frame_more_in_any_place_of_any_order_is_told_what_it_is() {
    let members = [0, 1, 2, 3, 4, 5];
    let again = members.map(value);
    let other = members.map(|position| Item::Value(position, 9));
    let wrong = members.map(Item::Error);
    let more: Vec<_> = [again, other, wrong].concat().into_iter().chain([Item::Unlisted]).collect();
    for order in arrangements() {
        for at in 0..=order.len() {
            for extra in &more {
                let mut items: Vec<_> = order.iter().map(|position| value(*position)).collect();
                items.insert(at, *extra);
                let last = items.len() - 1;
                let items: Vec<_> = items.into_iter().enumerate().map(|(at, item)| (item, at != last)).collect();
                compare(&items);
            }
        }
    }
}

/// Numbers that look random and are the same each time.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }

    fn item(&mut self) -> Item {
        let position = usize::try_from(self.below(6)).expect("a small number");
        match self.below(12) {
            0 => Item::Unlisted,
            1 => Item::Error(position),
            2 => Item::Value(position, 9),
            _ => value(position),
        }
    }
}

/// Lets five nodes talk at once to an assembler with room for three.
fn converse(random: &mut Random, is_listening: bool) {
    let mut assembler = if is_listening { Assembler::<All, 3>::listening(50) } else { Assembler::<All, 3>::new(50) };
    let mut naive = Naive { stories: [].into(), room: 3, patience: 50, is_listening };
    let mut now = START;
    for _ in 0..60 {
        now += random.below(20);
        let node = i32::try_from(random.below(5)).expect("a small number") + 1;
        match random.below(16) {
            0 | 1 => assert_eq!(assembler.ask(node, clock(now)).is_ok(), naive.ask(node, now)),
            2 => {
                assembler.forget(node);
                naive.stories.remove(&node);
            }
            3 => {
                let over = std::iter::from_fn(|| assembler.timed_out(clock(now))).take(4);
                let mut over: Vec<Said> = over.map(|partial| said_partial(&partial)).collect();
                over.sort_by_key(|said| said.node);
                assert_eq!(over, naive.timed_out(now));
            }
            _ => {
                let (item, more) = (random.item(), random.below(8) > 0);
                let progress = assembler.receive(&frame(node, item, more), clock(now)).expect("a frame of the set");
                assert_eq!(said(progress), naive.receive(node, item, more, now));
            }
        }
    }
}

#[test]
fn nodes_that_talk_at_once_are_never_mixed() {
    let mut random = Random(0xCA25);
    for round in 0..4000 {
        converse(&mut random, round % 2 == 0);
    }
}

fn asked() -> Assembler<All, 2> {
    let mut assembler = Assembler::new(140);
    assert_eq!(assembler.ask(3, 0), Ok(()));
    assembler
}

#[test]
fn a_whole_set_is_complete_with_its_last_frame_and_forgotten_then() {
    let mut assembler = asked();
    for position in 0..5_u8 {
        let progress = assembler.receive(&reply(5, 3, true, position + 1, 10), 1);
        assert!(matches!(progress, Some(Progress::Pending { node: 3, arrival: Arrival::InOrder, .. })));
    }
    let set = All([Some(10); 6]);
    let last = reply(5, 3, false, 6, 10);
    let complete = Progress::Complete { node: 3, arrival: Arrival::InOrder, set };
    assert_eq!(assembler.receive(&last, 2), Some(complete));
    assert_eq!(assembler.receive(&last, 3), Some(Progress::Unasked { node: 3 }));
    assert_eq!(assembler.timed_out(1000), None);
}

#[test]
fn what_is_missing_is_named_in_order() {
    let mut assembler = asked();
    assembler.receive(&reply(5, 3, true, 5, 10), 1);
    assembler.receive(&frame(3, Item::Error(1), true), 1);
    let Some(Progress::Incomplete { partial, .. }) = assembler.receive(&reply(5, 3, false, 77, 0), 1) else {
        panic!("the last frame of an incomplete set");
    };
    assert_eq!(partial.missing.names().collect::<Vec<_>>(), ["a", "c", "d", "f"]);
    assert_eq!(partial.failed.names().collect::<Vec<_>>(), ["b"]);
    assert_eq!((partial.node, partial.set), (3, All([None, None, None, None, Some(10), None])));
}

#[test]
fn frames_of_anything_else_are_none_of_the_set_and_change_nothing() {
    let mut assembler = asked();
    let before = assembler.partial(3);
    let request = Frame::new_raw(5 << 5 | 3 << 1, false, [1, 0, 0, 0, 0, 0, 0, 0], 4);
    let unknown_request = Frame::new_raw(5 << 5 | 3 << 1, false, [77, 0, 0, 0, 0, 0, 0, 0], 4);
    let long = Frame::new_raw(reply(5, 3, false, 1, 0).raw_id(), false, [1, 0, 0, 0, 0, 0, 0, 0], 8);
    let unknown_long = Frame::new_raw(long.raw_id(), false, [77, 0, 0, 0, 0, 0, 0, 0], 8);
    let wide = Frame::new_raw(long.raw_id(), true, [1, 0, 0, 0, 0, 0, 0, 0], 4);
    let other_set = [reply(6, 3, false, 1, 0), reply(6, 3, false, 77, 0)];
    let alone = [reply(7, 3, false, 1, 0), reply(7, 3, false, 77, 0)];
    let nobody = reply(5, 0, false, 1, 0);
    let others = [request, unknown_request, long, unknown_long, wide, nobody];
    for other in others.into_iter().chain(other_set).chain(alone) {
        assert_eq!(assembler.receive(&other, 1), None, "{other}");
    }
    assert_eq!(assembler.partial(3), before);
}

#[test]
fn an_address_that_the_document_does_not_name_is_a_node_too() {
    let mut assembler = Assembler::<All, 1>::listening(140);
    let progress = assembler.receive(&reply(5, 14, true, 1, 0), 1);
    assert!(matches!(progress, Some(Progress::Pending { node: 14, .. })));
}

#[test]
fn a_field_of_the_data_can_say_that_more_follow() {
    let mut assembler = Assembler::<Pair, 1>::new(140);
    assert_eq!(assembler.ask(3, 0), Ok(()));
    let progress = assembler.receive(&reply(6, 3, false, 1, 0x01AA), 1);
    assert!(matches!(progress, Some(Progress::Pending { missing, .. }) if missing.names().eq(["b"])));
    let set = Pair([Some(0x01AA), Some(0x0100)]);
    let complete = Progress::Complete { node: 3, arrival: Arrival::InOrder, set };
    assert_eq!(assembler.receive(&reply(6, 3, true, 2, 0x0100), 1), Some(complete));
}

#[test]
fn a_new_request_starts_the_set_anew() {
    let mut assembler = asked();
    assembler.receive(&reply(5, 3, true, 4, 10), 1);
    assert_eq!(assembler.ask(3, 100), Ok(()));
    assert_eq!(assembler.partial(3).map(|partial| partial.set), Some(All::default()));
    let progress = assembler.receive(&reply(5, 3, true, 1, 10), 101);
    assert!(matches!(progress, Some(Progress::Pending { arrival: Arrival::InOrder, .. })));
    assert_eq!(assembler.timed_out(240), None);
}

#[test]
fn a_full_assembler_says_so_and_has_room_again_when_a_node_is_done() {
    let mut assembler = asked();
    assert_eq!((assembler.ask(4, 0), assembler.ask(5, 0), assembler.ask(3, 0)), (Ok(()), Err(Full), Ok(())));
    assert_eq!(Full.to_string(), "the assembler has no room for another node");
    assert_eq!(assembler.receive(&reply(5, 5, true, 1, 0), 1), Some(Progress::Unasked { node: 5 }));
    assembler.receive(&reply(5, 4, false, 1, 0), 1);
    assert_eq!(assembler.ask(5, 0), Ok(()));
    let mut listening = Assembler::<All, 1>::listening(140);
    listening.receive(&reply(5, 4, true, 1, 0), 1);
    assert_eq!(listening.receive(&reply(5, 5, true, 1, 0), 1), Some(Progress::Full { node: 5 }));
    assert_eq!(Assembler::<All, 0>::new(1).ask(1, 0), Err(Full));
}

#[test]
fn a_node_times_out_after_so_much_silence_even_if_the_clock_wraps_around() {
    let mut assembler = Assembler::<All, 1>::new(140);
    assert_eq!(assembler.ask(3, u32::MAX - 100), Ok(()));
    assembler.receive(&reply(5, 3, true, 1, 10), u32::MAX - 50);
    assert_eq!(assembler.timed_out(88), None);
    let partial = assembler.timed_out(89).expect("140 ms after the last frame");
    assert!(partial.node == 3 && partial.missing.names().eq(["b", "c", "d", "e", "f"]));
    assert_eq!(assembler.timed_out(89), None);
}

#[test]
fn a_stamp_of_the_past_neither_ends_the_wait_nor_lengthens_it() {
    let mut assembler = asked();
    assembler.receive(&reply(5, 3, true, 1, 10), 50);
    assembler.receive(&reply(5, 3, true, 2, 10), 40);
    assert_eq!(assembler.timed_out(30), None);
    assert_eq!(assembler.timed_out(189), None);
    assert!(assembler.timed_out(190).is_some());
}

#[test]
fn frames_are_taken_for_those_of_the_device_model() {
    let mut assembler = asked().for_model(1_u8);
    assert_eq!(assembler.receive(&reply(5, 3, true, 1, 10), 1), None);
    assert!(asked().receive(&reply(5, 3, true, 1, 10), 1).is_some());
}

#[test]
fn sixty_four_members_have_a_bit_each() {
    const NAMES: [&str; 65] = ["x"; 65];
    let members = |bits| Members { names: &NAMES, bits };
    assert_eq!(members(u64::MAX).names().count(), 64);
    assert_eq!(members(1 << 63).names().count(), 1);
    assert!(members(0).is_empty() && !members(1 << 63).is_empty());
}
