//! Chooses channels of a log.

use std::collections::BTreeSet;

use clap::Args;

use crate::failure::MOST_NAMES;

/// Chooses channels of a log.
#[derive(Args)]
pub struct Channels {
    /// Only frames of this channel, or of several as `A,B`; repeatable.
    #[arg(long = "channel", value_name = "NAME", value_delimiter = ',')]
    names: Vec<String>,
}

/// The channels whose frames were left out, as far as a hint lists them.
#[derive(Clone, Default)]
pub struct Others(BTreeSet<String>);

impl Channels {
    /// Tests whether a frame of this channel is wanted.
    pub fn keep(&self, channel: Option<&str>, others: &mut Others) -> bool {
        let is_kept = self.names.is_empty() || channel.is_some_and(|name| self.names.iter().any(|kept| kept == name));
        if let Some(name) = channel.filter(|name| !is_kept && !others.0.contains(*name)) {
            others.add(name.to_owned());
        }
        is_kept
    }

    /// Says which channels there are instead, if no frame is of a wanted one.
    pub fn hint(&self, frames: u64, others: &Others) -> Option<String> {
        let known: Vec<&str> = others.0.iter().map(String::as_str).collect();
        let known = if known.is_empty() { "no channels".to_owned() } else { known.join(", ") };
        let is_wanted = frames == 0 && !self.names.is_empty();
        is_wanted.then(|| format!("no frame is of the channel {}; the log has {known}", self.names.join(", ")))
    }
}

impl Others {
    fn add(&mut self, name: String) {
        if self.0.len() < MOST_NAMES {
            self.0.insert(name);
        }
    }

    /// Adds the channels of another part of the log.
    pub fn join(&mut self, part: Self) {
        part.0.into_iter().for_each(|name| self.add(name));
    }
}
