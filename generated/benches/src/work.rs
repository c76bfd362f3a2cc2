//! What codecs do while they are measured.

use std::fmt::Debug;
use std::hint::black_box;

use crate::Codec;
use crate::frame::Frame;

/// Something that a codec does with frames.
#[derive(Clone, Copy)]
pub struct Work {
    /// Name in the table.
    pub name: &'static str,
    /// Prepares the work on the inputs that the frames give. It panics if the codec refuses a frame.
    pub prepare: fn(&[Frame]) -> Prepared,
}

/// A work with its inputs.
pub struct Prepared {
    count: usize,
    pass: Box<dyn Fn()>,
}

impl Prepared {
    /// Prepares a pass that does a work `count` times.
    pub fn new(count: usize, pass: impl Fn() + 'static) -> Self {
        Self { count, pass: Box::new(pass) }
    }

    /// Returns how often a pass does the work.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Does the work once with each input.
    pub fn run(&self) {
        (self.pass)();
    }
}

/// Prepares a work on each input. A pass does it once with each. The compiler would leave a large closure as a function
/// of its own, so this is a macro.
macro_rules! with_each {
    ($inputs:expr, |$input:pat_param| $work:expr) => {{
        let inputs = $inputs;
        $crate::work::Prepared::new(inputs.len(), move || {
            for input in &inputs {
                let $input = ::std::hint::black_box(input);
                $work;
            }
        })
    }};
}
pub(crate) use with_each;

/// Runs `work` on inputs that the compiler cannot foresee.
#[inline(always)]
pub fn each<T>(inputs: &[T], work: impl Fn(&T)) {
    for input in inputs {
        work(black_box(input));
    }
}

/// Decodes frames in the loop that takes the values, the only place that decodes.
pub const fn decode<C: Codec>() -> Work {
    let prepare = |frames: &[Frame]| {
        with_each!(known::<C>(frames), |frame| {
            C::decode(frame).as_ref().map(C::take).ok();
        })
    };
    Work { name: "decode", prepare }
}

/// Decodes frames by a function that is not inlined, as in a program that decodes in several places.
pub const fn decode_by_call<C: Codec>() -> Work {
    let prepare = |frames: &[Frame]| {
        with_each!(known::<C>(frames), |frame| {
            decoded::<C>(frame).as_ref().map(C::take).ok();
        })
    };
    Work { name: "decode by a call", prepare }
}

/// Builds requests.
pub const fn request<C: Codec>() -> Work {
    let prepare = |frames: &[Frame]| {
        with_each!(requests::<C>(frames), |request| {
            black_box(&C::request(request));
        })
    };
    Work { name: "request", prepare }
}

/// Builds requests by a function that is not inlined.
pub const fn request_by_call<C: Codec>() -> Work {
    let prepare = |frames: &[Frame]| {
        with_each!(requests::<C>(frames), |request| {
            black_box(&requested::<C>(request));
        })
    };
    Work { name: "request by a call", prepare }
}

/// Encodes what was received.
pub const fn encode<C: Codec>() -> Work {
    let prepare = |frames: &[Frame]| {
        with_each!(values::<C>(frames), |values| {
            black_box(&C::encode(values));
        })
    };
    Work { name: "encode what was received", prepare }
}

/// Encodes what was received by a function that is not inlined.
pub const fn encode_by_call<C: Codec>() -> Work {
    let prepare = |frames: &[Frame]| {
        with_each!(values::<C>(frames), |values| {
            black_box(&encoded::<C>(values));
        })
    };
    Work { name: "encode what was received by a call", prepare }
}

#[inline(never)]
fn decoded<C: Codec>(frame: &Frame) -> Result<C::Received, impl Debug> {
    C::decode(frame)
}

#[inline(never)]
fn requested<C: Codec>(request: &C::Request) -> Option<impl embedded_can::Frame> {
    C::request(request)
}

#[inline(never)]
fn encoded<C: Codec>(values: &C::Values) -> Option<impl embedded_can::Frame> {
    C::encode(values)
}

/// Decodes a frame of the protocol.
///
/// # Panics
///
/// If the codec refuses the frame.
pub fn received<C: Codec>(frame: &Frame) -> C::Received {
    decoded::<C>(frame).expect("a frame of the protocol")
}

fn known<C: Codec>(frames: &[Frame]) -> Vec<Frame> {
    frames.iter().map(C::known).collect()
}

fn values<C: Codec>(frames: &[Frame]) -> Vec<C::Values> {
    known::<C>(frames).iter().map(|frame| C::to_values(&received::<C>(frame))).collect()
}

/// Returns the requests among frames.
pub fn requests<C: Codec>(frames: &[Frame]) -> Vec<C::Request> {
    values::<C>(frames).iter().filter_map(C::to_request).collect()
}
