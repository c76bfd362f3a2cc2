//! Does one work by one codec for as many passes as it is told, so that valgrind can count: count KIND PASSES.
//!
//! `table` compiles it for each work of each codec. So the codec has one call site, as in most programs.

use std::env;

use canspec_benches::frame::Frame;
use canspec_benches::work::Prepared;
use canspec_benches::workload::{Kind, Workload};

/// The numbers of the workload, of the codec and of the work, a digit each.
const WORK: [usize; 3] = match option_env!("CANSPEC_WORK") {
    Some(digits) => numbers(digits.as_bytes()),
    None => [0; 3],
};
const WORKLOAD: Workload = Workload::ALL[WORK[0]];
/// Constants of their own: a program links all that its constants name.
const KINDS: &[Kind] = WORKLOAD.kinds;
const PREPARE: fn(&[Frame]) -> Prepared = WORKLOAD.codecs[WORK[1]].works[WORK[2]].prepare;

fn main() {
    let numbers: Vec<usize> = env::args().skip(1).filter_map(|number| number.parse().ok()).collect();
    let [kind, passes] = numbers[..] else { panic!("count KIND PASSES") };
    let prepared = PREPARE(&(KINDS[kind].frames)(Workload::COUNTED));
    println!("{}", prepared.count());
    for _ in 0..passes {
        prepared.run();
    }
}

const fn numbers(digits: &[u8]) -> [usize; 3] {
    let [workload, codec, work] = *digits else { panic!("three digits") };
    [(workload - b'0') as usize, (codec - b'0') as usize, (work - b'0') as usize]
}
