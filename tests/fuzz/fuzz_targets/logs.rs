#![no_main]

use canspec_tests::fuzz::LOGS;
use libfuzzer_sys::{fuzz_mutator, fuzz_target};

fuzz_target!(|data: &[u8]| (LOGS.run)(data));

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    canspec_fuzz::mutate(&LOGS, data, size, max_size, seed)
});
