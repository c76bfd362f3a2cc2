//! Hostile texts: small ones for what is said, and one of each at full size to see that it ends.

use canspec_codegen::source::SIZE_LIMIT;

use super::{errors, lines, refusal, spec};

#[test]
fn deep_nesting_is_refused() {
    let message = "error[yaml]: maps and lists are nested deeper than 64 levels";
    assert_eq!(errors(&format!("a:\n{}", " [\n".repeat(70))), [format!("mini.yaml:65:2: {message}")]);
    assert_eq!(errors(&format!("a:\n{}", "- ".repeat(100))), [format!("mini.yaml:2:127: {message}")]);
    for opening in ["[", "{a: ", "[\n ", "{a:\n ", "- ", "? "] {
        let found = errors(&format!("a:\n {}", opening.repeat(100_000)));
        assert!(found.last().is_some_and(|last| last.ends_with(message)), "{opening:?}: {:?}", found.last());
    }
}

#[test]
fn nesting_up_to_the_limit_is_read() {
    let means = format!("{}x{}", "{a: ".repeat(57), "}".repeat(57));
    spec(&format!("messages: {{one: {{access: [], examples: [{{means: {means}}}]}}}}\n"));
}

#[test]
fn many_values_are_refused() {
    let keys = lines(150_000, |number| format!("k{number}: 1\n"));
    assert_eq!(errors(&keys), ["mini.yaml:100001:1: error[yaml]: more than 200000 values in one file"]);
}

#[test]
fn many_errors_end_the_reading() {
    let found = errors(&format!("a: [{}]", "on,".repeat(100_000)));
    assert_eq!(found.len(), 1001);
    assert_eq!(found[1000], "mini.yaml:1:3002: error[yaml]: more than 1000 errors, the rest of the file is not read");
}

#[test]
fn a_bomb_of_aliases_is_refused_without_being_spread_out() {
    let doubled = lines(19, |level| format!("a{0}: &a{0} [*a{level}, *a{level}]\n", level + 1));
    let found = errors(&format!("a0: &a0 [x, x]\n{doubled}"));
    assert_eq!(found.iter().filter(|line| line.ends_with("an alias may not stand in a spec")).count(), 38);
}

#[test]
fn long_lines_are_read() {
    let long = "é ".repeat(SIZE_LIMIT / 4);
    assert_eq!(
        refusal(format!("a: {}", long.repeat(5)).as_bytes()),
        "mini.yaml: error[file]: the file is larger than 4 MiB"
    );
    let spec = spec(&format!("bit_rates: [{long}]"));
    assert_eq!(spec.bit_rates[0].len(), long.len() - 1);
}
