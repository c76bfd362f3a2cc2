//! Chooses between two entries that claim the same bits. The one that does not fit its neighbours
//! is probably wrong.

/// The bits that an entry claims, from `first` to `last`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Claim {
    pub first: u8,
    pub last: u8,
}

impl Claim {
    /// Claims the set bits of a mask, whose most significant bit is bit 0.
    pub fn of_mask(mask: u64) -> Self {
        let bit = |count: u32| u8::try_from(count).unwrap_or(u8::MAX);
        Self { first: bit(mask.leading_zeros()), last: bit(63_u32.saturating_sub(mask.trailing_zeros())) }
    }

    /// Tests whether the claim is 3, 5, 6 or 7 whole bytes. Numbers rarely have that width.
    fn has_rare_width(self) -> bool {
        self.width().is_multiple_of(8) && !self.width().is_power_of_two()
    }

    fn width(self) -> u8 {
        self.last - self.first + 1
    }
}

/// Returns which of two claims is probably wrong, `one` or `other`. The claims are in the order of
/// the file.
///
/// The first of these tests that tells them apart decides:
/// - its width is rare;
/// - it stands out of order;
/// - it has free bits beside it, but fewer than the other one, and may have been meant for them;
/// - its width is no power of two.
///
/// If no test decides, the later one is wrong.
pub fn misplaced(claims: &[Claim], one: usize, other: usize) -> usize {
    let (earlier, later) = (one.min(other), one.max(other));
    let free = |index: usize| Neighbours::of(claims, index, None).free(claims);
    let (before, after) = (free(earlier), free(later));
    let evidence: [&dyn Fn(usize, usize) -> bool; 4] = [
        &|index, _| claims[index].has_rare_width(),
        &|index, without| !Neighbours::of(claims, index, Some(without)).enclose(claims[index]),
        &|index, _| free(index) > 0 && (before == 0 || after == 0 || free(index) < before.max(after)),
        &|index, _| !claims[index].width().is_power_of_two(),
    ];
    let tells = |accuses: &&dyn Fn(usize, usize) -> bool| accuses(earlier, later) != accuses(later, earlier);
    match evidence.into_iter().find(tells) {
        Some(accuses) if accuses(earlier, later) => earlier,
        _ => later,
    }
}

/// The neighbours of a claim: the last bit of the one below, and the first bit of the one above.
struct Neighbours {
    below: Option<u8>,
    above: Option<u8>,
}

impl Neighbours {
    fn of(claims: &[Claim], index: usize, without: Option<usize>) -> Self {
        let others = |known: &(usize, &Claim)| Some(known.0) != without;
        let before = claims.iter().enumerate().take(index).rfind(others).map(|(_, claim)| *claim);
        let after = claims.iter().enumerate().skip(index + 1).find(others).map(|(_, claim)| *claim);
        let (below, above) = if ascends(claims) { (before, after) } else { (after, before) };
        Self { below: below.map(|claim| claim.last), above: above.map(|claim| claim.first) }
    }

    fn enclose(&self, claim: Claim) -> bool {
        self.below.is_none_or(|below| below < claim.first) && self.above.is_none_or(|above| claim.last < above)
    }

    /// Counts the bits between the two that nobody claims.
    fn free(&self, claims: &[Claim]) -> usize {
        let first = self.below.map_or(0, |below| below + 1);
        let between = first..self.above.unwrap_or(first);
        between.filter(|bit| !claims.iter().any(|claim| (claim.first..=claim.last).contains(bit))).count()
    }
}

fn ascends(claims: &[Claim]) -> bool {
    let rising = claims.windows(2).filter(|pair| pair[0].first < pair[1].first).count();
    let falling = claims.windows(2).filter(|pair| pair[0].first > pair[1].first).count();
    rising >= falling
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits(numbers: &[u8]) -> Vec<Claim> {
        numbers.iter().map(|number| Claim { first: *number, last: *number }).collect()
    }

    #[test]
    fn a_bit_that_stands_out_of_order_is_misplaced() {
        assert_eq!(misplaced(&bits(&[0, 1, 7, 3, 6, 7, 8]), 2, 5), 2);
        assert_eq!(misplaced(&bits(&[8, 7, 6, 3, 7, 1]), 1, 4), 4);
    }

    #[test]
    fn a_bit_beside_a_missing_one_is_misplaced() {
        assert_eq!(misplaced(&bits(&[0, 1, 3, 3, 4]), 2, 3), 2);
        assert_eq!(misplaced(&bits(&[0, 1, 2, 2, 4]), 2, 3), 3);
        assert_eq!(misplaced(&bits(&[7, 6, 5, 5, 3]), 2, 3), 3);
        assert_eq!(misplaced(&bits(&[7, 6, 4, 4, 3]), 2, 3), 2);
    }

    #[test]
    fn a_bit_beside_fewer_free_ones_is_misplaced() {
        assert_eq!(misplaced(&bits(&[1, 1, 4]), 0, 1), 0);
        assert_eq!(misplaced(&bits(&[3, 3, 5]), 0, 1), 1);
    }

    #[test]
    fn nine_bits_are_suspected_rather_than_eight() {
        let claims = [Claim { first: 7, last: 15 }, Claim { first: 0, last: 7 }];
        assert_eq!(misplaced(&claims, 0, 1), 0);
    }

    #[test]
    fn a_bit_above_a_free_one_is_misplaced_rather_than_the_field_it_hits() {
        let claims = [(29, 29), (25, 25), (23, 23), (16, 23), (8, 15)].map(|(first, last)| Claim { first, last });
        assert_eq!(misplaced(&claims, 2, 3), 2);
    }

    #[test]
    fn three_bytes_are_suspected_rather_than_two() {
        let claims = [Claim { first: 0, last: 23 }, Claim { first: 16, last: 31 }];
        assert_eq!(misplaced(&claims, 0, 1), 0);
        let claims = [Claim { first: 0, last: 15 }, Claim { first: 8, last: 31 }];
        assert_eq!(misplaced(&claims, 1, 0), 1);
    }

    #[test]
    fn without_evidence_the_later_one_is_misplaced() {
        assert_eq!(misplaced(&bits(&[0, 0]), 0, 1), 1);
    }

    #[test]
    fn a_mask_claims_its_bits_from_the_front() {
        assert_eq!(Claim::of_mask(0x00FF_0000_0000_0000), Claim { first: 8, last: 15 });
    }
}
