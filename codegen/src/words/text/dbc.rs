use super::Text;

impl Text {
    /// Writes the text for a DBC in ASCII. Tools do not agree on any other encoding.
    pub(crate) fn in_dbc(&self) -> String {
        let plain = self.0.chars().map(|letter| match letter {
            '"' => "'".to_owned(),
            '\\' => "/".to_owned(),
            '°' => "deg".to_owned(),
            '–' | '—' => "-".to_owned(),
            '×' => "x".to_owned(),
            'µ' | 'μ' => "u".to_owned(),
            'Ω' => "ohm".to_owned(),
            letter if letter.is_ascii() => letter.into(),
            _ => String::new(),
        });
        plain.collect::<String>().trim().to_owned()
    }
}
