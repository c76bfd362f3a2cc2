//! `canspec identify`.

use std::cmp::Reverse;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use canspec_codegen::interpret::{Decoded, Frame, Value, decode};
use canspec_codegen::model::{NoteRule, Protocol};
use canspec_specs::SPECS;
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::choose::channels::{Channels, Others};
use crate::choose::protocols;
use crate::failure::{Failure, Finish};
use crate::log::Reader;
use crate::log::input::Input;
use crate::output::output;
use crate::show::columns::{self, Row};
use crate::show::line::bit_names;

/// Find out which protocols a log holds.
///
/// Tries each built-in protocol and each given spec on every frame. The one that recognises most frames without a
/// contradiction stands first. Protocols with the same numbers fit equally well, and the last lines say how many
/// frames they read differently. A contradiction is a note, such as a value outside its range or a reserved bit.
/// ALONE counts the frames that no other protocol recognises. A protocol without such frames shares all of them
/// with others, and need not be on the bus.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = "Example:\n  canspec identify --spec my.yaml --channel can1 bus.log")]
pub struct Identify {
    /// A spec file to try beside the built-in protocols; repeatable.
    #[arg(long, value_name = "FILE")]
    spec: Vec<PathBuf>,
    #[command(flatten)]
    channels: Channels,
    /// A table, or a JSON object for each protocol.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// The log; standard input without one, or for `-`.
    file: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Jsonl,
}

/// How well a protocol explains a log.
#[derive(Serialize)]
struct Candidate {
    #[serde(skip)]
    protocol: Protocol,
    /// How it differs from each tried protocol, in the order of trial.
    #[serde(skip)]
    unlike: Vec<Unlike>,
    /// Its own place in that order.
    #[serde(skip)]
    place: usize,
    #[serde(rename = "protocol")]
    name: String,
    recognised: u64,
    share: f64,
    contradicted: u64,
    alone: u64,
}

/// The frames that two protocols read differently.
#[derive(Clone, Copy, Default)]
struct Unlike {
    count: u64,
    /// The line of the first one, and what differs there.
    first: (usize, &'static str),
}

impl Unlike {
    fn add(&mut self, line: usize, what: &'static str) {
        self.count += 1;
        if self.count == 1 {
            self.first = (line, what);
        }
    }
}

/// What a protocol says of a frame.
struct Reading {
    message: String,
    values: String,
    /// Their numbers, since each document has its own words for them.
    addresses: Vec<i64>,
}

impl Reading {
    fn of(protocol: &Protocol, decoded: &Decoded, id: u32) -> Self {
        Self {
            message: format!("{} {}", decoded.content(protocol).name, decoded.kind.name()),
            values: values(protocol, decoded),
            addresses: decoded.addresses(protocol, id).map(|(_, number)| number).collect(),
        }
    }
}

/// Says in what two readings of a frame differ.
fn difference(own: Option<&Reading>, other: Option<&Reading>) -> Option<&'static str> {
    match (own, other) {
        (None, None) => None,
        (Some(_), None) => Some("which the other does not know"),
        (None, Some(_)) => Some("which it does not know"),
        (Some(own), Some(other)) => [
            (own.message != other.message, "as another message"),
            (own.values != other.values, "with other values"),
            (own.addresses != other.addresses, "with other addresses"),
        ]
        .into_iter()
        .find_map(|(differs, what)| differs.then_some(what)),
    }
}

impl Identify {
    /// Writes the protocols that recognise frames.
    pub fn run(&self) -> Result<Finish, Failure> {
        let mut candidates = self.candidates()?;
        let (mut reader, mut frames, mut others) = (Reader::default(), 0, Others::default());
        let finish = Input::open_whole(self.file.as_deref())?.each(io::sink(), |_, line| {
            let entry = reader.read(line.text?)?;
            if let Some(entry) = entry.filter(|entry| self.channels.keep(entry.channel, &mut others)) {
                frames += 1;
                try_all(&mut candidates, &entry.frame, line.number);
            }
            Ok(Ok(()))
        })?;
        candidates.retain(|candidate| candidate.recognised > 0);
        if candidates.is_empty() {
            let why = format!("no protocol recognises a frame of this log, which has {frames}");
            return Err(Failure::Input(self.channels.hint(frames, &others).unwrap_or(why)));
        }
        for candidate in &mut candidates {
            candidate.share = share(candidate.recognised, frames);
        }
        candidates.sort_by_key(|candidate| Reverse(candidate.fit()));
        self.write(&candidates)?;
        Ok(finish)
    }

    fn candidates(&self) -> Result<Vec<Candidate>, Failure> {
        let choice = protocols::chosen(&[], &self.spec)?;
        let files = choice.specs.iter().map(|path| protocols::load(protocols::chosen_file(&choice, path)?));
        let protocols = files.chain(SPECS.iter().map(protocols::load_built_in));
        let protocols = protocols.collect::<Result<Vec<_>, _>>()?;
        let count = protocols.len();
        Ok(protocols.into_iter().enumerate().map(|(place, known)| Candidate::new(known, place, count)).collect())
    }

    fn write(&self, candidates: &[Candidate]) -> io::Result<()> {
        let mut out = BufWriter::new(output()?);
        match self.format {
            Format::Text => {
                let rows: Vec<Row> = candidates.iter().map(Candidate::row).collect();
                columns::write(
                    &mut out,
                    &["PROTOCOL", "RECOGNISED", "SHARE", "CONTRADICTED", "ALONE"],
                    "TITLE",
                    &rows,
                )?;
                write_equals(&mut out, candidates)?;
            }
            Format::Jsonl => {
                for candidate in candidates {
                    serde_json::to_writer(&mut out, candidate)?;
                    writeln!(out)?;
                }
            }
        }
        out.flush()
    }
}

/// Counts a frame for each protocol that recognises it, and notes which ones read it differently.
fn try_all(candidates: &mut [Candidate], frame: &Frame, line: usize) {
    let readings: Vec<_> = candidates.iter_mut().map(|candidate| candidate.try_on(frame)).collect();
    if readings.iter().flatten().count() == 1 {
        candidates.iter_mut().zip(&readings).for_each(|(known, own)| known.alone += u64::from(own.is_some()));
    }
    for (candidate, own) in candidates.iter_mut().zip(&readings) {
        for (unlike, other) in candidate.unlike.iter_mut().zip(&readings) {
            if let Some(what) = difference(own.as_ref(), other.as_ref()) {
                unlike.add(line, what);
            }
        }
    }
}

/// Says how protocols differ that fit equally well.
fn write_equals(out: &mut impl Write, candidates: &[Candidate]) -> io::Result<()> {
    let best = candidates.chunk_by(|one, next| one.fit() == next.fit()).next().unwrap_or_default();
    let [first, others @ ..] = best else { return Ok(()) };
    if others.is_empty() {
        return Ok(());
    }
    let names: Vec<_> = best.iter().map(|candidate| candidate.name.as_str()).collect();
    writeln!(out, "\n{} fit equally well; TITLE says what their devices are", names.join(", "))?;
    others.iter().try_for_each(|other| match other.unlike[first.place] {
        Unlike { count: 0, .. } => {
            writeln!(out, "{} reads the same messages, values and addresses as {} in this log", other.name, first.name)
        }
        Unlike { count, first: (line, what) } => {
            let frames = if count == 1 { "1 frame".to_owned() } else { format!("{count} frames") };
            writeln!(out, "{} reads {frames} unlike {}, the first in line {line}, {what}", other.name, first.name)
        }
    })
}

/// Returns the values of a frame as a text.
fn values(protocol: &Protocol, decoded: &Decoded) -> String {
    let content = decoded.content(protocol);
    let values = decoded.signals.iter().map(|read| {
        let signal = &content[read.signal];
        let unit = signal.unit.as_ref().map_or("", |unit| &unit.symbol);
        let value = match &read.value {
            Value::None => format!("raw {}", read.bits),
            Value::Status { set, unknown } => {
                format!("{:?} {unknown}", bit_names(protocol, signal, *set).collect::<Vec<_>>())
            }
            known @ (Value::Integer(_) | Value::Number(_) | Value::Name(_) | Value::Text(_)) => format!("{known:?}"),
        };
        format!("{} {value} {unit}", signal.name)
    });
    values.collect::<Vec<_>>().join("\n")
}

impl Candidate {
    fn new(protocol: Protocol, place: usize, count: usize) -> Self {
        let (name, unlike) = (protocol.name.clone(), vec![Unlike::default(); count]);
        Self { name, protocol, unlike, place, recognised: 0, share: 0.0, contradicted: 0, alone: 0 }
    }

    /// Counts a frame, and returns what it says if the protocol recognises it.
    fn try_on(&mut self, frame: &Frame) -> Option<Reading> {
        let decoded = decode(&self.protocol, None, frame).ok()?;
        self.recognised += 1;
        self.contradicted += u64::from(decoded.notes.iter().any(|note| contradicts(note.rule)));
        Some(Reading::of(&self.protocol, &decoded, frame.id))
    }

    /// Returns the frames without a contradiction, then all that are recognised.
    fn fit(&self) -> (u64, u64) {
        (self.recognised - self.contradicted, self.recognised)
    }

    fn row(&self) -> Row {
        let share = format!("{:.1} %", self.share * 100.0);
        let counts = [self.contradicted, self.alone].map(|count| count.to_string());
        let cells = [&[self.name.clone(), self.recognised.to_string(), share][..], &counts].concat();
        Row { cells, last: vec![self.protocol.title.for_people().to_owned()], separator: "", ..Row::default() }
    }
}

/// Tests whether a frame with such a note speaks against its protocol.
fn contradicts(rule: NoteRule) -> bool {
    match rule {
        NoteRule::ErrorCode | NoteRule::ModelDependent | NoteRule::Count => false,
        NoteRule::ReservedBit
        | NoteRule::UnknownValue
        | NoteRule::UnknownBit
        | NoteRule::Address
        | NoteRule::Addressing
        | NoteRule::OutOfRange
        | NoteRule::NotFinite => true,
    }
}

#[expect(clippy::cast_precision_loss, reason = "no log has that many frames")]
fn share(part: u64, whole: u64) -> f64 {
    part as f64 / whole as f64
}
