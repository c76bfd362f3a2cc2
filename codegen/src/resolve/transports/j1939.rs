//! The transport of SAE J1939-21: its frames have identifiers of their own.

use super::{Flaw, Kind};
use crate::model::{Groups, Identifier, Standard};
use crate::read::syntax::ast::{self, IdentifierEntry, Map, Pattern};
use crate::words::number::Rational;

/// The kind of transport.
pub const KIND: Kind = Kind { name: "j1939", messages: include_str!("j1939.yaml"), flaw, accesses, complete, standard };

/// The numbers of the groups of its frames: those that manage a transfer, and those with packets.
const GROUPS: [u32; 2] = [0xEC00, 0xEB00];

/// Bits of the number of a group.
const GROUP_BITS: u8 = 18;

/// The ways to answer, in the order in which a transport takes them.
const ANSWERS: [&str; 3] = ["one", "each", "coordinator"];

/// Returns how a sound transport uses the identifier.
fn standard(identifier: &Identifier, transport: &ast::Transport) -> Option<Standard> {
    let field = |name: &String| identifier.fields.position(|field| field.name == *name);
    Some(Standard::J1939(Groups {
        group: transport.group.0.iter().filter_map(field).collect(),
        target: field(transport.target.as_ref()?)?,
        source: field(transport.source.as_ref()?)?,
    }))
}

/// Finds what is wrong with a transport, but for its kind.
fn flaw(spec: &ast::Spec, _: &str, transport: &ast::Transport) -> Option<Flaw> {
    let flaw = |key, text, help: &str| Some(Flaw::new(key, text, help));
    if transport.fill.is_some() {
        return flaw("fill", "`fill` means nothing for J1939, which fills packets with ones".to_owned(), "take it out");
    }
    let (Some(target), Some(source)) = (&transport.target, &transport.source) else {
        let key = if transport.target.is_none() { "target" } else { "source" };
        return flaw(key, format!("a transport of J1939 needs `{key}`"), "name the field of the identifier");
    };
    let fields = [("target", target), ("source", source)];
    let fields = fields.into_iter().chain(transport.group.0.iter().map(|field| ("group", field)));
    for (key, field) in fields {
        let Some(width) = bits(spec, field).map(|(high, low)| high - low + 1) else {
            return flaw(key, format!("the identifier has no field `{field}`"), "name a field of `identifier`");
        };
        if key != "group" && width != 8 {
            let text = format!("`{field}` has {width} bits, and an address of J1939 has 8");
            return flaw(key, text, "name the field of the identifier with that address");
        }
    }
    let width: u8 =
        transport.group.0.iter().filter_map(|field| bits(spec, field)).map(|(high, low)| high - low + 1).sum();
    if width != GROUP_BITS {
        let text = format!("the fields of `group` have {width} bits, and the number of a group has {GROUP_BITS}");
        return flaw(
            "group",
            text,
            "name the two bits of the page, the format and the target: `[page, format, target]`",
        );
    }
    if transport.group.0.last() != Some(target) {
        let text = format!("the last field of `group` is not `{target}`");
        return flaw("group", text, "the field of the receiver stands last");
    }
    if GROUPS.iter().any(|group| matched(spec, transport, *group).is_none()) {
        let text = "a constant field of `group` keeps the frames of the transport out".to_owned();
        return flaw("group", text, "their page is 0, and their formats are 0xEB and 0xEC");
    }
    None
}

/// Returns the highest and the lowest bit of a field of the identifier.
fn bits(spec: &ast::Spec, name: &str) -> Option<(u8, u8)> {
    let IdentifierEntry::Field(field) = spec.identifier.get(name)? else { return None };
    let text = field.bits.as_ref()?;
    let (high, low) = text.split_once("..").unwrap_or((text, text));
    let (high, low) = (high.trim().parse().ok()?, low.trim().parse().ok()?);
    (low <= high && high < 29).then_some((high, low))
}

/// Returns what the identifier of a group must show, but for the address in its last byte. It is nothing if a constant
/// field shows something else.
fn matched(spec: &ast::Spec, transport: &ast::Transport, group: u32) -> Option<Pattern> {
    let mut pattern = Pattern::new();
    let mut rest = group;
    for name in transport.group.0.iter().rev() {
        let (high, low) = bits(spec, name)?;
        let width = high - low + 1;
        let value = rest & u32::MAX >> (32 - width);
        rest >>= width;
        let IdentifierEntry::Field(field) = spec.identifier.get(name)? else { return None };
        match &field.constant {
            _ if Some(name) == transport.target.as_ref() => {}
            Some(constant) if Rational::parse(constant) != Some(Rational::integer(value.into())) => return None,
            Some(_) => {}
            None => {
                pattern.insert(name.clone(), value.to_string());
            }
        }
    }
    Some(pattern)
}

/// Makes an access for each side that sends the frames of a transport.
fn accesses(spec: &ast::Spec, name: &str, transport: &ast::Transport) -> Map<ast::Access> {
    let ways = |mode: &ast::Mode| [mode.one.is_some(), mode.each.is_some(), mode.coordinator.is_some()];
    let way =
        |mode: &ast::Mode| ANSWERS.into_iter().zip(ways(mode)).find(|(_, is_there)| *is_there).map(|(way, _)| way);
    let of_module = spec.addressing.iter().filter_map(|(name, mode)| Some((name.clone(), way(mode)?.to_owned())));
    let asked = spec.addressing.iter().filter(|(_, mode)| mode.request.is_some());
    let of_controller = asked.map(|(name, mode)| (name.clone(), way(mode).unwrap_or("each").to_owned()));
    let access = |side: &str, answers: Map<String>| {
        (format!("{name}_of_{side}"), super::access(side, Pattern::new(), answers, transport))
    };
    Map::from_iter([access("module", of_module.collect()), access("controller", of_controller.collect())])
}

/// Completes the message of a frame.
fn complete(spec: &ast::Spec, transport: &ast::Transport, frame: &str, message: &mut ast::Message) {
    let group = if frame == "data" { GROUPS[1] } else { GROUPS[0] };
    message.pattern = matched(spec, transport, group).unwrap_or_default();
    message.length = ast::Names(vec!["8".to_owned()]);
    message.reserved = Some(ast::Reserved { send: Some("1".to_owned()), expect: None });
}
