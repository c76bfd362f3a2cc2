//! What the front end reads, refuses and says.

use canspec_codegen::diagnostic::{At, Diagnostic, Diagnostics, Severity};
use canspec_codegen::source::{SIZE_LIMIT, Source};
use canspec_codegen::syntax::tree::{Content, Path};
use canspec_codegen::syntax::{ast, parse};

/// Seven lines that are a whole spec; what a test adds starts at line 8.
const WHOLE: &str = "\
canspec: 1
protocol: mini
title: Mini
document: {title: Mini CAN, version: V1}
length: 8
identifier: {command: {bits: 10..0}}
access: {read: {request: {}, reply: {}}}
";

fn source(text: &str) -> Source {
    Source::new("mini.yaml", text.as_bytes().to_vec()).expect("the text is accepted")
}

fn refusal(bytes: &[u8]) -> String {
    Source::new("mini.yaml", bytes.to_vec()).expect_err("the bytes are refused").concise()
}

fn errors(text: &str) -> Vec<String> {
    let (spec, diagnostics) = parse(source(text));
    assert_eq!(spec.is_none(), diagnostics.has_errors());
    diagnostics.concise().lines().map(str::to_owned).collect()
}

fn errors_after_whole(added: &str) -> Vec<String> {
    errors(&format!("{WHOLE}{added}"))
}

fn spec(added: &str) -> ast::Spec {
    let (spec, diagnostics) = parse(source(&format!("{WHOLE}{added}")));
    assert_eq!(diagnostics.concise(), "");
    spec.expect("a spec without errors")
}

fn lines(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(line).collect::<Vec<_>>().concat()
}

fn first(text: &str) -> Diagnostics {
    parse(source(text)).1
}

#[test]
fn a_whole_spec_is_read() {
    let spec = spec("messages:\n  one: {access: [read], fields: {voltage: {bytes: 0..3, as: float, unit: V}}}\n");
    assert_eq!(spec.protocol, "mini");
    assert_eq!(spec.messages["one"].fields["voltage"].bytes.as_deref(), Some("0..3"));
    assert!(matches!(&spec.identifier["command"], ast::IdentifierEntry::Field(field) if field.bits.is_some()));
}

#[test]
fn every_leaf_is_the_text_of_the_file() {
    let spec = spec(
        "timing: {a: {time: 0x10}, b: {time: 16}, c: {time: 18E5}, d: {time: 1_000}, e: {time: 010}, f: {time: .inf}}\n\
         types: {a: {values: {0x10: 1.50, 16: 2024-05-13, 0: \"on\"}}}\n",
    );
    let times: Vec<_> = spec.timing.values().map(|timing| timing.time.as_str()).collect();
    assert_eq!(times, ["0x10", "16", "18E5", "1_000", "010", ".inf"]);
    let values: Vec<_> = spec.types["a"].values.iter().map(|(raw, name)| (raw.as_str(), name.as_str())).collect();
    assert_eq!(values, [("0x10", "1.50"), ("16", "2024-05-13"), ("0", "on")]);
}

#[test]
fn texts_of_several_lines_and_comments_are_read() {
    let spec = spec(
        "# a ? in a comment\nprocedures:\n  start:\n    steps: # ?\n    - |\n      one\n      two\n    - >-\n      three\n      four\n    - five\n      six?\n",
    );
    assert_eq!(spec.procedures["start"].steps, ["one\ntwo\n", "three four", "five six?"]);
}

#[test]
fn one_document_with_its_mark_is_read() {
    assert_eq!(errors(&format!("---\n{WHOLE}...\n")), [""; 0]);
}

// The text.

#[test]
fn a_byte_order_mark_at_the_start_is_skipped() {
    let source = source(&format!("\u{FEFF}{WHOLE}"));
    assert_eq!(source.text(), WHOLE);
}

#[test]
fn a_byte_order_mark_inside_is_refused() {
    let expected = "mini.yaml:1:4: error[encoding]: the byte order mark U+FEFF may not stand in a spec";
    assert_eq!(refusal("a: \u{FEFF}b\n".as_bytes()), expected);
}

#[test]
fn bytes_that_are_not_utf_8_are_refused_with_their_place() {
    let expected = "mini.yaml:2:4: error[encoding]: byte 9 of the file, 0xE9, is not UTF-8";
    assert_eq!(refusal(b"a: \xC3\xA9\nb: \xE9\n"), expected);
}

#[test]
fn control_characters_are_refused_with_their_places() {
    let expected = "\
mini.yaml:1:4: error[encoding]: the control character U+0000 may not stand in a spec
mini.yaml:2:5: error[encoding]: the control character U+001B may not stand in a spec
mini.yaml:3:4: error[encoding]: the control character U+007F may not stand in a spec";
    assert_eq!(refusal("a: \0\nb: é\u{1B}\nc: \u{7F}\n".as_bytes()), expected);
}

#[test]
fn line_separators_of_unicode_are_refused() {
    for character in ['\u{85}', '\u{2028}', '\u{2029}'] {
        let expected = format!(
            "mini.yaml:1:5: error[encoding]: the line separator that not every reader takes for one U+{:04X} may not stand in a spec",
            u32::from(character)
        );
        assert_eq!(refusal(format!("a: b{character}c\n").as_bytes()), expected);
    }
}

#[test]
fn marks_that_reverse_the_direction_of_text_are_refused() {
    let expected =
        "mini.yaml:1:4: error[encoding]: the mark that reverses the direction of text U+202E may not stand in a spec";
    assert_eq!(refusal("a: \u{202E}b\n".as_bytes()), expected);
}

#[test]
fn a_carriage_return_by_itself_is_refused() {
    let expected =
        "mini.yaml:2:5: error[encoding]: the carriage return without a line feed U+000D may not stand in a spec";
    assert_eq!(refusal(b"a: b\r\nc: d\re: f\r\n"), expected);
}

#[test]
fn lines_that_end_in_crlf_keep_their_columns() {
    let text = format!("{WHOLE}x: 1\n").replace('\n', "\r\n");
    assert_eq!(errors(&text), ["mini.yaml:8:1: error[unknown_key]: unknown key `x`"]);
    let text = format!("{WHOLE}messages:\n  one:\n    note: |\n      é\n      é\n    x: 1\n    access: []\n")
        .replace('\n', "\r\n");
    assert_eq!(errors(&text), ["mini.yaml:13:5: error[unknown_key]: unknown key `x`"]);
}

#[test]
fn columns_count_characters() {
    let found = errors_after_whole("messages: {\"°C é €\": {access: [], x: 1}}\n");
    assert_eq!(found, ["mini.yaml:8:35: error[unknown_key]: unknown key `x`"]);
}

#[test]
fn lines_and_columns_count_from_one() {
    let source = source("ab\n\u{B0}c\n");
    assert_eq!(source.line_column(0), (1, 1));
    assert_eq!(source.line_column(2), (1, 3));
    assert_eq!(source.line_column(3), (2, 1));
    assert_eq!(source.line_column(5), (2, 2));
    assert_eq!(source.line_column(7), (3, 1));
    assert_eq!(source.line_column(1000), (3, 1));
}

#[test]
fn columns_of_a_long_line_are_those_of_its_characters() {
    let text = "é€a".repeat(1000);
    let source = source(&text);
    for (position, (offset, _)) in text.char_indices().enumerate() {
        assert_eq!(source.line_column(offset), (1, position + 1));
    }
}

// The file.

#[test]
fn a_missing_file_is_one_error() {
    let refused = Source::read("no/such/file.yaml").expect_err("there is no such file");
    assert_eq!(refused.concise(), "no/such/file.yaml: error[file]: there is no such file");
    assert_eq!(refused.errors(), 1);
}

#[test]
fn a_folder_is_refused() {
    let refused = Source::read("src").expect_err("a folder");
    assert_eq!(refused.concise(), "src: error[file]: this is a folder, not a spec");
}

#[test]
fn a_file_is_read() {
    let source = Source::read("Cargo.toml").expect("the file of this package");
    assert_eq!(source.name(), "Cargo.toml");
    assert!(source.text().starts_with("[package]"));
}

#[test]
fn a_large_text_is_refused() {
    assert_eq!(refusal(&vec![b'a'; SIZE_LIMIT + 1]), "mini.yaml: error[file]: the file is larger than 4 MiB");
    assert!(Source::new("mini.yaml", vec![b'a'; SIZE_LIMIT]).is_ok());
}

// The gate.

#[test]
fn every_duplicate_key_is_reported_with_both_places() {
    let text = format!("{WHOLE}types:\n  a: {{}}\n  \"a\": {{}}\n  'a': {{}}\ntitle: again\n");
    let diagnostics = first(&text);
    let found: Vec<_> = diagnostics.located().collect();
    let expected = [(10, 9, "a", 3), (11, 9, "a", 3), (12, 3, "title", 1)];
    assert_eq!(found.len(), expected.len());
    for (found, (line, first, key, column)) in found.iter().zip(expected) {
        assert_eq!((found.rule, found.message), ("duplicate_key", format!("duplicate key `{key}`").as_str()));
        let place = found.place.expect("a place");
        assert_eq!((place.line, place.column), (line, column));
        let other = found.others[0].place.expect("a place");
        assert_eq!((other.line, other.column, found.others[0].text), (first, column, "first given here"));
    }
}

#[test]
fn plain_words_that_mean_several_things_are_refused_anywhere() {
    for word in ["on", "off", "yes", "no", "y", "n", "true", "false", "null", "~", "ON", "Off", "nO", "NULL"] {
        let message = format!("error[plain_word]: `{word}` is written without quotes");
        let found = errors_after_whole(&format!("models: {{a: {{items: [{word}], facts: {{{word}: {word}}}}}}}\n"));
        let columns = [22, 33 + word.len(), 35 + 2 * word.len()];
        let expected = columns.map(|column| format!("mini.yaml:8:{column}: {message}"));
        assert_eq!(found, expected);
    }
}

#[test]
fn quoted_words_and_words_in_a_text_are_kept() {
    let spec = spec("types: {a: {values: {0: \"on\", 1: 'no', 2: no load, 3: truely}}}\n");
    assert_eq!(spec.types["a"].values.values().collect::<Vec<_>>(), ["on", "no", "no load", "truely"]);
}

#[test]
fn a_key_without_a_value_is_refused() {
    let found = errors_after_whole("messages:\nmodels: {a, b: }\nbit_rates:\n  -\n  - 1\n");
    assert_eq!(
        found,
        [
            "mini.yaml:8:1: error[wrong_kind]: `messages` has no value",
            "mini.yaml:9:10: error[wrong_kind]: `a` has no value",
            "mini.yaml:9:13: error[wrong_kind]: `b` has no value",
            "mini.yaml:11:4: error[wrong_kind]: this item of the list has no value",
        ]
    );
}

#[test]
fn anchors_aliases_tags_and_merge_keys_are_refused() {
    let found = errors_after_whole("models:\n  a: &a {note: !!str x}\n  b: *a\n  c: {<<: {note: x}}\n");
    assert_eq!(
        found,
        [
            "mini.yaml:9:6: error[yaml]: an anchor may not stand in a spec",
            "mini.yaml:9:16: error[yaml]: a tag may not stand in a spec",
            "mini.yaml:10:6: error[yaml]: an alias may not stand in a spec",
            "mini.yaml:11:7: error[yaml]: a merge key `<<` may not stand in a spec",
            "mini.yaml:11:7: error[unknown_key]: unknown key `<<`",
        ]
    );
}

#[test]
fn an_alias_of_nothing_is_refused() {
    let found = errors_after_whole("note: *a\n");
    assert_eq!(found, ["mini.yaml:8:7: error[yaml]: an alias may not stand in a spec"]);
}

#[test]
fn a_second_document_is_refused() {
    let found = errors_after_whole("---\na: b\n");
    assert_eq!(found, ["mini.yaml:8:1: error[yaml]: a second document starts here"]);
}

#[test]
fn question_marks_before_keys_are_refused() {
    let refused = "error[yaml]: a `?` before a key may not stand in a spec";
    assert_eq!(errors_after_whole("? types\n: {}\n"), [format!("mini.yaml:8:1: {refused}")]);
    assert_eq!(errors_after_whole("types: {? a : {}}\n"), [format!("mini.yaml:8:9: {refused}")]);
    assert_eq!(
        errors_after_whole("types:\n  a: {}\n  ? # why?\n    b\n  : {}\n"),
        [format!("mini.yaml:10:3: {refused}")]
    );
}

#[test]
fn question_marks_in_texts_keys_and_comments_are_kept() {
    let spec = spec("procedures: # ?\n  a?: {steps: [why?, \"?\"]} # ?\n  ?b: {steps: [?c]}\n");
    assert_eq!(spec.procedures.keys().collect::<Vec<_>>(), ["a?", "?b"]);
}

#[test]
fn keys_that_are_no_text_are_refused() {
    let found = errors_after_whole("types:\n  [a, b]: {}\n  {c: d}: {}\n  : {}\n");
    assert_eq!(
        found,
        [
            "mini.yaml:9:3: error[yaml]: a key that is no text may not stand in a spec",
            "mini.yaml:10:3: error[yaml]: a key that is no text may not stand in a spec",
            "mini.yaml:11:3: error[wrong_kind]: this key has no name",
        ]
    );
}

#[test]
fn an_empty_file_is_refused() {
    for text in ["", "\n\n", "# nothing\n", "---\n", "--- # nothing\n...\n"] {
        let found = errors(text);
        assert_eq!(found, ["mini.yaml:1:1: error[yaml]: the file is empty"], "{text:?}");
    }
}

#[test]
fn a_file_that_is_no_map_is_refused() {
    let expected = "mini.yaml:1:1: error[wrong_kind]: expected a map of the whole spec, found";
    assert_eq!(errors("[a, b]\n"), [format!("{expected} a list")]);
    assert_eq!(errors("just a text\n"), [format!("{expected} the text `just a text`")]);
    assert_eq!(errors("on\n"), [format!("{expected} the text `on`")]);
}

#[test]
fn escapes_for_control_characters_are_refused() {
    let found = errors_after_whole("bit_rates: [\"a\\0\", \"\\e[1m\", \"\\n\\t\\\\\"]\n");
    assert_eq!(
        found,
        [
            "mini.yaml:8:13: error[encoding]: the text holds the control character U+0000",
            "mini.yaml:8:20: error[encoding]: the text holds the control character U+001B",
        ]
    );
}

#[test]
fn control_characters_do_not_reach_the_messages() {
    let found = errors_after_whole("\"\\e[31m\": a\n");
    assert_eq!(found[1], "mini.yaml:8:1: error[unknown_key]: unknown key `\u{FFFD}[31m`");
}

#[test]
fn what_is_not_yaml_is_said_in_words() {
    let cases = [
        ("a: 'x\n", "8:4", "this quoted text is never closed"),
        ("a: b: c\n", "8:5", "a `:` that ends no key"),
        ("a: [1, 2\nb: 3\n", "9:2", "a `:` that ends no key"),
        ("a: {b: c\n", "9:1", "expected `,` or `}` in this map"),
        ("a:\n\tb: c\n", "9:2", "a tab stands where only spaces may"),
        ("a:\n  - 1\n  b: 2\n", "10:3", "expected a `-` at this indentation"),
        ("a:\n  b: 1\n c: 2\n", "10:2", "expected a key at this indentation"),
        ("a: [b,, c]\n", "8:7", "expected a value here"),
        ("a: [b]]\n", "8:7", "a closing bracket without an opening one"),
        ("a: \"b\" c\n", "8:8", "text after a closing quote"),
        ("a: - b\n", "8:4", "a `-` that starts no item"),
        ("a: [- b]\n", "8:5", "a `-` that starts no item"),
        ("  a: b\n", "8:3", "expected a key at this indentation"),
        ("a: @b\n", "8:4", "an unquoted text cannot start with this character"),
        ("a: \"\\q\"\n", "8:4", "unknown escape in a text in double quotes"),
        ("just a line\n", "9:1", "a line without a `:`"),
    ];
    for (text, place, message) in cases {
        assert_eq!(errors_after_whole(text), [format!("mini.yaml:{place}: error[yaml]: {message}")], "{text:?}");
    }
}

// The reader.

#[test]
fn an_unknown_key_is_reported_with_the_nearest_and_all_others() {
    let diagnostics = first(&format!("{WHOLE}timing:\n  a: {{time: 1 s, tilte: x}}\n"));
    let found: Vec<_> = diagnostics.located().collect();
    assert_eq!(diagnostics.concise(), "mini.yaml:9:18: error[unknown_key]: unknown key `tilte`");
    assert_eq!(found[0].place.map(|place| (place.end_line, place.end_column)), Some((9, 23)));
    let help = "did you mean `title`? allowed here: `time`, `minimum`, `title`, `note`, `section`, `erratum`";
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
            "mini.yaml:1:1: error[missing_key]: missing key `document`",
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
      - {reply: [1], notes: none, means: {a: [{b: c}]}}
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
            "mini.yaml:16:10: error[wrong_kind]: expected a text for `reply`, found a list",
            "mini.yaml:16:29: error[wrong_kind]: expected a list for `notes`, found the text `none`",
            "mini.yaml:16:47: error[wrong_kind]: expected a text for an item of `messages.one.examples[1].means.a`, found a map",
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

// Places.

#[test]
fn paths_lead_to_keys_and_values() {
    let text = format!("{WHOLE}messages:\n  one: {{access: [read, set], title: One message}}\n");
    let diagnostics = first(&text);
    let shown = |at: At| diagnostics.span(&at).map(|span| text[span].to_owned()).unwrap_or_default();
    let one = Path::default().key("messages").key("one");
    assert_eq!(one.key("access").index(1).to_string(), "messages.one.access[1]");
    assert_eq!(shown(one.at_key()), "one");
    assert_eq!(shown(one.at_value()), "one");
    assert_eq!(shown(one.key("title").at_key()), "title");
    assert_eq!(shown(one.key("title").at_value()), "One message");
    assert_eq!(shown(one.key("access").at_value()), "access");
    assert_eq!(shown(one.key("access").index(1).at_value()), "set");
    assert_eq!(shown(one.key("fields").key("voltage").at_value()), "one");
    assert_eq!(shown(one.key("access").index(2).at_key()), "access");
    assert_eq!(shown(Path::default().at_value()), "canspec: 1");
    assert_eq!(shown(Path::default().key("models").at_key()), "canspec: 1");
    assert_eq!(diagnostics.span(&At::File), None);
}

#[test]
fn the_tree_keeps_the_order_of_the_file() {
    let diagnostics = first(WHOLE);
    let tree = diagnostics.tree().expect("a tree");
    let Content::Map(entries) = &tree.content else { panic!("a map") };
    let keys: Vec<_> = entries.keys().collect();
    assert_eq!(keys, ["canspec", "protocol", "title", "document", "length", "identifier", "access"]);
    let version = tree.get(&Path::default().key("document").key("version")).expect("the version");
    assert_eq!(version.content, Content::Text("V1".to_owned()));
}

#[test]
fn diagnostics_are_sorted_by_place_and_counted() {
    let mut diagnostics = first(WHOLE);
    diagnostics.push(Diagnostic::warning("late", Path::default().key("length").at_value(), "is eight"));
    diagnostics.push(Diagnostic::error("early", 0..7, "is old").label("here").other(At::File, "there"));
    diagnostics.push(Diagnostic::error("whole", At::File, "is short"));
    assert_eq!((diagnostics.errors(), diagnostics.warnings()), (2, 1));
    assert_eq!(diagnostics.sorted()[2].severity, Severity::Warning);
    assert_eq!(
        diagnostics.to_string(),
        "mini.yaml: error[whole]: is short\nmini.yaml:1:1: error[early]: is old\nmini.yaml:5:9: warning[late]: is eight"
    );
}

#[test]
fn a_text_of_several_lines_ends_where_it_is_written() {
    let text = format!("{WHOLE}models:\n  a:\n    note: |\n      one\n      two\n    title: x\n");
    let diagnostics = first(&text);
    let note = Path::default().key("models").key("a").key("note");
    let span = diagnostics.span(&note.at_value()).expect("a place");
    assert!(text[span.clone()].ends_with("two"), "{:?}", &text[span]);
}

#[test]
fn other_programs_get_the_places_as_numbers() {
    let diagnostics = first(&format!("{WHOLE}title: again\n"));
    let found: Vec<_> = diagnostics.located().collect();
    let expected = "\
- rule: duplicate_key
  severity: error
  message: duplicate key `title`
  file: mini.yaml
  line: 8
  column: 1
  end_line: 8
  end_column: 6
  label: given again here
  others:
  - line: 3
    column: 1
    end_line: 3
    end_column: 6
    text: first given here
  help: remove one of the two, or give it another name
";
    assert_eq!(serde_yaml::to_string(&found).expect("plain data"), expected);
}

// Hostile texts: small ones for what is said, and one of each at full size to see that it ends.

#[test]
fn deep_nesting_is_refused() {
    let message = "error[yaml]: maps and lists are nested deeper than 64 levels";
    assert_eq!(errors(&format!("a:\n{}", " [\n".repeat(70))), [format!("mini.yaml:65:2: {message}")]);
    assert_eq!(errors(&format!("a:\n{}", "- ".repeat(100))), [format!("mini.yaml:2:127: {message}")]);
    for opening in ["[", "{a: ", "[\n ", "{a:\n ", "- ", "? "] {
        let found = errors(&format!("a:\n {}", opening.repeat(100_000)));
        assert!(found.last().is_some_and(|last| last.ends_with(message)), "{opening:?}: {:?}", found.last());
    }
}

#[test]
fn nesting_up_to_the_limit_is_read() {
    let means = format!("{}x{}", "{a: ".repeat(57), "}".repeat(57));
    spec(&format!("messages: {{one: {{access: [], examples: [{{means: {means}}}]}}}}\n"));
}

#[test]
fn many_values_are_refused() {
    let keys = lines(150_000, |number| format!("k{number}: 1\n"));
    assert_eq!(errors(&keys), ["mini.yaml:100001:1: error[yaml]: more than 200000 values in one file"]);
}

#[test]
fn many_errors_end_the_reading() {
    let found = errors(&format!("a: [{}]", "on,".repeat(100_000)));
    assert_eq!(found.len(), 1001);
    assert_eq!(found[1000], "mini.yaml:1:3002: error[yaml]: more than 1000 errors, the rest of the file is not read");
}

#[test]
fn a_bomb_of_aliases_is_refused_without_being_spread_out() {
    let doubled = lines(19, |level| format!("a{0}: &a{0} [*a{level}, *a{level}]\n", level + 1));
    let found = errors(&format!("a0: &a0 [x, x]\n{doubled}"));
    assert_eq!(found.iter().filter(|line| line.ends_with("an alias may not stand in a spec")).count(), 38);
}

#[test]
fn long_lines_are_read() {
    let long = "é ".repeat(SIZE_LIMIT / 4);
    assert_eq!(
        refusal(format!("a: {}", long.repeat(5)).as_bytes()),
        "mini.yaml: error[file]: the file is larger than 4 MiB"
    );
    let spec = spec(&format!("bit_rates: [{long}]"));
    assert_eq!(spec.bit_rates[0].len(), long.len() - 1);
}

// How it is shown.

#[cfg(feature = "render")]
mod rendered {
    use super::{At, Diagnostic, WHOLE, first};

    #[test]
    fn lines_are_underlined_with_labels_and_help() {
        let text = format!("{WHOLE}types:\n  a: {{}}\n  a: {{}}\nmodels: {{m: {{max_paralel: 4}}}}\n");
        let expected = "\
error[duplicate_key]: duplicate key `a`
  --> mini.yaml:10:3
   |
 9 |   a: {}
   |   - first given here
10 |   a: {}
   |   ^ given again here
   |
   = help: remove one of the two, or give it another name

error[unknown_key]: unknown key `max_paralel`
  --> mini.yaml:11:14
   |
11 | models: {m: {max_paralel: 4}}
   |              ^^^^^^^^^^^
   |
   = help: did you mean `max_parallel`? allowed here: `title`, `items`, `max_parallel`, `bit_rates`, `facts`, `types`, `note`, `section`, `erratum`";
        assert_eq!(first(&text).render(false), expected);
    }

    #[test]
    fn places_far_apart_are_shown_one_after_the_other() {
        let filler = "# filler\n".repeat(1000);
        let text = format!("{WHOLE}types: {{}}\n{filler}types: {{}}\n");
        let expected = "\
error[duplicate_key]: duplicate key `types`
    --> mini.yaml:1009:1
     |
1009 | types: {}
     | ^^^^^ given again here
     |
    ::: mini.yaml:8:1
     |
   8 | types: {}
     | ----- first given here
     |
     = help: remove one of the two, or give it another name";
        assert_eq!(first(&text).render(false), expected);
    }

    #[test]
    fn long_lines_are_not_drawn() {
        let text = format!("{WHOLE}bit_rates: [{}on]", "1, ".repeat(10_000));
        let expected = "\
error[plain_word]: `on` is written without quotes
--> mini.yaml:8:30013
 = help: write `\"on\"`: readers of YAML disagree on what the plain word means";
        assert_eq!(first(&text).render(false), expected);
    }

    #[test]
    fn a_warning_about_the_whole_file_names_it() {
        let mut diagnostics = first(WHOLE);
        diagnostics.push(
            Diagnostic::warning("quiet", At::File, "says little").other(At::File, "as others do").help("say more"),
        );
        let expected = "\
warning[quiet]: says little
--> mini.yaml
 = note: as others do
 = help: say more";
        assert_eq!(diagnostics.render(false), expected);
        assert!(diagnostics.render(true).contains('\u{1b}'));
    }
}
