//! The messages in parts that have begun, however many devices send at a time.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::mem;

use super::Transfer;
use crate::interpret::assembled::Peers;
use crate::model::{LongMessageId, Side};

/// Which message it is, between which peers, and who sends it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Link {
    pub long: LongMessageId,
    pub peers: Peers,
    pub sender: Side,
}

/// Transfers by number. One that begins later has a greater number.
#[derive(Clone, Debug, PartialEq)]
pub struct Begun<M> {
    /// Each has its own memory, since a map takes room for eleven at once.
    transfers: BTreeMap<usize, Box<Transfer<M>>>,
    numbers: HashMap<Link, usize>,
    /// When silence ends transfers.
    deadlines: BTreeSet<(u64, usize)>,
}

impl<M> Default for Begun<M> {
    fn default() -> Self {
        Self { transfers: BTreeMap::new(), numbers: HashMap::new(), deadlines: BTreeSet::new() }
    }
}

impl<M> Begun<M> {
    /// Returns the number of the transfer of a link.
    pub fn number(&self, link: &Link) -> Option<usize> {
        self.numbers.get(link).copied()
    }

    /// Returns all transfers with their numbers, in order.
    pub fn entries(&self) -> impl Iterator<Item = (usize, &Transfer<M>)> {
        self.transfers.iter().map(|(number, transfer)| (*number, &**transfer))
    }

    pub fn get(&self, number: usize) -> Option<&Transfer<M>> {
        self.transfers.get(&number).map(Box::as_ref)
    }

    pub fn get_mut(&mut self, number: usize) -> Option<&mut Transfer<M>> {
        self.transfers.get_mut(&number).map(Box::as_mut)
    }

    /// Begins a transfer, and returns its number.
    pub fn begin(&mut self, transfer: Transfer<M>) -> usize {
        let number = self.transfers.last_key_value().map_or(0, |(last, _)| last + 1);
        self.numbers.insert(transfer.link.clone(), number);
        self.transfers.insert(number, Box::new(transfer));
        number
    }

    /// Sets when silence ends a transfer, in nanoseconds.
    pub fn wait(&mut self, number: usize, deadline: Option<u64>) {
        let Some(transfer) = self.transfers.get_mut(&number) else { return };
        if let Some(before) = mem::replace(&mut transfer.deadline, deadline) {
            self.deadlines.remove(&(before, number));
        }
        self.deadlines.extend(deadline.map(|deadline| (deadline, number)));
    }

    /// Returns the numbers of transfers that silence has ended, in order.
    pub fn silent(&self, now: u64) -> Vec<usize> {
        let due = self.deadlines.range(..=(now, usize::MAX));
        let mut numbers: Vec<_> = due.map(|(_, number)| *number).collect();
        numbers.sort_unstable();
        numbers
    }

    /// Takes out a transfer.
    pub fn end(&mut self, number: usize) -> Option<Transfer<M>> {
        self.wait(number, None);
        let transfer = self.transfers.remove(&number)?;
        self.numbers.remove(&transfer.link);
        Some(*transfer)
    }
}
