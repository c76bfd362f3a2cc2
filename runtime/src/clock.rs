//! Times in milliseconds that wrap around.

/// Tests whether a time has come.
pub fn has_come(time: u32, now: u32) -> bool {
    now.wrapping_sub(time) < 1 << 31
}

/// Tests whether a time is before another one, both within 24 days of now.
pub fn earlier(time: u32, other: u32, now: u32) -> bool {
    let since = |time: u32| now.wrapping_sub(time) as i32;
    since(time) > since(other)
}

/// Tests whether a time is after another one, both within 24 days of each other.
pub fn is_later(time: u32, other: u32) -> bool {
    !has_come(time, other)
}
