//! Many devices that send long messages at a time. A search through all of them for each frame would take long.

use canspec_codegen::interpret::{Assembled, Assembly, decode};
use canspec_codegen::model::Protocol;

use super::{feature, frame, written};

/// How many messages have begun at a time.
const MANY: u32 = 30_000;

/// The beginning of each spec, up to the fields of the identifier.
const HEAD: &str = "canspec: 1\nprotocol: busy\ntitle: T\ndocument: {title: T, version: V}\nlength: 8\nidentifier: ";

/// Nodes whose messages have two parts.
const PARTS: &str = "{node: {bits: 28..1}, direction: {bits: 0}}
types: {node: {range: 0..0xFFFFFFF}}
addressing: {one: {request: {node: node, direction: 1}, one: {node: node, direction: 0}}}
access: {report: {report: {}, answers: {one: one}}}
messages:
  m: {section: \"1\", access: [report], parts: {number: {bytes: 0}, first: 1, data: 1..7},
    fields: {text: {bytes: 0..13, as: text}}}
";

/// Nodes with messages of several frames.
const ISOTP: &str = "{node: {bits: 28..1}, direction: {bits: 0}}
types: {node: {range: 0..0xFFFFFFF}}
addressing: {one: {request: {node: node, direction: 1}, one: {node: node, direction: 0}}}
transports: {tp: {kind: isotp, section: \"1\"}}
access: {write: {request: {}, answers: {one: nobody}}}
messages:
  m: {section: \"2\", access: [write], via: tp, length: 8..30,
    fields: {item: {bytes: 0, const: 0x2E}, text: {bytes: 1.., as: text}}}
";

/// Nodes that send each other messages of several packets.
const J1939: &str = "{priority: {bits: 28..26, send: 6}, page: {bits: 25..24, const: 0}, format: {bits: 23..16}, \
     target: {bits: 15..8}, source: {bits: 7..0}}
types: {unit: {range: 0..0xC7, outside: refused}, tool: {range: 0xC8..0xFE, outside: refused, send: 0xC8}}
addressing:
  one: {request: {target: unit, source: tool}, one: {target: tool, source: unit}}
transports: {tp: {kind: j1939, section: \"1\", group: [page, format, target], target: target, source: source,
    send: {priority: 7}}}
access: {report: {report: {}, answers: {one: one}}}
messages:
  m: {section: \"2\", match: {format: 2}, access: [report], via: tp, length: 14,
    fields: {text: {bytes: 0..13, as: text}}}
";

/// Puts frames together, each at a time in milliseconds. It returns the messages of each frame, and those at the end.
fn ended(protocol: &Protocol, frames: impl IntoIterator<Item = (u64, String)>) -> Vec<Vec<Assembled<u64>>> {
    let mut assembly = Assembly::default();
    let frames = frames.into_iter().map(|(time, text)| {
        let frame = frame(&text);
        let decoded = decode(protocol, None, &frame).unwrap_or_else(|problem| panic!("{text}: {}", problem.text));
        assembly.take_at(Some(time * 1_000_000), (protocol, None), time, &frame, &decoded).ended
    });
    let mut ended: Vec<_> = frames.collect();
    ended.push(assembly.finish(protocol, None));
    ended
}

/// Returns when the frames of each message came.
fn marks(ended: &[Vec<Assembled<u64>>]) -> Vec<Vec<Vec<u64>>> {
    ended.iter().map(|whole| whole.iter().map(|whole| whole.marks.clone()).collect()).collect()
}

/// Tests that many messages begin one after the other, and then go on one after the other.
fn check(spec: &str, first: impl Fn(u32) -> String, then: impl Fn(u32) -> String, missing: Option<&str>) {
    let protocol = written(&format!("{HEAD}{spec}"));
    let frames = (0..MANY).map(&first).chain((0..MANY).map(&then));
    let ended = ended(&protocol, (0..).zip(frames));
    let (before, after) = ended.split_at(MANY as usize);
    assert!(before.iter().all(Vec::is_empty));
    for (number, whole) in (0..).zip(&after[..MANY as usize]) {
        let [whole] = whole.as_slice() else { panic!("message {number} ends") };
        assert_eq!((whole.marks[0], whole.incomplete.as_deref()), (number, missing));
    }
    assert!(after[MANY as usize].is_empty());
}

#[test]
fn parts_of_many_nodes_are_joined() {
    let part = |part: u8| move |node: u32| format!("{:08X}#{part:02X}41424344454647", node << 1);
    check(PARTS, part(1), part(2), None);
}

#[test]
fn answers_of_many_receivers_find_their_messages() {
    let no_room = Some("6 of 30 bytes came; the receiver has no room for it");
    let first = |node: u32| format!("{:08X}#101E2E4142434445", node << 1 | 1);
    check(ISOTP, first, |node| format!("{:08X}#3200000000000000", node << 1), no_room);
}

#[test]
fn packets_between_many_pairs_of_nodes_are_joined() {
    const PAIRS: u32 = 200 * 55;
    let pair = |kind: u32, number: u32| 0x1C00_0000 | (kind << 16) | ((0xC8 + number / 200) << 8) | (number % 200);
    let aborted = Some("packet 2 is missing; packet 1 came twice, with other data");
    let protocol = written(&format!("{HEAD}{J1939}"));
    let announced = (0..PAIRS).map(|number| format!("{:08X}#100E0002FF000200", pair(0xEC, number)));
    let packet = |number| format!("{:08X}#0141424344454647", pair(0xEB, number));
    let other = |number| format!("{:08X}#0151424344454647", pair(0xEB, number));
    let packets = (0..PAIRS).flat_map(|number| [packet(number), other(number)]);
    let ended = ended(&protocol, (0..).zip(announced.chain(packets)));
    let ended: Vec<_> = ended.into_iter().flatten().collect();
    assert_eq!(ended.len(), PAIRS as usize);
    for (number, whole) in (0..).zip(&ended) {
        assert_eq!((whole.marks[0], whole.incomplete.as_deref()), (number, aborted));
    }
}

#[test]
fn many_messages_that_have_begun_are_reported_at_the_end() {
    let protocol = written(&format!("{HEAD}{PARTS}"));
    let frames = (0..MANY).map(|node| format!("{:08X}#0141424344454647", node << 1));
    let ended = ended(&protocol, (0..).zip(frames));
    let (last, before) = ended.split_last().expect("there is what the end brings");
    assert!(before.iter().all(Vec::is_empty));
    let marks: Vec<_> = last.iter().map(|whole| whole.marks[0]).collect();
    assert_eq!(marks, (0..u64::from(MANY)).collect::<Vec<_>>());
}

#[test]
fn the_end_brings_messages_in_the_order_in_which_they_began() {
    let parts = feature("parts");
    let (first, second, third) = ("010201E8030A0000", "020B000C004A0100", "034B110000000000");
    let frames = [(1, first), (2, first), (3, first), (2, second), (2, third), (2, first), (3, second)];
    let frames = (0..).zip(frames.map(|(node, data)| format!("05{node}#{data}")));
    let mut ended = marks(&ended(&parts, frames));
    assert_eq!(ended.pop(), Some(vec![vec![0], vec![2, 6], vec![5]]));
    assert_eq!(ended[4], [[1, 3, 4]]);
}

#[test]
fn silence_is_counted_from_the_last_part_of_each_node() {
    let trips = feature("parts_until_silence");
    let frame = |time: u64, node: u32, data: &str| (time, format!("21{node}#{data}"));
    let (one, two) = ("010005000A000F00", "0200140019001E00");
    // The pause is 50 ms. Nodes 1 and 2 begin together, and a repeated part of node 3 counts as one.
    let frames = [
        frame(100, 2, one),
        frame(100, 1, one),
        frame(110, 3, one),
        frame(120, 3, one),
        frame(149, 4, one),
        frame(150, 4, two),
        frame(169, 5, one),
        frame(170, 5, two),
        frame(1_000, 6, one),
        // The clock of the log steps back, and silence is counted from there.
        frame(300, 6, two),
        frame(350, 7, one),
    ];
    let ended = marks(&ended(&trips, frames));
    let expected: [&[&[u64]]; 12] = [
        &[],
        &[],
        &[],
        &[],
        &[],
        &[&[100], &[100]],
        &[],
        &[&[110]],
        &[&[149, 150], &[169, 170]],
        &[],
        &[&[1_000, 300]],
        &[&[350]],
    ];
    assert_eq!(ended, expected);
}
