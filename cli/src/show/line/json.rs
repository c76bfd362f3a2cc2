//! The parts of JSON, written one by one into memory.

/// Writes members in their order. If some have the same name, the first one counts. A field that messages have in
/// different places is such a case.
pub fn object<'a, V>(
    out: &mut Vec<u8>,
    entries: &(impl Iterator<Item = (&'a str, V)> + Clone),
    mut write: impl FnMut(&mut Vec<u8>, V),
) {
    let start = out.len();
    for (index, (key, value)) in entries.clone().enumerate() {
        if entries.clone().take(index).all(|(other, _)| other != key) {
            member(out, key);
            write(out, value);
        }
    }
    enclose(out, start, *b"{}");
}

/// Writes members with names of their own.
pub fn members<'a, V>(
    out: &mut Vec<u8>,
    members: impl Iterator<Item = (&'a str, V)>,
    mut write: impl FnMut(&mut Vec<u8>, V),
) {
    let start = out.len();
    for (key, value) in members {
        member(out, key);
        write(out, value);
    }
    enclose(out, start, *b"{}");
}

/// Begins a member of an object that `enclose` puts into brackets.
fn member(out: &mut Vec<u8>, key: &str) {
    out.extend_from_slice(b",\"");
    out.extend_from_slice(key.as_bytes());
    out.extend_from_slice(b"\":");
}

/// Writes items in brackets.
pub fn list<V>(out: &mut Vec<u8>, items: impl IntoIterator<Item = V>, mut write: impl FnMut(&mut Vec<u8>, V)) {
    let start = out.len();
    for item in items {
        out.push(b',');
        write(out, item);
    }
    enclose(out, start, *b"[]");
}

/// Puts what was written since `start` into brackets. Each item has a comma before it.
fn enclose(out: &mut Vec<u8>, start: usize, [open, close]: [u8; 2]) {
    match out.get_mut(start) {
        Some(comma) => *comma = open,
        None => out.push(open),
    }
    out.push(close);
}

/// Writes a value, or `null`.
pub fn optional(out: &mut Vec<u8>, value: Option<&str>, write: impl FnOnce(&mut Vec<u8>, &str)) {
    match value {
        Some(value) => write(out, value),
        None => out.extend_from_slice(b"null"),
    }
}

/// Writes any text.
pub fn text(out: &mut Vec<u8>, value: &str) {
    if value.bytes().any(|byte| matches!(byte, 0..b' ' | b'"' | b'\\' | 0x7F)) {
        // JSON may hold DEL as it is, and a terminal acts on it.
        let text = serde_json::Value::from(value).to_string().replace('\u{7F}', "\\u007f");
        out.extend_from_slice(text.as_bytes());
    } else {
        name(out, value);
    }
}

/// Writes a name of a spec or of ours, which has nothing to escape by the rules of names.
pub fn name(out: &mut Vec<u8>, name: &str) {
    out.push(b'"');
    out.extend_from_slice(name.as_bytes());
    out.push(b'"');
}

/// Writes a number that is not below 0. Most have few digits.
pub fn natural(out: &mut Vec<u8>, value: impl Into<u64>) {
    let value = value.into();
    let Ok(byte) = u8::try_from(value) else {
        return out.extend_from_slice(itoa::Buffer::new().format(value).as_bytes());
    };
    if byte >= 100 {
        out.push(b'0' + byte / 100);
    }
    if byte >= 10 {
        out.push(b'0' + byte / 10 % 10);
    }
    out.push(b'0' + byte % 10);
}

/// Writes an integer, which nearly always fits into 64 bits.
pub fn integer(out: &mut Vec<u8>, value: impl Into<i128>) {
    let value = value.into();
    match u64::try_from(value) {
        Ok(value) => natural(out, value),
        Err(_) => out.extend_from_slice(itoa::Buffer::new().format(value).as_bytes()),
    }
}

/// Writes a number. JSON has none that is not finite.
pub fn number(out: &mut Vec<u8>, value: f64) {
    if value.is_finite() {
        out.extend_from_slice(zmij::Buffer::new().format_finite(value).as_bytes());
    } else {
        out.extend_from_slice(b"null");
    }
}
