//! Names of the spec language.

use std::collections::BTreeSet;

use canspec_codegen::emit::is_word_of_rust;

/// Converts `BatteryVoltage` and `VDM_Status` to `battery_voltage` and `vdm_status`. `prefix` goes
/// before a leading digit, or is the name if no letter is left.
pub fn snake_case(text: &str, prefix: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut name = String::new();
    for (index, letter) in letters.iter().enumerate() {
        let before = index.checked_sub(1).map_or(' ', |before| letters[before]);
        let starts_word = letter.is_ascii_uppercase()
            && (before.is_ascii_lowercase()
                || before.is_ascii_uppercase() && letters.get(index + 1).is_some_and(char::is_ascii_lowercase));
        if (starts_word || !letter.is_ascii_alphanumeric()) && !name.is_empty() && !name.ends_with('_') {
            name.push('_');
        }
        if letter.is_ascii_alphanumeric() {
            name.push(letter.to_ascii_lowercase());
        }
    }
    match name.trim_end_matches('_') {
        "" => prefix.to_owned(),
        name if name.starts_with(|first: char| first.is_ascii_digit()) => format!("{prefix}_{name}"),
        name => name.to_owned(),
    }
}

/// Names that are in use.
#[derive(Clone, Default)]
pub struct Names(BTreeSet<String>);

impl Names {
    /// Takes a name, with a number if it needs one. `rust` must turn it into a free and valid name
    /// in Rust.
    pub fn take(&mut self, wanted: &str, rust: impl Fn(&str) -> String) -> String {
        let numbered = (2..).map(|number| format!("{wanted}_{number}"));
        let mut names = std::iter::once(wanted.to_owned()).chain(numbered);
        let free = names.find(|name| !is_word_of_rust(&rust(name)) && self.0.insert(rust(name)));
        free.unwrap_or_default()
    }

    pub fn is_free(&self, rust: &str) -> bool {
        !self.0.contains(rust)
    }
}

/// Returns the name of a type in Rust, which is the same for `a_1` and `a1`.
pub fn type_name(name: &str) -> String {
    name.replace('_', "").to_ascii_uppercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_has_lower_case_words() {
        let names = [
            ("BatteryVoltage", "battery_voltage"),
            ("VDM_Status", "vdm_status"),
            ("ABSInfo2", "abs_info2"),
            ("Not Available", "not_available"),
            ("_x__Y-", "x_y"),
            ("12V", "value_12v"),
            ("\u{e4}", "value"),
            ("", "value"),
        ];
        for (text, expected) in names {
            assert_eq!(snake_case(text, "value"), expected);
        }
    }

    #[test]
    fn a_name_is_free_in_rust_too() {
        let mut names = Names::default();
        let taken = ["a_1", "a1", "a1", "type"].map(|name| names.take(name, type_name));
        assert_eq!(taken, ["a_1", "a1_2", "a1_3", "type"]);
        assert_eq!(names.take("type", str::to_owned), "type_2");
    }
}
