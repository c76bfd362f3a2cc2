//! Fields, status bits and named values that only some device models have.

use canspec_codegen::interpret::{Content, decode, encode};
use canspec_codegen::model::Protocol;

use super::{feature, frame, model, note_texts, requested, written};

/// Bits without a name are sent as 1. So a field that a model does not have is all ones.
const FILLED: &str = r#"
canspec: 1
protocol: filled
title: A battery
document: {title: Made up, version: "1"}
length: 2
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
reserved: {send: 1}
addressing: {battery: {request: {sender: 0}, one: {sender: 1}}}
access: {set: {request: {}, reply: {}, answers: {battery: one}}}
messages:
  set_limits:
    section: "1"
    match: {command: 2}
    access: [set]
    fields: {current: {bytes: 0}, heating: {bytes: 1, range: 10..200, models: [NEW]}}
models: {OLD: {section: "1"}, NEW: {section: "1"}}
"#;

/// Returns the notes of a frame for a device model.
fn notes(battery: &Protocol, name: &str, text: &str) -> Vec<String> {
    let decoded = decode(battery, Some(model(battery, name)), &frame(text)).expect("a frame of the protocol");
    decoded.notes.into_iter().map(|note| format!("{}: {}", note.rule, note.text)).collect()
}

#[test]
fn what_the_model_does_not_have_gets_a_note_where_bits_show_it() {
    let battery = feature("revisions");
    assert_eq!(notes(&battery, "V1_2", "005#32640100"), ["model_dependent: V1_2 has no `heating`"]);
    assert_eq!(notes(&battery, "V1_2", "005#32000300"), ["model_dependent: `alarms` of V1_2 has no `cold`"]);
    assert_eq!(notes(&battery, "V1_2", "005#32000100"), [""; 0]);
    assert_eq!(notes(&battery, "V1_3", "005#32000300"), ["out_of_range: heating 0 is outside 10..200"]);
    assert_eq!(note_texts(&battery, "005#32640300"), [""; 0]);
}

#[test]
fn a_request_to_a_model_leaves_out_what_it_does_not_have() {
    let battery = feature("revisions");
    let asked = |name: &str, signals: &[(&str, &str)]| {
        let model = Some(model(&battery, name));
        requested(&battery, model, "set_limits", "battery", signals).map_err(|refusal| refusal.0)
    };
    let (current, heating) = (("current", "50A"), ("heating", "100"));
    assert_eq!(asked("V1_2", &[current, ("alarms", "[hot]")]).as_deref(), Ok("004#32000100"));
    assert_eq!(asked("V1_3", &[current, heating, ("alarms", "[cold]")]).as_deref(), Ok("004#32640200"));
    let refused = [
        (asked("V1_2", &[current, heating, ("alarms", "[]")]), "set_limits.heating: V1_2 has no `heating`"),
        (asked("V1_2", &[current, ("alarms", "[cold]")]), "set_limits.alarms: `alarms` of V1_2 has no `cold`"),
        (asked("V1_3", &[current, ("alarms", "[]")]), "set_limits: the signal `heating` is missing"),
    ];
    for (asked, expected) in refused {
        assert_eq!(asked, Err(expected.to_owned()));
    }
}

#[test]
fn a_frame_comes_back_unless_it_asks_a_model_for_what_it_does_not_have() {
    let battery = feature("revisions");
    let comes_back = |name: Option<&str>, text: &str| {
        let model = name.map(|name| model(&battery, name));
        let decoded = decode(&battery, model, &frame(text)).expect("a frame of the protocol");
        encode(&battery, model, &Content::of(&battery, &decoded)).is_ok_and(|encoded| encoded == frame(text))
    };
    assert!(comes_back(Some("V1_2"), "004#32000100"), "nothing that it lacks");
    assert!(comes_back(Some("V1_2"), "005#32640200"), "a reply can hold anything");
    assert!(comes_back(None, "004#32640200"), "no model is chosen");
    assert!(!comes_back(Some("V1_2"), "004#32640000"));
    assert!(!comes_back(Some("V1_2"), "004#32000200"));
}

#[test]
fn a_field_that_a_model_does_not_have_is_sent_as_reserved_bits_are() {
    let battery = written(FILLED);
    let old = Some(model(&battery, "OLD"));
    let made = requested(&battery, old, "set_limits", "battery", &[("current", "5")]);
    assert_eq!(made.map_err(|refusal| refusal.0).as_deref(), Ok("004#05FF"));
    assert_eq!(notes(&battery, "OLD", "004#05FF"), [""; 0]);
    assert_eq!(notes(&battery, "OLD", "004#0500"), ["model_dependent: OLD has no `heating`"]);
}

#[test]
fn a_named_value_keeps_its_name_on_a_model_that_does_not_have_it_and_is_never_asked_of_it() {
    let battery = feature("values_by_model");
    assert_eq!(notes(&battery, "V1_2", "007#02050000"), ["model_dependent: `mode` of V1_2 has no `boost`"]);
    assert_eq!(notes(&battery, "V1_2", "007#00FE0000"), ["model_dependent: `delay` of V1_2 has no `at_once`"]);
    assert_eq!(notes(&battery, "V1_2", "007#00FF0000"), [""; 0]);
    assert_eq!(notes(&battery, "V1_3", "007#02FE0000"), [""; 0]);
    let asked = |name: Option<&str>, mode, delay| {
        let model = name.map(|name| model(&battery, name));
        let signals = [("mode", mode), ("delay", delay)];
        requested(&battery, model, "set_mode", "battery", &signals).map_err(|refusal| refusal.0)
    };
    assert_eq!(asked(Some("V1_2"), "idle", "never").as_deref(), Ok("006#00FF0000"));
    assert_eq!(asked(Some("V1_3"), "boost", "at_once").as_deref(), Ok("006#02FE0000"));
    assert_eq!(asked(None, "boost", "at_once").as_deref(), Ok("006#02FE0000"));
    let refused = [
        (asked(Some("V1_2"), "boost", "5s"), "set_mode.mode: `mode` of V1_2 has no `boost`"),
        (asked(Some("V1_2"), "idle", "at_once"), "set_mode.delay: `delay` of V1_2 has no `at_once`"),
        (asked(Some("V1_2"), "idle", "101s"), "set_mode.delay: 101 s is outside 0..100 s"),
    ];
    for (asked, expected) in refused {
        assert_eq!(asked, Err(expected.to_owned()));
    }
}

/// Only the frames of NEW reach its field.
const LONGER: &str = r#"
canspec: 1
protocol: longer
title: A battery
document: {title: Made up, version: "1"}
length: 2
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
addressing: {battery: {request: {sender: 0}, one: {sender: 1}}}
access: {set: {request: {}, reply: {}, answers: {battery: one}}}
messages:
  state:
    section: "1"
    match: {command: 2}
    access: [set]
    length: [2, 4]
    fields: {charge: {bytes: 0..1, range: 0..100}, heating: {bytes: 2..3, range: 0..200, models: [NEW]}}
models: {OLD: {section: "1"}, NEW: {section: "1"}}
"#;

#[test]
fn what_the_model_has_is_asked_for_though_others_have_a_shorter_frame() {
    let battery = written(LONGER);
    let asked = |name: &str, signals: &[(&str, &str)]| {
        let model = Some(model(&battery, name));
        requested(&battery, model, "state", "battery", signals).map_err(|refusal| refusal.0)
    };
    let (charge, heating) = (("charge", "84"), ("heating", "96"));
    assert_eq!(asked("OLD", &[charge]).as_deref(), Ok("004#0054"));
    assert_eq!(asked("NEW", &[charge, heating]).as_deref(), Ok("004#00540060"));
    assert_eq!(asked("NEW", &[charge]), Err("state: the signal `heating` is missing".to_owned()));
    assert_eq!(asked("OLD", &[charge, heating]), Err("state.heating: OLD has no `heating`".to_owned()));
    assert_eq!(requested(&battery, None, "state", "battery", &[charge]).ok().as_deref(), Some("004#0054"));
}

#[test]
fn a_frame_that_is_long_enough_for_what_the_model_does_not_have_gets_a_note() {
    let battery = written(LONGER);
    let longer = "model_dependent: OLD has no `heating`, for which the message is long enough";
    assert_eq!(notes(&battery, "OLD", "005#00540000"), [longer]);
    assert_eq!(notes(&battery, "OLD", "005#00540060"), ["model_dependent: OLD has no `heating`"]);
    assert_eq!(notes(&battery, "OLD", "005#0054"), [""; 0]);
    assert_eq!(notes(&battery, "NEW", "005#00540000"), [""; 0]);
}

#[test]
fn a_hidden_field_comes_back_as_its_blank_bits() {
    let battery = written(LONGER);
    for (name, text, shown) in [
        ("OLD", "005#00540000", &["charge"][..]),
        ("OLD", "005#00540060", &["charge", "heating"]),
        ("NEW", "005#00540000", &["charge", "heating"]),
        ("OLD", "005#0054", &["charge"]),
    ] {
        let (model, frame) = (Some(model(&battery, name)), frame(text));
        let mut decoded = decode(&battery, model, &frame).expect("a frame of the protocol");
        decoded.hide_lacking(&battery);
        let content = Content::of(&battery, &decoded);
        let names: Vec<_> = content.signals.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, shown, "{name} {text}");
        assert_eq!(encode(&battery, model, &content).map(|made| made.data), Ok(frame.data), "{name} {text}");
    }
}
