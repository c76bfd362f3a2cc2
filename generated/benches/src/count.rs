//! Does one work by one codec for as many passes as it is told, so that valgrind can count.
//!
//! `table` compiles it for each work and each codec. So the codec has one call site, as in most programs.

use std::env;

#[cfg(codec = "by_hand")]
use canspec_benches::by_hand::Hand as Codec;
#[cfg(codec = "dbc")]
use canspec_benches::dbc::Dbc as Codec;
use canspec_benches::frames;
#[cfg(not(any(codec = "by_hand", codec = "dbc")))]
use canspec_benches::generated::Generated as Codec;
#[cfg(not(any(work = "decode_by_call", work = "payload", work = "request", work = "encode", work = "reply")))]
use canspec_benches::work::decode as prepare;
#[cfg(work = "decode_by_call")]
use canspec_benches::work::decode_by_call as prepare;
#[cfg(work = "encode")]
use canspec_benches::work::encode as prepare;
#[cfg(work = "payload")]
use canspec_benches::work::payload as prepare;
#[cfg(work = "reply")]
use canspec_benches::work::reply as prepare;
#[cfg(work = "request")]
use canspec_benches::work::request as prepare;

fn main() {
    let passes: usize = env::args().next_back().and_then(|passes| passes.parse().ok()).expect("a number of passes");
    let prepared = prepare::<Codec>(&frames::distinct(frames::COUNTED));
    println!("{}", prepared.count());
    for _ in 0..passes {
        prepared.run();
    }
}
