//! Arrays, whose elements are signals of their own.

use canspec_codegen::interpret::{Content, Input, Value, encode};
use canspec_codegen::model::Protocol;

use super::{decoded, note_texts, printed, requested, values, written};

/// Words of both orders, status words, and parts of a word.
const SPEC: &str = r#"
canspec: 1
protocol: pack
title: A pack of cells
document: {title: Made up, version: "1"}
length: 8
identifier: {direction: {bits: 10}, command: {bits: 9..4}, node: {bits: 3..0}}
types: {pack: {range: 1..9}}
addressing: {single: {request: {direction: 0, node: pack}, one: {direction: 1, node: pack}}}
access: {set: {request: {}, reply: {}, answers: {single: one}}}
messages:
  cells:
    section: "1"
    match: {command: 1}
    access: [set]
    fields:
      heat:  {bytes: 1..0, repeat: 2, as: signed, scale: 1/2, unit: °C, range: -40..100, default: 20}
      alarm: {bytes: 4, repeat: 2, status: {hot: {bit: 0}, cold: {bit: 3}}}
      pair:  {bytes: 6, repeat: 2, fields: {high: {bits: 7..4}, low: {bits: 3..0}}}
  steps:
    section: "1"
    match: {command: 2}
    access: [set]
    length: [4, 6, 7]
    fields:
      level: {bytes: 0..1, repeat: 3, first: 0, default: 7}
      last:  {bytes: 6}
  falling:
    section: "1"
    match: {command: 3}
    access: [set]
    fields:
      byte: {bytes: 2, repeat: 2, step: -2}
      word: {bytes: 3..4, fields: {bit: {bits: 15..14, repeat: 3, step: -4}}}
      name: {bytes: 5, repeat: 2, as: text}
"#;

fn pack() -> Protocol {
    written(SPEC)
}

/// Makes a request to pack 1, or says why not.
fn asked(message: &str, signals: &[(&str, &str)]) -> Result<String, String> {
    requested(&pack(), None, message, "pack:1", signals).map_err(|refusal| refusal.0)
}

#[test]
fn elements_are_read_where_they_follow_one_another() {
    let integer = |name: &str, value| (name.to_owned(), Value::Integer(value));
    let found = values(&pack(), "011#3200FEFF01081234");
    let numbers: Vec<_> = found.iter().filter(|(_, value)| !matches!(value, Value::Status { .. })).cloned().collect();
    let heat = [("heat_1", 25.0), ("heat_2", -1.0)].map(|(name, value)| (name.to_owned(), Value::Number(value)));
    let parts = [integer("high_1", 1), integer("low_1", 2), integer("high_2", 3), integer("low_2", 4)];
    assert_eq!(numbers, [&heat[..], &parts].concat());
    let set = |bit: u8| Value::Status { set: 1 << bit, unknown: 0 };
    let alarms: Vec<_> = found.into_iter().filter(|(_, value)| matches!(value, Value::Status { .. })).collect();
    assert_eq!(alarms, [("alarm_1".to_owned(), set(0)), ("alarm_2".to_owned(), set(3))]);
    let text = "heat_2 101 °C is outside -40..100 °C";
    assert_eq!(note_texts(&pack(), "011#3200CA0001081234"), [text]);
}

#[test]
fn a_negative_step_leads_the_other_way() {
    // Bits 15..14, 11..10 and 7..6 of 0x8440.
    let named = |(name, value): (&str, i128)| (name.to_owned(), Value::Integer(value));
    let text = |(name, value): (&str, &str)| (name.to_owned(), Value::Text(value.to_owned()));
    let mut found = values(&pack(), "031#0700098440414200");
    found.sort_by(|(one, _), (other, _)| one.cmp(other));
    let bits = [("bit_1", 2), ("bit_2", 1), ("bit_3", 1)].map(named);
    let others = [[("byte_1", 9), ("byte_2", 7)].map(named), [("name_1", "A"), ("name_2", "B")].map(text)].concat();
    assert_eq!(found, [&bits[..], &others].concat());
}

#[test]
fn a_person_gives_the_values_of_an_array_one_after_the_other() {
    let rest = [("alarm", "[hot],[cold]"), ("high", "1,3"), ("low", "2,4")];
    let with = |heat: &[(&str, &str)]| asked("cells", &[heat, &rest].concat());
    let whole = Ok("011#3200FEFF01081234");
    assert_eq!(with(&[("heat", "25,-1°C")]).as_deref(), whole);
    assert_eq!(with(&[("heat", "25 °C, -1000 m°C")]).as_deref(), whole);
    assert_eq!(with(&[("heat_2", "-1"), ("heat_1", "25")]).as_deref(), whole);
    // Raw 40 is the default of 20 °C.
    assert_eq!(with(&[("heat", "25")]).as_deref(), Ok("011#3200280001081234"));
    assert_eq!(with(&[("heat", "1,2,3")]), Err("cells: `heat` has 2 elements, and 3 values are given".to_owned()));
    assert_eq!(with(&[("heat", "1,101")]), Err("cells.heat_2: 101 °C is outside -40..100 °C".to_owned()));
    let twice = with(&[("heat", "1,2"), ("heat_2", "2")]);
    assert_eq!(twice, Err("cells: the signal `heat_2` is given twice".to_owned()));
}

#[test]
fn an_element_beyond_the_least_length_is_optional() {
    assert_eq!(asked("steps", &[("level", "1,2")]).as_deref(), Ok("021#00010002"));
    assert_eq!(asked("steps", &[("level", "1,2,3")]).as_deref(), Ok("021#000100020003"));
    assert_eq!(asked("steps", &[("level_2", "3")]).as_deref(), Ok("021#000700070003"));
    let integers = [("level_0", 1), ("level_1", 2)].map(|(name, value)| (name.to_owned(), Value::Integer(value)));
    assert_eq!(values(&pack(), "021#00010002"), integers);
}

#[test]
fn a_list_of_values_is_encoded_as_far_as_it_goes() {
    let protocol = pack();
    let levels = |name: &str, levels: &[Option<i128>]| {
        let mut content = Content::of(&protocol, &decoded(&protocol, "421#00010002"));
        content.signals.clear();
        content.reserved.clear();
        let levels = levels.iter().map(|level| level.map(Input::Integer)).collect();
        content.arrays = vec![(name.to_owned(), levels)];
        encode(&protocol, None, &content).map(|frame| printed(&frame)).map_err(|refusal| refusal.0)
    };
    assert_eq!(levels("level", &[Some(5), Some(6)]).as_deref(), Ok("421#00050006"));
    assert_eq!(levels("level", &[Some(5), Some(6), Some(7)]).as_deref(), Ok("421#000500060007"));
    assert_eq!(levels("level", &[Some(5), Some(6), None]).as_deref(), Ok("421#00050006"));
    let missing = levels("level", &[None, Some(6)]);
    assert_eq!(missing, Err("steps: the signal `level_0` is missing".to_owned()));
    let longer = levels("level", &[Some(1); 4]);
    assert_eq!(longer, Err("steps: `level` has 3 elements, and 4 values are given".to_owned()));
    assert_eq!(levels("last", &[Some(1)]), Err("steps: there is no array `last`".to_owned()));
}

#[test]
fn an_element_given_in_a_list_and_alone_is_refused() {
    let protocol = pack();
    let mut content = Content::of(&protocol, &decoded(&protocol, "421#00010002"));
    content.arrays = vec![("level".to_owned(), vec![Some(Input::Integer(1))])];
    let refusal = encode(&protocol, None, &content).expect_err("a refusal").0;
    assert_eq!(refusal, "steps: the signal `level_0` is given twice");
}
