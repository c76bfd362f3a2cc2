//! The fuzz targets under libFuzzer.

use canspec_tests::fuzz::Target;
use fastrand::Rng;

/// Lets libFuzzer change an input in its way or, as often, in that of the target.
pub fn mutate(target: &Target, data: &mut [u8], size: usize, limit: usize, seed: u32) -> usize {
    let mut random = Rng::with_seed(seed.into());
    if random.bool() {
        return libfuzzer_sys::fuzzer_mutate(data, size, limit);
    }
    let mutated = (target.mutated)(&data[..size], &mut random);
    let length = mutated.len().min(limit);
    data[..length].copy_from_slice(&mutated[..length]);
    length
}
