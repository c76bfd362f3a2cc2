#![doc = include_str!("../../docs/rules/overlap.md")]

use std::collections::{HashMap, HashSet};

use crate::model::{Doc, FrameLayout, Message, Protocol, SelectorPlace, Signal};
use crate::report::claims::{Claim, misplaced};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;

rules! {
    OVERLAP "overlap" Check ERROR;
}

/// A leaf of a frame: its name, its remarks, and its bits with byte 0 highest.
type Leaf<'a> = (&'a str, &'a Doc, u64);

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let mut reported = HashSet::new();
        for frame in protocol.frames_of(message) {
            check_leaves(message, &leaves(protocol, frame), &mut reported, diagnostics);
        }
        for signal in &message.signals {
            let parts: Vec<_> = signal.encoding.parts().iter().map(leaf).collect();
            check_leaves(message, &parts, &mut HashSet::new(), diagnostics);
        }
    }
    for long in &protocol.long_messages {
        check_windows(&long.content, diagnostics);
    }
}

/// Reports each pair of fields of a long message that share bits, once.
fn check_windows<'a>(content: &'a Message, diagnostics: &mut Diagnostics) {
    let mut owners: HashMap<(usize, u8), &'a Signal> = HashMap::new();
    let mut reported = HashSet::new();
    for signal in &content.signals {
        let bytes = signal.masks().into_iter().enumerate();
        let bits =
            bytes.flat_map(|(byte, mask)| (0..8).filter(move |bit| mask >> bit & 1 == 1).map(move |bit| (byte, bit)));
        for (byte, bit) in bits {
            let byte = byte + usize::from(signal.window);
            let Some(other) = owners.insert((byte, bit), signal) else { continue };
            let [one, two] = [other, signal].map(|signal| content.field_name(signal));
            if one != two && reported.insert([one, two]) {
                let text = format!("`{one}` and `{two}` of `{}` share byte {byte}", content.name);
                let help = "correct one of the two places, or remove one of the two";
                // Few fields have a width that is no power of two.
                let is_rare = |known: &Signal| !known.place.width().is_power_of_two();
                let accused = if is_rare(other) && !is_rare(signal) { [other, signal] } else { [signal, other] };
                let [at, other] = accused.map(|known| diagnostics.written(&known.doc.path, &["bytes", "bits"]));
                diagnostics.push(Diagnostic::error(&OVERLAP, at, text).help(help).other(other, "the other one"));
            }
        }
    }
}

/// Reports each pair of leaves that share bits, once.
fn check_leaves<'a>(
    message: &Message,
    leaves: &[Leaf<'a>],
    reported: &mut HashSet<(&'a str, &'a str)>,
    diagnostics: &mut Diagnostics,
) {
    let claims: Vec<_> = leaves.iter().map(|leaf| Claim::of_mask(leaf.2)).collect();
    for (later, one) in leaves.iter().enumerate() {
        for (earlier, other) in leaves[..later].iter().enumerate() {
            if one.2 & other.2 != 0 && reported.insert((one.0, other.0)) {
                report(message, [other, one], misplaced(&claims, earlier, later) == later, diagnostics);
            }
        }
    }
}

fn leaves<'a>(protocol: &'a Protocol, frame: &'a FrameLayout) -> Vec<Leaf<'a>> {
    let signals = protocol.signals_of(frame).map(|(_, signal)| leaf(signal));
    let selectors = frame.selectors.iter().filter_map(|id| {
        let selector = &protocol[*id];
        match selector.place {
            SelectorPlace::Payload(place) => {
                Some((selector.name.as_str(), &selector.doc, u64::from_be_bytes(place.mask())))
            }
            SelectorPlace::Identifier(_) => None,
        }
    });
    selectors.chain(signals).collect()
}

fn leaf(signal: &Signal) -> Leaf<'_> {
    (&signal.name, &signal.doc, u64::from_be_bytes(signal.place.mask()))
}

/// Reports two leaves. The later one is probably wrong if `is_later`, else the earlier one.
fn report(message: &Message, [earlier, later]: [&Leaf; 2], is_later: bool, diagnostics: &mut Diagnostics) {
    let text = format!("`{}` and `{}` of `{}` share {}", earlier.0, later.0, message.name, bits(earlier.2 & later.2));
    let repeated = [(later, earlier), (earlier, later)].into_iter().find(|(one, other)| repeats(one, other));
    let (wrong, right) = repeated.unwrap_or(if is_later { (later, earlier) } else { (earlier, later) });
    let help = match repeated {
        Some(_) => format!(
            "the header reads `{}` in this frame already, and `selectors` of JSON lines show it; \
             take the field out, or correct its place",
            right.0
        ),
        None => "correct one of the two places, or remove one of the two".to_owned(),
    };
    let at = |leaf: &Leaf| diagnostics.written(&leaf.1.path, &["bytes", "bits"]);
    let diagnostic = Diagnostic::error(&OVERLAP, at(wrong), text).help(help).other(at(right), "the other one");
    diagnostics.push(diagnostic);
}

/// Tests whether a field of a message reads bits that one field of the header holds.
fn repeats(one: &Leaf, other: &Leaf) -> bool {
    let is_of_header = |leaf: &Leaf| leaf.1.path.ancestors().any(|outer| *outer == Path::default().key("header"));
    !is_of_header(one) && is_of_header(other) && one.2 & !other.2 == 0
}

/// Names bits of the frame: byte, and bits of the byte.
pub fn bits(mask: u64) -> String {
    let bytes = mask.to_be_bytes().into_iter().enumerate().filter(|(_, byte)| *byte != 0);
    bytes.map(|(index, byte)| bits_of_byte(index, byte)).collect::<Vec<_>>().join(" and ")
}

fn bits_of_byte(index: usize, byte: u8) -> String {
    if byte == u8::MAX {
        return format!("byte {index}");
    }
    let set: Vec<_> = (0..8).rev().filter(|bit| byte >> bit & 1 == 1).map(|bit: u8| bit.to_string()).collect();
    let what = if set.len() == 1 { "bit" } else { "bits" };
    format!("{what} {} of byte {index}", set.join(", "))
}
