//! What becomes of the frames of long messages.

use canspec_codegen::interpret::{Assembled, Assembly, decode};
use canspec_codegen::model::{ModelId, Protocol};

use super::frame;

/// Puts frames together. Each remembers its place. It returns the messages, and the places of frames that belong to none.
pub fn assembled(protocol: &Protocol, frames: &[&str]) -> (Vec<Assembled<usize>>, Vec<usize>) {
    assembled_on(protocol, None, frames)
}

/// The same for a device model.
pub fn assembled_on(
    protocol: &Protocol,
    model: Option<ModelId>,
    frames: &[&str],
) -> (Vec<Assembled<usize>>, Vec<usize>) {
    let (mut assembly, mut ended, mut others) = (Assembly::default(), Vec::new(), Vec::new());
    for (place, frame) in frames.iter().map(|known| frame(known)).enumerate() {
        let decoded = decode(protocol, model, &frame).unwrap_or_else(|problem| panic!("{place}: {}", problem.text));
        let taken = assembly.take(protocol, model, place, &frame, &decoded);
        ended.extend(taken.ended);
        if !taken.is_part {
            others.push(place);
        }
    }
    ended.extend(assembly.finish(protocol, model));
    (ended, others)
}

/// What became of frames: the places and what is missing of each message, and the frames that belong to none.
pub type Story<'a> = (Vec<(Vec<usize>, Option<&'a str>)>, Vec<usize>);

/// Tests what becomes of frames.
pub fn check(protocol: &Protocol, frames: &[&str], (messages, others): Story) {
    let (ended, left) = assembled(protocol, frames);
    let told: Vec<_> = ended.iter().map(|whole| (whole.marks.clone(), whole.incomplete.as_deref())).collect();
    assert_eq!((told, left), (messages, others), "{frames:?}");
}
