//! Logs: what comes in line by line, and what goes out as a log or a capture.
//!
//! The formats of several programs are told apart by their lines, one format a file. `input` reads
//! the lines of a file or of standard input, and ends that on Ctrl-C; `doubt` and `signature` refuse
//! what is no log, and `progress` shows how far a long one is read. `write` writes lines of candump,
//! and `capture` a capture for Wireshark.

mod asc;
pub mod capture;
mod compact;
mod csv;
mod doubt;
pub mod input;
mod part;
mod plain;
mod progress;
mod signature;
mod slcan;
mod trc;
mod write;

use canspec_codegen::interpret::Frame;

pub use part::{channel, data_frame, is_finite, is_number};
pub use write::{hexadecimal, identifier_digits, identifier_text, write, write_hexadecimal, write_identifier};

/// A readable line of a log.
#[derive(Debug)]
pub struct Entry<'a> {
    /// The stamp as written, but for leading zeros.
    pub time: Option<part::Stamp<'a>>,
    /// The name of the interface.
    pub channel: Option<&'a str>,
    pub frame: Frame,
    /// The number of bytes that a remote frame asks for, or the flags of an FD frame.
    pub digit: u8,
}

/// What is known of a log after the lines read so far.
#[derive(Clone, Default)]
pub struct Reader {
    format: Option<Format>,
    asides: Asides,
}

/// What the lines so far say that is of no format.
#[derive(Clone, Copy, Default, Debug, PartialEq, Eq)]
pub struct Asides {
    /// Lines that begin with `#`.
    pub comments: u64,
    /// Lines by which candump says that frames were lost, and how many these were.
    pub drops: u64,
    pub dropped: u64,
}

/// How lines look, and what the head of the log says of those below.
#[derive(Clone)]
enum Format {
    Compact,
    Plain,
    Slcan,
    Asc(asc::Base),
    Csv(Box<csv::Columns>),
    Trc(trc::Columns),
    /// A table without a column or a separator that it needs, and the complaint if nobody has heard it.
    Incomplete(Option<String>),
}

impl Reader {
    /// Reads the next line, `None` from one without a frame: a blank one, or in some formats a heading or an event.
    ///
    /// # Errors
    ///
    /// Says why the line is unreadable.
    pub fn read<'a>(&'a mut self, line: &'a str) -> Result<Option<Entry<'a>>, String> {
        // Most lines of most logs; no other format has lines that can be read so.
        if let Some(Format::Compact) = self.format
            && let Some(entry) = compact::usual(line)
        {
            return Ok(Some(entry));
        }
        if line.trim_ascii().is_empty() {
            return Ok(None);
        }
        if !self.tell(line) && self.asides.take(line) {
            return Ok(None);
        }
        match &mut self.format {
            Some(Format::Compact) => compact::read(line),
            Some(Format::Plain) => plain::read(line),
            Some(Format::Slcan) => slcan::read(line),
            Some(Format::Asc(base)) => asc::read(base, line),
            Some(Format::Csv(columns)) => columns.read(line),
            Some(Format::Trc(columns)) => trc::read(columns, line),
            Some(Format::Incomplete(complaint)) => complaint.take().map_or(Ok(None), Err),
            None => Err(unknown(line)),
        }
    }

    /// Tests whether both readers surely read the same from each line to come. Then they have the same format, and it
    /// keeps nothing of the lines so far.
    pub fn is_like(&self, other: &Self) -> bool {
        use Format::{Compact, Plain, Slcan};
        matches!(
            (&self.format, &other.format),
            (Some(Compact), Some(Compact)) | (Some(Plain), Some(Plain)) | (Some(Slcan), Some(Slcan))
        )
    }

    /// Returns what was said aside.
    pub fn asides(&self) -> Asides {
        self.asides
    }

    /// Finds out the format of a line, and tells whether it shows one. A line that shows none has the format so far.
    fn tell(&mut self, line: &str) -> bool {
        let told = match &self.format {
            Some(Format::Asc(_) | Format::Csv(_) | Format::Trc(_)) => None,
            Some(Format::Compact | Format::Plain | Format::Slcan | Format::Incomplete(_)) => {
                frame(line).or_else(|| head(line))
            }
            None => head(line).or_else(|| frame(line)).or_else(|| uncertain(line)),
        };
        let is_told = told.is_some();
        self.format = told.or_else(|| self.format.take());
        is_told
    }
}

impl Asides {
    /// Counts a line that no format has: a comment, or what candump says of lost frames.
    fn take(&mut self, line: &str) -> bool {
        let line = line.trim_ascii_start();
        if let Some(drop) = line.strip_prefix("DROPCOUNT:") {
            self.drops += 1;
            self.dropped += drop.split_ascii_whitespace().find_map(|word| word.parse::<u64>().ok()).unwrap_or(0);
            return true;
        }
        let is_comment = line.starts_with('#');
        self.comments += u64::from(is_comment);
        is_comment
    }
}

/// Returns the format that begins with such a line.
fn head(line: &str) -> Option<Format> {
    let csv = || csv::Columns::of(line).map(|columns| Format::Csv(Box::new(columns)));
    let asc = || asc::begins(line).then(|| Format::Asc(asc::Base::default()));
    let trc = || trc::begins(line).then(|| Format::Trc(trc::Columns::default()));
    csv().or_else(asc).or_else(trc)
}

/// Returns the format of a first line that has less than it should.
fn uncertain(line: &str) -> Option<Format> {
    let stamped = compact::has_stamp(line).then_some(Format::Compact);
    let lack = || csv::Columns::lack(line).or_else(|| csv::Columns::aligned(line));
    let complaint = || if line.trim_ascii_start().starts_with('#') { None } else { lack() };
    stamped.or_else(|| complaint().map(|why| Format::Incomplete(Some(why))))
}

/// Returns the format that has frames in such a line.
fn frame(line: &str) -> Option<Format> {
    match line.bytes().find(|byte| matches!(byte, b'#' | b'[')) {
        Some(b'#') if line.trim_ascii_start().starts_with('#') => None,
        Some(b'#') => Some(Format::Compact),
        Some(_) if plain::shows(line) => Some(Format::Plain),
        Some(_) if line.contains('#') => Some(Format::Compact),
        _ if slcan::shows(line) => Some(Format::Slcan),
        _ if asc::shows(line) => Some(Format::Asc(asc::Base::default())),
        _ => None,
    }
}

/// Says what the known formats look like.
fn unknown(line: &str) -> String {
    format!(
        "{} is of no known log; known are candump (`can0 123#1122` or `can0  123   [2]  11 22`), SLCAN (`t12321122`), \
         Vector ASC (begins with `date` or `base`), TRC of PEAK (begins with `;$FILEVERSION=`), and CSV (begins with \
         names of columns, such as `time,id,data`)",
        part::quoted(line.trim())
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads the last of these lines after the others.
    fn last(lines: &[&str]) -> Result<Option<(String, String)>, String> {
        let mut reader = Reader::default();
        let (last, before) = lines.split_last().expect("there are lines");
        for line in before {
            let _ = reader.read(line);
        }
        let entry = reader.read(last)?;
        Ok(entry.map(|entry| (identifier_text(&entry.frame), hexadecimal(&entry.frame.data))))
    }

    #[test]
    fn each_format_is_told_by_its_own_lines() {
        let logs: [&[&str]; 13] = [
            &["(1.5) can0 123#1122"],
            &["  can0  123   [2]  11 22"],
            &["  can0  123   [2]  11 22   '#['"],
            &["t12321122"],
            &["base hex  timestamps absolute", "0.5 1  123  Rx   d 2 11 22"],
            &["0.5 1  123  Rx   d 2 11 22"],
            &["timestamp,arbitration_id,extended,remote,error,dlc,data", "0.5,0x123,0,0,0,2,ESI="],
            &["Time [s];ID;DLC;Data", "0.5;123;2;11 22"],
            &["seconds,identifier,data", "0.5,123,1122"],
            &["#,Time,ID,Data", "7,0.5,123,1122"],
            &["", ";$FILEVERSION=1.1", ";   |  time, id | data", "  1)  0.5  Rx  0123  2  11 22"],
            &[";##########", ";    |     |", "     1)       5  0123  2 11 22"],
            &["id,data", "124,3344", "id,data", "123,1122"],
        ];
        for log in logs {
            assert_eq!(last(log), Ok(Some(("123".to_owned(), "1122".to_owned()))), "{log:?}");
        }
    }

    #[test]
    fn a_table_without_a_column_that_it_needs_is_complained_about_once() {
        let mut reader = Reader::default();
        assert!(reader.read("time,id,value").expect_err("there are no data").contains("no column for the data"));
        assert!(reader.read("0.5,123,7").is_ok_and(|entry| entry.is_none()));
        assert!(reader.read("(1.5) can0 123#1122").is_ok_and(|entry| entry.is_some()));
    }

    #[test]
    fn comments_and_lost_frames_are_counted_in_logs_of_every_format() {
        // As candump prints it.
        let dropped = "DROPCOUNT: dropped 5 CAN frames on 'can0' socket (total drops 12)";
        let logs: [&[&str]; 6] = [
            &["(1.5) can0 123#1122"],
            &["  can0  123   [2]  11 22"],
            &["t12321122"],
            &["base hex  timestamps absolute", "0.5 1  123  Rx   d 2 11 22"],
            &["time,id,data", "0.5,123,1122"],
            &[";$FILEVERSION=1.1", "  1)  0.5  Rx  0123  2  11 22"],
        ];
        for log in logs {
            let mut reader = Reader::default();
            let mut frames = 0;
            let aside = ["# a comment", " #another [1]", dropped];
            for line in aside.iter().chain(log).chain(&aside).chain(&log[log.len() - 1..]) {
                frames += usize::from(reader.read(line).expect("the line is readable").is_some());
            }
            assert_eq!(frames, 2, "{log:?}");
            assert_eq!(reader.asides(), Asides { comments: 4, drops: 2, dropped: 10 }, "{log:?}");
        }
    }

    #[test]
    fn columns_of_varying_width_are_read_if_something_parts_them() {
        let heading = "  TIME ;ID       ;DLC;DATA            ";
        for row in ["   0.5; 123     ; 2 ; 11 22", "123456.5;123;2;1122", "123456.5;  00000123;2;11 22   "] {
            let read = last(&[heading, row]).map(|entry| entry.map(|(_, data)| data));
            assert_eq!(read, Ok(Some("1122".to_owned())), "{row}");
        }
    }

    #[test]
    fn a_table_whose_columns_only_blanks_or_bars_part_is_complained_about_once() {
        for heading in ["TIME   ID   DLC  DATA", "Time | ID | D0 | D1", "TIME  CHANNEL  IDENTIFIER  MESSAGE"] {
            let mut reader = Reader::default();
            assert!(reader.read(heading).expect_err("nothing parts the cells").contains("comma"), "{heading}");
            assert!(reader.read("0.5    123  2    11 22").is_ok_and(|entry| entry.is_none()), "{heading}");
            assert!(reader.read("(1.5) can0 123#1122").is_ok_and(|entry| entry.is_some()), "{heading}");
        }
        assert!(last(&["a sentence with an id"]).expect_err("it is no heading").contains("no known log"));
    }

    #[test]
    fn logs_of_candump_and_slcan_may_follow_one_another() {
        for before in ["(1.5) can0 123#1122", "  can0  123   [2]  11 22", "t12321122"] {
            for line in ["(1.5) can0 001#33", "can0 001 [1] 33", "t001133"] {
                assert_eq!(last(&[before, line]), Ok(Some(("001".to_owned(), "33".to_owned()))), "{before} {line}");
            }
        }
    }

    #[test]
    fn a_line_that_shows_no_format_is_taken_for_one_of_the_format_so_far() {
        let reasons: [(&[&str], &str); 4] = [
            (&["(1.5) can0 123#1122", "can0"], "no frame in the form ID#DATA; `candump -L` writes it"),
            (&["(1.5) can0"], "no frame in the form ID#DATA; `candump -L` writes it"),
            (&["t12321122", "u12321122"], "`u12321122` is no frame of SLCAN, which begins with t, T, r or R"),
            (&["can0 123 [0]", "can0 123"], "no length in brackets, as in `can0  123   [2]  11 22`"),
        ];
        for (log, why) in reasons {
            assert_eq!(last(log), Err(why.to_owned()), "{log:?}");
        }
    }

    #[test]
    fn a_format_that_nobody_knows_is_answered_with_the_known_ones() {
        let why = last(&["hello \u{1b}world"]).expect_err("it is no log");
        assert!(
            why.starts_with("`hello \\u{1b}world` is of no known log; known are candump (`can0 123#1122` or"),
            "{why}"
        );
        for name in ["candump", "SLCAN", "Vector ASC", "TRC", "CSV"] {
            assert!(why.contains(name), "{name} in {why}");
        }
    }
}
