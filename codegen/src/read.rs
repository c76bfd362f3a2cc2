//! From the bytes of a file to plain structs, whose leaves are still texts.
//!
//! `source` tests size, encoding and characters. `bases` finds the specs on which a spec is based,
//! and puts their texts behind its own. `syntax` reads one tree of all of them, refuses YAML that no
//! spec needs, joins the trees, and lets serde fill the structs in `syntax/ast`. `lint` looks at how
//! the spec is written; it only warns.

pub mod bases;
pub mod lint;
pub mod source;
pub mod syntax;
