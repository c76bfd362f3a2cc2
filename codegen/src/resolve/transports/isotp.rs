//! The transport of ISO 15765-2: its frames have the identifiers of the messages that it carries.

use super::{Flaw, Kind};
use crate::model::keywords::SIDES;
use crate::model::{Identifier, Isotp, Standard};
use crate::read::syntax::ast::{self, Map, Pattern};
use crate::words::number::Rational;

/// The kind of transport.
pub const KIND: Kind = Kind { name: "isotp", messages: include_str!("isotp.yaml"), flaw, accesses, complete, standard };

/// The byte that fills frames unless a spec says otherwise. The standard recommends it.
const FILL: u8 = 0xCC;

/// The word for frames that end with their data.
const NO_FILL: &str = "none";

/// What one side shows in the identifier of its frames, and in which modes: `{single: one}`.
struct Way<'a> {
    side: &'a str,
    shown: Pattern,
    modes: Map<String>,
}

/// Returns how frames are filled.
fn standard(_: &Identifier, transport: &ast::Transport) -> Option<Standard> {
    filling(transport.fill.as_deref()).map(Standard::Isotp)
}

/// Reads the byte that fills frames. It returns nothing if the text is no byte.
fn filling(text: Option<&str>) -> Option<Isotp> {
    let byte = |text| u8::try_from(Rational::parse(text)?.to_integer()?).ok();
    let fill = match text {
        None => Some(FILL),
        Some(NO_FILL) => None,
        Some(text) => Some(byte(text)?),
    };
    Some(Isotp { fill })
}

fn flaw(spec: &ast::Spec, name: &str, transport: &ast::Transport) -> Option<Flaw> {
    let is_there = [!transport.group.0.is_empty(), transport.target.is_some(), transport.source.is_some()];
    let keys = ["group", "target", "source"].into_iter().zip(is_there);
    if let Some((key, _)) = keys.into_iter().find(|(_, is_there)| *is_there) {
        let text = format!("`{key}` means nothing for ISO-TP, whose frames have the identifiers of the messages");
        return Some(Flaw::new(key, text, "take it out"));
    }
    if filling(transport.fill.as_deref()).is_none() {
        let text = format!("`{}` is no byte", transport.fill.as_deref().unwrap_or_default());
        return Some(Flaw::new(
            "fill",
            text,
            "write a number from 0 to 255, or `none` for frames that end with their data",
        ));
    }
    carried(spec, name).next().is_none().then(|| {
        let text = format!("no message travels by `{name}`, so it has no identifiers");
        Flaw::new("kind", text, &format!("write `via: {name}` in a message"))
    })
}

/// Returns the messages that a transport carries.
fn carried<'a>(spec: &'a ast::Spec, name: &'a str) -> impl Iterator<Item = &'a ast::Message> {
    spec.messages.values().filter(move |message| message.via.as_deref() == Some(name))
}

/// Makes an access for each side and each identifier that it shows.
fn accesses(spec: &ast::Spec, name: &str, transport: &ast::Transport) -> Map<ast::Access> {
    let mut all: Vec<Way> = Vec::new();
    for way in carried(spec, name).flat_map(|message| ways(spec, message)) {
        let joins = |known: &&mut Way| {
            let is_like = |(mode, how): (&String, &String)| known.modes.get(mode).is_none_or(|other| other == how);
            (known.side, &known.shown) == (way.side, &way.shown) && way.modes.iter().all(is_like)
        };
        match all.iter_mut().find(joins) {
            Some(known) => known.modes.extend(way.modes),
            None => all.push(way),
        }
    }
    let mut accesses = Map::new();
    for Way { side, shown, modes } in all {
        let number = accesses.keys().filter(|known: &&String| known.starts_with(&format!("{name}_of_{side}"))).count();
        let suffix = if number == 0 { String::new() } else { format!("_{}", number + 1) };
        accesses.insert(format!("{name}_of_{side}{suffix}"), super::access(side, shown, modes, transport));
    }
    accesses
}

/// Returns the ways of a message: those of its own frames, and those of the answers to them.
fn ways<'a>(spec: &'a ast::Spec, message: &'a ast::Message) -> Vec<Way<'a>> {
    let mut ways = Vec::new();
    for access in message.access.iter().filter_map(|name| spec.access.get(name)) {
        let answers = if message.answers.is_empty() { &access.answers } else { &message.answers };
        for (side, _) in SIDES {
            let mut shown: Vec<_> =
                patterns(access, side).map(|pattern| in_identifier(spec, message, &pattern)).collect();
            if shown.is_empty() {
                shown.push(in_identifier(spec, message, &Pattern::new()));
            }
            let modes: Map<String> = answers.iter().filter_map(|answer| way(spec, side, answer)).collect();
            ways.extend(shown.into_iter().map(|shown| Way { side, shown, modes: modes.clone() }));
        }
    }
    ways
}

/// Returns the patterns of an access for frames that a side sends.
fn patterns<'a>(access: &'a ast::Access, side: &'a str) -> impl Iterator<Item = Pattern> {
    let from = access.from.as_deref().unwrap_or("module");
    // A field of the identifier has one value.
    let single = |(name, values): (&String, &ast::Numbers)| Some((name.clone(), values.0.first()?.clone()));
    let reply = access.reply.as_ref().map(|reply| reply.iter().filter_map(single).collect());
    let all = [("controller", access.request.clone()), ("module", reply), (from, access.report.clone())];
    all.into_iter().filter(move |(sender, _)| *sender == side).filter_map(|(_, pattern)| pattern)
}

/// Returns what frames of a message show in their identifier, besides addresses.
fn in_identifier(spec: &ast::Spec, message: &ast::Message, pattern: &Pattern) -> Pattern {
    let all = message.pattern.iter().chain(pattern).filter(|(name, _)| spec.identifier.contains_key(*name));
    all.map(|(name, value)| (name.clone(), value.clone())).collect()
}

/// Returns how a side sends frames in an addressing mode, if it can.
fn way(spec: &ast::Spec, side: &str, (name, how): (&String, &String)) -> Option<(String, String)> {
    let mode = spec.addressing.get(name)?;
    let how = if how == "nobody" { "one" } else { how };
    let is_there = match (side, how) {
        ("controller", _) => mode.request.is_some(),
        (_, "one") => mode.one.is_some(),
        (_, "each") => mode.each.is_some(),
        _ => mode.coordinator.is_some(),
    };
    is_there.then(|| (name.clone(), how.to_owned()))
}

/// The frames are as the standard describes them.
fn complete(_: &ast::Spec, _: &ast::Transport, _: &str, _: &mut ast::Message) {}
