//! Tests that what a transport carries fits its standard, and that the first frame shows which message comes.

mod isotp;
mod j1939;

use crate::model::{LongMessage, Protocol, Standard};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::resolve::rules;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for (id, transport) in protocol.transports.entries() {
        let carried = protocol.long_messages.iter().filter(|long| long.transport() == Some(id));
        let (mut announced, mut heads) = (j1939::Announced::default(), isotp::Heads::default());
        for long in carried {
            if let Some(flaw) = partial(long) {
                diagnostics.push(flaw);
            }
            match &transport.standard {
                Standard::J1939(groups) => j1939::check(protocol, groups, long, &mut announced, diagnostics),
                Standard::Isotp(_) => isotp::check(protocol, long, &mut heads, diagnostics),
            }
        }
    }
}

/// Finds a field that only some kinds of frames with fields have.
fn partial(long: &LongMessage) -> Option<Diagnostic> {
    let mut carrying = long.frames.iter().filter(|layout| !layout.signals.is_empty());
    carrying.find(|layout| layout.signals.len() < long.content.signals.len())?;
    let signal = long.content.signals.iter().find(|signal| !signal.kinds.is_empty())?;
    let (field, name) = (long.content.field_name(signal), &long.content.name);
    let text = format!("only some frames of `{name}` have `{field}`, and others have the rest of its fields");
    let help = "each kind of frame has all fields or none, so that they are one struct; make two messages of it";
    Some(Diagnostic::error(&rules::TRANSPORT, signal.doc.path.key("in").at_key(), text).help(help))
}
