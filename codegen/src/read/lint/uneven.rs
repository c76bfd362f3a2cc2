#![doc = include_str!("../../../docs/rules/uneven.md")]

use indexmap::IndexMap;

use super::Written;
use super::table::Table;
use crate::report::diagnostic::Diagnostic;
use crate::report::rule::rules;
use crate::report::tree::{Entry, Path};

rules! {
    UNEVEN "uneven" Lint WARNING;
}

/// Fewest entries that show what all have.
const FEWEST: usize = 4;

/// Kinds of maps, and the keys that every entry of them can have.
const KEYS: [(&str, &[&str]); 5] = [
    ("status", &["severity", "title"]),
    ("messages", &["title"]),
    ("models", &["title", "items", "max_parallel", "bit_rates", "facts", "types"]),
    ("timing", &["title"]),
    ("procedures", &["title"]),
];

/// Keys of models whose maps have the same names in each model.
const OF_MODELS: [&str; 2] = ["facts", "types"];

/// A map whose keys are compared with those of its siblings.
struct Sibling<'a> {
    name: &'a str,
    path: Path,
    entries: &'a IndexMap<String, Entry>,
}

pub fn lint(written: &Written) -> Vec<Diagnostic> {
    written.tables.iter().flat_map(uneven).collect()
}

fn uneven(table: &Table) -> Vec<Diagnostic> {
    let Some((_, keys)) = KEYS.iter().find(|(kind, _)| *kind == table.kind) else { return Vec::new() };
    let whole = siblings(table, None);
    let of_models = OF_MODELS.iter().filter(|_| table.kind == "models").map(|map| siblings(table, Some(map)));
    let parts = of_models.filter(|parts| parts.len() == whole.len()).filter_map(|parts| missing(&parts, |_| true));
    missing(&whole, |key| keys.contains(&key)).into_iter().chain(parts).collect()
}

/// Returns the entries of a table, or the maps after a key of each entry.
fn siblings<'a>(table: &Table<'a>, key: Option<&str>) -> Vec<Sibling<'a>> {
    let entries = table.entries.iter();
    entries
        .filter_map(|(name, entry)| {
            let path = table.path.key(name);
            Some(match key {
                None => Sibling { name, path, entries: entry.value.entries()? },
                Some(key) => Sibling { name, path: path.key(key), entries: entry.value.child_at(key)?.entries()? },
            })
        })
        .collect()
}

/// Finds the one key that all siblings but one have. An entry that lacks several keys is of another
/// kind.
fn missing(siblings: &[Sibling], is_compared: impl Fn(&str) -> bool) -> Option<Diagnostic> {
    let mut counts: IndexMap<&str, usize> = IndexMap::new();
    for key in siblings.iter().flat_map(|sibling| sibling.entries.keys()).filter(|key| is_compared(key)) {
        *counts.entry(key).or_default() += 1;
    }
    let mut keys = counts.into_iter().filter(|(_, count)| siblings.len() >= FEWEST && count + 1 == siblings.len());
    let (key, _) = keys.next().filter(|_| keys.next().is_none())?;
    let odd = siblings.iter().position(|sibling| !sibling.entries.contains_key(key))?;
    Some(diagnostic(siblings, odd, key))
}

fn diagnostic(siblings: &[Sibling], odd: usize, key: &str) -> Diagnostic {
    let Sibling { name, path, entries } = &siblings[odd];
    let neighbour = &siblings[if odd == 0 { 1 } else { odd - 1 }];
    let keys_before = neighbour.entries.keys().take_while(|known| *known != key);
    let at = keys_before
        .filter(|known| entries.contains_key(*known))
        .last()
        .map_or_else(|| path.clone(), |known| path.key(known));
    let text = format!("`{name}` has no `{key}`, which all {} others have", siblings.len() - 1);
    let help = match key {
        "title" => {
            "write a `title`, a few words for people; or say with an entry of `allow` why there is none".to_owned()
        }
        _ => format!("write `{key}`; if the document leaves it out, say so with an entry of `allow`"),
    };
    Diagnostic::warning(&UNEVEN, at.at_key(), text).label(format!("`{key}` is missing after this")).help(help)
}
