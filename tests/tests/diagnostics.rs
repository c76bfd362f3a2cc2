//! Every rule of the compiler has a spec that breaks it, what is said about that, and the spec mended.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use canspec_codegen::diagnostic::{Diagnostics, Severity};
use canspec_codegen::model::NoteRule;
use canspec_codegen::rules::{self, RULES};
use canspec_codegen::source::Source;
use canspec_codegen::{Bases, compile_with_examples};

/// Rules that no YAML file can break, which the compiler tests itself.
const WITHOUT_FIXTURE: [&str; 1] = ["file"];

/// Rules that a whole spec on a page cannot break.
const WITHOUT_EXAMPLE: [&str; 2] = ["file", "no_example"];

type Result<T = ()> = std::result::Result<T, Box<dyn Error>>;

#[test]
fn a_spec_that_breaks_a_rule_gets_exactly_the_expected_text() -> Result {
    let mut wrong = Vec::new();
    for spec in fixtures("bad")? {
        let diagnostics = diagnose(&spec)?;
        let rendered = format!("{}\n", diagnostics.render(false));
        let expected = spec.with_extension("stderr");
        if std::env::var_os("CANSPEC_BLESS").is_some() {
            fs::write(&expected, &rendered)?;
        } else if fs::read_to_string(&expected).ok().as_deref() != Some(&rendered) {
            wrong.push(format!("{}:\n{rendered}", spec.display()));
        }
    }
    assert!(wrong.is_empty(), "run with CANSPEC_BLESS=1 if this is right:\n{}", wrong.join("\n"));
    Ok(())
}

#[test]
fn a_spec_that_breaks_a_rule_names_that_rule() -> Result {
    for spec in fixtures("bad")? {
        let rule = folder_name(&spec);
        assert!(diagnose(&spec)?.located().any(|found| found.rule == rule), "{}", spec.display());
    }
    Ok(())
}

#[test]
fn a_mended_spec_gets_no_diagnostic() -> Result {
    for spec in fixtures("good")? {
        let diagnostics = diagnose(&spec)?;
        assert!(diagnostics.is_empty(), "{}\n{}", spec.display(), diagnostics.render(false));
    }
    Ok(())
}

#[test]
fn every_rule_has_a_folder_with_both_specs() -> Result {
    let listed: BTreeSet<_> = RULES.iter().map(|rule| rule.name.to_owned()).collect();
    let expected: BTreeSet<_> =
        listed.iter().filter(|rule| !WITHOUT_FIXTURE.contains(&rule.as_str())).cloned().collect();
    assert_eq!(expected, files(&rules_folder())?.iter().map(|path| file_name(path)).collect());
    for rule in expected {
        for file in ["bad.yaml", "bad.stderr", "good.yaml"] {
            assert!(rules_folder().join(&rule).join(file).exists(), "{rule}/{file}");
        }
    }
    Ok(())
}

#[test]
fn every_rule_has_a_document_with_its_summary_and_examples() {
    for rule in RULES.iter() {
        assert!(rule.summary().ends_with('.'), "{}: the first line is one sentence", rule.name);
        let paragraphs = rule.document.split("\n\n").count();
        assert!(paragraphs >= 2, "{}: the document says why", rule.name);
        let has_examples = rule.document.contains("```yaml fails\n") && rule.document.contains("\n```yaml\n");
        assert!(has_examples || WITHOUT_EXAMPLE.contains(&rule.name), "{}: two blocks of YAML", rule.name);
    }
}

#[test]
fn every_note_says_what_it_means_and_what_to_do() {
    for (note, name) in NoteRule::ALL {
        let (summary, rest) = note.document().split_once("\n\n").unwrap_or_default();
        assert!(summary.starts_with("A note: ") && summary.ends_with('.'), "{name}");
        assert!(rest.ends_with(".\n"), "{name}");
    }
}

#[test]
fn every_document_is_that_of_a_rule() -> Result {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../codegen/docs/rules");
    let documents: BTreeSet<_> = files(&folder)?.iter().map(|path| file_name(path)).collect();
    assert_eq!(documents, RULES.iter().map(|rule| format!("{}.md", rule.name)).collect());
    Ok(())
}

#[test]
fn the_page_of_rules_is_current() -> Result {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/rules.md");
    if std::env::var_os("CANSPEC_BLESS").is_some() {
        fs::write(&page, rules::reference())?;
    }
    assert!(fs::read_to_string(page)? == rules::reference(), "CANSPEC_BLESS=1 writes docs/rules.md anew");
    Ok(())
}

#[test]
fn every_rule_gives_what_the_specs_that_break_it_show() -> Result {
    let mut given: BTreeMap<&str, Vec<Severity>> = BTreeMap::new();
    for spec in fixtures("bad")? {
        for found in diagnose(&spec)?.located() {
            let severities = given.entry(found.rule).or_default();
            if !severities.contains(&found.severity) {
                severities.push(found.severity);
            }
        }
    }
    for rule in RULES.iter().filter(|rule| !WITHOUT_FIXTURE.contains(&rule.name)) {
        let mut severities = given.remove(rule.name).unwrap_or_default();
        severities.sort_by_key(|severity| *severity != Severity::Error);
        assert_eq!(severities, rule.gives, "{}", rule.name);
    }
    Ok(())
}

#[test]
fn all_errors_of_one_stage_come_in_one_run_in_the_order_of_the_file() -> Result {
    let specs = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs/stages");
    for (stage, expected) in [
        ("syntax", &[(3, "unknown_key"), (8, "duplicate_key"), (17, "plain_word"), (23, "wrong_kind")][..]),
        ("resolve", &[(8, "number"), (12, "unit"), (16, "name"), (26, "place"), (30, "name")]),
        ("check", &[(19, "section"), (25, "outside_frame"), (27, "overlap"), (28, "special_value"), (31, "erratum")]),
    ] {
        let diagnostics = diagnose(&specs.join(stage).with_extension("yaml"))?;
        let found: Vec<_> =
            diagnostics.located().map(|found| (found.place.map_or(0, |place| place.line), found.rule)).collect();
        assert_eq!(found, expected, "{stage}");
    }
    Ok(())
}

/// Compiles a spec; one of the folder `no_example` as a caller does who wants an example of each message.
fn diagnose(spec: &Path) -> Result<Diagnostics> {
    let source = Source::new(file_name(spec), fs::read(spec)?)?;
    let percent = (folder_name(spec) == "no_example").then_some(100);
    let whole = bases(spec)?.add_to(source);
    Ok(whole.map_or_else(|refused| refused, |source| compile_with_examples(source, percent).diagnostics))
}

/// Returns the specs beside a spec.
fn bases(spec: &Path) -> Result<Bases> {
    let beside = files(spec.parent().ok_or("a spec stands in a folder")?)?;
    let specs = beside.iter().filter(|path| path.extension().is_some_and(|kind| kind == "yaml"));
    let named = specs.map(|path| Ok((file_name(&path.with_extension("")), fs::read_to_string(path)?)));
    named.collect::<Result<Vec<_>>>().map(Bases::from_iter)
}

/// Returns the specs of all rules whose file name starts with `prefix`.
fn fixtures(prefix: &str) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for folder in files(&rules_folder())? {
        let specs = files(&folder)?.into_iter().filter(|path| path.extension().is_some_and(|kind| kind == "yaml"));
        found.extend(specs.filter(|path| file_name(path).starts_with(prefix)));
    }
    assert!(!found.is_empty());
    Ok(found)
}

fn rules_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("specs/rules")
}

fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
    let mut paths: Vec<_> = entries.collect::<Result<_>>()?;
    paths.sort();
    Ok(paths)
}

fn folder_name(path: &Path) -> String {
    path.parent().map(file_name).unwrap_or_default()
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
