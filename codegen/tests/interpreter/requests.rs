//! Requests by name, with values as a person types them.

use canspec_codegen::interpret::{Sent, Target, Targets, request, requests, sent, source, targets};
use canspec_codegen::model::{Kind, Protocol};

use super::{WIDE, feature, model, notes, printed, protocol, requested, written};

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
fn a_request_goes_to_the_first_and_the_last_address_and_to_none_beyond() {
    let levels = feature("addressing");
    let to = |target| requested(&levels, None, "level", target, &[("value", "50")]).ok();
    assert_eq!(to("module:0").as_deref(), Some("004300F0#3200000000000000"));
    assert_eq!(to("module:0x3B").as_deref(), Some("00433BF0#3200000000000000"));
    assert_eq!(to("group:7").as_deref(), Some("008307F0#3200000000000000"));
    assert_eq!(to("all").as_deref(), Some("00433FF0#3200000000000000"));
    assert_eq!([to("module:0x3C"), to("group:8"), to("module:-1"), to("module"), to("all:1")], [const { None }; 5]);
}

#[test]
fn a_register_is_chosen_by_its_selectors() {
    let request = requested(&feature("register_table"), None, "voltage_limit", "single:3", &[("value", "700")]);
    assert!(request.is_err_and(|refusal| refusal.0.contains("say which access")));
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

/// Makes the requests of a message that may be a set.
fn frames(protocol: &Protocol, access: Option<&str>, message: &str, signals: &[(&str, &str)]) -> Vec<String> {
    let signals: Vec<_> = signals.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    let target = Target::parse(protocol, "oven:3").expect("a target");
    let made = requests(protocol, None, access, message, &target, None, &signals);
    made.map_or_else(|refusal| vec![refusal.to_string()], |frames| frames.iter().map(printed).collect())
}

#[test]
fn a_set_is_asked_for_in_one_frame_or_in_one_a_member_of_which_the_last_says_so() {
    let ovens = protocol("tests/downstream/specs/oven.yaml");
    assert_eq!(frames(&ovens, None, "measured", &[]), ["086#00000000"]);
    assert_eq!(frames(&ovens, None, "identity", &[]), ["0A7#03000000", "0A6#01000000"]);
    assert_eq!(frames(&ovens, Some("scan"), "identity", &[]), ["0A7#03000000", "0A6#01000000"]);
    let refused = frames(&ovens, Some("read"), "identity", &[]);
    assert_eq!(refused, ["identity: it has no request of the access `read`"]);
    let refused = frames(&ovens, None, "identity", &[("value", "1"), ("other", "1")]);
    assert_eq!(refused, ["identity: there is no signal `value` to send; it has none"]);
    let pumps = protocol("tests/specs/devices/split_request.yaml");
    let target = Target::parse(&pumps, "pump:3").expect("a target");
    let made = requests(&pumps, None, None, "identity", &target, None, &[]).expect("a legal request");
    assert_eq!(made.iter().map(printed).collect::<Vec<_>>(), ["503#01AA000000", "503#0200000000"]);
}

#[test]
fn a_member_is_asked_for_by_its_own_access_unless_that_of_the_set_is_named() {
    let ovens = protocol("tests/downstream/specs/oven.yaml");
    assert_eq!(frames(&ovens, None, "temperature", &[]), ["046#01000000"]);
    assert_eq!(frames(&ovens, Some("scan"), "temperature", &[]), ["0A6#01000000"]);
    assert_eq!(frames(&ovens, None, "serial", &[]), ["0A6#03000000"]);
    let refused = frames(&ovens, Some("write"), "temperature", &[]);
    assert_eq!(refused, ["temperature: it has no request of the access `write`; it has `read`, `scan`"]);
    assert_eq!(frames(&ovens, None, "power", &[]), ["power: nobody requests it"]);
}

/// Returns how the targets of a request are written, `=` before the only one.
fn targets_of(protocol: &Protocol, access: Option<&str>, message: &str) -> Result<Vec<String>, String> {
    match targets(protocol, access, message) {
        Ok(Targets::One(Target { name, number })) => Ok(vec![format!("={name} {number:?}")]),
        Ok(Targets::Choice(forms)) => Ok(forms),
        Err(refusal) => Err(refusal.to_string()),
    }
}

#[test]
fn a_request_that_can_go_to_one_target_only_has_that_one() {
    const SPEC: &str = r#"
canspec: 1
protocol: alone
title: One device
document: {title: Made up, version: "1"}
length: 8
identifier: {direction: {bits: 10..9}, command: {bits: 8..4}, node: {bits: 3..0}}
types: {only: {range: 5..5}, any: {range: 1..9}}
addressing:
  single: {request: {direction: 0, node: only}, one: {direction: 1, node: only}}
  other: {request: {direction: 2, node: any}, one: {direction: 3, node: any}}
access:
  read: {request: {}, reply: {}, in: [reply], answers: {single: one}}
  ask: {request: {}, reply: {}, in: [reply], answers: {single: one, other: one}}
messages:
  near: {section: "1", match: {command: 1}, access: [read], value: {bytes: 0..1}}
  far: {section: "1", match: {command: 2}, access: [ask], value: {bytes: 0..1}}
"#;
    let alone = written(SPEC);
    assert_eq!(targets_of(&alone, None, "near"), Ok(vec!["=only Some(5)".to_owned()]));
    assert_eq!(targets_of(&alone, None, "far"), Ok(vec!["only:N".to_owned(), "any:N".to_owned()]));
    assert_eq!(
        targets_of(&alone, Some("ask"), "near"),
        Err("near: it has no request of the access `ask`; it has `read`".to_owned())
    );
    let all = feature("short_frames");
    assert_eq!(targets_of(&all, None, "keep_alive"), Ok(vec!["=all None".to_owned()]));
    let pumps = protocol("tests/specs/devices/split_request.yaml");
    assert_eq!(targets_of(&pumps, None, "identity"), Ok(vec!["pump:N".to_owned()]));
}

#[test]
fn a_request_takes_the_names_of_addresses_and_no_number_without_a_name() {
    let named = feature("named_addresses");
    let to = |target: &str| requested(&named, None, "switch_relay", target, &[("power", "on")]);
    let charge = Some("00915140#0100000000000000".to_owned());
    assert_eq!(["relay:charge", "relay:0x51"].map(|target| to(target).ok()), [charge.clone(), charge]);
    let refusal = |target: &str| to(target).expect_err("no such address").to_string();
    let why = "switch_relay: relay 82 (0x52) is none of 0x50 (main), 0x51 (charge)";
    assert_eq!(refusal("relay:0x52"), why);
    let why = "`gprs` is not an address; write `relay:3`, or one of the names `main`, `charge`";
    assert_eq!(refusal("relay:gprs"), why);
    let senders = ["gprs", "0x20", "32", "main"].map(|text| source(&named, text).ok());
    assert_eq!(senders, [Some(32), Some(32), Some(32), None]);
}

/// Two peers that both have a usual address.
const EQUALS: &str = r#"
canspec: 1
protocol: equals
title: A vehicle and a charger
document: {title: Made up, version: "1"}
length: 1
identifier: {priority: {bits: 28..26}, page: {bits: 25..24}, format: {bits: 23..16}, target: {bits: 15..8}, source: {bits: 7..0}}
types:
  vehicle: {range: 0xF0..0xF7, outside: refused, send: 0xF4}
  charger: {range: 0x50..0x5F, outside: refused, send: 0x56}
addressing: {peer: {request: {target: vehicle, source: charger}, one: {target: charger, source: vehicle}}}
access: {set: {request: {}, answers: {peer: nobody}}}
messages: {limit: {section: "1", match: {format: 1}, access: [set], value: {bytes: 0}}}
"#;

/// Returns the request of `limit` that another sender makes.
fn sent_by(protocol: &Protocol, sender: i64) -> Result<String, String> {
    let signals = [("value".to_owned(), "7".to_owned())];
    let target = Target::parse(protocol, "peer").map_err(|why| why.to_string())?;
    let frame = request(protocol, None, None, "limit", &target, Some(sender), &signals);
    frame.map(|frame| printed(&frame)).map_err(|why| why.to_string())
}

#[test]
fn another_sender_changes_its_own_address_and_not_that_of_its_peer() {
    let to_all = EQUALS.replace("addressing: {", "addressing: {all: {request: {target: 0xFF, source: charger}}, ");
    let group = "{kind: j1939, section: '1', group: [page, format, target], target: target, source: source}";
    let transport = format!("{EQUALS}transports: {{tp: {group}}}\n");
    for spec in [&to_all, &transport] {
        let protocol = written(spec);
        assert_eq!(sent_by(&protocol, 0x57), Ok("0001F457#07".to_owned()));
        let why = "limit: charger 245 is outside 80..95 (0x50..0x5F)";
        assert_eq!(sent_by(&protocol, 0xF5), Err(why.to_owned()), "that is a vehicle");
    }
}

#[test]
fn nobody_says_which_of_two_equal_peers_is_the_sender() {
    let why = "limit: the mode `peer` does not show which address is the source";
    assert_eq!(sent_by(&written(EQUALS), 0x57), Err(why.to_owned()));
}

#[test]
fn raw_bytes_are_taken_in_hexadecimal_with_all_their_digits() {
    let wide = written(WIDE);
    let send =
        |digits| requested(&wide, None, "lock", "counter:1", &[("value", digits)]).map_err(|why| why.to_string());
    assert_eq!(["0A1B2C", "0a1b2c"].map(send), [(); 2].map(|()| Ok("061#2C1B0A0000000000".to_owned())));
    let why = |digits| format!("lock.value: `{digits}` is not 3 bytes of two hexadecimal digits each for `value`");
    for digits in ["0A1B", "0A1B2", "0A1B2C3D", "0A 1B 2C", "0A1B2G"] {
        assert_eq!(send(digits), Err(why(digits)));
    }
}

#[test]
fn a_request_is_as_long_as_the_values_that_it_is_given() {
    let lengths = feature("optional_fields");
    let send = |signals: &[(&str, &str)]| requested(&lengths, None, "limit", "charger:3", signals).ok();
    assert_eq!(send(&[("current", "64 A")]).as_deref(), Some("133#40"));
    assert_eq!(send(&[("current", "64 A"), ("ramp", "5 s")]).as_deref(), Some("133#4005"));
    assert_eq!(send(&[("ramp", "5 s")]), None);
}

#[test]
fn what_is_left_out_of_a_long_enough_request_is_sent_as_all_ones() {
    let absent = feature("not_available");
    let send = |signals: &[(&str, &str)]| {
        requested(&absent, None, "limits", "vehicle:1", signals).map_err(|why| why.to_string())
    };
    let given = [("ready", "0"), ("counter", "1")];
    assert_eq!(send(&given), Ok("121#FFFF7F0301".to_owned()));
    assert_eq!(send(&[given[0], given[1], ("day", "90")]), Ok("121#FFFF7F03015A".to_owned()));
    assert!(send(&given[..1]).is_err(), "`counter` has `absent: none`");
}

#[test]
fn named_values_without_one_that_is_absent_are_needed() {
    let refused = requested(&feature("named_values"), None, "switch", "heater:3", &[("power", "off")]);
    assert_eq!(refused.expect_err("it lacks a value").to_string(), "switch: the signal `lamp` is missing");
}

#[test]
fn a_reply_of_a_module_is_the_printed_frame_and_says_that_all_is_well() {
    let mxr = protocol("specs/mxr.yaml");
    let reply = |kind| Sent { kind, access: None, model: None, message: "output_voltage", to: None, source: Some(1) };
    let signals = [("value".to_owned(), "700 V".to_owned())];
    let made = sent(&mxr, reply(Some(Kind::Reply)), &signals).expect("a reply of module 1");
    assert_eq!(made.iter().map(printed).collect::<Vec<_>>().join(" "), "060F8008#41F00001442F0000");
    let is_of_module = |kind| reply(kind).is_of_module(&mxr).ok();
    assert_eq!(
        [Some(Kind::Reply), Some(Kind::Request), None].map(is_of_module),
        [Some(true), Some(false), Some(false)]
    );
    let trio = protocol("specs/trio.yaml");
    let report = Sent { message: "output_values", ..reply(None) };
    assert_eq!(report.is_of_module(&trio).ok(), Some(true));
}

#[test]
fn a_frame_of_a_module_that_should_go_to_one_is_refused_with_what_names_the_sender() {
    let made = |spec: &Protocol, (kind, message), to: &str, (signal, value): (&str, &str)| {
        let to = Target::parse(spec, to).expect("a target");
        let by = Sent { kind: Some(kind), access: None, model: None, message, to: Some(&to), source: Some(2) };
        let frames = sent(spec, by, &[(signal.to_owned(), value.to_owned())]);
        frames.map(|frames| printed(&frames[0])).map_err(|why| why.to_string())
    };
    let mxr = protocol("specs/mxr.yaml");
    let reply = |to| made(&mxr, (Kind::Reply, "output_voltage"), to, ("value", "700 V"));
    assert_eq!(reply("controller:0xF0").as_deref(), Ok("060F8010#41F00001442F0000"));
    let why = "output_voltage: such a frame does not go to `module`; say who sends it, with `--source 0x00`";
    assert_eq!(reply("module:2"), Err(why.to_owned()));
    let battery = feature("whole_patterns");
    let report = made(&battery, (Kind::Report, "limits"), "module:2", ("voltage", "50 V"));
    assert_eq!(report, Err("limits: such a frame does not go to `module`".to_owned()));
}

#[test]
fn the_address_that_a_call_names_is_no_other_one_of_the_same_frame() {
    let spec = WIDE
        .replace("node: {bits: 3..0}", "host: {bits: 3..2}, gate: {bits: 1}, node: {bits: 0}")
        .replace(
            "{counter: {range: 1..9}}",
            "{host: {range: 0..3, send: 1}, gate: {range: 0..1, send: 0}, counter: {range: 0..1}}",
        )
        .replace("node: counter}", "host: host, gate: gate, node: counter}");
    let to = Target { name: "host".to_owned(), number: Some(3) };
    let by =
        Sent { kind: Some(Kind::Reply), access: None, model: None, message: "lock", to: Some(&to), source: Some(1) };
    let frames = sent(&written(&spec), by, &[("value".to_owned(), "010203".to_owned())]);
    // Direction 1, command 6, host 3, gate 0, node 1.
    assert_eq!(frames.map(|frames| printed(&frames[0])).ok().as_deref(), Some("46D#0302010000000000"));
}

/// Returns the data of the last frame of a message in parts that a module sends.
fn last_part(spec: &str, (message, kind): (&str, Kind), signals: &[(&str, &str)]) -> Option<String> {
    let protocol = feature(spec);
    let message = Sent { kind: Some(kind), access: None, model: None, message, to: None, source: Some(1) };
    let signals: Vec<_> = signals.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    sent(&protocol, message, &signals).expect("it has all values").iter().map(printed).next_back()
}

#[test]
fn the_last_part_is_filled_up_with_bits_as_they_are_sent() {
    // Cycles 258; the voltages in the lower bits, the group above: 0x114B is 331 of group 1.
    let cells = [("cycles", "258"), ("voltage", "10V,0.1V,0.11V,0.12V,3.3V,3.31V"), ("group", "0,0,0,0,0,1")];
    assert_eq!(last_part("parts", ("cells", Kind::Reply), &cells).as_deref(), Some("051#034B110000000000"));
    let voltages = ["1 V"; 33].join(",");
    let pack = [("state", "idle"), ("energy", "0"), ("valve", "0,0,0,0"), ("fan", "0,0,0,0,0")];
    let pack = [&pack[..], &[("voltage", voltages.as_str()), ("group", "3,2")]].concat();
    assert_eq!(last_part("long_fields", ("pack", Kind::Report), &pack).as_deref(), Some("611#0B03FFFFFFFFFFFF"));
}

/// Returns the frames of a message that module 1 sends, or why there are none.
fn sent_of(spec: &str, (model_name, message): (Option<&str>, &str), signals: &[(&str, &str)]) -> Vec<String> {
    let protocol = feature(spec);
    let model = model_name.map(|name| model(&protocol, name));
    let message = Sent { kind: Some(Kind::Reply), access: None, model, message, to: None, source: Some(1) };
    let signals: Vec<_> = signals.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    let frames = sent(&protocol, message, &signals).map(|frames| frames.iter().map(printed).collect());
    frames.unwrap_or_else(|refusal| vec![refusal.to_string()])
}

#[test]
fn a_list_of_elements_becomes_all_parts_and_elements_beside_a_number_become_one() {
    // 0x0CF0 is 3312, 0x0CFD 3325, 0x0D13 3347, 0x0CD3 3283 and 0x0D0B 3339.
    let cells = [("voltage", "3.312V,3.325V,3.347V,3.283V,3.339V")];
    let [from_0, from_1] =
        ["FROM_0", "FROM_1"].map(|model| sent_of("parts_of_elements", (Some(model), "cells"), &cells));
    assert_eq!(from_0, ["051#000CF00CFD0D1300", "051#010CD30D0B000000"]);
    assert_eq!(from_1, ["051#010CF00CFD0D1300", "051#020CD30D0B000000"]);
    let why = "cells: the first part has another number on each model; choose a model";
    assert_eq!(sent_of("parts_of_elements", (None, "cells"), &cells), [why]);
    let one = [("part", "3"), ("voltage", "3.312V,3.325V,3.347V")];
    assert_eq!(sent_of("parts_of_elements", (None, "cells"), &one), ["051#030CF00CFD0D1300"]);
    let missing = [("part", "3"), ("voltage_1", "3.312V")];
    assert_eq!(sent_of("parts_of_elements", (None, "cells"), &missing), ["cells: the signal `voltage_2` is missing"]);
}

#[test]
fn a_value_that_only_another_kind_of_frame_carries_is_refused_with_the_name_of_that_kind() {
    let in_request = written(&WIDE.replace("reply: {}, answers", "reply: {}, in: [request], answers"));
    let reply =
        Sent { kind: Some(Kind::Reply), access: None, model: None, message: "positive", to: None, source: Some(1) };
    let refused = sent(&in_request, reply, &[("value".to_owned(), "1".to_owned())]).map_err(|why| why.to_string());
    let why = "positive: a reply by `set` does not carry `value`; a request by `set` does";
    assert_eq!(refused.err().as_deref(), Some(why));
    let oven = feature("parts_to_modules");
    let refused = requested(&oven, None, "read program", "oven:3", &[("hold", "10")]).map_err(|why| why.to_string());
    let why = "program: a request by `read` does not carry `hold`; a request by `set` does";
    assert_eq!(refused.err().as_deref(), Some(why));
}
