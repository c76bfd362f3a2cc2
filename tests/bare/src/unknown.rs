//! Values that the compiler cannot foresee.

use canspec_runtime::plumbing::{Incoming, Raw, Shown, Way, Who};
use canspec_runtime::{Bcd, Bytes, Destination, Elements, Frame, Meaning, Number, Payload, Route, Text};

/// A type whose values can be unknown.
pub trait Unknown: Sized {
    /// Returns a value that can be any.
    fn unknown() -> Self;
}

/// Returns a value that can be any.
pub fn unknown<T: Unknown>() -> T {
    T::unknown()
}

impl Unknown for u64 {
    fn unknown() -> Self {
        static WORD: u64 = 0;
        // SAFETY: the pointer is made of a reference. The compiler may not assume what a volatile read returns.
        unsafe { core::ptr::read_volatile(&raw const WORD) }
    }
}

impl Unknown for &'static str {
    fn unknown() -> Self {
        static TEXT: &str = "";
        // SAFETY: the pointer is made of a reference. The compiler may not assume what a volatile read returns.
        unsafe { core::ptr::read_volatile(&raw const TEXT) }
    }
}

macro_rules! integers {
    ($($type:ty)*) => {$(
        impl Unknown for $type {
            #[expect(clippy::allow_attributes, reason = "not every type does all of this")]
            #[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "any value will do")]
            fn unknown() -> Self {
                unknown::<u64>() as Self
            }
        }
    )*};
}

integers!(u8 u16 u32 usize i8 i16 i32 i64);

impl Unknown for bool {
    fn unknown() -> Self {
        unknown::<u8>() & 1 != 0
    }
}

impl Unknown for Who {
    fn unknown() -> Self {
        match unknown::<u8>() {
            0 => Self::One,
            1 => Self::Each,
            2 => Self::Coordinator,
            _ => Self::Nobody,
        }
    }
}

impl Unknown for f32 {
    fn unknown() -> Self {
        Self::from_bits(unknown())
    }
}

impl Unknown for f64 {
    fn unknown() -> Self {
        Self::from_bits(unknown())
    }
}

impl<T: Unknown, const N: usize> Unknown for [T; N] {
    fn unknown() -> Self {
        [(); N].map(|()| unknown())
    }
}

impl<T: Unknown, const N: usize> Unknown for Elements<T, N> {
    fn unknown() -> Self {
        Self::from_fn(unknown(), |_| unknown())
    }
}

impl<const N: usize, const FILL: u8> Unknown for Text<N, FILL> {
    fn unknown() -> Self {
        Self::from_bits(unknown())
    }
}

impl<const N: usize> Unknown for Bytes<N> {
    fn unknown() -> Self {
        Raw::from_bits(unknown())
    }
}

impl<R: Unknown> Unknown for Bcd<R> {
    fn unknown() -> Self {
        Self::from_raw(unknown())
    }
}

impl<T: Unknown> Unknown for Option<T> {
    fn unknown() -> Self {
        unknown::<bool>().then(unknown)
    }
}

impl Unknown for Frame {
    fn unknown() -> Self {
        Self::new_raw(unknown(), unknown(), unknown(), unknown())
    }
}

impl Unknown for Incoming {
    fn unknown() -> Self {
        Self::new(unknown(), unknown())
    }
}

impl Unknown for Payload {
    fn unknown() -> Self {
        let new = if unknown() { Self::within_limits } else { Self::new };
        new(unknown(), unknown()).for_model(unknown())
    }
}

impl<T: Destination + Unknown> Unknown for Route<T> {
    fn unknown() -> Self {
        if unknown() { Self::new(unknown(), unknown()) } else { unknown::<T>().into() }
    }
}

impl Unknown for Number {
    fn unknown() -> Self {
        match unknown::<u8>() {
            0 => Self::Unsigned(unknown()),
            1 => Self::Signed(unknown()),
            _ => Self::Float(unknown()),
        }
    }
}

impl Unknown for Meaning<'_> {
    fn unknown() -> Self {
        match unknown::<u8>() {
            0 => Self::Number(unknown()),
            1 => Self::Name(unknown()),
            2 => Self::Text(unknown()),
            3 => Self::Status(unknown(), &[]),
            4 => Self::Bytes(&[]),
            _ => Self::None,
        }
    }
}

impl Unknown for Shown {
    fn unknown() -> Self {
        Self::new(unknown(), unknown(), &[Some(Who::One), Some(Who::Each), Some(Who::Coordinator), None])
    }
}

impl Unknown for Way {
    fn unknown() -> Self {
        let shown: Shown = unknown();
        if unknown() { shown.request(unknown()) } else { shown.reply(unknown(), unknown()) }
    }
}
