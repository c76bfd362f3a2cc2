//! What frames have in common, found or made once for those to come.

use std::hash::Hash;

use canspec_codegen::interpret::{self, Decoded, Frame, Recognised, Unrecognised};
use canspec_codegen::model::{FrameId, Protocol};
use rustc_hash::FxHashMap;

use crate::choose::device::Device;
use crate::show::outcome::Outcome;

/// As many frames are kept at the same time. A bus has far fewer identifiers.
const MOST: usize = 1 << 13;

/// What identifier and kind of a frame alone decide: which message it is, its addresses and its names. Most frames of
/// a log have those of an earlier one.
#[derive(Default)]
pub struct Kept<'a> {
    recognised: FxHashMap<(usize, u32), Recognised<'a>>,
    texts: FxHashMap<Key, Box<[u8]>>,
    /// The widths for which the texts were made.
    widths: Vec<usize>,
}

#[derive(PartialEq, Eq, Hash)]
struct Key {
    /// The place of the protocol.
    protocol: usize,
    id: u32,
    frame: FrameId,
}

impl<'a> Kept<'a> {
    /// Decodes a frame, as [`interpret::decode`] does.
    ///
    /// # Errors
    ///
    /// The frame is not recognised.
    pub fn decode(&mut self, (protocol, model): Device<'a>, frame: &Frame) -> Result<Decoded, Unrecognised> {
        let key = (place(protocol), frame.id);
        if let Some(known) = self.recognised.get(&key).filter(|known| known.is_known_of(frame)) {
            return Ok(known.decode(frame));
        }
        let recognised = interpret::recognise(protocol, model, frame)?;
        let decoded = recognised.decode(frame);
        if recognised.is_known_of(frame) {
            keep(&mut self.recognised, key, recognised);
        }
        Ok(decoded)
    }

    /// Drops all texts that were made for columns of other widths.
    pub fn fit(&mut self, widths: &[usize]) {
        if self.widths != widths {
            self.texts.clear();
            self.widths = widths.to_vec();
        }
    }

    /// Adds the text of a recognised frame, which `make` adds for the first such frame. What several frames say together
    /// has no text that others share.
    pub fn add(
        &mut self,
        out: &mut Vec<u8>,
        outcome: &Outcome<'_>,
        decoded: &Decoded,
        make: impl FnOnce(&mut Vec<u8>),
    ) {
        if outcome.whole.is_some() {
            return make(out);
        }
        let key = Key { protocol: place(outcome.protocol), id: decoded.id, frame: decoded.frame };
        if let Some(text) = self.texts.get(&key) {
            return out.extend_from_slice(text);
        }
        let start = out.len();
        make(out);
        keep(&mut self.texts, key, out[start..].into());
    }
}

/// Keeps something, and drops the rest where that is too much.
fn keep<K: Eq + Hash, V>(known: &mut FxHashMap<K, V>, key: K, value: V) {
    if known.len() == MOST {
        known.clear();
    }
    known.insert(key, value);
}

/// Returns where a protocol stands in memory, which tells it from others.
fn place(protocol: &Protocol) -> usize {
    std::ptr::from_ref(protocol).addr()
}

#[cfg(test)]
mod tests {
    use canspec_codegen::interpret::Form;
    use canspec_specs::SPECS;

    use super::*;
    use crate::choose::protocols;
    use crate::command::decode::rows::Rows;
    use crate::show::line;
    use crate::show::table::Table;

    /// Returns the frames of all examples, each with fewer bytes, too, and as other forms of frame.
    fn frames(protocol: &Protocol) -> Vec<Frame> {
        let printed = protocol.examples.iter().map(|example| Frame::of(protocol, example));
        let changed = printed.flat_map(|frame| {
            let shorter = Frame { data: frame.data[..frame.data.len() / 2].to_vec(), ..frame.clone() };
            let other = Frame { data: frame.data.iter().map(|byte| !byte).collect(), ..frame.clone() };
            let narrow = Frame { extended: !frame.extended, ..frame.clone() };
            let remote = Frame { form: Form::Remote, ..frame.clone() };
            [frame, shorter, other, narrow, remote]
        });
        changed.collect()
    }

    #[test]
    fn a_frame_is_decoded_alike_whatever_came_before_it() {
        for spec in SPECS {
            let protocol = protocols::load_built_in(spec).expect("a built-in spec has no errors");
            let frames = frames(&protocol);
            let mut kept = Kept::default();
            for frame in frames.iter().chain(&frames).chain(frames.iter().rev()) {
                let expected = interpret::decode(&protocol, None, frame);
                assert_eq!(kept.decode((&protocol, None), frame), expected, "{}: {frame}", protocol.name);
            }
        }
    }

    #[test]
    fn a_row_is_written_alike_whatever_came_before_it() {
        each_outcome(|protocol| {
            let mut kept = Kept::default();
            let [mut one, mut other] = [(); 2].map(|()| Table::new(std::slice::from_ref(protocol)));
            move |outcome| {
                let [mut row, mut expected] = [Vec::new(), Vec::new()];
                one.write(&mut row, &mut kept, outcome);
                other.write(&mut expected, &mut Kept::default(), outcome);
                assert_eq!(String::from_utf8(row), String::from_utf8(expected));
            }
        });
    }

    #[test]
    fn rows_of_csv_are_written_alike_whatever_came_before_them() {
        each_outcome(|_| {
            let mut kept = Kept::default();
            let [mut one, mut other] = [(); 2].map(|()| Rows::default());
            move |outcome| {
                let [mut rows, mut expected] = [Vec::new(), Vec::new()];
                one.write(&mut rows, &mut kept, outcome);
                other.write(&mut expected, &mut Kept::default(), outcome);
                assert_eq!(String::from_utf8(rows), String::from_utf8(expected));
            }
        });
    }

    #[test]
    fn a_line_of_json_is_written_alike_whatever_came_before_it() {
        each_outcome(|_| {
            let mut kept = Kept::default();
            move |outcome| {
                let [mut line, mut expected] = [Vec::new(), Vec::new()];
                line::write(&mut line, &mut kept, outcome);
                line::write(&mut expected, &mut Kept::default(), outcome);
                assert_eq!(String::from_utf8(line), String::from_utf8(expected));
            }
        });
    }

    /// Does work on the frames of each protocol, which come over channels with names of several lengths.
    fn each_outcome<W: FnMut(&Outcome<'_>)>(work: impl Fn(&Protocol) -> W) {
        for spec in SPECS {
            let protocol = protocols::load_built_in(spec).expect("a built-in spec has no errors");
            let mut work = work(&protocol);
            for channel in ["a", "a", "longer than CHANNEL", "a"] {
                for frame in &frames(&protocol) {
                    let (channel, protocol, decoded) =
                        (Some(channel), &protocol, &interpret::decode(&protocol, None, frame));
                    work(&Outcome { line: 1, time: None, channel, frame, protocol, decoded, whole: None });
                }
            }
        }
    }

    #[test]
    fn no_more_is_kept_than_fits() {
        let mut known = FxHashMap::default();
        for key in 0..3 * MOST {
            keep(&mut known, key, key);
            assert!(known.get(&key) == Some(&key) && known.len() <= MOST);
        }
    }
}
