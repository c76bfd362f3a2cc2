//! Exported DBCs by an independent reader, and by the frames that the documents print.

use std::collections::BTreeSet;
use std::path::PathBuf;

use can_dbc::{Dbc, MessageId};
use canspec_codegen::emit::dbc;
use canspec_codegen::model::{Example, NoteRule, Protocol};
use canspec_tests::{protocol, specs};

/// Returns every spec that is right.
fn all() -> Vec<PathBuf> {
    let folders = ["specs", "tests/specs", "tests/specs/features", "tests/specs/devices", "tests/peers"];
    folders.into_iter().flat_map(specs).collect()
}

/// Returns the protocol of a feature.
fn feature(name: &str) -> Protocol {
    let path = specs("tests/specs/features").into_iter().find(|path| path.file_stem().is_some_and(|stem| stem == name));
    protocol(path.expect("the feature has a spec"))
}

fn read(text: &str) -> Dbc {
    Dbc::try_from(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Returns the identifiers, each with its width.
fn identifiers(dbc: &Dbc) -> Vec<(bool, u32)> {
    let number = |id: &MessageId| match id {
        MessageId::Standard(id) => (false, (*id).into()),
        MessageId::Extended(id) => (true, *id),
    };
    dbc.messages.iter().map(|message| number(&message.id)).collect()
}

#[test]
fn another_reader_finds_every_frame_and_no_identifier_twice() {
    for path in all() {
        let protocol = protocol(&path);
        for nodes in [None, Some(0..=3)] {
            let exported = dbc(&protocol, nodes);
            let read = read(&exported.text);
            let identifiers = identifiers(&read);
            let masked: BTreeSet<u32> = identifiers.iter().map(|(_, id)| id & exported.mask).collect();
            assert_eq!(identifiers.len(), exported.counts.1, "{}", path.display());
            assert_eq!(masked.len(), identifiers.len(), "{}", path.display());
            assert!(identifiers.iter().all(|(extended, _)| *extended == protocol.identifier.extended));
        }
    }
}

/// Tests whether the document foresees all of a frame.
fn is_foreseen(example: &Example) -> bool {
    let strange = [NoteRule::Address, NoteRule::Addressing];
    example.fails.is_none() && !example.notes.iter().any(|rule| strange.contains(rule))
}

/// Counts the document's frames. Each must have a message.
fn found(protocol: &Protocol, dbc: &Dbc, mask: u32) -> usize {
    let identifiers: BTreeSet<_> = identifiers(dbc).iter().map(|(wide, id)| (*wide, id & mask)).collect();
    let foreseen: Vec<_> = protocol.examples.iter().filter(|example| is_foreseen(example)).collect();
    for Example { extended, id, .. } in &foreseen {
        assert!(identifiers.contains(&(*extended, id & mask)), "{}: {id:X}", protocol.name);
    }
    foreseen.len()
}

#[test]
fn each_frame_of_a_document_is_found_by_the_mask() {
    let mut count = 0;
    for path in all() {
        let protocol = protocol(&path);
        let exported = dbc(&protocol, None);
        count += found(&protocol, &read(&exported.text), exported.mask);
    }
    assert!(count > 200, "only {count} frames");
}

#[test]
fn identifiers_of_nodes_are_those_of_the_document() {
    let protocol = feature("addressing");
    // Command 3 to and from modules 0 and 1, to and from groups 0 and 1, to all modules, and of one module for all.
    let expected = [
        (0x0043_00F0, "level_request_single_0"),
        (0x0043_01F0, "level_request_single_1"),
        (0x0083_00F0, "level_request_group_0"),
        (0x0083_01F0, "level_request_group_1"),
        (0x0043_3FF0, "level_request_all"),
        (0x0043_F000, "level_reply_single_0"),
        (0x0043_F001, "level_reply_single_1"),
        (0x0083_F000, "level_reply_group_0"),
        (0x0083_F001, "level_reply_group_1"),
        (0x0043_F03F, "level_reply_all"),
    ];
    let exported = dbc(&protocol, Some(0..=1));
    let read = read(&exported.text);
    let messages: Vec<_> = read.messages.iter().map(|message| message.name.as_str()).collect();
    let identifiers: Vec<u32> = identifiers(&read).iter().map(|(_, id)| *id).collect();
    assert_eq!(identifiers.into_iter().zip(messages).collect::<Vec<_>>(), expected);
    // All but the error code.
    assert_eq!(exported.mask, 0x03FF_FFFF);
}

#[test]
fn text_is_in_characters_that_every_tool_reads_alike() {
    for path in all() {
        let exported = dbc(&protocol(&path), None);
        assert!(exported.text.bytes().all(|byte| byte == b'\n' || (b' '..=b'~').contains(&byte)), "{}", path.display());
        assert_eq!(exported, dbc(&protocol(&path), None));
    }
}

#[test]
fn a_message_that_looks_like_another_one_is_named_as_missing() {
    let exported = dbc(&feature("model_layouts"), None);
    let lost = "`supply_dc` is missing in `supply_ac_report`, where nothing tells it from `supply_ac`";
    assert!(exported.losses.iter().any(|loss| loss == lost), "{:?}", exported.losses);
    assert!(exported.text.contains(lost) && !exported.text.contains("SG_ supply_dc"));
}

#[test]
fn an_empty_request_never_wins_over_a_message_with_signals() {
    let path = specs("tests/specs/devices").into_iter().find(|path| path.ends_with("overlapping_addresses.yaml"));
    let protocol = protocol(path.expect("the device has a spec"));
    let exported = dbc(&protocol, None);
    let messages = |text: &str| -> Vec<(String, Vec<String>)> {
        let messages = read(text).messages.into_iter();
        let names = |message: &can_dbc::Message| message.signals.iter().map(|signal| signal.name.clone()).collect();
        messages.map(|message| (message.name.clone(), names(&message))).collect()
    };
    let message = |name: &str, signals: &[&str]| {
        (name.to_owned(), signals.iter().map(|signal| (*signal).to_owned()).collect::<Vec<_>>())
    };
    let expected = [
        message("pressure_reply", &["inlet", "outlet"]),
        message("opening_request", &["share"]),
        message("temperature_report", &["value"]),
    ];
    assert_eq!(messages(&exported.text), expected);
    let dropped: Vec<_> =
        exported.dropped.iter().map(|dropped| (dropped.text.as_str(), dropped.has_own_identifier)).collect();
    let request = "`pressure` (request to read) is missing in `pressure_reply`, where nothing tells it from `pressure` (reply to read)";
    let restart = "`restart` is missing in `temperature_report`, whose length is 8 bytes";
    assert_eq!(dropped, [(request, true), (restart, true)]);
    assert!(exported.losses.iter().any(|loss| loss == request) && exported.losses.iter().any(|loss| loss == restart));

    let of_node = dbc(&protocol, Some(1..=1));
    assert_eq!((messages(&of_node.text).len(), of_node.dropped), (6, vec![]));
}
