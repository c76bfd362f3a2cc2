//! The text and the file: what is read at all.

use canspec_codegen::source::{SIZE_LIMIT, Source};

use super::{WHOLE, errors, errors_after_whole, refusal, source};

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
fn characters_that_nobody_sees_are_refused() {
    for character in ['\u{AD}', '\u{200B}', '\u{200F}', '\u{2060}', '\u{E0041}'] {
        let code = u32::from(character);
        let expected = format!(
            "mini.yaml:1:4: error[encoding]: the character that nobody sees U+{code:04X} may not stand in a spec"
        );
        assert_eq!(refusal(format!("a: {character}b\n").as_bytes()), expected);
    }
}

#[test]
fn a_carriage_return_by_itself_is_refused() {
    let expected =
        "mini.yaml:2:5: error[encoding]: the carriage return that ends no line U+000D may not stand in a spec";
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
