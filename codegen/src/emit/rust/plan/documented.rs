//! How the requests of each addressing mode show documented addresses only.

use proc_macro2::Ident;

use super::comparison::{Comparison, Range, field_place, range};
use crate::model::{AddressPattern, FieldId, Protocol};

/// How many modes have a bit. The runtime works the others out from their patterns.
const BITS: usize = 8;

/// The modes whose requests no other mode before them has too.
pub struct Documented {
    /// What requests of each mode show.
    pub common: Vec<Comparison>,
    /// Places of the fields that tell the modes apart.
    pub fields: Vec<Ident>,
    /// What requests of the modes show.
    pub modes: Vec<Shown>,
}

/// What requests of a mode show besides.
pub struct Shown {
    /// The number of the mode.
    pub mode: usize,
    /// The values of each field. Any will do if there are none.
    pub ranges: Vec<Vec<Range>>,
}

/// The fields that a pattern looks at, and their values.
type Values = Vec<(FieldId, Vec<(u32, u32)>)>;

impl Documented {
    /// Plans the modes of a protocol.
    pub fn new(protocol: &Protocol) -> Self {
        let requests = protocol.modes.iter().map(|mode| mode.request.as_ref()).enumerate().take(BITS);
        let requests = requests.filter_map(|(mode, request)| Some((mode, values(protocol, request?))));
        let requests = requests.fold(Vec::new(), |mut known: Vec<(usize, Values)>, (mode, values)| {
            if known.iter().all(|(_, other)| excludes(other, &values)) {
                known.push((mode, values));
            }
            known
        });
        let is_read = |id: &FieldId| requests.iter().any(|(_, values)| values.iter().any(|(field, _)| field == id));
        let is_common = |id: &FieldId| requests.windows(2).all(|pair| of(*id, &pair[0].1).eq(of(*id, &pair[1].1)));
        let (common, own): (Vec<_>, Vec<_>) = protocol.identifier.fields.ids().filter(is_read).partition(is_common);
        let place = |field: &FieldId| field_place(protocol, *field).0;
        let comparison = |field: &FieldId| Comparison {
            place: Some(place(field)),
            inside: true,
            ranges: ranges(protocol, *field, &requests[0].1),
        };
        let shown = |(mode, values): &(usize, Values)| Shown {
            mode: *mode,
            ranges: own.iter().map(|field| ranges(protocol, *field, values)).collect(),
        };
        Self {
            common: common.iter().map(comparison).collect(),
            fields: own.iter().map(place).collect(),
            modes: requests.iter().map(shown).collect(),
        }
    }
}

/// Returns what a pattern requires of each field that it looks at, with the addresses that the document names.
fn values(protocol: &Protocol, pattern: &AddressPattern) -> Values {
    let fields = protocol.identifier.fields.entries().filter(|(_, field)| pattern.mask & field.mask() != 0);
    let constants =
        fields.map(|(id, field)| (id, field.get(pattern.value))).map(|(id, value)| (id, vec![(value, value)]));
    let addresses = pattern.addresses.iter().map(|known| (known.field, protocol[known.address_type].raw_ranges()));
    constants.chain(addresses).collect()
}

/// Tests whether no identifier shows both.
fn excludes(one: &Values, other: &Values) -> bool {
    let is_apart = |ranges: &[(u32, u32)], others: &[(u32, u32)]| {
        ranges.iter().all(|(first, last)| others.iter().all(|(start, end)| last < start || end < first))
    };
    one.iter().any(|(field, ranges)| other.iter().any(|(known, others)| field == known && is_apart(ranges, others)))
}

fn ranges(protocol: &Protocol, field: FieldId, values: &Values) -> Vec<Range> {
    let width = protocol[field].width;
    of(field, values).map(|ends| range(*ends, width)).collect()
}

/// Returns the values that a pattern requires of a field.
fn of(field: FieldId, values: &Values) -> impl Iterator<Item = &(u32, u32)> {
    values.iter().filter(move |(known, _)| *known == field).flat_map(|(_, ranges)| ranges)
}
