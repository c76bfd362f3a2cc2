//! Drivers for a processor without floating-point instructions.
#![no_std]
#![deny(warnings, missing_docs, unsafe_code)]

include!(concat!(env!("OUT_DIR"), "/protocols.rs"));
