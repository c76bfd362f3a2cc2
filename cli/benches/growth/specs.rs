//! Specs in which one thing grows.

use std::fmt::Write as _;

/// The head of each spec, up to what is particular about its types.
const HEAD: &str = "\
canspec: 1
protocol: synthetic
title: Synthetic devices
document: {title: Synthetic, version: V1}
length: 8
identifier: {error: {bits: 28..26, normal: 0}, command: {bits: 25..10}, direction: {bits: 9}, node: {bits: 8..3}, more: {bits: 2, continues: 1}, rest: {bits: 1..0, const: 0}}
header: {member: {bytes: 0..1}}
access:
  read: {request: {}, reply: {}, in: [reply], answers: {one: one}}
  set: {request: {}, reply: {}, answers: {one: one}}
addressing:
  one: {request: {direction: 1, node: device}, one: {direction: 0, node: device}}
types:
  device: {range: 0..0x3F}
  voltage: {scale: 0.1, unit: V}
  current: {scale: 0.01, unit: A}
  temperature: {as: signed, unit: °C}
";

/// A number with a sign.
const TEMPERATURE: &str = "{bytes: 4, type: temperature}";
/// A number of two bytes.
const COUNT: &str = "{bytes: 5..6}";

/// Members of a set, and sets of a member.
const MEMBERS: u32 = 64;

/// Returns a spec of items: what comes before the first, each item, and what comes behind the last.
fn spec(before: &str, count: u32, item: impl Fn(u32) -> String, behind: &str) -> String {
    let items = (0..count).map(item);
    items.fold(format!("{HEAD}{before}"), |spec, item| spec + &item) + behind
}

/// Returns a spec of `count` messages of four signals.
pub fn messages(count: u32) -> String {
    spec("messages:\n", count, |number| message(number, TEMPERATURE, COUNT), "")
}

/// Returns a spec of `count` messages, each with named values of its own.
pub fn enums(count: u32) -> String {
    spec(
        "messages:\n",
        count,
        |number| {
            let names = format!("{{0: off_{number}, 1: on_{number}, 2: waiting_{number}, 3: failed_{number}}}");
            message(number, TEMPERATURE, &format!("{{bytes: 5..6, values: {names}}}"))
        },
        "",
    )
}

/// Returns a spec of `count` messages, each with two errors.
pub fn errors(count: u32) -> String {
    spec("messages:\n", count, |number| message(number, "{bytes: 3, type: missing}", COUNT), "")
}

fn message(number: u32, temperature: &str, count: &str) -> String {
    format!(
        "  message_{number}:\n    section: \"1\"\n    match: {{command: {number}}}\n    access: [read]\n    fields:\n      \
         voltage: {{bytes: 0..1, type: voltage}}\n      current: {{bytes: 2..3, type: current}}\n      \
         temperature: {temperature}\n      count: {count}\n"
    )
}

/// Returns a spec of `count` sets, as many as possible with the same members.
pub fn sets(count: u32) -> String {
    let member = |number| {
        format!(
            "  member_{number}: {{section: \"1\", match: {{member: {number}}}, value: {{bytes: 4..7, type: voltage}}}}\n"
        )
    };
    let set = |number: u32| {
        let first = number / MEMBERS * MEMBERS;
        let names: Vec<_> = (first..first + MEMBERS).map(|member| format!("member_{member}")).collect();
        let members = names.join(", ");
        format!(
            "  set_{number}: {{section: \"1\", match: {{command: {number}}}, access: [read], members: [{members}]}}\n"
        )
    };
    let members = count.next_multiple_of(MEMBERS);
    spec("messages:\n", members, member, &(0..count).map(set).collect::<String>())
}

/// Returns a spec of `count` device models, each with limits and a layout of its own.
pub fn models(count: u32) -> String {
    let model = |number| {
        let last = number + 100;
        format!("  M{number}: {{title: Model, section: \"1\", types: {{voltage: {{range: {number}..{last}}}}}}}\n")
    };
    let layouts = (0..count).fold(String::new(), |mut layouts, number| {
        let _ = writeln!(
            layouts,
            "  message_{number}: {{section: \"1\", match: {{command: 1}}, access: [set], models: [M{number}], \
             value: {{bytes: 2..3, type: voltage}}}}"
        );
        layouts
    });
    spec("models:\n", count, model, &format!("messages:\n{layouts}"))
}

/// Returns a spec of one field with `count` named values.
pub fn values(count: u32) -> String {
    let message = "messages:\n  message_0: {section: \"1\", match: {command: 0}, access: [set], value: {bytes: 2..3, type: names}}\n";
    spec("  names:\n    section: \"1\"\n    values:\n", count, |raw| format!("      {raw}: name_{raw}\n"), message)
}
