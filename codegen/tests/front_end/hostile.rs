//! Hostile texts: small ones for what is said, and one of each at full size to see that it ends.

use canspec_codegen::compile;
use canspec_codegen::source::SIZE_LIMIT;

use super::{WHOLE, errors, lines, refusal, source, spec};

/// Returns what is said of types whose keys contradict each other, in a spec with a message of one field.
fn errors_in_types(types: &str, field: &str) -> Vec<String> {
    let message = format!("messages: {{one: {{access: [read], fields: {{first: {field}}}}}}}\n");
    let found = compile(source(&format!("{WHOLE}{message}types:\n{types}"))).diagnostics.concise();
    found.lines().filter(|line| line.contains("error[type]")).map(str::to_owned).collect()
}

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
    let keys = lines(310_000, |number| format!("k{number}: 1\n"));
    assert_eq!(errors(&keys), ["mini.yaml:300001:1: error[yaml]: more than 600000 values in one spec"]);
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

#[test]
fn a_type_with_a_field_of_its_own_type_is_refused() {
    let word = errors_in_types("  a: {bytes: 0..1, fields: {inner: {type: a}}}\n", "{type: a}");
    assert_eq!(word, ["mini.yaml:10:43: error[type]: `inner` has a type that brings `inner` with it"]);
    let ring = "  a: {bits: 7..0, fields: {b: {type: b}}}\n  b: {bits: 7..0, fields: {a: {type: a}}}\n";
    let through_another = errors_in_types(ring, "{bytes: 0, fields: {inner: {type: a}}}");
    assert_eq!(through_another, ["mini.yaml:11:38: error[type]: `a` has a type that brings `a` with it"]);
    let packed = errors_in_types("  a: {format: \"{inner}\", fields: {inner: {type: a}}}\n", "{type: a}");
    assert_eq!(packed, ["mini.yaml:10:49: error[type]: `inner` has a type that brings `inner` with it"]);
}

#[test]
fn types_that_double_their_fields_are_refused_without_being_spread_out() {
    let doubled =
        |level| format!("  t{level}: {{bits: 7..0, fields: {{a: {{type: t{0}}}, b: {{type: t{0}}}}}}}\n", level + 1);
    let types = lines(60, doubled) + "  t60: {bits: 7..0}\n";
    let found = errors_in_types(&types, "{bytes: 0, fields: {inner: {type: t0}}}");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].ends_with("error[type]: `one` comes to more than 256 fields"), "{}", found[0]);
}

#[test]
fn a_long_chain_of_types_is_refused() {
    let chain = |length| {
        lines(length, |level| format!("  t{level}: {{type: t{}}}\n", level + 1))
            + &format!("  t{length}: {{bytes: 0}}\n")
    };
    assert_eq!(errors_in_types(&chain(63), "{type: t0}"), [""; 0]);
    let message = "error[type]: more than 64 types take keys from one another, down to `t64`";
    for length in [64, 40_000] {
        assert_eq!(errors_in_types(&chain(length), "{type: t0}"), [format!("mini.yaml:73:15: {message}")]);
    }
}

#[test]
fn a_message_of_very_many_fields_is_refused() {
    let fields =
        |count| format!("{{bytes: 0..7, fields: {{{}}}}}", lines(count, |number| format!("f{number}: {{bits: 0}}, ")));
    assert_eq!(errors_in_types("  a: {}\n", &fields(255)), [""; 0]);
    let found = errors_in_types("  a: {}\n", &fields(30_000));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].ends_with("`one` comes to more than 256 fields"), "{}", found[0]);
}

#[test]
fn limits_of_very_many_models_on_very_many_fields_are_refused() {
    let models = lines(256, |number| format!("  M{number}: {{types: {{volts: {{range: 0..{}}}}}}}\n", 1 + number));
    let fields = lines(258, |number| {
        format!("  m{number}: {{access: [read], fields: {{first: {{bytes: 0..1, type: volts}}}}}}\n")
    });
    let spec = format!("{WHOLE}types: {{volts: {{unit: V}}}}\nmodels:\n{models}messages:\n{fields}");
    let found = compile(source(&spec)).diagnostics.concise();
    let found: Vec<_> = found.lines().filter(|line| line.contains("error[model_range]")).collect();
    // 256 models limit 256 fields each. Seven lines stand above, then `types`, `models` and 256 of them, and `messages`.
    let text = "device models change fields more than 65536 times from here on";
    assert_eq!(found, [format!("mini.yaml:523:35: error[model_range]: {text}")]);
}

#[test]
fn defaults_and_scales_of_very_many_models_on_very_many_fields_are_refused() {
    let fields = lines(258, |number| {
        format!("  m{number}: {{access: [read], fields: {{first: {{bytes: 0..1, type: volts}}}}}}\n")
    });
    for change in ["default: 1", "scale: 1/10"] {
        let models = lines(256, |number| format!("  M{number}: {{types: {{volts: {{{change}}}}}}}\n"));
        let spec = format!("{WHOLE}types: {{volts: {{unit: V}}}}\nmodels:\n{models}messages:\n{fields}");
        let found = compile(source(&spec)).diagnostics.concise();
        let found: Vec<_> = found.lines().filter(|line| line.contains("error[model_range]")).collect();
        let text = "device models change fields more than 65536 times from here on";
        assert_eq!(found, [format!("mini.yaml:523:35: error[model_range]: {text}")], "{change}");
    }
}

/// A spec whose messages are reports.
const TOLD: &str = "\
canspec: 1
protocol: mini
title: Mini
document: {title: Mini CAN, version: V1}
length: 8
identifier: {command: {bits: 10..0}}
addressing: {all: {one: {}}}
access: {tell: {report: {}, answers: {all: one}}}
";

/// What only the first of 256 models has. In 257 fields the others lack it 65,535 times.
const PARTIAL: [&str; 3] = [
    "{bytes: 0..1, models: [M0]}",
    "{bytes: 0, status: {low: {bit: 0, models: [M0]}}}",
    "{bytes: 0, values: {0: idle, 1: {name: full, models: [M0]}}}",
];

#[test]
fn what_very_many_models_lack_of_very_many_fields_is_refused() {
    let models = lines(256, |number| format!("  M{number}: {{section: \"1\"}}\n"));
    for field in PARTIAL {
        let refused = |count| {
            let fields = lines(count, |number| {
                format!("  m{number}: {{match: {{command: {number}}}, access: [tell], fields: {{first: {field}}}}}\n")
            });
            let spec = format!("{TOLD}models:\n{models}messages:\n{fields}");
            let found = compile(source(&spec)).diagnostics.concise();
            found.lines().filter(|line| line.contains("error")).map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(refused(257), [""; 0], "{field}");
        let text = "device models lack more than 65536 fields, bits and named values from here on";
        assert_eq!(refused(258), [format!("mini.yaml:524:58: error[model_range]: {text}")], "{field}");
    }
}

#[test]
fn an_error_around_deeply_nested_fields_lets_examples_name_them() {
    let inner = lines(25, |level| format!("a{level}: {{bits: 0, fields: {{"));
    let fields = format!("{inner}last: {{bits: 0}}{}", "}}".repeat(25));
    let message = format!(
        "messages: {{one: {{access: [read], fields: {{first: {{bytes: 0..99, fields: {{{fields}}}}}}}, \
         examples: [{{request: 01C, means: {{a24: 1, last: 1, a0_last: 1}}}}]}}}}\n"
    );
    let found = compile(source(&format!("{WHOLE}{message}"))).diagnostics.concise();
    let names: Vec<_> = found.lines().filter(|line| line.contains("there is no signal")).collect();
    assert_eq!(names, ["mini.yaml:8:785: error[name]: there is no signal `a0_last`"], "{found}");
}
