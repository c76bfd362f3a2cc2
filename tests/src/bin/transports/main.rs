//! One node of a transport, on a bus of lines, for programs that are compared with canspec. Called as
//! `transports j1939`.
//!
//! A line says what happens to the node, as words with a blank between them: `ID#DATA` is a frame that comes, `ID=DATA`
//! a message to send. The answer is one line too: its words are frames that the node sends, messages that it has put
//! together, `sent` for a message that came over, and `!CAUSE` for one that comes to nothing. The identifier of
//! a message is the one that it would have as a single frame.

mod j1939;

use std::env;
use std::fmt;
use std::io::{self, Write};

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
    let mut node: Box<dyn Node> = match env::args().nth(1).as_deref() {
        Some("j1939") => Box::new(J1939::new()),
        _ => return Err(io::Error::other("call it as `transports j1939`")),
    };
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

/// Returns what a node answers to a word, if it is one.
fn told(node: &mut dyn Node, word: &str) -> Option<Vec<Word>> {
    let (id, data) = word.split_once(['#', '='])?;
    let id = u32::from_str_radix(id, 16).ok()?;
    let pairs = (0..data.len()).step_by(2).map(|at| data.get(at..at + 2));
    let bytes: Option<Vec<u8>> = pairs.map(|pair| u8::from_str_radix(pair?, 16).ok()).collect();
    Some(if word.contains('#') { node.take(id, &bytes?) } else { node.send(id, bytes?) })
}
