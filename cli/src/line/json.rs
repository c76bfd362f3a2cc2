//! The parts of JSON, written one by one.

use std::io::{self, Write};

/// Writes members in their order. If some have the same name, the first one counts. A field that messages have in
/// different places is such a case.
pub fn object<'a, W: Write, V>(
    out: &mut W,
    entries: impl Iterator<Item = (&'a str, V)> + Clone,
    write: impl FnMut(&mut W, V) -> io::Result<()>,
) -> io::Result<()> {
    let all = entries.clone();
    let is_first = |index: usize, name: &str| all.clone().take(index).all(|(other, _)| other != name);
    let firsts = entries.enumerate().filter(|(index, (name, _))| is_first(*index, name));
    members(out, firsts.map(|(_, entry)| entry), write)
}

/// Writes members with names of their own.
pub fn members<'a, W: Write, V>(
    out: &mut W,
    members: impl Iterator<Item = (&'a str, V)>,
    mut write: impl FnMut(&mut W, V) -> io::Result<()>,
) -> io::Result<()> {
    let mut separator = "{\"";
    for (key, value) in members {
        out.write_all(separator.as_bytes())?;
        out.write_all(key.as_bytes())?;
        out.write_all(b"\":")?;
        write(out, value)?;
        separator = ",\"";
    }
    out.write_all(if separator == "{\"" { b"{}" } else { b"}" })
}

/// Writes items in brackets.
pub fn list<W: Write, V>(
    out: &mut W,
    items: impl IntoIterator<Item = V>,
    mut write: impl FnMut(&mut W, V) -> io::Result<()>,
) -> io::Result<()> {
    let mut separator = "[";
    for item in items {
        out.write_all(separator.as_bytes())?;
        write(out, item)?;
        separator = ",";
    }
    out.write_all(if separator == "[" { b"[]" } else { b"]" })
}

/// Writes a value, or `null`.
pub fn optional<W: Write>(
    out: &mut W,
    value: Option<&str>,
    write: impl FnOnce(&mut W, &str) -> io::Result<()>,
) -> io::Result<()> {
    if let Some(value) = value { write(out, value) } else { out.write_all(b"null") }
}

/// Writes any text.
pub fn text(out: &mut impl Write, value: &str) -> io::Result<()> {
    if value.bytes().any(|byte| matches!(byte, 0..b' ' | b'"' | b'\\' | 0x7F)) {
        // JSON may hold DEL as it is, and a terminal acts on it.
        let text = serde_json::to_string(value)?.replace('\u{7F}', "\\u007f");
        return out.write_all(text.as_bytes());
    }
    name(out, value)
}

/// Writes a name of a spec or of ours, which has nothing to escape by the rules of names.
pub fn name(out: &mut impl Write, name: &str) -> io::Result<()> {
    out.write_all(b"\"")?;
    out.write_all(name.as_bytes())?;
    out.write_all(b"\"")
}

/// Writes an integer.
pub fn integer(out: &mut impl Write, value: impl itoa::Integer) -> io::Result<()> {
    out.write_all(itoa::Buffer::new().format(value).as_bytes())
}

/// Writes an integer that nearly always fits into 64 bits, whose digits come faster.
pub fn long_integer(out: &mut impl Write, value: i128) -> io::Result<()> {
    if let Ok(value) = i64::try_from(value) { integer(out, value) } else { integer(out, value) }
}
