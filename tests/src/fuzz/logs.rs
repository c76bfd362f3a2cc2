//! Any bytes as the lines of a log: what can be read is shown in all forms, and comes back.

use std::sync::LazyLock;

use canspec::files::{Log, Shown, encoded};
use canspec_codegen::model::Protocol;
use serde_json::Value;

use crate::{protocol, specs};

/// Longest complaint about a line, which shows 40 characters of it, and escapes each.
const COMPLAINT: usize = 700;
/// Longest table of a frame of it, which may be as long as its protocol's names.
const TABLE: usize = 10_000;

static PROTOCOLS: LazyLock<Vec<Protocol>> = LazyLock::new(|| specs("specs").into_iter().map(protocol).collect());

/// Reads each line by the protocol that the first byte chooses.
pub fn run(data: &[u8]) {
    let choice = usize::from(data.first().copied().unwrap_or_default());
    let protocol = &PROTOCOLS[choice % PROTOCOLS.len()];
    let mut log = Log::default();
    for line in data.split(|byte| *byte == b'\n').filter_map(|line| str::from_utf8(line).ok()) {
        match log.decoded(protocol, line) {
            Ok(None) => {}
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
    let again = match encoded(protocol, json) {
        Ok(again) => again,
        // Decoding knows no model, and so no limits of one.
        Err(why) => return assert!(why.contains("the limits of the models taken together"), "{json}: {why}"),
    };
    let frame =
        format!("{}#{}", object["id"].as_str().unwrap_or_default(), object["data"].as_str().unwrap_or_default());
    assert!(again.trim_end().ends_with(&frame), "{line:?} comes back as {again:?}");
}
