//! The fuzz targets for a few seconds, always with the same inputs, and with those that once broke them.

use std::fs;
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::time::{Duration, Instant};

use canspec::files::{Log, imported};
use canspec_codegen::compile;
use canspec_codegen::source::Source;
use canspec_codegen::syntax::parse;
use canspec_tests::fuzz::{DBC, FRAMES, FRONT_END, LOGS, TARGETS, Target, regressions};
use canspec_tests::protocol;
use fastrand::Rng;

/// Longest time that an input may take, on a slow and busy machine.
const LIMIT: Duration = Duration::from_secs(20);

/// Runs a target on an input; one that breaks it is kept as a file.
fn run(target: &Target, input: &[u8]) {
    let start = Instant::now();
    let outcome = panic::catch_unwind(AssertUnwindSafe(|| (target.run)(input)));
    if outcome.is_err() || start.elapsed() > LIMIT {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(target.name);
        fs::write(&file, input).expect("the folder of the build can be written");
        panic!("after {:?}: the input is {}", start.elapsed(), file.display());
    }
}

/// Returns the seeds of a target, changed up to three times.
fn inputs(target: Target) -> impl Iterator<Item = Vec<u8>> {
    let seeds = (target.seeds)();
    let mut random = Rng::with_seed(0xF022);
    std::iter::repeat_with(move || {
        let seed = seeds[random.usize(..seeds.len())].clone();
        let changes = random.usize(0..=3);
        (0..changes).fold(seed, |input, _| (target.mutated)(&input, &mut random))
    })
}

#[test]
fn whatever_a_spec_says_it_is_refused_in_its_place_or_of_use() {
    inputs(FRONT_END).take(400).for_each(|input| run(&FRONT_END, &input));
}

#[test]
fn whatever_a_frame_holds_both_engines_say_the_same_of_it() {
    inputs(FRAMES).take(100_000).for_each(|input| run(&FRAMES, &input));
}

#[test]
fn whatever_a_log_says_it_is_refused_or_shown_in_all_forms() {
    inputs(LOGS).take(1_000).for_each(|input| run(&LOGS, &input));
}

#[test]
fn whatever_a_dbc_says_it_is_refused_or_a_spec_that_is_right() {
    inputs(DBC).take(1_000).for_each(|input| run(&DBC, &input));
}

#[test]
fn what_once_broke_a_target_does_so_no_more() {
    for target in TARGETS {
        for path in regressions(&target) {
            run(&target, &fs::read(&path).expect("the file can be read"));
        }
    }
}

#[test]
fn of_the_changed_lines_and_files_enough_are_read() {
    let infy = protocol(Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs/infy.yaml"));
    let (mut shown, mut count) = (0, 0);
    for bytes in inputs(LOGS).take(200) {
        let mut log = Log::default();
        for line in bytes.split(|byte| *byte == b'\n').filter_map(|line| str::from_utf8(line).ok()) {
            shown += usize::from(matches!(log.decoded(&infy, line), Ok(Some(_))));
            count += 1;
        }
    }
    let imported = inputs(DBC).take(400).filter(|dbc| imported(dbc.clone()).is_ok()).count();
    assert!(shown * 2 > count && imported >= 100, "{shown} of {count} lines, {imported} of 400");
}

#[test]
fn of_the_changed_specs_enough_are_read_and_enough_are_right() {
    let sources: Vec<_> = inputs(FRONT_END).take(400).filter_map(|spec| Source::new("spec.yaml", spec).ok()).collect();
    let read = sources.iter().filter(|source| parse((*source).clone()).0.is_some()).count();
    let right = sources.into_iter().filter(|source| compile(source.clone()).protocol.is_some()).count();
    assert!(read >= 120 && right >= 40, "of 400 specs {read} can be read, and {right} are right");
}
