//! Which mistakes are planted.

use std::path::Path;
use std::{env, io};

use super::accepted::Accepted;
use super::before;
use super::part::Part;
use super::source::{Place, Source};

/// What the arguments ask for.
#[derive(Default)]
pub struct Choice {
    /// Only print what would be planted.
    pub is_list: bool,
    /// Only functions that have changed since this revision.
    pub since: Option<String>,
    at_most: Option<usize>,
    words: Vec<String>,
}

impl Choice {
    /// Reads the arguments of the program.
    pub fn from_arguments() -> io::Result<Self> {
        let mut choice = Self::default();
        let mut arguments = env::args().skip(1);
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--list" => choice.is_list = true,
                "--since" => choice.since = Some(revision(arguments.next())?),
                "--at-most" => choice.at_most = Some(number(arguments.next())?),
                _ => choice.words.push(argument),
            }
        }
        Ok(choice)
    }

    /// Tells whether all mistakes are asked for.
    pub fn is_everything(&self) -> bool {
        self.since.is_none() && self.at_most.is_none() && self.words.is_empty()
    }

    /// Returns the mistakes of a part that are asked for.
    pub fn of<'a>(
        &self,
        part: &Part,
        root: &Path,
        sources: &'a [Source],
        accepted: &Accepted,
    ) -> io::Result<Vec<Place<'a>>> {
        let before = self.since.as_ref().map(|since| before::functions(part, root, since)).transpose()?;
        let is_new = |place: &Place<'_>| before.as_ref().is_none_or(|before| !before.contains(&place.mistake.whole));
        let places =
            sources.iter().flat_map(Source::places).filter(|place| self.has_words(part, place) && is_new(place));
        let mut places = self.sample(places.collect());
        // A run for changes does not ask again for what was accepted.
        places.retain(|place| self.since.is_none() || !accepted.has(place.mistake));
        Ok(places)
    }

    fn has_words(&self, part: &Part, place: &Place<'_>) -> bool {
        let text = format!("{} {} {}", part.name, place.source.path.display(), place.mistake);
        self.words.iter().all(|word| text.contains(word))
    }

    /// Leaves as many as are asked for, from everywhere; they are the same each time.
    fn sample<'a>(&self, mut places: Vec<Place<'a>>) -> Vec<Place<'a>> {
        if let Some(number) = self.at_most {
            places.sort_by_cached_key(|place| hash(&place.mistake.to_string()));
            places.truncate(number);
        }
        places
    }
}

fn revision(argument: Option<String>) -> io::Result<String> {
    argument.ok_or_else(|| io::Error::other("`--since` takes a revision of git"))
}

fn number(argument: Option<String>) -> io::Result<usize> {
    let number = argument.and_then(|argument| argument.parse().ok());
    number.ok_or_else(|| io::Error::other("`--at-most` takes a number"))
}

/// Fowler, Noll and Vo's hash, which is the same on every machine.
fn hash(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}
