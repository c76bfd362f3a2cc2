//! From the content of a decoded line back to a frame.

use canspec_codegen::interpret::{Content, Input, Refusal, encode};
use canspec_codegen::model::Protocol;

use super::{decoded, feature, printed};

/// Takes a frame apart, changes its content, and puts it together again.
fn changed(protocol: &Protocol, text: &str, change: impl Fn(&mut Content)) -> Result<String, Refusal> {
    let mut content = Content::of(protocol, &decoded(protocol, text));
    change(&mut content);
    encode(protocol, None, &content).map(|frame| printed(&frame))
}

#[test]
fn a_frame_comes_back_with_its_reserved_bits_and_unnamed_values() {
    let frames = [
        ("status_word", "443#0100820100FF0080"),
        ("named_values", "5A3#0712340000000000"),
        ("register_table", "413#43F20021FFC01234"),
        ("little_endian", "083#73AAFEFF28231311"),
        ("short_frames", "283#0100FAFFFEFF"),
        ("addressing", "0C83F13C#32000000000000FF"),
    ];
    for (name, text) in frames {
        assert_eq!(changed(&feature(name), text, |_| ()).as_deref(), Ok(text));
    }
}

#[test]
fn a_reply_takes_what_its_bits_hold_and_a_request_what_its_range_has() {
    let levels = feature("addressing");
    let value = |text, value| {
        changed(&levels, text, |content| content.signals[0].1 = Input::Integer(value)).map_err(|refusal| refusal.0)
    };
    assert_eq!(value("0043F003#3200000000000000", 255).as_deref(), Ok("0043F003#FF00000000000000"));
    assert!(value("0043F003#3200000000000000", 256).is_err());
    assert_eq!(value("004303F0#3200000000000000", 100).as_deref(), Ok("004303F0#6400000000000000"));
    assert_eq!(value("004303F0#3200000000000000", 101), Err("level.value: 101 % is outside 0..100 %".to_owned()));
}

#[test]
fn without_a_kind_the_identifier_says_whether_a_frame_asks_or_answers() {
    let levels = feature("addressing");
    for text in ["0043F003#FF00000000000000", "004303F0#3200000000000000"] {
        assert_eq!(changed(&levels, text, |content| content.kind = None).as_deref(), Ok(text));
    }
}

#[test]
fn a_request_to_an_undocumented_address_is_refused() {
    let levels = feature("addressing");
    let to = |target| changed(&levels, "004303F0#3200000000000000", |content| content.identifier[3].1 = target);
    assert_eq!(to(0x3B).as_deref(), Ok("00433BF0#3200000000000000"));
    assert!(to(0x3C).is_err() && to(0x100).is_err());
}

#[test]
fn selectors_of_another_message_are_refused() {
    let registers = feature("register_table");
    let selector =
        |index: usize, value| changed(&registers, "413#41F00021442F0000", |content| content.selectors[index].1 = value);
    assert_eq!(selector(1, 0xF2).as_deref(), Ok("413#41F20021442F0000"));
    assert!(selector(0, 0x42).is_err() && selector(1, 0x100).is_err() && selector(2, 0x22).is_err());
}

#[test]
fn without_a_name_the_selectors_choose_the_access() {
    let registers = feature("register_table");
    for text in ["013#1000002100000000", "013#03000021442F0000"] {
        assert_eq!(changed(&registers, text, |content| content.access = None).as_deref(), Ok(text));
    }
}

#[test]
fn the_set_bits_of_a_status_word_are_sent_by_name() {
    let status = feature("status_word");
    let state = |set: &[&str], unknown| {
        let set = set.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let input = Input::Status { set, unknown };
        changed(&status, "443#0000000000000000", |content| content.signals[0].1 = input.clone())
    };
    assert_eq!(state(&["fan_fault", "hot"], 0x4000).as_deref(), Ok("443#0000420200000000"));
    assert!(state(&["cold"], 0).is_err() && state(&[], 0x0200).is_err());
}
