#![doc = include_str!("../rules/direction.md")]

use std::collections::{BTreeSet, HashSet};

use indexmap::IndexMap;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Address, AddressPattern, FieldId, FrameLayout, Mode, ModeId, Protocol, Who, exclude};
use crate::rule::rules;
use crate::syntax::tree::Path;

rules! {
    DIRECTION "direction" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let (to_module, to_controller) = (&protocol.recognition.to_module, &protocol.recognition.to_controller);
    let is_told = |tests: &Vec<_>| to_controller.any.iter().all(|others| exclude(tests, others));
    if !to_module.any.iter().all(is_told) {
        report(protocol, diagnostics);
    }
}

/// Names all requests and replies that look alike. Those with one way out stand together.
fn report(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let (requests, replies): (Vec<_>, Vec<_>) = patterns(protocol).partition(Known::is_request);
    let pairs = || requests.iter().flat_map(|request| replies.iter().map(move |reply| Pair { request, reply }));
    let fitting = pairs().filter_map(|pair| Some((pair, Some(pair.common(protocol, tolerates)?))));
    let mut alike: Vec<_> = fitting.collect();
    if alike.is_empty() {
        let close = pairs().filter(|pair| pair.common(protocol, |address, _| !is_strict(protocol, address)).is_some());
        alike = close.map(|pair| (pair, None)).collect();
    }
    let mut by_way: IndexMap<String, Vec<Alike>> = IndexMap::new();
    for known in alike {
        let mut ways = known.0.ways_out(protocol);
        let place = ways.iter().position(|way| by_way.contains_key(way)).unwrap_or(0);
        by_way.entry(ways.swap_remove(place)).or_default().push(known);
    }
    let together = by_way.into_iter().filter_map(|(way, alike)| Some(together(protocol, &alike)?.help(way)));
    together.for_each(|diagnostic| diagnostics.push(diagnostic));
}

/// A request and a reply that look alike, and an identifier that fits both, if one was found.
type Alike<'a> = (Pair<'a>, Option<u32>);

/// Reports the first pair, with the patterns of the others beside it.
fn together(protocol: &Protocol, alike: &[Alike]) -> Option<Diagnostic> {
    let ((first, identifier), others) = alike.split_first()?;
    let mut named = HashSet::from([first.request.path(), first.reply.path()]);
    let patterns =
        others.iter().flat_map(|(pair, _)| [(pair.request, "another request"), (pair.reply, "another reply")]);
    let others = patterns.filter(|(known, _)| named.insert(known.path()));
    Some(
        others
            .fold(first.report(protocol, *identifier), |known, (other, what)| known.other(other.path().at_key(), what)),
    )
}

/// What always tells the direction.
const ELSE: &str = "give one of the two another constant; if modules send both, write the request as a `report`";

/// Tests whether an address of the pattern may have a number that the document does not name.
fn tolerates(address: &Address, raw: u32) -> bool {
    !address.excluded.iter().any(|(first, last)| (*first..=*last).contains(&raw))
}

fn is_strict(protocol: &Protocol, address: &Address) -> bool {
    protocol[address.address_type].strict
}

/// A pattern of an addressing mode, and its key.
struct Known<'a> {
    id: ModeId,
    mode: &'a Mode,
    key: &'static str,
    who: Who,
    pattern: &'a AddressPattern,
}

fn patterns(protocol: &Protocol) -> impl Iterator<Item = Known<'_>> {
    protocol.modes.entries().flat_map(|(id, mode)| {
        let Mode { request, one, each, coordinator, .. } = mode;
        let all = [
            ("request", Who::Nobody, request),
            ("one", Who::One, one),
            ("each", Who::Each, each),
            ("coordinator", Who::Coordinator, coordinator),
        ];
        all.into_iter()
            .filter_map(move |(key, who, pattern)| Some(Known { id, mode, key, who, pattern: pattern.as_ref()? }))
    })
}

impl Known<'_> {
    fn is_request(&self) -> bool {
        self.key == "request"
    }

    fn path(&self) -> Path {
        self.mode.doc.path.key(self.key)
    }

    fn constant(&self, protocol: &Protocol, field: FieldId) -> Option<u32> {
        let field = &protocol[field];
        (self.pattern.mask & field.mask() != 0).then(|| field.get(self.pattern.value))
    }

    fn address(&self, field: FieldId) -> Option<&Address> {
        self.pattern.addresses.iter().find(|address| address.field == field)
    }

    fn says_nothing(&self, protocol: &Protocol, field: FieldId) -> bool {
        self.constant(protocol, field).is_none() && self.address(field).is_none()
    }

    fn allows(&self, protocol: &Protocol, field: FieldId, raw: u32, tolerates: impl Fn(&Address, u32) -> bool) -> bool {
        let is_address = |address: &Address| {
            let known = &protocol[address.address_type];
            known.documents(raw) || !known.strict && tolerates(address, raw)
        };
        self.constant(protocol, field).is_none_or(|value| value == raw) && self.address(field).is_none_or(is_address)
    }

    /// Returns numbers that show what the pattern says of a field.
    fn samples(&self, protocol: &Protocol, field: FieldId) -> impl Iterator<Item = u32> {
        let address = self.address(field).map(|address| protocol[address.address_type].raw_ranges());
        let documented = address.into_iter().flatten().take(1).map(|(first, _)| first);
        self.constant(protocol, field).into_iter().chain(documented)
    }

    /// Returns what frames of the pattern have in a field.
    fn used(&self, protocol: &Protocol, field: FieldId) -> BTreeSet<u32> {
        let travels = |frame: &&FrameLayout| {
            let is_its_kind = frame.kind.is_to_module() == self.is_request();
            let is_its_way = |mode, who| mode == self.id && (self.is_request() || who == self.who);
            is_its_kind && frame.travels.iter().any(|travel| is_its_way(travel.mode, travel.who))
        };
        let constants = protocol.frames.iter().filter(travels).flat_map(FrameLayout::identifier);
        constants.filter_map(|(id, value)| (id == field).then_some(value)).collect()
    }
}

/// A request and a reply.
#[derive(Clone, Copy)]
struct Pair<'a> {
    request: &'a Known<'a>,
    reply: &'a Known<'a>,
}

impl Pair<'_> {
    /// Returns an identifier that fits both.
    fn common(&self, protocol: &Protocol, tolerates: impl Fn(&Address, u32) -> bool) -> Option<u32> {
        let Self { request, reply } = self;
        let mut fields = protocol.identifier.fields.entries();
        fields.try_fold(protocol.identifier.value, |identifier, (id, field)| {
            let sampled = request.samples(protocol, id).chain(reply.samples(protocol, id));
            let mut values = sampled.chain([field.sent()]);
            let fits = |known: &Known, raw| known.allows(protocol, id, raw, &tolerates);
            Some(field.put(identifier, values.find(|raw| fits(request, *raw) && fits(reply, *raw))?))
        })
    }

    fn report(&self, protocol: &Protocol, identifier: Option<u32>) -> Diagnostic {
        let name = |known: &Known| format!("`{}` of `{}`", known.key, known.mode.name);
        let (request, reply) = (name(self.request), name(self.reply));
        let text = match identifier {
            Some(identifier) => {
                let digits = if protocol.identifier.extended { 8 } else { 3 };
                format!(
                    "a request and a reply look alike: the identifier {identifier:0digits$X} fits {request} and {reply}"
                )
            }
            None => format!("nothing in the identifier tells {request} from {reply}"),
        };
        let diagnostic = Diagnostic::error(&DIRECTION, self.reply.path().at_key(), text);
        diagnostic.other(self.request.path().at_key(), "the request")
    }

    /// Says what could tell the two apart, the best first. What the accesses hold comes before addresses, which one may
    /// refuse. There is always one.
    fn ways_out(&self, protocol: &Protocol) -> Vec<String> {
        let each = |way: fn(&Self, &Protocol, FieldId) -> Option<String>| {
            protocol.identifier.fields.ids().filter_map(move |field| way(self, protocol, field))
        };
        let ways =
            [Self::by_access, Self::by_controller, Self::by_module, Self::by_constant, Self::by_type, Self::by_other];
        let found: Vec<_> = ways.into_iter().flat_map(each).collect();
        if found.is_empty() { vec![ELSE.to_owned()] } else { found }
    }

    /// Returns the pattern that says nothing of a field, and the other one.
    fn lacking(&self, protocol: &Protocol, field: FieldId) -> Option<(&Known<'_>, &Known<'_>)> {
        let pairs = [(self.request, self.reply), (self.reply, self.request)];
        let is_fixed = |known: &Known| {
            let is_strict = |address| is_strict(protocol, address);
            known.constant(protocol, field).is_some() || known.address(field).is_some_and(is_strict)
        };
        pairs.into_iter().find(|(one, other)| one.says_nothing(protocol, field) && is_fixed(other))
    }

    /// The accesses of one have constants that the other cannot have.
    fn by_access(&self, protocol: &Protocol, field: FieldId) -> Option<String> {
        let (lacking, other) = self.lacking(protocol, field)?;
        let used = lacking.used(protocol, field);
        if used.iter().any(|value| other.allows(protocol, field, *value, tolerates)) {
            return None;
        }
        let (key, mode, name) = (lacking.key, &lacking.mode.name, &protocol[field].name);
        let values: Vec<_> = used.iter().map(|value| format!("{value:#04X}")).collect();
        match &values[..] {
            [] => None,
            [value] => Some(format!("write `{name}: {value}` in `{key}` of `{mode}`, as its accesses have it")),
            [first, ..] => Some(format!(
                "the accesses of `{mode}` have {} in `{name}`: write one such mode for each, \
                 with its constant in `{key}`, as in `{name}: {first}`",
                values.join(" or ")
            )),
        }
    }

    /// A constant of the reply may be the address of a controller.
    fn by_controller(&self, protocol: &Protocol, field: FieldId) -> Option<String> {
        let address = self.reply.constant(protocol, field)?;
        if protocol[self.request.address(field)?.address_type].documents(address) {
            return None;
        }
        let written = format!("{{range: {address:#04X}..{address:#04X}, outside: refused, send: {address:#04X}}}");
        Some(format!(
            "give one field different constants in requests and replies. \
             If no module has the address {address:#04X}, put the name of a type there: `{written}`"
        ))
    }

    /// A constant of the request may be no address of a module.
    fn by_module(&self, protocol: &Protocol, field: FieldId) -> Option<String> {
        let value = self.request.constant(protocol, field)?;
        let known = &protocol[self.reply.address(field)?.address_type];
        let (name, name_of_field) = (&known.name, &protocol[field].name);
        (!known.documents(value)).then(|| {
            format!(
                "write `outside: refused` in the type `{name}`: then {value:#04X} in `{name_of_field}` is a request"
            )
        })
    }

    /// One lacks a constant, and its accesses do not say which.
    fn by_constant(&self, protocol: &Protocol, field: FieldId) -> Option<String> {
        let (lacking, other) = self.lacking(protocol, field)?;
        if !lacking.used(protocol, field).is_empty() {
            return None;
        }
        let (key, mode, name) = (lacking.key, &lacking.mode.name, &protocol[field].name);
        let taken = match other.constant(protocol, field) {
            Some(value) => format!("other than {value:#04X}"),
            None => format!("that `{}` of `{}` cannot have", other.key, other.mode.name),
        };
        Some(format!("in `{key}` of `{mode}`, give `{name}` a constant {taken}"))
    }

    /// Both have addresses, of types that share no number.
    fn by_type(&self, protocol: &Protocol, field: FieldId) -> Option<String> {
        let of = |known: &Known| Some(&protocol[known.address(field)?.address_type]);
        let (asked, answered) = (of(self.request)?, of(self.reply)?);
        let apart = |(first, last): &(u32, u32), (start, end): &(u32, u32)| last < start || end < first;
        let others = answered.raw_ranges();
        asked.raw_ranges().iter().all(|range| others.iter().all(|other| apart(range, other))).then(|| {
            format!(
                "give one field different constants in requests and replies. \
                 If no `{}` has a number of `{}`, write `outside: refused` in the type `{}`",
                asked.name, answered.name, answered.name
            )
        })
    }

    /// Both have the same constant.
    fn by_other(&self, protocol: &Protocol, field: FieldId) -> Option<String> {
        let name = &protocol[field].name;
        self.request.constant(protocol, field).filter(|value| self.reply.constant(protocol, field) == Some(*value))?;
        Some(format!(
            "give one of the two another constant, as in `{name}`; if modules send both, write the request as a `report`"
        ))
    }
}
