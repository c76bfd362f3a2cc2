#![doc = include_str!("../rules/direction.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{AddressPattern, IdentifierField, Mode, Protocol, exclude};
use crate::rule::rules;
use crate::syntax::tree::Path;

rules! {
    DIRECTION "direction" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let pairs = protocol
        .recognition
        .to_module
        .any
        .iter()
        .flat_map(|one| protocol.recognition.to_controller.any.iter().map(move |other| (one, other)));
    for (one, other) in pairs {
        if !exclude(one, other) {
            report(protocol, diagnostics);
            return;
        }
    }
}

/// Names the patterns without the constant that shows the direction of the others. If there is no
/// such constant, it names all patterns.
fn report(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let text = "nothing in the identifier tells a request from a reply";
    let patterns = patterns(protocol);
    let fields = protocol.identifier.fields.iter();
    let nearly = fields.filter(|field| tells(&patterns, field.mask()));
    let lacking = |field: &&IdentifierField| patterns.iter().filter(|known| !known.has(field.mask())).count();
    let Some(field) = nearly.min_by_key(lacking) else {
        return report_alike(protocol, &patterns, diagnostics);
    };
    for known in patterns.iter().filter(|known| !known.has(field.mask())) {
        let text = format!("{text}: `{}` of `{}` has no constant in `{}`", known.key, known.mode.name, field.name);
        let help = format!("give `{}` a constant here, as the other patterns have", field.name);
        let at = known.mode.doc.path.key(known.key).at_key();
        diagnostics.push(Diagnostic::error(&DIRECTION, at, text).help(help));
    }
}

/// Shows where requests and replies have the same constant, or asks for something that tells them
/// apart.
fn report_alike(protocol: &Protocol, patterns: &[Known], diagnostics: &mut Diagnostics) {
    let (requests, replies): (Vec<_>, Vec<_>) = patterns.iter().partition(|known| known.key == "request");
    let mut pairs = requests.iter().flat_map(|one| replies.iter().map(move |other| (*one, *other)));
    let common = pairs.find_map(|(one, other)| {
        let has = |field: &&IdentifierField| one.has(field.mask()) && other.has(field.mask());
        let mut fields = protocol.identifier.fields.iter().filter(has);
        let is_same = |field: &IdentifierField| (one.pattern.value ^ other.pattern.value) & field.mask() == 0;
        let has_own = other.pattern.mask & !one.pattern.mask != 0;
        let first = fields.next().filter(|field| !has_own && is_same(field) && fields.all(is_same))?;
        Some((one, other, first))
    });
    let Some((request, reply, field)) = common else {
        let text = "nothing in the identifier tells a request from a reply";
        let at = Path::default().key("addressing").at_key();
        let diagnostic = Diagnostic::error(&DIRECTION, at, text);
        return diagnostics.push(diagnostic.help(way_out(protocol, &requests, &replies)));
    };
    let (name, value) = (&field.name, field.get(request.pattern.value));
    let text = format!("a request and a reply look alike: both have {value} in `{name}`");
    let place = |known: &Known| known.mode.doc.path.key(known.key).key(name).at_value();
    let diagnostic = Diagnostic::error(&DIRECTION, place(reply), text).other(place(request), "the request");
    diagnostics.push(diagnostic.help(between(protocol, request.pattern, reply.pattern)));
}

/// Says what could tell a request from a reply with the same constant. It may be a number that is no
/// address of the reply.
fn between(protocol: &Protocol, request: &AddressPattern, reply: &AddressPattern) -> String {
    let told = reply.addresses.iter().find_map(|address| {
        let (field, address_type) = (&protocol[address.field], &protocol[address.address_type]);
        let value = field.get(request.value);
        let is_other = request.mask & field.mask() != 0 && !address_type.documents(value);
        is_other.then_some((field, value, &address_type.name))
    });
    match told {
        Some((field, value, name)) => {
            let name_of_field = &field.name;
            format!(
                "write `outside: refused` in the type `{name}`: then {value:#04X} in `{name_of_field}` is a request"
            )
        }
        None => {
            "give one of the two another constant; if modules send both, write the request as a `report`".to_owned()
        }
    }
}

/// Says what could tell the direction. A constant that replies alone have may be a controller's address.
fn way_out(protocol: &Protocol, requests: &[&Known], replies: &[&Known]) -> String {
    let is_own = |field: &&IdentifierField| requests.iter().all(|request| !request.has(field.mask()));
    let controller = replies.iter().find_map(|reply| {
        let mut fields = protocol.identifier.fields.iter().filter(|field| reply.has(field.mask()));
        Some(fields.find(is_own)?.get(reply.pattern.value))
    });
    let refusing = match controller {
        Some(address) => {
            let written = format!("{{range: {address:#04X}..{address:#04X}, outside: refused, send: {address:#04X}}}");
            format!("If no module has the address {address:#04X}, put the name of a type there: `{written}`")
        }
        None => "If no module has a controller's address, write `outside: refused` in the controller's type".to_owned(),
    };
    format!("give one field different constants in requests and replies. {refusing}")
}

/// A pattern of an addressing mode, and its key.
struct Known<'a> {
    mode: &'a Mode,
    key: &'static str,
    pattern: &'a AddressPattern,
}

impl Known<'_> {
    /// Tests whether the pattern has a constant in a field.
    fn has(&self, field: u32) -> bool {
        self.pattern.mask & field != 0
    }
}

fn patterns(protocol: &Protocol) -> Vec<Known<'_>> {
    protocol.modes.iter().flat_map(patterns_of).collect()
}

fn patterns_of(mode: &Mode) -> impl Iterator<Item = Known<'_>> {
    let Mode { request, one, each, coordinator, .. } = mode;
    let keys = [("request", request), ("one", one), ("each", each), ("coordinator", coordinator)];
    keys.into_iter().filter_map(move |(key, pattern)| Some(Known { mode, key, pattern: pattern.as_ref()? }))
}

/// Tests whether the constants of requests in the field differ from those of replies.
fn tells(patterns: &[Known], field: u32) -> bool {
    let having = patterns.iter().filter(|known| known.has(field));
    let (requests, replies): (Vec<_>, Vec<_>) = having.partition(|known| known.key == "request");
    let pairs = || requests.iter().flat_map(|one| replies.iter().map(move |other| (one.pattern, other.pattern)));
    pairs().next().is_some() && pairs().all(|(one, other)| (one.value ^ other.value) & field != 0)
}
