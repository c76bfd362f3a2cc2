//! Arms of a `match` on one line each, where the formatter breaks them early.

/// The longest line.
const WIDTH: usize = 120;

/// Joins the lines of each arm whose body is one call and fits on one line.
pub fn joined(text: &str) -> String {
    let lines: Vec<_> = text.lines().collect();
    let mut joined = String::with_capacity(text.len());
    let mut index = 0;
    while let Some(line) = lines.get(index) {
        let (text, count) = arm(&lines[index..]).unwrap_or_else(|| ((*line).to_owned(), 1));
        joined.push_str(&text);
        joined.push('\n');
        index += count;
    }
    joined
}

/// Returns the arm that begins here as one line, and how many lines it had.
fn arm(lines: &[&str]) -> Option<(String, usize)> {
    let pattern = lines.first()?.strip_suffix("=> {")?;
    let indent = pattern.len() - pattern.trim_start().len();
    let last = lines.iter().skip(1).position(|line| line.len() - line.trim_start().len() == indent)? + 1;
    let (body, end) = (lines.get(1..last)?, lines.get(last)?);
    let is_call = end.trim() == "}" && !body.iter().any(|line| line.contains(['{', ';']) || line.contains("//"));
    let arm = format!("{pattern}=> {},", body.iter().fold(String::new(), |call, line| appended(call, line.trim())));
    (is_call && arm.len() <= WIDTH).then_some((arm, last + 1))
}

/// Appends a line as it stands behind the others without a break.
fn appended(mut call: String, line: &str) -> String {
    if line.starts_with(')') && call.ends_with(',') {
        call.pop();
    } else if !call.is_empty() && !call.ends_with('(') && !line.starts_with(['.', ')']) {
        call.push(' ');
    }
    call + line
}

#[cfg(test)]
mod tests {
    use super::joined;

    #[test]
    fn a_call_stands_on_the_line_of_its_arm() {
        let broken = "    0x01 => {\n        call(\n            &A,\n            B(data),\n        )\n        .or(C)\n    }\n    _ => D,\n";
        assert_eq!(joined(broken), "    0x01 => call(&A, B(data)).or(C),\n    _ => D,\n");
    }

    #[test]
    fn blocks_and_what_does_not_fit_stay_as_they_are() {
        let long = format!("0x01 => {{\n    {}()\n}}\n", "a".repeat(120));
        for text in ["0x01 => {\n    one();\n    two()\n}\n", "0x01 => {\n    if a {\n    }\n}\n", &long] {
            assert_eq!(joined(text), text);
        }
    }
}
