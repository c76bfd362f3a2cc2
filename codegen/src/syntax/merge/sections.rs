//! Names the document of sections.

use super::Entries;
use crate::syntax::tree::{Content, Node};

/// Keys whose maps hold items, which can have a section.
const MAPS: [&str; 14] = [
    "identifier",
    "header",
    "types",
    "addressing",
    "access",
    "foreign",
    "transports",
    "messages",
    "models",
    "timing",
    "procedures",
    "errata",
    "fields",
    "status",
];

/// Begins the sections of all items with a name, unless they begin with one of the other names.
pub fn name(spec: &mut Entries, name: &str, others: &[String]) {
    for (key, entry) in spec {
        match &mut entry.value.content {
            Content::Text(section) if key == "section" => *section = named(section, name, others),
            Content::Map(item) if key == "value" => self::name(item, name, others),
            Content::Map(items) if key == "examples" || MAPS.contains(&key.as_str()) => {
                let items = items.values_mut().map(|entry| &mut entry.value);
                items.for_each(|item| name_item(item, name, others));
            }
            Content::List(items) if key == "examples" || key == "frames" => {
                for item in items {
                    name_item(item, name, others);
                }
            }
            Content::Text(_) | Content::List(_) | Content::Map(_) | Content::Refused => {}
        }
    }
}

fn name_item(item: &mut Node, name: &str, others: &[String]) {
    if let Content::Map(item) = &mut item.content {
        self::name(item, name, others);
    }
}

/// Begins each place of a section with a name, as in `P 2.1; C 4`.
fn named(section: &str, name: &str, others: &[String]) -> String {
    let places = section.split(';').map(str::trim).map(|place| {
        let first = place.split_whitespace().next().unwrap_or_default();
        if others.iter().any(|other| other == first) { place.to_owned() } else { format!("{name} {place}") }
    });
    places.collect::<Vec<_>>().join("; ")
}
