//! Requests by name: whom they address, and how many frames they take.

use canspec_codegen::interpret::{Sent, Target, Targets, request, requests, sent, source, targets};
use canspec_codegen::model::{Kind, Protocol};

use super::{WIDE, feature, model, printed, protocol, requested, written};

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
