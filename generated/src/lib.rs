//! Codecs of the protocols that canspec ships: `no_std`, no allocation, one module a protocol.
//!
//! The modules are generated from the specs when this crate is built; each item names the section of the vendor's document.
//!
//! The features `serde`, `defmt` and `arbitrary` give the optional traits to every type; `canspec_runtime` says what each of them does.
#![no_std]
#![forbid(unsafe_code)]

/// The README's Rust runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

include!(concat!(env!("OUT_DIR"), "/protocols.rs"));
