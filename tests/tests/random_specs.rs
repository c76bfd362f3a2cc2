//! Random specs with hostile names: what the compiler accepts compiles as Rust, and both engines take it.

use std::path::Path;

use canspec_tests::fuzz::FRONT_END;
use canspec_tests::random_specs::Spec;
use canspec_tests::random_specs::keys::Keys;
use canspec_tests::random_specs::run::Run;

/// How many specs are compiled as Rust; `just random-specs` compiles as many as you like.
const COMPILED: u64 = 200;

#[test]
fn what_is_accepted_compiles_as_rust() {
    let mut run = Run::default();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("random_specs");
    run.add(0..COMPILED, &folder).expect("cargo runs");
    assert!(run.complaints.is_empty(), "{}", run.complaints.join("\n"));
    assert!(run.rejections() * 20 <= run.specs, "{run}");
}

#[test]
fn what_is_accepted_has_every_output_and_its_frames_come_back() {
    (0..COMPILED).for_each(|seed| (FRONT_END.run)(Spec::new(seed).text.as_bytes()));
}

#[test]
fn every_key_is_set_at_every_place_where_it_counts() {
    let mut keys = Keys::default();
    (0..1000).for_each(|seed| keys.add(&Spec::new(seed).tree));
    let rare = keys.rows().filter(|(_, _, count)| *count < 5);
    let rare: Vec<_> = rare.map(|(place, key, count)| format!("{place} `{key}`: {count}")).collect();
    assert!(rare.is_empty(), "a key of the language is set too rarely:\n{}", rare.join("\n"));
}

#[test]
fn a_spec_is_the_same_for_the_same_seed() {
    assert_eq!(Spec::new(7).text, Spec::new(7).text);
    assert_ne!(Spec::new(7).text, Spec::new(8).text);
}

#[test]
fn a_place_and_a_key_that_no_spec_sets_are_in_the_table() {
    let keys = Keys::default();
    let is_zero = |place: &str, key: &str| keys.rows().any(|row| row == (place, key, 0));
    let of_structs = [("", "messages"), ("messages.*.examples.[]", "fails"), ("types.*.status.*", "led")];
    let of_fields = [("header.*", "normal"), ("types.address type", "outside"), ("identifier.*", "continues")];
    for (place, key) in of_structs.into_iter().chain(of_fields) {
        assert!(is_zero(place, key), "{place} `{key}`");
    }
    assert!(!is_zero("header.*", "scale"), "the header reads no scale");
}
