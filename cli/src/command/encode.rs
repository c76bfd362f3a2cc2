//! `canspec encode`.

mod access;

use std::collections::HashSet;
use std::io::{BufWriter, Write};
use std::path::Path;

use canspec_codegen::interpret::{self, Frame, Refusal, Sent, Target, Targets};
use canspec_codegen::model::{Kind, LongMessage, ModelId, Protocol, Signal};
use clap::{Args, ValueEnum};

use crate::choose::device::{Device, Model};
use crate::choose::protocols::{self, Several};
use crate::failure::{Failure, Finish};
use crate::log;
use crate::log::input::Input;
use crate::output::output;
use crate::show::line::{self, Content, Line, Message};

/// Make a request, a report or a reply, or turn decoded lines back into frames.
///
/// Name the message, after its access if the message has several. Set signals as NAME=VALUE, with a unit or without. A
/// message that modules only report becomes a report. For a reply, say --kind reply. With --from jsonl, the lines that
/// `canspec decode --format jsonl` writes become a log again. Frames that were not recognised come back unchanged.
#[derive(Args)]
#[command(
    verbatim_doc_comment,
    mut_arg("protocol", |protocol| protocol.help("A built-in protocol; with --from, several as `A,B`")),
    mut_arg("spec", |spec| spec.help("A spec file; with --from, repeatable")),
    after_long_help = "\
Examples:
  canspec encode --protocol NAME set_output --to module:3 voltage=750V current=15A
  canspec encode --protocol NAME output --kind reply --source 3 voltage=500V
  canspec encode --protocol NAME --from jsonl frames.jsonl"
)]
pub struct Encode {
    #[command(flatten)]
    protocols: Several,
    #[command(flatten)]
    model: Model,
    /// Read decoded lines from the file, or from standard input.
    #[arg(long, value_enum, value_name = "FORMAT", conflicts_with_all = ["to", "source", "kind"])]
    from: Option<Format>,
    /// Whom to address: `module:3`, `host:NAME`, `broadcast`, or `MODE:N` with an addressing mode; needed where there is a choice.
    #[arg(long, value_name = "TARGET")]
    to: Option<String>,
    /// The sender's address or its name, instead of the one that the spec says is sent. A report or a reply needs that
    /// of its module, if the identifier shows it.
    #[arg(long, value_name = "ADDRESS")]
    source: Option<String>,
    /// What the frame is for, where a message has several kinds of frames; a request without it.
    #[arg(long, value_enum, value_name = "KIND")]
    kind: Option<Purpose>,
    /// `[ACCESS] MESSAGE NAME=VALUE...`, or the file after --from.
    #[arg(value_name = "WORD")]
    words: Vec<String>,
}

/// How a value is written in a call.
const PAIR: &str = "write NAME=VALUE without a blank or in quotes, with the unit or without";

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Jsonl,
}

#[derive(Clone, Copy, ValueEnum)]
enum Purpose {
    Request,
    Reply,
    Report,
}

impl Purpose {
    fn kind(self) -> Kind {
        match self {
            Self::Request => Kind::Request,
            Self::Reply => Kind::Reply,
            Self::Report => Kind::Report,
        }
    }
}

impl Encode {
    /// Prints the frames asked for.
    pub fn run(&self) -> Result<Finish, Failure> {
        let settings = self.protocols.choice()?;
        match self.from {
            None => {
                let protocol = protocols::load_one(&settings)?;
                let model = self.model.find_in(&protocol, &settings)?;
                self.request(&protocol, model)
            }
            Some(Format::Jsonl) => {
                let protocols = protocols::load_all(&settings)?;
                let models = self.model.find(&protocols, &settings)?;
                let devices: Vec<_> = protocols.iter().zip(models).collect();
                lines(&devices, self.file()?)
            }
        }
    }

    fn file(&self) -> Result<Option<&Path>, Failure> {
        match self.words.as_slice() {
            [] => Ok(None),
            [file] => Ok(Some(Path::new(file))),
            _ => Err(Failure::Call("--from reads one file".to_owned())),
        }
    }

    fn request(&self, protocol: &Protocol, model: Option<ModelId>) -> Result<Finish, Failure> {
        let first = self.words.iter().position(|word| word.contains('=')).unwrap_or(self.words.len());
        let (names, signals) = self.words.split_at(first);
        let signals = pairs(signals)?;
        let (access, message) = named(protocol, names)?;
        let refused = |refusal: Refusal| Failure::Call(refusal.to_string());
        let sent = Sent { kind: self.kind.map(Purpose::kind), access, model, message, to: None, source: None };
        if sent.is_of_module(protocol).map_err(refused)? {
            return write(&self.sent(protocol, sent, &signals).map_err(refused)?);
        }
        if access.is_none() {
            access::refuse_several(message, &interpret::accesses(protocol, message, &signals).map_err(refused)?)?;
        }
        let target = self.target(protocol, access, message)?;
        let source = self.source.as_ref().map(|text| interpret::source(protocol, text)).transpose().map_err(refused)?;
        let frames = interpret::requests(protocol, model, access, message, &target, source, &signals);
        write(&frames.map_err(refused)?)
    }

    /// Returns the frames that a module sends.
    fn sent(&self, protocol: &Protocol, sent: Sent<'_>, signals: &[(String, String)]) -> Result<Vec<Frame>, Refusal> {
        let to = self.to.as_ref().map(|text| Target::parse(protocol, text)).transpose()?;
        let source = self.source.as_ref().map(|text| interpret::module(protocol, text)).transpose()?;
        interpret::sent(protocol, Sent { to: to.as_ref(), source, ..sent }, signals)
    }
}

impl Encode {
    /// Returns the target of the call, or the only one that there is.
    fn target(&self, protocol: &Protocol, access: Option<&str>, message: &str) -> Result<Target, Failure> {
        match &self.to {
            Some(to) => Target::parse(protocol, to).map_err(|refusal| Failure::Call(refusal.to_string())),
            None => match interpret::targets(protocol, access, message) {
                Err(refusal) => Err(Failure::Call(refusal.to_string())),
                Ok(Targets::One(target)) => Ok(target),
                Ok(Targets::Choice(forms)) => {
                    let forms: Vec<_> = forms.iter().map(|form| format!("`--to {form}`")).collect();
                    Err(Failure::Call(format!("{message}: say whom to address, with {}", forms.join(" or "))))
                }
            },
        }
    }
}

fn write(frames: &[Frame]) -> Result<Finish, Failure> {
    let mut out = output()?;
    frames.iter().try_for_each(|frame| log::write(&mut out, None, None, frame))?;
    Ok(Finish::Done)
}

/// Reads the words before the values: a message, after its access if the call names one.
fn named<'a>(protocol: &Protocol, names: &'a [String]) -> Result<(Option<&'a str>, &'a str), Failure> {
    let has_message = |name: &str| protocol.messages.iter().any(|message| message.name == name);
    let why = match names {
        [message] => return Ok((None, message)),
        [message, value] if has_message(message) && !has_message(value) => {
            format!("`{value}` stands alone behind `{message}`; {PAIR}")
        }
        [access, message] => return Ok((Some(access), message)),
        _ => "name one message, or an access and a message, and then each value as NAME=VALUE".to_owned(),
    };
    Err(Failure::Call(why))
}

/// Splits words of the form NAME=VALUE. The first one has that form.
fn pairs(words: &[String]) -> Result<Vec<(String, String)>, Failure> {
    if let Some([before, word]) = words.array_windows().find(|[_, word]| !word.contains('=')) {
        let why = format!("`{word}` stands alone behind `{before}`");
        return Err(Failure::Call(format!("{why}; {PAIR}")));
    }
    let pair = |word: &String| word.split_once('=').map(|(name, value)| (name.to_owned(), value.to_owned()));
    Ok(words.iter().filter_map(pair).collect())
}

/// Turns decoded lines into those of a log.
#[derive(Default)]
pub struct Encoder {
    /// Messages and transports whose frames have lines of their own, by protocol. They are not made once more of the whole
    /// message.
    by_frames: HashSet<(Option<String>, String)>,
}

impl Encoder {
    /// Turns a decoded line into lines of a log.
    ///
    /// # Errors
    ///
    /// Says why the line cannot be read, or its message cannot be sent.
    pub fn line(&mut self, devices: &[Device<'_>], text: &str) -> Result<String, String> {
        let Some(Line { time, channel, content }) = Line::read(text)? else { return Ok(String::new()) };
        let frames = match content {
            Content::Message(message) => vec![self.frame(devices, &message)?],
            Content::Long(message) => self.frames(devices, &message)?,
            Content::Frame(frame) => vec![frame],
        };
        let mut out = Vec::new();
        let time = time.as_ref().map(|time| time.get());
        for frame in &frames {
            log::write(&mut out, time, channel.as_deref(), frame).map_err(|error| error.to_string())?;
        }
        String::from_utf8(out).map_err(|error| error.to_string())
    }

    fn frame(&mut self, devices: &[Device<'_>], message: &Message) -> Result<Frame, String> {
        let (protocol, model) = device(devices, message.protocol.as_deref())?;
        check_units(protocol.messages.iter(), model, message)?;
        let of_transport = line::of_transport(protocol, &message.frame);
        let (carrier, content) =
            of_transport.as_ref().map_or((&*message.frame.message, &message.frame), |(name, content)| (*name, content));
        let frame = interpret::encode(protocol, model, content).map_err(|refusal| refusal.to_string())?;
        if !protocol.long_messages.is_empty() {
            self.by_frames.insert((message.protocol.clone(), carrier.to_owned()));
        }
        Ok(frame)
    }

    /// Makes the frames of a long message, unless they have lines of their own.
    fn frames(&self, devices: &[Device<'_>], message: &Message) -> Result<Vec<Frame>, String> {
        let (protocol, model) = device(devices, message.protocol.as_deref())?;
        let carrier = carrier(protocol, &message.frame.message);
        if self.by_frames.contains(&(message.protocol.clone(), carrier.to_owned())) {
            return Ok(Vec::new());
        }
        if let Some(missing) = &message.incomplete {
            return Err(format!("this message did not come whole, so it is not made again: {missing}"));
        }
        check_units(protocol.long_messages.iter().map(|long| &long.content), model, message)?;
        interpret::encode_long(protocol, model, &message.frame).map_err(|refusal| refusal.to_string())
    }
}

/// Returns the name of what carries a long message: its transport, or itself.
fn carrier<'a>(protocol: &'a Protocol, message: &'a str) -> &'a str {
    let known = protocol.long_messages.iter().find(|long| long.content.name == message);
    known.and_then(LongMessage::transport).map_or(message, |transport| &protocol[transport].name)
}

/// Turns decoded lines into a log.
fn lines(devices: &[Device<'_>], file: Option<&Path>) -> Result<Finish, Failure> {
    let out = BufWriter::new(output()?);
    let mut encoder = Encoder::default();
    Input::open_lines(file, is_decoded)?.each(out, |out, line| {
        let made = line.text.and_then(|text| encoder.line(devices, text))?;
        Ok(out.write_all(made.as_bytes()))
    })
}

/// Tests whether a line that can be read is not blank. What cannot be read is mostly another kind of file.
fn is_decoded(text: &str) -> Result<bool, String> {
    let hint = |why| format!("{why}; `--from jsonl` reads what `canspec decode --format jsonl` writes");
    Line::read(text).map(|line| line.is_some()).map_err(hint)
}

/// Returns the protocol that a line names. A line without a name is of the only protocol.
fn device<'a>(devices: &[Device<'a>], name: Option<&str>) -> Result<Device<'a>, String> {
    let known: Vec<_> = devices.iter().map(|(protocol, _)| format!("`{}`", protocol.name)).collect();
    match (name, devices) {
        (None, [device]) => Ok(*device),
        (None, _) => Err(format!("missing field `protocol`; it is one of {}", known.join(", "))),
        (Some(name), _) => {
            let named = devices.iter().find(|(protocol, _)| protocol.name == name);
            named.copied().ok_or_else(|| format!("the line is of protocol {name:?}, not {}", known.join(" or ")))
        }
    }
}

/// Refuses a value whose stated unit is not that of its signal.
fn check_units<'a>(
    mut messages: impl Iterator<Item = &'a canspec_codegen::model::Message>,
    model: Option<ModelId>,
    line: &Message,
) -> Result<(), String> {
    let Some(message) = messages.find(|message| message.name == line.frame.message) else { return Ok(()) };
    for (name, stated) in &line.units {
        let is_meant = |signal: &&Signal| signal.name == *name || message.field_name(signal) == name;
        let Some(signal) = message.signals.iter().find(is_meant) else { continue };
        let wanted = match signal.on(model).unit {
            Some(unit) if *unit.symbol == **stated => continue,
            Some(unit) => format!("the unit is {}", unit.symbol),
            None => "there is no unit".to_owned(),
        };
        return Err(format!("{}.{name}: {wanted}, not {stated:?}", line.frame.message));
    }
    Ok(())
}
