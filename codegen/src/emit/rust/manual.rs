//! The documentation of a module: the document, an example, every message, and the times.

mod example;
mod table;

use super::plan::Plan;
use super::plan::doc::{self, Comment};
use super::plan::usage::time;
use crate::emit::Scaled;
use crate::model::{Doc, Document, Protocol, Quantity, Silence, Timing};
use crate::words::text::Text;

/// What the documentation is written from.
pub struct Manual<'a> {
    /// The protocol.
    pub protocol: &'a Protocol,
    /// Its module.
    pub plan: &'a Plan,
    /// What scaled values are.
    pub scaled: Scaled,
}

impl Manual<'_> {
    /// Returns the documentation as inner doc comments.
    pub fn text(&self) -> String {
        let sides = self.protocol.sides.sentence();
        let head = Comment::new([self.title(), self.documents()].into_iter().chain(sides).chain([SHARED.to_owned()]));
        let parts = [section(head.lines()), self.example(), self.table(), self.timing(), self.limits()];
        let parts: Vec<_> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        parts.join("//!\n")
    }

    fn title(&self) -> String {
        doc::sentence_of(&self.protocol.title.in_rust_doc())
    }

    /// Says which documents it follows, and how fast the bus is.
    fn documents(&self) -> String {
        let Protocol { documents, bit_rates, .. } = self.protocol;
        let documents = documents.iter().map(document).collect::<Vec<_>>().join(" ");
        let rates: Vec<_> = bit_rates.iter().map(|rate| format!("{} kbit/s", f64::from(*rate) / 1000.0)).collect();
        let bus = if rates.is_empty() { String::new() } else { format!(" The bus runs at {}.", rates.join(" or ")) };
        format!("{documents}{bus}")
    }

    /// Lists the times that the document states, and what silence does.
    fn timing(&self) -> String {
        let times = self.protocol.timing.iter().map(|timing| self.stated(timing));
        let silence = self.protocol.after_silence.iter().map(|silence| self.silent(silence));
        let list = doc::list(times.chain(silence));
        if list.is_empty() { list } else { section(Comment::new(["# Timing".to_owned(), list]).lines()) }
    }

    /// Lists the limits of the product.
    fn limits(&self) -> String {
        let items = self.protocol.limits.iter().map(|limit| format!("`{}`: {}.", limit.quantity, limit.text()));
        let list = doc::list(items);
        if list.is_empty() { list } else { section(Comment::new(["# Limits of the product".to_owned(), list]).lines()) }
    }

    fn silent(&self, silence: &Silence) -> String {
        let sentence = doc::sentence_of(&format!("After silence the output {}", silence.output.meaning()));
        self.remarked(&silence.doc, &sentence)
    }

    fn stated(&self, timing: &Timing) -> String {
        let least = timing.minimum.map(|minimum| format!(", at least {}", quantity(minimum)));
        let title = doc::title(&timing.doc, &timing.name);
        let role = timing.role.map(|role| format!(" (`{}`)", role.name()));
        let [least, role] = [least, role].map(Option::unwrap_or_default);
        let sentence = doc::sentence_of(&format!("{title}: {}{least}{role}", time(timing)));
        self.remarked(&timing.doc, &sentence)
    }

    /// Adds the note and the section of an item of a list to its sentence.
    fn remarked(&self, doc: &Doc, sentence: &str) -> String {
        let errata_at_items = Doc { errata: Vec::new(), ..doc.clone() };
        doc::paragraphs(self.protocol, &errata_at_items, sentence, None).join(" ")
    }
}

/// Says in a sentence which document it is.
fn document(document: &Document) -> String {
    let [title, version] = [&document.title, &document.version].map(Text::within_rust_doc);
    let date = document.date.as_ref().map_or_else(String::new, |date| format!(" of {}", date.within_rust_doc()));
    let name = document.name.as_ref().map_or_else(String::new, |name| format!(" `{name}`"));
    doc::sentence_of(&format!("Document{name}: {title}, version {version}{date}"))
}

const SHARED: &str = "What all protocols have in common, such as `Frame` and `Error`, is re-exported below.";

/// Writes lines as inner doc comments.
fn section(lines: &[String]) -> String {
    lines.iter().fold(String::new(), |text, line| text + format!("//! {line}").trim_end() + "\n")
}

fn quantity(Quantity { value, unit }: Quantity) -> String {
    format!("{value}{}", unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol)))
}
