//! The table of the messages.

use super::{Manual, section};
use crate::emit::rust::plan::doc;
use crate::emit::rust::plan::message::Message;
use crate::model::{self, Constant};
use crate::words::text::Text;

impl Manual<'_> {
    /// Lists the messages in the order of the document, each in a row.
    pub fn table(&self) -> String {
        let messages = self.protocol.messages.iter().zip(&self.plan.messages);
        let selectors = self.selectors();
        let names = selectors.iter().map(|name| format!("`{name}`"));
        let titles = ["message", "title", "access", "section"].map(str::to_owned);
        let head: Vec<_> = names.chain(titles).collect();
        let rule = vec!["---".to_owned(); head.len()];
        let rows = messages.map(|(known, message)| self.row(&selectors, known, message));
        let rows = [head, rule].into_iter().chain(rows).map(|cells| format!("| {} |", cells.join(" | ")));
        let lines: Vec<_> = ["# Messages".to_owned(), String::new()].into_iter().chain(rows).collect();
        section(&lines)
    }

    /// Returns the names of the fields that choose messages, in the order in which messages name them.
    fn selectors(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for constant in self.protocol.messages.iter().flat_map(|message| &message.constants) {
            let name = self.protocol[constant.selector].name.as_str();
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }

    fn row(&self, selectors: &[&str], known: &model::Message, message: &Message) -> Vec<String> {
        let value = |constant: &Constant| self.protocol.selector_value(constant.selector, constant.value);
        let is_named = |constant: &&Constant, name: &str| self.protocol[constant.selector].name == name;
        let values = selectors.iter().map(|name| {
            let constant = known.constants.iter().find(|constant| is_named(constant, name));
            constant.map(value).unwrap_or_default()
        });
        let whole = message.whole();
        let title = known.doc.title.as_ref().map_or_else(|| doc::title(&known.doc, &known.name), Text::in_rust_table);
        let accesses = known.exchanges.iter().zip(&message.exchanges);
        let mut accesses: Vec<_> =
            accesses.map(|(own, way)| format!("[`{}`]({})", self.protocol[own.access].name, way.shared)).collect();
        accesses.dedup();
        let section = known.doc.section.as_ref().map_or_else(String::new, Text::in_rust_table);
        let cells = [format!("[`{whole}`](struct@{whole})"), title, accesses.join(", "), section];
        values.chain(cells).collect()
    }
}
