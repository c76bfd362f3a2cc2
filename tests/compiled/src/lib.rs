//! The generated Rust of random specs, each in a module.
//!
//! `tests/src/random_specs/compiled.rs` writes the modules into a file, whose path is in `CANSPEC_MODULES`.
#![no_std]
#![deny(warnings, missing_docs, unsafe_code)]

include!(env!("CANSPEC_MODULES"));
