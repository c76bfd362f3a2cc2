//! Tests of how a line is read.

use super::*;

/// A line with these members beside those that it needs.
fn line(members: &str) -> String {
    format!(r#"{{"message":"m","identifier":{{"source":3}},"selectors":{{}}{members}}}"#)
}

fn read(text: &str) -> Line {
    Line::read(text).expect("the line is readable").expect("the line is not blank")
}

fn message(line: Line) -> Message {
    match line.content {
        Content::Message(message) | Content::Long(message) => message,
        Content::Frame(frame) => panic!("{frame:?} is no message"),
    }
}

fn why(line: &str) -> String {
    Line::read(line).expect_err("the line is refused")
}

fn input(signal: &str) -> Result<Input, String> {
    let line = Line::read(&line(&format!(r#","signals":{{"s":{signal}}}"#)))?;
    let signal = line.and_then(|line| message(line).frame.signals.into_iter().next());
    signal.map(|(_, input)| input).ok_or_else(|| "no signal".to_owned())
}

#[test]
fn a_line_of_decode_is_read_whole() {
    let line = read(concat!(
        r#"{"line":1,"time":1700000000.0,"channel":"can0","id":"0283F000","data":"43FA000040600000","protocol":"p","#,
        r#""message":"m","access":"read","kind":"reply","addressing":"point_to_point","#,
        r#""identifier":{"error":0,"device":10},"selectors":{"function":3},"#,
        r#""signals":{"voltage":{"raw":1140457472,"value":500.0,"unit":"V"},"#,
        r#""state":{"raw":64,"set":["on"],"unknown":32}},"reserved":"00ff","notes":[{"rule":"r","text":"t"}]}"#,
    ));
    let pairs = |pairs: &[(&str, u64)]| pairs.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let expected = interpret::Content {
        message: "m".to_owned(),
        access: Some("read".to_owned()),
        kind: Some(Kind::Reply),
        identifier: pairs(&[("error", 0), ("device", 10)]),
        selectors: pairs(&[("function", 3)]),
        signals: vec![
            ("voltage".to_owned(), Input::Integer(500)),
            ("state".to_owned(), Input::Status { set: vec!["on".to_owned()], unknown: 32 }),
        ],
        arrays: Vec::new(),
        reserved: vec![0x00, 0xFF],
    };
    assert_eq!(line.time.as_ref().map(|time| time.get()), Some("1700000000.0"));
    assert_eq!(line.channel.as_deref(), Some("can0"));
    let message = message(line);
    assert_eq!(message.frame, expected);
    assert_eq!(message.protocol.as_deref(), Some("p"));
    assert_eq!(message.units, [("voltage".to_owned(), "V".to_owned())]);
}

/// A line about a frame that no protocol knows.
fn unrecognised(kind: &str, id: &str, data: &str) -> String {
    format!(r#"{{"id":{id},"data":{data},"message":null,"problem":{{"kind":"{kind}","text":"t"}}}}"#)
}

#[test]
fn a_frame_that_was_not_recognised_is_read_as_it_was() {
    let frames = [("123", "00", 0x123, false, vec![0]), ("00000123", "", 0x123, true, Vec::new())];
    for (id, data, number, extended, bytes) in frames {
        let line = read(&unrecognised("foreign", &format!("{id:?}"), &format!("{data:?}")));
        let Content::Frame(frame) = line.content else { panic!("{line:?} is no frame") };
        assert_eq!((frame.id, frame.extended, frame.data), (number, extended, bytes));
    }
}

#[test]
fn blank_lines_are_no_frames() {
    assert!(Line::read(" \r").expect("a blank line is readable").is_none());
}

#[test]
fn a_stamp_is_kept_as_it_is_written() {
    let line = read(&line(r#","time":1700000000.123456789012345678,"signals":{}"#));
    assert_eq!(line.time.as_ref().map(|time| time.get()), Some("1700000000.123456789012345678"));
}

#[test]
fn an_integer_is_not_a_floating_point_number() {
    assert_eq!(input(r#"{"value":2}"#), Ok(Input::Integer(2)));
    assert_eq!(input(r#"{"value":-2}"#), Ok(Input::Integer(-2)));
    assert_eq!(input(r#"{"value":2.5}"#), Ok(Input::Number(2.5)));
    assert_eq!(input(r#"{"value":18446744073709551615}"#), Ok(Input::Integer(u64::MAX.into())));
    assert_eq!(input(r#"{"value":"on"}"#), Ok(Input::Text("on".to_owned())));
    // A double has a zero below zero.
    assert_eq!(input(r#"{"value":0}"#), Ok(Input::Number(0.0)));
    assert!(matches!(input(r#"{"value":-0}"#), Ok(Input::Number(zero)) if zero.is_sign_negative()));
}

#[test]
fn an_integer_that_no_double_has_is_not_rounded() {
    let just_beyond = i128::from(i64::MIN) - 1;
    assert_eq!(input(&format!(r#"{{"value":{just_beyond}}}"#)), Ok(Input::Integer(just_beyond)));
    assert_eq!(input(&format!(r#"{{"raw":{just_beyond}}}"#)), Ok(Input::Raw(just_beyond)));
    assert_eq!(input(r#"{"value":18446744073709551616}"#), Ok(Input::Number(2_f64.powi(64))));
    let why = "signal `s`: `raw` is an integer of up to 64 bits, not 18446744073709551616";
    assert_eq!(input(r#"{"raw":18446744073709551616}"#), Err(why.to_owned()));
    assert_eq!(input(r#"{"value":1e400}"#), Err("signal `s`: `value` is no number of 64 bits".to_owned()));
}

#[test]
fn a_whole_number_keeps_its_digits_however_it_is_written() {
    let value = |text: &str| input(&format!(r#"{{"value":{text}}}"#));
    let just_beyond = i128::from(i64::MIN) - 1;
    for text in ["-9223372036854775809.0", "-9.223372036854775809e18", "-92233720368547758090E-1"] {
        assert_eq!(value(text), Ok(Input::Integer(just_beyond)), "{text}");
    }
    // 2^53 + 1 is no double.
    for text in ["9007199254740993.0", "9007199254740993e0", "9.007199254740993e+15", "900719925474099300e-2"] {
        assert_eq!(value(text), Ok(Input::Integer(9_007_199_254_740_993)), "{text}");
    }
    assert_eq!(value("18446744073709551615.0"), Ok(Input::Integer(u64::MAX.into())));
    assert_eq!(value("18446744073709551616.0"), Ok(Input::Number(2_f64.powi(64))));
    assert_eq!(value(&format!("2.{}", "0".repeat(60))), Ok(Input::Integer(2)));
    assert_eq!(value("1e2"), Ok(Input::Integer(100)));
    assert_eq!(value("1e300"), Ok(Input::Number(1e300)));
    assert_eq!(value("0e99999999999999999999"), Ok(Input::Number(0.0)));
    assert!(matches!(value("-0.0"), Ok(Input::Number(zero)) if zero.is_sign_negative()));
}

#[test]
fn a_fraction_that_no_double_has_is_refused_and_not_rounded() {
    let value = |text: &str| input(&format!(r#"{{"value":{text}}}"#));
    assert_eq!(value("4503599627370495.5"), Ok(Input::Number(4_503_599_627_370_495.5)));
    for text in ["4503599627370496.5", "-9223372036854775808.5", "4.5035996273704965e15"] {
        let why = format!("signal `s`: `value` is {text}; numbers of that size are whole");
        assert_eq!(value(text), Err(why));
    }
    // A double that another program writes with all its digits has none.
    assert_eq!(value("340282346638528859811704183484516925440.0"), Ok(Input::Number(f32::MAX.into())));
}

#[test]
fn raw_counts_only_without_a_value() {
    assert_eq!(input(r#"{"raw":7,"value":2}"#), Ok(Input::Integer(2)));
    assert_eq!(input(r#"{"raw":7,"value":null}"#), Ok(Input::Raw(7)));
    assert_eq!(input(r#"{"raw":-7}"#), Ok(Input::Raw(-7)));
    assert_eq!(input(r#"{"raw":18446744073709551615}"#), Ok(Input::Raw(u64::MAX.into())));
    assert_eq!(
        input(r#"{"raw":7,"set":[],"unknown":1,"severity":{}}"#),
        Ok(Input::Status { set: Vec::new(), unknown: 1 })
    );
}

#[test]
fn a_signal_without_a_usable_value_says_why() {
    let digits = "`raw` of a longer text is an even number of hexadecimal digits, at most 8190";
    let reasons = [
        ("{}", "`value` is missing, and so is `raw`"),
        (r#"{"value":null}"#, "`value` is missing, and so is `raw`"),
        (r#"{"value":null,"raw":1.5}"#, "`raw` is an integer of up to 64 bits, not 1.5"),
        (r#"{"raw":"7"}"#, digits),
        (r#"{"value":"Pump 7","raw":"5075zz"}"#, digits),
        (&format!(r#"{{"value":"Pump 7","raw":"{}"}}"#, "0".repeat(8192)), digits),
        (r#"{"value":true}"#, "`value` is a number, a text or null, not true"),
        (r#"{"value":[[1]]}"#, "`value` is a number, a text or null, not [1]"),
        (r#"{"set":[]}"#, "missing field `unknown`"),
        (r#"{"unknown":0}"#, "missing field `set`"),
        (r#"{"value":1,"set":[],"unknown":0}"#, "it has a `value` and the bits of a status word"),
    ];
    for (signal, reason) in reasons {
        assert_eq!(input(signal), Err(format!("signal `s`: {reason}")), "{signal}");
    }
}

#[test]
fn a_line_that_is_not_complete_or_not_known_says_why() {
    let reasons = [
        ("{".to_owned(), "the line is no JSON object: EOF while parsing an object (column 1)"),
        ("[]".to_owned(), "invalid type: sequence, expected an object (column 0)"),
        (line(r#","signals":{"s":[1,2]}"#), "invalid type: sequence, expected an object (column 71)"),
        ("{}".to_owned(), "missing field `message` (column 2)"),
        (line(""), "missing field `signals`"),
        (r#"{"message":"m","signals":{}}"#.to_owned(), "missing field `identifier`"),
        (r#"{"message":"m","signals":{},"identifier":{}}"#.to_owned(), "missing field `selectors`"),
        (line(r#","signals":{},"signals":{}"#), "duplicate field `signals` (column 78)"),
        (line(r#","signals":{"s":{"raw":1},"s":{"raw":1}}"#), "duplicate field `s` (column 84)"),
        (line(r#","signals":{},"kind":"answer""#), r#"`kind` is request, reply or report, not "answer""#),
        (line(r#","signals":{},"time":"now""#), r#"`time` is a number or null, not "now""#),
        (
            line(r#","signals":{},"channel":"can 0""#),
            "the channel `can 0` is no name; a name has no blanks, no `#` and nothing invisible, and does not begin \
             with `(`",
        ),
        (
            line(r#","signals":{},"reserved":"0G""#),
            r#"`reserved` is an even number of hexadecimal digits, at most 16, not "0G""#,
        ),
        (unrecognised("foreign", r#""123""#, "null"), "missing field `data`"),
        (unrecognised("foreign", "291", r#""00""#), "`id` is a text, not 291"),
        (unrecognised("foreign", r#""1234""#, r#""00""#), "the identifier 1234 has 4 digits instead of 3 or 8"),
        (unrecognised("foreign", r#""123""#, r#""0""#), "the data have an odd number of digits, 1"),
        (unrecognised("foreign", r#""123""#, r#""001122334455667788""#), "the data have 9 bytes, more than 8"),
        (unrecognised("foreign", r#""20000004""#, r#""""#), "an error frame has no data to send"),
        (unrecognised("frame", r#""123""#, r#""""#), "a remote, error or FD frame is not made again"),
        (r#"{"message":null,"id":"123","data":""}"#.to_owned(), "missing field `problem`"),
    ];
    for (line, reason) in reasons {
        assert_eq!(why(&line), reason, "{line}");
    }
}

#[test]
fn an_unknown_member_is_named_with_the_known_ones() {
    assert!(why(&line(r#","signals":{},"value":1"#)).starts_with("unknown field `value`, expected one of `time`"));
    let reason = why(&line(r#","signals":{"s":{"vale":1}}"#));
    assert!(reason.starts_with("unknown field `vale`, expected one of `raw`, `value`, `unit`"), "{reason}");
}
