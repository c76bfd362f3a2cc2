//! Numbers that look random.

/// Numbers that look random, the same each time.
pub struct Random(pub u64);

impl Random {
    /// Returns the next one, from 0 up to a limit.
    pub fn below(&mut self, limit: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 20) % limit
    }
}
