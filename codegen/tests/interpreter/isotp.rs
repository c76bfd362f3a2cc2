//! Messages by ISO-TP, and what becomes of them if frames are lost, late, repeated or wrong.

use canspec_codegen::interpret::{Assembled, Content, Frame, Sent, encode_long, requests, sent};
use canspec_codegen::model::{Kind, Protocol};

use super::assembled::{Story, assembled};
use super::{assembled, protocol};

/// A unit's reply in three frames: 1000 rpm, 10, 30, 50 and 0 A, day 9. Then one in a single frame.
const FIRST: &str = "7E8#100E62F19003E800";
const SECOND: &str = "7E8#2164012C01F40000";
const THIRD: &str = "7E8#2209000000000000";
const SINGLE: &str = "7E8#0562F19103E80000";

fn units() -> Protocol {
    protocol("tests/specs/devices/units.yaml")
}

fn text(frame: &Frame) -> String {
    let data: Vec<_> = frame.data.iter().map(|byte| format!("{byte:02X}")).collect();
    format!("{:03X}#{}", frame.id, data.concat())
}

fn check(frames: &[&str], story: Story) {
    assembled::check(&units(), frames, story);
}

fn hex(data: &[u8]) -> String {
    data.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().concat()
}

#[test]
fn a_message_of_three_frames_has_the_joined_data_and_its_selectors() {
    let units = units();
    let (ended, others) = assembled(&units, &[FIRST, "7E0#3000000000000000", SECOND, THIRD]);
    let [whole] = ended.as_slice() else { panic!("one message") };
    assert_eq!((whole.marks.as_slice(), others.is_empty()), (&[0, 2, 3][..], true));
    assert_eq!(hex(whole.data.as_ref().expect("it is whole")), "62F19003E80064012C01F4000009");
    let decoded = &whole.decoded;
    assert_eq!((units[decoded.message].name.as_str(), decoded.kind), ("calibration", Kind::Reply));
    let selectors: Vec<_> = decoded.selectors.iter().map(|(id, value)| (units[*id].name.as_str(), *value)).collect();
    assert_eq!(selectors, [("service", 0x62), ("data", 0xF190)]);
    let bits: Vec<_> = decoded.signals.iter().map(|reading| reading.bits).collect();
    assert_eq!(bits, [1000, 100, 300, 500, 0, 9]);
    assert_eq!((decoded.notes.len(), whole.reserved.iter().any(|byte| *byte != 0)), (0, false));
}

#[test]
fn a_request_without_fields_ends_with_its_constants() {
    let (ended, _) = assembled(&units(), &["7E3#0322F19000000000"]);
    let [whole] = ended.as_slice() else { panic!("one message") };
    assert_eq!(
        (whole.incomplete.as_deref(), whole.decoded.kind, whole.decoded.signals.len()),
        (None, Kind::Request, 0)
    );
    check(&["7E3#0422F19000000000"], (vec![(vec![0], Some("4 bytes came, but the message has 3"))], vec![]));
}

#[test]
fn data_of_no_message_belong_to_none() {
    let (other_service, other_data) = ("7E8#0399F19100000000", "7E8#0362F19900000000");
    check(&[other_service, other_data, "7E8#0262F10000000000"], (vec![], vec![0, 1, 2]));
    check(&["7E8#100E62F19903E800", SECOND, THIRD], (vec![], vec![0, 1, 2]));
    // A request's data come from the controller.
    check(&["7E8#0322F19000000000", "7E0#0562F19103E80000"], (vec![], vec![0, 1]));
}

#[test]
fn a_skipped_or_repeated_frame_ends_a_message_and_others_belong_to_nothing_then() {
    let skipped = "6 of 14 bytes came; frame number 2 came in place of 1";
    check(&[FIRST, THIRD, THIRD], (vec![(vec![0], Some(skipped))], vec![2]));
    let repeated = "13 of 14 bytes came; frame number 1 came in place of 2";
    check(&[FIRST, SECOND, SECOND, THIRD], (vec![(vec![0, 1], Some(repeated))], vec![3]));
    check(&[SECOND, THIRD], (vec![], vec![0, 1]));
    check(&[FIRST, SECOND], (vec![(vec![0, 1], Some("13 of 14 bytes came"))], vec![]));
}

#[test]
fn another_message_of_the_same_sender_ends_one() {
    let (six, thirteen) = ("6 of 14 bytes came; another message begins", "13 of 14 bytes came; another message begins");
    check(&[FIRST, SECOND, SINGLE], (vec![(vec![0, 1], Some(thirteen)), (vec![2], None)], vec![]));
    check(&[FIRST, FIRST, SECOND, THIRD], (vec![(vec![0], Some(six)), (vec![1, 2, 3], None)], vec![]));
    check(&[FIRST, "7E8#0399000000000000", SECOND], (vec![(vec![0], Some(six))], vec![1, 2]));
    check(&[FIRST, "7E0#0322F19000000000", SECOND, THIRD], (vec![(vec![1], None), (vec![0, 2, 3], None)], vec![]));
}

#[test]
fn two_senders_at_once_are_never_mixed() {
    let frames = [FIRST, "7E9#100E62F19003E900", "7E9#2164012C01F40000", SECOND, THIRD, "7E9#220A000000000000"];
    let (ended, others) = assembled(&units(), &frames);
    let last = |whole: &Assembled<usize>| whole.decoded.signals.last().map(|reading| reading.bits);
    let told: Vec<_> = ended.iter().map(|whole| (whole.marks.clone(), last(whole))).collect();
    assert_eq!(told, [(vec![0, 3, 4], Some(9)), (vec![1, 2, 5], Some(10))]);
    assert!(others.is_empty());
}

#[test]
fn a_receiver_without_room_ends_a_message_and_other_answers_do_not() {
    let (wait, overflow, of_unit_1) = ("7E0#310000", "7E0#3200000000000000", "7E1#3200000000000000");
    let whole = |places: [usize; 3]| vec![(places.to_vec(), None)];
    check(&[FIRST, "7E0#300800", SECOND, THIRD], (whole([0, 2, 3]), vec![]));
    check(&[FIRST, wait, SECOND, THIRD], (whole([0, 2, 3]), vec![]));
    check(&[FIRST, of_unit_1, SECOND, THIRD], (whole([0, 2, 3]), vec![1]));
    check(&[FIRST, "7E8#3200000000000000", SECOND, THIRD], (whole([0, 2, 3]), vec![1]));
    let no_room = "6 of 14 bytes came; the receiver has no room for it";
    check(&[FIRST, overflow, SECOND], (vec![(vec![0], Some(no_room))], vec![2]));
}

#[test]
fn padding_may_be_anything_and_may_be_missing() {
    check(&[FIRST, SECOND, "7E8#2209"], (vec![(vec![0, 1, 2], None)], vec![]));
    check(&[FIRST, SECOND, "7E8#2209AA55FF010203"], (vec![(vec![0, 1, 2], None)], vec![]));
    check(&["7E8#0562F19103E8", "7E8#0562F19103E8AAAA"], (vec![(vec![0], None), (vec![1], None)], vec![]));
}

#[test]
fn what_the_standard_tells_receivers_to_ignore_changes_nothing() {
    let ignored = [
        "7E8#0062F19103E80000",
        "7E8#0F62F19103E80000",
        "7E8#0562F19103",
        "7E8#100000000FFF62F1",
        "7E8#100762F19003E800",
        "7E8#216401",
    ];
    for known in ignored {
        check(&[FIRST, known, SECOND, THIRD], (vec![(vec![0, 2, 3], None)], vec![1]));
    }
}

#[test]
fn a_message_that_is_too_long_ends_the_one_before() {
    let ended = Some("6 of 14 bytes came; another message begins");
    check(&[FIRST, "7E8#10000000100062F1", SECOND, THIRD], (vec![(vec![0], ended)], vec![1, 2, 3]));
}

#[test]
fn a_wrong_size_is_told() {
    let nine = ["7E8#100962F19003E800", "7E8#2164012C00000000"];
    check(&nine, (vec![(vec![0, 1], Some("9 bytes came, but the message has 14"))], vec![]));
    check(&["7E8#1FFF62F19003E800"], (vec![(vec![0], Some("6 of 4095 bytes came"))], vec![]));
}

#[test]
fn a_message_that_is_whole_encodes_to_its_frames() {
    let units = units();
    let (ended, _) = assembled(&units, &[FIRST, SECOND, THIRD, SINGLE, "7E0#0322F19000000000"]);
    let back = |whole| encode_long(&units, None, &Content::of_long(&units, whole)).expect("it can be sent");
    let frames: Vec<_> = ended.iter().flat_map(back).map(|frame| text(&frame)).collect();
    assert_eq!(frames, [FIRST, SECOND, THIRD, SINGLE, "7E0#0322F19000000000"]);
}

#[test]
fn a_message_with_another_service_is_not_made() {
    let units = units();
    let (ended, _) = assembled(&units, &[SINGLE]);
    let mut content = Content::of_long(&units, &ended[0]);
    content.selectors[0].1 = 0x63;
    let refusal = encode_long(&units, None, &content).expect_err("no such reply");
    assert_eq!(refusal.0, "idle_speed: the identifier and the selectors are not those of this message");
    content.selectors.remove(0);
    assert!(encode_long(&units, None, &content).is_err());
}

fn named(signals: &[(&str, &str)]) -> Vec<(String, String)> {
    signals.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
}

#[test]
fn a_call_makes_all_frames_of_a_request_and_keeps_limits() {
    let units = units();
    let target = canspec_codegen::interpret::Target { name: "unit".to_owned(), number: Some(1) };
    let request = |access, signals: &[(&str, &str)]| {
        let made = requests(&units, None, Some(access), "calibration", &target, None, &named(signals));
        made.map(|frames| frames.iter().map(text).collect::<Vec<_>>()).map_err(|refusal| refusal.0)
    };
    let currents = ("current", "1A,2A,3A,25A");
    // 900 is 0x384. The day takes its default 1.
    let frames = ["7E1#100E2EF190038400", "7E1#210A0014001E00FA", "7E1#2201000000000000"];
    assert_eq!(request("write", &[("speed", "900rpm"), currents]), Ok(frames.map(str::to_owned).to_vec()));
    let limit = "calibration.speed: 2001 rpm is outside 500..2000 rpm";
    assert_eq!(request("write", &[("speed", "2001rpm"), currents]), Err(limit.to_owned()));
    assert_eq!(request("read", &[]), Ok(vec!["7E1#0322F19000000000".to_owned()]));
    assert!(request("read", &[("speed", "900rpm")]).is_err());
}

#[test]
fn a_call_makes_the_reply_of_a_unit() {
    let units = units();
    let reply = |message, signals: &[(&str, &str)]| {
        let access = (message == "calibration").then_some("read");
        let sent_by = Sent { kind: Some(Kind::Reply), access, model: None, message, to: None, source: Some(3) };
        let made = sent(&units, sent_by, &named(signals)).expect("it can be sent");
        made.iter().map(text).collect::<Vec<_>>()
    };
    assert_eq!(reply("refused", &[("refused", "write"), ("reason", "locked")]), ["7EB#037F2E3300000000"]);
    let calibration = [("speed", "1000rpm"), ("current", "10A,30A,50A,0A"), ("day", "9")];
    assert_eq!(reply("calibration", &calibration), [FIRST, SECOND, THIRD].map(|frame| frame.replace("7E8", "7EB")));
}
