use super::Text;

impl Text {
    /// Writes the text in quotes.
    pub(crate) fn in_lua(&self) -> String {
        quoted(&self.0)
    }
}

/// Writes any text in quotes, so that Lua reads the same text.
pub(crate) fn quoted(text: &str) -> String {
    let escaped = text.chars().map(|letter| match letter {
        '"' | '\\' => format!("\\{letter}"),
        letter if letter.is_ascii_control() => format!("\\{:03}", u32::from(letter)),
        letter => letter.to_string(),
    });
    format!("\"{}\"", escaped.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn a_text_is_quoted_so_that_lua_reads_the_same() {
        assert_eq!(quoted("a \"b\" \\ °C\n1"), r#""a \"b\" \\ °C\0101""#);
    }
}
