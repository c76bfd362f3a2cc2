//! `canspec encode`.

use std::io::{BufWriter, Write};
use std::path::Path;

use canspec_codegen::interpret::{self, Frame, Target, Targets};
use canspec_codegen::model::{ModelId, Protocol};
use clap::{Args, ValueEnum};

use crate::failure::{Failure, Finish};
use crate::input::Input;
use crate::line::Content;
use crate::log;
use crate::model::Model;
use crate::output::output;
use crate::protocols::{self, One};

/// Make a request, or turn decoded lines back into frames.
///
/// Name the message of the request, after its access if the message has several. Set signals as NAME=VALUE, with a
/// unit or without. With --from jsonl, the lines that `canspec decode --format jsonl` writes become a log again.
#[derive(Args)]
#[command(
    verbatim_doc_comment,
    after_long_help = "\
Examples:
  canspec encode --protocol NAME set_output --to module:3 voltage=750V current=15A
  canspec encode --protocol NAME --from jsonl frames.jsonl"
)]
pub struct Encode {
    #[command(flatten)]
    protocol: One,
    #[command(flatten)]
    model: Model,
    /// Read decoded lines from the file, or from standard input.
    #[arg(long, value_enum, value_name = "FORMAT", conflicts_with_all = ["to", "source"])]
    from: Option<Format>,
    /// Whom to address: `module:3`, `broadcast`, or `MODE:N` with an addressing mode; needed where there is a choice.
    #[arg(long, value_name = "TARGET")]
    to: Option<String>,
    /// The sender's address, instead of the one that the spec names.
    #[arg(long, value_name = "ADDRESS", value_parser = address)]
    source: Option<i64>,
    /// `[ACCESS] MESSAGE NAME=VALUE...`, or the file after --from.
    #[arg(value_name = "WORD")]
    words: Vec<String>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Jsonl,
}

/// Reads a decimal or `0x` hexadecimal number.
fn address(text: &str) -> Result<i64, String> {
    let number = match text.strip_prefix("0x") {
        Some(digits) => i64::from_str_radix(digits, 16),
        None => text.parse(),
    };
    number.map_err(|_| "an address is a number such as 240 or 0xF0".to_owned())
}

impl Encode {
    /// Prints the frames asked for.
    pub fn run(&self) -> Result<Finish, Failure> {
        let settings = self.protocol.choice()?;
        let protocol = protocols::load_one(&settings)?;
        let model = self.model.find_in(&protocol, &settings)?;
        match self.from {
            None => self.request(&protocol, model),
            Some(Format::Jsonl) => lines(&protocol, model, self.file()?),
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
        let (access, message) = match names {
            [message] => (None, message),
            [access, message] => (Some(access.as_str()), message),
            _ => {
                let why = "name one message, or an access and a message, and then each value as NAME=VALUE";
                return Err(Failure::Call(why.to_owned()));
            }
        };
        let target = self.target(protocol, access, message)?;
        let frames = interpret::requests(protocol, model, access, message, &target, self.source, &signals);
        let frames = frames.map_err(|refusal| Failure::Call(refusal.to_string()))?;
        let mut out = output()?;
        frames.iter().try_for_each(|frame| log::write(&mut out, None, None, frame))?;
        Ok(Finish::Done)
    }
}

impl Encode {
    /// Returns the target of the call, or the only one that there is.
    fn target(&self, protocol: &Protocol, access: Option<&str>, message: &str) -> Result<Target, Failure> {
        match &self.to {
            Some(to) => Target::parse(to).map_err(|refusal| Failure::Call(refusal.to_string())),
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

/// Splits words of the form NAME=VALUE. The first one has that form.
fn pairs(words: &[String]) -> Result<Vec<(String, String)>, Failure> {
    if let Some([before, word]) = words.array_windows().find(|[_, word]| !word.contains('=')) {
        let why = format!("`{word}` stands alone behind `{before}`");
        let help = "write NAME=VALUE without a blank or in quotes, with the unit or without";
        return Err(Failure::Call(format!("{why}; {help}")));
    }
    let pair = |word: &String| word.split_once('=').map(|(name, value)| (name.to_owned(), value.to_owned()));
    Ok(words.iter().filter_map(pair).collect())
}

/// Turns a decoded line into one of a log.
pub fn line(protocol: &Protocol, model: Option<ModelId>, text: &str) -> Result<Option<String>, String> {
    let Some((content, frame)) = read(protocol, model, text)? else { return Ok(None) };
    let mut out = Vec::new();
    let time = content.time.as_ref().map(|time| time.get());
    log::write(&mut out, time, content.channel.as_deref(), &frame).map_err(|error| error.to_string())?;
    String::from_utf8(out).map(Some).map_err(|error| error.to_string())
}

/// Turns decoded lines into a log.
fn lines(protocol: &Protocol, model: Option<ModelId>, file: Option<&Path>) -> Result<Finish, Failure> {
    let out = BufWriter::new(output()?);
    Input::open(file)?.each(out, |out, line| {
        let made = line.text.and_then(|text| self::line(protocol, model, text))?;
        Ok(made.map_or(Ok(()), |made| out.write_all(made.as_bytes())))
    })
}

fn read(protocol: &Protocol, model: Option<ModelId>, line: &str) -> Result<Option<(Content, Frame)>, String> {
    let Some(content) = Content::read(line)? else { return Ok(None) };
    check_protocol(protocol, &content)?;
    check_units(protocol, &content)?;
    let frame = interpret::encode(protocol, model, &content.frame).map_err(|refusal| refusal.to_string())?;
    Ok(Some((content, frame)))
}

fn check_protocol(protocol: &Protocol, content: &Content) -> Result<(), String> {
    match &content.protocol {
        Some(name) if *name != protocol.name => {
            Err(format!("the line is of protocol {name:?}, not `{}`", protocol.name))
        }
        _ => Ok(()),
    }
}

/// Refuses a value whose stated unit is not that of its signal.
fn check_units(protocol: &Protocol, content: &Content) -> Result<(), String> {
    let message = protocol.messages.iter().find(|message| message.name == content.frame.message);
    let signals = message.map_or(&[][..], |message| &message.signals);
    for (name, stated) in &content.units {
        let Some(signal) = signals.iter().find(|signal| signal.name == *name) else { continue };
        let wanted = match signal.unit {
            Some(unit) if unit.symbol == stated => continue,
            Some(unit) => format!("the unit is {}", unit.symbol),
            None => "there is no unit".to_owned(),
        };
        return Err(format!("{}.{name}: {wanted}, not {stated:?}", content.frame.message));
    }
    Ok(())
}
