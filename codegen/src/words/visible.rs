//! Which characters may stand in specs, and in the names of files and channels.

/// Names the kind of a character that specs, file names and channel names must not hold.
pub fn forbidden(character: char) -> Option<&'static str> {
    match character {
        ' '..='~' | '\t' | '\n' => None,
        '\r' => Some("carriage return that ends no line"),
        BYTE_ORDER_MARK => Some("byte order mark"),
        '\u{85}' | '\u{2028}' | '\u{2029}' => Some("line separator that not every reader takes for one"),
        '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => Some("mark that reverses the direction of text"),
        '\u{AD}'
        | '\u{61C}'
        | '\u{180E}'
        | '\u{200B}'..='\u{200F}'
        | '\u{2060}'..='\u{206F}'
        | '\u{FFF9}'..='\u{FFFB}'
        | '\u{E0000}'..='\u{E007F}' => Some("character that nobody sees"),
        '\u{FFFE}' | '\u{FFFF}' => Some("code point that is no character"),
        _ if character.is_control() => Some("control character"),
        _ => None,
    }
}

/// Replaces characters that begin a line or act on a terminal.
pub(crate) fn visible(text: &str) -> String {
    text.replace(|character: char| character.is_control() || forbidden(character).is_some(), "\u{FFFD}")
}

pub(crate) const BYTE_ORDER_MARK: char = '\u{FEFF}';
