#![doc = include_str!("../rules/overlap.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Doc, Message, Protocol, SelectorPlace, Shape, Signal};

/// A leaf of a frame: its name, its remarks, its bits with byte 0 highest.
type Leaf<'a> = (&'a str, &'a Doc, u64);

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let mut reported = Vec::new();
        for shape in &message.shapes {
            let leaves = leaves(protocol, message, shape);
            for (index, one) in leaves.iter().enumerate() {
                for other in leaves[..index].iter().filter(|other| one.2 & other.2 != 0) {
                    if !reported.contains(&(one.0, other.0)) {
                        reported.push((one.0, other.0));
                        report(message, one, other, diagnostics);
                    }
                }
            }
        }
        for signal in &message.signals {
            check_parts(message, signal, diagnostics);
        }
    }
}

fn leaves<'a>(protocol: &'a Protocol, message: &'a Message, shape: &Shape) -> Vec<Leaf<'a>> {
    let signals = shape.signals.iter().map(|index| leaf(&message.signals[*index]));
    let selectors = shape.selectors.iter().filter_map(|index| {
        let selector = &protocol.selectors[*index];
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

fn check_parts(message: &Message, signal: &Signal, diagnostics: &mut Diagnostics) {
    let crate::model::Encoding::Packed { parts, .. } = &signal.encoding else { return };
    for (index, one) in parts.iter().enumerate() {
        for other in parts[..index].iter().filter(|other| leaf(one).2 & leaf(other).2 != 0) {
            report(message, &leaf(one), &leaf(other), diagnostics);
        }
    }
}

fn report(message: &Message, one: &Leaf, other: &Leaf, diagnostics: &mut Diagnostics) {
    let text = format!("`{}` and `{}` of `{}` share {}", other.0, one.0, message.name, bits(one.2 & other.2));
    let help = "correct one of the two places, or remove one of the two";
    let diagnostic = Diagnostic::error("overlap", one.1.path.at_key(), text).help(help);
    diagnostics.push(diagnostic.other(other.1.path.at_key(), "the other one"));
}

/// Names bits of the frame: byte, and bits of the byte.
fn bits(mask: u64) -> String {
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
