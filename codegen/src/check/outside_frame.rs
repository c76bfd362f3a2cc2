#![doc = include_str!("../../docs/rules/outside_frame.md")]

use canspec_runtime::Place;

use crate::model::{Message, Protocol, Selector, SelectorPlace, Signal};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;

rules! {
    OUTSIDE_FRAME "outside_frame" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for signal in &message.signals {
            if let Some(text) = outside(message, signal) {
                let help = "correct the place, or the `length` of the message";
                let at = place(&signal.doc.path, diagnostics);
                diagnostics.push_first(Diagnostic::error(&OUTSIDE_FRAME, at, text).help(help));
            }
        }
        check_selectors(protocol, message, diagnostics);
        check_lengths(message, diagnostics);
    }
}

/// Says that a signal lies beyond the longest frame, or that a shorter one has only a part of it.
fn outside(message: &Message, signal: &Signal) -> Option<String> {
    let (name, end) = (format!("`{}.{}`", message.name, signal.name), signal.end());
    if end > message.longest() {
        return Some(format!("{name} reaches byte {}, but the message has {}", end - 1, bytes(message.longest())));
    }
    let start = signal.start();
    let cut = message.lengths.iter().find(|length| (start + 1..end).contains(length))?;
    Some(format!("{name} takes bytes {start} to {}, but a frame can have {}", end - 1, bytes(*cut)))
}

/// Tests that what chooses a message is in its shortest frame.
fn check_selectors(protocol: &Protocol, message: &Message, diagnostics: &mut Diagnostics) {
    let selectors = protocol.frames_of(message).flat_map(|frame| &frame.selectors).map(|id| &protocol[*id]);
    let beyond = |selector: &&Selector| match selector.place {
        SelectorPlace::Payload(place) => last_byte(place) >= message.shortest(),
        SelectorPlace::Identifier(_) => false,
    };
    for selector in selectors.filter(beyond) {
        let (name, own, length) = (&selector.name, &message.doc.path, bytes(message.shortest()));
        let is_own = selector.doc.path.ancestors().any(|outer| outer == own);
        let (at, help) = if is_own {
            (place(&selector.doc.path, diagnostics), "correct the place, or the `length` of the message")
        } else if message.lengths.len() > 1 {
            (own.key("length").at_value(), "take the shortest length out, or correct the place")
        } else {
            (diagnostics.written(own, &["length"]), "write a greater `length`, or correct the place in the header")
        };
        let text = format!("`{name}` chooses `{}`, and a frame of {length} lacks it", message.name);
        diagnostics.push_first(Diagnostic::error(&OUTSIDE_FRAME, at, text).help(help));
    }
}

/// Tests that each longer frame carries more.
fn check_lengths(message: &Message, diagnostics: &mut Diagnostics) {
    for pair in message.lengths.windows(2) {
        let [shorter, longer] = pair else { continue };
        if !message.signals.iter().any(|signal| (shorter + 1..=*longer).contains(&signal.end())) {
            let text = format!("no field of `{}` ends between the lengths {shorter} and {longer}", message.name);
            let help = "name the field that only the longer frame has, or take one of the two out";
            let at = message.doc.path.key("length").at_value();
            return diagnostics.push_first(Diagnostic::error(&OUTSIDE_FRAME, at, text).help(help));
        }
    }
}

/// Returns the last byte of the frame in which a place has bits.
fn last_byte(place: Place) -> u8 {
    u8::try_from(7 - u64::from_be_bytes(place.mask()).trailing_zeros() / 8).unwrap_or(7)
}

/// Names the bytes of a frame, counted from 0 as `bytes` does.
fn bytes(length: u8) -> String {
    match length {
        0 => "no data bytes".to_owned(),
        1 => "byte 0 only".to_owned(),
        _ => format!("bytes 0 to {}", length - 1),
    }
}

/// Returns the place of `bytes`: of the field itself, or of the word around it.
fn place(field: &Path, diagnostics: &Diagnostics) -> At {
    let known = field.ancestors().map(|outer| outer.key("bytes")).find(|path| diagnostics.has(path));
    known.map_or_else(|| field.at_key(), |path| path.at_value())
}
