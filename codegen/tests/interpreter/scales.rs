//! Numbers whose scale depends on the device model.

use canspec_codegen::interpret::{Content, Sent, Value, decode, encode, sent};

use super::{feature, frame, model, notes, printed, requested, values, written};

/// A reply has no limits.
const SPEC: &str = r#"
canspec: 1
protocol: meter
title: A meter
document: {title: Made up, version: "1"}
length: 1
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
types: {current: {unit: A, range: 0..10}}
addressing: {meter: {request: {sender: 0}, one: {sender: 1}}}
access: {read: {request: {}, reply: {}, in: [reply], answers: {meter: one}}}
messages: {current: {section: "1", match: {command: 2}, access: [read], value: {bytes: 0, type: current}}}
models:
  FINE:    {section: "1", types: {current: {scale: 1/10}}}
  SHIFTED: {section: "1", types: {current: {scale: 1/2, offset: -40}}}
  OTHER:   {section: "1"}
"#;

/// Each model makes another current of it.
const FRAME: &str = "004#02943200";

#[test]
fn without_a_model_only_the_raw_number_is_known() {
    let rectifier = feature("scales_by_model");
    let found = values(&rectifier, FRAME);
    assert_eq!(found, [("current".to_owned(), Value::None), ("temperature".to_owned(), Value::None)]);
    assert_eq!(notes(&rectifier, FRAME), ["model_dependent", "model_dependent"]);
}

#[test]
fn a_model_says_what_a_step_is() {
    let rectifier = feature("scales_by_model");
    // 660 / 20, 660 / 30, 660 / 1250; 50 / 2, and 50 / 2 - 40.
    let expected = [("R4830", 0.528, 25.0), ("R4850_X20", 33.0, 25.0), ("R4850_X30", 22.0, -15.0)];
    for (name, current, temperature) in expected {
        let decoded = decode(&rectifier, Some(model(&rectifier, name)), &frame(FRAME)).expect("a request");
        let found: Vec<_> = decoded.signals.iter().map(|reading| reading.value.clone()).collect();
        assert_eq!(found, [Value::Number(current), Value::Number(temperature)], "{name}");
        assert_eq!(decoded.notes, [], "{name}");
    }
}

#[test]
fn a_frame_comes_back_with_and_without_a_model() {
    let rectifier = feature("scales_by_model");
    let models = ["R4830", "R4850_X20", "R4850_X30"].map(|name| Some(model(&rectifier, name)));
    for text in [FRAME, "004#01B83200", "004#FFFF3200"] {
        for model in models.into_iter().chain([None]) {
            let decoded = decode(&rectifier, model, &frame(text)).expect("a frame of the protocol");
            let encoded = encode(&rectifier, model, &Content::of(&rectifier, &decoded));
            assert_eq!(encoded.map(|frame| printed(&frame)).as_deref(), Ok(text));
        }
    }
}

#[test]
fn a_physical_value_needs_a_model() {
    let rectifier = feature("scales_by_model");
    let asked = |name: Option<&str>, value| {
        let model = name.map(|name| model(&rectifier, name));
        requested(&rectifier, model, "set_output", "rectifier", &[("current", value), ("temperature", "0°C")])
            .map_err(|refusal| refusal.0)
    };
    let refusal = "set_output.current: its scale depends on the device model; choose R4830, R4850_X20 or R4850_X30";
    for value in ["22A", "22", "0.5"] {
        assert_eq!(asked(None, value), Err(refusal.to_owned()));
    }
    // 22 x 20 = 0x1B8, 22 x 30 = 0x294, and 0.352 x 1250 = 0x1B8.
    assert_eq!(asked(Some("R4850_X20"), "22A").as_deref(), Ok("004#01B80000"));
    assert_eq!(asked(Some("R4850_X30"), "22000mA").as_deref(), Ok("004#02945000"));
    assert_eq!(asked(Some("R4830"), "0.352").as_deref(), Ok("004#01B80000"));
    let beyond = "set_output.current: 50.05 A is outside 0..50 A".to_owned();
    assert_eq!(asked(Some("R4850_X20"), "50.05A"), Err(beyond));
}

#[test]
fn raw_numbers_keep_to_the_widest_raw_limits() {
    let rectifier = feature("scales_by_model");
    let sent = |raw: u16| {
        let text = format!("004#{raw:04X}0000");
        let decoded = decode(&rectifier, None, &frame(&text)).expect("a request");
        encode(&rectifier, None, &Content::of(&rectifier, &decoded)).map_err(|refusal| refusal.0)
    };
    // 53.5 A x 30 = 1605.
    assert!(sent(1605).is_ok());
    let refusal = "set_output.current: 1606 is outside 0..1605, the limits of the models taken together; \
                   choose a model for its own";
    assert_eq!(sent(1606), Err(refusal.to_owned()));
}

#[test]
fn a_module_sends_by_the_scale_of_its_model() {
    let meter = written(SPEC);
    let reply = |name: &str, value: &str| {
        let kind = Some(canspec_codegen::model::Kind::Reply);
        let reply =
            Sent { kind, access: None, model: Some(model(&meter, name)), message: "current", to: None, source: None };
        let values = [("value".to_owned(), value.to_owned())];
        let frames = sent(&meter, reply, &values);
        frames.map(|frames| frames.iter().map(printed).collect::<String>()).map_err(|refusal| refusal.0)
    };
    // 12 x 10 = 0x78, and (12 + 40) x 2 = 0x68.
    assert_eq!(reply("FINE", "12A").as_deref(), Ok("005#78"));
    assert_eq!(reply("SHIFTED", "12A").as_deref(), Ok("005#68"));
    let refusal = "current.value: its scale depends on the device model; choose FINE or SHIFTED";
    assert_eq!(reply("OTHER", "12A"), Err(refusal.to_owned()), "nobody says what its steps are");
}

#[test]
fn a_note_names_the_element_of_an_array_whose_scale_depends_on_the_model() {
    let value = "value: {bytes: 0, type: current}";
    let array = "fields: {phase: {bytes: 0, repeat: 2, type: current}}";
    let meter = written(&SPEC.replace("length: 1", "length: 2").replace(value, array));
    let fine = model(&meter, "FINE");
    let decoded = decode(&meter, Some(fine), &frame("005#0A78")).expect("a reply");
    let found: Vec<_> = decoded.notes.iter().map(|note| note.text.as_str()).collect();
    assert_eq!(found, ["phase_2 12 A is outside 0..10 A"]);
    let on_model = meter[decoded.message].on(Some(fine));
    let places = on_model.signals.iter().map(|signal| (signal.name.as_str(), signal.bytes()));
    assert_eq!(places.collect::<Vec<_>>(), [("phase_1", 0..1), ("phase_2", 1..2)]);
}

/// Steps of a power of two, counted by as many bits as a double has digits.
const WIDE: &str = r#"
canspec: 1
protocol: meter
title: A meter
document: {title: Made up, version: "1"}
length: 8
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
addressing: {meter: {request: {sender: 0}, one: {sender: 1}}}
access: {read: {request: {}, reply: {}, in: [reply], answers: {meter: one}}}
messages:
  sixteens: {section: "1", match: {command: 1}, access: [read], fields: {word: {bytes: 0..7, fields: {level: {bits: 52..0, scale: 16, title: Level}}}}}
  fine:     {section: "1", match: {command: 2}, access: [read], fields: {word: {bytes: 0..7, fields: {level: {bits: 52..0, scale: 1/1024, title: Level}}}}}
  halves:   {section: "1", match: {command: 3}, access: [read], fields: {word: {bytes: 0..7, fields: {level: {bits: 53..0, as: signed, scale: 1/2, offset: 1/2, title: Level}}}}}
  falling:  {section: "1", match: {command: 4}, access: [read], fields: {word: {bytes: 0..7, fields: {level: {bits: 52..0, scale: -1024, title: Level}}}}}
  tenths:   {section: "1", match: {command: 5}, access: [read], fields: {word: {bytes: 0..7, fields: {level: {bits: 49..0, scale: 1/10, title: Level}}}}}
"#;

/// The values are those of Python's fractions, of which each but the tenths is a double.
#[test]
fn steps_of_a_power_of_two_are_exact_to_53_bits_and_come_back() {
    let meter = written(WIDE);
    for (text, value) in [
        ("003#001FFFFFFFFFFFFF", 144_115_188_075_855_856.0),
        ("003#0010000000000001", 72_057_594_037_927_952.0),
        ("005#001FFFFFFFFFFFFF", 9_007_199_254_740_991.0 / 1024.0),
        ("005#0010000000000001", 4_503_599_627_370_497.0 / 1024.0),
        ("007#001FFFFFFFFFFFFF", 4_503_599_627_370_496.0),
        ("007#0020000000000000", -4_503_599_627_370_495.5),
        ("009#001FFFFFFFFFFFFF", -9_223_372_036_854_774_784.0),
        ("00B#0003FFFFFFFFFFFF", 112_589_990_684_262.3),
        ("00B#0003FFFFFFFFFFFE", 112_589_990_684_262.2),
    ] {
        let decoded = decode(&meter, None, &frame(text)).expect("a reply");
        assert_eq!(decoded.signals[0].value, Value::Number(value), "{text}");
        assert_eq!(
            encode(&meter, None, &Content::of(&meter, &decoded)).map(|frame| printed(&frame)).as_deref(),
            Ok(text)
        );
    }
}
