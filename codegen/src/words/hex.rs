//! Bytes as documents print them: two hexadecimal digits each.

/// Writes bytes.
pub fn digits(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |text, byte| format!("{text}{byte:02X}"))
}

/// Reads bytes, or returns `None` for any other text.
pub fn bytes(text: &str) -> Option<Vec<u8>> {
    let even = text.len().is_multiple_of(2) && text.bytes().all(|digit| digit.is_ascii_hexdigit());
    let pairs = (0..text.len()).step_by(2).map(|at| u8::from_str_radix(text.get(at..at + 2)?, 16).ok());
    even.then(|| pairs.collect()).flatten()
}
