//! Messages by the transport of J1939, and what becomes of them if packets are lost, late, repeated or wrong.

use canspec_codegen::interpret::{Assembled, Assembly, Content, decode, encode_long};
use canspec_codegen::model::{NoteRule, Protocol};

use super::{feature, frame};

/// A vehicle announces 14 bytes, and sends them in two packets: ACME, 400 V, 180 Ah, 515 cycles, 2022, April.
const ANNOUNCED: &str = "1CEC56F4#100E0002FF000200";
const ONE: &str = "1CEB56F4#0141434D45A00F08";
const TWO: &str = "1CEB56F4#02070302002504FF";

/// The charger allows two packets from the first one on, or the second one alone. It confirms them, or gives them up.
const ALLOWED: &str = "1CECF456#110201FFFF000200";
const AGAIN: &str = "1CECF456#110102FFFF000200";
const DONE: &str = "1CECF456#130E0002FF000200";
const ABORTED: &str = "1CECF456#FF03FFFFFF000200";

/// The same to all nodes.
const TO_ALL: [&str; 3] = ["1CECFFF4#200E0002FF000200", "1CEBFFF4#0141434D45A00F08", "1CEBFFF4#02070302002504FF"];

fn vehicle() -> Protocol {
    feature("transport")
}

/// Puts frames together. Each remembers its place. It returns the messages, and the places of frames that belong to none.
fn assembled(protocol: &Protocol, frames: &[&str]) -> (Vec<Assembled<usize>>, Vec<usize>) {
    let (mut assembly, mut ended, mut others) = (Assembly::default(), Vec::new(), Vec::new());
    for (place, frame) in frames.iter().map(|known| frame(known)).enumerate() {
        let decoded = decode(protocol, None, &frame).unwrap_or_else(|problem| panic!("{place}: {}", problem.text));
        let taken = assembly.take(protocol, None, place, &frame, &decoded);
        ended.extend(taken.ended);
        if !taken.is_part {
            others.push(place);
        }
    }
    ended.extend(assembly.finish(protocol, None));
    (ended, others)
}

/// What became of frames: the places and what is missing of each message, and the frames that belong to none.
type Story<'a> = (Vec<(Vec<usize>, Option<&'a str>)>, Vec<usize>);

fn check(frames: &[&str], (messages, others): Story) {
    let (ended, left) = assembled(&vehicle(), frames);
    let told: Vec<_> = ended.iter().map(|whole| (whole.marks.clone(), whole.incomplete.as_deref())).collect();
    assert_eq!((told, left), (messages, others), "{frames:?}");
}

#[test]
fn a_message_is_its_announcement_and_its_packets() {
    let vehicle = vehicle();
    let (ended, others) = assembled(&vehicle, &[ANNOUNCED, ALLOWED, ONE, TWO, DONE]);
    let [whole] = ended.as_slice() else { panic!("one message") };
    assert_eq!((whole.marks.as_slice(), others.is_empty()), (&[0, 2, 3][..], true));
    let bits: Vec<_> = whole.decoded.signals.iter().map(|reading| reading.bits).collect();
    assert_eq!(bits, [0x4143_4D45, 4000, 1800, 515, 37, 4]);
    // As one frame it has its own priority and group.
    assert_eq!((whole.frame.id, whole.data.as_ref().map(Vec::len)), (0x1802_56F4, Some(14)));
    let made = encode_long(&vehicle, None, &Content::of_long(&vehicle, whole)).expect("it can be sent");
    assert_eq!(made, [ANNOUNCED, ONE, TWO].map(frame));
    check(&TO_ALL, (vec![(vec![0, 1, 2], None)], vec![]));
}

#[test]
fn a_packet_that_comes_again_counts_once_and_one_with_other_data_ends_the_message() {
    check(&[ANNOUNCED, ONE, ONE, TWO], (vec![(vec![0, 1, 3], None)], vec![]));
    let other = "1CEB56F4#0142434D45A00F08";
    let twice = "packet 2 is missing; packet 1 came twice, with other data";
    check(&[ANNOUNCED, ONE, other, TWO], (vec![(vec![0, 1], Some(twice))], vec![3]));
    // After a permission to send it once more, the later one counts.
    check(&[ANNOUNCED, ONE, ALLOWED, other, TWO], (vec![(vec![0, 3, 4], None)], vec![]));
}

#[test]
fn a_late_packet_ends_the_message_unless_the_receiver_asks_for_it() {
    let late = "packet 1 is missing; packet 1 came after packet 2";
    check(&[ANNOUNCED, TWO, ONE], (vec![(vec![0, 1], Some(late))], vec![]));
    check(&[ANNOUNCED, TWO, ALLOWED, ONE], (vec![(vec![0, 1, 3], None)], vec![]));
    check(&[ANNOUNCED, ONE, AGAIN, TWO, DONE], (vec![(vec![0, 1, 3], None)], vec![]));
    check(&[TO_ALL[0], TO_ALL[2]], (vec![(vec![0, 1], Some("packet 1 is missing"))], vec![]));
}

#[test]
fn the_frames_of_a_message_stand_in_the_order_in_which_they_came() {
    // The first packet comes once more after the second one, and is the one that counts.
    check(&[ANNOUNCED, ONE, AGAIN, ALLOWED, ONE, TWO, DONE], (vec![(vec![0, 4, 5], None)], vec![]));
    check(&[ANNOUNCED, TWO, ALLOWED, TWO, ONE, DONE], (vec![(vec![0, 3, 4], None)], vec![]));
    check(&[ANNOUNCED, TWO, ALLOWED, ONE, DONE], (vec![(vec![0, 1, 3], None)], vec![]));
}

#[test]
fn a_message_ends_if_it_is_given_up_or_another_one_begins() {
    let one_came = |why: &str| format!("packet 2 is missing; {why}");
    let [aborted, begun, early] =
        ["the transfer is aborted for reason 3", "another message begins", "the receiver says that it came whole"]
            .map(one_came);
    check(&[ANNOUNCED, ONE, ABORTED, TWO], (vec![(vec![0, 1], Some(&aborted))], vec![3]));
    check(&[ANNOUNCED, ONE, ANNOUNCED, ONE, TWO], (vec![(vec![0, 1], Some(&begun)), (vec![2, 3, 4], None)], vec![]));
    check(&[ANNOUNCED, ONE, DONE], (vec![(vec![0, 1], Some(&early))], vec![]));
    let nothing = "the packets 1, 2 are missing";
    check(&[ANNOUNCED], (vec![(vec![0], Some(nothing))], vec![]));
    // An abort of another group is none of this message.
    check(&[ANNOUNCED, "1CECF456#FF03FFFFFF000300", ONE, TWO], (vec![(vec![0, 2, 3], None)], vec![1]));
}

#[test]
fn what_nothing_announces_belongs_to_nothing() {
    check(&[ONE, ALLOWED, DONE, ABORTED], (vec![], vec![0, 1, 2, 3]));
    let other_group = "1CEC56F4#100E0002FF000900";
    check(&[other_group, ONE, TWO], (vec![], vec![0, 1, 2]));
    check(&[ANNOUNCED, "1CEB56F4#0341434D45A00F08", ONE, TWO], (vec![(vec![0, 2, 3], None)], vec![1]));
}

#[test]
fn a_wrong_size_is_told() {
    let announced = |text: &str| text.to_owned();
    let cases = [
        ("1CEC56F4#10D00702FF000200", "2000 bytes in 2 packets are announced"),
        ("1CEC56F4#10000002FF000200", "0 bytes in 2 packets are announced"),
        ("1CEC56F4#100E0003FF000200", "14 bytes in 3 packets are announced"),
    ];
    for (frame, why) in cases {
        check(&[frame, ONE, TWO], (vec![(vec![0], Some(&announced(why)))], vec![1, 2]));
    }
    let thirteen = "13 bytes came, but the message has 11 or 14";
    check(&["1CEC56F4#100D0002FF000200", ONE, TWO], (vec![(vec![0, 1, 2], Some(thirteen))], vec![]));
}

#[test]
fn padding_that_is_not_all_ones_is_noted() {
    let eleven = "1CEC56F4#100B0002FF000200";
    let (ended, _) = assembled(&vehicle(), &[eleven, ONE, "1CEB56F4#0207030200FFFF00"]);
    let [whole] = ended.as_slice() else { panic!("one message") };
    assert_eq!(whole.incomplete, None);
    let notes: Vec<_> = whole.decoded.notes.iter().map(|note| (note.rule, note.text.as_str())).collect();
    assert_eq!(notes, [(NoteRule::ReservedBit, "bytes behind the end of the message are not all 0xFF")]);
}

#[test]
fn nodes_that_send_at_once_are_never_mixed() {
    let [announced, one, two] = TO_ALL;
    let frames = [ANNOUNCED, announced, ONE, one, two, TWO];
    check(&frames, (vec![(vec![1, 3, 4], None), (vec![0, 2, 5], None)], vec![]));
}
