//! Blank lines between items, which the formatter leaves out.

/// Separates items of a file, and functions from what stands before them in an `impl`.
pub fn spaced(text: &str) -> String {
    let lines: Vec<_> = text.lines().collect();
    let mut spaced = String::with_capacity(text.len() + text.len() / 16);
    for (index, line) in lines.iter().enumerate() {
        if index > 0 && begins_group(&lines, index) {
            spaced.push('\n');
        }
        spaced.push_str(line);
        spaced.push('\n');
    }
    spaced
}

/// Tests whether an item begins that is set off from the one before.
fn begins_group(lines: &[&str], index: usize) -> bool {
    let (before, line) = (lines[index - 1], lines[index]);
    let is_code = !before.trim_start().starts_with("//");
    let ends = is_code && before.ends_with([';', '}']) && !line.trim_start().starts_with('}');
    match indent(line) {
        0 => ends && (import(before).is_none() || import(before) != import(line)),
        4 => ends && (is_function(&lines[index..]) || before == "    }"),
        _ => false,
    }
}

/// Returns whether a line imports all that a module has, if it is an import.
fn import(line: &str) -> Option<bool> {
    let is_import = ["use ", "pub use "].iter().any(|start| line.starts_with(start));
    is_import.then(|| line.ends_with("*;"))
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// Tests whether the item behind comments and attributes is a function.
fn is_function(lines: &[&str]) -> bool {
    let item =
        lines.iter().map(|line| line.trim_start()).find(|line| !line.starts_with("///") && !line.starts_with("#["));
    item.is_some_and(|item| {
        ["fn ", "pub fn ", "const fn ", "pub const fn "].iter().any(|start| item.starts_with(start))
    })
}

#[cfg(test)]
mod tests {
    use super::spaced;

    #[test]
    fn items_and_functions_are_set_off_but_constants_and_fields_are_not() {
        let dense = "pub use a::prelude::*;\nuse a::*;\nuse a::b;\nuse a::c;\n\
            /// Ends with a brace }\npub struct A {\n    pub one: u8,\n    /// Two;\n    pub two: u8,\n}\nimpl A {\n    \
            const ONE: u8 = 1;\n    const TWO: u8 = B\n        .two();\n    /// Three.\n    #[must_use]\n    pub fn three() {\n        \
            four();\n    }\n    fn five() {}\n}\n";
        let open = "pub use a::prelude::*;\nuse a::*;\n\nuse a::b;\nuse a::c;\n\n\
            /// Ends with a brace }\npub struct A {\n    pub one: u8,\n    /// Two;\n    pub two: u8,\n}\n\nimpl A {\n    \
            const ONE: u8 = 1;\n    const TWO: u8 = B\n        .two();\n\n    /// Three.\n    #[must_use]\n    pub fn three() {\n        \
            four();\n    }\n\n    fn five() {}\n}\n";
        assert_eq!(spaced(dense), open);
    }
}
