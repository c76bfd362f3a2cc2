//! What was meant by a call with a word too many.

use std::env;
use std::ffi::OsString;

use canspec_specs::find;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Error, Parser};

use crate::Canspec;
use crate::command::Command;

/// Adds a tip to a refusal, if the call is right once the tip is followed.
pub fn with_tip(mut refusal: Error) -> Error {
    let unknown = match refusal.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(word)) if refusal.kind() == ErrorKind::UnknownArgument => word.clone(),
        _ => return refusal,
    };
    let words: Vec<OsString> = env::args_os().collect();
    let tip = format(&words, &unknown).or_else(|| spec(&words)).or_else(|| several(words, &unknown));
    if let Some(tip) = tip {
        refusal.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
        refusal.remove(ContextKind::SuggestedArg);
    }
    refusal
}

/// Suggests `--format csv` in place of `--csv`, and `--format jsonl` in place of `--json`.
fn format(words: &[OsString], unknown: &str) -> Option<String> {
    let format = unknown.strip_prefix("--")?;
    let format = match parse(&with(words, unknown, "format", format)) {
        Ok(_) => format.to_owned(),
        Err(refusal) => match refusal.get(ContextKind::SuggestedValue) {
            Some(ContextValue::String(known)) => known.clone(),
            _ => return None,
        },
    };
    let is_right = parse(&with(words, unknown, "format", &format)).is_ok();
    is_right.then(|| format!("a similar argument exists: '--format {format}'"))
}

/// Suggests an option for the name of a protocol or of a spec file that stands alone.
fn spec(words: &[OsString]) -> Option<String> {
    words.iter().skip(1).filter_map(|word| word.to_str()).find_map(|word| {
        let option = match word.rsplit_once('.') {
            Some((_, "yaml" | "yml")) => "spec",
            None if find(word).is_some() => "protocol",
            _ => return None,
        };
        let is_right = parse(&with(words, word, option, word)).is_ok();
        is_right.then(|| format!("an option names it: '--{option} {word}'"))
    })
}

/// Suggests how several logs are read as one, if nothing but the other logs is wrong.
fn several(mut words: Vec<OsString>, unknown: &str) -> Option<String> {
    let mut surplus = unknown.to_owned();
    loop {
        if surplus.starts_with('-') {
            return None;
        }
        let place = words.iter().rposition(|word| word.to_str() == Some(&surplus))?;
        words.remove(place);
        match parse(&words) {
            Ok(Canspec { command: Command::Decode(_) | Command::Identify(_) }) => {
                return Some("several logs are read as one: 'cat LOG LOG | canspec ... -'".to_owned());
            }
            Ok(_) => return None,
            Err(refusal) => match refusal.get(ContextKind::InvalidArg) {
                Some(ContextValue::String(word)) if refusal.kind() == ErrorKind::UnknownArgument => {
                    surplus.clone_from(word);
                }
                _ => return None,
            },
        }
    }
}

fn parse(words: &[OsString]) -> Result<Canspec, Error> {
    Canspec::try_parse_from(words)
}

/// Returns the call with `--OPTION=VALUE` in place of a word.
fn with(words: &[OsString], replaced: &str, option: &str, value: &str) -> Vec<OsString> {
    let replace = |word: &OsString| {
        if word.to_str() == Some(replaced) { format!("--{option}={value}").into() } else { word.clone() }
    };
    words.iter().map(replace).collect()
}
