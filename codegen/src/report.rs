//! What is wrong with a spec, and where: every stage reports through this layer.
//!
//! `lines` is the text of a spec and of its bases, and turns bytes into lines and columns. `tree`
//! has the paths by which the later stages name a place. A `rule` is what can be broken, and a
//! [`diagnostic::Diagnostic`] says that it is, at which place, and what to do. `claims` decides
//! which of two overlapping places is probably the wrong one.

pub mod claims;
pub mod diagnostic;
pub mod lines;
pub mod rule;
pub mod tree;
