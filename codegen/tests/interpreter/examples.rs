//! The documents' own frames.

use super::{outcome, specs};

#[test]
fn every_frame_that_a_document_prints_holds_both_ways() {
    let outcomes: Vec<_> = specs("specs").iter().map(|path| outcome(path)).collect();
    let wrong: Vec<_> = outcomes.iter().map(|outcome| outcome.diagnostics.concise()).collect();
    assert_eq!(wrong.concat(), "");
    let frames = outcomes.iter().map(|outcome| outcome.summary.frames).sum::<usize>();
    let failures = outcomes.iter().map(|outcome| outcome.summary.expected_failures).sum::<usize>();
    assert!(frames >= 100 && failures >= 13, "{frames} frames, {failures} expected failures");
}

#[test]
fn every_frame_of_the_made_up_specs_holds_both_ways() {
    let folders = ["tests/specs", "tests/specs/features", "tests/specs/devices"];
    for path in folders.map(specs).concat() {
        assert_eq!(outcome(&path).diagnostics.concise(), "", "{}", path.display());
    }
}
