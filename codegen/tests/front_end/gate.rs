//! The gate: what is refused of YAML.

use super::{WHOLE, errors, errors_after_whole, first, spec};

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
    assert_eq!(
        spec.types["a"].values.values().map(|value| &value.name).collect::<Vec<_>>(),
        ["on", "no", "no load", "truely"]
    );
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
        ("a: 'x\n", "8:4", "this `'` is not closed"),
        ("a: b: c\n", "8:5", "a `:` that ends no key"),
        ("a: [1, 2\nb: 3\n", "8:4", "this `[` is not closed"),
        ("a: {b: c\n", "8:4", "this `{` is not closed"),
        ("a: {b: c\n  d: e}\n", "9:4", "expected `,` or `}` in this map"),
        ("a: {b: c]\n", "8:9", "`]` does not close this `{`"),
        ("a: \"b\nc: d\n", "8:4", "this `\"` is not closed"),
        ("a:\n  b:c\n  d: e\n", "9:4", "no blank after the `:` of `b`"),
        ("a:\n  -{b: c}\n  - {d: e}\n", "9:3", "no blank after the `-`"),
        ("a:\n\tb: c\n", "9:2", "a tab stands where only spaces may"),
        ("a:\n  - 1\n  b: 2\n", "10:3", "expected a `-` at this indentation"),
        ("a:\n  b: 1\n c: 2\n", "10:2", "expected a key at this indentation"),
        ("a: [b,, c]\n", "8:7", "expected a value here"),
        ("a: [b]]\n", "8:7", "a closing bracket without an opening one"),
        ("a: \"b\" c\n", "8:8", "text after a closing quote"),
        ("a: - b\n", "8:4", "a `-` that starts no item"),
        ("a: [- b]\n", "8:5", "a `-` that starts no item"),
        ("  a: b\n", "8:3", "expected a key at this indentation"),
        ("a: @b\n", "8:4", "an unquoted text cannot start with `@`"),
        ("a: \"\\q\"\n", "8:4", "unknown escape in a text in double quotes"),
        ("just a line\n", "8:1", "`just a line` has no `:`"),
        ("a:\n  b [c]\n  d: e\n", "9:3", "`b [c]` has no `:`"),
    ];
    for (text, place, message) in cases {
        assert_eq!(errors_after_whole(text), [format!("mini.yaml:{place}: error[yaml]: {message}")], "{text:?}");
    }
}

#[test]
fn a_bracket_without_an_end_is_shown_with_the_place_where_the_end_was_missed() {
    let diagnostics = first(&format!("{WHOLE}a: {{b: {{c: d}}\ne: f\n"));
    let found: Vec<_> = diagnostics.located().collect();
    let [found] = found.as_slice() else { panic!("one error: {found:?}") };
    assert_eq!((found.message, found.help), ("this `{` is not closed", Some("close it with `}`")));
    let other = found.others[0].place.expect("a place");
    assert_eq!((other.line, other.column), (9, 1));
}

#[test]
fn an_unknown_key_is_the_mistake_where_its_value_is_a_plain_word() {
    let found = errors_after_whole("types: {a: {signed: true, scale: on}}\n");
    assert_eq!(
        found,
        [
            "mini.yaml:8:13: error[unknown_key]: unknown key `signed`",
            "mini.yaml:8:34: error[plain_word]: `on` is written without quotes",
        ]
    );
}

#[test]
fn a_comma_in_a_text_in_brackets_is_the_mistake() {
    let diagnostics = first(&format!("{WHOLE}errata: {{a: {{because: b, c, uses: 23,5 V}}}}\n"));
    let helps: Vec<_> = diagnostics.located().filter_map(|found| found.help.map(str::to_owned)).collect();
    let comma = "quote the text that holds a comma: inside `{}` and `[]` a comma ends it";
    assert!(helps.contains(&comma.to_owned()), "{helps:?}");
    assert!(helps.contains(&"write a decimal point for the comma: `23.5 V`".to_owned()), "{helps:?}");
}

#[test]
fn a_plain_word_comes_with_what_to_write_instead() {
    let diagnostics = first(&format!("{WHOLE}types: {{a: {{values: {{0: on}}}}}}\n"));
    let found: Vec<_> = diagnostics.located().map(|found| found.replacement).collect();
    assert_eq!(found, [Some("\"on\"")]);
}
