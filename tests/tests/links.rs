//! Generated code needs no standard library and cannot panic: a program that could would not be linked.
#![cfg(target_os = "linux")]

use std::env;
use std::path::Path;

use canspec_codegen::emit::{Goal, Scaled};
use canspec_tests::bare::{Binary, Codec, Others, Program, Settings, is_installed};

const SIZE: Settings<'static> = Settings { profile: "z", target: None };
const SPEED: Settings<'static> = Settings { profile: "three", target: None };

/// How programs are linked: for size, and if the environment variable `CANSPEC_DEEP` is set, then for speed, too.
fn all_settings() -> &'static [Settings<'static>] {
    if env::var_os("CANSPEC_DEEP").is_some() { &[SIZE, SPEED] } else { &[SIZE] }
}

fn link(program: &Program, settings: Settings<'_>) -> Result<Binary, String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bare");
    program.link(&folder, settings).expect("cargo runs")
}

fn linked(program: &Program, settings: Settings<'_>) -> Binary {
    link(program, settings).unwrap_or_else(|message| panic!("{message}"))
}

#[test]
fn every_function_of_every_protocol_links_without_std_and_without_panics() {
    let codecs = |goal| ["specs", "tests/specs"].map(|folder| Codec::all(folder, Scaled::F64, goal)).concat();
    linked(&Program::everything(&codecs(Goal::Size)), SIZE);
    if all_settings().contains(&SPEED) {
        linked(&Program::codecs(&codecs(Goal::Speed)), SPEED);
    }
}

#[test]
fn every_construct_of_the_language_links_without_std_and_without_panics() {
    for folder in ["tests/specs/features", "tests/specs/devices"] {
        linked(&Program::codecs(&Codec::all(folder, Scaled::F64, Goal::Size)), SIZE);
    }
}

#[test]
fn whole_steps_link_without_std_and_without_panics() {
    for folder in ["specs", "tests/specs/features"] {
        linked(&Program::codecs(&Codec::all_in_steps(folder, Goal::Size)), SIZE);
    }
}

#[test]
fn one_indexing_expression_in_one_decoder_does_not_link() {
    let codec = Codec::all("specs", Scaled::F64, Goal::Size).pop().expect("there are specs");
    let message = link(&Program::codecs(&[codec.with_index()]), SIZE).expect_err("a panic needs what nobody defines");
    assert!(message.contains("undefined") && message.contains("this_program_can_panic"), "{message}");
}

#[test]
fn one_message_alone_does_not_link_the_others() {
    for codec in Codec::all("specs", Scaled::F64, Goal::Size) {
        let Some(owner) = codec.one_message() else { continue };
        let others = Others::new(&codec, &owner);
        let every = linked(&Program::decode(&codec), SIZE);
        assert!(!others.named_in(&every).is_empty(), "names are found where they are");
        for settings in all_settings() {
            let alone = linked(&Program::one_message(&codec), *settings);
            assert_eq!(others.named_in(&alone), Vec::<&str>::new());
            assert_eq!(others.symbols_in(&alone), Vec::<String>::new());
        }
    }
}

/// A processor without instructions for doubles: each operation on them is a function that is linked.
const SINGLE: Settings<'static> = Settings { profile: "z", target: Some("thumbv7em-none-eabihf") };

/// Tests whether a function calculates with doubles, by the names of LLVM and of the ABI of ARM.
fn is_of_doubles(symbol: &str) -> bool {
    let of_arm = symbol.strip_prefix("__aeabi_").is_some_and(|name| name.starts_with('d') || name.ends_with("2d"));
    of_arm || symbol.starts_with("__") && (symbol.contains("df") || symbol.ends_with("dfti"))
}

/// Returns the functions that calculate with doubles in a program that decodes, encodes, asks and reads replies.
fn doubles(codecs: &[Codec]) -> Vec<String> {
    let mut symbols = linked(&Program::traffic(codecs), SINGLE).symbols();
    symbols.retain(|symbol| is_of_doubles(symbol));
    symbols
}

#[test]
fn a_driver_in_whole_steps_never_calculates_with_doubles() {
    if !SINGLE.target.is_some_and(is_installed) {
        eprintln!("SKIPPED: the toolchain has no thumbv7em-none-eabihf; `rustup target add` installs it");
        return;
    }
    let codecs = |scaled| Codec::all("specs", scaled, Goal::Size);
    assert_eq!(doubles(&codecs(Scaled::Steps)), Vec::<String>::new());
    assert!(!doubles(&codecs(Scaled::F64)[..1]).is_empty(), "such functions are found where they are");
}
