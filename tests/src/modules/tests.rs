use super::{Files, circles};

fn crate_of<const N: usize>(files: [(&str, &str); N]) -> Files {
    files.map(|(name, text)| (name.to_owned(), text.to_owned())).into()
}

const ROOT: (&str, &str) = ("lib.rs", "mod a;\nmod b;\nmod c;\n");

#[test]
fn a_circle_is_shown_with_a_place_for_each_edge() {
    let files = crate_of([
        ROOT,
        ("a.rs", "//! `B` is named here, too.\n\nmod deep;\n"),
        ("a/deep.rs", "use std::fmt;\n\nuse crate::{\n    b::B,\n};\n"),
        ("b.rs", "pub struct B;\n\nfn f() -> usize {\n    g(&[super::c::LENGTH])\n}\n"),
        ("c.rs", "use super::a;\n"),
    ]);
    let circle = "in `crate`: a, b, c\n  a needs b: a/deep.rs:4 (crate::b::B)\n  \
        b needs c: b.rs:4 (super::c::LENGTH)\n  c needs a: c.rs:1 (super::a)";
    assert_eq!(circles(&files), [circle]);
}

#[test]
fn each_folder_is_looked_at_for_itself() {
    let files = crate_of([
        ("lib.rs", "mod a;"),
        ("a.rs", "mod b;\nmod c;\n"),
        ("a/b.rs", "mod d;\n"),
        ("a/b/d.rs", "type D = super::super::c::C;\n"),
        ("a/c.rs", "use crate::a::b;\n"),
    ]);
    let circle =
        "in `crate::a`: b, c\n  b needs c: a/b/d.rs:1 (super::super::c::C)\n  c needs b: a/c.rs:1 (crate::a::b)";
    assert_eq!(circles(&files), [circle]);
}

#[test]
fn a_path_through_a_face_leads_to_the_module_of_the_item() {
    let files = crate_of([
        ROOT,
        ("a.rs", "use crate::b::See;\n"),
        ("b.rs", "pub use crate::c::{self as sea, C as See};\n"),
        ("c.rs", "use crate::a;\n"),
    ]);
    let circle = "in `crate`: a, c\n  a needs c: a.rs:1 (crate::b::See)\n  c needs a: c.rs:1 (crate::a)";
    assert_eq!(circles(&files), [circle]);
}

#[test]
fn a_face_and_its_children_may_name_each_other() {
    let files =
        crate_of([("lib.rs", "mod a;\n\npub struct Shared;\nfn f() { a::g() }\n"), ("a.rs", "use crate::Shared;\n")]);
    assert_eq!(circles(&files), [""; 0]);
}

#[test]
fn what_a_face_offers_is_the_face_for_those_below_it() {
    let face = |import: &str| {
        circles(&crate_of([
            ("lib.rs", "mod a;\n"),
            ("a.rs", &format!("mod b;\nmod c;\n\n{import} b::B;\n")),
            ("a/b.rs", "use super::c::C;\n\npub struct B(C);\n"),
            ("a/c.rs", "use super::B;\n\npub struct C(B);\n"),
        ]))
    };
    assert_eq!(face("pub use"), [""; 0]);
    assert_eq!(face("use").len(), 1);
}

#[test]
fn what_tests_and_generated_code_name_does_not_count() {
    let files = crate_of([
        ROOT,
        ("a.rs", "use crate::b;\n"),
        ("b.rs", "#[cfg(test)]\nuse crate::a;\n\nimpl B {\n    #[cfg(test)]\n    fn f() { crate::a::f() }\n}\n"),
        ("c.rs", "use crate::a;\n\nfn f() { quote!(crate::b) }\n\n#[cfg(test)]\nmod tests { use crate::b; }\n"),
    ]);
    assert_eq!(circles(&files), [""; 0]);
}
