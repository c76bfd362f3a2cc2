//! The order of messages in a spec says nothing about what they have in common.

use canspec_codegen::model::StatusWord;
use canspec_codegen::source::Source;
use canspec_codegen::{Outcome, compile};

/// Places of a word in three messages, in each of their orders. The widest has 16 bits.
const ORDERS: [[&str; 3]; 6] = [
    ["0", "1..2", "3"],
    ["0", "3", "1..2"],
    ["1..2", "0", "3"],
    ["1..2", "3", "0"],
    ["3", "0", "1..2"],
    ["3", "1..2", "0"],
];

/// Compiles messages that have a status word of one type at these places.
fn outcome(places: [&str; 3], bits: &str) -> Outcome {
    let message = |place: &str| {
        let command = place.len() + place.parse::<usize>().unwrap_or(9);
        format!(
            "  at_{command}: {{match: {{command: {command}}}, access: [report], fields: {{seen: {{bytes: {place}, type: alarms}}}}}}\n"
        )
    };
    let text = format!(
        "canspec: 1\nprotocol: fan\ntitle: Fans\ndocument: {{title: Fan manual, version: \"1\"}}\nlength: 8\n\
         identifier: {{command: {{bits: 10..0}}}}\naddressing: {{all: {{one: {{}}}}}}\n\
         access: {{report: {{report: {{}}, answers: {{all: one}}}}}}\n\
         types: {{alarms: {{status: {{{bits}}}}}}}\nmessages:\n{}",
        places.map(message).concat()
    );
    compile(Source::new("fan.yaml", text.into()).expect("it is text"))
}

#[test]
fn a_status_bit_may_lie_anywhere_in_the_widest_word_of_its_type() {
    for places in ORDERS {
        let outcome = outcome(places, "hot: {bit: 15}, fan: {bit: 3}, phase: {bit: 8, repeat: 3}");
        let protocol = outcome.protocol.unwrap_or_else(|| panic!("{places:?}: {}", outcome.diagnostics.concise()));
        let words: Vec<&StatusWord> = protocol.status_words.iter().collect();
        let [word] = words.as_slice() else { panic!("{} words", words.len()) };
        let bits: Vec<_> = word.bits.iter().map(|bit| (bit.bit, bit.name.as_str())).collect();
        assert_eq!(
            (word.width, &*bits),
            (16, &[(3, "fan"), (8, "phase_1"), (9, "phase_2"), (10, "phase_3"), (15, "hot")][..])
        );
    }
}

#[test]
fn a_status_bit_beyond_the_widest_word_is_refused_in_every_order() {
    for (bits, error) in [
        ("hot: {bit: 16}, fan: {bit: 3}", "there is no bit 16 in this word of 16 bits"),
        ("hot: {bit: 14, repeat: 3}", "3 bits from bit 14 on are more than this word of 16 has"),
        ("hot: {bit: 70}", "there is no bit 70 in this word of 16 bits"),
        ("hot: {bit: 17}, fan: {bit: 20}", "this word has 16 bits, and 2 of its status bits lie beyond"),
    ] {
        for places in ORDERS {
            let outcome = outcome(places, bits);
            let errors = outcome.diagnostics.concise();
            assert!(outcome.protocol.is_none() && errors.contains(error), "{places:?}: {errors}");
            assert_eq!(outcome.diagnostics.errors(), 1, "{places:?}: {errors}");
        }
    }
}
