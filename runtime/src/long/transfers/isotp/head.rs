//! The constants at the beginning of the joined data, which show the message.

use super::super::is_to_module;
use super::{Ends, Filled};
use crate::{Data, Exchange, Filter, Frame, Kind, Protocol};

/// Bits at the beginning of the joined data, and their value.
#[derive(Clone, Copy, Debug)]
pub struct Head {
    mask: u64,
    value: u64,
}

impl Head {
    /// Returns the constants and the fields of the header that frames show.
    pub fn of(filter: &Filter) -> Self {
        let word = |data: Data| u64::from_be_bytes(data);
        let fields = filter.data_selectors().iter().map(|selector| word(selector.place.mask()));
        let mask = fields.fold(word(filter.data_mask()), |mask, field| mask | field);
        Self { mask, value: word(filter.data_value()) & mask }
    }

    /// Returns how many bytes reach to its last bit.
    pub fn length(self) -> usize {
        8_usize.saturating_sub(usize::try_from(self.mask.trailing_zeros() / 8).unwrap_or(8))
    }

    /// Writes it to the front of the data.
    pub fn write(self, data: &mut [u8]) {
        let bytes = self.mask.to_be_bytes().into_iter().zip(self.value.to_be_bytes());
        data.iter_mut().zip(bytes).for_each(|(byte, (mask, value))| *byte = *byte & !mask | value);
    }
}

/// A message that the transport carries: how it travels, what for, and its constants.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    pub exchange: &'static Exchange,
    pub kind: Kind,
    pub head: Head,
    filter: Filter,
}

impl Carried {
    /// Finds the message whose `size` data bytes begin so, as far as they came. `id` is the identifier of its frames, and says whether they
    /// go to a module. It is one of the device model, if there is one.
    pub fn find<T: Filled>(
        (id, is_to_module): (u32, bool),
        data: &[u8],
        size: usize,
        model: Option<u8>,
    ) -> Option<Self> {
        let mut shown = T::CARRIES.iter().filter_map(|(exchange, kind)| {
            let filter = exchange.filter(*kind)?;
            let is_shown = exchange.is_to_module::<T::Protocol>(*kind) == is_to_module
                && filter.matches_id(id)
                && begins(&filter, data);
            let known = Self { exchange, kind: *kind, head: Head::of(&filter), filter };
            (is_shown && known.head.length() <= size).then_some(known)
        });
        shown.clone().find(|known| known.exchange.is_of(model)).or_else(|| shown.next())
    }

    /// Finds the message that a blank frame is of.
    pub fn of_blank<T: Filled>(blank: &Frame) -> Option<Self> {
        let id = blank.raw_id();
        let is_own = embedded_can::Frame::is_extended(blank) == T::Protocol::FRAME.is_extended();
        Self::find::<T>((id, is_to_module::<T>(id)), &blank.bytes(), 8, None).filter(|_| is_own)
    }

    /// Returns who sends it under an identifier.
    pub fn ends<T: Filled>(&self, id: u32) -> Ends {
        let is_to_module = self.exchange.is_to_module::<T::Protocol>(self.kind);
        Ends::new(id, is_to_module, self.exchange.addressing::<T::Protocol>(self.kind, id))
    }

    /// Returns the identifier of the receiver's answer, if an addressing mode has one.
    pub fn answer<T: Filled>(&self, ends: &Ends) -> Option<u32> {
        let mut others = [Kind::Request, Kind::Reply, Kind::Report]
            .into_iter()
            .filter(|kind| self.exchange.is_to_module::<T::Protocol>(*kind) != ends.is_to_module());
        let filter = others.find_map(|kind| self.exchange.filter(kind)).unwrap_or(self.filter);
        ends.answer_in(T::Protocol::MODES, filter.sent_id())
    }
}

/// Tests whether data bytes are those of a frame. What did not come is as it has to be.
fn begins(filter: &Filter, data: &[u8]) -> bool {
    let mut head = filter.data_value();
    head.iter_mut().zip(data).for_each(|(place, byte)| *place = *byte);
    filter.matches_data(&head)
}
