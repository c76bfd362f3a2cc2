//! `canspec list`.

mod built_in;
mod carrier;
mod derivation;
mod errata;
mod examples;
mod frames;
mod heading;
mod json;
mod layout;
mod meaning;
mod message;
mod models;
mod overview;
mod quantities;
mod remarks;
mod rows;
mod timing;
mod uses;
mod words;

use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use canspec_codegen::model::{MessageId, Protocol};
use canspec_codegen::nearest;
use clap::{Args, ValueEnum};

use self::uses::Uses;
use crate::choose::protocols;
use crate::failure::{Failure, Finish};
use crate::output::output;

/// List the built-in protocols, or the messages of one.
///
/// The table shows bytes and bits as the spec counts them. With --message or --full it also shows
/// frames, notes and errata. Constants that choose a message are in hexadecimal: `0x55` is what some
/// documents print as `55h`.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = "Example:\n  canspec list --protocol NAME --message NAME")]
pub struct List {
    /// A built-in protocol.
    #[arg(long, value_name = "NAME", conflicts_with = "spec")]
    protocol: Option<String>,
    /// A spec file.
    #[arg(long, value_name = "FILE")]
    spec: Option<PathBuf>,
    /// Show all that the spec says of a message, or of several as `A,B`.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    message: Vec<String>,
    /// Show all that the spec says.
    #[arg(long, conflicts_with = "message")]
    full: bool,
    /// Tables, or one JSON object with all that the spec says.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Json,
}

impl List {
    /// Writes the list.
    pub fn run(&self) -> Result<Finish, Failure> {
        let mut out = BufWriter::new(output()?);
        let is_of_one = self.full || !self.message.is_empty();
        match (self.protocol.as_deref(), self.spec.as_deref()) {
            (None, None) if !is_of_one => built_in::write(&mut out, self.format)?,
            (name, path) => self.write(&mut out, &protocols::load_chosen(name, path)?)?,
        }
        out.flush()?;
        Ok(Finish::Done)
    }

    fn write(&self, out: &mut impl Write, protocol: &Protocol) -> Result<(), Failure> {
        let messages = self.messages(protocol)?;
        match self.format {
            Format::Json => json::write(out, protocol, &messages)?,
            Format::Text if self.full => full(out, protocol, &messages)?,
            Format::Text if self.message.is_empty() => overview::write(out, protocol)?,
            Format::Text => some(out, protocol, &messages)?,
        }
        Ok(())
    }

    /// Returns the chosen messages, or all.
    fn messages(&self, protocol: &Protocol) -> Result<Vec<MessageId>, Failure> {
        if self.message.is_empty() {
            return Ok(protocol.messages.ids().collect());
        }
        self.message.iter().map(|name| find(protocol, name)).collect()
    }
}

fn find(protocol: &Protocol, name: &str) -> Result<MessageId, Failure> {
    protocol.messages.position(|message| message.name == name).ok_or_else(|| {
        let known = nearest(name, protocol.messages.iter().map(|message| message.name.as_str()));
        let help = known.map_or_else(
            || format!("`canspec list` shows the messages of `{}`", protocol.name),
            |known| format!("did you mean `{known}`?"),
        );
        Failure::Call(format!("unknown message `{name}`; {help}"))
    })
}

/// Writes all that the spec says.
fn full(out: &mut impl Write, protocol: &Protocol, messages: &[MessageId]) -> io::Result<()> {
    heading::write(out, protocol)?;
    layout::write(out, protocol)?;
    messages.iter().try_for_each(|id| message::write(out, protocol, *id))?;
    examples::write(out, protocol, None)?;
    examples::sequences(out, protocol)?;
    examples::of_types(out, protocol)?;
    quantities::write(out, protocol)?;
    models::write(out, protocol, true)?;
    timing::write(out, protocol)?;
    errata::write(out, protocol, |_| true)
}

/// Writes all that the spec says of some messages, and of what they refer to.
fn some(out: &mut impl Write, protocol: &Protocol, messages: &[MessageId]) -> io::Result<()> {
    let uses = Uses::of(protocol, messages);
    heading::write(out, protocol)?;
    messages.iter().try_for_each(|id| message::write(out, protocol, *id))?;
    layout::accesses(out, protocol, &uses.accesses())?;
    layout::types(out, uses.types())?;
    timing::times(out, protocol, uses.times())?;
    let errata = uses.errata();
    errata::write(out, protocol, |name| errata.contains(name))
}
