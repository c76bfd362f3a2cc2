//! How many data bytes long messages have.

use crate::model::{ByteRun, FrameLayout, LongMessage, Signal, SignalId, Varying};

/// What frames of a long message carry together.
#[derive(Clone, Copy, Debug)]
pub struct Extent<'a> {
    long: &'a LongMessage,
    /// What the message would be as one frame; `None` for all that it can carry.
    layout: Option<&'a FrameLayout>,
}

impl LongMessage {
    /// Returns all that it can carry.
    pub fn whole(&self) -> Extent<'_> {
        Extent { long: self, layout: None }
    }

    /// Returns what it carries if it is sent as one of its layouts.
    pub fn extent<'a>(&'a self, layout: &'a FrameLayout) -> Extent<'a> {
        Extent { long: self, layout: Some(layout) }
    }
}

impl<'a> Extent<'a> {
    /// Returns the message.
    pub fn long(self) -> &'a LongMessage {
        self.long
    }

    /// Returns the signals that are there.
    pub fn signals(self) -> impl Iterator<Item = (SignalId, &'a Signal)> + Clone {
        let is_there = move |id: SignalId| self.layout.is_none_or(|layout| layout.signals.contains(&id));
        self.long.content.signals.entries().filter(move |(id, _)| is_there(*id))
    }

    /// Returns how many bytes the constants and fields of the header need, which stand first.
    pub fn head(self) -> usize {
        let layouts = self.long.frames.iter().filter(|known| self.layout.is_none_or(|layout| known.is_kind_of(layout)));
        layouts.map(FrameLayout::head).max().unwrap_or(0)
    }

    /// Returns the bits of constants and fields of the header, byte 0 highest.
    pub fn header(self) -> u64 {
        self.layout.map_or(0, |layout| layout.covered)
    }

    /// Returns the numbers of data bytes that it can have, if the spec lists them.
    pub fn lengths(self) -> &'a [u16] {
        if self.signals().next().is_some() { &self.long.lengths } else { &[] }
    }

    /// Returns the greatest number of data bytes.
    pub fn longest(self) -> usize {
        self.lengths().last().map_or_else(|| self.bytes_with(None), |length| usize::from(*length))
    }

    /// Returns the least number of data bytes.
    pub fn shortest(self) -> usize {
        let of_signals = || self.bytes_with(self.varying().map(|field| field.least));
        self.lengths().first().map_or_else(of_signals, |length| usize::from(*length))
    }

    /// Tests whether it can have some number of data bytes.
    pub fn has_length(self, length: usize) -> bool {
        match self.varying().filter(|_| self.lengths().is_empty()) {
            Some(field) => self
                .elements_in(length)
                .is_some_and(|count| count >= field.least && self.bytes_with(Some(count)) == length),
            None => self.all_lengths().contains(&length),
        }
    }

    /// Says how many data bytes it has if it cannot have `length`: `9 or 11`, `5 to 40`, or `3, 5, ... 33`.
    pub fn other_lengths(self, length: usize) -> Option<String> {
        if self.has_length(length) {
            return None;
        }
        let lengths = self.all_lengths();
        Some(match lengths.as_slice() {
            [first, _, .., last] if last - first == lengths.len() - 1 => format!("{first} to {last}"),
            [first, second, _, .., last] => format!("{first}, {second}, ... {last}"),
            few => few.iter().map(usize::to_string).collect::<Vec<_>>().join(" or "),
        })
    }

    /// Returns the numbers of data bytes that it can have, the least first.
    fn all_lengths(self) -> Vec<usize> {
        let mut lengths: Vec<_> = match (self.lengths(), self.varying()) {
            ([], Some(field)) => (field.least..=field.most).map(|count| self.bytes_with(Some(count))).collect(),
            ([], None) => vec![self.longest()],
            (listed, _) => listed.iter().map(|length| usize::from(*length)).collect(),
        };
        lengths.dedup();
        lengths
    }

    /// Returns how many elements the field of varying length has in some number of data bytes.
    pub fn elements_in(self, length: usize) -> Option<usize> {
        let field = self.varying()?;
        // More elements never take fewer bytes.
        let (mut fitting, mut beyond) = (0, field.most + 1);
        while fitting < beyond {
            let middle = usize::midpoint(fitting, beyond);
            if self.bytes_with(Some(middle)) <= length {
                fitting = middle + 1;
            } else {
                beyond = middle;
            }
        }
        fitting.checked_sub(1)
    }

    /// Returns how many data bytes it has with some number of elements in fields of varying length, or with all.
    pub fn bytes_with(self, elements: Option<usize>) -> usize {
        self.reach(elements).max(self.head())
    }

    /// Returns how many data bytes reach to the end of its signals with some number of elements, or with all.
    pub fn reach(self, elements: Option<usize>) -> usize {
        let present = self.signals().filter(|(_, signal)| self.long.is_among(elements, signal));
        present.map(|(_, signal)| signal.reach_with(elements)).max().unwrap_or(0)
    }

    /// Returns the first field whose length varies, if there is one. Others vary with it.
    pub fn varying(self) -> Option<Varying<'a>> {
        let is_there = |name: &str| self.signals().any(|(_, signal)| self.long.content.field_name(signal) == name);
        self.long.varying().filter(|field| is_there(field.name))
    }

    /// Returns the text whose length varies, if there is one.
    pub fn open_text(self) -> Option<(&'a Signal, ByteRun)> {
        let mut texts = self.signals().filter_map(|(_, signal)| Some((signal, signal.run?)));
        texts.find(|(_, run)| run.varies())
    }
}
