//! Messages in numbered parts, and what becomes of them if parts are lost or messages overlap.

use canspec_codegen::interpret::{Assembly, Content, decode, encode_long};
use canspec_codegen::model::NoteRule;

use super::assembled::{assembled, check};
use super::{feature, frame, model, printed, values, written};

/// A battery's six cells in three parts of three words, without the cycles in the first two bytes.
const FIRST: &str = "051#010201E8030A0000";
const SECOND: &str = "051#020B000C004A0100";
const THIRD: &str = "051#034B110000000000";
const SIX: &str = "031#0600000000000000";

#[test]
fn a_message_in_parts_ends_with_the_part_that_its_count_needs() {
    let parts = feature("parts");
    check(&parts, &[SIX, FIRST, SECOND, THIRD], (vec![(vec![1, 2, 3], None)], vec![0]));
    // Two cells and the cycles are six bytes.
    check(
        &parts,
        &["031#0200000000000000", FIRST, SECOND],
        (vec![(vec![1], None), (vec![2], Some("part 1 is missing"))], vec![0]),
    );
}

#[test]
fn what_fills_up_a_message_is_noted_only_if_it_is_whole() {
    // Five bytes are a pack and two cells. No such message has four.
    let said = |frame| {
        let (ended, _) = assembled(&feature("fast_packets"), &[frame]);
        let [pack] = ended.as_slice() else { panic!("one message") };
        assert_eq!(pack.decoded.reserved, [0; 8]);
        let notes: Vec<_> = pack.decoded.notes.iter().map(|note| note.text.clone()).collect();
        (pack.incomplete.clone(), notes)
    };
    let filled = "bytes behind the end of the message are not all 0xFF".to_owned();
    assert_eq!(said("19FF0123#000501E40CE50C00"), (None, vec![filled]));
    let announced = |length| Some(format!("{length} announced, but the message has 3, 5, ... 33"));
    assert_eq!(said("19FF0123#400401E40CE50C00"), (announced("4 bytes"), vec![]));
    assert_eq!(said("19FF0123#4001010000000000"), (announced("1 byte"), vec![]));
}

#[test]
fn a_message_that_is_said_to_end_before_its_last_field_is_incomplete() {
    // The maker's year, name and serial number are 25 bytes in four parts. Of the label, two bytes are always there.
    let texts = feature("long_texts");
    let came = |count: usize| format!("{count} bytes came, but the message has 25");
    let [one, three] = [came(7), came(21)];
    check(&texts, &["211#0120214100000000"], (vec![(vec![0], Some(&one))], vec![]));
    let three_parts = ["611#01202141434D4520", "611#024D4F544F525320", "211#03FF000102030405"];
    check(&texts, &three_parts, (vec![(vec![0, 1, 2], Some(&three))], vec![]));
    let four_parts = [&three_parts[..2], &["611#03FF000102030405", "211#0406070809FFFFFF"]].concat();
    check(&texts, &four_parts, (vec![(vec![0, 1, 2, 3], None)], vec![]));
    // A part that is lost says enough.
    let lost = Some("part 1 is missing");
    check(&texts, &["211#024D4F544F525320"], (vec![(vec![0], lost)], vec![]));
    check(&texts, &["221#0000656E50756D70"], (vec![(vec![0], None)], vec![]));
    let (ended, _) = assembled(&texts, &["211#0120214100000000"]);
    assert_eq!((ended[0].data.as_ref(), ended[0].decoded.signals.len()), (None, 1));
}

#[test]
fn a_part_whose_number_is_not_greater_ends_the_message_before() {
    let again = "051#010300E8030A0000";
    let lost = Some("the parts 2, 3 are missing");
    check(
        &feature("parts"),
        &[SIX, FIRST, again, SECOND, THIRD],
        (vec![(vec![1], lost), (vec![2, 3, 4], None)], vec![0]),
    );
    // The same frame at once is a repetition.
    check(&feature("parts"), &[SIX, FIRST, FIRST, SECOND, THIRD], (vec![(vec![1, 3, 4], None)], vec![0]));
}

#[test]
fn what_a_device_said_last_does_not_count_what_it_is_told_and_confirms() {
    let ovens = feature("parts_to_modules");
    let frames = ["053#0100000000000000", "0A3#010A070807D00800", "0A3#0234000000000000"];
    let from = |id| frames.map(|frame| frame.replace("0A3", id));
    for told in [from("0A3"), from("0B3")] {
        let told = told.each_ref().map(String::as_str);
        check(&ovens, &told, (vec![(vec![1, 2], None)], vec![0]));
        let (ended, _) = assembled(&ovens, &told);
        assert!(ended[0].decoded.notes.iter().any(|note| note.rule == NoteRule::Count));
    }
    // The last part says what it is, when the device confirms in the middle of what it says itself.
    let mixed = ["053#0300000000000000", "093#010A070807D00800", "0B3#0234000000000000", "0B3#0300000000000000"];
    check(&ovens, &mixed, (vec![(vec![1, 2, 3], None)], vec![0]));
    // A program that is read has one temperature, so the second part belongs to no message.
    let own = from("093");
    let own = own.each_ref().map(String::as_str);
    check(&ovens, &own, (vec![(vec![1], None), (vec![2], Some("part 1 is missing"))], vec![0]));
}

#[test]
fn a_request_that_carries_no_part_ends_what_the_device_has_begun() {
    let bare = "041#0000000000000000";
    let lost = Some("the parts 2, 3 are missing");
    check(
        &feature("parts"),
        &[SIX, FIRST, bare, SECOND],
        (vec![(vec![1], lost), (vec![3], Some("the parts 1, 3 are missing"))], vec![0, 2]),
    );
}

#[test]
fn a_frame_of_elements_shows_its_own_and_the_whole_shows_all() {
    let parts = feature("parts_of_elements");
    let frames = ["051#000CF00CFD0D1300", "051#010CD30D0B000000", "051#020CF00000000000"];
    let names: Vec<_> = values(&parts, frames[0]).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["part", "voltage_1", "voltage_2", "voltage_3"]);
    // Nothing is put together as long as nobody knows the number of the first part.
    check(&parts, &frames, (vec![], vec![0, 1, 2]));
    let joined = |name, frames: &[&str]| {
        let (model, mut assembly, mut ended) = (Some(model(&parts, name)), Assembly::default(), Vec::new());
        for frame in frames.iter().map(|text| frame(text)) {
            let decoded = decode(&parts, model, &frame).expect("a frame of the protocol");
            ended.extend(assembly.take(&parts, model, (), &frame, &decoded).ended);
        }
        ended
            .iter()
            .map(|whole| whole.decoded.signals.iter().map(|reading| reading.bits).collect())
            .collect::<Vec<Vec<_>>>()
    };
    // There can be eight cells in three parts, so the third one ends the message.
    assert_eq!(joined("FROM_0", &frames), [[3312, 3325, 3347, 3283, 3339, 0, 3312, 0]]);
    assert_eq!(joined("FROM_1", &frames), [[0; 0]; 0]);
    // The device says that it has five.
    assert_eq!(joined("FROM_0", &["031#0500000000000000", frames[0], frames[1]]), [[3312, 3325, 3347, 3283, 3339]]);
}

#[test]
fn bits_between_elements_are_noted_and_come_back() {
    let parts = feature("parts_of_words");
    // The upper bits of bytes 2 and 5 have no field.
    let frames = ["071#D70001F6FF020000", "071#0000000A00F10001", "071#1400210000000002"];
    let (ended, _) = assembled(&parts, &frames);
    let [whole] = ended.as_slice() else { panic!("one message") };
    assert_eq!(whole.decoded.notes.iter().map(|note| note.rule).collect::<Vec<_>>(), [NoteRule::ReservedBit]);
    assert_eq!(whole.reserved, [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xF0, 0, 0, 0x20, 0, 0, 0]);
    let made = encode_long(&parts, None, &Content::of_long(&parts, whole)).expect("what came can be sent");
    assert_eq!(made.iter().map(printed).collect::<Vec<_>>(), frames);
}

/// Only half of the bytes of a frame are data.
const HALF: &str = r#"
canspec: 1
protocol: half
title: A battery
document: {title: Made up, version: "1"}
length: 8
reserved: {send: 1}
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
addressing: {battery: {request: {sender: 0}, one: {sender: 1}}}
access: {set: {request: {}, reply: {}, answers: {battery: one}}}
messages:
  cells:
    section: "1"
    match: {command: 3}
    access: [set]
    parts: {number: {bytes: 0}, first: 0, data: 1..3}
    fields: {one: {bytes: 0..1}, other: {bytes: 2..4}}
"#;

#[test]
fn bits_beside_the_data_of_a_part_come_back_as_they_are_sent() {
    let (half, frames) = (written(HALF), ["006#00000100FFFFFFFF", "006#010001FFFFFFFFFF"]);
    let (ended, _) = assembled(&half, &frames);
    let [whole] = ended.as_slice() else { panic!("one message") };
    let made = encode_long(&half, None, &Content::of_long(&half, whole)).expect("what came can be sent");
    assert_eq!(made.iter().map(printed).collect::<Vec<_>>(), frames);
}
