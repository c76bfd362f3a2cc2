//! Reads logs and DBC files in memory.

use canspec_codegen::interpret::decode;
use canspec_codegen::model::Protocol;

use crate::command::encode;
use crate::command::import;
use crate::log::Reader;
use crate::log::capture::Capture;
use crate::show::kept::Kept;
use crate::show::line;
use crate::show::outcome::Outcome;
use crate::show::table::Table;

/// A decoded line of a log.
pub struct Shown {
    /// The JSON object.
    pub json: String,
    /// A table with only the frame.
    pub table: String,
    /// A capture with only the frame, or why there is none.
    pub capture: Result<Vec<u8>, String>,
}

/// A log that is read line by line.
#[derive(Default)]
pub struct Log(Reader);

impl Log {
    /// Decodes the next line, `None` of one without a frame.
    ///
    /// # Errors
    ///
    /// Says why the line is unreadable.
    pub fn decoded(&mut self, protocol: &Protocol, line: &str) -> Result<Option<Shown>, String> {
        let Some(entry) = self.0.read(line)? else { return Ok(None) };
        let (time, channel, frame) = (entry.time.as_deref(), entry.channel, &entry.frame);
        let decoded = &decode(protocol, None, frame);
        let outcome = Outcome { line: 1, time, channel, frame, protocol, decoded, whole: None };
        let (mut json, mut table, mut bytes) = (Vec::new(), Vec::new(), Vec::new());
        let unwritten = |error: std::io::Error| error.to_string();
        line::write(&mut json, &mut Kept::default(), &outcome);
        Table::new(std::slice::from_ref(protocol)).write(&mut table, &mut Kept::default(), &outcome);
        let capture = Capture::begin(&mut bytes).map_err(unwritten)?.frame(&mut bytes, &entry);
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).map_err(|error| error.to_string());
        Ok(Some(Shown { json: text(json)?, table: text(table)?, capture: capture.map(|_| bytes) }))
    }
}

/// Makes the lines of a log from a JSON object. A blank line gives none.
///
/// # Errors
///
/// Says why there is no such frame.
pub fn encoded(protocol: &Protocol, json: &str) -> Result<String, String> {
    encode::Encoder::default().line(&[(protocol, None)], json)
}

/// Makes a spec of a DBC.
///
/// # Errors
///
/// The bytes are no DBC.
pub fn imported(bytes: Vec<u8>) -> Result<String, String> {
    import::imported(bytes)
}
