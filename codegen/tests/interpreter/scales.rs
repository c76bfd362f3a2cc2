//! Numbers whose scale depends on the device model.

use canspec_codegen::interpret::{Content, Sent, Value, decode, encode, sent};

use super::{feature, frame, model, notes, printed, requested, values};

/// What R4850_X30 makes of a raw number is a third less than what R4850_X20 makes of it.
const REPLY: &str = "005#02943200";

#[test]
fn without_a_model_only_the_raw_number_is_known() {
    let rectifier = feature("scales_by_model");
    let found = values(&rectifier, REPLY);
    assert_eq!(found, [("current".to_owned(), Value::None), ("temperature".to_owned(), Value::None)]);
    assert_eq!(notes(&rectifier, REPLY), ["model_dependent", "model_dependent"]);
}

#[test]
fn a_model_says_what_a_step_is() {
    let rectifier = feature("scales_by_model");
    // 660 / 20, 660 / 30, 660 / 1250; 50 / 2, and 50 / 2 - 40.
    let expected = [("R4830", 0.528, 25.0), ("R4850_X20", 33.0, 25.0), ("R4850_X30", 22.0, -15.0)];
    for (name, current, temperature) in expected {
        let decoded = decode(&rectifier, Some(model(&rectifier, name)), &frame(REPLY)).expect("a reply");
        let found: Vec<_> = decoded.signals.iter().map(|reading| reading.value.clone()).collect();
        assert_eq!(found, [Value::Number(current), Value::Number(temperature)], "{name}");
        assert_eq!(decoded.notes, [], "{name}");
    }
}

#[test]
fn a_frame_comes_back_with_and_without_a_model() {
    let rectifier = feature("scales_by_model");
    let models = ["R4830", "R4850_X20", "R4850_X30"].map(|name| Some(model(&rectifier, name)));
    for text in [REPLY, "004#01B83200", "004#FFFF3200"] {
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
    let rectifier = feature("scales_by_model");
    let values = [("current", "22A"), ("temperature", "25°C")].map(|(name, text)| (name.to_owned(), text.to_owned()));
    let reply = |name: &str| {
        let model = Some(model(&rectifier, name));
        let kind = Some(canspec_codegen::model::Kind::Reply);
        let reply = Sent { kind, access: None, model, message: "set_output", to: None, source: None };
        sent(&rectifier, reply, &values).map(|frames| frames.iter().map(printed).collect()).map_err(|refusal| refusal.0)
    };
    // 22 x 20 and 25 x 2; 22 x 30 and (25 + 40) x 2.
    assert_eq!(reply("R4850_X20").as_deref(), Ok("005#01B83200"));
    assert_eq!(reply("R4850_X30").as_deref(), Ok("005#02948200"));
}
