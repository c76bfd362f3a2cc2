//! Finds the identifiers, and the frames that share one.

use std::collections::{HashMap, HashSet};
use std::ops::RangeInclusive;

use indexmap::{IndexMap, IndexSet};

use super::Dropped;
use super::file::DbcMessage;
use super::text::{self, remarks};
use super::tree::{self, Candidate, Tree};
use crate::model::{Address, AddressPattern, FrameId, FrameLayout, Kind, Message, ModeId, Protocol};

/// One frame of one message in one addressing mode.
pub struct Sent<'a> {
    pub message: &'a Message,
    pub id_of_layout: FrameId,
    pub layout: &'a FrameLayout,
    mode: ModeId,
    node: Option<i64>,
    id: u32,
    /// Bits that are the same in all its identifiers.
    fixed: u32,
}

/// Returns every frame in each of its addressing modes, for each node if nodes are given.
pub fn sent<'a>(protocol: &'a Protocol, nodes: Option<&RangeInclusive<i64>>) -> Vec<Sent<'a>> {
    let mut sent = Vec::new();
    for (id_of_layout, layout) in protocol.frames.entries() {
        let message = &protocol[layout.message];
        for (mode, pattern) in protocol.patterns_of(layout) {
            let numbers: Vec<Option<i64>> = match nodes {
                Some(nodes) if is_open(protocol, pattern) => nodes.clone().map(Some).collect(),
                _ => vec![None],
            };
            let frames = numbers.into_iter().filter_map(|node| {
                let (id, fixed) = identifier(protocol, layout, pattern, node, nodes.is_some())?;
                Some(Sent { message, id_of_layout, layout, mode, node, id, fixed })
            });
            sent.extend(frames);
        }
    }
    sent
}

/// Tests whether a pattern has an address that is not the sender's own.
fn is_open(protocol: &Protocol, pattern: &AddressPattern) -> bool {
    pattern.addresses.iter().any(|address| protocol[address.address_type].send.is_none())
}

/// Returns an identifier and its fixed bits, or `None` if a node has no such address. A given node
/// fixes the addresses.
fn identifier(
    protocol: &Protocol,
    frame: &FrameLayout,
    pattern: &AddressPattern,
    node: Option<i64>,
    concrete: bool,
) -> Option<(u32, u32)> {
    let layout = &protocol.identifier;
    let chosen = frame.identifier().fold(0, |mask, (field, _)| mask | protocol[field].mask());
    let mut fixed = layout.mask | pattern.mask | chosen;
    let mut id = protocol.base_identifier(frame, pattern);
    for address in &pattern.addresses {
        let field = &protocol[address.field];
        let (raw, varying) = number(protocol, address, node)?;
        id = field.put(id, raw);
        fixed |= (if concrete { u32::MAX } else { !varying }) << field.shift & field.mask();
    }
    Some((id, fixed))
}

/// Returns the raw value of an address, and the bits that differ among the documented ones.
fn number(protocol: &Protocol, address: &Address, node: Option<i64>) -> Option<(u32, u32)> {
    let known = &protocol[address.address_type];
    let raw = u32::try_from(known.raw(known.send.or(node).unwrap_or(known.first))).ok();
    let raw = raw.filter(|raw| known.documents(*raw))?;
    let varying = known.raw_ranges().into_iter().fold(0, |varying, (first, last)| {
        varying | raw ^ first | u32::MAX.checked_shr((first ^ last).leading_zeros()).unwrap_or(0)
    });
    Some((raw, varying))
}

/// Returns the bits of the identifier that all frames fix.
pub fn mask(protocol: &Protocol, sent: &[Sent]) -> u32 {
    let all = if protocol.identifier.extended { 0x1FFF_FFFF } else { 0x7FF };
    sent.iter().fold(all, |mask, sent| mask & sent.fixed)
}

/// The frames that share an identifier.
struct Group<'a> {
    /// The frames that the DBC has.
    sent: Vec<&'a Sent<'a>>,
    lost: Vec<&'a Sent<'a>>,
    /// The frames of another length.
    others: Vec<Candidate<'a>>,
    tree: Tree<'a>,
}

/// Returns a frame for each value of the masked bits, and the frames that are lost.
pub fn frames(protocol: &Protocol, sent: &[Sent], mask: u32) -> (Vec<DbcMessage>, Vec<Dropped>) {
    let mut groups: IndexMap<u32, Vec<&Sent>> = IndexMap::new();
    for sent in sent {
        groups.entry(sent.id & mask).or_default().push(sent);
    }
    let groups: Vec<Group> = groups.into_values().map(|sent| group(protocol, sent)).collect();
    let names = names(protocol, &groups);
    let lost = dropped(protocol, &groups, &names);
    let frames = groups.into_iter().zip(names).map(|(group, name)| frame(protocol, group, name)).collect();
    (frames, lost)
}

fn group<'a>(protocol: &Protocol, sent: Vec<&'a Sent<'a>>) -> Group<'a> {
    let (mut candidates, mut layouts): (Vec<Candidate>, _) = (Vec::new(), HashSet::new());
    for sent in &sent {
        if layouts.insert(sent.id_of_layout) {
            candidates.push(Candidate { id: sent.id_of_layout, message: sent.message, layout: sent.layout });
        }
    }
    let with_signals = candidates.iter().find(|candidate| !tree::is_empty(candidate));
    let length = with_signals.unwrap_or(&candidates[0]).layout.longest();
    let (candidates, others): (Vec<_>, Vec<_>) =
        candidates.into_iter().partition(|candidate| candidate.layout.longest() == length);
    let tree = tree::tree(protocol, candidates);
    let (sent, lost) = sent.into_iter().partition(|sent| tree.has(sent.id_of_layout));
    Group { sent, lost, others, tree }
}

/// A message that a frame lacks.
struct Lost {
    /// What is missing, and why.
    missing: String,
    why: String,
    has_own_identifier: bool,
}

/// Returns what a frame lacks.
fn lost(protocol: &Protocol, group: &Group) -> Vec<Lost> {
    let length = group.sent[0].message.longest();
    let kept: HashSet<u32> = group.sent.iter().map(|sent| sent.id).collect();
    let shared = group.lost.iter().filter(|lost| kept.contains(&lost.id));
    let shared: HashSet<FrameId> = shared.map(|lost| lost.id_of_layout).collect();
    let dropped = |candidate: &Candidate, missing: String, why: String| {
        let has_own_identifier = !shared.contains(&candidate.id);
        Lost { missing, why, has_own_identifier }
    };
    let other =
        |lost: &Candidate| dropped(lost, format!("`{}`", lost.message.name), format!("whose length is {length} bytes"));
    let same = |(lost, kept): &(Candidate, Candidate)| {
        let is_one = lost.layout.message == kept.layout.message;
        let [missing, found] = [lost, kept].map(|candidate| {
            let how = if is_one { format!(" ({})", how(protocol, candidate.layout)) } else { String::new() };
            format!("`{}`{how}", candidate.message.name)
        });
        dropped(lost, missing, format!("where nothing tells it from {found}"))
    };
    group.others.iter().map(other).chain(group.tree.lost.iter().map(same)).collect()
}

/// Says once what several frames lack for the same reason, such as those of several nodes.
fn dropped(protocol: &Protocol, groups: &[Group], names: &[String]) -> Vec<Dropped> {
    let mut frames: IndexMap<(String, String, bool), Vec<&str>> = IndexMap::new();
    for (group, name) in groups.iter().zip(names) {
        for Lost { missing, why, has_own_identifier } in lost(protocol, group) {
            frames.entry((missing, why, has_own_identifier)).or_default().push(name);
        }
    }
    let said = frames.into_iter().map(|((missing, why, has_own_identifier), names)| {
        let more = match names.len() - 1 {
            0 => String::new(),
            1 => " and 1 more frame".to_owned(),
            count => format!(" and {count} more frames"),
        };
        Dropped { text: format!("{missing} is missing in `{}`{more}, {why}", names[0]), has_own_identifier }
    });
    said.collect()
}

/// Says what a frame is for, and by which access.
fn how(protocol: &Protocol, layout: &FrameLayout) -> String {
    match layout.kind {
        Kind::Report => Kind::Report.name().to_owned(),
        kind @ (Kind::Request | Kind::Reply) => format!("{} to {}", kind.name(), protocol[layout.access].name),
    }
}

fn frame(protocol: &Protocol, group: Group, name: String) -> DbcMessage {
    let sent = &group.sent;
    let sides = &protocol.sides;
    let (module, controller) =
        (text::module(sides, common(sent, |sent| sent.node).flatten()), sides.controller.clone());
    let is_to_module = sent[0].layout.is_to_module();
    let (sender, receivers) = if is_to_module { (controller, module) } else { (module, controller) };
    DbcMessage {
        id: sent[0].id,
        extended: protocol.identifier.extended,
        name,
        length: sent[0].message.longest(),
        sender,
        receivers,
        comment: comment(protocol, sent),
        cycle: common(sent, |sent| cycle(protocol, sent)).flatten(),
        signals: group.tree.signals,
    }
}

/// Returns what all frames of a group have in common.
fn common<T: PartialEq>(group: &[&Sent], of: impl Fn(&Sent) -> T) -> Option<T> {
    let first = of(group.first()?);
    group.iter().all(|sent| of(sent) == first).then_some(first)
}

/// Returns the milliseconds between two reports. It is the shortest time if the time may vary.
fn cycle(protocol: &Protocol, sent: &Sent) -> Option<u32> {
    let access = &protocol[sent.layout.access];
    let timing = &protocol[sent.message.every.or(access.every).filter(|_| sent.layout.kind == Kind::Report)?];
    let [time, _] = timing.ends().map(|end| end.as_secs_f64() * 1e3);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it lies within a day")]
    (1.0..=864e5).contains(&time).then(|| time.round() as u32)
}

/// Says which messages a frame carries, in which modes.
fn comment(protocol: &Protocol, group: &[&Sent]) -> String {
    let mut lines: IndexSet<String> = IndexSet::new();
    let mut modes: IndexSet<&str> = IndexSet::new();
    for sent in group {
        let text = remarks(&sent.message.doc);
        let space = if text.is_empty() { "" } else { ": " };
        let how = how(protocol, sent.layout);
        lines.insert(format!("{} ({how}){space}{text}", sent.message.name));
        modes.insert(&protocol[sent.mode].name);
    }
    let modes: Vec<&str> = modes.into_iter().collect();
    let addressing = format!("Addressing: {}", modes.join(", "));
    lines.into_iter().chain([addressing]).collect::<Vec<_>>().join("\n")
}

/// Names each group after its message, kind and node. If that is ambiguous, it adds the mode or the
/// identifier.
fn names(protocol: &Protocol, groups: &[Group]) -> Vec<String> {
    let mut plain = Vec::new();
    for group in groups {
        let message = group.tree.message().unwrap_or(&protocol.name);
        let mode = common(&group.sent, |sent| sent.mode).map(|mode| protocol[mode].name.clone());
        plain.push((format!("{message}_{}", group.sent[0].layout.kind.name()), mode));
    }
    let mut modes: HashMap<&str, HashSet<Option<&str>>> = HashMap::new();
    for (name, mode) in &plain {
        modes.entry(name).or_default().insert(mode.as_deref());
    }
    let mut names = Vec::new();
    for (group, (name, mode)) in groups.iter().zip(&plain) {
        let is_sent_otherwise = modes[name.as_str()].len() > 1;
        let mode = mode.clone().filter(|_| is_sent_otherwise);
        let node = common(&group.sent, |sent| sent.node).flatten().map(|node| node.to_string());
        names.push([Some(name.clone()), mode, node].into_iter().flatten().collect::<Vec<_>>().join("_"));
    }
    let mut counts: HashMap<&str, usize> = HashMap::new();
    for name in &names {
        *counts.entry(name).or_default() += 1;
    }
    let is_single = |name: &String| counts[name.as_str()] == 1;
    let numbered = names
        .iter()
        .zip(groups)
        .map(|(name, group)| if is_single(name) { name.clone() } else { format!("{name}_{:X}", group.sent[0].id) });
    numbered.collect()
}
