//! Fields of long messages that only some device models have.

use canspec_codegen::interpret::{Assembled, Content, Target, encode_long, requests};
use canspec_codegen::model::{ModelId, Protocol};

use super::assembled::assembled_on;
use super::{model, printed, written};

/// What only the longer message of NEW has: a heating.
const FAST_PACKETS: &str = r#"
canspec: 1
protocol: packets
title: A battery
document: {title: Made up, version: "1"}
length: 8
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
addressing: {battery: {request: {sender: 0}, one: {sender: 1}}}
access: {set: {request: {}, reply: {}, answers: {battery: one}}}
messages:
  state:
    section: "1"
    match: {command: 2}
    access: [set]
    parts: {number: {bytes: 0, bits: 4..0}, counter: {bytes: 0, bits: 7..5}, first: 0, data: 1..7, length: {bytes: 1}}
    length: [2, 9]
    fields: {charge: {bytes: 0..1, range: 0..100}, heating: {bytes: 7..8, range: 0..200, models: [NEW]}}
models: {OLD: {section: "1"}, NEW: {section: "1"}}
"#;

const ISOTP: &str = r#"
canspec: 1
protocol: diagnosed
title: A battery
document: {title: Made up, version: "1"}
length: 8
identifier: {node: {bits: 10..0}}
header: {service: {bytes: 0}}
addressing: {battery: {request: {node: 0x7E0}, one: {node: 0x7E8}}}
access: {set: {request: {service: 0x2E}, reply: {service: 0x6E}, answers: {battery: one}}}
transports: {tp: {kind: isotp, section: "1"}}
messages:
  state:
    section: "1"
    access: [set]
    via: tp
    length: [3, 10]
    fields: {charge: {bytes: 1..2, range: 0..100}, heating: {bytes: 8..9, range: 0..200, models: [NEW]}}
models: {OLD: {section: "1"}, NEW: {section: "1"}}
"#;

const J1939: &str = r#"
canspec: 1
protocol: vehicle
title: A battery
document: {title: Made up, version: "1"}
length: 8
identifier:
  priority: {bits: 28..26, send: 6}
  page:     {bits: 25..24, const: 0}
  format:   {bits: 23..16}
  target:   {bits: 15..8}
  source:   {bits: 7..0}
addressing: {battery: {request: {target: 0xF4, source: 0x56}, one: {target: 0x56, source: 0xF4}}}
access: {set: {request: {format: 1}, reply: {format: 2}, answers: {battery: one}}}
transports: {tp: {section: "1", kind: j1939, group: [page, format, target], target: target, source: source}}
messages:
  state:
    section: "1"
    access: [set]
    via: tp
    length: [2, 9]
    fields: {charge: {bytes: 0..1, range: 0..100}, heating: {bytes: 7..8, range: 0..200, models: [NEW]}}
models: {OLD: {section: "1"}, NEW: {section: "1"}}
"#;

/// A spec, and the requests of 84 % alone, with 96 W, and with a heating that is 0.
type Carried = (&'static str, [&'static [&'static str]; 3]);

const CARRIED: [Carried; 3] = [
    (
        FAST_PACKETS,
        [
            &["004#0002005400000000"],
            &["004#0009005400000000", "004#0100006000000000"],
            &["004#0009005400000000", "004#0100000000000000"],
        ],
    ),
    (
        ISOTP,
        [
            &["7E0#032E0054CCCCCCCC"],
            &["7E0#100A2E0054000000", "7E0#2100000060CCCCCC"],
            &["7E0#100A2E0054000000", "7E0#2100000000CCCCCC"],
        ],
    ),
    (
        J1939,
        [
            &["1801F456#0054"],
            &["18ECF456#10090002FF000100", "18EBF456#0100540000000000", "18EBF456#020060FFFFFFFFFF"],
            &["18ECF456#10090002FF000100", "18EBF456#0100540000000000", "18EBF456#020000FFFFFFFFFF"],
        ],
    ),
];

/// Returns the frames of a request to a battery of a device model.
fn asked(battery: &Protocol, name: Option<&str>, signals: &[(&str, &str)]) -> Result<Vec<String>, String> {
    let model = name.map(|name| model(battery, name));
    let target = Target::parse(battery, "battery").expect("it is a target");
    let signals: Vec<_> = signals.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    let made = requests(battery, model, None, "state", &target, None, &signals);
    made.map(|frames| frames.iter().map(printed).collect()).map_err(|refusal| refusal.0)
}

/// Returns the message that some frames carry together.
fn whole(battery: &Protocol, name: &str, frames: &[&str]) -> (ModelId, Assembled<usize>) {
    let model = model(battery, name);
    let (mut ended, _) = assembled_on(battery, Some(model), frames);
    assert_eq!(ended.len(), 1, "{frames:?}");
    (model, ended.remove(0))
}

fn notes(battery: &Protocol, name: &str, frames: &[&str]) -> Vec<String> {
    let (_, whole) = whole(battery, name, frames);
    whole.decoded.notes.iter().map(|note| format!("{}: {}", note.rule, note.text)).collect()
}

/// Returns the names of the signals that are shown, and whether the length is hidden. The frames must come back.
fn shown(battery: &Protocol, name: &str, frames: &[&str]) -> (Vec<String>, bool) {
    let (model, mut whole) = whole(battery, name, frames);
    whole.decoded.hide_lacking(battery);
    let content = Content::of_long(battery, &whole);
    let made = encode_long(battery, Some(model), &content).expect("it was sent");
    assert_eq!(made.iter().map(printed).collect::<Vec<_>>(), frames, "{name}");
    let is_length_hidden = whole.decoded.is_length_hidden(battery, whole.reserved.len());
    if !is_length_hidden && whole.reserved.iter().all(|byte| *byte == 0) {
        let made = encode_long(battery, Some(model), &Content { reserved: Vec::new(), ..content.clone() });
        assert_eq!(made.expect("it was sent").iter().map(printed).collect::<Vec<_>>(), frames, "{name}");
    }
    (content.signals.into_iter().map(|(name, _)| name).collect(), is_length_hidden)
}

#[test]
fn what_the_model_has_of_a_long_message_is_asked_for_though_others_have_a_shorter_one() {
    for (spec, [short, long, _]) in CARRIED {
        let battery = written(spec);
        let (charge, heating) = (("charge", "84"), ("heating", "96"));
        let [short, long] = [short, long].map(|frames| Ok(frames.iter().map(|frame| (*frame).to_owned()).collect()));
        assert_eq!(asked(&battery, Some("OLD"), &[charge]), short);
        assert_eq!(asked(&battery, Some("NEW"), &[charge, heating]), long);
        let missing = Err("state: the signal `heating` is missing".to_owned());
        assert_eq!(asked(&battery, Some("NEW"), &[charge]), missing);
        let lacking = Err("state.heating: OLD has no `heating`".to_owned());
        assert_eq!(asked(&battery, Some("OLD"), &[charge, heating]), lacking);
        assert_eq!(asked(&battery, None, &[charge]), short);
    }
}

#[test]
fn a_long_message_that_is_long_enough_for_what_the_model_does_not_have_gets_a_note() {
    for (spec, [short, long, blank]) in CARRIED {
        let battery = written(spec);
        let longer = "model_dependent: OLD has no `heating`, for which the message is long enough";
        assert_eq!(notes(&battery, "OLD", blank), [longer]);
        assert_eq!(notes(&battery, "OLD", long), ["model_dependent: OLD has no `heating`"]);
        assert_eq!(notes(&battery, "NEW", blank), [""; 0]);
        if spec != J1939 {
            assert_eq!(notes(&battery, "OLD", short), [""; 0]);
        }
    }
}

#[test]
fn a_hidden_field_of_a_long_message_comes_back_as_its_blank_bits() {
    for (spec, [short, long, blank]) in CARRIED {
        // What a battery confirms may be anything.
        let of_battery = |frames: &[&str]| {
            let ids =
                [("004#", "005#"), ("7E0#", "7E8#"), ("2E0054", "6E0054"), ("F456#", "56F4#"), ("000100", "000200")];
            let replaced =
                |frame: &&str| ids.iter().fold((*frame).to_owned(), |text, (from, to)| text.replace(from, to));
            frames.iter().map(replaced).collect::<Vec<_>>()
        };
        let battery = written(spec);
        let check = |name, frames, expected: (&[&str], bool)| {
            let frames = of_battery(frames);
            let (names, is_length_hidden) =
                shown(&battery, name, &frames.iter().map(String::as_str).collect::<Vec<_>>());
            assert_eq!(
                (names, is_length_hidden),
                (expected.0.iter().map(|name| (*name).to_owned()).collect(), expected.1)
            );
        };
        check("OLD", blank, (&["charge"], true));
        check("OLD", long, (&["charge", "heating"], false));
        check("NEW", blank, (&["charge", "heating"], false));
        if spec != J1939 {
            check("OLD", short, (&["charge"], false));
            // A battery says what it likes.
            check("NEW", short, (&["charge"], false));
        }
    }
}

/// A message of 14 bytes on each model, whose bits without a name are sent as 1.
const FIXED: &str = r#"
canspec: 1
protocol: fixed
title: A battery
document: {title: Made up, version: "1"}
length: 8
reserved: {send: 1}
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
addressing: {battery: {request: {sender: 0}, one: {sender: 1}}}
access: {set: {request: {}, reply: {}, answers: {battery: one}}}
messages:
  state:
    section: "1"
    match: {command: 2}
    access: [set]
    parts: {number: {bytes: 0}, first: 0, data: 1..7}
    fields:
      heating: {bytes: 0, range: 10..200, models: [NEW]}
      name:    {bytes: 1..12, as: text, models: [NEW]}
      charge:  {bytes: 13, range: 0..100}
models: {OLD: {section: "1"}, NEW: {section: "1"}}
"#;

#[test]
fn a_long_message_of_one_length_has_blank_bits_for_what_the_model_does_not_have() {
    let battery = written(FIXED);
    let frames = ["004#00FFFFFFFFFFFFFF", "004#01FFFFFFFFFFFF54"];
    let charge = ("charge", "84");
    assert_eq!(asked(&battery, Some("OLD"), &[charge]), Ok(frames.map(str::to_owned).to_vec()));
    assert_eq!(notes(&battery, "OLD", &frames), [""; 0]);
    assert_eq!(shown(&battery, "OLD", &frames), (vec!["charge".to_owned()], false));
    let missing = asked(&battery, Some("NEW"), &[charge, ("heating", "10")]);
    assert_eq!(missing, Err("state: the signal `name` is missing".to_owned()));
    let named = ["005#00FFFFFFFFFFFFFF", "005#01FFFFFFFFFF4154"];
    assert_eq!(notes(&battery, "OLD", &named), ["model_dependent: OLD has no `name`"]);
    assert_eq!(shown(&battery, "OLD", &named), (vec!["name".to_owned(), "charge".to_owned()], false));
}

/// Messages whose length follows from what NEW alone has. Nothing says how many parts are real.
const VARYING: &str = r#"
canspec: 1
protocol: varying
title: A battery
document: {title: Made up, version: "1"}
length: 8
reserved: {send: 1}
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
addressing: {battery: {request: {sender: 0}, one: {sender: 1}}}
access: {set: {request: {}, reply: {}, answers: {battery: one}}}
messages:
  state:
    section: "1"
    match: {command: 2}
    access: [set]
    parts: {number: {bytes: 0}, first: 0, data: 1..7}
    FIELDS
models: {OLD: {section: "1"}, NEW: {section: "1"}}
"#;

#[test]
fn a_message_may_have_more_parts_than_one_of_a_model_without_the_list_or_the_text() {
    let warmth = "fields: {charge: {bytes: 0, range: 0..100}, warmth: {bytes: 1, repeat: 1..13, models: [NEW]}}";
    let label = "fields: {charge: {bytes: 0, range: 0..100}, label: {bytes: 1.., as: text, fill: 0x20, models: [NEW]}}\n    \
                 length: 2..14";
    let beyond = (7..=13).map(|element| format!("warmth_{element}")).collect();
    for (fields, beyond, what) in
        [(warmth, beyond, "elements of `warmth`"), (label, vec!["label".to_owned()], "bytes of `label`")]
    {
        let battery = written(&VARYING.replace("FIELDS", fields));
        let short = ["004#0054FFFFFFFFFFFF"];
        let made = asked(&battery, Some("OLD"), &[("charge", "84")]);
        assert_eq!(made, Ok(short.map(str::to_owned).to_vec()), "{fields}");
        // What fills up the part of OLD is none of its fields.
        assert_eq!(notes(&battery, "OLD", &short), [""; 0]);
        assert_eq!(shown(&battery, "OLD", &short), (vec!["charge".to_owned()], false));
        let long = ["004#0054FFFFFFFFFFFF", "004#01FFFFFFFFFFFFFF"];
        let longer =
            |name: &String| format!("model_dependent: OLD has no `{name}`, for which the message is long enough");
        assert_eq!(notes(&battery, "OLD", &long), beyond.iter().map(longer).collect::<Vec<_>>());
        assert_eq!(shown(&battery, "OLD", &long), (vec!["charge".to_owned()], true));
        let count = format!("count: nothing says how many of the {what} are real");
        assert!(notes(&battery, "NEW", &long).contains(&count), "{what}");
    }
}
