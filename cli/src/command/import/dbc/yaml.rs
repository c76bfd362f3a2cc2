//! The spec as YAML.

use std::collections::BTreeSet;
use std::fmt::{self, Display, Formatter};

use super::names::Names;
use super::places::groups;
use super::spec::{Field, Message, Spec};

/// Words that readers of YAML take for different things.
const UNCLEAR: [&str; 9] = ["on", "off", "yes", "no", "y", "n", "true", "false", "null"];

/// Writes a text, in quotes where YAML needs them.
pub fn quoted(text: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "_.-+/() ".contains(letter);
    let begins = text.starts_with(|first: char| first.is_ascii_alphanumeric());
    let is_marked = text.split(' ').any(|word| word.is_empty() || word.starts_with('-'));
    let is_unclear = UNCLEAR.contains(&text.to_ascii_lowercase().as_str());
    if begins && !is_marked && text.chars().all(is_plain) && !is_unclear {
        return text.to_owned();
    }
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Writes a map in one line.
pub fn map<'a>(entries: impl IntoIterator<Item = (&'a str, &'a str)>) -> String {
    let entries: Vec<_> = entries.into_iter().map(|(key, value)| format!("{key}: {value}")).collect();
    format!("{{{}}}", entries.join(", "))
}

impl Display for Spec {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        writeln!(out, "# A first spec, made by `canspec import dbc` from {}.", self.file)?;
        writeln!(out, "# Where it says DECIDE, the vendor's document must say more than a DBC can.")?;
        if !self.limits.is_empty() {
            writeln!(out, "#\n# What the DBC says and this spec does not:")?;
            self.limits.iter().try_for_each(|limit| writeln!(out, "# - {limit}"))?;
        }
        self.write_head(out)?;
        self.write_cycles(out)?;
        if !self.messages.is_empty() {
            writeln!(
                out,
                "\n# DECIDE: the section of each message in the document, and example frames from it\nmessages:"
            )?;
        }
        self.messages.iter().try_for_each(|message| message.write(self.length, out))?;
        self.write_allowances(out)
    }
}

impl Spec {
    fn write_head(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let (file, version) = (quoted(&self.file), quoted(&self.version));
        writeln!(out, "\ncanspec: 1\nprotocol: {}", quoted(&self.protocol))?;
        writeln!(out, "title: {}  # DECIDE: what the devices are", quoted(&self.protocol))?;
        writeln!(out, "document: {{title: {file}, version: {version}}}  # DECIDE: the document of the vendor")?;
        writeln!(out, "length: {}\n", self.length)?;
        let high = if self.extended { 28 } else { 10 };
        writeln!(
            out,
            "# DECIDE: which bits are addresses, commands, priorities\nidentifier:\n  id: {{bits: {high}..0}}\n"
        )?;
        writeln!(out, "# DECIDE: who is asked, who answers; which messages are requests and replies\naddressing:")?;
        writeln!(out, "  bus: {{one: {{}}}}\n\naccess:\n  report: {{report: {{}}, answers: {{bus: one}}}}")
    }

    /// Allows what a DBC cannot say, so that `check` warns of the rest.
    fn write_allowances(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let has = |test: fn(&Field) -> bool| self.messages.iter().flat_map(|message| &message.fields).any(test);
        let sections = "a DBC names no sections";
        let allowed = [
            ("section", "timing", sections, self.messages.iter().any(|message| message.cycle.is_some())),
            ("section", "messages", sections, !self.messages.is_empty()),
            ("no_unit", "messages", "the DBC states no unit", has(Field::is_without_unit)),
            ("read_only_range", "messages", "the DBC states limits", has(Field::is_limited)),
        ];
        let mut allowed = allowed.into_iter().filter(|(.., is_needed)| *is_needed).peekable();
        if allowed.peek().is_some() {
            writeln!(out, "\n# DECIDE: take an entry out when the spec says what its reason lacks\nallow:")?;
        }
        allowed.try_for_each(|(rule, at, why, _)| writeln!(out, "  - {{rule: {rule}, at: {at}, because: {why}}}"))
    }

    fn write_cycles(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let cycles: BTreeSet<u64> = self.messages.iter().filter_map(|message| message.cycle).collect();
        if !cycles.is_empty() {
            writeln!(out, "\ntiming:")?;
        }
        cycles.iter().try_for_each(|cycle| writeln!(out, "  {}: {{time: {cycle} ms}}", cycle_name(*cycle)))
    }
}

fn cycle_name(cycle: u64) -> String {
    format!("cycle_{cycle}_ms")
}

impl Message {
    fn write(&self, length: u8, out: &mut Formatter<'_>) -> fmt::Result {
        let sender = self.sender.as_ref().map_or(String::new(), |sender| format!("  # sent by {sender}"));
        writeln!(out, "  {}:{sender}", quoted(&self.name))?;
        for (key, text) in [("title", &self.title), ("note", &self.note)] {
            if !text.is_empty() {
                writeln!(out, "    {key}: {}", quoted(text))?;
            }
        }
        writeln!(out, "    match: {{id: 0x{:X}}}\n    access: [report]", self.id)?;
        if self.length != length {
            writeln!(out, "    length: {}", self.length)?;
        }
        if let Some(cycle) = self.cycle {
            writeln!(out, "    every: {}", cycle_name(cycle))?;
        }
        self.write_fields(out)
    }

    fn write_fields(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let places: Vec<_> = self.fields.iter().map(|field| (field.place, field.is_constant)).collect();
        let mut names = Names::default();
        for field in &self.fields {
            names.take(&field.name, str::to_owned);
        }
        if !places.is_empty() {
            writeln!(out, "    fields:")?;
        }
        for group in groups(&places) {
            let mut fields = group.of.iter().map(|index| &self.fields[*index]);
            if group.is_word {
                let name = names.take(&group.place.word_name(), str::to_owned);
                writeln!(out, "      {name}:\n        bytes: {}\n        fields:", group.place.bytes())?;
                fields.try_for_each(|field| field.write("          ", "bits", &field.place.bits(group.place), out))?;
            } else {
                fields.try_for_each(|field| field.write("      ", "bytes", &field.place.bytes(), out))?;
            }
        }
        Ok(())
    }
}

impl Field {
    fn key(&self, name: &str) -> Option<&str> {
        self.keys.iter().find(|(key, _)| *key == name).map(|(_, value)| value.as_str())
    }

    /// Tests for a scale or an offset without a word on the unit.
    fn is_without_unit(&self) -> bool {
        let is_scaled = self.key("scale").is_some_and(|scale| scale != "1") || self.key("offset").is_some();
        is_scaled && self.key("unit").or(self.key("title")).is_none()
    }

    /// Tests for a range that does no more than give notes. Beside special values it tells them apart.
    fn is_limited(&self) -> bool {
        self.key("range").is_some() && self.key("values").is_none()
    }

    fn write(&self, indent: &str, key: &str, place: &str, out: &mut Formatter<'_>) -> fmt::Result {
        let keys = self.keys.iter().map(|(key, value)| (*key, value.as_str()));
        let decide = match self.decide.as_slice() {
            [] => String::new(),
            questions => format!("  # DECIDE: {}", questions.join("; ")),
        };
        writeln!(out, "{indent}{}: {}{decide}", quoted(&self.name), map([(key, place)].into_iter().chain(keys)))
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn a_text_has_quotes_where_it_needs_them() {
        for plain in ["Flow in l/min", "0x10", "a.dbc", "7"] {
            assert_eq!(quoted(plain), plain);
        }
        for text in ["No", "", "a: b", "%", "a ", "section -", "a -b"] {
            assert_eq!(quoted(text), format!("\"{text}\""));
        }
        assert_eq!(quoted("a\"\\"), "\"a\\\"\\\\\"");
    }
}
