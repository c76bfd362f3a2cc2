//! Texts of a spec and names of files are shown as they are, and nothing in them is obeyed.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use canspec_codegen::emit::{self, Options};
use canspec_codegen::model::Protocol;
use canspec_codegen::source::Source;
use canspec_codegen::syntax::parse;
use canspec_codegen::syntax::tree::{Content, Node};
use canspec_codegen::{Outcome, compile};
use canspec_tests::specs;
use fastrand::Rng;
use serde_json::Value;

/// What Markdown, Rust, Lua, a DBC or a terminal could take for something else than words.
const HOSTILE: [&str; 24] = [
    "```\npanic!(\"a doctest ran\")\n```",
    "~~~\npanic!()\n~~~",
    "    panic!();\n\n        panic!();",
    "[x] [`y`] [z][w] [a](b) ![i](j)\n\n[k]: l",
    "<b><script>alert(1)</script> <!-- </ <i class=x>",
    "`",
    "a ` b `` c ``` d",
    "\\ \\\\ \\` \\[ \\",
    "text`",
    "`[x]` <`y`> [`z`]",
    "&lt; &#60; &amp; &",
    "https://example.com/a_b and (http://example.org.) x`y`https://example.com",
    "- [ ] a\n- b\n\n1. c\n2) d",
    "# a\n===\n---\n- - -",
    "| a | b |\n|---|---|\n| c | d |",
    "a\n:-:|:-:\nb",
    "*/ /* // \"); } fn x() { #![allow(x)]",
    "[^1] [^1]: x",
    "[set_group] [<a_b>] <a_b>c_d</a_b>",
    "*a* **b** _c_ __d__ ~~e~~ ^f^ $g$",
    "]] --[[ \"\nerror(1)",
    "\"; BO_ 1 x: 8 y\nCM_ \"",
    "1. a",
    "+ a",
];

/// Keys with texts, wherever they stand.
const TEXTS: [&str; 14] = [
    "title",
    "note",
    "section",
    "prints",
    "uses",
    "because",
    "set_when",
    "clear_when",
    "effect",
    "led",
    "date",
    "file",
    "version",
    "items",
];

/// Puts hostile texts in the place of all others.
struct Attacker {
    next: usize,
}

impl Attacker {
    fn text(&mut self) -> Value {
        self.next += 1;
        HOSTILE[self.next % HOSTILE.len()].into()
    }

    /// Returns what stands below a key.
    fn attacked(&mut self, key: &str, node: &Node) -> Value {
        match &node.content {
            Content::Text(_) if TEXTS.contains(&key) => self.text(),
            Content::Text(name) if key == "erratum" => renamed(name).into(),
            Content::Text(text) => text.as_str().into(),
            Content::List(items) => items.iter().map(|item| self.attacked(key, item)).collect(),
            Content::Map(entries) => {
                let name = |name: &str| if key == "errata" { renamed(name) } else { name.to_owned() };
                // A field may be called as a key is.
                let is_field = key == "means";
                let entries = entries.iter().map(|(below, entry)| {
                    let value = self.attacked(if is_field { "" } else { below }, &entry.value);
                    (name(below), value)
                });
                entries.collect()
            }
            Content::Refused => Value::Null,
        }
    }
}

/// Names an erratum as hostile as a text.
fn renamed(name: &str) -> String {
    format!("```\n[{name}]\n```")
}

fn right(name: &str, text: String) -> Protocol {
    let Outcome { protocol, diagnostics, .. } = compile(Source::new(name, text.into_bytes()).expect("it is a text"));
    protocol.unwrap_or_else(|| panic!("{name}: {diagnostics}"))
}

/// Returns the specs with each feature of the language, with hostile texts at every place.
fn attacked() -> Vec<Protocol> {
    let paths = ["specs", "tests/specs", "tests/specs/features", "tests/specs/devices"].into_iter().flat_map(specs);
    let mut attacker = Attacker { next: 0 };
    let protocols = paths.filter_map(|path| {
        let (_, diagnostics) = parse(Source::read(&path).expect("the spec can be read"));
        // A spec that is based on another one has no texts but those of whole specs.
        let is_whole = !diagnostics.source().text().contains("\nbased_on:");
        let tree = diagnostics.tree().filter(|_| is_whole)?;
        Some(right(&path.display().to_string(), attacker.attacked("", tree).to_string()))
    });
    protocols.collect()
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(folder.join("src")).expect("the folder of the build can be written");
    folder
}

/// Runs a program, which must succeed, and returns what it says.
fn said(command: &mut Command) -> String {
    let output = command.output().expect("it is part of the toolchain");
    let [out, error] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    assert!(output.status.success(), "{command:?}\n{out}\n{error}");
    out.into_owned()
}

#[test]
fn hostile_texts_at_every_place_neither_run_nor_warn_in_a_users_build() {
    let folder = folder("hostile");
    let runtime = Path::new(env!("CARGO_MANIFEST_DIR")).join("../runtime");
    let manifest = format!(
        "[package]\nname = \"hostile\"\nversion = \"0.1.0\"\nedition = \"2024\"\n[workspace]\n\
        [dependencies]\ncanspec-runtime = {{ path = {runtime:?} }}\n"
    );
    let (mut lib, mut examples) = (String::new(), 0);
    for (index, protocol) in attacked().iter().enumerate() {
        let [manual, code] = [emit::manual, emit::rust].map(|emit| emit(protocol, &Options::default()));
        examples += usize::from(manual.contains("module_path!()"));
        fs::write(folder.join(format!("src/p{index}.rs")), manual + &code).expect("the folder can be written");
        writeln!(lib, "pub mod p{index};").expect("a text takes everything");
    }
    fs::write(folder.join("Cargo.toml"), manifest).expect("the folder can be written");
    fs::write(folder.join("src/lib.rs"), lib).expect("the folder can be written");
    let cargo = |arguments: &[&str]| {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(arguments).current_dir(&folder).env("RUSTDOCFLAGS", "-D warnings");
        said(cargo.env("CARGO_TARGET_DIR", folder.join("target")))
    };
    cargo(&["doc", "--offline", "--no-deps"]);
    let tests = cargo(&["test", "--offline", "--doc"]);
    assert!(examples > 20 && tests.contains(&format!("running {examples} tests")), "{tests}");
}

#[test]
fn hostile_texts_add_nothing_to_a_dbc() {
    for protocol in attacked() {
        let dbc = emit::dbc(&protocol, None);
        let read =
            can_dbc::Dbc::try_from(dbc.text.as_str()).unwrap_or_else(|error| panic!("{}: {error}", protocol.name));
        assert_eq!(read.messages.len(), dbc.counts.1, "{}", protocol.name);
    }
}

#[test]
fn documentation_shows_any_text_as_it_is() {
    let texts = texts();
    let folder = folder("shown");
    fs::write(folder.join("src/lib.rs"), documented(&texts)).expect("the folder can be written");
    let mut rustdoc = Command::new("rustdoc");
    rustdoc.args(["--edition", "2024", "-D", "warnings", "--crate-name", "shown", "--out-dir"]);
    said(rustdoc.arg(folder.join("doc")).arg(folder.join("src/lib.rs")));
    let run = said(Command::new("rustdoc").args(["--edition", "2024", "--test"]).arg(folder.join("src/lib.rs")));
    assert!(run.contains("running 0 tests"), "{run}");
    for (index, text) in texts.iter().enumerate() {
        let page = folder.join(format!("doc/shown/struct.M{index}.html"));
        let page = fs::read_to_string(page).expect("rustdoc made the page");
        let shown = page.split_once("<div class=\"docblock\">").and_then(|(_, after)| after.split_once("</div>"));
        let shown = shown.expect("the page shows the comment").0;
        let (_, note) = shown.split_once("</ul>").expect("the note stands behind the accesses");
        assert_eq!(words(&seen(note)), words(text), "{text:?} became {note}");
    }
    let page = fs::read_to_string(folder.join("doc/shown/index.html")).expect("rustdoc made the page");
    let (_, table) = page.split_once("<tbody>").expect("the page has a table");
    let rows: Vec<_> = table.split("</tr>").take(texts.len()).collect();
    for (text, row) in texts.iter().zip(rows) {
        let cells: Vec<_> = row.split("</td>").collect();
        let title = cells[2].trim_start_matches("<td>");
        assert_eq!((cells.len(), words(&seen(title))), (6, words(text)), "{text:?} became {row}");
    }
}

/// Returns the hostile texts, and random ones of their parts.
fn texts() -> Vec<String> {
    let parts: Vec<&str> =
        HOSTILE.iter().flat_map(|text| text.split_inclusive(' ')).chain(["é", "°C", "a_b"]).collect();
    let mut random = Rng::with_seed(0x7E87);
    let mut some = || (0..random.usize(1..30)).map(|_| parts[random.usize(..parts.len())]).collect::<String>();
    let random: Vec<String> = std::iter::repeat_with(&mut some).take(400).collect();
    HOSTILE.into_iter().map(str::to_owned).chain(random).collect()
}

/// Returns Rust with the documentation of a module, and a struct for each text. The text is title and
/// note of the struct's message.
fn documented(texts: &[String]) -> String {
    let mut spec = String::from(
        "{canspec: 1, protocol: shown, title: Texts, document: {title: Test, version: '1'}, length: 2, \
        identifier: {direction: {bits: 27}, command: {bits: 26..4}, node: {bits: 3..0}, top: {bits: 28}}, \
        types: {node: {range: 1..9}}, \
        addressing: {single: {request: {direction: 0, node: node}, one: {direction: 1, node: node}}}, \
        access: {read: {request: {}, reply: {}, in: [reply], answers: {single: one}}}, messages: {",
    );
    for (index, text) in texts.iter().enumerate() {
        let text = serde_json::to_string(text).expect("a text is JSON");
        write!(
            spec,
            "m{index}: {{section: '1', match: {{command: {index}}}, access: [read], title: {text}, note: {text}, "
        )
        .and_then(|()| write!(spec, "fields: {{x: {{bytes: 0}}}}}}, "))
        .expect("a text takes everything");
    }
    let protocol = right("shown.yaml", spec + "}}");
    let [manual, code] = [emit::manual, emit::rust].map(|emit| emit(&protocol, &Options::default()));
    let mut shown = manual + "/// The access.\npub const READ_ACCESS: () = ();\n";
    for item in syn::parse_file(&code).expect("it is Rust").items {
        let syn::Item::Struct(item) = item else { continue };
        let name = item.ident.to_string();
        if name.strip_prefix('M').is_some_and(|number| number.parse::<usize>().is_ok()) {
            let docs = item.attrs.iter().filter(|attribute| attribute.path().is_ident("doc"));
            writeln!(shown, "{}\npub struct {name};", quote::quote!(#(#docs)*)).expect("a text takes everything");
        }
    }
    shown
}

/// Returns what a reader sees of a paragraph of HTML, which may have nothing but words and code.
fn seen(html: &str) -> String {
    let plain = ["<p>", "</p>", "<code>", "</code>"].iter().fold(html.to_owned(), |text, tag| text.replace(tag, ""));
    assert!(!plain.contains('<'), "{html}");
    let entities = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#39;", "'"), ("&amp;", "&")];
    entities.iter().fold(plain, |text, (entity, letter)| text.replace(entity, letter))
}

/// Returns a text without what the pages show in another way: blanks, quotes, dashes, and the first and last letter.
fn words(text: &str) -> String {
    let typeset = [("–", "--"), ("—", "---"), ("…", "..."), ("-", "")];
    let text = typeset.iter().fold(text.to_lowercase(), |text, (shown, written)| text.replace(shown, written));
    let quotes = ['`', '\'', '"', '‘', '’', '“', '”'];
    text.split_whitespace().collect::<String>().replace(quotes, "").trim_end_matches('.').to_owned()
}

#[test]
fn a_file_name_stands_in_one_line_of_each_output() {
    let name = "a\u{1b}[2J\nfn x() {}\n*/ \u{202E}\u{200B}\u{9B}\r\n\"]] --[[.yaml";
    let text = fs::read_to_string(&specs("tests/specs/features")[0]).expect("the spec can be read");
    let [plain, hostile] = ["a.yaml", name].map(|name| right(name, text.clone()));
    let outputs = |protocol: &Protocol| {
        [emit::rust(protocol, &Options::default()), emit::wireshark(protocol), emit::dbc(protocol, None).text]
    };
    for (plain, hostile) in outputs(&plain).into_iter().zip(outputs(&hostile)) {
        assert_eq!(hostile.lines().count(), plain.lines().count(), "{hostile}");
        let acts = |letter: char| letter.is_control() && letter != '\n' || "\u{202E}\u{200B}".contains(letter);
        assert!(!hostile.contains(acts), "{hostile:?}");
    }
}

#[test]
fn a_dbc_leaves_out_a_text_that_is_blank_in_ascii() {
    let text = "canspec: 1\nprotocol: heater\ntitle: A heater\ndocument: {title: \u{52A0}\u{70ED}\u{5668}, version: \"1\"}\n\
        length: 8\nidentifier: {command: {bits: 10..0}}\naddressing: {bus: {one: {}}}\n\
        access: {report: {report: {}, answers: {bus: one}}}\n\
        messages:\n  output:\n    section: \"2.4\"\n    match: {command: 3}\n    access: [report]\n\
        \x20   fields: {voltage: {bytes: 0, unit: V, title: \u{7535}\u{538B}}}\n\
        \x20   examples: [{report: 003#0500000000000000, means: {voltage: 5 V}}]\n";
    let dbc = emit::dbc(&right("heater.yaml", text.to_owned()), None).text;
    assert!(dbc.contains("\nDocument: 1\n"), "{dbc}");
    assert!(dbc.contains(" voltage \"section 2.4\";"), "{dbc}");
}
