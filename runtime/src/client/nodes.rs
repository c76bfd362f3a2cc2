//! Sets of modules.

use core::fmt;

/// A set of modules, by their numbers from 0 to 255: their addresses in the way that the document counts.
///
/// ```
/// use canspec_runtime::client::Nodes;
///
/// let mut nodes = Nodes::from([1, 2, 200]);
/// nodes.remove(2);
/// assert!(nodes.iter().eq([1, 200]));
/// ```
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Nodes([u32; 8]);

impl Nodes {
    /// No module.
    pub const NONE: Self = Self([0; 8]);

    /// Adds a module.
    pub fn insert(&mut self, node: u8) {
        if let Some(word) = self.0.get_mut(usize::from(node >> 5)) {
            *word |= bit(node);
        }
    }

    /// Takes a module out, and returns whether the set had it.
    pub fn remove(&mut self, node: u8) -> bool {
        let had = self.contains(node);
        if let Some(word) = self.0.get_mut(usize::from(node >> 5)) {
            *word &= !bit(node);
        }
        had
    }

    /// Tests whether the set has a module.
    pub fn contains(&self, node: u8) -> bool {
        self.0.get(usize::from(node >> 5)).is_some_and(|word| word & bit(node) != 0)
    }

    /// Tests whether the set has no module.
    pub fn is_empty(&self) -> bool {
        *self == Self::NONE
    }

    /// Returns the modules, the lowest number first.
    pub fn iter(&self) -> impl Iterator<Item = u8> {
        let set = *self;
        (0..=u8::MAX).filter(move |node| set.contains(*node))
    }

    /// Returns the modules that both sets have.
    pub(crate) fn both(mut self, other: &Self) -> Self {
        self.0.iter_mut().zip(other.0).for_each(|(word, other)| *word &= other);
        self
    }

    /// Returns the modules that this set has, or another one.
    pub(crate) fn either(mut self, other: &Self) -> Self {
        self.0.iter_mut().zip(other.0).for_each(|(word, other)| *word |= other);
        self
    }
}

const fn bit(node: u8) -> u32 {
    1 << (node & 31)
}

impl FromIterator<u8> for Nodes {
    fn from_iter<I: IntoIterator<Item = u8>>(nodes: I) -> Self {
        let mut set = Self::NONE;
        nodes.into_iter().for_each(|node| set.insert(node));
        set
    }
}

impl<const M: usize> From<[u8; M]> for Nodes {
    fn from(nodes: [u8; M]) -> Self {
        nodes.into_iter().collect()
    }
}

impl fmt::Debug for Nodes {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_set().entries(self.iter()).finish()
    }
}

#[cfg(test)]
mod tests {
    use std::format;

    use super::*;

    #[test]
    fn a_set_has_what_was_added_and_not_taken_out() {
        let ends = [0, 31, 32, 63, 64, 255];
        let mut set = Nodes::from(ends);
        assert!(set.iter().eq(ends));
        assert!((0..=255).all(|node| set.contains(node) == ends.contains(&node)));
        assert_eq!([set.remove(32), set.remove(32), set.remove(33)], [true, false, false]);
        assert_eq!(format!("{set:?}"), "{0, 31, 63, 64, 255}");
        assert_eq!(ends.map(|node| set.remove(node)), [true, true, false, true, true, true]);
        assert!(set.is_empty());
    }

    #[test]
    fn two_sets_have_modules_in_common_or_together() {
        let (one, other) = (Nodes::from([1, 40, 255]), Nodes::from([2, 40, 255]));
        assert_eq!(one.both(&other), Nodes::from([40, 255]));
        assert_eq!(one.either(&other), Nodes::from([1, 2, 40, 255]));
    }
}
