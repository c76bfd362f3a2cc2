//! Mistakes of every kind in pieces of code like those of the project.

use super::{Kind, mistakes, planted};

/// A function, the kind of a mistake in it, and the function with the mistake.
const MISTAKES: [(Kind, &str, &str); 27] = [
    (Kind::Comparison, "fn f() -> i64 { (rest >= half) as i64 }", "fn f() -> i64 { (rest > half) as i64 }"),
    (
        Kind::Comparison,
        "fn f() -> X { values.find(|value| value.raw == bits) }",
        "fn f() -> X { values.find(|value| value.raw != bits) }",
    ),
    (Kind::Logic, "fn f() -> X { if a.is_empty() && b { c } }", "fn f() -> X { if a.is_empty() || b { c } }"),
    (Kind::Logic, "fn f() -> X { g(!a) }", "fn f() -> X { g(a) }"),
    (Kind::Logic, "fn f() -> X { quote!(#a && #b) }", "fn f() -> X { quote!(#a || #b) }"),
    (Kind::Arithmetic, "fn f() -> X { raw * self.numerator }", "fn f() -> X { raw / self.numerator }"),
    (Kind::Arithmetic, "fn f() -> X { g(-limit) }", "fn f() -> X { g(limit) }"),
    (Kind::Bits, "fn f() -> X { bits & mask }", "fn f() -> X { bits | mask }"),
    (Kind::Bits, "fn f() -> X { bits << width }", "fn f() -> X { bits >> width }"),
    (Kind::Number, "fn f() -> X { 1_u64.wrapping_shl(bit) }", "fn f() -> X { 2u64.wrapping_shl(bit) }"),
    (Kind::Number, "fn f() -> X { quote!(#bits >> 8) }", "fn f() -> X { quote!(#bits >> 9) }"),
    (Kind::Truth, "const SIGNED: bool = true;", "const SIGNED: bool = false;"),
    (
        Kind::Truth,
        "macro_rules! signed { ($raw:ty) => { const SIGNED: bool = true; } }",
        "macro_rules! signed { ($raw:ty) => { const SIGNED: bool = false; } }",
    ),
    (Kind::Range, "fn f() -> X { (low..=high).contains(&raw) }", "fn f() -> X { (low..high).contains(&raw) }"),
    (Kind::Range, "fn f() -> X { quote!((#low..=#high)) }", "fn f() -> X { quote!((#low..#high)) }"),
    (Kind::Condition, "fn f() -> X { if is_signed { a } }", "fn f() -> X { if !(is_signed) { a } }"),
    (
        Kind::Condition,
        "fn f() -> X { if let Some(raw) = raw { a } }",
        "fn f() -> X { if false && let Some(raw) = raw { a } }",
    ),
    (
        Kind::Condition,
        "fn f() -> X { match raw { raw if fits(raw) => a } }",
        "fn f() -> X { match raw { raw if !(fits(raw)) => a } }",
    ),
    (Kind::Name, "fn f() -> X { u64::from_le_bytes(data) }", "fn f() -> X { u64::from_be_bytes(data) }"),
    (Kind::Name, "fn f() -> X { g(range.minimum) }", "fn f() -> X { g(range.maximum) }"),
    (Kind::Step, "fn f() -> X { bytes.iter().rev() }", "fn f() -> X { bytes.iter() }"),
    (Kind::Step, "fn f() -> X { quote!(.offset(#above)) }", "fn f() -> X { quote!() }"),
    (
        Kind::Arguments,
        "fn f() -> X { quote!(.scale(#numerator, #denominator)) }",
        "fn f() -> X { quote!(.scale(#denominator, #numerator)) }",
    ),
    (Kind::Arguments, "fn f() -> X { Scale::new(part(a), part(b)) }", "fn f() -> X { Scale::new(part(b), part(a)) }"),
    (
        Kind::Arms,
        "fn f() -> X { match order { Order::Low => a, Order::High => b } }",
        "fn f() -> X { match order { Order::Low => b, Order::High => a } }",
    ),
    (Kind::Statement, "fn f() { self.since = now; }", "fn f() { {} }"),
    (Kind::Result, "fn f() -> Option<Reply> { Some(reply) }", "fn f() -> Option<Reply> { None }"),
];

#[test]
fn every_kind_of_mistake_is_planted() {
    for (kind, right, wrong) in MISTAKES {
        let (right, wrong) = (parsed(right), printed(&parsed(wrong)));
        let found = mistakes(&right, "module");
        let same = |number: &usize| printed(&planted(&right, "module", *number)) == wrong;
        let number = (0..found.len()).find(same).unwrap_or_else(|| panic!("among {found:#?} is no\n{wrong}"));
        assert_eq!(found[number].kind, kind);
    }
    for (kind, name) in Kind::ALL {
        assert!(MISTAKES.iter().any(|(known, ..)| *known == kind), "{name}");
    }
}

#[test]
fn each_mistake_changes_the_file() {
    for (_, right, _) in MISTAKES {
        let right = parsed(right);
        for number in 0..mistakes(&right, "module").len() {
            assert_ne!(printed(&planted(&right, "module", number)), printed(&right));
        }
    }
}

#[test]
fn a_mistake_is_known_by_its_type_or_module_and_its_function() {
    let file = parsed("fn free() -> bool { a == b } impl Scale { fn own(&self) -> bool { a == b } }");
    let functions: Vec<_> = mistakes(&file, "number").into_iter().map(|mistake| mistake.function).collect();
    assert_eq!(functions, ["number::free", "Scale::own"]);
}

#[test]
fn code_that_only_tests_compile_has_no_mistakes() {
    let file = parsed("#[cfg(test)] mod tests { fn one() -> bool { a == b } } #[test] fn other() { g(1) }");
    assert_eq!(mistakes(&file, "module"), []);
}

/// Prints a file without its spaces, since those in macros differ.
fn printed(file: &syn::File) -> String {
    prettyplease::unparse(file).split_whitespace().collect()
}

fn parsed(code: &str) -> syn::File {
    syn::parse_file(code).expect("the code is Rust")
}
