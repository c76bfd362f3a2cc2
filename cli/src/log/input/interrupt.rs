//! Standard input that ends when somebody presses Ctrl-C, so that what is known by then is shown.

use std::io::{self, Cursor, Read};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::{mem, process, thread};

use super::LONGEST;

/// How shells show that a program was ended by Ctrl-C.
const INTERRUPTED: i32 = 130;

/// Whole lines of standard input. An empty chunk is its end.
pub struct Interruptible {
    chunks: Receiver<io::Result<Vec<u8>>>,
    chunk: Cursor<Vec<u8>>,
    is_over: bool,
}

/// Returns standard input, which Ctrl-C ends. Ctrl-C ends the program if it is pressed again.
///
/// # Errors
///
/// Where nobody can be told of Ctrl-C.
pub fn stdin() -> io::Result<Interruptible> {
    // One chunk at a time waits, so that a fast bus needs no more room.
    let (sender, chunks) = sync_channel(1);
    let key = Key { end: sender.clone(), was_pressed: AtomicBool::new(false) };
    ctrlc::set_handler(move || {
        if key.press() == Pressed::Again {
            process::exit(INTERRUPTED);
        }
    })
    .map_err(io::Error::other)?;
    thread::spawn(move || forward(io::stdin(), &sender));
    Ok(Interruptible { chunks, chunk: Cursor::default(), is_over: false })
}

/// The keys Ctrl-C.
struct Key {
    end: SyncSender<io::Result<Vec<u8>>>,
    was_pressed: AtomicBool,
}

#[derive(Debug, PartialEq, Eq)]
enum Pressed {
    First,
    Again,
}

impl Key {
    /// Ends the input by the first press. If the input has just ended by itself, what is known is shown already, so the
    /// press changes nothing.
    fn press(&self) -> Pressed {
        if self.was_pressed.swap(true, Ordering::Relaxed) {
            return Pressed::Again;
        }
        let _ = self.end.send(Ok(Vec::new()));
        Pressed::First
    }
}

/// Sends whole lines, and what follows the last one when its end is known. Nobody receives them after Ctrl-C.
fn forward(mut input: impl Read, sender: &SyncSender<io::Result<Vec<u8>>>) {
    let mut buffer = vec![0; LONGEST];
    let mut rest = Vec::new();
    let mut is_heard = true;
    while is_heard {
        is_heard = match input.read(&mut buffer) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => true,
            Err(error) => return drop(sender.send(Err(error))),
            Ok(0) => return drop(sender.send(Ok(rest)).and_then(|()| sender.send(Ok(Vec::new())))),
            Ok(count) => {
                rest.extend(&buffer[..count]);
                let end = rest.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
                let end = if end == 0 && rest.len() > LONGEST { rest.len() } else { end };
                let unfinished = rest.split_off(end);
                let whole = mem::replace(&mut rest, unfinished);
                whole.is_empty() || sender.send(Ok(whole)).is_ok()
            }
        }
    }
}

impl Read for Interruptible {
    fn read(&mut self, room: &mut [u8]) -> io::Result<usize> {
        let mut count = self.chunk.read(room)?;
        if count == 0 && !self.is_over {
            self.chunk = Cursor::new(self.chunks.recv().unwrap_or_else(|_| Ok(Vec::new()))?);
            self.is_over = self.chunk.get_ref().is_empty();
            count = self.chunk.read(room)?;
        }
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_press_behind_the_end_of_the_input_leaves_time_to_show_what_is_known() {
        let (end, chunks) = sync_channel(1);
        let key = Key { end, was_pressed: AtomicBool::new(false) };
        drop(chunks);
        assert_eq!([key.press(), key.press()], [Pressed::First, Pressed::Again]);
    }
}
