//! Written by hand.

pub fn handwritten() {}
