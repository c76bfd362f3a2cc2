//! What a spec takes over from another one.

use std::io::{self, Write};

use canspec_codegen::model::{Derivation, Descent, MessageId, Protocol};
use canspec_codegen::text::Text;

use crate::show::columns;

/// Writes what a spec is based on and what it changes, if it has a base.
pub fn write(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let Some(Derivation { base, replaces, removes, .. }) = &protocol.derivation else { return Ok(()) };
    columns::text(out, &format!("Based on {}.", base.for_people()))?;
    for (what, paths) in [("Replaces", replaces), ("Removes", removes)] {
        if !paths.is_empty() {
            let paths = paths.iter().map(Text::for_people).collect::<Vec<_>>().join(", ");
            columns::text(out, &format!("{what} {paths}."))?;
        }
    }
    Ok(())
}

/// Says where a message comes from, if the spec has a base.
pub fn descent(protocol: &Protocol, message: MessageId) -> Option<String> {
    let Derivation { base, descents, .. } = protocol.derivation.as_ref()?;
    Some(match descents[message] {
        Descent::Own => "own".to_owned(),
        Descent::Changed => format!("{}, changed", base.for_people()),
        Descent::TakenOver => base.for_people().to_owned(),
    })
}
