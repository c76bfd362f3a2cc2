//! `canspec export dbc`.

use std::io::Write;
use std::ops::RangeInclusive;

use canspec_codegen::emit::{self, Dropped};
use canspec_codegen::model::Protocol;
use canspec_codegen::number::Rational;
use clap::Args;

use crate::choose::protocols::One;
use crate::failure::{Failure, Finish, tell};
use crate::output::output;

/// Export a protocol as a DBC.
///
/// Addresses vary, so each message stands for a layout of the identifier, which a mask compares.
/// Tools without masks need the identifiers of the nodes on the bus. The DBC has the messages of all
/// device models, with the widest limits.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = EXAMPLES)]
pub struct Dbc {
    #[command(flatten)]
    protocol: One,
    /// Write the identifiers of these nodes, as `2` or `0-3`, in place of layouts.
    #[arg(long, value_name = "FIRST-LAST", value_parser = nodes)]
    nodes: Option<RangeInclusive<i64>>,
    /// Write the mask and what the DBC cannot say in place of the DBC.
    #[arg(long)]
    report: bool,
}

const EXAMPLES: &str = "Examples:
  canspec export dbc --protocol NAME > all-nodes.dbc
  canspec export dbc --spec protocol.yaml --nodes 0-3 > four-nodes.dbc
  canspec export dbc --protocol NAME --report";

/// More nodes are a mistake. No bus has them.
const MOST: i64 = 256;

impl Dbc {
    /// Writes the DBC, or the report on it.
    pub fn run(&self) -> Result<Finish, Failure> {
        let protocol = self.protocol.load()?;
        if let Some(nodes) = &self.nodes {
            refuse_strangers(&protocol, nodes)?;
        }
        let dbc = emit::dbc(&protocol, self.nodes.clone());
        dbc.dropped.iter().for_each(|dropped| tell(format_args!("canspec: warning: {}", self.advised(dropped))));
        let text = if self.report { report(&dbc) } else { dbc.text };
        output()?.write_all(text.as_bytes())?;
        Ok(Finish::Done)
    }
}

impl Dbc {
    /// Says what the DBC lacks and what to do.
    fn advised(&self, Dropped { text, has_own_identifier }: &Dropped) -> String {
        if *has_own_identifier && self.nodes.is_none() {
            format!("{text}; `--nodes FIRST-LAST` exports whole identifiers, which differ")
        } else {
            format!(
                "{text}; `canspec export wireshark` makes a dissector, which knows lengths, addresses and device models"
            )
        }
    }
}

/// Refuses nodes if the document names none of them.
fn refuse_strangers(protocol: &Protocol, nodes: &RangeInclusive<i64>) -> Result<(), Failure> {
    let open: Vec<_> = protocol.address_types.iter().filter(|known| known.send.is_none()).collect();
    let (first, last) = (*nodes.start(), *nodes.end());
    if open.is_empty() || open.iter().any(|known| known.first <= last && first <= known.last) {
        return Ok(());
    }
    let known: Vec<_> = open.iter().map(|known| format!("`{}` {}-{}", known.name, known.first, known.last)).collect();
    Err(Failure::Call(format!("no node has an address in {first}-{last}; the document names {}", known.join(", "))))
}

fn report(dbc: &emit::Dbc) -> String {
    let (messages, frames) = dbc.counts;
    let mut lines = vec![
        format!("messages: {messages} of the protocol, {frames} of the DBC"),
        format!("frame-id mask {:#010X}", dbc.mask),
    ];
    if !dbc.losses.is_empty() {
        lines.push("what the DBC cannot say:".to_owned());
        lines.extend(dbc.losses.iter().map(|loss| format!("  {loss}")));
    }
    lines.join("\n") + "\n"
}

/// Reads a node or a range of nodes.
fn nodes(text: &str) -> Result<RangeInclusive<i64>, String> {
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let number = |text: &str| Rational::parse(text)?.to_integer().and_then(|number| i64::try_from(number).ok());
    match (number(first), number(last)) {
        (Some(first), Some(last)) if first <= last && last - first < MOST => Ok(first..=last),
        _ => Err(format!("nodes are a number or a range such as `0-3`, of at most {MOST}")),
    }
}

#[cfg(test)]
mod tests {
    use super::nodes;

    #[test]
    fn nodes_are_a_number_or_a_range() {
        assert_eq!(nodes("2"), Ok(2..=2));
        assert_eq!(nodes("0-3"), Ok(0..=3));
        assert_eq!(nodes("0xE0-0xEF"), Ok(224..=239));
        assert_eq!(nodes("1-256"), Ok(1..=256));
        for text in ["", "-", "1-", "-1", "3-0", "0.5", "a", "0-256", "0-99999999999999999999"] {
            assert!(nodes(text).is_err(), "{text}");
        }
    }
}
