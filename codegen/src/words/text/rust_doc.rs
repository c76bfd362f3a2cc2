use super::Text;

impl Text {
    /// Writes the text for a paragraph of Rust documentation. Markdown shows it unchanged.
    ///
    /// Text between two backquotes stays code, and names that look like code become code.
    pub(crate) fn in_rust_doc(&self) -> String {
        self.shown(unmarked)
    }

    /// Writes the text as [`in_rust_doc`](Self::in_rust_doc) does, but for the midst of a paragraph.
    pub(crate) fn within_rust_doc(&self) -> String {
        self.shown(plain)
    }

    /// Writes the text for a cell of a table, which a bar would end even in code.
    pub(crate) fn in_rust_table(&self) -> String {
        if !self.0.contains('|') {
            return self.within_rust_doc();
        }
        let words = self.0.split_whitespace().map(|word| escaped(&word.replace('`', "'")));
        words.collect::<Vec<_>>().join(" ")
    }

    /// Writes the text word by word; `first` writes the first one.
    fn shown(&self, first: fn(&str) -> String) -> String {
        let ticks = self.0.matches('`').count();
        let is_paired = ticks.is_multiple_of(2) && !self.0.contains("``");
        let text = if is_paired { self.0.clone() } else { self.0.replace('`', "'") };
        let mut in_code = false;
        let words = text.split_whitespace().enumerate().map(|(index, word)| {
            if !in_code && !word.contains('`') {
                return if index == 0 { first(word) } else { plain(word) };
            }
            let parts = word.split('`').enumerate().map(|(index, part)| {
                in_code ^= index > 0;
                if in_code { part.to_owned() } else { escaped(part) }
            });
            parts.collect::<Vec<_>>().join("`")
        });
        words.collect::<Vec<_>>().join(" ")
    }
}

/// Writes any text as code, unless it holds a backquote.
pub(crate) fn code(text: &str) -> String {
    let text = Text::new(text);
    if text.0.contains('`') { text.in_rust_doc() } else { format!("`{}`", text.0) }
}

/// Writes the first word, so that it begins no list and is no rule across the page.
fn unmarked(word: &str) -> String {
    let number = word.trim_end_matches(['.', ')']);
    if word.starts_with(['-', '+', '=']) {
        return format!("\\{}", escaped(word));
    }
    if number.len() < word.len() && number.bytes().all(|byte| byte.is_ascii_digit()) {
        return format!("{number}\\{}", &word[number.len()..]);
    }
    plain(word)
}

/// Writes a word. If its name looks like code, the punctuation around the name stays outside the
/// code.
fn plain(word: &str) -> String {
    let name = word.trim_matches(|letter: char| !letter.is_alphanumeric());
    match word.split_once(name).filter(|_| looks_like_code(name)) {
        Some((before, after)) => format!("{}`{name}`{}", escaped(before), escaped(after)),
        None => escaped(word),
    }
}

/// Tests for `snake_case`, `CamelCase`, paths, and addresses of pages. Such an address must not
/// become a link.
fn looks_like_code(word: &str) -> bool {
    let bytes = word.as_bytes();
    let camel = bytes.windows(2).any(|pair| pair[0].is_ascii_lowercase() && pair[1].is_ascii_uppercase());
    camel || word.contains('_') || word.contains("::") || word.contains("://")
}

fn escaped(text: &str) -> String {
    let special = |letter: char| matches!(letter, '[' | ']' | '<' | '>' | '*' | '_' | '\\' | '#' | '|' | '~' | '&');
    let text = text.chars().fold(String::new(), |mut shown, letter| {
        if special(letter) {
            shown.push('\\');
        }
        shown.push(letter);
        shown
    });
    text.replace("://", "\\://")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str) -> String {
        Text::new(text).in_rust_doc()
    }

    #[test]
    fn names_become_code_and_markdown_is_shown_as_it_is() {
        assert_eq!(shown("see set_group, or [1] in CamelCase"), "see `set_group`, or \\[1\\] in `CamelCase`");
        assert_eq!(shown("wait after `set group now` once"), "wait after `set group now` once");
        assert_eq!(shown("a stray ` of set_group"), "a stray ' of `set_group`");
    }

    #[test]
    fn what_stands_around_code_is_none() {
        assert_eq!(shown("[set_group] <b>`x`</b> [`y`]"), "\\[`set_group`\\] \\<b\\>`x`\\</b\\> \\[`y`\\]");
    }

    #[test]
    fn no_text_begins_a_block() {
        assert_eq!(shown("```rust\npanic!()\n```"), "'''rust panic!() '''");
        assert_eq!(shown("~~~ ~~x~~"), "\\~\\~\\~ \\~\\~x\\~\\~");
        assert_eq!(shown("    let x = 1;"), "let x = 1;");
        assert_eq!(shown("- a"), "\\- a");
        assert_eq!(shown("12. a"), "12\\. a");
        assert_eq!(shown("a|b"), "a\\|b");
    }

    #[test]
    fn code_is_code_without_backquotes() {
        assert_eq!(code("{a:2}-{b}"), "`{a:2}-{b}`");
        assert_eq!(code("`{a}\n[x]"), "'{a} \\[x\\]");
    }
}
