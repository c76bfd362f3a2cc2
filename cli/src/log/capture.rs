//! Captures in the pcapng format, which Wireshark reads.

use std::collections::HashMap;
use std::collections::hash_map;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;

use canspec_codegen::interpret::{Form, Frame};

use crate::log::Entry;

const SECTION: u32 = 0x0A0D_0D0A;
const INTERFACE: u32 = 1;
const ENHANCED_PACKET: u32 = 6;
/// Tells the reader the byte order: little endian.
const BYTE_ORDER: u32 = 0x1A2B_3C4D;
/// Option of a section: the program that wrote it.
const APPLICATION: u16 = 4;
/// `LINKTYPE_CAN_SOCKETCAN`.
const SOCKETCAN: u16 = 227;
/// Options of an interface: its name, and the decimal places of its times.
const NAME: u16 = 2;
const RESOLUTION: u16 = 9;
const PLACES: u8 = 9;
/// The flag of a 29-bit identifier.
const EXTENDED: u32 = 1 << 31;
const REMOTE: u32 = 1 << 30;
const ERROR: u32 = 1 << 29;
/// The flag of an FD frame. The flags of the log come in addition.
const FD: u8 = 4;

/// The file of a capture. Its first block has a seal of the rest. Other programs keep that block when they change the
/// file, and then the seal does not match.
pub struct Sealed {
    file: File,
    seal: Seal,
    /// A device or a pipe has none.
    has_seal: bool,
}

/// A number that follows from bytes: their hash by FNV-1a, of 64 bits.
#[derive(Clone, Copy)]
struct Seal(u64);

impl Seal {
    const OF_NOTHING: Self = Self(0xCBF2_9CE4_8422_2325);

    fn add(&mut self, bytes: &[u8]) {
        const PRIME: u64 = 0x0100_0000_01B3;
        self.0 = bytes.iter().fold(self.0, |seal, byte| (seal ^ u64::from(*byte)).wrapping_mul(PRIME));
    }
}

impl Sealed {
    /// Makes the file of a capture with its first block, in place of one that canspec wrote last, or that is empty. With `is_forced` it takes
    /// the place of any file.
    ///
    /// # Errors
    ///
    /// Where the file cannot be written, or is to be kept.
    pub fn create(path: &Path, is_forced: bool) -> io::Result<Self> {
        let has_seal = fs::metadata(path).map_or(true, |known| known.is_file());
        let mut file = File::options().read(has_seal).write(true).create(true).truncate(false).open(path)?;
        if has_seal {
            if !is_forced && !is_own(&file)? {
                let why = "the file is no capture that canspec wrote last, so it is kept; name another one after \
                           `--to pcapng`, or add `--force`";
                return Err(io::Error::new(io::ErrorKind::AlreadyExists, why));
            }
            file.set_len(0)?;
            file.rewind()?;
        }
        let mut sealed = Self { file, seal: Seal::OF_NOTHING, has_seal };
        let section = sealed.section()?;
        sealed.file.write_all(&section)?;
        Ok(sealed)
    }

    /// Returns the first block of a capture in it.
    fn section(&self) -> io::Result<Vec<u8>> {
        section(self.has_seal.then_some(self.seal))
    }
}

impl Write for Sealed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.file.write(bytes)?;
        self.seal.add(&bytes[..count]);
        Ok(count)
    }

    /// Seals what is written. So a capture that is stopped has its seal.
    fn flush(&mut self) -> io::Result<()> {
        if self.has_seal {
            let section = self.section()?;
            self.file.rewind()?;
            self.file.write_all(&section)?;
            self.file.seek(SeekFrom::End(0))?;
        }
        self.file.flush()
    }
}

/// Tests whether a file is empty, or as canspec wrote it.
fn is_own(file: &File) -> io::Result<bool> {
    let mut reader = BufReader::new(file);
    let mut first = vec![0; section(Some(Seal::OF_NOTHING))?.len()];
    if reader.fill_buf()?.is_empty() {
        return Ok(true);
    }
    if let Err(error) = reader.read_exact(&mut first) {
        return if error.kind() == io::ErrorKind::UnexpectedEof { Ok(false) } else { Err(error) };
    }
    let mut seal = Seal::OF_NOTHING;
    loop {
        let bytes = reader.fill_buf()?;
        if bytes.is_empty() {
            return Ok(first == section(Some(seal))?);
        }
        seal.add(bytes);
        let count = bytes.len();
        reader.consume(count);
    }
}

/// Returns the first block of a capture. It names canspec, and has the seal of the bytes behind it if there is one.
fn section(seal: Option<Seal>) -> io::Result<Vec<u8>> {
    let length_unknown = u64::MAX.to_le_bytes();
    let head = [&BYTE_ORDER.to_le_bytes()[..], &1_u16.to_le_bytes(), &0_u16.to_le_bytes(), &length_unknown];
    let application = seal.map_or_else(|| "canspec".to_owned(), |Seal(seal)| format!("canspec, seal {seal:016X}"));
    let mut bytes = Vec::new();
    block(&mut bytes, SECTION, &[head.concat(), option(APPLICATION, application.as_bytes()), vec![0; 4]].concat())?;
    Ok(bytes)
}

/// A capture that is being written; each channel of the log is an interface.
#[derive(Default)]
pub struct Capture {
    /// Numbers of the interfaces.
    channels: HashMap<Option<String>, u32>,
}

impl Capture {
    /// Begins a capture. It can be read from then on.
    ///
    /// # Errors
    ///
    /// Where `out` cannot be written.
    pub fn begin(out: &mut impl Write) -> io::Result<Self> {
        out.write_all(&section(None)?)?;
        out.flush()?;
        Ok(Self::default())
    }

    /// Writes a frame. Without a stamp its time is 0. Digits after the nanoseconds are cut off.
    ///
    /// # Errors
    ///
    /// Where the capture cannot be written, or its format has no such time.
    pub fn frame(&mut self, out: &mut impl Write, entry: &Entry<'_>) -> Result<io::Result<()>, String> {
        let time = entry.time.as_deref().map_or(Ok(0), |time| {
            let refusal = || format!("a capture has no time `{time}`; it counts nanoseconds from 1970 to 2554");
            nanoseconds(time).ok_or_else(refusal)
        })?;
        Ok(self.packet(out, entry, time))
    }

    fn packet(&mut self, out: &mut impl Write, entry: &Entry<'_>, time: u64) -> io::Result<()> {
        let interface = self.interface(out, entry.channel)?;
        let [low, high] = [time, time >> 32].map(|half| half & u64::from(u32::MAX));
        let bytes = socketcan(&entry.frame, entry.digit);
        let numbers = [interface, half(high), half(low), length(&bytes), length(&bytes)];
        let head: Vec<u8> = numbers.into_iter().flat_map(u32::to_le_bytes).collect();
        block(out, ENHANCED_PACKET, &[head, bytes].concat())
    }

    /// Returns the number of the channel's interface. The interface is written on its first use.
    fn interface(&mut self, out: &mut impl Write, channel: Option<&str>) -> io::Result<u32> {
        let next = u32::try_from(self.channels.len()).unwrap_or(u32::MAX);
        let entry = match self.channels.entry(channel.map(str::to_owned)) {
            hash_map::Entry::Occupied(known) => return Ok(*known.get()),
            hash_map::Entry::Vacant(entry) => entry,
        };
        let head = [SOCKETCAN.to_le_bytes(), [0; 2], [0; 2], [0; 2]].concat();
        let name = channel.map_or_else(Vec::new, |name| option(NAME, name.as_bytes()));
        block(out, INTERFACE, &[head, name, option(RESOLUTION, &[PLACES]), vec![0; 4]].concat())?;
        Ok(*entry.insert(next))
    }
}

/// Writes a block, with its length before and after it. It writes all at once, so that no buffer is
/// flushed inside a block.
fn block(out: &mut impl Write, kind: u32, body: &[u8]) -> io::Result<()> {
    let body = padded(body);
    let total = length(&body).saturating_add(12).to_le_bytes();
    out.write_all(&[&kind.to_le_bytes()[..], &total, &body, &total].concat())
}

fn option(code: u16, value: &[u8]) -> Vec<u8> {
    let length = u16::try_from(value.len()).unwrap_or(u16::MAX);
    let value = &value[..usize::from(length)];
    [&code.to_le_bytes()[..], &length.to_le_bytes(), &padded(value)].concat()
}

/// Fills bytes up to a multiple of four.
fn padded(bytes: &[u8]) -> Vec<u8> {
    let mut padded = bytes.to_vec();
    padded.resize(bytes.len().next_multiple_of(4), 0);
    padded
}

fn length(bytes: &[u8]) -> u32 {
    u32::try_from(bytes.len()).unwrap_or(u32::MAX)
}

fn half(number: u64) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

/// Returns a frame in the format of Linux: identifier with its flags, length, flags of FD, data.
fn socketcan(frame: &Frame, digit: u8) -> Vec<u8> {
    let count = u8::try_from(frame.data.len()).unwrap_or(u8::MAX);
    let width = if frame.extended { EXTENDED } else { 0 };
    let (bits, count, flags) = match frame.form {
        Form::Data => (width, count, 0),
        Form::Remote => (width | REMOTE, digit, 0),
        Form::Error => (ERROR, count, 0),
        Form::Fd => (width, count, FD | digit),
    };
    [&(frame.id | bits).to_be_bytes()[..], &[count, flags, 0, 0], &frame.data].concat()
}

/// Converts a decimal number of seconds to nanoseconds, without floating-point numbers.
pub fn nanoseconds(seconds: &str) -> Option<u64> {
    let (mantissa, exponent) = seconds.split_once(['e', 'E']).unwrap_or((seconds, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: u128 = format!("{whole}{fraction}").parse().ok()?;
    let places = i64::try_from(fraction.len()).ok()?;
    let power = exponent.parse::<i64>().ok()?.checked_add(i64::from(PLACES))?.checked_sub(places)?;
    let factor = 10_u128.checked_pow(u32::try_from(power.unsigned_abs()).ok()?);
    let nanoseconds = match factor {
        _ if digits == 0 => 0,
        Some(factor) if power >= 0 => digits.checked_mul(factor)?,
        None if power >= 0 => return None,
        factor => factor.map_or(0, |factor| digits / factor),
    };
    u64::try_from(nanoseconds).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log;

    /// Returns the blocks that follow the section's head, one a line in hexadecimal.
    fn blocks(lines: &[&str]) -> Vec<String> {
        let mut bytes = Vec::new();
        let mut capture = Capture::begin(&mut bytes).expect("a vector takes everything");
        for line in lines {
            let mut reader = log::Reader::default();
            let entry = reader.read(line).expect("a readable line").expect("a frame");
            capture.frame(&mut bytes, &entry).expect("a time").expect("a vector takes everything");
        }
        let mut rest = &bytes[section(None).expect("a vector takes everything").len()..];
        let mut blocks = Vec::new();
        while let Some(length) = rest.get(4..8) {
            let (block, after) = rest.split_at(u32::from_le_bytes(length.try_into().expect("four bytes")) as usize);
            blocks.push(log::hexadecimal(block).to_lowercase());
            rest = after;
        }
        blocks
    }

    #[test]
    fn each_channel_is_an_interface_with_times_in_nanoseconds() {
        // Put together by hand from the pcapng specification: kind, length, fields, options, length; 1.5 s are 0x59682F00 ns.
        let interface = |digit: u8| {
            format!("0100000028000000 e300000000000000 0200040063616e3{digit} 0900010009000000 00000000 28000000")
        };
        let packet = |index: u8| {
            format!(
                "060000002c000000 0{index}000000 00000000002f6859 0900000009000000 0000012301000000 ab000000 2c000000"
            )
        };
        let expected = [interface(0), packet(0), interface(1), packet(1), packet(0)];
        let lines = ["(1.5) can0 123#AB", "(1.5) can1 123#AB", "(1.5) can0 123#AB"];
        assert_eq!(blocks(&lines), expected.map(|block| block.replace(' ', "")));
    }

    #[test]
    fn a_capture_begins_with_the_program_that_wrote_it() {
        // By hand as above: the option 4 has 7 bytes, and the length of the section is unknown.
        let head = "0a0d0d0a2c000000 4d3c2b1a01000000 ffffffffffffffff 0400070063616e7370656300 00000000 2c000000";
        let mut bytes = Vec::new();
        Capture::begin(&mut bytes).expect("a vector takes everything");
        assert_eq!(log::hexadecimal(&bytes).to_lowercase(), head.replace(' ', ""));
    }

    #[test]
    fn a_seal_is_the_hash_of_the_bytes_however_they_are_parted() {
        // Test vectors of FNV-1a from draft-eastlake-fnv.
        for (text, hash) in
            [("", 0xCBF2_9CE4_8422_2325), ("a", 0xAF63_DC4C_8601_EC8C), ("foobar", 0x8594_4171_F739_67E8)]
        {
            let [mut whole, mut parted] = [Seal::OF_NOTHING; 2];
            whole.add(text.as_bytes());
            text.as_bytes().chunks(2).for_each(|chunk| parted.add(chunk));
            assert_eq!((whole.0, parted.0), (hash, hash), "{text}");
        }
    }

    #[test]
    fn a_capture_that_is_stopped_behind_a_flush_is_sealed() {
        let folder = tempfile::tempdir().expect("there is a folder for temporary files");
        let path = folder.path().join("capture");
        let is_own = || is_own(&File::open(&path).expect("it is there")).expect("it can be read");
        let mut sealed = Sealed::create(&path, false).expect("the folder can be written");
        let mut seen = vec![is_own()];
        for _ in 0..2 {
            sealed.write_all(b"some block").expect("it can be written");
            seen.push(is_own());
            sealed.flush().expect("it can be written");
            seen.push(is_own());
        }
        assert_eq!(seen, [true, false, true, false, true]);
        assert!(fs::read(&path).expect("it is there").ends_with(b"some blocksome block"));
    }

    #[test]
    fn identifiers_carry_the_flags_of_linux() {
        let packets = |line: &str| blocks(&[line])[1][56..].to_owned();
        assert!(packets("12345678#01").starts_with("9234567801000000"));
        assert!(packets("123#R5").starts_with("4000012305000000"));
        assert!(packets("20000004#0000000000000000").starts_with("2000000408000000"));
        assert!(packets("123##3AABB").starts_with("0000012302070000aabb"));
    }

    #[test]
    fn a_time_is_exact_to_the_last_digit_of_the_log() {
        for (text, expected) in [
            ("1700000000.123456", Some(1_700_000_000_123_456_000)),
            ("1700000000.123456789", Some(1_700_000_000_123_456_789)),
            ("0.0000000019", Some(1)),
            ("1.5e3", Some(1_500_000_000_000)),
            ("15e-1", Some(1_500_000_000)),
            ("0e99", Some(0)),
            ("1e-99", Some(0)),
            ("18446744073.709551615", Some(u64::MAX)),
            ("18446744073.709551616", None),
            ("1e99", None),
            ("-1", None),
        ] {
            assert_eq!(nanoseconds(text), expected, "{text}");
        }
    }
}
