//! Supplies that nobody makes, for six kinds of frames. `supply.yaml` describes them.

pub mod binrw;
pub mod by_hand;
pub mod dbc;
pub mod frames;
pub mod generated;
pub mod hand;

use self::binrw::Binrw;
use crate::Codec;
use crate::work;
use crate::workload::{Kind, Measured, Workload};
use crate::{frame, steps};
use by_hand::Hand;
use dbc::{Dbc, OneAddress};
use generated::Generated;

// `names` calls a macro with the names of all registers of a real and of a whole number, and of all signals.
include!(concat!(env!("OUT_DIR"), "/names.rs"));

/// The workload.
pub const WORKLOAD: Workload = Workload {
    name: "supply",
    kinds: &[
        Kind { name: "two floats", frames: |count| frames::of(1, count) },
        Kind { name: "set-point", frames: |count| frames::of(2, count) },
        Kind { name: "status", frames: |count| frames::of(3, count) },
        Kind { name: "three tenths", frames: |count| frames::of(4, count) },
        Kind { name: "one of 40 registers", frames: |count| frames::of(5, count) },
        Kind { name: "one of 60 signals", frames: |count| frames::of(6, count) },
    ],
    codecs: &[
        measured::<Generated>(),
        measured::<Hand>(),
        measured::<Dbc>(),
        measured::<OneAddress>(),
        measured::<Binrw>(),
    ],
    counted: None,
};

const fn measured<C: Codec>() -> Measured {
    let works = const {
        &[
            work::decode::<C>(),
            work::decode_by_call::<C>(),
            work::request::<C>(),
            work::request_by_call::<C>(),
            work::encode::<C>(),
            work::encode_by_call::<C>(),
        ]
    };
    Measured { codec: C::NAME, works }
}
