//! Texts with control characters.

use canspec_codegen::interpret::{Content, Value, decode, encode};
use canspec_codegen::model::Protocol;

use super::{frame, note_texts, requested, values, written};

const LABELS: &str = r#"
canspec: 1
protocol: labels
title: A battery with labels
document: {title: Made up, version: "1"}
length: 6
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
addressing: {battery: {request: {sender: 0}, one: {sender: 1}}}
access: {set: {request: {}, reply: {}, answers: {battery: one}}}
messages:
  set_label:
    section: "1"
    match: {command: 2}
    access: [set]
    fields:
      label: {bytes: 0..3, as: text, default: 'A\n'}
      code:
        format: '{letter}\{number:2}'
        fields: {letter: {bytes: 4, as: text}, number: {bytes: 5}}
    examples:
      - {request: 004#410D0A094207, means: {label: 'A\r\n\t', code: 'B\\07'}}
      - {reply: 005#5C1B00007F07, means: {label: '\\\x1b', code: '\x7F\\07'}}
"#;

/// Returns a frame as it comes back.
fn back(labels: &Protocol, text: &str) -> bool {
    let decoded = decode(labels, None, &frame(text)).expect("a frame of the protocol");
    encode(labels, None, &Content::of(labels, &decoded)).is_ok_and(|encoded| encoded == frame(text))
}

#[test]
fn a_text_holds_every_ascii_character_but_nul() {
    let labels = written(LABELS);
    let label = |text: &str| values(&labels, text)[0].1.clone();
    for byte in 0..=0xFF_u8 {
        let text = format!("005#41{byte:02X}42004207");
        let expected = match byte {
            1..=0x7F => Value::Text(format!("A{}B", char::from(byte))),
            0 | 0x80.. => Value::None,
        };
        assert_eq!(label(&text), expected, "{text}");
        assert!(back(&labels, &text), "{text}");
    }
    assert_eq!(note_texts(&labels, "005#41800000420A"), ["label is not a text of the documented form"]);
}

#[test]
fn people_write_control_characters_and_backslashes_as_escapes() {
    let labels = written(LABELS);
    let asked = |signals: &[(&str, &str)]| {
        requested(&labels, None, "set_label", "battery", signals).map_err(|refusal| refusal.0)
    };
    let code = ("code", r"B\\07");
    assert_eq!(asked(&[("label", r"A\r\n\x1B"), code]).as_deref(), Ok("004#410D0A1B4207"));
    assert_eq!(asked(&[("label", r"\\n"), code]).as_deref(), Ok("004#5C6E00004207"));
    assert_eq!(asked(&[code]).as_deref(), Ok("004#410A00004207"), "the default");
    let no_escape = r"begins no escape; write `\\`, `\n`, `\r`, `\t`, or `\x1B` by its number";
    let refused = [
        (asked(&[("label", r"A\q"), code]), format!(r"set_label.label: a backslash of `A\q` {no_escape}")),
        (asked(&[("code", r"B\07")]), format!(r"set_label.code: a backslash of `B\07` {no_escape}")),
        (
            asked(&[("label", r"A\x00B"), code]),
            r"set_label.label: `A\x00B` is not a text of at most 4 ASCII characters without NUL for `label`".to_owned(),
        ),
    ];
    for (asked, expected) in refused {
        assert_eq!(asked, Err(expected));
    }
}
