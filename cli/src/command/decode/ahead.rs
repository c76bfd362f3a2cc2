//! Decodes the parts of a file ahead of their turn, on all cores, and writes them in order.

use std::collections::VecDeque;
use std::io::{self, Write};
use std::{panic, thread};

use super::Work;
use crate::failure::{Failure, Finish};
use crate::log::input::{Input, Line, Part, Written};
use crate::show::kept::Kept;

/// What was made of a part.
struct Done<'a> {
    written: Written,
    work: Work<'a>,
}

/// Calls `decode` with each line of a file.
///
/// A part begins with the state that is known when its turn to be read comes. If the parts before it end with another
/// state, it is decoded again in its turn. Nobody sees the difference. While there is a format that keeps something of
/// each line, as the heading of a table, there is one part at a time.
///
/// # Errors
///
/// Where the input cannot be read, or the output cannot be written.
pub fn decode<'a>(
    input: Input,
    out: &mut impl Write,
    work: &mut Work<'a>,
    decode: impl Fn(&mut Work<'a>, &mut Vec<u8>, Line<'_>) -> Result<(), String> + Sync,
) -> Result<Finish, Failure> {
    let mut input = input.watched();
    // One part more than cores: none is idle while a part is written.
    let parts = thread::available_parallelism().map_or(1, usize::from) + 1;
    let run = |part: Part, mut work: Work<'a>, text: Vec<u8>| {
        let written = part.work(text, |out, line| decode(&mut work, out, line));
        Done { written, work }
    };
    let run = &run;
    thread::scope(|scope| {
        let (mut finish, mut failure, mut is_read) = (Finish::Done, None, false);
        // Each state that is not like the one before it has a number.
        let mut version = 0;
        let mut ahead = VecDeque::new();
        // A buffer that was written to before costs no page faults.
        let mut rooms: Vec<(Vec<u8>, Kept<'_>)> = Vec::new();
        loop {
            let most = if work.state.is_like(&work.state) { parts } else { 1 };
            while !is_read && ahead.len() < most {
                match input.next_part() {
                    Ok(Some(part)) => {
                        let (text, kept) = rooms.pop().unwrap_or_default();
                        let (again, start) = (part.clone(), work.after(kept));
                        ahead.push_back((again, version, scope.spawn(move || run(part, start, text))));
                    }
                    Ok(None) => is_read = true,
                    Err(error) => (is_read, failure) = (true, Some(error)),
                }
            }
            let Some((part, begun, thread)) = ahead.pop_front() else { break };
            let mut done = thread.join().unwrap_or_else(|panicked| panic::resume_unwind(panicked));
            let length = part.length();
            if begun != version {
                done.written.text.clear();
                done = run(part, work.after(done.work.kept), done.written.text);
            }
            if deliver(&mut input, out, &done.written)? == Finish::Errors {
                finish = Finish::Errors;
            }
            input.advance(length);
            version += u64::from(!work.state.is_like(&done.work.state));
            work.state = done.work.state;
            work.counts.join(done.work.counts);
            done.written.text.clear();
            rooms.push((done.written.text, done.work.kept));
        }
        failure.map_or(Ok(finish), Err)
    })
}

/// Writes what was written about a part, with each complaint where it came.
fn deliver(input: &mut Input, out: &mut impl Write, written: &Written) -> io::Result<Finish> {
    let mut rest = &written.text[..];
    let mut start = 0;
    for (place, complaint) in &written.complaints {
        let (before, after) = rest.split_at(place - start);
        (rest, start) = (after, *place);
        out.write_all(before)?;
        out.flush()?;
        input.tell(complaint);
    }
    out.write_all(rest)?;
    Ok(if written.complaints.is_empty() { Finish::Done } else { Finish::Errors })
}
