//! The pages of the language and the vendor guide: their YAML is compiled, and the reference lists every key there is.

use std::collections::BTreeSet;
use std::fs;

use canspec_codegen::diagnostic::Diagnostics;
use canspec_codegen::source::Source;
use canspec_codegen::{Bases, compile};

/// The first page of the language. It starts with the smallest whole spec.
const LANGUAGE: &str = "docs/language.md";
const LANGUAGE_PAGES: &str = "docs/language";
const REFERENCE: &str = "docs/language/reference.md";
const README: &str = "README.md";
const VENDOR_GUIDE: &str = "docs/adding-a-vendor.md";
const RULES: &str = "docs/rules.md";
const HOW_TO: &str = "docs/how-to";

/// Headings of the reference, each with a spec fragment in which `nothing` stands where the keys below that heading may.
const PLACES: [(&str, &str); 32] = [
    ("The top level", "nothing: x"),
    ("`document`", "document: {title: t, version: v, nothing: x}"),
    ("`sides`", "sides: {nothing: x}"),
    ("`reserved`", "reserved: {nothing: x}"),
    ("Fields", "identifier:\n  command: {bits: 28..16, nothing: x}"),
    ("Fields", "header:\n  function: {bytes: 0, nothing: x}"),
    ("Fields", "types:\n  level: {nothing: x}"),
    ("Fields", "types:\n  level: {fields: {part: {nothing: x}}}"),
    ("Fields", "messages:\n  other: {access: [read], fields: {level: {nothing: x}}}"),
    ("Fields", "messages:\n  other: {access: [read], value: {nothing: x}}"),
    ("Fields", "models:\n  small: {types: {level: {nothing: x}}}"),
    ("Named values", "types:\n  level: {values: {0: {nothing: x}}}"),
    ("Status bits", "types:\n  level: {status: {low: {bit: 0, nothing: x}}}"),
    ("Examples of a type", "types:\n  level: {examples: [{bytes: 00, means: 0, nothing: x}]}"),
    ("`addressing`", "addressing:\n  all: {nothing: x}"),
    ("`access`", "access:\n  scan: {nothing: x}"),
    ("`foreign`", "foreign:\n  others: {match: {command: 1}, nothing: x}"),
    ("`messages`", "messages:\n  other: {access: [read], nothing: x}"),
    ("`parts`", "messages:\n  other: {access: [read], parts: {nothing: x}}"),
    ("`transports`", "transports:\n  tp: {nothing: x}"),
    ("Examples of frames", "messages:\n  other: {access: [read], examples: [{nothing: x}]}"),
    ("Examples of frames", "examples:\n  start: {frames: [{nothing: x}]}"),
    ("`examples`", "examples:\n  start: {frames: [], nothing: x}"),
    ("`models`", "models:\n  small: {nothing: x}"),
    ("`quantities`", "quantities:\n  voltage: {nothing: x}"),
    ("Paths", "quantities:\n  voltage: {read: {signal: a.b, nothing: x}}"),
    ("`product`", "product: {nothing: x}"),
    ("`timing`", "timing:\n  pause: {time: 1 s, nothing: x}"),
    ("`after_silence`", "after_silence: {nothing: x}"),
    ("`procedures`", "procedures:\n  start: {steps: [], nothing: x}"),
    ("`errata`", "errata:\n  E1: {kind: note, prints: a, uses: b, because: c, nothing: x}"),
    ("`allow`", "allow: [{rule: section, at: messages, because: b, nothing: x}]"),
];

#[test]
fn every_block_of_the_language_does_what_it_says() {
    check_blocks(LANGUAGE);
}

#[test]
fn every_block_of_the_pages_on_the_language_does_what_it_says() {
    check_pages(LANGUAGE_PAGES);
}

#[test]
fn every_block_of_the_vendor_guide_does_what_it_says() {
    check_blocks(VENDOR_GUIDE);
}

#[test]
fn every_block_of_the_readme_adds_to_the_smallest_spec() {
    check_blocks_beside(README);
}

#[test]
fn every_block_of_the_how_to_pages_does_what_it_says() {
    check_pages(HOW_TO);
}

#[test]
fn every_block_of_the_rules_adds_to_the_smallest_spec() {
    check_blocks_beside(RULES);
}

#[test]
fn the_reference_lists_exactly_the_keys_that_are_read() {
    let (language, text) = (read(LANGUAGE), read(REFERENCE));
    let blocks = blocks(&language);
    let smallest = &blocks.first().expect("the language starts with a whole spec").lines;
    for (heading, probe) in PLACES {
        let spec = merged(smallest, &numbered(probe));
        assert_eq!(listed_keys(&text, heading), allowed_keys(&compiled(&spec)), "the keys below `{heading}`");
    }
}

#[test]
fn every_table_of_keys_in_the_reference_is_compared() {
    let text = read(REFERENCE);
    let parts = text.split("\n## ").filter(|part| part.contains("\n| key |"));
    let headings: BTreeSet<_> = parts.filter_map(|part| part.lines().next()).collect();
    assert_eq!(headings, PLACES.iter().map(|(heading, _)| *heading).collect());
}

/// A line of a document and its number, counted from 1.
type Line<'a> = (usize, &'a str);

/// A key and the lines of its entry.
type Entry<'a> = (&'a str, Vec<Line<'a>>);

/// A block of YAML, and the rule that it breaks if it is there to show that.
struct Block<'a> {
    fails: Option<&'a str>,
    lines: Vec<Line<'a>>,
}

fn read(document: &str) -> String {
    let path = format!("{}/../{document}", env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn check_blocks(document: &str) {
    let text = read(document);
    let blocks = blocks(&text);
    let smallest = &blocks.first().expect("a document starts with a whole spec").lines;
    let complaints: Vec<_> = blocks.iter().filter_map(|block| complaint(document, smallest, block)).collect();
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

/// Checks the blocks of all pages in a folder as additions to the smallest spec of the language.
fn check_pages(folder: &str) {
    let path = format!("{}/../{folder}", env!("CARGO_MANIFEST_DIR"));
    let pages = fs::read_dir(&path).expect("the folder is there").flatten();
    for page in pages {
        check_blocks_beside(&format!("{folder}/{}", page.file_name().to_string_lossy()));
    }
}

/// Checks the blocks of a document as additions to the smallest spec of the language.
fn check_blocks_beside(document: &str) {
    let (language, text) = (read(LANGUAGE), read(document));
    let whole = blocks(&language);
    let smallest = &whole.first().expect("the language starts with a whole spec").lines;
    let complaints: Vec<_> = blocks(&text).iter().filter_map(|block| complaint(document, smallest, block)).collect();
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

/// Says what is wrong with a block.
fn complaint(document: &str, smallest: &[Line], block: &Block) -> Option<String> {
    let spec = if is_whole(block) { block.lines.clone() } else { merged(smallest, &block.lines) };
    let diagnostics = compiled(&spec);
    let rules: BTreeSet<_> = diagnostics.located().map(|found| found.rule).collect();
    if rules == block.fails.into_iter().collect() {
        return None;
    }
    let (first, _) = block.lines.first()?;
    let wanted = block.fails.map_or_else(|| "compiles".to_owned(), |rule| format!("fails by the rule `{rule}`"));
    Some(format!("{document}:{first}: this block {wanted}, but:\n{}", listing(document, &spec, &diagnostics)))
}

/// Lists what is wrong by the lines of the document.
fn listing(document: &str, spec: &[Line], diagnostics: &Diagnostics) -> String {
    let lines = diagnostics.located().map(|found| {
        let line = found.place.and_then(|place| spec.get(place.line - 1)).map_or(0, |(number, _)| *number);
        format!("  {document}:{line}: {}[{}]: {}", found.severity, found.rule, found.message)
    });
    let lines: Vec<_> = lines.collect();
    if lines.is_empty() { "  nothing is wrong with it".to_owned() } else { lines.join("\n") }
}

/// Compiles a spec, which can be based on the smallest one or on a built-in one.
fn compiled(spec: &[Line]) -> Diagnostics {
    let lines: Vec<_> = spec.iter().map(|(_, line)| *line).collect();
    let language = read(LANGUAGE);
    let smallest = blocks(&language).swap_remove(0).lines.iter().map(|(_, line)| *line).collect::<Vec<_>>().join("\n");
    let bases: Bases = built_in().chain([("charger".to_owned(), smallest)]).collect();
    let source = Source::new("spec.yaml", lines.join("\n").into_bytes()).and_then(|source| bases.add_to(source));
    source.map_or_else(|diagnostics| diagnostics, |source| compile(source).diagnostics)
}

/// Returns the names and the texts of the built-in specs.
fn built_in() -> impl Iterator<Item = (String, String)> {
    let files = fs::read_dir(format!("{}/../specs", env!("CARGO_MANIFEST_DIR"))).expect("the folder is there");
    let paths = files.flatten().map(|file| file.path());
    paths.filter(|path| path.extension().is_some_and(|ending| ending == "yaml")).map(|path| {
        let name = path.file_stem().expect("it has an ending").to_string_lossy().into_owned();
        (name, fs::read_to_string(path).expect("a spec is a text"))
    })
}

/// Returns the blocks of a document that are fenced as YAML.
fn blocks(text: &str) -> Vec<Block<'_>> {
    let mut blocks = Vec::new();
    let mut lines = numbered(text).into_iter();
    while let Some((number, line)) = lines.next() {
        let Some(info) = line.strip_prefix("```yaml") else { continue };
        let fails = info.trim().strip_prefix("fails=");
        assert!(fails.is_some() || info.trim().is_empty(), "line {number}: `{info}` says nothing to this test");
        blocks.push(Block { fails, lines: lines.by_ref().take_while(|(_, line)| *line != "```").collect() });
    }
    blocks
}

fn numbered(text: &str) -> Vec<Line<'_>> {
    text.lines().enumerate().map(|(index, line)| (index + 1, line)).collect()
}

fn is_whole(block: &Block) -> bool {
    block.lines.iter().any(|(_, line)| line.starts_with("canspec:"))
}

/// Adds a fragment to a spec: entries of its maps are added to those of the spec and win; all else is replaced.
fn merged<'a>(spec: &[Line<'a>], fragment: &[Line<'a>]) -> Vec<Line<'a>> {
    let mut sections = entries(spec, 0);
    for section in entries(fragment, 0) {
        let known = sections.iter().find(|(key, _)| *key == section.0);
        let section = known.and_then(|known| extended(known, &section)).unwrap_or(section);
        put(&mut sections, section);
    }
    lines_of(sections)
}

/// Joins two sections that are maps; an identifier is one layout and is never joined.
fn extended<'a>(known: &Entry<'a>, section: &Entry<'a>) -> Option<Entry<'a>> {
    let is_map =
        |(key, lines): &Entry| *key != "identifier" && lines.first().is_some_and(|(_, line)| line.ends_with(':'));
    if !is_map(known) || !is_map(section) {
        return None;
    }
    let (heading, below) = known.1.split_first()?;
    let mut joined = entries(below, 2);
    for entry in entries(&section.1, 2) {
        put(&mut joined, entry);
    }
    let lines = std::iter::once(*heading).chain(lines_of(joined));
    Some((known.0, lines.collect()))
}

fn put<'a>(entries: &mut Vec<Entry<'a>>, entry: Entry<'a>) {
    match entries.iter_mut().find(|(key, _)| *key == entry.0) {
        Some(known) => *known = entry,
        None => entries.push(entry),
    }
}

fn lines_of(entries: Vec<Entry>) -> Vec<Line> {
    entries.into_iter().flat_map(|(_, lines)| lines).collect()
}

/// Splits a map in block form at its keys, which are indented so far.
fn entries<'a>(lines: &[Line<'a>], indent: usize) -> Vec<Entry<'a>> {
    let mut entries: Vec<Entry> = Vec::new();
    for &(number, line) in lines {
        let starts = line.len() - line.trim_start().len() == indent && !line.trim_start().is_empty();
        match entries.last_mut() {
            _ if starts => entries.push((line.split(':').next().unwrap_or(line).trim(), vec![(number, line)])),
            Some((_, lines)) => lines.push((number, line)),
            None => {}
        }
    }
    entries
}

/// Returns the keys in the table below a heading of the reference.
fn listed_keys<'a>(text: &'a str, heading: &str) -> BTreeSet<&'a str> {
    let level = |line: &str| line.bytes().take_while(|byte| *byte == b'#').count();
    let mut lines = text.lines().skip_while(|line| level(line) == 0 || line.trim_start_matches('#').trim() != heading);
    assert!(lines.next().is_some(), "the reference has no heading `{heading}`");
    let table = lines.take_while(|line| level(line) == 0).skip_while(|line| !line.starts_with("| key |"));
    let cells = table.map_while(|line| line.strip_prefix('|')?.split('|').next());
    cells.flat_map(quoted).collect()
}

/// Returns the keys that the compiler names where it finds another one.
fn allowed_keys(diagnostics: &Diagnostics) -> BTreeSet<&str> {
    let unknown = diagnostics.located().find(|found| found.rule == "unknown_key");
    let help = unknown.and_then(|found| found.help).unwrap_or_else(|| panic!("no unknown key in {diagnostics}"));
    let (_, allowed) = help.split_once("allowed here: ").unwrap_or_else(|| panic!("no keys in `{help}`"));
    quoted(allowed).collect()
}

/// Returns what stands in backquotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}
