//! Names the document of sections.

use super::Entries;
use crate::report::tree::{Content, NAMING, Node};

/// Keys that hold one item, or a text in place of it.
const ITEMS: [&str; 6] = ["after_silence", "value", "parts", "number", "counter", "length"];

/// Begins the sections of all items with a name, unless they begin with one of the other names.
pub fn name(spec: &mut Entries, name: &str, others: &[String]) {
    for (key, entry) in spec {
        match &mut entry.value.content {
            Content::Text(section) if key == "section" => *section = named(section, name, others),
            Content::Map(item) if ITEMS.contains(&key.as_str()) => self::name(item, name, others),
            Content::Map(items) if NAMING.contains(&key.as_str()) => {
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

#[cfg(all(test, feature = "schema"))]
mod tests {
    use serde_json::Value;

    use crate::reference::schema::schema;
    use crate::report::tree::{Content, Entry, Node};

    fn node(content: Content) -> Node {
        Node { span: 0..0, content }
    }

    fn entry(key: &str, value: Node) -> Node {
        node(Content::Map([(key.to_owned(), Entry { key: 0..0, value })].into_iter().collect()))
    }

    /// Returns a spec for each place that can have a section, with nothing else. Definitions hold themselves; each is
    /// entered twice. `within` are those that stand around.
    fn specs(all: &Value, schema: &Value, within: &[&str]) -> Vec<Node> {
        let of = |schema| specs(all, schema, within);
        let form = |key: &str| schema.get(key);
        let alternatives = form("anyOf").and_then(Value::as_array).into_iter().flatten().flat_map(of);
        let listed = form("items").into_iter().flat_map(of).map(|item| node(Content::List(vec![item])));
        let named = form("additionalProperties").into_iter().flat_map(of).map(|item| entry("anything", item));
        let keys = form("properties").and_then(Value::as_object).into_iter().flatten().flat_map(|(key, value)| {
            let section = (key == "section").then(|| node(Content::Text("2".to_owned())));
            of(value).into_iter().chain(section).map(|value| entry(key, value))
        });
        let name = form("$ref").and_then(Value::as_str).and_then(|path| path.strip_prefix("#/definitions/"));
        let name = name.filter(|name| within.iter().filter(|other| other == &name).count() < 2);
        let defined =
            name.into_iter().flat_map(|name| specs(all, &all["definitions"][name], &[within, &[name]].concat()));
        alternatives.chain(listed).chain(named).chain(keys).chain(defined).collect()
    }

    /// Returns the path of the only section of a spec, and its text.
    fn section(spec: &Node) -> (String, &str) {
        let (key, inner) = match &spec.content {
            Content::Text(text) => return (String::new(), text),
            Content::Map(entries) => entries.first().map(|(key, entry)| (key.as_str(), &entry.value)),
            Content::List(items) => items.first().map(|item| ("0", item)),
            Content::Refused => None,
        }
        .expect("each node has one below it");
        let (path, text) = section(inner);
        (format!("{key}/{path}"), text)
    }

    #[test]
    fn every_section_of_the_schema_gets_the_name() {
        let schema: Value = serde_json::from_str(&schema()).expect("it is JSON");
        let specs = specs(&schema, &schema, &[]);
        assert!(specs.len() > 50, "{} places", specs.len());
        for mut spec in specs {
            let Content::Map(entries) = &mut spec.content else { unreachable!("a spec is a map") };
            super::name(entries, "base", &[]);
            let (path, text) = section(&spec);
            assert_eq!(text, "base 2", "{path}");
        }
    }
}
