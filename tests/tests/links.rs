//! Generated code needs no standard library and cannot panic: a program that could would not be linked.
#![cfg(target_os = "linux")]

use std::path::Path;

use canspec_tests::bare::{Binary, Codec, Others, Program, Settings};

const SIZE: Settings<'static> = Settings { profile: "z", target: None };
const SPEED: Settings<'static> = Settings { profile: "three", target: None };

fn link(program: &Program, settings: Settings<'_>) -> Result<Binary, String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bare");
    program.link(&folder, settings).expect("cargo runs")
}

fn linked(program: &Program, settings: Settings<'_>) -> Binary {
    link(program, settings).unwrap_or_else(|message| panic!("{message}"))
}

#[test]
fn every_function_of_every_protocol_links_without_std_and_without_panics() {
    let program = Program::everything(&[Codec::all("specs"), Codec::all("tests/specs")].concat());
    linked(&program, SIZE);
    linked(&program, SPEED);
}

#[test]
fn every_construct_of_the_language_links_without_std_and_without_panics() {
    linked(&Program::everything(&Codec::all("tests/specs/features")), SIZE);
    linked(&Program::everything(&Codec::all("tests/specs/devices")), SIZE);
}

#[test]
fn one_indexing_expression_in_one_decoder_does_not_link() {
    let mut codecs = Codec::all("specs");
    let Some(codec) = codecs.pop() else { return };
    codecs.push(codec.with_index());
    let message = link(&Program::everything(&codecs), SIZE).expect_err("a panic needs what nobody defines");
    assert!(message.contains("undefined") && message.contains("this_program_can_panic"), "{message}");
}

#[test]
fn one_message_alone_does_not_link_the_others() {
    for codec in Codec::all("specs") {
        let Some(owner) = codec.one_message() else { continue };
        let others = Others::new(&codec, &owner);
        let every = linked(&Program::decode(&codec), SIZE);
        assert!(!others.named_in(&every).is_empty(), "names are found where they are");
        for settings in [SIZE, SPEED] {
            let alone = linked(&Program::one_message(&codec), settings);
            assert_eq!(others.named_in(&alone), Vec::<&str>::new());
            assert_eq!(others.symbols_in(&alone), Vec::<String>::new());
        }
    }
}
