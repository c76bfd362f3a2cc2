//! Numbers: floats, scaled and decimal ones, limits and scales of device models.

use canspec_codegen::model::{Numeral, Unit};
use canspec_codegen::number::Rational;

use super::draft::{Draft, Limited};
use super::yaml::Map;

/// Steps of scaled numbers.
const SCALES: [&str; 10] = ["1/10", "0.1", "1/1000", "1/1024", "0.02", "5", "10", "3/8", "-1/2", "1/3"];
/// Physical values of raw 0.
const OFFSETS: [&str; 5] = ["-40", "100", "0xFD", "1/2", "-0.5"];
/// The widest number that is scaled.
const SCALED: u8 = 22;

/// Limits of a number.
pub struct Grid {
    numeral: Numeral,
    scale: Rational,
    offset: Rational,
    lowest: i128,
    highest: i128,
}

impl Grid {
    /// Writes the physical value of a raw value.
    fn physical(&self, raw: i128) -> String {
        let value = Rational::integer(raw).times(self.scale).and_then(|value| value.plus(self.offset));
        value.expect("the numbers are small").fraction()
    }

    /// Writes the range between two raw values.
    fn range(&self, first: i128, last: i128) -> String {
        let (first, last) = if self.scale < Rational::ZERO { (last, first) } else { (first, last) };
        format!("{}..{}", self.physical(first), self.physical(last))
    }
}

impl Draft {
    pub fn float(&mut self, field: &mut Map) {
        field.put("as", "float");
        self.unit(field);
        if self.chance(30) {
            field.put("range", self.one(&["0..100", "-1/3..20.06", "0.1..0.2", "-1000000..1000000"]));
            if self.chance(30) {
                field.put("default", "0.125");
                field.put("range", "0..1");
            }
        }
    }

    pub fn unit(&mut self, field: &mut Map) {
        if self.chance(60) {
            let symbols: Vec<_> =
                Unit::ALL.iter().map(|unit| unit.symbol.to_string()).chain(self.units.clone()).collect();
            field.put("unit", self.one(&symbols));
        }
    }

    /// Makes a number, and returns how to write its values and which are allowed.
    pub fn quantity(&mut self, field: &mut Map, bits: u8) -> (Grid, i128, i128) {
        let grid = self.grid(field, bits);
        self.unit(field);
        let span = grid.highest - grid.lowest;
        let first = grid.lowest + self.one(&[0, 1.min(span), span / 4]);
        let last = grid.highest - self.one(&[0, 1.min(span), span / 4]);
        let (first, last) = (first.min(last), first.max(last));
        let has_range = self.chance(45);
        if has_range {
            field.put("range", grid.range(first, last));
        }
        if !has_range && bits > 1 && self.chance(15) {
            field.put("absent", "ones");
        }
        let is_number = ["unit", "scale", "offset", "range"].iter().any(|key| field.has(key));
        let edges = [grid.highest, grid.lowest, grid.highest - 1, grid.lowest + 1];
        let special: Vec<_> = edges.into_iter().filter(|raw| !has_range || !(first..=last).contains(raw)).collect();
        let special: Vec<_> = special.into_iter().filter(|raw| (grid.lowest..=grid.highest).contains(raw)).collect();
        if is_number && !special.is_empty() && self.chance(35) {
            let mut special = self.some(&special);
            special.sort_unstable();
            special.dedup();
            let raw: Vec<_> = special.into_iter().filter_map(|number| grid.numeral.raw(number)).collect();
            let values = self.names_of(&raw);
            field.put("values", values);
            self.values_on_some(field);
        }
        if has_range && self.chance(20) {
            field.put("out_of_range", self.one(&["refused", "ignored", "limited"]));
        }
        if self.chance(15) {
            field.put("power_off", self.one(&["kept", "lost"]));
        }
        if self.chance(20) {
            field.put("default", grid.physical(self.one(&[first, last])));
        }
        (grid, first, last)
    }

    fn grid(&mut self, field: &mut Map, bits: u8) -> Grid {
        let numeral = self.numeral(field, bits);
        let (lowest, highest) = numeral.limits(bits);
        let mut chosen = |draft: &mut Self, key: &str, of: &[&'static str], percent| {
            let text = (bits <= SCALED && draft.chance(percent)).then(|| draft.one(of))?;
            field.put(key, text);
            Rational::parse(text)
        };
        let scale = chosen(self, "scale", &SCALES, 45).unwrap_or(Rational::ONE);
        let offset = chosen(self, "offset", &OFFSETS, 25).unwrap_or(Rational::ZERO);
        Grid { numeral, scale, offset, lowest, highest }
    }

    fn numeral(&mut self, field: &mut Map, bits: u8) -> Numeral {
        match self.random.u8(..100) {
            0..10 if bits.is_multiple_of(4) => {
                field.put("as", "bcd");
                Numeral::Bcd
            }
            10..40 if bits > 1 => {
                field.put("as", "signed");
                Numeral::Signed
            }
            40..50 => {
                field.put("as", "unsigned");
                Numeral::Unsigned
            }
            _ => Numeral::Unsigned,
        }
    }

    /// Makes a number of a type that device models can limit.
    pub fn limited(&mut self, field: &mut Map, bits: u8) {
        if bits <= SCALED && self.chance(30) {
            return self.scaled_by_models(field, bits);
        }
        let mut keys = Map::default();
        let (grid, first, last) = self.quantity(&mut keys, bits);
        if !keys.has("range") {
            keys.0.remove("values");
        }
        keys.0.remove("default");
        let quarter = (last - first) / 4;
        let narrowed = [(first, last), (first + quarter, last), (first, last - quarter), (first, first)];
        let limits = |(first, last)| [("range", grid.range(first, last)), ("default", grid.physical(last))];
        let changes = narrowed.into_iter().flat_map(|ends| {
            let [range, default] = limits(ends);
            [Map::of([range.clone()]), Map::of([range, default])]
        });
        let changes = changes.collect();
        let name = self.add_type(keys);
        self.limited.push(Limited { name: name.clone(), changes });
        field.put("type", name);
    }

    /// Makes a number of a type that device models can scale.
    fn scaled_by_models(&mut self, field: &mut Map, bits: u8) {
        let mut keys = Map::of([("as", "unsigned")]);
        self.remark(&mut keys);
        let changes = (0..4).map(|_| self.scale_of_model(bits)).collect();
        let name = self.add_type(keys);
        self.limited.push(Limited { name: name.clone(), changes });
        field.put("type", name);
    }

    /// Returns what a device model says of a number without a sign.
    fn scale_of_model(&mut self, bits: u8) -> Map {
        let (scale, offset) = (self.one(&SCALES), self.one(&OFFSETS));
        let [scale, offset] = [scale, offset].map(|text| Rational::parse(text).expect("it is a number"));
        let (lowest, highest) = Numeral::Unsigned.limits(bits);
        let grid = Grid { numeral: Numeral::Unsigned, scale, offset, lowest, highest };
        let mut change = Map::of([("scale", scale.fraction()), ("offset", offset.fraction())]);
        self.unit(&mut change);
        if self.random.bool() {
            change.put("range", grid.range(lowest, highest / 2));
            change.put("default", grid.physical(lowest));
        }
        change
    }

    /// Writes the range of a part. Its ends can lie between two numbers, and few lie beyond what the bits hold.
    fn range_of_part(&mut self, greatest: u32) -> String {
        let first = self.random.u32(..=greatest);
        let ends = [first, self.random.u32(first..=greatest)].map(i128::from);
        let [first, last] = match self.random.u8(..100) {
            0 => [-2, 2 * ends[1]],
            1 => [2 * ends[0], 2 * i128::from(greatest) + 2],
            2..20 if ends[0] < ends[1] => [2 * ends[0] + 1, 2 * ends[1] - 1],
            _ => ends.map(|end| 2 * end),
        };
        let half = |count| Rational::integer(count).over(Rational::integer(2)).expect("2 is not 0").fraction();
        format!("{}..{}", half(first), half(last))
    }

    pub fn packed_number(&mut self, part: &mut Map, format: &mut String, name: &str, bits: u8) {
        let digits = if self.random.bool() { String::new() } else { format!(":{}", self.random.u8(1..=6)) };
        format.extend(["{", name, digits.as_str(), "}"]);
        let is_decimal = bits.is_multiple_of(4) && self.chance(20);
        if is_decimal {
            part.put("as", "bcd");
        }
        if self.chance(40) {
            let greatest = if is_decimal { 10_u32.pow(u32::from(bits / 4)) - 1 } else { u32::MAX >> (32 - bits) };
            let range = self.range_of_part(greatest);
            part.put("range", range);
        }
        self.remark(part);
    }
}
