//! What ISO-TP asks of its messages: the first six bytes show which one it is, and one node answers its first frame.

use indexmap::IndexMap;

use crate::check::ambiguous::fixed;
use crate::model::{FieldId, FrameLayout, LongMessage, Protocol, Side, Signal, Travel, Who};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::resolve::rules;

/// Data bytes that a first frame has, and that a single frame has.
const FIRST: usize = 6;
const SINGLE: usize = 7;

/// Tests a message, and those of the same transport before it, which have these heads.
pub fn check<'a>(protocol: &Protocol, long: &'a LongMessage, earlier: &mut Heads<'a>, diagnostics: &mut Diagnostics) {
    if let Some(flaw) = long.frames.iter().find_map(|layout| flaw(protocol, long, layout)) {
        diagnostics.push(flaw);
    }
    if let Some(other) = earlier.alike(long) {
        diagnostics.push(alike(long, other));
    }
    earlier.add(long);
}

/// What the frames of messages show, as far as it tells messages apart. Frames that show the same bits are found at
/// once, however many there are.
#[derive(Default)]
pub struct Heads<'a> {
    messages: Vec<&'a LongMessage>,
    /// By what the frames show: the data bits, each with the place of its first message.
    shapes: IndexMap<Shape, IndexMap<u64, usize>>,
}

/// What all frames of a kind show.
#[derive(PartialEq, Eq, Hash)]
struct Shape {
    sender: Side,
    identifier: Vec<(FieldId, u32)>,
    /// The data bits that constants fix.
    mask: u64,
}

impl Shape {
    /// Returns the shape of a frame, and its data bits.
    fn of(layout: &FrameLayout) -> (Self, u64) {
        let (mask, bits) = fixed(layout);
        (Self { sender: layout.sender, identifier: layout.identifier().collect(), mask }, bits & mask)
    }

    /// Tests whether one identifier fits both.
    fn fits(&self, other: &Self) -> bool {
        let differs =
            |(field, value): &(_, _)| other.identifier.iter().any(|known| known.0 == *field && known.1 != *value);
        self.sender == other.sender && !self.identifier.iter().any(differs)
    }
}

impl<'a> Heads<'a> {
    fn add(&mut self, long: &'a LongMessage) {
        for layout in &long.frames {
            let (shape, bits) = Shape::of(layout);
            self.shapes.entry(shape).or_default().entry(bits).or_insert(self.messages.len());
        }
        self.messages.push(long);
    }

    /// Finds the first message whose data can be those of another one, too.
    fn alike(&self, long: &LongMessage) -> Option<&'a LongMessage> {
        let places = long.frames.iter().filter_map(|layout| {
            let (own, bits) = Shape::of(layout);
            let fitting = self.shapes.iter().filter(|(shape, _)| shape.fits(&own));
            fitting.filter_map(|(shape, known)| first_alike(known, bits, own.mask, shape.mask)).min()
        });
        places.min().map(|place| self.messages[place])
    }
}

/// Finds the first message whose data bits are equal where both are fixed.
fn first_alike(known: &IndexMap<u64, usize>, bits: u64, mask: u64, others: u64) -> Option<usize> {
    if mask == others {
        return known.get(&bits).copied();
    }
    let alike = known.iter().filter(|(other, _)| mask & others & (bits ^ *other) == 0);
    alike.map(|(_, place)| *place).min()
}

/// Finds what is wrong with one of the ways in which a message is sent.
fn flaw(protocol: &Protocol, long: &LongMessage, layout: &FrameLayout) -> Option<Diagnostic> {
    let (extent, name, kind) = (long.extent(layout), &long.content.name, layout.kind.name());
    let path = &long.content.doc.path;
    let error = |at, text: String, help: &str| Some(Diagnostic::error(&rules::TRANSPORT, at, text).help(help));
    if extent.longest() == 0 {
        let text = format!("a {kind} of `{name}` has no data byte, and ISO-TP carries at least one");
        return error(path.at_key(), text, "name a field of the header in `match` or the access, or write `fields`");
    }
    if layout.head() > FIRST {
        let text = format!("the header of `{name}` has {} bytes, and the first frame shows {FIRST}", layout.head());
        return error(
            path.key("via").at_key(),
            text,
            "make fields of the message of what does not tell messages apart",
        );
    }
    if let Some(length) = extent.lengths().iter().find(|length| usize::from(**length) < layout.head()) {
        let text = format!("a {kind} of `{name}` has no room for its header in the length {length}");
        return error(path.key("length").at_key(), text, "count the bytes of the header in `length`, too");
    }
    if let Some((_, signal)) = extent.signals().find(|(_, signal)| is_covered(signal, layout)) {
        let text = format!("`{}` stands where the header or a constant of `{name}` does", signal.name);
        return error(signal.doc.path.at_key(), text, "fields count from byte 0 of the whole message; move the field");
    }
    let to_many = |travel: &&Travel| matches!(travel.who, Who::Each | Who::Coordinator);
    let travel = layout.travels.iter().find(to_many).filter(|_| layout.is_to_module() && extent.longest() > SINGLE)?;
    let mode = &protocol[travel.mode].name;
    let text = format!(
        "a {kind} of `{name}` has up to {} bytes, and goes to several nodes in the mode `{mode}`",
        extent.longest()
    );
    error(path.at_key(), text, "a message to several nodes has at most 7 bytes; leave the mode out in `answers`")
}

/// Tests whether a signal has bits of the header.
fn is_covered(signal: &Signal, layout: &FrameLayout) -> bool {
    let header = layout.covered.to_be_bytes();
    let own = header.into_iter().skip(signal.window.into()).zip(signal.masks());
    own.into_iter().any(|(header, mask)| header & mask != 0)
}

fn alike(long: &LongMessage, other: &LongMessage) -> Diagnostic {
    let text = format!("data can be of both `{}` and `{}`", other.content.name, long.content.name);
    let problem = Diagnostic::error(&rules::TRANSPORT, long.content.doc.path.at_key(), text);
    problem
        .other(other.content.doc.path.at_key(), "the other one")
        .help("let a constant in the first six bytes differ, in `match`, the access or a field")
}
