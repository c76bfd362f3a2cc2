//! Tables in CSV, whose heading says what the columns hold: those of python-can, `SavvyCAN`, and others with common names.

use std::ops::Range;

use canspec_codegen::interpret::{Form, Frame};
use csv_core::{ReadRecordResult, ReaderBuilder};

use super::Entry;
use super::part::{CLASSIC, FLEXIBLE, LARGEST_EXTENDED, LARGEST_STANDARD, Stamp};
use super::part::{as_many, bytes, channel, date, fewer, fitting, moved, quoted, seconds};

/// What stands between two cells.
const SEPARATORS: [u8; 3] = [b',', b';', b'\t'];

/// What python-can writes.
const PYTHON_CAN: &str = "timestamp,arbitration_id,extended,remote,error,dlc,data";

/// The columns of a log, and room for the cells of a line.
pub struct Columns {
    heading: String,
    separator: u8,
    kinds: Vec<Column>,
    /// Data in base 64 rather than in hexadecimal digits.
    base64: bool,
    reader: csv_core::Reader,
    text: Vec<u8>,
    ends: Vec<usize>,
}

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    /// A time, and how many decimal places of a second its unit has.
    Time(usize),
    Channel,
    Identifier(Base),
    Extended,
    Remote,
    Error,
    Length,
    Data,
    /// One byte of the data.
    Byte,
    Other,
}

/// How a column writes its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Base {
    /// Hexadecimal, though the heading does not say so.
    Usual,
    Hexadecimal,
    Decimal,
}

impl Column {
    /// Knows a column by its name, whose letters and digits alone count.
    fn named(heading: &str) -> Self {
        let name = heading.to_lowercase().replace(['\u{B5}', '\u{3BC}'], "u");
        let name: String = name.chars().filter(char::is_ascii_alphanumeric).collect();
        match name.as_str() {
            "channel" | "bus" | "interface" | "chn" => Self::Channel,
            "extended" | "ext" | "ide" | "isextended" | "isextendedid" => Self::Extended,
            "remote" | "rtr" | "isremote" | "isremoteframe" => Self::Remote,
            "error" | "iserror" | "iserrorframe" => Self::Error,
            "dlc" | "length" | "len" | "datalength" => Self::Length,
            "data" | "datahex" | "databytes" | "payload" => Self::Data,
            _ if is_byte(&name) => Self::Byte,
            _ => time_unit(&name).map(Self::Time).or_else(|| base(&name).map(Self::Identifier)).unwrap_or(Self::Other),
        }
    }
}

/// Returns the decimal places of a second that the unit of a time has.
fn time_unit(name: &str) -> Option<usize> {
    let unit = ["timestamp", "time", "ts"].into_iter().find_map(|start| name.strip_prefix(start));
    match unit.unwrap_or(name) {
        "" | "s" | "sec" if unit.is_some() => Some(0),
        "ms" if unit.is_some() => Some(3),
        "us" if unit.is_some() => Some(6),
        "ns" if unit.is_some() => Some(9),
        "seconds" => Some(0),
        "milliseconds" => Some(3),
        "microseconds" => Some(6),
        "nanoseconds" => Some(9),
        _ => None,
    }
}

/// Returns how the identifiers of a column are written, `None` of a column of something else.
fn base(name: &str) -> Option<Base> {
    let names = ["id", "canid", "identifier", "arbitrationid", "arbid", "messageid", "msgid", "frameid"];
    names.into_iter().find_map(|start| match name.strip_prefix(start)? {
        "" => Some(Base::Usual),
        "hex" => Some(Base::Hexadecimal),
        "dec" | "decimal" => Some(Base::Decimal),
        _ => None,
    })
}

/// Tests for `d0`, `data1`, `byte2` and the like.
fn is_byte(name: &str) -> bool {
    let number = ["databyte", "data", "byte", "d", "b"].into_iter().find_map(|start| name.strip_prefix(start));
    number.is_some_and(|digits| matches!(digits.parse(), Ok(0_u8..=64)))
}

/// What the cells of a line say.
#[derive(Default)]
struct Cells<'a> {
    time: Option<Stamp<'a>>,
    channel: Option<&'a str>,
    identifier: Option<(&'a str, Base)>,
    extended: Option<bool>,
    remote: bool,
    error: bool,
    length: Option<usize>,
    data: Vec<u8>,
}

impl Clone for Columns {
    /// Reads the heading again: a clone of a reader of `csv_core` 0.1 takes all letters for the same.
    fn clone(&self) -> Self {
        Self::parted(&self.heading, self.separator)
    }
}

impl Columns {
    /// Reads a heading, `None` from a line that has none with an identifier and data.
    pub fn of(line: &str) -> Option<Self> {
        Self::readings(line).find(|columns| columns.has() == (true, true))
    }

    /// Says what a heading lacks that has an identifier without data, or data without an identifier.
    pub fn lack(line: &str) -> Option<String> {
        let (what, names) = Self::readings(line).find_map(|columns| match columns.has() {
            (true, false) => Some(("the data", "`data` or `d0`")),
            (false, true) => Some(("the identifier", "`id`")),
            (true, true) | (false, false) => None,
        })?;
        let heading = quoted(line.trim());
        Some(format!("the heading {heading} has no column for {what}, such as {names}; no row below it is read"))
    }

    /// Refuses a heading whose columns are parted by blanks or bars. Blanks also stand inside of cells.
    pub fn aligned(line: &str) -> Option<String> {
        let kinds: Vec<_> = line.split([' ', '|']).filter(|name| !name.is_empty()).map(Column::named).collect();
        let has = |is_it: fn(&Column) -> bool| kinds.iter().any(is_it);
        let is_heading = has(|column| matches!(column, Column::Identifier(_)))
            && has(|column| matches!(column, Column::Time(_) | Column::Data | Column::Byte));
        is_heading.then(|| {
            let (heading, help) = (quoted(line.trim()), "put a comma, a semicolon or a tab between them");
            format!("only blanks or bars part the columns of {heading}; {help}; no row below it is read")
        })
    }

    /// Parts a line by each separator that it has.
    fn readings(line: &str) -> impl Iterator<Item = Self> {
        let separators = SEPARATORS.into_iter().filter(|separator| line.as_bytes().contains(separator));
        separators.map(|separator| Self::parted(line, separator))
    }

    fn parted(line: &str, separator: u8) -> Self {
        let reader = ReaderBuilder::new().delimiter(separator).build();
        let base64 = line.trim_ascii() == PYTHON_CAN;
        let (kinds, text, ends) = (Vec::new(), Vec::new(), Vec::new());
        let mut parted = Self { heading: line.to_owned(), separator, kinds, base64, reader, text, ends };
        let count = parted.split(line);
        parted.kinds = (0..count).map(|index| Column::named(parted.cell(index).unwrap_or_default())).collect();
        parted.count_as_savvycan();
        parted
    }

    /// `SavvyCAN` counts microseconds, and does not say so.
    fn count_as_savvycan(&mut self) {
        if self.heading.starts_with("Time Stamp,ID,Extended,") {
            self.kinds[0] = Column::Time(6);
        }
    }

    /// Tests for an identifier and for data.
    fn has(&self) -> (bool, bool) {
        let has = |is_it: fn(&Column) -> bool| self.kinds.iter().any(is_it);
        (
            has(|column| matches!(column, Column::Identifier(_))),
            has(|column| matches!(column, Column::Data | Column::Byte)),
        )
    }

    /// Splits a line into cells, and returns how many there are.
    fn split(&mut self, line: &str) -> usize {
        self.reader.reset();
        self.text.resize(line.len(), 0);
        self.ends.resize(line.len() + 1, 0);
        let line = line.strip_suffix('\r').unwrap_or(line).as_bytes();
        let (_, _, written, count) = self.reader.read_record(line, &mut self.text, &mut self.ends);
        let (rest, ends) = (&mut self.text[written..], &mut self.ends[count..]);
        let (end, _, _, more) = self.reader.read_record(&[], rest, ends);
        debug_assert!(matches!(end, ReadRecordResult::Record | ReadRecordResult::End));
        count + more
    }

    fn place(&self, index: usize) -> Option<Range<usize>> {
        let start = if index == 0 { 0 } else { *self.ends.get(index - 1)? };
        Some(start..*self.ends.get(index)?)
    }

    fn cell(&self, index: usize) -> Option<&str> {
        str::from_utf8(self.text.get(self.place(index)?)?).ok().map(str::trim)
    }

    /// Makes a name of a channel such as `CAN 1` or `(1)`, by `_` for each character that no name may have.
    fn name_channels(&mut self, count: usize) {
        let is_channel = |index: &usize| self.kinds.get(*index) == Some(&Column::Channel);
        let places: Vec<_> = (0..count).filter(is_channel).filter_map(|index| self.place(index)).collect();
        for place in places {
            let Some(cell) = self.text.get_mut(place) else { continue };
            let name = cell.len() - cell.trim_ascii_start().len()..cell.trim_ascii_end().len();
            let letters = cell.get_mut(name).into_iter().flatten();
            letters.filter(|byte| matches!(byte, b' ' | b'\t' | b'#' | b'(')).for_each(|byte| *byte = b'_');
        }
    }

    /// Reads a line that is not blank; the heading may stand there again, where logs were put together.
    pub fn read(&mut self, line: &str) -> Result<Option<Entry<'_>>, String> {
        if line == self.heading {
            return Ok(None);
        }
        let count = self.split(line);
        self.name_channels(count);
        // Cells at the end that hold nothing may be missing, or be more than those of the heading.
        let surplus = (self.kinds.len()..count).filter_map(|index| self.cell(index)).find(|cell| !cell.is_empty());
        if let Some(cell) = surplus {
            return Err(format!("the cell {} has no heading", quoted(cell)));
        }
        let mut cells = Cells::default();
        for (index, column) in self.kinds.iter().enumerate() {
            let cell = if index < count { self.cell(index) } else { None };
            cells.take(*column, cell.unwrap_or_default(), self.base64)?;
        }
        cells.entry().map(Some)
    }
}

impl<'a> Cells<'a> {
    /// Takes the text of a cell.
    fn take(&mut self, column: Column, text: &'a str, base64: bool) -> Result<(), String> {
        match column {
            Column::Other => {}
            Column::Extended => self.extended = answer(text)?,
            Column::Remote => self.remote = answer(text)?.unwrap_or_default(),
            Column::Error => self.error = answer(text)?.unwrap_or_default(),
            Column::Identifier(base) => self.identifier = Some((text, base)),
            _ if text.is_empty() => {}
            Column::Time(places) => self.time = Some(time(text, places)?),
            Column::Channel => self.channel = Some(channel(text)?),
            Column::Length => {
                self.length = Some(text.parse().map_err(|_| format!("the length {} is no number", quoted(text)))?);
            }
            Column::Data if base64 => self.data = of_base64(text)?,
            Column::Data | Column::Byte => self.data.extend(parted_bytes(text)?),
        }
        Ok(())
    }

    fn entry(self) -> Result<Entry<'a>, String> {
        let Self { time, channel, identifier, extended, remote, error, length, data } = self;
        let (text, base) = identifier.unwrap_or(("", Base::Usual));
        let (id, extended) = if base == Base::Decimal { decimal(text, extended) } else { id(text, base, extended) }?;
        fewer(data.len(), FLEXIBLE)?;
        let form = match (error, remote) {
            (true, _) => Form::Error,
            (false, true) => Form::Remote,
            (false, false) if data.len() > CLASSIC => Form::Fd,
            (false, false) => Form::Data,
        };
        if matches!(form, Form::Data | Form::Fd) {
            as_many(length.unwrap_or(data.len()), data.len())?;
        }
        let digit = length.filter(|_| form == Form::Remote).and_then(|length| u8::try_from(length).ok());
        let (extended, data) = (extended || error, if form == Form::Remote { Vec::new() } else { data });
        Ok(Entry { time, channel, frame: Frame { id, extended, data, form }, digit: digit.unwrap_or_default() })
    }
}

/// Reads seconds, or smaller units, or a date with a time of day.
fn time(text: &str, places: usize) -> Result<Stamp<'_>, String> {
    match text.split_once([' ', 'T']) {
        Some((day, time)) => date(day, time),
        None if places > 0 => moved(text, places),
        None => seconds(text),
    }
}

/// Reads an identifier; one of more than 11 bits or with eight digits has 29.
fn id(text: &str, base: Base, extended: Option<bool>) -> Result<(u32, bool), String> {
    let digits = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")).unwrap_or(text);
    let marked = digits.strip_suffix(['x', 'X']);
    let digits = marked.unwrap_or(digits);
    let append = |number: u32, digit: char| Some(number.saturating_mul(16).saturating_add(digit.to_digit(16)?));
    let number = digits.chars().try_fold(0, append).filter(|_| !digits.is_empty());
    let number = number.ok_or_else(|| format!("the identifier {} is not hexadecimal", quoted(text)))?;
    let looks_decimal = base == Base::Usual && text.bytes().all(|byte| byte.is_ascii_digit());
    // Who writes hexadecimal digits alone writes three or eight of them.
    if looks_decimal && matches!(digits.len(), 4..=7) && !digits.starts_with('0') {
        let help = "name the column `id_dec` or `id_hex`";
        return Err(format!("the identifier {digits} may be decimal or hexadecimal; {help}"));
    }
    let extended = extended.unwrap_or(marked.is_some() || digits.len() > 7 || number > LARGEST_STANDARD);
    let help = "; identifiers are read as hexadecimal; if they are decimal, name the column `id_dec`";
    let help = if looks_decimal { help } else { "" };
    fitting(number, extended, digits).map(|number| (number, extended)).map_err(|why| why + help)
}

/// Reads a decimal identifier; one of more than 11 bits has 29.
fn decimal(text: &str, extended: Option<bool>) -> Result<(u32, bool), String> {
    let is_number = text.bytes().all(|byte| byte.is_ascii_digit());
    let number = text.parse().ok().filter(|number| is_number && *number <= LARGEST_EXTENDED);
    let refusal = || format!("the identifier {} is no decimal number up to {LARGEST_EXTENDED}", quoted(text));
    let number = number.ok_or_else(refusal)?;
    let extended = extended.unwrap_or(number > LARGEST_STANDARD);
    fitting(number, extended, &format!("{text} (0x{number:X})")).map(|number| (number, extended))
}

/// Reads whether something is so; an empty cell does not say.
fn answer(text: &str) -> Result<Option<bool>, String> {
    match text.to_ascii_lowercase().as_str() {
        "" => Ok(None),
        "1" | "true" | "yes" | "x" | "ext" | "extended" => Ok(Some(true)),
        "0" | "false" | "no" | "-" | "std" | "standard" => Ok(Some(false)),
        _ => Err(format!("{} is neither 1 nor 0", quoted(text))),
    }
}

/// Reads bytes in hexadecimal digits, together or with something between them. A digit alone is a byte.
fn parted_bytes(text: &str) -> Result<Vec<u8>, String> {
    let pieces = text.split([' ', '.', ':', '-']).filter(|piece| !piece.is_empty());
    let pieces = pieces.map(|piece| match piece.strip_prefix("0x").unwrap_or(piece) {
        digit if digit.len() == 1 => bytes(&format!("0{digit}"), FLEXIBLE),
        digits => bytes(digits, FLEXIBLE),
    });
    Ok(pieces.collect::<Result<Vec<_>, _>>()?.concat())
}

fn of_base64(text: &str) -> Result<Vec<u8>, String> {
    use base64::Engine;
    let data = base64::engine::general_purpose::STANDARD.decode(text);
    data.map_err(|_| format!("the data {} are not base 64", quoted(text)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::{hexadecimal, identifier_text};

    /// Reads a line below a heading as time and channel, form, identifier, data and digit.
    fn read(heading: &str, line: &str) -> Result<(String, Form, String, String, u8), String> {
        let mut columns = Columns::of(heading).expect("it is a heading");
        let entry = columns.read(line)?.expect("every line has a frame");
        let time = entry.time.as_deref().unwrap_or_default();
        let place = format!("{time} {}", entry.channel.unwrap_or_default());
        let Frame { data, form, .. } = &entry.frame;
        Ok((place, *form, identifier_text(&entry.frame), hexadecimal(data), entry.digit))
    }

    #[test]
    fn a_row_that_ends_before_its_channel_keeps_its_data() {
        let mut columns = Columns::of("id,data,dlc,bus").expect("it is a heading");
        for (row, channel) in [("1,1 2,,c 1", Some("c_1")), ("123,1 2", None)] {
            let entry = columns.read(row).expect("it is readable").expect("it has a frame");
            assert_eq!((entry.channel, hexadecimal(&entry.frame.data).as_str()), (channel, "0102"), "{row}");
        }
    }

    #[test]
    fn headings_say_what_the_columns_hold() {
        let savvy = "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8";
        let logs = [
            (PYTHON_CAN, "1700000000.0125,0x28300f0,1,0,0,2,ESI=", "1700000000.0125", "", "028300F0", "1122"),
            (savvy, "1500000,000001A5,false,Rx,0,2,11,22,", "1.500000", "0", "1A5", "1122"),
            ("Time (ms),CAN ID,Data", "12.5,18FF50E5,11 22", "0.0125", "", "18FF50E5", "1122"),
            ("Timestamp;Channel;ID;DLC;Data (hex)", "0.5;can1;0x7FF;2;0x11 0x22", "0.5", "can1", "7FF", "1122"),
            (
                "id\ttime\tdata\tnote",
                "123x\t2023-11-14 22:13:20.5\t1122\t\"a\tb\"",
                "1700000000.5",
                "",
                "00000123",
                "1122",
            ),
            ("\"ID\",\"Data\"", "\"00000123\",\"11-22\"", "", "", "00000123", "1122"),
            ("ts_ns,id,data", "1500000000,123,1 2 0xA", "1.500000000", "", "123", "01020A"),
            ("Time [µs];ID;D0;D1", "1500000;123;0;f", "1.500000", "", "123", "000F"),
            ("Timestamp (ms),CAN ID (dec),Data", "12,419385573,11", "0.012", "", "18FF50E5", "11"),
            ("ts,id_dec,data", "2023-11-14T23:13:20.5+01:00,2047,11", "1700000000.5", "", "7FF", "11"),
            ("id_dec,ext,data", "2047,1,11", "", "", "000007FF", "11"),
            ("id_hex,data", "1025,11", "", "", "00001025", "11"),
            ("bus,id,data", " CAN 1 ,123,11 22", "", "CAN_1", "123", "1122"),
            ("id,data,bus", "123,11 22,\"(CAN#\t1)\"", "", "_CAN__1)", "123", "1122"),
        ];
        for (heading, line, time, channel, id, data) in logs {
            let expected = (format!("{time} {channel}"), Form::Data, id.to_owned(), data.to_owned(), 0);
            assert_eq!(read(heading, line), Ok(expected), "{heading}");
        }
    }

    #[test]
    fn remote_error_and_fd_frames_are_told_apart() {
        let form = |line: &str| read(PYTHON_CAN, line).map(|(_, form, id, data, digit)| (form, id, data.len(), digit));
        assert_eq!(form("0,0x1fffffff,1,1,0,5,"), Ok((Form::Remote, "1FFFFFFF".to_owned(), 0, 5)));
        assert_eq!(form("0,0x4,0,0,1,0,"), Ok((Form::Error, "20000004".to_owned(), 0, 0)));
        assert_eq!(form("0,0x123,0,0,0,12,AAECAwQFBgcICQoL"), Ok((Form::Fd, "123".to_owned(), 24, 0)));
    }

    #[test]
    fn a_line_without_identifier_or_data_is_no_heading() {
        for line in ["time,id", "data,time", "0.5,123,00", "id data", "a;b"] {
            assert!(Columns::of(line).is_none(), "{line}");
        }
    }

    #[test]
    fn a_heading_with_a_part_of_what_it_needs_says_what_it_lacks() {
        let lacks = |line: &str, what: &str| Columns::lack(line).is_some_and(|why| why.contains(what));
        assert!(lacks("time;id;value", "no column for the data, such as `data`"));
        assert!(lacks("time,d0,d1", "no column for the identifier, such as `id`"));
        for line in ["id,data", "0.5,123,00", "a;b", "id"] {
            assert_eq!(Columns::lack(line), None, "{line}");
        }
    }

    #[test]
    fn an_unreadable_line_says_why() {
        let heading = "time,id,extended,dlc,data";
        let reasons = [
            ("0.5,123,0,2", "the line says that there are 2 data bytes, and has 0"),
            ("0.5,123,0,2,1122,,x", "the cell `x` has no heading"),
            ("x,123,0,2,1122", "the stamp `x` is no number"),
            ("1 2,123,0,2,1122", "the stamp `1 2` is no date with a time"),
            ("0.5,12G,0,2,1122", "the identifier `12G` is not hexadecimal"),
            ("0.5,,0,2,1122", "the identifier `` is not hexadecimal"),
            ("0.5,80F,0,2,1122", "the identifier 80F is above 7FF, the largest of 11 bits"),
            ("0.5,0x800,0,2,1122", "the identifier 800 is above 7FF, the largest of 11 bits"),
            (
                "0.5,2047,0,2,1122",
                "the identifier 2047 may be decimal or hexadecimal; name the column `id_dec` or `id_hex`",
            ),
            (
                "0.5,801,0,2,1122",
                "the identifier 801 is above 7FF, the largest of 11 bits; identifiers are read as hexadecimal; \
                 if they are decimal, name the column `id_dec`",
            ),
            (
                "0.5,419385573,,2,1122",
                "the identifier 419385573 is above 1FFFFFFF, the largest of 29 bits; identifiers are read as hexadecimal; \
                 if they are decimal, name the column `id_dec`",
            ),
            ("0.5,18FF50E5A,,2,1122", "the identifier 18FF50E5A is above 1FFFFFFF, the largest of 29 bits"),
            ("0.5,123,maybe,2,1122", "`maybe` is neither 1 nor 0"),
            ("0.5,123,0,two,1122", "the length `two` is no number"),
            ("0.5,123,0,3,1122", "the line says that there are 3 data bytes, and has 2"),
            ("0.5,123,0,2,11 223", "the data have an odd number of digits, 3"),
        ];
        for (line, reason) in reasons {
            assert_eq!(read(heading, line), Err(reason.to_owned()), "{line}");
        }
        let decimal = |line: &str| read("id_dec,ext,data", line).map(|_| ());
        for line in ["", "12G", "0x123", "+5", "536870912"] {
            let why = format!("the identifier `{line}` is no decimal number up to 536870911");
            assert_eq!(decimal(&format!("{line},,11")), Err(why));
        }
        let why = "the identifier 2048 (0x800) is above 7FF, the largest of 11 bits";
        assert_eq!(decimal("2048,0,11"), Err(why.to_owned()));
        assert_eq!(read(PYTHON_CAN, "0,0x1,0,0,0,1,%"), Err("the data `%` are not base 64".to_owned()));
    }
}
