//! Writes Lua tables in the layout that people use.

use crate::model::Id;
use crate::words::text::{Text, quoted_in_lua};

/// Columns of a line.
const WIDTH: usize = 120;

/// A Lua value.
pub enum Value {
    /// A value that is written unchanged: a number, a text in quotes, `true` or a call.
    Plain(String),
    /// A table counted from 1.
    List(Vec<Value>),
    /// A table with names or keys, in the form that stands before the `=`.
    Record(Vec<(String, Value)>),
}

impl Value {
    /// Returns an empty record.
    pub fn record() -> Self {
        Self::Record(Vec::new())
    }

    /// Adds a member to a record.
    pub fn with(self, name: &'static str, value: Self) -> Self {
        self.maybe(name, Some(value))
    }

    /// Adds a member to a record, if there is one.
    pub fn maybe(self, name: &'static str, value: Option<Self>) -> Self {
        let Self::Record(mut members) = self else { return self };
        members.extend(value.map(|value| (name.to_owned(), value)));
        Self::Record(members)
    }

    /// Returns a record with keys that are values.
    pub fn map(entries: impl Iterator<Item = (Self, Self)>) -> Self {
        Self::Record(entries.map(|(key, value)| (format!("[{}]", inline(&key)), value)).collect())
    }

    /// Returns a list with a value for each item.
    pub fn list<T>(items: impl IntoIterator<Item = T>, value: impl Fn(T) -> Self) -> Self {
        Self::List(items.into_iter().map(value).collect())
    }

    /// Writes a name or a number in quotes.
    pub fn text(text: &str) -> Self {
        Self::Plain(quoted_in_lua(text))
    }

    /// Writes a text of the spec in quotes.
    pub fn words(text: &Text) -> Self {
        Self::Plain(text.in_lua())
    }

    /// Writes a whole number.
    pub fn number(number: impl Into<i128>) -> Self {
        Self::Plain(number.into().to_string())
    }

    /// Writes a double with the fewest digits that identify it.
    pub fn double(number: f64) -> Self {
        Self::Plain(number.to_string())
    }

    /// Writes a number of up to 32 bits in hexadecimal.
    pub fn hexadecimal(number: impl Into<u64>) -> Self {
        Self::Plain(format!("0x{:02X}", number.into()))
    }

    /// Writes a number of 64 bits. Lua has no such numbers before 5.3.
    pub fn unsigned_of_64_bits(number: u64) -> Self {
        Self::Plain(format!("UInt64(0x{:08X}, 0x{:08X})", number & u64::from(u32::MAX), number >> 32))
    }

    /// Writes a signed number of 64 bits.
    pub fn signed_of_64_bits(number: i64) -> Self {
        let bits = number.cast_unsigned();
        Self::Plain(format!("Int64(0x{:08X}, 0x{:08X})", bits & u64::from(u32::MAX), bits >> 32))
    }

    /// Writes the place of a row in its table. Lua counts from 1.
    pub fn id(id: impl Id) -> Self {
        Self::Plain((id.place() + 1).to_string())
    }

    /// Writes `true` or `false`.
    pub fn flag(flag: bool) -> Self {
        Self::Plain(flag.to_string())
    }

    fn entries(&self) -> Vec<(String, &Self)> {
        match self {
            Self::Plain(_) => Vec::new(),
            Self::List(items) => items.iter().map(|item| (String::new(), item)).collect(),
            Self::Record(members) => members.iter().map(|(name, value)| (format!("{name} = "), value)).collect(),
        }
    }
}

/// Lays out a value on as many lines as it takes.
pub fn whole(value: &Value) -> String {
    lines(value, 0, "local protocol = ".len())
}

fn lines(value: &Value, indent: usize, before: usize) -> String {
    let line = inline(value);
    // A comma may follow.
    if indent + before + line.chars().count() < WIDTH || matches!(value, Value::Plain(_)) {
        return line;
    }
    let inner = indent + 2;
    let entries = value.entries().into_iter().map(|(name, value)| {
        let before = name.chars().count();
        format!("{:inner$}{name}{},\n", "", lines(value, inner, before))
    });
    format!("{{\n{}{:indent$}}}", entries.collect::<String>(), "")
}

fn inline(value: &Value) -> String {
    if let Value::Plain(text) = value {
        return text.clone();
    }
    let entries: Vec<_> = value.entries().into_iter().map(|(name, value)| format!("{name}{}", inline(value))).collect();
    if entries.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", entries.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_stands_on_one_line_until_it_is_too_long() {
        let short = Value::record().with("name", Value::text("a")).with("places", Value::list([1, 2], Value::number));
        assert_eq!(whole(&short), r#"{ name = "a", places = { 1, 2 } }"#);
        let long = Value::record().with("short", short).with("long", Value::text(&"x".repeat(WIDTH)));
        let expected = "{\n  short = { name = \"a\", places = { 1, 2 } },\n  long = \"xxx";
        assert!(whole(&long).starts_with(expected), "{}", whole(&long));
    }

    #[test]
    fn numbers_of_64_bits_are_written_by_halves_the_low_one_first() {
        assert_eq!(inline(&Value::unsigned_of_64_bits(0x0123_4567_89AB_CDEF)), "UInt64(0x89ABCDEF, 0x01234567)");
        assert_eq!(inline(&Value::signed_of_64_bits(-2)), "Int64(0xFFFFFFFE, 0xFFFFFFFF)");
    }
}
