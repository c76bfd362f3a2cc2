//! The JSON is enough to read frames: a few lines of arithmetic find the raw values that `canspec decode` shows.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{canspec, object, specs};

/// How much was compared.
#[derive(Default)]
struct Count {
    frames: usize,
    long: usize,
    values: usize,
    addresses: usize,
}

#[test]
fn the_raw_values_of_the_examples_follow_from_the_places_in_json() {
    let mut count = Count::default();
    for spec in specs() {
        let listed = object(&spec);
        for line in decoded(&spec, &listed) {
            compare(&listed, &line, &mut count);
        }
    }
    let Count { frames, long, values, addresses } = count;
    assert!(frames > 900, "{frames} frames");
    assert!(long > 20, "{long} long messages");
    assert!(values > 2000, "{values} values");
    assert!(addresses > 900, "{addresses} addresses");
}

/// Decodes the frames of all examples.
fn decoded(spec: &Path, listed: &Value) -> Vec<Value> {
    let folder = tempfile::tempdir().expect("there is room");
    let log = folder.path().join("examples.log");
    let examples = items(listed, "examples").iter();
    let frames = examples.flat_map(|example| items(example, "frames")).filter(|frame| !frame["data"].is_null());
    let lines: Vec<_> =
        frames.map(|frame| format!("(0.0) can0 {}#{}\n", text(frame, "id"), text(frame, "data"))).collect();
    fs::write(&log, lines.concat()).expect("there is room");
    let paths = [spec, &log].map(|path| path.to_str().expect("the path is text"));
    let call = ["decode", "--spec", paths[0], "--format", "jsonl", "--assemble", paths[1]];
    canspec(&call).lines().map(|line| serde_json::from_str(line).expect("it is JSON")).collect()
}

/// Compares a decoded frame or long message with what the list says of it.
fn compare(listed: &Value, line: &Value, count: &mut Count) {
    let Some(message) = items(listed, "messages").iter().find(|message| message["name"] == line["message"]) else {
        // A frame of a transport, or one that is not recognised.
        assert!(line["message"].as_str().is_none_or(|name| name.contains('.')), "{line}");
        return;
    };
    // A long message without data lacks parts.
    let Some(data) = line["data"].as_str().map(bytes) else { return };
    let is_long = line.get("lines").is_some();
    if is_long {
        count.long += 1;
    } else {
        count.frames += 1;
        count.addresses += compare_identifier(listed, message, line, &data);
    }
    let own = if is_long { &message["long"]["signals"] } else { &message["signals"] };
    let other = &message["long"]["signals"];
    let known = [own, other].into_iter().flat_map(|known| known.as_array().into_iter().flatten());
    let known: Vec<_> = known.collect();
    for (name, shown) in line["signals"].as_object().expect("it has signals") {
        count.values += compare_field(&known, &data, (name, &shown["raw"]), line);
    }
}

/// Compares a signal, or the elements of an array, with the bits at their places.
fn compare_field(known: &[&Value], data: &[u8], (name, raw): (&str, &Value), line: &Value) -> usize {
    if let Some(signal) = known.iter().find(|signal| signal["name"] == name) {
        let bits = bits(signal, data);
        // Another field may say that a text ends before the data.
        let is_begun = !signal["least_bytes"].is_null() && begins(&bits, raw);
        assert!(*raw == bits || is_begun, "{name} is {bits} in {line}");
        return 1;
    }
    let elements = raw.as_array().unwrap_or_else(|| panic!("`{name}` is not listed: {line}"));
    for (index, raw) in elements.iter().enumerate().filter(|(_, raw)| !raw.is_null()) {
        let is_meant = |signal: &&&Value| signal["array"]["name"] == name && signal["array"]["index"] == index;
        let signal = known.iter().find(is_meant).unwrap_or_else(|| panic!("{name} {index}: {line}"));
        assert_eq!(*raw, bits(signal, data), "{name} {index} in {line}");
    }
    elements.len()
}

/// Tests whether a text in hexadecimal begins with another one.
fn begins(long: &Value, short: &Value) -> bool {
    long.as_str().zip(short.as_str()).is_some_and(|(long, short)| long.starts_with(short))
}

/// Returns the raw value of the bits at a place.
fn bits(signal: &Value, data: &[u8]) -> Value {
    let place = &signal["place"];
    let [first, last, high, low] = ["first", "last", "high", "low"].map(|key| number(place, key));
    if !signal["least_bytes"].is_null() {
        let text = &data[first..=last.min(data.len() - 1)];
        let digits: Vec<_> = text.iter().map(|byte| format!("{byte:02X}")).collect();
        return Value::from(digits.concat());
    }
    // What a short frame lacks is 0.
    let byte = |place: usize| data.get(place).copied().unwrap_or(0);
    let bytes: Vec<usize> = if first <= last { (first..=last).collect() } else { (last..=first).rev().collect() };
    let word = bytes.iter().fold(0_u128, |word, place| word << 8 | u128::from(byte(*place)));
    let width = high - low + 1;
    let raw = word >> low & ((1 << width) - 1);
    let is_negative = signal["as"] == "signed" && raw >> (width - 1) & 1 == 1;
    let raw = i128::try_from(raw).expect("it has at most 64 bits") - if is_negative { 1 << width } else { 0 };
    u64::try_from(raw).map_or_else(|_| Value::from(i64::try_from(raw).expect("it has at most 64 bits")), Value::from)
}

/// Tests that a frame of the list has the identifier and the constants of the line, and compares the addresses.
fn compare_identifier(listed: &Value, message: &Value, line: &Value, data: &[u8]) -> usize {
    let id = u32::from_str_radix(text(line, "id"), 16).expect("it is hexadecimal");
    let long = message["long"]["frames"].as_array().into_iter().flatten();
    let frames = items(message, "frames").iter().chain(long);
    let mut frames = frames.filter(|frame| frame["access"] == line["access"] && frame["kind"] == line["kind"]);
    let frame = frames.find(|frame| has_constants(listed, frame, id, data)).unwrap_or_else(|| panic!("{line}"));
    let Some(mode) = line["addressing"].as_str() else { return 0 };
    let shown = items(frame, "identifiers").iter().filter(|shown| shown["mode"] == mode);
    let is_met =
        |shown: &&Value| usize::try_from(id).ok().map(|id| id & number(shown, "mask")) == Some(number(shown, "value"));
    let fitting: Vec<_> = shown.filter(is_met).collect();
    // A note says that the message is not addressed so.
    assert!(!fitting.is_empty() || line["notes"].to_string().contains("\"addressing\""), "{line}");
    let addresses = line["addresses"].as_object().expect("it has addresses");
    let is_shown =
        |shown: &&Value| addresses.iter().all(|(name, number)| address(listed, shown, name, id) == number.as_i64());
    assert!(fitting.is_empty() || fitting.iter().any(is_shown), "{line}");
    addresses.len()
}

/// Returns the number of an address that an identifier shows.
fn address(listed: &Value, shown: &Value, name: &str, id: u32) -> Option<i64> {
    let known = items(shown, "addresses").iter().find(|known| known["address"] == name)?;
    let kind = items(listed, "addresses").iter().find(|kind| kind["name"] == name)?;
    let raw = field(listed, known["field"].as_str()?, id)?;
    Some(i64::from(raw) * kind["sign"].as_i64()? + kind["offset"].as_i64()?)
}

/// Returns the value of a field of the identifier.
fn field(listed: &Value, name: &str, id: u32) -> Option<u32> {
    let known = items(&listed["identifier"], "fields").iter().find(|field| field["name"] == name)?;
    let [high, low] = ["high", "low"].map(|key| number(known, key));
    Some(id >> low & (u32::MAX >> (31 - (high - low))))
}

/// Tests whether the fields that choose a message have the values of a frame.
fn has_constants(listed: &Value, frame: &Value, id: u32, data: &[u8]) -> bool {
    items(frame, "constants").iter().all(|constant| {
        let name = text(constant, "selector");
        let header = items(listed, "header").iter().find(|selector| selector["name"] == name);
        let value = match header {
            Some(selector) => bits(selector, data),
            None => Value::from(field(listed, name, id).expect("it is a field of the identifier")),
        };
        items(constant, "values").contains(&value)
    })
}

fn items<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().unwrap_or_else(|| panic!("`{key}` is no list of {value}"))
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_else(|| panic!("`{key}` is no text of {value}"))
}

fn number(value: &Value, key: &str) -> usize {
    value[key].as_u64().and_then(|number| usize::try_from(number).ok()).expect("it is a number")
}

fn bytes(digits: &str) -> Vec<u8> {
    let digits: Vec<char> = digits.chars().collect();
    digits
        .chunks(2)
        .map(|pair| u8::from_str_radix(&pair.iter().collect::<String>(), 16).expect("hexadecimal"))
        .collect()
}
