//! From frames to values.

use canspec_codegen::interpret::{Form, Frame, Problem, Value, decode, recognise};
use canspec_codegen::model::Protocol;

use super::{WIDE, decoded, feature, frame, message, model, note_texts, notes, problem, protocol, values, written};

fn named(name: &str) -> Value {
    Value::Name(name.to_owned())
}

fn all<const N: usize>(values: [(&str, Value); N]) -> Vec<(String, Value)> {
    values.map(|(name, value)| (name.to_owned(), value)).to_vec()
}

#[test]
fn numbers_are_scaled_and_keep_their_sign() {
    // Low byte first: FEAA73 is -22 above 2675, and 2675 * 0.02 = 53.5; 6E is 110 half degrees above -40.
    let expected = all([
        ("voltage", Value::Number(53.5)),
        ("current", Value::Number(-2.2)),
        ("temperature", Value::Number(15.0)),
        ("power", Value::Number(4500.0)),
        ("output", Value::Integer(1)),
        ("mode", Value::Integer(1)),
        ("counter", Value::Integer(17)),
    ]);
    assert_eq!(values(&feature("little_endian"), "083#73AAFE6E28230311"), expected);
    // 0xFFFA00 is -1536 of 1024 steps a volt, 0xFFFE is -2.
    let expected = all([("drift", Value::Number(-1.5)), ("turns", Value::Integer(-2))]);
    assert_eq!(values(&feature("short_frames"), "283#0000FAFFFEFF"), expected);
}

/// Constants that different messages call differently share byte 0.
const CALLED_TWICE: &str = r#"
canspec: 1
protocol: called_twice
title: A battery
document: {title: Made up, version: "1"}
length: 4
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
addressing: {battery: {request: {sender: 0}, one: {sender: 1}}}
access: {report: {report: {}, answers: {battery: one}}}
messages:
  one:   {section: "1", match: {command: 2}, access: [report], fields: {kind: {bytes: 0, const: 1}, level: {bytes: 2}}}
  two:   {section: "1", match: {command: 2}, access: [report], fields: {sort: {bytes: 0, const: 2}, level: {bytes: 2}}}
  three: {section: "1", match: {command: 3}, access: [report], fields: {kind: {bytes: 0, const: 1}, level: {bytes: 2}}}
  four:  {section: "1", match: {command: 3}, access: [report], fields: {both: {bytes: 0..1, const: 0x0302}}}
"#;

#[test]
fn a_byte_that_chooses_no_message_is_named_once() {
    let battery = written(CALLED_TWICE);
    let text = |frame_text| decode(&battery, None, &frame(frame_text)).expect_err("no message has it").text;
    assert_eq!(text("005#04000000"), "no report has kind 0x04");
    assert_eq!(text("007#04000000"), "no report has both 0x0400");
}

#[test]
fn a_special_value_is_read_as_its_name() {
    let values = values(&feature("little_endian"), "083#73AA0EFF28230311");
    assert_eq!(values[2], ("temperature".to_owned(), named("broken")));
}

#[test]
fn a_float_is_read_as_the_number_it_is() {
    // 0x442F0000 is 700, 0x7FC00000 is no number.
    let registers = feature("register_table");
    assert_eq!(values(&registers, "413#41F00021442F0000"), all([("value", Value::Number(700.0))]));
    assert_eq!(values(&registers, "413#41F000217FC00000"), all([("value", Value::None)]));
    assert_eq!(notes(&registers, "413#41F000217FC00000"), ["not_finite"]);
}

#[test]
fn on_and_off_are_read_as_their_names_and_other_values_as_none() {
    let switches = feature("named_values");
    assert_eq!(values(&switches, "5A3#000A0A0000000000"), all([("power", named("on")), ("lamp", named("dark"))]));
    assert_eq!(values(&switches, "5A3#01F00F0000000000"), all([("power", named("off")), ("lamp", named("bright"))]));
    assert_eq!(values(&switches, "5A3#020A0A0000000000")[0].1, Value::None);
    assert_eq!(notes(&switches, "5A3#020A0A0000000000"), ["unknown_value"]);
}

#[test]
fn a_status_word_shows_its_set_bits_by_number() {
    // 0x8201: bit 15 has no name, bits 9 and 0 have one; 0x32 is red 3 and green 2.
    let status = feature("status_word");
    let state = Value::Status { set: 0x0201, unknown: 0x8000 };
    let expected = all([("state", state), ("red", Value::Integer(3)), ("green", Value::Integer(2))]);
    assert_eq!(values(&status, "443#0000820100320000"), expected);
    assert_eq!(notes(&status, "443#0000820100320000"), ["unknown_bit"]);
}

#[test]
fn set_bits_that_nothing_covers_are_reserved() {
    // Of byte 5 the bits 5, 4, 1 and 0 are signals.
    let decoded = decoded(&feature("status_word"), "443#0100000000FF0080");
    assert_eq!(decoded.reserved, [1, 0, 0, 0, 0, 0xCC, 0, 0x80]);
}

#[test]
fn a_frame_shows_its_addressing_mode() {
    let levels = feature("addressing");
    let mode = |text| decoded(&levels, text).addressing.map(|travel| levels[travel.mode].name.as_str());
    assert_eq!(mode("004303F0#3200000000000000"), Some("single"));
    assert_eq!(mode("008307F0#3200000000000000"), Some("group"));
    assert_eq!(mode("00433FF0#3200000000000000"), Some("all"));
    assert_eq!(mode("00C303F0#3200000000000000"), None);
    let values = decoded(&levels, "0083F103#3200000000000000").identifier(&levels).map(|(_, value)| value);
    assert_eq!(values.collect::<Vec<_>>(), [0, 2, 3, 0xF1, 3]);
}

#[test]
fn an_address_beyond_the_last_one_gets_a_note() {
    let levels = feature("addressing");
    assert_eq!(notes(&levels, "00433BF0#3200000000000000"), [""; 0]);
    assert_eq!(notes(&levels, "00433CF0#3200000000000000"), ["address"]);
    assert_eq!(problem(&levels, "004303F9#3200000000000000"), Some(Problem::Identifier));
}

#[test]
fn a_value_beyond_its_range_gets_a_note() {
    let levels = feature("addressing");
    assert_eq!(notes(&levels, "004303F0#6400000000000000"), [""; 0]);
    assert_eq!(notes(&levels, "004303F0#6500000000000000"), ["out_of_range"]);
}

#[test]
fn the_note_of_a_wide_number_has_all_its_digits() {
    let wide = written(WIDE);
    let note = note_texts(&wide, "011#FFFFFFFFFFFFFFFF");
    assert_eq!(note, ["value 18446744073709551615 is outside 0..1000"]);
    let note = note_texts(&wide, "021#0100000000000080");
    assert_eq!(note, ["value -9223372036854775807 is outside 0..1000"]);
}

#[test]
fn a_float_meets_its_limits_as_nearly_as_it_can_and_a_scaled_number_exactly() {
    let wide = written(WIDE);
    // The floats nearest to 0.7 and 1.1 are 0.69999999 and 1.10000002; beyond them are 3F333332 and 3F8CCCCE.
    let of_float = |bits: &str| notes(&wide, &format!("031#{bits}00000000")).len();
    assert_eq!(["3F333332", "3F333333", "3F8CCCCD", "3F8CCCCE"].map(of_float), [1, 0, 0, 1]);
    // The float nearest to 16777.218 is 16777.21875, and 16777.2187 lies between the two.
    let of_scaled = |raw: u32| notes(&wide, &format!("041#{raw:08X}00000000")).len();
    assert_eq!([167_772_180, 167_772_187].map(of_scaled), [0, 1]);
}

#[test]
fn decimal_digits_are_a_number_unless_one_is_above_nine() {
    let wide = written(WIDE);
    let said = |bits: &str| notes(&wide, &format!("051#{bits}000000000000"));
    for bits in ["0500", "0010", "FFFF"] {
        assert!(said(bits).is_empty(), "{bits}");
    }
    for bits in ["0501", "0009"] {
        assert_eq!(said(bits), ["out_of_range"], "{bits}");
    }
    assert_eq!(said("04A9"), ["unknown_value"]);
}

#[test]
fn a_text_ends_before_the_bytes_that_fill_it_up_and_no_other_byte_may_follow() {
    let text = feature("text");
    let said = |bytes: &str| notes(&text, &format!("463#{bytes}00000000"));
    for bytes in ["41312020", "20413142", "20202020"] {
        assert!(said(bytes).is_empty(), "{bytes}");
    }
    for bytes in ["41310000", "41200020", "412020FF"] {
        assert_eq!(said(bytes), ["unknown_value"], "{bytes}");
    }
}

#[test]
fn an_error_code_gets_a_note() {
    assert_eq!(notes(&feature("addressing"), "0443F003#3200000000000000"), ["error_code"]);
    let registers = feature("register_table");
    assert_eq!(notes(&registers, "413#41F10021442F0000"), ["error_code"]);
    assert_eq!(notes(&registers, "413#41F00021442F0000"), [""; 0]);
}

#[test]
fn what_is_no_frame_of_the_protocol_is_named() {
    let registers = feature("register_table");
    assert_eq!(problem(&registers, "413#42F00021442F0000"), Some(Problem::UnknownMessage));
    assert_eq!(problem(&registers, "413#41F00022442F0000"), Some(Problem::UnknownMessage));
    assert_eq!(problem(&registers, "423#41F00021442F0000"), Some(Problem::UnknownMessage));
    assert_eq!(problem(&registers, "413#41F00021442F00"), Some(Problem::Length));
    assert_eq!(problem(&registers, "00000413#41F00021442F0000"), Some(Problem::Identifier));
    let report = feature("little_endian");
    assert_eq!(problem(&report, "003#73AA0E6E28230311"), Some(Problem::Foreign));
    assert_eq!(problem(&report, "103#73AA0E6E28230311"), Some(Problem::Identifier));
}

#[test]
fn the_identifier_is_split_only_if_it_is_of_the_protocol() {
    let report = feature("little_endian");
    let split =
        |frame: &Frame| decode(&report, None, frame).map_err(|why| (why.problem, why.identifier.iter().count()));
    let own = frame("103#73AA0E6E28230311");
    assert_eq!(split(&Frame { form: Form::Remote, ..own.clone() }).err(), Some((Problem::Frame, 0)));
    assert_eq!(split(&frame("003#73AA0E6E28230311")).err(), Some((Problem::Foreign, 0)));
    let registers = feature("register_table");
    let unknown = decode(&registers, None, &frame("423#41F00021442F0000")).expect_err("there is no such command");
    assert_eq!(unknown.identifier.iter().copied().collect::<Vec<_>>(), [1, 2, 3]);
}

#[test]
fn what_the_identifier_alone_decided_is_known_of_frames_that_differ_in_their_data() {
    let winches = protocol("tests/downstream/specs/winch.yaml");
    let first = frame("0B211201#00000000");
    let known = recognise(&winches, None, &first).expect("a frame of the winch");
    let other = frame("0B211201#12345678");
    assert!(known.is_known_of(&other));
    assert_eq!(known.decode(&other), decode(&winches, None, &other).expect("a frame of the winch"));
    for unlike in [
        frame("0B211202#12345678"),
        frame("0B211201#123456"),
        Frame { form: Form::Remote, ..other.clone() },
        Frame { extended: false, ..other.clone() },
    ] {
        assert!(!known.is_known_of(&unlike), "{unlike}");
    }
    let registers = feature("register_table");
    let read = frame("413#41F00021442F0000");
    assert!(!recognise(&registers, None, &read).expect("a register").is_known_of(&read));
}

#[test]
fn each_fixed_bit_of_the_identifier_counts() {
    // Bits 28 to 24 are 01011.
    let winches = protocol("tests/downstream/specs/winch.yaml");
    assert_eq!(problem(&winches, "0B211201#00000000"), None);
    for id in ["1B211201", "03211201", "0F211201", "09211201", "0A211201"] {
        assert_eq!(problem(&winches, &format!("{id}#00000000")), Some(Problem::Identifier), "{id}");
    }
}

#[test]
fn of_messages_that_look_the_same_the_device_model_chooses() {
    let pumps = feature("model_layouts");
    assert_eq!(message(&pumps, None, "003#12C0"), "supply_ac");
    assert_eq!(message(&pumps, Some(model(&pumps, "P_10A")), "003#12C0"), "supply_ac");
    assert_eq!(message(&pumps, Some(model(&pumps, "P_48V_DC")), "003#12C0"), "supply_dc");
}

/// Two device models that each report from an end of their own.
const ENDS: &str = r#"
canspec: 1
protocol: ends
title: Two ends
document: {title: Ends, version: "1"}
length: 1
identifier: {command: {bits: 10..2}, end: {bits: 1}, sender: {bits: 0}}
addressing:
  left:  {request: {end: 0, sender: 0}, one: {end: 0, sender: 1}}
  right: {request: {end: 1, sender: 0}, one: {end: 1, sender: 1}}
access:
  report_left:  {report: {}, answers: {left: one}}
  report_right: {report: {}, answers: {right: one}}
messages:
  left:  {section: "1", match: {command: 1}, access: [report_left], models: [L], value: {bytes: 0}}
  right: {section: "1", match: {command: 1}, access: [report_right], models: [R], value: {bytes: 0}}
models: {L: {section: "1"}, R: {section: "1"}}
"#;

#[test]
fn the_message_of_another_model_is_noted_only_if_the_frame_can_be_that_one() {
    let ends = written(ENDS);
    // Command 1 is bit 2, the right end bit 1, a report bit 0.
    assert_eq!((message(&ends, None, "005#07"), notes(&ends, "005#07")), ("left", vec![]));
    assert_eq!((message(&ends, None, "007#07"), notes(&ends, "007#07")), ("right", vec![]));
    assert_eq!(notes(&feature("model_layouts"), "003#08FC"), ["model_dependent"]);
}

/// One frame that is another message on each of three kinds of devices.
const KINDS: &str = r#"
canspec: 1
protocol: kinds
title: Three kinds
document: {title: Kinds, version: "1"}
length: 1
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
addressing: {all: {request: {sender: 0}, one: {sender: 1}}}
access: {read: {request: {}, reply: {}, in: [reply], answers: {all: one}}, report: {report: {}, answers: {all: one}}}
messages:
  speed: {section: "1", match: {command: 1}, access: [report], models: [A], value: {bytes: 0, unit: rpm}}
  power: {section: "1", match: {command: 1}, access: [report], models: [B, C], value: {bytes: 0, unit: W}}
  level: {section: "1", match: {command: 1}, access: [report], models: [D], value: {bytes: 0, unit: "%"}}
models: {A: {section: "1"}, B: {section: "1"}, C: {section: "1"}, D: {section: "1"}}
"#;

#[test]
fn the_note_of_a_message_that_depends_on_the_model_names_each_of_the_others() {
    let texts = note_texts(&written(KINDS), "003#07");
    assert_eq!(texts, ["it is `power` if the model is B or C, and `level` if the model is D"]);
}

#[test]
fn a_frame_of_a_set_is_its_member_by_the_access_of_the_set() {
    let ovens = protocol("tests/downstream/specs/oven.yaml");
    let shown = |text: &str| {
        let decoded = decoded(&ovens, text);
        let set = decoded.set.map(|set| ovens.messages[set].name.as_str());
        (ovens.messages[decoded.message].name.as_str(), ovens.accesses[decoded.access].name.as_str(), set)
    };
    assert_eq!(shown("486#01000907"), ("temperature", "scan", Some("measured")));
    assert_eq!(shown("4A7#01000907"), ("temperature", "scan", Some("identity")));
    assert_eq!(shown("446#01000907"), ("temperature", "read", None));
    assert_eq!(shown("086#00000000"), ("measured", "scan", None));
    assert_eq!(problem(&ovens, "486#03001234"), Some(Problem::UnknownMessage));
    assert_eq!(notes(&ovens, "487#02070000"), ["error_code"]);
}

#[test]
fn a_word_of_the_header_that_stands_in_a_type_tells_an_error_reply_and_the_end_of_a_set() {
    let spec = r#"
canspec: 1
protocol: typed_header
title: Words of types
document: {title: Made up, version: "1"}
length: 8
identifier: {direction: {bits: 10}, command: {bits: 9..4}, node: {bits: 3..0}}
header: {flags: {bytes: 0, type: flags}}
types:
  node: {range: 1..9}
  flags: {fields: {result: {bits: 7..4, normal: 0}, more: {bits: 3..0, continues: 1}}}
addressing: {single: {request: {direction: 0, node: node}, one: {direction: 1, node: node}}}
access: {read: {request: {}, reply: {}, in: [reply], answers: {single: one}}}
messages: {heat: {section: "1", match: {command: 1, more: 0}, access: [read], value: {bytes: 1}}}
"#;
    let protocol = written(spec);
    assert_eq!(notes(&protocol, "411#2007000000000000"), ["error_code"]);
    assert_eq!(protocol.continuation().map(|field| field.raw), Some(1));
}

#[test]
fn a_group_has_signals_of_its_own_wherever_it_is_used() {
    let groups = feature("groups");
    let signals = groups.messages.iter().flat_map(|message| &message.signals);
    let names: Vec<_> = signals.map(|signal| signal.name.as_str()).collect();
    let fields = ["level", "pack", "cell_1", "cell_2"];
    let [alarms, warnings] = ["alarms", "warnings"].map(|of| fields.map(|field| format!("{of}_{field}")));
    assert!(alarms.iter().chain(&warnings).all(|name| names.contains(&name.as_str())), "{names:?}");
    assert_eq!((names.len(), groups.enumerations.len()), (8, 1));
    // 0x0168 and 0x0902: one half of a volt and 9 of them; bit 3 and bits 1..0.
    let found = values(&groups, "103#01680209");
    let value = |name: &str| found.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone());
    assert_eq!(value("alarms_level"), Some(Value::Number(0.5)));
    assert_eq!(value("warnings_level"), Some(Value::Number(4.5)));
    assert_eq!([value("alarms_cell_1"), value("alarms_cell_2")], [0, 1].map(|bit| Some(Value::Integer(bit))));
    assert_eq!(value("alarms_pack"), Some(Value::Name("off".to_owned())));
    assert_eq!(value("warnings_pack"), Some(Value::None));
}

/// Nothing but the addresses shows the direction.
const UNDIRECTED: &str = r#"
canspec: 1
protocol: undirected
title: Heaters
document: {title: Made up, version: "1"}
length: 1
identifier: {rest: {bits: 10..8, const: 0}, target: {bits: 7..4}, source: {bits: 3..0}}
types: {host: {range: 12..12, outside: refused, send: 12}, heater: {range: 1..9, outside: refused}}
addressing: {one: {request: {target: heater, source: host}, one: {target: host, source: heater}}}
access: {read: {request: {}, reply: {}, in: [reply], answers: {one: one}}}
messages: {heat: {section: "1", access: [read], value: {bytes: 0}}}
"#;

/// Returns why a frame is not recognised, and what its identifier shows.
fn unrecognised(protocol: &Protocol, text: &str) -> (String, Vec<u32>) {
    let unrecognised = decode(protocol, None, &frame(text)).expect_err("no frame of the protocol");
    (unrecognised.text, unrecognised.identifier.iter().copied().collect())
}

#[test]
fn an_identifier_without_a_direction_names_what_no_mode_has() {
    let undirected = written(UNDIRECTED);
    let text = |id: &str| unrecognised(&undirected, &format!("{id}#00")).0;
    assert_eq!(text("0A1"), "no addressing mode has target 0x0A; they have 0x01..0x09, 0x0C");
    assert_eq!(text("09F"), "no addressing mode has source 0x0F; they have 0x01..0x09, 0x0C");
    assert_eq!(text("000"), "no addressing mode has target 0x00; they have 0x01..0x09, 0x0C");
    // Each address is one of some mode.
    for id in ["011", "099", "0CC"] {
        assert_eq!(text(id), "the addresses do not show whether it goes to a module or to the controller");
    }
}

#[test]
fn an_identifier_of_the_right_width_shows_its_fields() {
    let undirected = written(UNDIRECTED);
    let shown = |text: &str| unrecognised(&undirected, text).1;
    assert_eq!([shown("0A1#00"), shown("1C1#00")], [[0, 10, 1], [1, 12, 1]]);
    let other = unrecognised(&undirected, "000000A1#00");
    assert_eq!(other, ("the identifier has 29 bits instead of 11".to_owned(), vec![]));
}

#[test]
fn a_wrong_length_is_told_with_those_that_fit_the_addresses() {
    let why = |spec: &Protocol, text| decode(spec, None, &frame(text)).err().map(|why| why.text);
    let charger = feature("optional_fields");
    assert_eq!(why(&charger, "521#8A0C020103").as_deref(), Some("5 data bytes instead of 3 or 4 or 7"));
    assert_eq!(why(&charger, "521#8A").as_deref(), Some("1 data byte instead of 3 or 4 or 7"));
    let units = written(
        r#"
canspec: 1
protocol: units
title: Units
document: {title: Made up, version: "1"}
length: 8
identifier: {command: {bits: 10..4}, node: {bits: 3..0}}
types: {unit: {range: 1..9}}
addressing: {all: {request: {node: 0}}, single: {request: {node: unit}}}
access: {tell: {request: {}, answers: {all: nobody}}, order: {request: {}, answers: {single: nobody}}}
messages:
  stop:  {section: "1", match: {command: 1}, length: 2, access: [tell], value: {bytes: 0}}
  start: {section: "1", match: {command: 1}, length: 4, access: [order], value: {bytes: 0}}
"#,
    );
    assert_eq!(why(&units, "010#000000").as_deref(), Some("3 data bytes instead of 2"));
    assert_eq!(why(&units, "011#000000").as_deref(), Some("3 data bytes instead of 4"));
}
