//! Calls, lists and constants on one line each, where the formatter breaks them early.

/// The longest line.
const WIDTH: usize = 120;

/// Joins the lines of what fits on one: an arm or a closure that is one call, a constant, a list in brackets.
pub fn joined(text: &str) -> String {
    let lines: Vec<_> = text.lines().collect();
    let mut joined = String::with_capacity(text.len());
    let mut index = 0;
    while let Some(line) = lines.get(index) {
        let (text, count) = one_line(&lines[index..]).unwrap_or_else(|| ((*line).to_owned(), 1));
        joined.push_str(&text);
        joined.push('\n');
        index += count;
    }
    joined
}

/// Returns what begins here as one line, and how many lines it had.
fn one_line(lines: &[&str]) -> Option<(String, usize)> {
    let known = [constant(lines), block(lines), list(lines)].into_iter().flatten();
    let is_code = |count: &usize| !lines[..*count].iter().any(|line| line.contains("//"));
    known.into_iter().find(|(text, count)| text.len() <= WIDTH && is_code(count))
}

/// Joins a constant.
fn constant(lines: &[&str]) -> Option<(String, usize)> {
    let is_constant = ["const ", "pub const "].iter().any(|start| lines[0].trim_start().starts_with(start));
    let last = lines.iter().position(|line| line.ends_with([';', '{', '}']))?;
    (is_constant && last > 0 && lines[last].ends_with(';')).then(|| (call(&lines[..=last]), last + 1))
}

/// Joins an arm or a closure whose block is one call.
fn block(lines: &[&str]) -> Option<(String, usize)> {
    let head = lines[0].strip_suffix(" {").filter(|head| head.ends_with(['>', '|']))?;
    let (body, end) = enclosed(lines, '}')?;
    let is_call = head.ends_with("=>") || head.ends_with('|');
    let after = if head.ends_with('>') { "," } else { end.trim_start().strip_prefix('}')? };
    (is_call && !body.iter().any(|line| line.ends_with([';', '{']))).then(|| {
        let text = format!("{head} {}{after}", call(body).trim_start());
        (text, body.len() + 2)
    })
}

/// Joins what stands in brackets, or the members of a value.
fn list(lines: &[&str]) -> Option<(String, usize)> {
    let end = match lines[0].trim_start() {
        line if line.ends_with('(') => ')',
        line if line.ends_with('[') => ']',
        line if line.ends_with("Self {") && !line.ends_with("-> Self {") => '}',
        _ => return None,
    };
    let (body, _) = enclosed(lines, end)?;
    let count = body.len() + 2;
    (!body.iter().any(|line| line.ends_with([';', '{']))).then(|| (call(&lines[..count]), count))
}

/// Returns the indented lines that follow the first one, and the one behind them, which has to begin with `end`.
fn enclosed<'a>(lines: &'a [&'a str], end: char) -> Option<(&'a [&'a str], &'a str)> {
    let indent = |line: &str| line.len() - line.trim_start().len();
    let inner = indent(lines.get(1)?);
    let last = lines.iter().skip(1).position(|line| indent(line) < inner)? + 1;
    lines[last].trim_start().starts_with(end).then(|| (&lines[1..last], lines[last]))
}

/// Writes lines as they stand without a break.
fn call(lines: &[&str]) -> String {
    let (first, others) = lines.split_first().unwrap_or((&"", &[]));
    others.iter().fold((*first).to_owned(), |call, line| appended(call, line.trim()))
}

/// Appends a line as it stands behind the others without a break.
fn appended(mut call: String, line: &str) -> String {
    if line.starts_with([')', ']', '}']) && call.ends_with(',') {
        call.pop();
    }
    if !call.ends_with(['(', '[']) && !line.starts_with(['.', ')', ']']) {
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
    fn a_constant_a_list_and_a_closure_stand_on_one_line() {
        let cases = [
            (
                "const A: B = C\n    .new(&[\n        1,\n        2,\n    ])\n    .of();\n",
                "const A: B = C.new(&[1, 2]).of();\n",
            ),
            ("pub fn a(\n    &self,\n    b: B,\n) -> C {\n    d()\n}\n", "pub fn a(&self, b: B) -> C {\n    d()\n}\n"),
            (
                "const A: B = C::new(\n        1,\n        2,\n    )\n    .of(\n        \"a \",\n        D,\n    );\n",
                "const A: B = C::new(1, 2).of(\"a \", D);\n",
            ),
            ("    Self {\n        a: 1,\n        b,\n    }\n", "    Self { a: 1, b }\n"),
            ("const A: B = |c, d| {\n    c.call(d)\n};\n", "const A: B = |c, d| c.call(d);\n"),
            ("const A: B = |c| Self {\n    d: c,\n};\n", "const A: B = |c| Self { d: c };\n"),
        ];
        for (broken, whole) in cases {
            assert_eq!(joined(broken), whole);
        }
    }

    #[test]
    fn blocks_comments_and_what_does_not_fit_stay_as_they_are() {
        let long = "a".repeat(120);
        for text in [
            "0x01 => {\n    one();\n    two()\n}\n",
            "0x01 => {\n    if a {\n    }\n}\n",
            "fn new() -> Self {\n    call()\n}\n",
            "/// Takes (\n/// both).\n",
            "call(\n    // why\n    a,\n)\n",
            "const fn new() -> A {\n    call();\n    other()\n}\n",
            "impl A {\n    const B: C = D;\n}\n",
            &format!("0x01 => {{\n    {long}()\n}}\n"),
            &format!("const A: B = {long}\n    .of();\n"),
        ] {
            assert_eq!(joined(text), text);
        }
    }
}
