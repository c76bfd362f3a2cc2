//! The way through an addressing mode that an identifier shows.

use crate::address::{Address, Who};
use crate::{AddressType, Bits};

/// An identifier, and how its message travels. Generated code finds the addressing mode.
#[derive(Clone, Copy, Debug)]
pub struct Shown {
    id: u32,
    is_to_module: bool,
    answers: &'static [Option<Who>],
}

/// A way through an addressing mode, and how well an identifier fits it.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    id: u32,
    mode: usize,
    who: Option<Who>,
    is_fit: bool,
    is_documented: bool,
    constants: u8,
}

impl Shown {
    /// Returns the identifier of a message. `answers` says who answers it in each mode.
    pub const fn new(id: u32, is_to_module: bool, answers: &'static [Option<Who>]) -> Self {
        Self { id, is_to_module, answers }
    }

    /// Returns the way to a module in a mode, which is an index into [`Protocol::MODES`](crate::Protocol::MODES).
    #[inline(always)]
    pub fn request(&self, mode: usize) -> Way {
        self.way(mode, None, self.is_to_module && self.answer(mode).is_some())
    }

    /// Returns the way to the controller in a mode, of a frame that `who` sends.
    #[inline(always)]
    pub fn reply(&self, mode: usize, who: Who) -> Way {
        self.way(mode, Some(who), !self.is_to_module && self.answer(mode) == Some(who))
    }

    #[inline(always)]
    fn answer(&self, mode: usize) -> Option<Who> {
        self.answers.get(mode).copied().flatten()
    }

    #[inline(always)]
    const fn way(&self, mode: usize, who: Option<Who>, is_fit: bool) -> Way {
        Way { id: self.id, mode, who, is_fit, is_documented: true, constants: 0 }
    }
}

impl Way {
    /// Requires a value in a field.
    #[must_use]
    #[inline(always)]
    pub const fn id(self, bits: Bits, value: u32) -> Self {
        let constants = self.constants.wrapping_add(1);
        Self { is_fit: self.is_fit && bits.of(self.id) == value, constants, ..self }
    }

    /// Requires an address in a field: one that the document names, or one that is tolerated.
    #[must_use]
    #[inline(always)]
    pub fn address(self, address: &Address) -> Self {
        let is_documented = address.is_documented(self.id);
        let is_fit = self.is_fit && (is_documented || address.is_tolerated(self.id));
        Self { is_fit, is_documented: self.is_documented && is_documented, ..self }
    }

    /// Returns the way that fits best: first by documented addresses, then by the number of constants.
    #[inline(always)]
    pub fn best<const N: usize>(ways: [Self; N]) -> Option<Self> {
        let best = ways.into_iter().reduce(|best, next| if next.rank() > best.rank() { next } else { best });
        best.filter(|best| best.is_fit)
    }

    #[inline(always)]
    const fn rank(&self) -> (bool, bool, u8) {
        (self.is_fit, self.is_documented, self.constants)
    }

    /// Returns the mode, and who sends a frame to the controller.
    #[inline(always)]
    pub const fn place(&self) -> (usize, Option<Who>) {
        (self.mode, self.who)
    }

    /// Returns the number of an address in a field.
    #[inline(always)]
    pub const fn number(&self, bits: Bits, kind: &AddressType) -> i32 {
        kind.number(bits.of(self.id))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEVICE: Bits = Bits::new(15, 8);
    const TARGET: Bits = Bits::new(7, 0);
    const MODULE: AddressType = AddressType::new("module", 0, 0x3B);
    const GROUP: AddressType = AddressType::new("group", 0x40, 0x4F);
    const ANSWERS: &[Option<Who>] = &[Some(Who::One), Some(Who::Nobody), None];

    /// Returns the mode of a request to a module, to a group, and to all, which the message does not have.
    fn mode(id: u32) -> Option<usize> {
        let shown = Shown::new(id, true, ANSWERS);
        let module = shown.request(0).address(&Address::new(TARGET, &MODULE).excluding(&[(0xFF, 0xFF)]));
        let group = shown.request(1).address(&Address::new(TARGET, &GROUP).excluding(&[(0xFF, 0xFF)]));
        let all = shown.request(2).id(TARGET, 0xFF);
        let reply = shown.reply(0, Who::One);
        Way::best([module, group, all, reply]).map(|way| way.place().0)
    }

    #[test]
    fn a_documented_address_counts_more_than_a_tolerated_one() {
        assert_eq!([0x03, 0x41, 0x60].map(mode), [Some(0), Some(1), Some(0)]);
    }

    #[test]
    fn a_way_that_the_message_does_not_have_fits_no_identifier() {
        assert_eq!(mode(0xFF), None);
    }

    #[test]
    fn of_ways_with_documented_addresses_the_one_with_most_constants_fits_best() {
        let shown = Shown::new(0x0B03, false, ANSWERS);
        let narrow = shown.reply(0, Who::One).id(DEVICE, 0xB).address(&Address::new(TARGET, &MODULE));
        let wide = shown.reply(0, Who::One).address(&Address::new(TARGET, &MODULE));
        let best = |ways| Way::best(ways).map(|way| way.constants);
        assert_eq!((best([wide, narrow]), best([narrow, wide])), (Some(1), Some(1)));
        assert_eq!(best([narrow.id(TARGET, 4), wide]), Some(0));
        assert!(Way::best([shown.reply(1, Who::One), shown.request(0)]).is_none());
    }
}
