//! Values as a person types them: how they are sent, and which are refused.

use super::{WIDE, feature, model, notes, protocol, requested, written};

fn output(signals: &[(&str, &str)]) -> Option<String> {
    requested(&feature("scaled_signal"), None, "set_output", "module:3", signals).ok()
}

fn power(power: &str) -> Option<String> {
    output(&[("voltage", "41.5"), ("temperature", "-40"), ("delay", "8"), ("power", power)])
}

#[test]
fn values_are_scaled_and_a_negative_one_is_a_complement() {
    // 53.5 V = 535 = 0x217, 15 °C = 110 = 0x6E, -1500 W = -150 = 0xFF6A.
    let values = [("voltage", "53.5V"), ("temperature", "15 °C"), ("delay", "10 s"), ("power", "-1500W")];
    assert_eq!(output(&values).as_deref(), Some("001203F0#02176E0AFF6A0000"));
}

#[test]
fn half_a_step_is_rounded_away_from_zero() {
    // 415 = 0x19F; -1505 W = -150.5 steps, -151 = 0xFF69; 155 W = 15.5 steps, 16 = 0x10.
    assert_eq!(power("-1505").as_deref(), Some("001203F0#019F0008FF690000"));
    assert_eq!(power("-1504.9").as_deref(), Some("001203F0#019F0008FF6A0000"));
    assert_eq!(power("155").as_deref(), Some("001203F0#019F000800100000"));
    let delay = |delay| output(&[("voltage", "41.5"), ("temperature", "-40"), ("delay", delay), ("power", "0")]);
    assert_eq!(delay("10.5").as_deref(), Some("001203F0#019F000B00000000"));
}

#[test]
fn both_ends_of_a_range_are_legal_and_what_lies_beyond_is_refused() {
    let voltage = |voltage| output(&[("voltage", voltage), ("temperature", "15"), ("power", "0")]).is_some();
    assert_eq!(["41.5", "58.5"].map(voltage), [true; 2]);
    assert_eq!(["41.4", "58.6", "41.49"].map(voltage), [false; 3]);
    assert_eq!([power("327670").is_some(), power("-327680").is_some()], [true; 2]);
    assert_eq!([power("327680").is_some(), power("-327690").is_some()], [false; 2]);
}

#[test]
fn a_wide_number_is_refused_with_all_its_digits() {
    let refused = |message: &str, value: &str| {
        let refusal = requested(&written(WIDE), None, message, "counter:1", &[("value", value)]);
        refusal.expect_err("it is out of range").to_string()
    };
    let (highest, lowest) = ("18446744073709551615", "-9223372036854775807");
    assert_eq!(refused("positive", highest), format!("positive.value: {highest} is outside 0..1000"));
    assert_eq!(refused("negative", lowest), format!("negative.value: {lowest} is outside 0..1000"));
}

#[test]
fn a_fraction_that_no_double_has_is_refused_and_not_rounded() {
    let refused = |message: &str, value: &str| {
        let refusal = requested(&written(WIDE), None, message, "counter:1", &[("value", value)]);
        refusal.expect_err("it is refused").to_string()
    };
    // 2^52 and a half.
    for value in ["4503599627370496.5", "-4503599627370496.5"] {
        let why = format!("negative.value: {value} has a fraction; numbers of that size are whole");
        assert_eq!(refused("negative", value), why);
    }
    assert_eq!(refused("negative", "4503599627370495.5"), "negative.value: 4503599627370495.5 is outside 0..1000");
}

#[test]
fn a_special_value_is_legal_outside_the_range() {
    let delay = |delay| output(&[("temperature", "15"), ("delay", delay), ("power", "0")]);
    assert_eq!(delay("forbid").as_deref(), Some("001203F0#02176E0000000000"));
    assert_eq!(delay("0").as_deref(), Some("001203F0#02176E0000000000"));
    assert_eq!([delay("7"), delay("7.9")], [None, None]);
    // Raw 0 is 8 s.
    let fans = protocol("tests/downstream/specs/fan.yaml");
    let turn =
        |delay| requested(&fans, None, "set_speed", "fan:1", &[("speed", "0"), ("delay", delay), ("power", "off")]);
    assert_eq!(turn("never").as_deref(), Ok("019101E1#0100000001"));
    assert_eq!(turn("8 s").as_deref(), Ok("019101E1#0100000001"));
    assert!(turn("8.4 s").is_err() && turn("9.9 s").is_err());
}

fn limit(current: &str, interval: &str, slope: &str) -> Result<String, String> {
    let signals = [("current", current), ("interval", interval), ("slope", slope), ("cold", "0")];
    let charger = feature("limits_between_steps");
    requested(&charger, None, "set_limit", "charger", &signals).map_err(|refusal| refusal.to_string())
}

#[test]
fn what_is_sent_for_a_value_between_two_steps_lies_inside_the_range_too() {
    // The range is 0.04..20.06 A in steps of 0.1 A: 20.04 A is raw 200 = 0xC8, 20.06 A would be 201.
    let sent = |current| limit(current, "10", "5").ok();
    assert_eq!(sent("20.04").as_deref(), Some("006#C80A050000000000"));
    assert_eq!(sent("0.05").as_deref(), Some("006#010A050000000000"));
    let refused = limit("20.06", "10", "5").expect_err("20.1 A would be sent");
    assert_eq!(refused, "set_limit.current: 20.06 A would be sent as 20.1 A, which is outside 0.04..20.06 A");
    // The range is 0.5..9.5 in steps of 1.
    assert_eq!(["0.5", "9.49", "9.5"].map(|slope| limit("1", "10", slope).is_ok()), [true, true, false]);
}

#[test]
fn a_step_beyond_a_limit_is_refused_though_both_have_the_same_nearest_double() {
    let charger = feature("limits_between_steps");
    let sent = |share| requested(&charger, None, "set_reach", "charger", &[("reach", "0"), ("share", share)]);
    assert_eq!(sent("0.299").as_deref(), Ok("00A#00000000012B0000"));
    let refused = sent("0.3").expect_err("300/1000 lies outside").to_string();
    assert_eq!(refused, "set_reach.share: 0.3 would be sent as 0.3, which is outside 0..0.29999999999999999");
}

#[test]
fn a_limit_of_64_bits_is_exact() {
    // 2^53 + 3 is no double; the nearest one is 2^53 + 4.
    let charger = feature("limits_between_steps");
    let total = |total| requested(&charger, None, "set_total", "charger", &[("total", total)]).ok();
    assert_eq!(total("9007199254740995").as_deref(), Some("008#0020000000000003"));
    assert_eq!([total("9007199254740996"), total("9007199254740996.0"), total("0")], [None, None, None]);
    assert_eq!(notes(&charger, "008#0020000000000003"), [""; 0]);
    assert_eq!(notes(&charger, "008#0020000000000004"), ["out_of_range"]);
}

#[test]
fn a_number_that_would_be_sent_as_a_special_value_is_refused() {
    let refused = limit("0.04", "10", "5").expect_err("raw 0 would be sent");
    assert_eq!(refused, "set_limit.current: 0.04 A would be sent as `unlimited`");
    assert_eq!(limit("0", "10", "5").as_deref(), Ok("006#000A050000000000"));
    assert_eq!(limit("unlimited", "10", "5").as_deref(), Ok("006#000A050000000000"));
    // There is no range at all.
    let refused = limit("1", "0.4", "5").expect_err("raw 0 would be sent");
    assert_eq!(refused, "set_limit.interval: 0.4 s would be sent as `never`");
    assert_eq!(limit("1", "0", "5").as_deref(), Ok("006#0A00050000000000"));
    assert_eq!(limit("1", "0.5", "5").as_deref(), Ok("006#0A01050000000000"));
}

#[test]
fn a_signal_that_is_left_out_takes_its_default() {
    // 53.5 V and `forbid`.
    let frame = output(&[("temperature", "15"), ("power", "0")]);
    assert_eq!(frame.as_deref(), Some("001203F0#02176E0000000000"));
    assert_eq!(output(&[("power", "0")]), None);
}

#[test]
fn a_model_has_limits_and_a_default_of_its_own() {
    let pumps = feature("model_limits");
    let set = |name, signals: &[_]| requested(&pumps, Some(model(&pumps, name)), "set_speed", "pump", signals).ok();
    // 500 = 0x1F4, 600 = 0x258.
    assert_eq!(set("P_10A", &[("flow", "0")]).as_deref(), Some("004#01F40000"));
    assert_eq!(set("P_48V_DC", &[("flow", "0")]).as_deref(), Some("004#02580000"));
    let takes = |name, speed| set(name, &[("speed", speed), ("flow", "0")]).is_some();
    assert!(takes("P_10A", "300") && takes("P_10A", "3000") && takes("P_48V_DC", "0") && takes("P_48V_DC", "1500"));
    assert!(!takes("P_10A", "299") && !takes("P_10A", "3001") && !takes("P_48V_DC", "1501"));
    assert_eq!(set("P_20A", &[("flow", "0")]), None);
}

#[test]
fn without_a_model_a_request_keeps_to_the_hull_of_what_the_models_state() {
    // Section 3.3 prints eight models: from 50 V and 0.1 A, to 750 V and 50 A.
    let infy = protocol("specs/infy.yaml");
    let takes = |volts, amperes| {
        let signals = [("voltage", volts), ("current", amperes)];
        requested(&infy, None, "set_module_output", "module:3", &signals).is_ok()
    };
    assert!(takes("50", "0.1") && takes("750", "50"));
    assert!(!takes("49.999", "1") && !takes("750.001", "1") && !takes("4000000", "15"));
    assert!(!takes("500", "0.099") && !takes("500", "50.001"));
}

#[test]
fn a_model_that_states_no_limits_has_those_of_the_type_or_does_not_widen_the_hull() {
    let pumps = feature("model_limits");
    let refusal = |model_name: Option<&str>, speed, flow| {
        let known = model_name.map(|name| model(&pumps, name));
        requested(&pumps, known, "set_speed", "pump", &[("speed", speed), ("flow", flow)]).err().map(|why| why.0)
    };
    // P_20A, for which the type's 0..6000 rpm would count, does not have the message.
    assert_eq!([refusal(None, "0", "-30"), refusal(None, "3000", "30.5")], [const { None }; 2]);
    let hull = "the limits of the models taken together; choose a model for its own";
    assert_eq!(refusal(None, "3001", "0"), Some(format!("set_speed.speed: 3001 rpm is outside 0..3000 rpm, {hull}")));
    assert_eq!(refusal(None, "300", "31"), Some(format!("set_speed.flow: 31 % is outside -30..30.5 %, {hull}")));
    // P_10A states no limits of the flow, and neither does the type.
    assert_eq!(refusal(Some("P_10A"), "300", "31"), None);
    // F_400 states none, and the type has -1500.5..1500.5 rpm.
    let fans = protocol("tests/downstream/specs/fan.yaml");
    let turns = |speed| {
        let signals = [("speed", speed), ("delay", "10"), ("power", "on")];
        requested(&fans, None, "set_speed", "fan:1", &signals).is_ok()
    };
    assert!(turns("1500.5") && turns("-1500.5") && !turns("1501") && !turns("-1501"));
}

#[test]
fn a_model_without_limits_is_not_held_to_those_of_the_others() {
    let modules = protocol("specs/megmeet.yaml");
    let set = |name: Option<&str>, volts| {
        let known = name.map(|name| model(&modules, name));
        requested(&modules, known, "set output_voltage_setting", "module:1", &[("value", volts)]).is_ok()
    };
    // Section 2.2.2 prints 41.5 to 58.5 V for 48 V alone.
    assert!(set(Some("V24"), "27") && set(Some("V72"), "80") && !set(Some("V48"), "27"));
    assert!(set(None, "41.5") && set(None, "58.5") && !set(None, "27") && !set(None, "80"));
}

#[test]
fn on_and_off_are_sent_by_name() {
    let switches = feature("named_values");
    let set = |power| requested(&switches, None, "switch", "heater:9", &[("power", power), ("lamp", "dark")]).ok();
    assert_eq!(set("on").as_deref(), Some("1A9#000A0A0000000000"));
    assert_eq!(set("off").as_deref(), Some("1A9#010A0A0000000000"));
    assert_eq!(set("of"), None);
}

#[test]
fn the_written_limit_of_a_float_is_legal_although_the_nearest_float_lies_beside_it() {
    let write = |volts| {
        requested(&feature("register_table"), None, "write voltage_limit", "single:3", &[("value", volts)]).ok()
    };
    // The float nearest to 0.1 is 0x3DCCCCCD and lies above it.
    assert_eq!(write("0.1").as_deref(), Some("013#030000213DCCCCCD"));
    assert_eq!([write("0.0999"), write("750.1")], [const { None }; 2]);
}
