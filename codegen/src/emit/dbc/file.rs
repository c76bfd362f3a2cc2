//! The parts of a DBC, and how they are written.

use std::fmt::{self, Display, Formatter};

use canspec_runtime::Place;
use canspec_runtime::plumbing::ByteOrder;

use super::names::short;
use crate::model::Range;
use crate::words::number::Rational;

/// A whole file.
pub struct File {
    pub comment: String,
    pub nodes: Vec<String>,
    pub frames: Vec<DbcMessage>,
}

/// A message of the DBC: the frames of one identifier.
pub struct DbcMessage {
    pub id: u32,
    pub extended: bool,
    pub name: String,
    pub length: u8,
    pub sender: String,
    pub receivers: String,
    pub comment: String,
    /// Milliseconds from one frame to the next.
    pub cycle: Option<u32>,
    pub signals: Vec<Signal>,
}

/// A signal of the DBC.
pub struct Signal {
    pub name: String,
    pub place: Place,
    pub signed: bool,
    pub float: bool,
    pub factor: Rational,
    pub offset: Rational,
    pub range: Option<Range>,
    pub unit: String,
    pub named: Vec<(i128, String)>,
    pub comment: String,
    /// Raw value that is sent by default.
    pub start: Option<i128>,
    /// Whether its value chooses the other signals of the frame.
    pub multiplexor: bool,
    /// Name and value of the multiplexor that it depends on.
    pub under: Option<(String, u64)>,
}

/// Longer names are written as a short name and an attribute.
const LONGEST: usize = 32;

const ATTRIBUTES: &str = r#"BA_DEF_ BO_ "GenMsgCycleTime" INT 0 86400000;
BA_DEF_ SG_ "GenSigStartValue" FLOAT -9223372036854775808 18446744073709551615;
BA_DEF_ BO_ "SystemMessageLongSymbol" STRING;
BA_DEF_ SG_ "SystemSignalLongSymbol" STRING;
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_DEF_DEF_ "GenSigStartValue" 0;
BA_DEF_DEF_ "SystemMessageLongSymbol" "";
BA_DEF_DEF_ "SystemSignalLongSymbol" "";"#;

/// Tests whether readers of a DBC can hold a named raw value, as a signed number of 64 bits.
pub fn is_writable(raw: i128) -> bool {
    i64::try_from(raw).is_ok()
}

impl Display for File {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        writeln!(out, "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: {}\n", self.nodes.join(" "))?;
        let names = short(self.frames.iter().map(|frame| frame.name.as_str()), LONGEST);
        let mut frames = self.frames.iter().zip(&names);
        frames.clone().try_for_each(|(frame, name)| frame.write(name, out))?;
        writeln!(out, "CM_ \"{}\";", self.comment)?;
        self.frames.iter().try_for_each(|frame| frame.write_comments(out))?;
        writeln!(out, "{ATTRIBUTES}")?;
        frames.try_for_each(|(frame, name)| frame.write_attributes(name, out))?;
        self.frames.iter().try_for_each(|frame| frame.write_values(out))?;
        self.frames.iter().try_for_each(|frame| frame.write_floats(out))?;
        self.frames.iter().try_for_each(|frame| frame.write_multiplexing(out))
    }
}

impl DbcMessage {
    /// Returns the identifier. Its bit 31 says that it has 29 bits.
    fn number(&self) -> u32 {
        self.id | if self.extended { 1 << 31 } else { 0 }
    }

    /// Returns the names of the signals as the file has them.
    fn names(&self) -> Vec<String> {
        short(self.signals.iter().map(|signal| signal.name.as_str()), LONGEST)
    }

    fn write(&self, name: &str, out: &mut Formatter<'_>) -> fmt::Result {
        writeln!(out, "BO_ {} {name}: {} {}", self.number(), self.length, self.sender)?;
        for (signal, name) in self.signals.iter().zip(self.names()) {
            writeln!(out, " SG_ {name}{} : {signal} {}", signal.marker(), self.receivers)?;
        }
        writeln!(out)
    }

    fn write_comments(&self, out: &mut Formatter<'_>) -> fmt::Result {
        if !self.comment.is_empty() {
            writeln!(out, "CM_ BO_ {} \"{}\";", self.number(), self.comment)?;
        }
        let commented = self.signals.iter().zip(self.names()).filter(|(signal, _)| !signal.comment.is_empty());
        for (signal, name) in commented {
            writeln!(out, "CM_ SG_ {} {name} \"{}\";", self.number(), signal.comment)?;
        }
        Ok(())
    }

    fn write_attributes(&self, name: &str, out: &mut Formatter<'_>) -> fmt::Result {
        let number = self.number();
        if let Some(cycle) = self.cycle {
            writeln!(out, "BA_ \"GenMsgCycleTime\" BO_ {number} {cycle};")?;
        }
        if name != self.name {
            writeln!(out, "BA_ \"SystemMessageLongSymbol\" BO_ {number} \"{}\";", self.name)?;
        }
        for (signal, name) in self.signals.iter().zip(self.names()) {
            if let Some(start) = signal.start {
                writeln!(out, "BA_ \"GenSigStartValue\" SG_ {number} {name} {start};")?;
            }
            if name != signal.name {
                writeln!(out, "BA_ \"SystemSignalLongSymbol\" SG_ {number} {name} \"{}\";", signal.name)?;
            }
        }
        Ok(())
    }

    fn write_values(&self, out: &mut Formatter<'_>) -> fmt::Result {
        for (signal, name) in self.signals.iter().zip(self.names()) {
            let named = signal.named.iter().filter(|(raw, _)| is_writable(*raw));
            let values: Vec<_> = named.map(|(raw, text)| format!("{raw} \"{text}\"")).collect();
            if !values.is_empty() {
                writeln!(out, "VAL_ {} {name} {} ;", self.number(), values.join(" "))?;
            }
        }
        Ok(())
    }

    fn write_floats(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let mut floats = self.signals.iter().zip(self.names()).filter(|(signal, _)| signal.float);
        floats.try_for_each(|(_, name)| writeln!(out, "SIG_VALTYPE_ {} {name} : 1;", self.number()))
    }

    /// Writes which multiplexor a signal depends on, if there are several.
    fn write_multiplexing(&self, out: &mut Formatter<'_>) -> fmt::Result {
        if self.signals.iter().filter(|signal| signal.multiplexor).count() < 2 {
            return Ok(());
        }
        let names = self.names();
        for (signal, name) in self.signals.iter().zip(&names) {
            let Some((multiplexor, value)) = &signal.under else { continue };
            let is_meant = |(other, _): &(&Signal, &String)| other.name == *multiplexor;
            if let Some((_, multiplexor)) = self.signals.iter().zip(&names).find(is_meant) {
                writeln!(out, "SG_MUL_VAL_ {} {name} {multiplexor} {value}-{value};", self.number())?;
            }
        }
        Ok(())
    }
}

impl Signal {
    /// Returns an unsigned number without a meaning.
    pub fn new(name: String, place: Place) -> Self {
        Self {
            name,
            place,
            signed: false,
            float: false,
            factor: Rational::ONE,
            offset: Rational::ZERO,
            range: Some(Range { minimum: Rational::ZERO, maximum: Rational::integer(place.max().into()) }),
            unit: String::new(),
            named: Vec::new(),
            comment: String::new(),
            start: None,
            multiplexor: false,
            under: None,
        }
    }

    fn marker(&self) -> String {
        let under = self.under.as_ref().map_or(String::new(), |(_, value)| format!("m{value}"));
        let multiplexor = if self.multiplexor { "M" } else { "" };
        let space = if under.is_empty() && multiplexor.is_empty() { "" } else { " " };
        format!("{space}{under}{multiplexor}")
    }
}

impl Display for Signal {
    /// Writes place, scale, limits and unit.
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let (start, order) = start_bit(self.place);
        let sign = if self.signed || self.float { '-' } else { '+' };
        let (minimum, maximum) =
            self.range.map_or((Rational::ZERO, Rational::ZERO), |range| (range.minimum, range.maximum));
        let [factor, offset, minimum, maximum] = [self.factor, self.offset, minimum, maximum].map(decimal);
        let width = self.place.width();
        write!(out, "{start}|{width}@{order}{sign} ({factor},{offset}) [{minimum}|{maximum}] \"{}\"", self.unit)
    }
}

/// Returns the start bit and the byte order of a DBC. If the low byte comes first, they are the
/// least significant bit and 1. If the high byte comes first, they are the most significant bit and
/// 0. Bits count from the least significant one of the first byte.
fn start_bit(place: Place) -> (u8, u8) {
    let bits = place.bits_of_payload();
    match place.order() {
        ByteOrder::Little => (bits.shift(), 1),
        ByteOrder::Big => {
            let high = bits.shift() + bits.width() - 1;
            (8 * (7 - high / 8) + high % 8, 0)
        }
    }
}

/// Writes a number as a decimal. A decimal that does not end is rounded to the nearest double.
fn decimal(number: Rational) -> String {
    let text = number.to_string();
    if text.contains('/') { number.to_f64().to_string() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_where_the_format_counts_it() {
        let places = [
            (Place::bytes(0, 1), "7|16@0"),
            (Place::bytes(1, 0), "0|16@1"),
            (Place::bytes(4, 7), "39|32@0"),
            (Place::bytes(7, 4), "32|32@1"),
            (Place::bytes(2, 3).bits(11, 0), "19|12@0"),
            (Place::bytes(3, 2).bits(11, 0), "16|12@1"),
            (Place::bytes(3, 2).bits(15, 4), "20|12@1"),
            (Place::byte(5).bit(6), "46|1@0"),
            (Place::bytes(6, 7).bit(9), "49|1@0"),
            (Place::bytes(0, 7), "7|64@0"),
        ];
        for (place, expected) in places {
            let text = Signal::new("level".to_owned(), place).to_string();
            assert!(text.starts_with(expected), "{text} instead of {expected}");
        }
    }

    #[test]
    fn numbers_have_no_fraction_line() {
        let numbers = [("1/1024", "0.0009765625"), ("-40", "-40"), ("1/3", "0.3333333333333333"), ("0.1", "0.1")];
        for (number, expected) in numbers {
            assert_eq!(Rational::parse(number).map(decimal), Some(expected.to_owned()));
        }
    }
}
