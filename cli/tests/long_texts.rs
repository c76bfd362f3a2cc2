//! Texts of more than eight bytes: the table shows them, JSON lines have their bytes, and both ways back give the frames.

mod calls;

use std::path::Path;

use serde_json::{Value, json};

/// Motor 1 has a label in two frames; one in three, whose last one only fills it up; and one that is no text.
const LABELS: &str = "\
(1.0) can0 621#0000656E50756D70
(1.0) can0 221#0001203720202020
(2.0) can0 621#0000656E50756D70
(2.0) can0 621#0001203720202020
(2.0) can0 221#0002202020202020
(3.0) can0 621#0000656E0156D700
(3.0) can0 221#0001203720202020
";

/// Motor 1 says that its note has 20 letters, and sends it.
const NOTE: &str = "\
(1.0) can0 211#1400000000000000
(1.1) can0 221#0100010203040506
(1.2) can0 221#020708536C6F7720
(1.3) can0 221#0370756D70206174
(1.4) can0 221#0420646F636B2037
(1.5) can0 221#0520202020202020
";

fn canspec(arguments: &[&str], input: &str) -> [String; 2] {
    canspec_by("long_texts", arguments, input)
}

fn canspec_by(spec: &str, arguments: &[&str], input: &str) -> [String; 2] {
    let specs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/specs/features");
    let spec = specs.join(spec).with_extension("yaml");
    calls::canspec(&spec, arguments, input).into()
}

/// Returns the objects of whole messages.
fn wholes(log: &str) -> Vec<Value> {
    wholes_by("long_texts", log)
}

fn wholes_by(spec: &str, log: &str) -> Vec<Value> {
    let [out, _] = canspec_by(spec, &["decode", "--assemble", "--format", "jsonl", "-"], log);
    let objects = out.lines().map(|line| serde_json::from_str::<Value>(line).expect("a line is an object"));
    objects.filter(|object| object.get("lines").is_some()).collect()
}

fn encoded(objects: &[Value]) -> [String; 2] {
    let lines = objects.iter().map(|object| format!("{object}\n")).collect::<Vec<_>>().concat();
    canspec(&["encode", "--from", "jsonl"], &lines)
}

#[test]
fn the_raw_bytes_of_a_text_are_hexadecimal_digits() {
    let texts: Vec<_> = wholes(LABELS).into_iter().map(|whole| whole["signals"]["text"].clone()).collect();
    let expected = [
        json!({"raw": "50756D70203720202020", "value": "Pump 7"}),
        json!({"raw": "50756D70203720202020202020202020", "value": "Pump 7"}),
        json!({"raw": "0156D700203720202020", "value": null}),
    ];
    assert_eq!(texts, expected);
}

#[test]
fn objects_become_the_same_frames_whatever_fills_them_up() {
    assert_eq!(encoded(&wholes(LABELS)), [LABELS, ""]);
}

#[test]
fn another_value_counts_and_not_the_bytes_beside_it() {
    let mut changed = wholes(LABELS).swap_remove(1);
    changed["signals"]["text"]["value"] = json!("Pump 12");
    assert_eq!(encoded(&[changed])[0], "(2.0) can0 621#0000656E50756D70\n(2.0) can0 221#0001203132202020\n");
    let mut longer = wholes(LABELS).swap_remove(0);
    longer["signals"]["text"]["value"] = json!("x".repeat(39));
    let [out, complaint] = encoded(&[longer]);
    assert!(out.is_empty() && complaint.contains("at most 38 ASCII characters without NUL"), "{complaint}");
}

#[test]
fn a_table_shows_the_text_or_its_bytes_and_tables_of_data_both() {
    let [table, _] = canspec(&["decode", "-"], LABELS);
    let rows: Vec<_> = table.lines().collect();
    assert!(rows[1].ends_with("language en  text Pump 7"), "{table}");
    assert!(rows[3].ends_with("language en  text ? (raw 0x0156D700203720202020)"), "{table}");
    assert!(rows[4].contains("unknown_value: text is not a text of the documented form"), "{table}");
    let [csv, _] = canspec(&["decode", "--assemble", "--format", "csv", "-"], LABELS);
    let cells = "label,report,report,motor 1,text,50756D70203720202020,Pump 7,,,656E50756D70203720202020,";
    assert!(csv.lines().any(|row| row.ends_with(cells)), "{csv}");
}

#[test]
fn a_text_that_lacks_a_part_is_absent() {
    let lost = LABELS.lines().filter(|line| !line.contains("621#0001")).collect::<Vec<_>>().join("\n");
    let whole = &wholes(&lost)[1];
    assert_eq!(whole["incomplete"], "part 1 is missing");
    assert_eq!(whole["signals"], json!({"language": {"raw": 25966, "value": "en"}}));
}

#[test]
fn a_table_of_data_has_no_cell_that_a_spreadsheet_takes_for_a_formula() {
    // The label is `=1+2`.
    let log = "(1.0) =cmd 621#0000656E3D312B32\n(1.1) =cmd 221#0001202020202020\n";
    let [csv, _] = canspec(&["decode", "--assemble", "--format", "csv", "-"], log);
    let cells = "1.1,'=cmd,221,long_texts,label,report,report,motor 1,text,3D312B32202020202020,'=1+2,,,";
    assert!(csv.contains(cells), "{csv}");
}

#[test]
fn a_message_that_a_device_ends_early_is_not_whole() {
    let whole = &wholes("211#0120214100000000")[0];
    assert_eq!((&whole["data"], &whole["incomplete"]), (&json!(null), &json!("7 bytes came, but the message has 25")));
    assert_eq!(whole["signals"], json!({"year": {"raw": 8225, "value": 2021}}));
    let [table, _] = canspec(&["decode", "-"], "211#0120214100000000");
    assert!(table.ends_with("! 7 bytes came, but the message has 25\n"), "{table}");
    assert!(
        encoded(std::slice::from_ref(whole))[1].ends_with("not made again: 7 bytes came, but the message has 25\n")
    );
}

#[test]
fn a_text_that_lacks_its_last_parts_is_absent_if_its_length_is_known() {
    let note = |log: &str| wholes_by("counted_text", log).swap_remove(0);
    assert_eq!(note(NOTE)["signals"]["text"]["value"], "Slow pump at dock 7");
    let (first_parts, _) = NOTE.split_once("(1.4)").expect("there is a fourth part");
    let cut = note(first_parts);
    assert_eq!(cut["incomplete"], "the parts 4, 5 are missing");
    assert_eq!(cut["signals"], json!({"writer": {"raw": "000102030405060708", "value": "000102030405060708"}}));
}

#[test]
fn a_text_has_its_least_length_also_if_a_device_counts_less() {
    let log = NOTE.replace("#14", "#01");
    let (first_parts, _) = log.split_once("(1.4)").expect("there is a fourth part");
    let whole = &wholes_by("counted_text", first_parts)[0];
    assert_eq!(whole["lines"], json!([2, 3, 4]));
    assert_eq!(whole["signals"]["text"]["value"], "Slow pump");
}

#[test]
fn arguments_make_as_few_frames_as_a_text_needs() {
    let made = |text: &str| {
        let text = format!("text={text}");
        canspec(&["encode", "report", "label", "language=de", &text, "--source", "1"], "")
    };
    assert_eq!(made("")[0], "221#0000646520202020\n");
    assert_eq!(made("Pumpe 77")[0], "621#0000646550756D70\n221#0001652037372020\n");
    assert!(made("Motör")[1].contains("ASCII characters"), "{:?}", made("Motör"));
    let maker = |serial: &str| {
        let serial = format!("serial={serial}");
        canspec(&["encode", "report", "maker", "year=2021", "name=ACME", &serial, "--source", "1"], "")
    };
    let frames = "611#01202141434D4520\n611#0220202020202020\n611#03FF0A0102030405\n211#0406070809FFFFFF\n";
    assert_eq!(maker("0a010203040506070809")[0], frames);
    assert!(maker("0A01")[1].contains("`0A01` is not 10 bytes of two hexadecimal digits each"), "{:?}", maker("0A01"));
}
