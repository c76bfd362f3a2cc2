//! Works out how an identifier shows whether a frame goes to a module or to the controller.

use crate::model::{
    AddressPattern, AddressType, AddressTypeId, Direction, Directions, FieldId, FieldTest, Identifier, Mode, ModeId,
    Table, Way, exclude,
};

/// The kinds of addresses.
type AddressTypes = Table<AddressTypeId, AddressType>;

/// A way, what it shows, and the tests by which it shows its direction.
struct Known<'a> {
    way: Way,
    pattern: &'a AddressPattern,
    tests: Vec<FieldTest>,
}

/// Works out how identifiers show their direction, to a module and to the controller.
///
/// A constant counts only if the other direction has another constant in the same field. So an
/// unknown device number does not hide the direction. If two patterns still look alike, all
/// constants in which they differ count. If even these do not tell, all constants count, and the
/// messages must tell the rest.
pub fn directions(identifier: &Identifier, types: &AddressTypes, modes: &Table<ModeId, Mode>) -> Directions {
    let (requests, replies): (Vec<_>, Vec<_>) = Way::all(modes).partition(|(way, _)| way.is_to_module());
    let tests = |pattern, others: &[_]| direction_tests(pattern, others, identifier, types, modes);
    let known = |(way, pattern), others| Known { way, pattern, tests: tests(pattern, others) };
    let mut to_module: Vec<_> = requests.iter().map(|request| known(*request, &replies)).collect();
    let mut to_controller: Vec<_> = replies.iter().map(|reply| known(*reply, &requests)).collect();
    for one in &mut to_module {
        for other in &mut to_controller {
            if !exclude(&one.tests, &other.tests) {
                let differing = one.pattern.mask & other.pattern.mask & (one.pattern.value ^ other.pattern.value);
                one.add_constants(identifier, differing);
                other.add_constants(identifier, differing);
            }
        }
    }
    let open = alike(&to_module, &to_controller);
    for known in to_module.iter_mut().chain(&mut to_controller) {
        if open.iter().any(|(one, other)| [*one, *other].contains(&known.way)) {
            known.add_constants(identifier, known.pattern.mask);
        }
    }
    let alike = alike(&to_module, &to_controller);
    Directions { to_module: towards(to_module), to_controller: towards(to_controller), alike }
}

impl Known<'_> {
    /// Adds tests of the constants in the fields that have some of these bits.
    fn add_constants(&mut self, identifier: &Identifier, bits: u32) {
        for (id, field) in identifier.fields.entries().filter(|(_, field)| bits & field.mask() != 0) {
            let test = FieldTest::constant(id, field.get(self.pattern.value));
            if !self.tests.contains(&test) {
                self.tests.push(test);
            }
        }
    }
}

/// Returns the ways that one identifier can show, to a module and to the controller.
fn alike(requests: &[Known], replies: &[Known]) -> Vec<(Way, Way)> {
    let pairs = requests.iter().flat_map(|one| replies.iter().map(move |other| (one, other)));
    let alike = pairs.filter(|(one, other)| !exclude(&one.tests, &other.tests));
    alike.map(|(one, other)| (one.way, other.way)).collect()
}

/// Joins the lists of tests of one direction, without those that another list includes.
fn towards(ways: Vec<Known>) -> Direction {
    let mut any: Vec<Vec<FieldTest>> = Vec::new();
    for Known { tests, .. } in ways {
        if !any.iter().any(|known| known.iter().all(|test| tests.contains(test))) {
            any.retain(|known| !tests.iter().all(|test| known.contains(test)));
            any.push(tests);
        }
    }
    Direction { any }
}

fn direction_tests(
    pattern: &AddressPattern,
    others: &[(Way, &AddressPattern)],
    identifier: &Identifier,
    types: &AddressTypes,
    modes: &Table<ModeId, Mode>,
) -> Vec<FieldTest> {
    let mut tests = Vec::new();
    for (id, field) in identifier.fields.entries() {
        let address = pattern.addresses.iter().find(|address| address.field == id);
        let address = address.map(|address| &types[address.address_type]);
        let value = (pattern.mask & field.mask() != 0).then(|| field.get(pattern.value));
        let is_telling = || others.iter().all(|(_, other)| differs(pattern, other, field.mask()));
        let claimed = without(strict_ranges(id, types, modes), value);
        if let Some(strict) = address.filter(|known| known.strict) {
            tests.push(FieldTest { field: id, ranges: strict.raw_ranges(), inside: true });
        } else if let Some(value) = value.filter(|_| is_telling()) {
            tests.push(FieldTest::constant(id, value));
        } else if (address.is_some() || value.is_some()) && !claimed.is_empty() {
            tests.push(FieldTest { field: id, ranges: claimed, inside: false });
        }
    }
    tests
}

/// Tests whether the patterns have different constants in the field.
fn differs(one: &AddressPattern, other: &AddressPattern, field: u32) -> bool {
    other.mask & field != 0 && (one.value ^ other.value) & field != 0
}

/// Returns ranges without a value.
fn without(ranges: Vec<(u32, u32)>, value: Option<u32>) -> Vec<(u32, u32)> {
    let Some(value) = value else { return ranges };
    let rest = |(first, last): (u32, u32)| {
        let before = value.checked_sub(1).map(|before| (first, last.min(before)));
        let after = value.checked_add(1).map(|after| (first.max(after), last));
        before.into_iter().chain(after).filter(|(first, last)| first <= last)
    };
    ranges.into_iter().flat_map(rest).collect()
}

fn strict_ranges(field: FieldId, types: &AddressTypes, modes: &Table<ModeId, Mode>) -> Vec<(u32, u32)> {
    let patterns = modes.iter().flat_map(|mode| [&mode.request, &mode.one, &mode.each, &mode.coordinator]);
    let addresses = patterns.flatten().flat_map(|pattern| &pattern.addresses).filter(|address| address.field == field);
    let strict = addresses.map(|address| &types[address.address_type]).filter(|known| known.strict);
    let mut ranges: Vec<_> = strict.flat_map(AddressType::raw_ranges).collect();
    ranges.sort_unstable();
    ranges.dedup();
    ranges
}
