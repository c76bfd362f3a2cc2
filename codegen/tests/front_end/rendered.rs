//! How it is shown.

use canspec_codegen::diagnostic::{At, Diagnostic};
use canspec_codegen::source::Source;

use super::{WHOLE, first, rule};

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
   = help: put the entries of both below one of the two, or give it another name

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
     = help: put the entries of both below one of the two, or give it another name";
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
        Diagnostic::warning(rule("section"), At::File, "says little").other(At::File, "as others do").help("say more"),
    );
    let expected = "\
warning[section]: says little
--> mini.yaml
 = note: as others do
 = help: say more";
    assert_eq!(diagnostics.render(false), expected);
    assert!(diagnostics.render(true).contains('\u{1b}'));
}

#[test]
fn no_control_character_of_the_file_reaches_the_terminal() {
    let controls = (0..0x20).chain(0x7F..0xA0).filter_map(char::from_u32).filter(|letter| !"\t\n\r".contains(*letter));
    let text = controls.fold(String::new(), |text, letter| format!("{text}a: {letter}\n"));
    let diagnostics = Source::new("mini.yaml", text.into_bytes()).expect_err("control characters are refused");
    assert_eq!(diagnostics.errors(), 29 + 33);
    let drawn = diagnostics.render(false);
    assert!(!drawn.contains(|letter: char| letter.is_control() && letter != '\n'), "{drawn:?}");
    assert!(drawn.contains("a: \u{FFFD}"));
}
