//! What people and editors read about the language: all rules, and the JSON Schema.
//!
//! This layer stands on top, since it gathers what the stages have. `rules` joins the rules of each
//! stage, finds one by its name, and makes the page of all. `schema` is made from the structs that a
//! spec is read into, and from the words that its keys choose among, so that an editor offers
//! what the compiler takes.

pub mod rules;
#[cfg(feature = "schema")]
pub mod schema;
