//! Fields: texts, named values, status words, packed values and words.

use serde_yaml::Value;

use super::draft::Draft;
use super::names::Scope;
use super::yaml::{Map, list};

/// Where the fields of a message stand.
pub struct Site<'a> {
    /// The first byte that is free, and the length.
    pub first: u8,
    pub length: u8,
    /// The kinds of frames that the message has.
    pub kinds: &'a [&'static str],
    /// A field of the identifier or the header that replies can show by the type of a value.
    pub spare: Option<&'a str>,
    /// Whether some field is in every frame, and none in requests alone.
    pub is_member: bool,
}

/// The number of data bytes of a message that is longer than a frame.
pub enum Length {
    /// Without and with the last field.
    Fixed([u16; 2]),
    /// Any number of elements decides.
    Elements,
    /// The last text is open, and the message says how long it can be.
    Open(String),
}

impl Draft {
    /// Returns the fields of a message.
    pub fn fields(&mut self, site: &Site) -> Map {
        let (mut fields, mut scope, mut first) = (Map::default(), Scope::default(), site.first);
        let mut has_reply = false;
        while first < site.length {
            if self.chance(15) && !(site.is_member && fields.is_empty()) {
                first += 1;
                continue;
            }
            let count = self.random.u8(1..=site.length - first);
            let field = self.field(first, count, &mut scope, site, &mut has_reply);
            let name = self.names.plain(&mut scope);
            fields.put(name, field);
            first += count;
        }
        fields
    }

    /// Returns the fields of a message that is longer than a frame, and how long it is.
    pub fn long_fields(&mut self) -> (Map, Length) {
        let (mut fields, mut scope, mut first) = (Map::default(), Scope::default(), 0);
        for _ in 0..self.random.u8(1..5) {
            let count = self.random.u8(1..=8);
            let mut field = Map::of([("bytes", self.bytes(first, count))]);
            self.fill(&mut field, 8 * count);
            let name = self.names.plain(&mut scope);
            fields.put(name, field);
            first += count + self.random.u8(..2);
        }
        if self.chance(30) {
            let count = self.random.u8(9..=40);
            let mut text = Map::of([("bytes", format!("{first}..{}", first + count - 1))]);
            self.long_text(&mut text);
            let name = self.names.plain(&mut scope);
            fields.put(name, text);
            first += count;
        }
        if self.chance(25) {
            let mut text = Map::of([("bytes", format!("{first}.."))]);
            self.long_text(&mut text);
            let name = self.names.plain(&mut scope);
            fields.put(name, text);
            let least = u16::from(first) + self.random.u16(9..20);
            return (fields, Length::Open(format!("{least}..{}", least + self.random.u16(1..300))));
        }
        let varies = self.random.bool();
        let (size, most) = (self.random.u8(1..=4), self.random.u8(2..=30));
        let mut array = self.element(first, size, &mut scope);
        let least = self.random.u8(1..most);
        array.put("repeat", if varies { format!("{least}..{most}") } else { most.to_string() });
        let name = self.names.plain(&mut scope);
        fields.put(name, array);
        let whole = u16::from(first) + u16::from(size) * u16::from(most);
        (fields, if varies { Length::Elements } else { Length::Fixed([u16::from(first), whole]) })
    }

    /// Returns the first element of an array of a message of several frames: a word or another field.
    pub fn element(&mut self, first: u8, size: u8, scope: &mut Scope) -> Map {
        let mut element = Map::of([("bytes", self.bytes(first, size))]);
        if self.random.bool() {
            let parts = self.parts(8 * size, scope, false);
            element.put("fields", parts);
        } else {
            self.fill(&mut element, 8 * size);
        }
        element
    }

    /// Returns a field of `count` bytes.
    pub fn field(&mut self, first: u8, count: u8, scope: &mut Scope, site: &Site, has_reply: &mut bool) -> Map {
        if count > 1 && self.chance(12) {
            return self.array(first, count, scope, site, has_reply);
        }
        let place = self.bytes(first, count);
        if self.chance(12) {
            let mut packed = self.packed(first, count, scope);
            self.restrict(&mut packed, site, has_reply);
            return self.with_types(packed, &[], 8 * count);
        }
        let mut field = Map::of([("bytes", place)]);
        if count <= 4 && self.chance(25) {
            let parts = self.parts(8 * count, scope, true);
            field.put("fields", parts);
            self.refer(&mut field);
            return self.with_types(field, &[], 8 * count);
        }
        if self.chance(8) && !site.is_member && count < 5 {
            return self.constant(field, count, site);
        }
        self.fill(&mut field, 8 * count);
        self.count_by_byte(&mut field);
        self.restrict(&mut field, site, has_reply);
        self.with_types(field, &[], 8 * count)
    }

    /// Returns an array in `count` bytes, of words or of other fields.
    fn array(&mut self, first: u8, count: u8, scope: &mut Scope, site: &Site, has_reply: &mut bool) -> Map {
        let elements = self.random.u8(2..=count);
        let each = count / elements;
        let step = if elements == 2 { count - each } else { each };
        let is_falling = self.chance(20);
        let start = if is_falling { first + (elements - 1) * step } else { first };
        let mut field = Map::of([("bytes", self.bytes(start, each))]);
        if each <= 4 && self.chance(30) {
            let parts = self.parts(8 * each, scope, false);
            field.put("fields", parts);
            self.refer(&mut field);
        } else {
            self.fill(&mut field, 8 * each);
            self.restrict(&mut field, site, has_reply);
        }
        self.repeat(&mut field, elements, if is_falling { -i16::from(step) } else { step.into() }, each);
        self.with_types(field, &[], 8 * each)
    }

    /// Adds the keys of an array.
    fn repeat(&mut self, field: &mut Map, elements: u8, step: i16, size: u8) {
        field.put("repeat", elements.to_string());
        if step != i16::from(size) || self.chance(20) {
            field.put("step", step.to_string());
        }
        if self.chance(30) {
            field.put("first", self.one(&["0", "2", "300"]));
        }
    }

    /// Numbers some status bits in their byte instead of the word.
    fn count_by_byte(&mut self, field: &mut Map) {
        let place: Vec<u8> = field.text("bytes").split("..").filter_map(|end| end.parse().ok()).collect();
        let (Some(first), Some(last)) = (place.first(), place.last()) else { return };
        for bit in field.maps_in("status") {
            let Some(number) = bit.get("bit").and_then(|known| known.as_str()?.parse::<u8>().ok()) else { continue };
            if self.chance(20) {
                let byte = if first <= last { last - number / 8 } else { last + number / 8 };
                bit.insert("byte".into(), byte.to_string().into());
                bit.insert("bit".into(), (number % 8).to_string().into());
            }
        }
    }

    pub fn bytes(&mut self, first: u8, count: u8) -> String {
        let last = first + count - 1;
        match (count, self.random.bool()) {
            (1, _) => first.to_string(),
            (_, true) => format!("{first}..{last}"),
            (_, false) => format!("{last}..{first}"),
        }
    }

    /// Adds `in`, `models` and `reply`.
    fn restrict(&mut self, field: &mut Map, site: &Site, has_reply: &mut bool) {
        if !site.is_member && self.chance(8) {
            let kinds = self.some(site.kinds);
            field.put("in", list(kinds));
        }
        self.only_on_some(field, 8);
        if let Some(spare) = site.spare.filter(|_| !*has_reply && self.chance(12)) {
            *has_reply = true;
            let value = self.random.u8(..4);
            field.put("reply", Map::of([(spare, self.number(value))]));
        }
    }

    /// Lists the only device models that have a field or a status bit.
    fn only_on_some(&mut self, item: &mut Map, percent: u8) {
        if !self.models.is_empty() && self.chance(percent) {
            let models = self.models.clone();
            item.put("models", list(self.some(&models)));
        }
    }

    fn constant(&mut self, mut field: Map, count: u8, site: &Site) -> Map {
        let value = self.random.u32(..) >> (32 - 8 * u32::from(count));
        let value = self.number(value);
        field.put("const", value);
        if self.chance(20) {
            let values = self.values(&[0, 1]);
            field.put("values", values);
        }
        if self.chance(20) {
            let kinds = self.some(site.kinds);
            field.put("in", list(kinds));
        }
        self.remark(&mut field);
        field
    }

    /// Returns the fields of a word.
    fn parts(&mut self, width: u8, scope: &mut Scope, may_repeat: bool) -> Map {
        let (mut parts, mut low) = (Map::default(), 0);
        while low < width {
            let widest = if self.chance(60) { 4 } else { 32 };
            let bits = self.random.u8(1..=widest.min(width - low));
            if !self.chance(20) || parts.is_empty() {
                let (name, part) = (self.names.plain(scope), self.part(low, bits, may_repeat));
                parts.put(name, part);
            }
            low += bits;
        }
        parts
    }

    fn part(&mut self, low: u8, bits: u8, may_repeat: bool) -> Map {
        if may_repeat && bits > 1 && self.chance(12) {
            let size = bits / 2;
            let mut part = Map::of([("bits", bits_of(low, size))]);
            self.fill(&mut part, size);
            self.repeat(&mut part, 2, (bits - size).into(), size);
            return self.with_types(part, &[], size);
        }
        let mut part = Map::of([("bits", bits_of(low, bits))]);
        self.fill(&mut part, bits);
        self.with_types(part, &[], bits)
    }

    /// Says what `bits` bits mean.
    pub fn fill(&mut self, field: &mut Map, bits: u8) {
        let whole: Vec<_> = self.whole.iter().filter(|known| known.bits == bits).cloned().collect();
        if !whole.is_empty() && self.chance(25) {
            let known = self.one(&whole);
            return field.put("type", known.name);
        }
        match self.random.u8(..100) {
            0..=14 => self.named(field, bits),
            15..=29 => self.status(field, bits),
            30..=44 if bits == 32 => self.float(field),
            30..=39 if bits.is_multiple_of(8) => self.ascii(field, bits / 8),
            40..=44 => return self.limited(field, bits),
            _ => drop(self.quantity(field, bits)),
        }
        self.remark(field);
    }

    fn named(&mut self, field: &mut Map, bits: u8) {
        let greatest = u64::MAX >> (64 - bits);
        let values = self.values(&[0, 1, greatest, greatest / 2, greatest - greatest / 4]);
        if self.chance(20) {
            let names: Vec<_> = values.0.values().filter_map(|name| name.as_str().map(str::to_owned)).collect();
            field.put("default", self.one(&names));
        }
        field.put("values", values);
        self.values_on_some(field);
    }

    /// Lists the only device models that have a named value.
    pub fn values_on_some(&mut self, field: &mut Map) {
        let Some(values) = field.0.get_mut("values").and_then(Value::as_mapping_mut) else { return };
        for value in values.values_mut() {
            let mut known = Map::of([("name", value.clone())]);
            self.only_on_some(&mut known, 10);
            if known.has("models") {
                *value = known.into();
            }
        }
    }

    /// Names some of some raw values, one at least.
    fn values(&mut self, raw: &[u64]) -> Map {
        let raw: std::collections::BTreeSet<_> = self.some(raw).into_iter().collect();
        let signed: Vec<_> = raw.into_iter().map(i128::from).collect();
        self.names_of(&signed)
    }

    pub fn names_of(&mut self, raw: &[i128]) -> Map {
        let mut scope = Scope::default();
        Map::of(raw.iter().map(|raw| (self.number(*raw), self.names.name(&mut scope))).collect::<Vec<_>>())
    }

    fn status(&mut self, field: &mut Map, bits: u8) {
        let (mut status, mut scope) = (Map::default(), Scope::default());
        if self.chance(10) {
            return field.put("status", status);
        }
        let row = if bits > 4 && self.chance(35) { self.random.u8(2..bits) } else { 0 };
        if row > 0 {
            let mut known = self.status_bit(0);
            known.put("repeat", row.to_string());
            if self.random.bool() {
                known.put("first", self.one(&["0", "2"]));
            }
            status.put("row_of", known);
        }
        for bit in row..bits {
            if bit == 0 || (status.0.len() < 6 && self.chance(40)) {
                let (name, known) = (self.names.name(&mut scope), self.status_bit(bit));
                status.put(name, known);
            }
        }
        field.put("status", status);
    }

    fn status_bit(&mut self, bit: u8) -> Map {
        let mut known = Map::of([("bit", bit.to_string())]);
        if self.chance(40) {
            known.put("severity", self.one(&["state", "alarm", "fault"]));
        }
        self.only_on_some(&mut known, 10);
        for key in ["set_when", "clear_when", "effect", "led"] {
            if self.chance(15) {
                let text = self.text();
                known.put(key, text);
            }
        }
        self.remark(&mut known);
        known
    }

    /// Says what a text is that no place holds.
    fn long_text(&mut self, field: &mut Map) {
        field.put("as", self.one(&["text", "bytes"]));
        if field.text("as") == "text" && self.chance(30) {
            field.put("fill", self.one(&["0", "0x20", "255", "0x41"]));
        }
        self.only_on_some(field, 8);
        self.remark(field);
    }

    fn ascii(&mut self, field: &mut Map, count: u8) {
        if self.chance(30) {
            return field.put("as", "bytes");
        }
        field.put("as", "text");
        if self.chance(90) {
            field.put("fill", self.one(&["0", "0x20", "255", "0x41"]));
        }
        if self.chance(20) {
            field.put("default", if count > 1 { "A\"" } else { "\\\\" });
        }
    }

    /// Returns a packed value that fills `count` bytes.
    fn packed(&mut self, first: u8, count: u8, scope: &mut Scope) -> Map {
        let (mut parts, mut format) = (Map::default(), String::new());
        let mut next = first;
        while next < first + count {
            if !format.is_empty() || self.chance(20) {
                format += self.one(&["-", "/", " ", "\"", "\\", "V", ".", "``", "#"]);
            }
            let bytes = self.random.u8(1..=(first + count - next).min(2));
            let (place, name) = (self.bytes(next, bytes), self.names.plain(scope));
            let mut part = Map::of([("bytes", place)]);
            match self.random.u8(..6) {
                0 => self.packed_word(&mut part, &mut format, bytes, scope),
                1 | 2 => {
                    part.put("as", "text");
                    format.extend(["{", name.as_str(), "}"]);
                    self.remark(&mut part);
                }
                _ => self.packed_number(&mut part, &mut format, &name, 8 * bytes),
            }
            let part = self.with_types(part, &[], 0);
            parts.put(name, part);
            next += bytes;
        }
        let mut packed = Map::of([("format", format)]);
        packed.put("fields", parts);
        self.remark(&mut packed);
        packed
    }

    fn packed_word(&mut self, word: &mut Map, format: &mut String, bytes: u8, scope: &mut Scope) {
        let mut parts = Map::default();
        let split = self.random.u8(1..8 * bytes);
        for (low, bits) in [(split, 8 * bytes - split), (0, split)] {
            let name = self.names.plain(scope);
            let mut part = Map::of([("bits", bits_of(low, bits))]);
            if low == 0 {
                *format += self.one(&["-", "/", "x"]);
            }
            self.packed_number(&mut part, format, &name, bits);
            parts.put(name, part);
        }
        word.put("fields", parts);
        self.refer(word);
    }
}

/// Writes the place of some bits.
pub fn bits_of(low: u8, bits: u8) -> String {
    if bits == 1 { low.to_string() } else { format!("{}..{low}", low + bits - 1) }
}
