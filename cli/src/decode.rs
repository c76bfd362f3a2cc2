//! `canspec decode`.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use canspec_codegen::interpret::{self, Decoded, Frame, Unrecognised};
use canspec_codegen::model::{ModelId, Protocol};
use clap::{Args, ValueEnum};

use crate::capture::Capture;
use crate::failure::{Failure, Finish, shown};
use crate::input::Input;
use crate::line::{self, Origin};
use crate::log::{self, Entry};
use crate::model::Model;
use crate::output::output;
use crate::protocols::Several;
use crate::table::Table;

/// Decode a log of a CAN bus.
///
/// The log is one of candump, of an SLCAN adapter, of Vector's programs (ASC), or a table in CSV. The lines show
/// which. Unreadable lines are reported and skipped.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = EXAMPLES)]
pub struct Decode {
    #[command(flatten)]
    protocols: Several,
    #[command(flatten)]
    model: Model,
    /// A table, or a JSON object a frame.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Write the frames, as they are, to a capture for Wireshark; FORMAT is `pcapng`.
    #[arg(long, num_args = 2, value_names = ["FORMAT", "OUT"], group = "Several", conflicts_with_all = ["name", "format"])]
    to: Vec<String>,
    /// The log; standard input without one, or for `-`.
    file: Option<PathBuf>,
}

const EXAMPLES: &str = "Examples:
  candump -L can0 | canspec decode --protocol NAME
  canspec decode --to pcapng bus.pcapng bus.log";

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Jsonl,
}

enum Printer {
    Text(Table),
    Jsonl,
}

impl Decode {
    /// Writes each frame of the log as the chosen protocols understand it.
    pub fn run(&self) -> Result<Finish, Failure> {
        match self.to.as_slice() {
            [format, out] if format == "pcapng" => self.capture(Path::new(out)),
            [format, ..] => Err(Failure::Call(format!("unknown format `{format}`; a capture is written as `pcapng`"))),
            [] => self.print(),
        }
    }

    fn capture(&self, path: &Path) -> Result<Finish, Failure> {
        let failure = |error: io::Error| Failure::input(path, &error);
        let log = Input::open(self.file.as_deref())?;
        if log.is_at(path) {
            let why = format!("{} is the log itself; name another file for the capture", shown(path));
            return Err(Failure::Call(why));
        }
        let mut out = BufWriter::new(File::create(path).map_err(failure)?);
        let mut capture = Capture::begin(&mut out).map_err(failure)?;
        let finish = log.each(out, |out, line| {
            let entry = line.text.and_then(log::read)?;
            entry.map_or(Ok(Ok(())), |entry| capture.frame(out, &entry))
        });
        finish.map_err(|why| if let Failure::Output(error) = why { failure(error) } else { why })
    }

    fn print(&self) -> Result<Finish, Failure> {
        let protocols = self.protocols.load()?;
        let models = self.model.find(&protocols)?;
        let devices: Vec<_> = protocols.iter().zip(models).collect();
        let mut printer = self.printer(&protocols);
        let out = BufWriter::new(output()?);
        Input::open(self.file.as_deref())?.each(out, |out, line| {
            let entry = line.text.and_then(log::read)?;
            Ok(entry.map_or(Ok(()), |entry| printer.frame(out, &devices, line.number, &entry)))
        })
    }

    fn printer(&self, protocols: &[Protocol]) -> Printer {
        match self.format {
            Format::Text => Printer::Text(Table::new(protocols)),
            Format::Jsonl => Printer::Jsonl,
        }
    }
}

impl Printer {
    fn frame(
        &mut self,
        out: &mut impl Write,
        devices: &[Device<'_>],
        line: usize,
        entry: &Entry<'_>,
    ) -> io::Result<()> {
        let Some((protocol, decoded)) = decode(devices, &entry.frame) else { return Ok(()) };
        let Entry { time, channel, frame, .. } = entry;
        let origin = Origin { line, time: time.as_deref(), channel: *channel, frame, protocol };
        match self {
            Self::Text(table) => table.write(out, &origin, &decoded),
            Self::Jsonl => line::write(out, &origin, &decoded),
        }
    }
}

/// A protocol, and the device model if one of its models is chosen.
type Device<'a> = (&'a Protocol, Option<ModelId>);

/// Decodes by the first protocol that recognises the frame, else says what the first one has against it.
fn decode<'a>(devices: &[Device<'a>], frame: &Frame) -> Option<(&'a Protocol, Result<Decoded, Unrecognised>)> {
    let by = |(protocol, model): &Device<'a>| (*protocol, interpret::decode(protocol, *model, frame));
    devices.iter().map(by).find(|(_, decoded)| decoded.is_ok()).or_else(|| devices.first().map(by))
}
