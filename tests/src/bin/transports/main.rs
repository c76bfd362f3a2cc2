//! One node of a transport, on a bus of lines, for programs that are compared with canspec.
//!
//! Called as `transports j1939 LIMIT`, the node sends at most `LIMIT` packets at once. Called as
//! `transports isotp BLOCK SEPARATION [PADDING]`, it asks senders for blocks and for time between frames, and fills its
//! frames up with a byte.
//!
//! A line says in words what happens to the node. `ID#DATA` is a frame that comes, and `ID=DATA` a message to send. Its
//! identifier is the one that the message would have as a single frame. The answer is one line too. It has frames that
//! the node sends, and messages that it has put together. `sent` says that a message came over, and `!CAUSE` that one
//! comes to nothing.

mod isotp;
mod j1939;

use std::env;
use std::fmt;
use std::io::{self, Write};

use isotp::IsoTp;
use j1939::J1939;

/// A node, which answers at once.
trait Node {
    /// Begins to send a message.
    fn send(&mut self, id: u32, data: Vec<u8>) -> Vec<Word>;

    /// Takes a frame.
    fn take(&mut self, id: u32, data: &[u8]) -> Vec<Word>;
}

/// What a node does.
enum Word {
    Frame(u32, Vec<u8>),
    Message(u32, Vec<u8>),
    Sent,
    Broken(String),
}

impl fmt::Display for Word {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (id, sign, data) = match self {
            Self::Frame(id, data) => (id, '#', data),
            Self::Message(id, data) => (id, '=', data),
            Self::Sent => return formatter.write_str("sent"),
            Self::Broken(cause) => return write!(formatter, "!{cause}"),
        };
        write!(formatter, "{id:X}{sign}")?;
        data.iter().try_for_each(|byte| write!(formatter, "{byte:02X}"))
    }
}

fn main() -> io::Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let mut node = node(&arguments).ok_or_else(|| io::Error::other("the page of this program says how to call it"))?;
    for line in io::stdin().lines() {
        let mut answer = Vec::new();
        for word in line?.split_whitespace() {
            answer.extend(told(&mut *node, word).ok_or_else(|| io::Error::other(format!("`{word}` is no word")))?);
        }
        let answer: Vec<_> = answer.iter().map(Word::to_string).collect();
        writeln!(io::stdout(), "{}", answer.join(" "))?;
    }
    Ok(())
}

fn node(arguments: &[String]) -> Option<Box<dyn Node>> {
    let (transport, numbers) = arguments.split_first()?;
    let numbers: Result<Vec<u8>, _> = numbers.iter().map(|number| number.parse()).collect();
    match (transport.as_str(), numbers.ok()?.as_slice()) {
        ("j1939", [limit]) => Some(Box::new(J1939::new(*limit))),
        ("isotp", [block, separation]) => Some(Box::new(IsoTp::new(*block, *separation, None))),
        ("isotp", [block, separation, padding]) => Some(Box::new(IsoTp::new(*block, *separation, Some(*padding)))),
        _ => None,
    }
}

/// Returns what a node answers to a word, if it is one.
fn told(node: &mut dyn Node, word: &str) -> Option<Vec<Word>> {
    let (id, data) = word.split_once(['#', '='])?;
    let id = u32::from_str_radix(id, 16).ok()?;
    let pairs = (0..data.len()).step_by(2).map(|at| data.get(at..at + 2));
    let bytes: Option<Vec<u8>> = pairs.map(|pair| u8::from_str_radix(pair?, 16).ok()).collect();
    Some(if word.contains('#') { node.take(id, &bytes?) } else { node.send(id, bytes?) })
}
