//! The shipped logs decode to what the vendors' documents say, and encode back to the same frames.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::LazyLock;

use serde_json::Value;

/// A log, its protocol, and what is expected of it. The protocol is built in or a file.
struct Session {
    name: &'static str,
    protocol: &'static str,
    model: Option<&'static str>,
    /// Commands or registers that the log uses.
    commands: &'static [u64],
    /// Lines whose request is outside the limits.
    out_of_range: &'static [u64],
    /// Lines that no model takes. They get no note, because no model is chosen.
    beyond_every_model: &'static [u64],
}

const SESSIONS: [Session; 9] = [
    Session {
        name: "infy-session",
        protocol: "infy",
        model: None,
        commands: &[1, 2, 3, 4, 6, 8, 9, 10, 11, 12, 19, 20, 22, 25, 26, 27, 28, 31],
        out_of_range: &[],
        beyond_every_model: &[34],
    },
    Session {
        name: "gcp-session",
        protocol: "gcp",
        model: Some("PS_M2_3AC_1000DC_30KW"),
        commands: &[1, 2, 3, 4, 6, 12, 15, 19, 20, 26, 27, 28],
        out_of_range: &[],
        beyond_every_model: &[],
    },
    Session {
        name: "gcp-dc-session",
        protocol: "gcp",
        model: Some("PS_M2_825DC_1000DC_30KW"),
        commands: &[1, 2, 3, 4, 6, 12, 15, 19, 20, 26, 27, 28],
        out_of_range: &[],
        beyond_every_model: &[],
    },
    Session {
        name: "trio-session",
        protocol: "trio",
        model: Some("PM_1AC_24DC_2500W"),
        commands: &[16, 17, 32, 33, 34, 35, 37, 39],
        out_of_range: &[10, 14, 15, 16, 99],
        beyond_every_model: &[],
    },
    Session {
        name: "mxr-session",
        protocol: "mxr",
        model: None,
        commands: &[
            1, 2, 3, 4, 5, 8, 10, 11, 12, 13, 14, 16, 17, 18, 23, 27, 30, 31, 32, 33, 34, 35, 48, 49, 62, 64, 67, 68,
            70, 72, 74, 75, 84, 85, 86, 87,
        ],
        out_of_range: &[],
        beyond_every_model: &[],
    },
    Session {
        name: "megmeet-session",
        protocol: "megmeet",
        model: Some("V48"),
        commands: &[64, 80, 128, 129, 130],
        out_of_range: &[634, 635, 636, 637, 638, 639, 640, 641, 642, 643, 644, 645, 646, 647, 648, 649],
        beyond_every_model: &[],
    },
    Session {
        name: "daly-session",
        protocol: "daly",
        model: None,
        commands: &[144, 145, 146, 147, 148, 149, 150, 151, 152],
        out_of_range: &[],
        beyond_every_model: &[],
    },
    Session {
        name: "gbt27930-session",
        protocol: "gbt27930",
        model: None,
        commands: &[],
        out_of_range: &[337, 338, 339],
        beyond_every_model: &[],
    },
    Session {
        name: "huawei-session",
        protocol: "huawei",
        model: Some("R4830S1"),
        commands: &[16, 17, 64, 80, 128, 129, 130, 210],
        out_of_range: &[484, 487, 490, 491, 494, 497, 508, 511, 516, 519, 534, 535, 542, 543],
        beyond_every_model: &[],
    },
];

/// The specs of whole protocols that do not ship; each has a log called after it.
static UNSHIPPED: LazyLock<Vec<Unshipped>> = LazyLock::new(|| {
    let entries = fs::read_dir(tests().join("specs")).expect("the folder exists").flatten().map(|entry| entry.path());
    let mut specs: Vec<_> = entries.filter(|path| path.extension().is_some_and(|ending| ending == "yaml")).collect();
    specs.sort();
    specs.iter().map(|spec| Unshipped::new(spec)).collect()
});

struct Unshipped {
    session: String,
    path: String,
    out_of_range: Vec<u64>,
}

impl Unshipped {
    fn new(path: &Path) -> Self {
        let session = format!("{}-session", path.file_stem().unwrap_or_default().to_string_lossy());
        let table = fs::read_to_string(tests().join(format!("logs/{session}.expected.tsv"))).expect("each has a table");
        let stated = table.lines().find_map(|line| line.strip_prefix("# out of range:")).unwrap_or_default();
        let out_of_range = stated.split_whitespace().map(|line| line.parse().expect("a line of the log")).collect();
        Self { session, path: path.to_string_lossy().into_owned(), out_of_range }
    }

    fn session(&'static self) -> Session {
        let Self { session: name, path: protocol, out_of_range } = self;
        Session { name, protocol, model: None, commands: &[], out_of_range, beyond_every_model: &[] }
    }
}

/// Returns every session.
fn sessions() -> impl Iterator<Item = Session> {
    SESSIONS.into_iter().chain(UNSHIPPED.iter().map(Unshipped::session))
}

fn tests() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests")
}

impl Session {
    /// Tests whether a line is a request that is not sent.
    fn refuses(&self, line: &Value) -> bool {
        is_noted(line) || line["line"].as_u64().is_some_and(|number| self.beyond_every_model.contains(&number))
    }

    fn file(&self, ending: &str) -> PathBuf {
        tests().join(format!("logs/{}.{ending}", self.name))
    }

    /// Returns the lines of the expected values without the line that explains them.
    fn expected(&self) -> Vec<String> {
        let text = fs::read_to_string(self.file("expected.tsv")).expect("the file ships");
        text.lines().filter(|line| !line.starts_with('#')).map(|line| line.trim_end().to_owned()).collect()
    }

    fn run(&self, command: &str, options: &[&str], input: &[u8]) -> Output {
        let option = if Path::new(self.protocol).is_absolute() { "--spec" } else { "--protocol" };
        let mut arguments = vec![command, option, self.protocol];
        arguments.extend(self.model.iter().flat_map(|model| ["--model", model]));
        arguments.extend(options);
        canspec(&arguments, input)
    }

    fn decode(&self, options: &[&str]) -> String {
        let log = self.file("log");
        let output = self.run("decode", &[options, &[&log.to_string_lossy()]].concat(), b"");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("the output is UTF-8")
    }

    fn decoded(&self) -> Vec<Value> {
        let text = self.decode(&["--format", "jsonl"]);
        text.lines().map(|line| serde_json::from_str(line).expect("each line is an object")).collect()
    }

    /// Encodes decoded lines.
    fn encode(&self, lines: &[Value]) -> Output {
        let lines: Vec<_> = lines.iter().map(Value::to_string).collect();
        self.run("encode", &["--from", "jsonl"], lines.join("\n").as_bytes())
    }
}

fn canspec(arguments: &[&str], input: &[u8]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let mut child = command
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command was built");
    let mut stdin = child.stdin.take().expect("standard input is a pipe");
    let input = input.to_vec();
    let writer = std::thread::spawn(move || std::io::Write::write_all(&mut stdin, &input));
    let output = child.wait_with_output().expect("the command ends");
    writer.join().expect("the writer ends").expect("the command reads its input");
    output
}

/// Shows a line of output as the expected values are written, the signals in the order of their names.
fn shown(line: &Value) -> String {
    let Some(message) = line["message"].as_str() else { return format!("{}\t-\t-", line["line"]) };
    let signals = line["signals"].as_object().expect("signals are an object");
    let signals: Vec<_> = signals.iter().map(|(name, signal)| format!("{name}={}", value(signal))).collect();
    let kind = line["kind"].as_str().expect("a kind");
    let numbers =
        line["lines"].as_array().map(|lines| lines.iter().map(Value::to_string).collect::<Vec<_>>().join(","));
    let number = numbers.unwrap_or_else(|| line["line"].to_string());
    format!("{number}\t{message}\t{kind}\t{}", signals.join("; ")).trim_end().to_owned()
}

/// Puts the signals of an expected line into the order of their names.
fn sorted(expected: &str) -> String {
    let Some((head, signals)) = expected.rsplit_once('\t') else { return expected.to_owned() };
    let mut signals: Vec<_> = signals.split("; ").collect();
    signals.sort_unstable();
    format!("{head}\t{}", signals.join("; ")).trim_end().to_owned()
}

/// Returns the command of a frame, or the register of a protocol that has registers.
fn command(line: &Value) -> Option<u64> {
    line["identifier"]["command"].as_u64().or(line["selectors"]["register"].as_u64())
}

fn value(signal: &Value) -> String {
    if let Some(set) = signal["set"].as_array() {
        let unknown = signal["unknown"].as_u64().unwrap_or_default();
        let unnamed = (0..64).filter(|bit| unknown >> bit & 1 == 1).map(|bit| format!("?{bit}"));
        let named = set.iter().filter_map(Value::as_str).map(str::to_owned);
        return format!("{{{}}}", named.chain(unnamed).collect::<Vec<_>>().join(","));
    }
    let text = plain(&signal["value"], &signal["raw"]);
    let unit = signal["unit"].as_str().filter(|_| !signal["value"].is_string());
    unit.map_or(text.clone(), |unit| format!("{text} {unit}"))
}

/// Shows a value without its unit, an array as `[1,2]`, a line end as `\r\n`, or the raw value of one that has no name.
fn plain(value: &Value, raw: &Value) -> String {
    match (value, raw) {
        (Value::String(text), _) => text.replace('\r', "\\r").replace('\n', "\\n"),
        (Value::Number(number), _) => number.to_string().trim_end_matches(".0").to_owned(),
        (Value::Array(values), Value::Array(raws)) => {
            let shown: Vec<_> = values.iter().zip(raws).map(|(value, raw)| plain(value, raw)).collect();
            format!("[{}]", shown.join(","))
        }
        _ => format!("?{raw}"),
    }
}

#[test]
fn each_session_decodes_to_the_values_of_the_document() {
    for session in sessions() {
        let lines = session.decoded();
        let expected = session.expected();
        for (line, expected) in lines.iter().zip(&expected) {
            assert_eq!(shown(line), sorted(expected), "{}", session.name);
        }
        assert_eq!(lines.len(), expected.len(), "{}", session.name);
    }
}

#[test]
fn the_transfers_of_a_charging_decode_to_the_values_of_the_document() {
    let session = Session {
        name: "gbt27930-transfers",
        protocol: "gbt27930",
        model: None,
        commands: &[],
        out_of_range: &[],
        beyond_every_model: &[],
    };
    let text = session.decode(&["--format", "jsonl", "--assemble"]);
    let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    let expected = session.expected();
    assert_eq!(lines.len(), expected.len());
    for (line, expected) in lines.iter().zip(&expected) {
        let whole = expected.strip_suffix("\tincomplete");
        assert_eq!(shown(line), sorted(whole.unwrap_or(expected)));
        assert_eq!(line.get("incomplete").is_some(), whole.is_some(), "{expected}");
    }
    let log = fs::read_to_string(session.file("log")).expect("the file ships");
    let output = session.run("encode", &["--from", "jsonl"], text.as_bytes());
    assert_eq!(String::from_utf8_lossy(&output.stdout), log, "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn each_session_uses_every_command() {
    for session in sessions() {
        let lines = session.decoded();
        let commands: BTreeSet<_> = lines.iter().filter_map(command).collect();
        assert!(session.commands.iter().all(|command| commands.contains(command)), "{}: {commands:?}", session.name);
    }
}

#[test]
fn each_session_encodes_back_to_the_same_frames() {
    for session in sessions() {
        let log = fs::read_to_string(session.file("log")).expect("the file ships");
        let accepted = |line: &Value| line["problem"]["kind"] != "frame" && !session.refuses(line);
        let accepted: Vec<_> = session.decoded().into_iter().filter(accepted).collect();
        let output = session.encode(&accepted);
        let frame = |line: &str| line.rsplit(' ').next().unwrap_or_default().to_owned();
        let encoded: Vec<_> = String::from_utf8_lossy(&output.stdout).lines().map(frame).collect();
        let numbers = accepted.iter().filter_map(|line| line["line"].as_u64()).collect::<BTreeSet<_>>();
        let printed = log.lines().zip(1..).filter(|(_, number)| numbers.contains(number)).map(|(line, _)| frame(line));
        assert_eq!(encoded, printed.collect::<Vec<_>>(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(output.status.success(), "{}", session.name);
    }
}

#[test]
fn a_log_of_several_protocols_encodes_back_whole() {
    // The third frame is of a battery, and the fourth of nobody.
    let log = "(1.5) can0 0283F000#43FA000040600000\n(1.6) can1 060F8008#42F0004300000001\n\
               (1.7) can1 18FF50E5#0102\n123#\n(1.8) can0 029C03F0#000B71B000003A98\n";
    let protocols = ["--protocol", "infy,mxr"];
    let lines = canspec(&[&["decode", "--format", "jsonl"], &protocols[..]].concat(), log.as_bytes()).stdout;
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the output is UTF-8");
    let encode = |protocols: &[&str], lines: &str| {
        let output = canspec(&[&["encode", "--from", "jsonl"], protocols].concat(), lines.as_bytes());
        (output.status.code(), text(output.stdout), text(output.stderr))
    };
    let lines = text(lines);
    assert!(lines.contains(r#""protocol":"infy""#) && lines.contains(r#""protocol":"mxr""#), "{lines}");
    assert_eq!(encode(&protocols, &lines), (Some(0), log.to_owned(), String::new()));
    let (status, _, said) = encode(&["--protocol", "trio,mxr"], &lines);
    assert_eq!((status, said.lines().count()), (Some(1), 2), "{said}");
    assert!(said.starts_with("<stdin>:1: the line is of protocol \"infy\", not `trio` or `mxr`\n"), "{said}");
    let (_, _, said) = encode(&protocols, &lines.replace(r#""protocol":"infy","#, ""));
    assert!(said.starts_with("<stdin>:1: missing field `protocol`; it is one of `infy`, `mxr`\n"), "{said}");
}

/// Tests whether a line is outside the limits, and not an answer, which a device may give as it likes.
fn is_noted(line: &Value) -> bool {
    line["kind"] != "reply"
        && line["notes"].as_array().is_some_and(|notes| notes.iter().any(|note| note["rule"] == "out_of_range"))
}

#[test]
fn each_request_outside_the_limits_is_noted_and_cannot_be_sent() {
    for session in sessions() {
        let lines = session.decoded();
        let noted: Vec<_> =
            lines.iter().filter(|line| is_noted(line)).filter_map(|line| line["line"].as_u64()).collect();
        assert_eq!(noted, session.out_of_range, "{}", session.name);
        let outside: Vec<_> = lines.into_iter().filter(|line| session.refuses(line)).collect();
        let output = session.encode(&outside);
        let refusals = String::from_utf8_lossy(&output.stderr);
        assert_eq!(refusals.lines().count(), outside.len(), "{refusals}");
        assert!(output.stdout.is_empty(), "{}", session.name);
    }
}

#[test]
fn each_session_of_a_protocol_that_does_not_ship_uses_every_message() {
    for Unshipped { path, .. } in UNSHIPPED.iter() {
        let output = canspec(&["check", "--format", "json", path], b"");
        let summary: Value = serde_json::from_slice(&output.stdout).expect("the summary is an object");
        let session = sessions().find(|session| session.protocol == path).expect("each spec has a session");
        let lines = session.decoded();
        let messages: BTreeSet<_> = lines.iter().filter_map(|line| line["message"].as_str()).collect();
        assert_eq!(Some(messages.len() as u64), summary["messages"].as_u64(), "{path}: {messages:?}");
    }
}

/// Splits the table into the text of each line of the log, with the wrapped parts joined. The row of a whole message
/// has the stamp and the identifier of its last frame, and is left out.
fn blocks(table: &str) -> Vec<String> {
    let mut blocks: Vec<String> = Vec::new();
    for row in table.lines().skip(1) {
        let words = row.split_whitespace().collect::<Vec<_>>().join(" ");
        match blocks.last_mut() {
            Some(block) if row.starts_with(' ') => *block = format!("{block} {words}"),
            _ => blocks.push(words),
        }
    }
    blocks.dedup_by_key(|block| block.split(' ').take(3).map(str::to_owned).collect::<Vec<_>>());
    blocks
}

/// Returns the elements of an array such as `[1,2]`; any other text is one element.
fn elements(text: &str) -> Vec<&str> {
    text.trim_start_matches('[').trim_end_matches(']').split(',').collect()
}

/// Tells whether a text of the table stands for a value of the document, element by element.
fn stands_for(text: &str, value: &str) -> bool {
    let (shown, exact) = (elements(text), elements(value));
    shown.len() == exact.len() && shown.iter().zip(exact).all(|(text, value)| element_stands_for(text, value))
}

/// Tells whether a text stands for one value: a number may be rounded to its last decimal.
fn element_stands_for(text: &str, value: &str) -> bool {
    let number = |text: &str| text.parse::<f64>().ok();
    match (number(text), number(value)) {
        (Some(shown), Some(exact)) => {
            let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
            let half = 0.5 / 10_f64.powi(i32::try_from(decimals).expect("it is small"));
            (shown - exact).abs() <= half * 1.000_001
        }
        _ => text == value,
    }
}

/// Tells whether the table shows `name=value unit`, or `name=?raw`, of a line.
fn has(block: &str, signal: &str) -> bool {
    let (name, value) = signal.split_once('=').expect("a signal has a value");
    let (value, unit) = value.split_once(' ').unwrap_or((value, ""));
    let block = block.replace(", ", ",");
    let words: Vec<&str> = block.split(' ').collect();
    words.windows(2).enumerate().filter(|(_, words)| words[0] == name).any(|(at, found)| {
        match value.strip_prefix('?') {
            Some(raw) => {
                let raw: u64 = raw.parse().expect("a raw value");
                words[at + 1..].join(" ").starts_with(&format!("? (raw {raw:#X})"))
            }
            None => stands_for(found[1], value) && (unit.is_empty() || words.get(at + 2) == Some(&unit)),
        }
    })
}

/// Tells whether the row of a line shows its message and each of its numbers and names.
fn shows(block: &str, expected: &str) -> Result<(), String> {
    let mut columns = expected.split('\t').skip(1);
    let message = columns.next().expect("a message");
    if message != "-" && !block.contains(&format!(" {message}")) {
        return Err(format!("{message} is not in {block:?}"));
    }
    let signals = columns.nth(1).unwrap_or_default();
    for signal in signals.split("; ").filter(|signal| signal.contains('=') && !signal.contains('{')) {
        if !has(block, signal) {
            return Err(format!("{signal:?} is not in {block:?}"));
        }
    }
    Ok(())
}

#[test]
fn a_rounded_number_stands_for_no_other_step_of_its_scale() {
    // 52657 and 52658 steps of 1/1024.
    assert!(stands_for("51.4229", "51.4228515625"));
    assert!(!stands_for("51.4229", "51.423828125") && !stands_for("51.4", "51.5"));
    assert!(stands_for("350.000", "350") && stands_for("on", "on"));
    assert!(stands_for("[3.3,3.301]", "[3.3,3.301]") && !stands_for("[3.3,3.302]", "[3.3,3.301]"));
    assert!(!stands_for("[3.3]", "[3.3,3.301]"));
    assert!(has("x cell [3.3, 3.301] V", "cell=[3.3,3.301] V") && !has("x cell [3.301, 3.3] V", "cell=[3.3,3.301] V"));
    assert!(has("x voltage 350.000 V", "voltage=350 V") && !has("x voltage 350.000 A", "voltage=350 V"));
    assert!(has("led ? (raw 0x2) ! x", "led=?2") && !has("led ? (raw 0x3)", "led=?2"));
}

#[test]
fn each_row_of_the_table_shows_the_values_of_the_document() {
    for session in sessions() {
        let blocks = blocks(&session.decode(&["--frames"]));
        let expected = session.expected();
        assert_eq!(blocks.len(), expected.len(), "{}", session.name);
        for ((block, line), object) in blocks.iter().zip(&expected).zip(session.decoded()) {
            if is_refusal(&object) {
                let signals = line.split('\t').nth(3).unwrap_or_default().split("; ");
                let names = signals.filter_map(|signal| Some(signal.split_once('=')?.0));
                let shown: Vec<_> = names.filter(|name| block.contains(&format!(" {name} "))).collect();
                assert!(block.contains(", data ") && shown.is_empty(), "{}: {shown:?} in {block:?}", session.name);
            } else {
                assert_eq!(shows(block, line), Ok(()), "{}", session.name);
            }
        }
    }
}

/// Tests whether a line is of a module that reports an error, so that its values mean nothing.
fn is_refusal(line: &Value) -> bool {
    let notes = line["notes"].as_array();
    line["kind"] != "request" && notes.is_some_and(|notes| notes.iter().any(|note| note["rule"] == "error_code"))
}
