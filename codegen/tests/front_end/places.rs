//! Where things stand.

use canspec_codegen::diagnostic::{At, Diagnostic, Severity};
use canspec_codegen::syntax::tree::{Content, Path};

use super::{WHOLE, first, rule};

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
    diagnostics.push(Diagnostic::warning(rule("order"), Path::default().key("length").at_value(), "is eight"));
    diagnostics.push(Diagnostic::error(rule("yaml"), 0..7, "is old").label("here").other(At::File, "there"));
    diagnostics.push(Diagnostic::error(rule("file"), At::File, "is short"));
    assert_eq!((diagnostics.errors(), diagnostics.warnings()), (2, 1));
    assert_eq!(diagnostics.sorted()[2].severity, Severity::Warning);
    assert_eq!(
        diagnostics.to_string(),
        "mini.yaml: error[file]: is short\nmini.yaml:1:1: error[yaml]: is old\nmini.yaml:5:9: warning[order]: is eight"
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
  replacement: null
";
    assert_eq!(serde_yaml::to_string(&found).expect("plain data"), expected);
}
