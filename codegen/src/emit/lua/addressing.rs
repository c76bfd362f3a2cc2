//! Writes identifiers: their constants, directions, addresses and modes.

use super::table::Value;
use crate::model::{Address, AddressPattern, AddressType, Direction, FieldTest, Foreign, Mode, Who};

/// Returns the runs of bits that are constant, with their values.
pub fn constants(mask: u32, value: u32) -> Value {
    Value::list(runs(mask), |(shift, width)| {
        let ones = u32::MAX >> (32 - width);
        Value::record()
            .with("shift", Value::number(shift))
            .with("width", Value::number(width))
            .with("value", Value::hexadecimal(value >> shift & ones))
    })
}

/// Returns the runs of ones in a mask, as shift and width, the lowest first.
fn runs(mask: u32) -> Vec<(u32, u32)> {
    let mut runs = Vec::new();
    let mut shift = 0;
    while let Some(rest) = mask.checked_shr(shift).filter(|rest| *rest != 0) {
        let start = shift + rest.trailing_zeros();
        let width = (mask >> start).trailing_ones();
        runs.push((start, width));
        shift = start + width;
    }
    runs
}

pub fn foreign(foreign: &Foreign) -> Value {
    Value::list(&foreign.ranges, |(field, first, last)| {
        Value::record()
            .maybe("field", field.map(Value::id))
            .with("first", Value::hexadecimal(*first))
            .with("last", Value::hexadecimal(*last))
    })
}

pub fn direction(direction: &Direction) -> Value {
    let test = |test: &FieldTest| {
        Value::record()
            .with("field", Value::id(test.field))
            .with("ranges", ranges(&test.ranges))
            .with("inside", Value::flag(test.inside))
    };
    Value::list(&direction.any, |tests| Value::list(tests, test))
}

fn ranges(ranges: &[(u32, u32)]) -> Value {
    Value::list(ranges, |(first, last)| Value::list([*first, *last], Value::hexadecimal))
}

/// Returns an address type with the documented raw values.
pub fn address_type(known: &AddressType) -> Value {
    Value::record()
        .with("name", Value::text(&known.name))
        .with("ranges", ranges(&known.raw_ranges()))
        .maybe("strict", known.strict.then(|| Value::flag(true)))
        .maybe("sent", known.send.is_some().then(|| Value::flag(true)))
}

pub fn mode(mode: &Mode) -> Value {
    Value::record()
        .with("name", Value::text(&mode.name))
        .maybe("request", mode.request.as_ref().map(pattern))
        .maybe("one", mode.one.as_ref().map(pattern))
        .maybe("each", mode.each.as_ref().map(pattern))
        .maybe("coordinator", mode.coordinator.as_ref().map(pattern))
}

fn pattern(pattern: &AddressPattern) -> Value {
    Value::record()
        .with("constants", constants(pattern.mask, pattern.value))
        .with("constant_fields", Value::Plain(pattern.constants.to_string()))
        .with("addresses", Value::list(&pattern.addresses, address))
}

fn address(address: &Address) -> Value {
    Value::record()
        .with("field", Value::id(address.field))
        .with("type", Value::id(address.address_type))
        .with("excluded", ranges(&address.excluded))
}

/// Returns the word that says who answers.
pub fn who(who: Who) -> &'static str {
    match who {
        Who::One => "one",
        Who::Each => "each",
        Who::Coordinator => "coordinator",
        Who::Nobody => "nobody",
    }
}

#[cfg(test)]
mod tests {
    use super::runs;

    #[test]
    fn a_mask_is_its_runs_of_ones() {
        assert_eq!(runs(0), []);
        assert_eq!(runs(0b0110_1000), [(3, 1), (5, 2)]);
        assert_eq!(runs(0x8000_0001), [(0, 1), (31, 1)]);
        assert_eq!(runs(u32::MAX), [(0, 32)]);
    }
}
