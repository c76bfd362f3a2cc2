//! Any bytes as the lines of a log: what can be read is shown in all forms, and comes back.

use std::sync::LazyLock;

use canspec::files::{Shown, decoded, encoded};
use canspec_codegen::model::Protocol;
use serde_json::Value;

use crate::{protocol, specs};

/// Longest complaint about a line, and longest table of a frame of it, which may be as long as its protocol's names.
const COMPLAINT: usize = 400;
const TABLE: usize = 10_000;

static PROTOCOLS: LazyLock<Vec<Protocol>> = LazyLock::new(|| specs("specs").into_iter().map(protocol).collect());

/// Reads each line by the protocol that the first byte chooses.
pub fn run(data: &[u8]) {
    let choice = usize::from(data.first().copied().unwrap_or_default());
    let protocol = &PROTOCOLS[choice % PROTOCOLS.len()];
    for line in data.split(|byte| *byte == b'\n').filter_map(|line| str::from_utf8(line).ok()) {
        match decoded(protocol, line) {
            Ok(None) => assert!(line.trim_ascii().is_empty(), "{line:?} is skipped"),
            Ok(Some(shown)) => check(protocol, line, &shown),
            Err(why) => assert!(why.len() < COMPLAINT && !why.contains(char::is_control), "{why:?}"),
        }
        if let Err(why) = encoded(protocol, line) {
            assert!(why.len() < line.len() + COMPLAINT, "{why}");
        }
    }
}

fn check(protocol: &Protocol, line: &str, shown: &Shown) {
    let Shown { json, table, capture } = shown;
    let object: Value = serde_json::from_str(json).unwrap_or_else(|error| panic!("{line:?}: {error}: {json}"));
    assert!(!table.contains(|letter: char| letter.is_control() && letter != '\n'), "{table:?}");
    assert!(table.len() < TABLE, "{} bytes for {line:?}", table.len());
    assert!(capture.as_ref().is_ok_and(|bytes| bytes.len() % 4 == 0) || object["time"].is_number(), "{line:?}");
    if object["notes"].as_array().is_none_or(|notes| !notes.is_empty()) {
        return;
    }
    let again = encoded(protocol, json).unwrap_or_else(|why| panic!("{json}: {why}")).expect("the line is not blank");
    let frame =
        format!("{}#{}", object["id"].as_str().unwrap_or_default(), object["data"].as_str().unwrap_or_default());
    assert!(again.trim_end().ends_with(&frame), "{line:?} comes back as {again:?}");
}
