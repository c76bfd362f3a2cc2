//! `canspec decode`.

mod ahead;
mod assemblies;
mod choice;
pub mod rows;
mod summary;

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use canspec_codegen::interpret::{Assembled, Decoded, Frame, Taken, Unrecognised};
use canspec_codegen::model::Protocol;
use clap::{Args, ValueEnum};

use crate::choose::channels::{Channels, Others};
use crate::choose::device::{Device, Model};
use crate::choose::protocols::{self, Several};
use crate::failure::{Failure, Finish, shown, tell};
use crate::log::capture::{Capture, Sealed};
use crate::log::input::{Input, Line};
use crate::log::{Asides, Entry, Reader};
use crate::output::{self, output};
use crate::show::kept::Kept;
use crate::show::line;
use crate::show::outcome::{Outcome, Whole};
use crate::show::table::Table;
use assemblies::{Assemblies, Mark};
use choice::Choice;
use rows::Rows;
use summary::Summary;

/// Decode a log of a CAN bus.
///
/// The log comes from candump, an SLCAN adapter, Vector's programs (ASC) or those of PEAK (TRC), or is a table in CSV.
/// canspec recognises the format. Unreadable lines are reported and skipped.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = EXAMPLES)]
pub struct Decode {
    #[command(flatten)]
    protocols: Several,
    #[command(flatten)]
    model: Model,
    #[command(flatten)]
    channels: Channels,
    #[command(flatten)]
    choice: Choice,
    /// A table, a JSON object for each frame, or a row of CSV for each signal.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Add messages that are longer than a frame, put together; tables show them in any case.
    #[arg(long, conflicts_with = "to")]
    assemble: bool,
    /// Show the frames of such messages in the table, too.
    #[arg(long, conflicts_with_all = ["summary", "to"])]
    frames: bool,
    /// Counts and rates in place of the frames.
    #[arg(long, conflicts_with = "to")]
    summary: bool,
    #[command(flatten)]
    capture: ToCapture,
    /// The log; standard input without one, or for `-`.
    file: Option<PathBuf>,
}

/// The capture to write.
#[derive(Args)]
struct ToCapture {
    /// Write the frames, as they are, to a capture for Wireshark; FORMAT is `pcapng`, OUT a file or `-`.
    #[arg(long, num_args = 2, value_names = ["FORMAT", "OUT"], conflicts_with_all = ["protocol", "spec", "name", "format"])]
    to: Vec<String>,
    /// Write the capture over any file, also one that others wrote or changed.
    #[arg(long, requires = "to")]
    force: bool,
}

const EXAMPLES: &str = "Examples:
  candump -L can0 | canspec decode --protocol NAME
  canspec decode --protocol NAME --summary bus.asc
  canspec decode --protocol NAME --message output --signal voltage --format csv bus.log
  canspec decode --to pcapng bus.pcapng bus.log
  candump -L can0 | canspec decode --to pcapng - | wireshark -k -i -

A capture is read as the table that tshark makes of it:
  (echo time,channel,id_dec,ext,remote,error,data
   tshark -r bus.pcapng -T fields -E separator=, -e frame.time_epoch -e frame.interface_name \\
     -e can.id -e can.flags.xtd -e can.flags.rtr -e can.flags.err -e data.data) | canspec decode --protocol NAME";

/// Bytes that are written at once, if the input does not pause.
const BUFFER: usize = 1 << 16;

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Jsonl,
    Csv,
}

/// What the lines so far decide about those to come.
#[derive(Clone)]
struct State {
    reader: Reader,
    /// Long messages, if they are put together.
    assemblies: Option<Assemblies>,
    printer: Printer,
}

impl State {
    /// Tests whether the lines to come are surely read and written in the same way.
    fn is_like(&self, other: &Self) -> bool {
        self.reader.is_like(&other.reader)
            && self.assemblies == other.assemblies
            && self.printer.is_like(&other.printer)
    }
}

/// What a worker has of the lines so far.
struct Work<'a> {
    state: State,
    counts: Counts,
    kept: Kept<'a>,
}

impl<'a> Work<'a> {
    /// Begins a part of the log behind the lines so far. `kept` is what was kept of other parts.
    fn after(&self, kept: Kept<'a>) -> Self {
        Self { state: self.state.clone(), counts: Counts::default(), kept }
    }
}

/// What is counted of a log.
#[derive(Default)]
struct Counts {
    frames: u64,
    recognised: u64,
    others: Others,
}

impl Counts {
    /// Adds the counts of another part of the log.
    fn join(&mut self, part: Self) {
        self.frames += part.frames;
        self.recognised += part.recognised;
        self.others.join(part.others);
    }
}

#[derive(Clone)]
enum Printer {
    Text(Table),
    Jsonl,
    Csv(Rows),
    Summary { counts: Box<Summary>, jsonl: bool },
}

impl Decode {
    /// Writes each frame of the log as the chosen protocols understand it.
    pub fn run(&self) -> Result<Finish, Failure> {
        match self.capture.to.as_slice() {
            [format, out] if format == "pcapng" => self.capture(Path::new(out)),
            [format, ..] => Err(Failure::Call(format!("unknown format `{format}`; a capture is written as `pcapng`"))),
            [] => self.print(),
        }
    }

    fn capture(&self, path: &Path) -> Result<Finish, Failure> {
        let log = Input::open_log(self.file.as_deref())?.summed_up();
        if path == Path::new("-") {
            let mut out = BufWriter::new(output()?);
            let capture = Capture::begin(&mut out)?;
            return self.write_capture(log, out, capture);
        }
        let failure = |error: io::Error| Failure::input(path, &error);
        if log.is_at(path) {
            let why = format!("{} is the log itself; name another file for the capture", shown(path));
            return Err(Failure::Call(why));
        }
        let out = BufWriter::new(Sealed::create(path, self.capture.force).map_err(failure)?);
        let finish = self.write_capture(log, out, Capture::default());
        finish.map_err(|why| if let Failure::Output(error) = why { failure(error) } else { why })
    }

    fn write_capture(&self, log: Input, mut out: impl Write, mut capture: Capture) -> Result<Finish, Failure> {
        let (mut reader, mut counts) = (Reader::default(), Counts::default());
        let finish = log.each(&mut out, |out, line| {
            let entry = reader.read(line.text?)?.filter(|entry| self.channels.keep(entry.channel, &mut counts.others));
            counts.frames += u64::from(entry.is_some());
            entry.map_or(Ok(Ok(())), |entry| capture.frame(out, &entry))
        });
        let finish = finish?;
        out.flush()?;
        self.suggest(&counts, finish);
        Ok(finish)
    }

    fn print(&self) -> Result<Finish, Failure> {
        let settings = self.protocols.choice()?;
        let protocols = protocols::load_all(&settings)?;
        let models = self.model.find(&protocols, &settings)?;
        self.choice.check(&protocols)?;
        let devices: Vec<_> = protocols.iter().zip(models).collect();
        let is_table = matches!(self.format, Format::Text);
        let assemblies = (self.assemble || is_table).then(Assemblies::default);
        let state = State { reader: Reader::default(), assemblies, printer: self.printer(&protocols)? };
        let mut work = Work { state, counts: Counts::default(), kept: Kept::default() };
        let mut out = BufWriter::with_capacity(BUFFER, output()?);
        let open = if self.summary { Input::open_whole } else { Input::open_log };
        let mut input = open(self.file.as_deref())?;
        if let Printer::Text(table) = &mut work.state.printer {
            input.foresee(|entry| table.expect(entry.time.as_deref(), entry.channel))?;
        }
        let finish = if input.has_parts() && !self.summary {
            ahead::decode(input, &mut out, &mut work, |work, out, line| self.line(&devices, work, out, line))?
        } else {
            let mut text = Vec::new();
            input.each(&mut out, |out, line| {
                text.clear();
                self.line(&devices, &mut work, &mut text, line).map(|()| out.write_all(&text))
            })?
        };
        let Work { mut state, counts, mut kept } = work;
        for (protocol, channel, whole) in state.assemblies.iter_mut().flat_map(|known| known.finish(&devices)) {
            let mut text = Vec::new();
            let printer = (&mut state.printer, &mut kept);
            self.show_whole(printer, &mut text, protocol, channel.as_deref(), whole);
            out.write_all(&text)?;
        }
        state.printer.end(state.reader.asides(), &mut out)?;
        out.flush()?;
        self.suggest(&counts, finish);
        if counts.frames > 0 && counts.recognised == 0 {
            self.suggest_identify();
        }
        Ok(finish)
    }

    /// Writes what the protocols say of a line.
    fn line<'a>(
        &self,
        devices: &[Device<'a>],
        Work { state, counts, kept }: &mut Work<'a>,
        out: &mut Vec<u8>,
        line: Line<'_>,
    ) -> Result<(), String> {
        let Some(entry) = state.reader.read(line.text?)? else { return Ok(()) };
        if !self.channels.keep(entry.channel, &mut counts.others) {
            return Ok(());
        }
        let decoded = decode(kept, devices, &entry.frame);
        counts.frames += 1;
        counts.recognised += u64::from(decoded.as_ref().is_some_and(|(_, decoded)| decoded.is_ok()));
        let Some((device, mut decoded)) = decoded else { return Ok(()) };
        let taken = match (&mut state.assemblies, &decoded) {
            (Some(assemblies), Ok(decoded)) => assemblies.take(device, line.number, &entry, decoded),
            _ => Taken { is_part: false, ended: Vec::new() },
        };
        let is_hidden = taken.is_part && matches!(self.format, Format::Text) && !self.frames && !self.summary;
        if !is_hidden {
            let printer = (&mut state.printer, &mut *kept);
            self.show(printer, out, line.number, &entry, (device.0, &mut decoded));
        }
        for whole in taken.ended {
            self.show_whole((&mut state.printer, &mut *kept), out, device.0, entry.channel, whole);
        }
        Ok(())
    }

    /// Says why nothing is shown: no frame is of a chosen channel, or there is none. A summary counts none itself.
    fn suggest(&self, counts: &Counts, finish: Finish) {
        let is_empty = counts.frames == 0 && finish == Finish::Done && !self.summary;
        let hint = self.channels.hint(counts.frames, &counts.others);
        if let Some(hint) = hint.or_else(|| is_empty.then(|| "the log has no frame".to_owned())) {
            tell(format_args!("canspec: {hint}"));
        }
    }

    /// Says how to find the protocol of a log in which nothing was recognised.
    fn suggest_identify(&self) {
        let log = self.file.as_deref().map_or("LOG".to_owned(), shown);
        tell(format_args!("canspec: no frame was recognised; `canspec identify {log}` tries every built-in protocol"));
    }

    fn printer(&self, protocols: &[Protocol]) -> Result<Printer, Failure> {
        match (self.format, self.summary) {
            (Format::Csv, true) => {
                Err(Failure::Call("a summary has several tables; choose the format `text` or `jsonl`".to_owned()))
            }
            (format, true) => {
                let jsonl = matches!(format, Format::Jsonl);
                Ok(Printer::Summary { counts: Box::default(), jsonl })
            }
            (Format::Text, false) => Ok(Printer::Text(Table::new(protocols).within(output::width()))),
            (Format::Jsonl, false) => Ok(Printer::Jsonl),
            (Format::Csv, false) => Ok(Printer::Csv(Rows::default())),
        }
    }

    fn show(
        &self,
        (printer, kept): (&mut Printer, &mut Kept),
        out: &mut Vec<u8>,
        line: usize,
        entry: &Entry<'_>,
        (protocol, decoded): (&Protocol, &mut Result<Decoded, Unrecognised>),
    ) {
        let is_chosen = match decoded {
            Ok(decoded) => self.choice.keep(protocol, decoded),
            Err(_) => self.choice.is_everything(),
        };
        if !is_chosen {
            return;
        }
        let Entry { time, channel, frame, .. } = entry;
        let (time, channel) = (time.as_deref(), *channel);
        printer.frame(out, kept, &Outcome { line, time, channel, frame, protocol, decoded, whole: None });
    }

    fn show_whole(
        &self,
        (printer, kept): (&mut Printer, &mut Kept),
        out: &mut Vec<u8>,
        protocol: &Protocol,
        channel: Option<&str>,
        assembled: Assembled<Mark>,
    ) {
        let Assembled { marks, frame, mut decoded, data, reserved, counter, incomplete } = assembled;
        if !self.choice.keep(protocol, &mut decoded) {
            return;
        }
        let lines: Vec<_> = marks.iter().map(|mark| mark.line).collect();
        let last = marks.last();
        let whole = Whole {
            lines: &lines,
            data: data.as_deref(),
            reserved: &reserved,
            counter: counter.as_ref().map(|(name, value)| (name.as_str(), *value)),
            incomplete: incomplete.as_deref(),
        };
        let (line, time) = (last.map_or(0, |mark| mark.line), last.and_then(|mark| mark.time.as_deref()));
        let (frame, decoded) = (&frame, &Ok(decoded));
        printer.frame(out, kept, &Outcome { line, time, channel, frame, protocol, decoded, whole: Some(whole) });
    }
}

impl Printer {
    /// Tests whether the frames to come are surely written in the same way.
    fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Text(one), Self::Text(another)) => one.is_like(another),
            (Self::Csv(one), Self::Csv(another)) => one == another,
            (Self::Jsonl, Self::Jsonl) => true,
            _ => false,
        }
    }

    fn frame(&mut self, out: &mut Vec<u8>, kept: &mut Kept, outcome: &Outcome<'_>) {
        match self {
            Self::Text(table) => table.write(out, kept, outcome),
            Self::Jsonl => line::write(out, kept, outcome),
            Self::Csv(rows) => rows.write(out, kept, outcome),
            Self::Summary { counts, .. } => counts.count(outcome),
        }
    }

    /// Writes what comes after the last frame.
    fn end(&mut self, asides: Asides, out: &mut impl Write) -> io::Result<()> {
        match self {
            Self::Text(_) | Self::Jsonl => Ok(()),
            Self::Csv(rows) => out.write_all(rows.begin().as_bytes()),
            Self::Summary { counts, jsonl: true } => counts.write_jsonl(asides, out),
            Self::Summary { counts, jsonl: false } => counts.write_text(asides, out),
        }
    }
}

/// What a protocol says of a frame.
type Answer<'a> = (Device<'a>, Result<Decoded, Unrecognised>);

/// Decodes by the first protocol that recognises the frame. If none does, it is the one whose tests the frame passes
/// furthest.
fn decode<'a>(kept: &mut Kept<'a>, devices: &[Device<'a>], frame: &Frame) -> Option<Answer<'a>> {
    let mut nearest: Option<(Device<'a>, Unrecognised)> = None;
    for &device in devices {
        match kept.decode(device, frame) {
            Ok(decoded) => return Some((device, Ok(decoded))),
            Err(other) => {
                // The tests are counted in their order.
                let is_nearer = |(_, known): &(_, Unrecognised)| other.problem as u8 > known.problem as u8;
                if nearest.as_ref().is_none_or(is_nearer) {
                    nearest = Some((device, other));
                }
            }
        }
    }
    nearest.map(|(device, unrecognised)| (device, Err(unrecognised)))
}
