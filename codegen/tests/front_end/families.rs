//! Specs that are based on others: where mistakes are shown, and what is taken over.

use std::fs;

use canspec_codegen::diagnostic::Diagnostics;
use canspec_codegen::source::SIZE_LIMIT;
use canspec_codegen::{Bases, compile};

use super::{WHOLE, errors, errors_after_whole, lines, source};

/// The first lines of a spec that is based on `base`; what a test adds starts at line 5.
const DERIVED: &str = "canspec: 1\nprotocol: small\ntitle: Small\nbased_on: base\n";

/// Returns a whole spec with a way to ask.
fn asked() -> String {
    let access = "addressing: {any: {request: {}}}\naccess: {read: {request: {}, answers: {any: nobody}}}\n";
    WHOLE.replace("access: {read: {request: {}, reply: {}}}\n", access)
}

/// Compiles a spec that is based on some others.
fn diagnosed(own: &str, bases: &[(&'static str, String)]) -> Diagnostics {
    let bases: Bases = bases.iter().cloned().collect();
    bases.add_to(source(own)).map_or_else(|refused| refused, |source| compile(source).diagnostics)
}

/// Returns what is said about a derived spec, a line each.
fn said(own: &str, base: &str) -> Vec<String> {
    let diagnostics = diagnosed(&format!("{DERIVED}{own}"), &[("base", format!("{WHOLE}{base}"))]);
    diagnostics.concise().lines().map(str::to_owned).collect()
}

/// Returns a spec that is based on the next one.
fn link(number: usize) -> String {
    format!("canspec: 1\nprotocol: s{number}\ntitle: Link\nbased_on: s{}\n", number + 1)
}

#[test]
fn a_mistake_is_shown_in_the_file_in_which_it_stands() {
    let base = "types:\n  ü: {scale: 1, skale: 2}\nmessages:\n  one: {access: [raed], section: \"1\"}\n";
    assert_eq!(
        said("messages:\n  two: {acess: [read]}\n", base),
        [
            "mini.yaml:6:9: error[unknown_key]: unknown key `acess`",
            "base.yaml:9:17: error[unknown_key]: unknown key `skale`",
        ]
    );
    assert_eq!(
        said("messages:\n  two: {access: [reed], section: \"1\"}\n", &base.replace(", skale: 2", "")),
        [
            "mini.yaml:6:18: error[name]: there is no access `reed`",
            "base.yaml:9:3: error[identifier_name]: `ü` is not a name",
            "base.yaml:11:18: error[name]: there is no access `raed`",
        ]
    );
}

#[test]
fn text_that_is_no_yaml_is_shown_in_the_file_in_which_it_stands() {
    let broken = "messages:\n  one: {access: [read]\n";
    let expected = "base.yaml:9:8: error[yaml]: this `{` is not closed";
    assert_eq!(said("", broken), [expected]);
    assert_eq!(
        said("types: {a: &b {bits: 1}}\n", broken),
        ["mini.yaml:5:12: error[yaml]: an anchor may not stand in a spec", expected]
    );
    // The line above the first one of a file is no line of it.
    let diagnostics = diagnosed(DERIVED, &[("base", "  - a: b: c\n".to_owned())]);
    assert!(diagnostics.concise().lines().all(|line| line.starts_with("base.yaml:1:")), "{diagnostics}");
}

#[test]
fn a_missing_key_is_shown_where_the_rest_of_its_item_stands() {
    let diagnostics =
        diagnosed("canspec: 1\nprotocol: small\nbased_on: base\nremoves: [length]\n", &[("base", WHOLE.to_owned())]);
    assert_eq!(
        diagnostics.concise().lines().collect::<Vec<_>>(),
        [
            "mini.yaml:1:1: error[missing_key]: missing key `title`",
            "mini.yaml:1:1: error[missing_key]: missing key `length`",
        ]
    );
}

#[test]
fn programs_learn_the_file_of_each_place() {
    let own = format!("{DERIVED}length: 7\n");
    let diagnostics = diagnosed(&own, &[("base", WHOLE.to_owned())]);
    let located: Vec<_> = diagnostics.located().collect();
    let json = serde_json::to_value(&located[0]).expect("a diagnostic is JSON");
    assert_eq!((&json["file"], &json["line"]), (&"mini.yaml".into(), &5.into()));
    assert_eq!((&json["others"][0]["file"], &json["others"][0]["line"]), (&"base.yaml".into(), &5.into()));
}

#[test]
fn warnings_about_how_a_spec_is_written_are_those_of_its_own_file() {
    let comment = "timing: {pause: {time: 1 s, section: \"1\"}, rest: {time: 2 s, section: \"1\", note: a #b\n}}\n";
    assert_eq!(said("", comment), [""; 0]);
    let own = comment.replace("pause", "start").replace("rest", "end").replace("\"1\"", "base 1");
    let own = said(&own, "");
    assert_eq!(own, ["mini.yaml:5:87: warning[comment]: the text ends where ` #` begins a comment"]);
}

#[test]
fn what_a_base_allows_is_allowed_for_what_is_taken_over() {
    let base = "messages: {one: {access: [read], match: {command: 1}}, two: {access: [read], match: {command: 2}}}\nallow:\n  \
                - {rule: section, at: messages.one, because: b}\n  - {rule: section, at: messages.two, because: b}\n";
    let said = |own: &str| {
        let diagnostics = diagnosed(&format!("{DERIVED}{own}"), &[("base", asked() + base)]);
        diagnostics.concise().lines().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(said(""), [""; 0]);
    assert_eq!(said("removes: [messages.two]\n"), [""; 0]);
    let own = "messages: {three: {access: [read], match: {command: 3}}}\n";
    let warning = "mini.yaml:5:12: warning[section]: the message `three` has no section";
    assert_eq!(said(own), [warning]);
    let allow =
        "allow: [{rule: section, at: messages.three, because: a}, {rule: section, at: messages.four, because: a}]\n";
    let stale =
        "mini.yaml:6:65: warning[stale_allowance]: there is no warning of the rule `section` in `messages.four`";
    assert_eq!(said(&format!("{own}{allow}")), [stale]);
}

#[test]
fn sections_begin_with_the_name_of_the_base_that_has_them() {
    let last = asked()
        + "documents: {C: {title: t, version: v}}\nmessages:\n  one: {section: \"1; C 2\", access: [read], \
           match: {command: 1}, examples: [{request: 001#0000000000000000, section: \"3\"}]}\n";
    let middle = "canspec: 1\nprotocol: m\ntitle: Middle\ndocument: {title: Mid, version: v}\nbased_on: last\nmessages:\n  \
                  two: {section: \"4; last 5\", access: [read], match: {command: 2}}\n";
    let own = DERIVED.replace(": base", ": middle")
        + "messages:\n  three: {section: C 6, access: [read], match: {command: 3}}\n";
    let bases: Bases = [("last", last), ("middle", middle.to_owned())].into_iter().collect();
    let outcome = compile(bases.add_to(source(&own)).expect("the bases are there"));
    let protocol = outcome.protocol.unwrap_or_else(|| panic!("{}", outcome.diagnostics));
    let sections =
        protocol.messages.iter().map(|message| &message.doc).chain(protocol.examples.iter().map(|known| &known.doc));
    let sections: Vec<_> = sections.filter_map(|doc| Some(doc.section.as_ref()?.for_people())).collect();
    assert_eq!(sections, ["last 1; C 2", "middle 4; last 5", "C 6", "last 3"]);
    let names: Vec<_> = protocol.documents.iter().filter_map(|document| document.name.as_deref()).collect();
    assert_eq!(names, ["middle", "last", "C"]);
}

#[test]
fn a_name_that_is_called_section_is_no_section() {
    let base = asked()
        + "header: {section: {bytes: 0}}\nmessages: {one: {section: \"1\", match: {section: 5}, access: [read]}}\n";
    assert_eq!(diagnosed(DERIVED, &[("base", base)]).concise(), "");
}

#[test]
fn at_most_four_specs_stand_behind_one() {
    let names = ["s0", "s1", "s2", "s3", "s4", "s5"];
    let chain = |length: usize| {
        let links = (1..length).map(|number| (names[number], link(number)));
        let bases: Vec<_> = links.chain([(names[length], WHOLE.to_owned())]).collect();
        diagnosed(&link(0), &bases).concise()
    };
    assert_eq!(chain(4), "");
    let expected =
        "s4.yaml:4:11: error[based_on]: more than 4 specs stand behind this one: mini → s1 → s2 → s3 → s4 → s5";
    assert_eq!(chain(5), expected);
}

#[test]
fn a_spec_whose_bases_nobody_has_looked_for_is_refused() {
    let expected = "mini.yaml:4:11: error[based_on]: nobody has looked for the spec `base`";
    assert_eq!(errors(DERIVED).first().map(String::as_str), Some(expected));
    assert_eq!(
        errors_after_whole("based_on: [base]\n"),
        ["mini.yaml:8:1: error[wrong_kind]: expected a text for `based_on`, found a list"]
    );
}

#[test]
fn a_spec_and_its_bases_are_together_no_larger_than_a_spec() {
    let half = format!("{WHOLE}#{}", "a".repeat(SIZE_LIMIT / 2));
    let small = diagnosed(DERIVED, &[("base", half.clone())]);
    assert_eq!(small.concise(), "");
    let large = diagnosed(&format!("{DERIVED}#{}", "a".repeat(SIZE_LIMIT / 2)), &[("base", half)]);
    let expected = "mini.yaml:4:11: error[based_on]: the spec and those that it is based on are larger than 4 MiB";
    assert_eq!(large.concise(), expected);
}

#[test]
fn a_file_beside_a_spec_comes_before_a_spec_of_the_same_name() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let path = |name: &str| folder.path().join(name);
    let bases: Bases = [("base", WHOLE.replace("length: 8", "length: 9"))].into_iter().collect();
    fs::write(path("own.yaml"), DERIVED).expect("the folder is there");
    let said = |bases: &Bases| {
        bases.read(path("own.yaml")).map_or_else(|refused| refused, |source| compile(source).diagnostics)
    };
    assert_eq!(said(&bases).concise(), "base.yaml:5:9: error[number]: a frame has at most 8 data bytes, not 9");
    let missing = said(&Bases::default());
    assert!(missing.concise().ends_with("own.yaml:4:11: error[based_on]: there is no spec `base`"), "{missing}");
    fs::write(path("base.yaml"), WHOLE).expect("the folder is there");
    assert_eq!(said(&bases).concise(), "");
    fs::write(path("base.yaml"), DERIVED).expect("the folder is there");
    let ring = said(&bases).concise();
    assert!(ring.ends_with("error[based_on]: a spec is based on itself: own → base → base"), "{ring}");
}

#[cfg(unix)]
#[test]
fn a_file_that_cannot_be_read_is_not_passed_over() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let path = |name: &str| folder.path().join(name);
    let bases: Bases = [("base", WHOLE)].into_iter().collect();
    fs::write(path("own.yaml"), DERIVED).expect("the folder is there");
    let read = || bases.read(path("own.yaml")).map(|_| ()).map_err(|refused| refused.concise());
    assert_eq!(read(), Ok(()), "no file has the name");
    for target in ["nowhere.yaml", "base.yaml"] {
        std::os::unix::fs::symlink(path(target), path("base.yaml")).expect("the folder is there");
        let said = read().expect_err("the link leads nowhere");
        assert!(said.starts_with(&format!("{}: error[file]: ", path("base.yaml").display())), "{said}");
        fs::remove_file(path("base.yaml")).expect("the link is there");
    }
}

#[test]
fn many_conflicts_are_reported_up_to_a_limit() {
    let types = |value: &str| format!("types:\n{}", lines(300, |number| format!("  t{number}: {{note: {value}}}\n")));
    assert_eq!(said(&types("a"), &types("b")).len(), 100);
}
