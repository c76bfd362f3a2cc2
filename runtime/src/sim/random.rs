//! Numbers that look random.

/// Numbers that look random, and are the same for the same seed.
#[derive(Clone, Copy, Debug)]
pub struct Random(u64);

impl Random {
    /// Returns the numbers of a seed.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Returns the next number below a limit, or 0 if the limit is 0.
    pub fn below(&mut self, limit: u32) -> u32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        // The upper half of a product with 32 random bits.
        let product = u64::from(limit).wrapping_mul(mixed >> 32);
        u32::try_from(product >> 32).unwrap_or_default()
    }

    /// Returns whether something happens that does so in some of a hundred cases.
    pub fn chance(&mut self, percent: u8) -> bool {
        self.below(100) < percent.into()
    }
}
