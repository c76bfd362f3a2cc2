#![doc = include_str!("../../docs/rules/direction.md")]

use std::collections::HashSet;

use indexmap::IndexMap;

use super::ambiguous::{Ranges, accepted};
use crate::model::{Address, AddressPattern, FieldId, FrameLayout, Message, Mode, Protocol, Way};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;
use crate::words::hex;

rules! {
    DIRECTION "direction" Check ERROR;
}

/// Names all requests and replies that look alike. Those with one way out stand together.
pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let mut by_way: IndexMap<String, Vec<Alike>> = IndexMap::new();
    let ways = protocol.recognition.alike.iter();
    for alike in ways.filter_map(|(request, reply)| Pair::new(protocol, *request, *reply)?.alike(protocol)) {
        let mut ways = alike.pair.ways_out(protocol);
        let place = ways.iter().position(|way| by_way.contains_key(way)).unwrap_or(0);
        by_way.entry(ways.swap_remove(place)).or_default().push(alike);
    }
    let report = |(way, alike): (String, Vec<Alike>)| Some(together(protocol, diagnostics, &alike)?.help(way));
    let reports: Vec<_> = by_way.into_iter().filter_map(report).collect();
    for diagnostic in reports {
        diagnostics.push(diagnostic);
    }
}

/// Reports the first pair, with the patterns of the others beside it.
fn together(protocol: &Protocol, diagnostics: &Diagnostics, alike: &[Alike]) -> Option<Diagnostic> {
    let (first, others) = alike.split_first()?;
    let mut named = HashSet::from([first.pair.request.path(), first.pair.reply.path()]);
    let pairs = others.iter().map(|known| known.pair);
    let patterns = pairs.flat_map(|pair| [(pair.request, "another request"), (pair.reply, "another reply")]);
    let others = patterns.filter(|(known, _)| named.insert(known.path()));
    let report = first.report(protocol, diagnostics);
    Some(others.fold(report, |known, (other, what)| known.other(other.path().at_key(), what)))
}

/// What always tells the direction.
const ELSE: &str = "give one of the two another constant; if modules send both, write the request as a `report`";

fn is_strict(protocol: &Protocol, address: &Address) -> bool {
    protocol[address.address_type].strict
}

/// A way, and what its identifiers show.
#[derive(Clone, Copy)]
struct Known<'a> {
    way: Way,
    mode: &'a Mode,
    key: &'static str,
    pattern: &'a AddressPattern,
}

impl<'a> Known<'a> {
    fn new(protocol: &'a Protocol, way: Way) -> Option<Self> {
        let mode = &protocol[way.mode];
        Some(Self { way, mode, key: way.key(), pattern: way.pattern(mode)? })
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

    /// Returns numbers that show what the pattern says of a field.
    fn samples(&self, protocol: &Protocol, field: FieldId) -> impl Iterator<Item = u32> {
        let address = self.address(field).map(|address| protocol[address.address_type].raw_ranges());
        let documented = address.into_iter().flatten().take(1).map(|(first, _)| first);
        self.constant(protocol, field).into_iter().chain(documented)
    }

    /// Tests whether a frame of the pattern has a constant in a field.
    fn uses(&self, protocol: &Protocol, field: FieldId) -> bool {
        let mut frames = protocol.frames.iter().filter(|frame| self.way.has(frame));
        frames.any(|frame| constant_of(frame, field).is_some())
    }
}

fn constant_of(frame: &FrameLayout, field: FieldId) -> Option<u32> {
    frame.identifier().find(|(known, _)| *known == field).map(|(_, value)| value)
}

/// A request and a reply that look alike, with an identifier that fits both.
struct Alike<'a> {
    pair: Pair<'a>,
    frames: [&'a FrameLayout; 2],
    identifier: u32,
}

impl Alike<'_> {
    fn report(&self, protocol: &Protocol, diagnostics: &Diagnostics) -> Diagnostic {
        let Pair { request, reply } = &self.pair;
        let name = |known: &Known| format!("`{}` of `{}`", known.key, known.mode.name);
        let text = format!(
            "{} look alike: the {} fits {} and {}",
            self.messages(protocol),
            self.frame(protocol),
            name(request),
            name(reply)
        );
        let diagnostic = Diagnostic::error(&DIRECTION, reply.path().at_key(), text);
        let diagnostic = diagnostic.other(request.path().at_key(), "the request");
        let chosen = self.chosen(protocol, diagnostics).into_iter();
        chosen.fold(diagnostic, |known, (at, what)| known.other(at, what))
    }

    /// Returns where two messages are chosen.
    fn chosen(&self, protocol: &Protocol, diagnostics: &Diagnostics) -> Vec<(At, String)> {
        let messages = self.frames.map(|frame| &protocol[frame.message]);
        let of = |message: &Message| {
            (diagnostics.written(&message.doc.path, &["match"]), format!("chooses `{}`", message.name))
        };
        if messages[0].name == messages[1].name { Vec::new() } else { messages.map(of).into() }
    }

    fn messages(&self, protocol: &Protocol) -> String {
        let [request, reply] = self.frames;
        let [one, other] = self.frames.map(|frame| &protocol[frame.message].name);
        let [asks, kind] = [request, reply].map(|frame| frame.kind.name());
        if one == other && asks == kind {
            format!("both {kind}s of `{one}`")
        } else if one == other {
            format!("the {asks} of `{one}` and its {kind}")
        } else {
            format!("the {asks} of `{one}` and the {kind} of `{other}`")
        }
    }

    /// Shows a frame that could be either. Data without constants say nothing.
    fn frame(&self, protocol: &Protocol) -> String {
        let width = if protocol.identifier.extended { 8 } else { 3 };
        let identifier = format!("{:0width$X}", self.identifier);
        let mut constants = self.frames.into_iter().flat_map(FrameLayout::payload).peekable();
        if constants.peek().is_none() {
            return format!("identifier {identifier}");
        }
        let mut data = [0; 8];
        constants.for_each(|(place, value)| place.put(&mut data, value));
        let length = usize::from(self.frames[0].shortest().min(8));
        format!("frame {identifier}#{}", hex::digits(&data[..length]))
    }
}

/// A request and a reply.
#[derive(Clone, Copy)]
struct Pair<'a> {
    request: Known<'a>,
    reply: Known<'a>,
}

impl<'a> Pair<'a> {
    fn new(protocol: &'a Protocol, request: Way, reply: Way) -> Option<Self> {
        Some(Self { request: Known::new(protocol, request)?, reply: Known::new(protocol, reply)? })
    }

    /// Finds a request and a reply that one frame can be.
    fn alike(self, protocol: &'a Protocol) -> Option<Alike<'a>> {
        let choice = protocol.recognition.either.choice.as_ref()?;
        let mut requests = protocol.frames.iter().filter(|frame| self.request.way.has(frame));
        requests.find_map(|request| {
            choice.find_among(&request.constants, &mut |group| {
                group.choice.as_ref()?.find_among(&request.constants, &mut |frames| {
                    let replies = frames.iter().map(|id| &protocol[*id]).filter(|frame| self.reply.way.has(frame));
                    replies.map(|reply| [request, reply]).find_map(|frames| {
                        Some(Alike { pair: self, frames, identifier: self.common(protocol, frames)? })
                    })
                })
            })
        })
    }

    /// Returns an identifier that both frames can have.
    fn common(&self, protocol: &Protocol, frames: [&FrameLayout; 2]) -> Option<u32> {
        let both = [self.request, self.reply];
        let mut fields = protocol.identifier.fields.entries();
        fields.try_fold(protocol.identifier.value, |identifier, (id, field)| {
            let shown = frames.into_iter().filter_map(|frame| constant_of(frame, id));
            let accepted = both.map(|known| accepted(protocol, known.pattern, id));
            let fits = |raw: &u32| {
                let is_accepted = |ranges: &Ranges| ranges.iter().any(|(first, last)| (first..=last).contains(&raw));
                shown.clone().all(|value| value == *raw) && accepted.iter().all(is_accepted)
            };
            let samples = both.iter().flat_map(|known| known.samples(protocol, id)).chain([field.sent()]);
            // What two ranges share starts with the first value of one of them.
            let firsts = accepted.iter().flatten().map(|(first, _)| *first);
            Some(field.put(identifier, shown.clone().chain(samples).chain(firsts).find(fits)?))
        })
    }

    /// Says what could tell the two apart, the best first. There is always one.
    fn ways_out(&self, protocol: &Protocol) -> Vec<String> {
        let each = |way: fn(&Self, &Protocol, FieldId) -> Option<String>| {
            protocol.identifier.fields.ids().filter_map(move |field| way(self, protocol, field))
        };
        let ways = [Self::by_controller, Self::by_module, Self::by_constant, Self::by_type, Self::by_other];
        let found: Vec<_> = ways.into_iter().flat_map(each).collect();
        if found.is_empty() { vec![ELSE.to_owned()] } else { found }
    }

    /// Returns the pattern that says nothing of a field, and the other one.
    fn lacking(&self, protocol: &Protocol, field: FieldId) -> Option<(&Known<'_>, &Known<'_>)> {
        let pairs = [(&self.request, &self.reply), (&self.reply, &self.request)];
        let is_fixed = |known: &Known| {
            let is_strict = |address| is_strict(protocol, address);
            known.constant(protocol, field).is_some() || known.address(field).is_some_and(is_strict)
        };
        pairs.into_iter().find(|(one, other)| one.says_nothing(protocol, field) && is_fixed(other))
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
        if lacking.uses(protocol, field) {
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
        let (asked, answered) = (of(&self.request)?, of(&self.reply)?);
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
