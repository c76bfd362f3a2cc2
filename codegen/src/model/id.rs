//! Ids of the model's tables. The id of one table cannot find a row of another.

use serde::{Deserialize, Serialize};

use std::fmt::Debug;
use std::hash::Hash;
use std::iter::{Enumerate, FusedIterator};
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut, Index, IndexMut};
use std::slice;

use super::{
    Access, AddressType, Array, DeviceModel, Enumeration, Exchange, FrameLayout, IdentifierField, LongMessage, Message,
    Mode, Protocol, Selector, Signal, StatusWord, Timing, Transport,
};

/// The place of a row in its table.
pub trait Id: Copy + Debug + Ord + Hash {
    /// Makes the id of the row at a place.
    fn new(place: usize) -> Self;

    /// Returns the place of the row.
    fn place(self) -> usize;
}

macro_rules! define_ids {
    ($($(#[$doc:meta])* $name:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        pub struct $name(u32);

        impl Id for $name {
            fn new(place: usize) -> Self {
                Self(u32::try_from(place).unwrap_or(u32::MAX))
            }

            fn place(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

define_ids! {
    /// A message of [`Protocol::messages`].
    MessageId;
    /// An access of [`Protocol::accesses`].
    AccessId;
    /// An addressing mode of [`Protocol::modes`].
    ModeId;
    /// A kind of address of [`Protocol::address_types`].
    AddressTypeId;
    /// A field of [`Identifier::fields`](super::Identifier::fields).
    FieldId;
    /// A selector of [`Protocol::selectors`].
    SelectorId;
    /// Named values of [`Protocol::enumerations`].
    EnumerationId;
    /// A status word of [`Protocol::status_words`].
    StatusWordId;
    /// A device model of [`Protocol::models`].
    ModelId;
    /// A time of [`Protocol::timing`].
    TimingId;
    /// A signal of [`Message::signals`].
    SignalId;
    /// An array of [`Message::arrays`].
    ArrayId;
    /// A part of a packed value.
    PartId;
    /// A way in which a message travels, of [`Message::exchanges`].
    ExchangeId;
    /// A kind of frame of [`Protocol::frames`].
    FrameId;
    /// What the parts of a message say together, of [`Protocol::long_messages`].
    LongMessageId;
    /// A transport of [`Protocol::transports`].
    TransportId;
}

macro_rules! impl_index {
    ($($id:ident: $($table:ident).+ of $owner:ident is $row:ident;)*) => {$(
        impl Index<$id> for $owner {
            type Output = $row;

            #[inline]
            fn index(&self, id: $id) -> &$row {
                &self.$($table).+[id]
            }
        }
    )*};
}

impl_index! {
    MessageId: messages of Protocol is Message;
    AccessId: accesses of Protocol is Access;
    ModeId: modes of Protocol is Mode;
    AddressTypeId: address_types of Protocol is AddressType;
    FieldId: identifier.fields of Protocol is IdentifierField;
    SelectorId: selectors of Protocol is Selector;
    EnumerationId: enumerations of Protocol is Enumeration;
    StatusWordId: status_words of Protocol is StatusWord;
    ModelId: models of Protocol is DeviceModel;
    TimingId: timing of Protocol is Timing;
    FrameId: frames of Protocol is FrameLayout;
    LongMessageId: long_messages of Protocol is LongMessage;
    TransportId: transports of Protocol is Transport;
    SignalId: signals of Message is Signal;
    ArrayId: arrays of Message is Array;
    ExchangeId: exchanges of Message is Exchange;
}

/// Rows with an id type of their own.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent, bound(serialize = "T: Serialize", deserialize = "T: Deserialize<'de>"))]
pub struct Table<I, T> {
    rows: Vec<T>,
    ids: PhantomData<fn() -> I>,
}

impl<I: Id, T> Table<I, T> {
    /// Adds a row and returns its id.
    pub fn push(&mut self, row: T) -> I {
        self.rows.push(row);
        I::new(self.rows.len() - 1)
    }

    /// Returns the row of an id.
    pub fn get(&self, id: I) -> Option<&T> {
        self.rows.get(id.place())
    }

    /// Returns the ids of all rows, in order.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = I> + ExactSizeIterator + Clone + use<I, T> {
        (0..self.rows.len()).map(I::new)
    }

    /// Returns all rows with their ids, in order.
    pub fn entries(&self) -> Entries<'_, I, T> {
        Entries { rows: self.rows.iter().enumerate(), ids: PhantomData }
    }

    /// Finds the first row that passes a test.
    pub fn position(&self, test: impl FnMut(&T) -> bool) -> Option<I> {
        self.rows.iter().position(test).map(I::new)
    }

    /// Makes a table with the same ids.
    pub fn map<U>(&self, row: impl FnMut(&T) -> U) -> Table<I, U> {
        self.rows.iter().map(row).collect()
    }
}

/// The rows of a table with their ids.
#[derive(Debug)]
pub struct Entries<'a, I, T> {
    rows: Enumerate<slice::Iter<'a, T>>,
    ids: PhantomData<fn() -> I>,
}

impl<I, T> Clone for Entries<'_, I, T> {
    fn clone(&self) -> Self {
        Self { rows: self.rows.clone(), ids: PhantomData }
    }
}

impl<'a, I: Id, T> Iterator for Entries<'a, I, T> {
    type Item = (I, &'a T);

    fn next(&mut self) -> Option<Self::Item> {
        self.rows.next().map(|(place, row)| (I::new(place), row))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.rows.size_hint()
    }
}

impl<I: Id, T> FusedIterator for Entries<'_, I, T> {}

impl<I, T> Default for Table<I, T> {
    fn default() -> Self {
        Self { rows: Vec::new(), ids: PhantomData }
    }
}

impl<I, T> FromIterator<T> for Table<I, T> {
    fn from_iter<S: IntoIterator<Item = T>>(rows: S) -> Self {
        Self { rows: rows.into_iter().collect(), ids: PhantomData }
    }
}

impl<I, T> Deref for Table<I, T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.rows
    }
}

impl<I, T> DerefMut for Table<I, T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.rows
    }
}

impl<I: Id, T> Index<I> for Table<I, T> {
    type Output = T;

    fn index(&self, id: I) -> &T {
        &self.rows[id.place()]
    }
}

impl<I: Id, T> IndexMut<I> for Table<I, T> {
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.rows[id.place()]
    }
}

impl<'a, I, T> IntoIterator for &'a Table<I, T> {
    type Item = &'a T;
    type IntoIter = slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.rows.iter()
    }
}

impl<I, T> IntoIterator for Table<I, T> {
    type Item = T;
    type IntoIter = std::vec::IntoIter<T>;

    fn into_iter(self) -> Self::IntoIter {
        self.rows.into_iter()
    }
}
