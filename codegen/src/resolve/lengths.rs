//! Resolves numbers of data bytes.

use std::fmt::Display;

use super::Resolver;
use super::window::MOST_BYTES;
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::number::Rational;

impl Resolver<'_> {
    /// Reads a number of data bytes.
    pub fn length(&mut self, path: &Path, text: &str) -> Option<u8> {
        let is_longer = Rational::parse(text).is_some_and(|number| number > Rational::integer(8));
        if !is_longer {
            return self.integer(path, text, 0, 8);
        }
        let message = format!("a frame has at most 8 data bytes, not {text}");
        let help = "frames of CAN FD are not there yet; split what is longer into messages of its frames";
        self.error_with_help(&rules::NUMBER, path.at_value(), message, help);
        None
    }

    /// Reads the numbers of data bytes that frames of a message can have, the least first.
    pub fn lengths(&mut self, path: &Path, written: &[String], otherwise: u8) -> Vec<u8> {
        let lengths = self.rising(path, written, Self::length);
        if lengths.is_empty() { vec![otherwise] } else { lengths }
    }

    /// Reads the numbers of data bytes that a long message can have, the least first.
    pub fn long_lengths(&mut self, path: &Path, written: &[String]) -> Vec<u16> {
        self.rising(path, written, |resolver, at, text| resolver.integer(at, text, 1, MOST_BYTES))
    }

    /// Reads numbers in rising order.
    fn rising<N: Copy + PartialOrd + Display>(
        &mut self,
        path: &Path,
        written: &[String],
        read: impl Fn(&mut Self, &Path, &str) -> Option<N>,
    ) -> Vec<N> {
        let mut lengths: Vec<N> = Vec::new();
        for (index, text) in written.iter().enumerate() {
            let at = if self.diagnostics.has(&path.index(index)) { path.index(index) } else { path.clone() };
            let Some(length) = read(self, &at, text) else { continue };
            match lengths.last().filter(|shorter| **shorter >= length) {
                None => lengths.push(length),
                Some(shorter) => {
                    let text = format!("the length {length} stands after {shorter}");
                    self.error_with_help(
                        &rules::NUMBER,
                        at.at_value(),
                        text,
                        "write each length once, the least first",
                    );
                }
            }
        }
        lengths
    }
}

/// Returns the lengths of a kind of frame: the shortest, and those at which more of its signals end.
pub fn lengths_with(lengths: &[u8], ends: &(impl Iterator<Item = u8> + Clone)) -> Vec<u8> {
    let mut shorter = None;
    let adds = |length: &&u8| {
        let shorter = shorter.replace(**length);
        shorter.is_none_or(|shorter| ends.clone().any(|end| (shorter + 1..=**length).contains(&end)))
    };
    lengths.iter().filter(adds).copied().collect()
}
