//! Times in milliseconds that wrap around.

/// Tests whether a time has come.
pub fn has_come(time: u32, now: u32) -> bool {
    now.wrapping_sub(time) < 1 << 31
}

/// Tests whether so much time has passed since a time, which may lie ahead.
pub fn has_lasted(since: u32, patience: u32, now: u32) -> bool {
    has_come(since, now) && now.wrapping_sub(since) >= patience
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

/// Returns the later one of two times, both within 24 days of each other.
pub fn later_of(one: u32, other: u32) -> u32 {
    if is_later(other, one) { other } else { one }
}

/// Returns the later one of two times, or the only one.
pub fn latest_of(one: Option<u32>, other: Option<u32>) -> Option<u32> {
    one.zip(other).map(|(one, other)| later_of(one, other)).or(one).or(other)
}
