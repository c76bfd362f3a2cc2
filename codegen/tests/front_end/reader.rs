//! The reader: keys, kinds and names.

use super::{WHOLE, errors, errors_after_whole, first, lines};

#[test]
fn an_unknown_key_is_reported_with_the_nearest_and_all_others() {
    let diagnostics = first(&format!("{WHOLE}timing:\n  a: {{time: 1 s, tilte: x}}\n"));
    let found: Vec<_> = diagnostics.located().collect();
    assert_eq!(diagnostics.concise(), "mini.yaml:9:18: error[unknown_key]: unknown key `tilte`");
    assert_eq!(found[0].place.map(|place| (place.end_line, place.end_column)), Some((9, 23)));
    let help = "did you mean `title`? allowed here: `time`, `minimum`, `role`, `tries`, `messages`, `title`, `note`, `section`, `erratum`";
    assert_eq!(found[0].help, Some(help));
}

#[test]
fn an_unknown_key_that_resembles_none_is_reported_with_all_that_are_allowed() {
    let diagnostics = first(&format!("{WHOLE}foreign: {{a: {{match: {{}}, whatever: x}}}}\n"));
    let help = "allowed here: `match`, `title`, `note`, `section`, `erratum`";
    assert_eq!(diagnostics.located().next().and_then(|found| found.help), Some(help));
}

#[test]
fn all_missing_keys_are_reported_at_their_parent() {
    assert_eq!(
        errors("note: x\n"),
        [
            "mini.yaml:1:1: error[unknown_key]: unknown key `note`",
            "mini.yaml:1:1: error[missing_key]: missing key `canspec`",
            "mini.yaml:1:1: error[missing_key]: missing key `protocol`",
            "mini.yaml:1:1: error[missing_key]: missing key `title`",
            "mini.yaml:1:1: error[missing_key]: missing key `length`",
            "mini.yaml:1:1: error[missing_key]: missing key `identifier`",
            "mini.yaml:1:1: error[missing_key]: missing key `access`",
        ]
    );
    let found = errors_after_whole("errata:\n  A1: {kind: typing, prints: x}\n");
    assert_eq!(
        found,
        [
            "mini.yaml:9:3: error[missing_key]: missing key `uses` in `errata.A1`",
            "mini.yaml:9:3: error[missing_key]: missing key `because` in `errata.A1`",
        ]
    );
}

#[test]
fn a_missing_key_of_an_item_is_reported_at_its_first_line() {
    let diagnostics =
        first(&format!("{WHOLE}types:\n  a:\n    examples:\n      - bytes: 00 # zero\n        section: x\n"));
    let place = diagnostics.located().next().and_then(|found| found.place).expect("a place");
    assert_eq!(
        diagnostics.concise(),
        "mini.yaml:11:9: error[missing_key]: missing key `means` in `types.a.examples[0]`"
    );
    assert_eq!((place.end_line, place.end_column), (11, 25));
}

#[test]
fn values_of_the_wrong_kind_are_all_reported() {
    let found = errors_after_whole(
        "messages:
  one:
    access: read
    fields: x
    match: [1]
    title: {a: b}
    examples:
      - text
      - {reply: [1], notes: none, means: {a: b}}
    value: [1]
bit_rates: [1, [2], {a: b}]
types: {a: {type: {b: c}, erratum: [[x]]}}
header: []
",
    );
    assert_eq!(
        found,
        [
            "mini.yaml:10:13: error[wrong_kind]: expected a list for `access`, found the text `read`",
            "mini.yaml:11:13: error[wrong_kind]: expected a map for `fields`, found the text `x`",
            "mini.yaml:12:5: error[wrong_kind]: expected a map for `match`, found a list",
            "mini.yaml:13:5: error[wrong_kind]: expected a text for `title`, found a map",
            "mini.yaml:15:9: error[wrong_kind]: expected a map for an item of `messages.one.examples`, found the text `text`",
            "mini.yaml:16:29: error[wrong_kind]: expected a list for `notes`, found the text `none`",
            "mini.yaml:17:5: error[wrong_kind]: expected a map for `value`, found a list",
            "mini.yaml:18:16: error[wrong_kind]: expected a text for an item of `bit_rates`, found a list",
            "mini.yaml:18:21: error[wrong_kind]: expected a text for an item of `bit_rates`, found a map",
            "mini.yaml:19:13: error[wrong_kind]: expected a name or a list of names for `type`, found a map",
            "mini.yaml:19:37: error[wrong_kind]: expected a text for an item of `types.a.erratum`, found a list",
            "mini.yaml:20:1: error[wrong_kind]: expected a map for `header`, found a list",
        ]
    );
}

#[test]
fn a_place_in_the_identifier_is_a_text_or_a_field() {
    let text = WHOLE.replace("{command: {bits: 10..0}}", "{command: {bitz: 1}, ones: [6..1], zeros: 7}");
    assert_eq!(
        errors(&text),
        [
            "mini.yaml:6:24: error[unknown_key]: unknown key `bitz`",
            "mini.yaml:6:34: error[wrong_kind]: expected a field, or a place such as `6..1` after `ones` or `zeros` for `ones`, found a list",
        ]
    );
}

#[test]
fn a_list_does_not_stand_for_a_map() {
    let text = WHOLE.replace("{title: Mini CAN, version: V1}", "[Mini CAN, V1]");
    assert_eq!(errors(&text), ["mini.yaml:4:1: error[wrong_kind]: expected a map for `document`, found a list"]);
}

#[test]
fn a_long_text_is_shortened() {
    let found = errors_after_whole(&format!("types: {}\n", "é".repeat(50)));
    let shown = "é".repeat(40);
    assert_eq!(
        found,
        [format!("mini.yaml:8:8: error[wrong_kind]: expected a map for `types`, found the text `{shown}...`")]
    );
}

#[test]
fn keys_that_look_like_messages_do_not_confuse_the_reader() {
    let found = errors_after_whole("\"x`, expected `y\": 1\n\"missing field `a`\": 2\ntypes: \"x, expected a list\"\n");
    assert_eq!(
        found,
        [
            "mini.yaml:8:1: error[unknown_key]: unknown key `x`, expected `y`",
            "mini.yaml:9:1: error[unknown_key]: unknown key `missing field `a``",
            "mini.yaml:10:8: error[wrong_kind]: expected a map for `types`, found the text `x, expected a list`",
        ]
    );
}

#[test]
fn errors_of_gate_and_reader_are_reported_together_by_place() {
    let found = errors_after_whole("models: {a: {itemz: []}}\ntypes: {a: {note: yes}, a: {}}\nwhat: x\n");
    assert_eq!(
        found,
        [
            "mini.yaml:8:14: error[unknown_key]: unknown key `itemz`",
            "mini.yaml:9:19: error[plain_word]: `yes` is written without quotes",
            "mini.yaml:9:25: error[duplicate_key]: duplicate key `a`",
            "mini.yaml:10:1: error[unknown_key]: unknown key `what`",
        ]
    );
}

#[test]
fn a_hundred_errors_of_the_reader_are_reported() {
    let keys = lines(150, |number| format!("key{number}: x\n"));
    assert_eq!(errors_after_whole(&keys).len(), 100);
}
