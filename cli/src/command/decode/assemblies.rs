//! Long messages of a log, put together from frames of each channel.

use canspec_codegen::interpret::{Assembled, Assembly, Decoded, Taken};
use canspec_codegen::model::Protocol;
use indexmap::IndexMap;

use crate::choose::device::Device;
use crate::log::Entry;
use crate::log::capture::nanoseconds;

/// What a long message remembers of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub line: usize,
    pub time: Option<String>,
}

/// The parts that came so far, by protocol and channel.
#[derive(Clone, Default, PartialEq)]
pub struct Assemblies(IndexMap<Bus, Assembly<Mark>>);

/// The name of a protocol, and a channel.
type Bus = (String, Option<String>);

impl Assemblies {
    /// Takes a frame of the log.
    pub fn take(
        &mut self,
        (protocol, model): Device<'_>,
        line: usize,
        entry: &Entry<'_>,
        decoded: &Decoded,
    ) -> Taken<Mark> {
        if protocol.long_messages.is_empty() {
            return Taken { is_part: false, ended: Vec::new() };
        }
        let assembly = self.0.entry((protocol.name.clone(), entry.channel.map(str::to_owned))).or_default();
        let mark = Mark { line, time: entry.time.as_deref().map(str::to_owned) };
        let now = entry.time.as_deref().filter(|_| has_silence(protocol)).and_then(nanoseconds);
        assembly.take_at(now, (protocol, model), mark, &entry.frame, decoded)
    }

    /// Ends all messages, each with its device and its channel.
    pub fn finish<'a>(&mut self, devices: &[Device<'a>]) -> Vec<(&'a Protocol, Option<String>, Assembled<Mark>)> {
        let mut ended = Vec::new();
        for ((name, channel), assembly) in &mut self.0 {
            let device = devices.iter().find(|(protocol, _)| protocol.name == *name);
            let Some((protocol, model)) = device else { continue };
            let whole = assembly.finish(protocol, *model).into_iter();
            ended.extend(whole.map(|whole| (*protocol, channel.clone(), whole)));
        }
        ended
    }
}

/// Tests whether the time of a frame can end a message.
fn has_silence(protocol: &Protocol) -> bool {
    protocol.long_messages.iter().any(|long| protocol.silence(long).is_some())
}
