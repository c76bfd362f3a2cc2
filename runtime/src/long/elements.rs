//! Arrays whose number of elements varies.

use core::array;
use core::fmt;
use core::hash::{Hash, Hasher};
use core::ops::{Deref, DerefMut};

/// Up to `N` elements of an array. It is used like a slice.
///
/// ```
/// use canspec_runtime::Elements;
///
/// let voltages = Elements::<f64, 16>::from_slice(&[3.301, 3.299]).expect("there is room for them");
/// assert_eq!(voltages.len(), 2);
/// assert_eq!(voltages.iter().sum::<f64>(), 6.6);
/// assert_eq!(voltages.first(), Some(&3.301));
/// ```
#[derive(Clone, Copy)]
pub struct Elements<T, const N: usize> {
    /// The elements. What stands behind them does not count.
    values: [T; N],
    length: usize,
}

impl<T, const N: usize> Elements<T, N> {
    /// Returns the first elements, each by its place, which counts from 0. There are at most `N`.
    pub fn from_fn(length: usize, element: impl FnMut(usize) -> T) -> Self {
        Self { values: array::from_fn(element), length: length.min(N) }
    }
}

impl<T: Copy, const N: usize> Elements<T, N> {
    /// Returns what a function makes of each element.
    #[must_use]
    pub fn map<U>(self, element: impl FnMut(T) -> U) -> Elements<U, N> {
        Elements { values: self.values.map(element), length: self.length }
    }

    /// Returns the elements as an array; `None` if there are fewer than `N`.
    pub fn whole(&self) -> Option<[T; N]> {
        (self.length == N).then_some(self.values)
    }

    /// Returns the elements of a slice; `None` if it has none, or more than `N`.
    pub fn from_slice(elements: &[T]) -> Option<Self> {
        let first = *elements.first()?;
        let element = |index| elements.get(index).copied().unwrap_or(first);
        (elements.len() <= N).then(|| Self::from_fn(elements.len(), element))
    }
}

impl<T, const N: usize> From<[T; N]> for Elements<T, N> {
    fn from(values: [T; N]) -> Self {
        Self { values, length: N }
    }
}

impl<T, const N: usize> Deref for Elements<T, N> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        self.values.get(..self.length).unwrap_or(&self.values)
    }
}

impl<T, const N: usize> DerefMut for Elements<T, N> {
    fn deref_mut(&mut self) -> &mut [T] {
        let length = self.length.min(N);
        self.values.get_mut(..length).unwrap_or_default()
    }
}

impl<'a, T, const N: usize> IntoIterator for &'a Elements<T, N> {
    type Item = &'a T;
    type IntoIter = core::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T: fmt::Debug, const N: usize> fmt::Debug for Elements<T, N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(formatter)
    }
}

impl<T: PartialEq, const N: usize> PartialEq for Elements<T, N> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: Eq, const N: usize> Eq for Elements<T, N> {}

impl<T: Hash, const N: usize> Hash for Elements<T, N> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (**self).hash(state);
    }
}

#[cfg(test)]
mod tests {
    use std::format;

    use super::*;

    #[test]
    fn what_stands_behind_the_elements_does_not_count() {
        let [one, other] = [7, 8].map(|rest| Elements::<u8, 3>::from_fn(2, |index| if index < 2 { 5 } else { rest }));
        assert_eq!((one, format!("{one:?}")), (other, "[5, 5]".into()));
        assert_ne!(one, Elements::from([5, 5, 7]));
    }

    #[test]
    fn there_are_never_more_elements_than_room() {
        let mut elements = Elements::<usize, 2>::from_fn(9, |index| index);
        assert_eq!(*elements, [0, 1]);
        elements.iter_mut().for_each(|element| *element += 1);
        assert_eq!(elements, Elements::from([1, 2]));
        assert_eq!(Elements::<u8, 2>::from_slice(&[1, 2, 3]), None);
        assert_eq!(Elements::<u8, 2>::from_slice(&[]), None);
        assert_eq!(Elements::<u8, 2>::from_slice(&[4]).as_deref(), Some(&[4][..]));
    }
}
