//! The identifier, the header, and whom frames address.

use super::draft::Draft;
use super::fields::bits_of;
use super::names::Scope;
use super::yaml::{Map, list};

/// A field that tells frames apart, and how many bits it has.
#[derive(Clone)]
pub struct Chooser {
    pub name: String,
    pub bits: u8,
}

/// How frames are told apart, and who can be asked.
#[derive(Default)]
pub struct Bus {
    pub identifier: Map,
    pub header: Map,
    pub addressing: Map,
    /// The field of the identifier with a value for each message.
    pub command: Option<Chooser>,
    /// The field with a value for each access.
    pub function: Option<Chooser>,
    /// The field of the header with a value for each of some messages.
    pub register: Option<Chooser>,
    /// A field that replies can show by the type of a value.
    pub spare: Option<String>,
    /// A field that messages can send with a value of their own.
    pub priority: Option<String>,
    /// How a transport uses the identifier.
    pub transport: Option<Map>,
    /// Whether the identifier has an error code, and whether that says that a device starts.
    pub has_code: bool,
    pub has_starting: bool,
    /// Whether a field says that more frames of a set follow.
    pub continues: bool,
    /// Data bytes that the header takes.
    pub header_bytes: u8,
    pub modes: Vec<Mode>,
}

/// A mode, and who answers in it.
#[derive(Clone)]
pub struct Mode {
    pub name: String,
    pub is_asked: bool,
    pub answers: Vec<&'static str>,
    /// Whether replies show who sends them.
    pub shows_sender: bool,
}

/// What is needed while the identifier is filled from its most significant bit on.
struct Filling {
    identifier: Map,
    scope: Scope,
    next: u8,
}

impl Filling {
    fn place(&mut self, bits: u8) -> String {
        self.next -= bits;
        bits_of(self.next, bits)
    }

    fn add(&mut self, name: &str, mut field: Map, bits: u8) {
        let place = self.place(bits);
        field.put("bits", place);
        self.identifier.put(name, field);
    }
}

impl Draft {
    /// Chooses how frames are told apart.
    pub fn bus(&mut self) -> Bus {
        let (mut bus, extended) = (Bus::default(), self.chance(70));
        let mut filling =
            Filling { identifier: Map::default(), scope: Scope::default(), next: if extended { 29 } else { 11 } };
        if extended && self.random.bool() {
            self.by_addresses(&mut bus, &mut filling);
        } else {
            self.by_direction(&mut bus, &mut filling, extended);
        }
        if self.chance(60) {
            self.header(&mut bus, &mut filling.scope);
        }
        bus.identifier = filling.identifier;
        bus
    }

    fn field_name(&mut self, filling: &mut Filling) -> String {
        self.names.plain(&mut filling.scope)
    }

    /// Adds fields above the command, and the command in the bits that are left above `below`.
    fn above(&mut self, bus: &mut Bus, filling: &mut Filling, below: u8) {
        if filling.next - below >= 14 {
            self.fixed(filling);
            self.priority(bus, filling);
        }
        if filling.next - below >= 12 && self.random.bool() {
            let (name, field) = (self.field_name(filling), self.selector(3));
            filling.add(&name, field, 3);
            bus.function = Some(Chooser { name, bits: 3 });
        }
        if filling.next - below >= 8 && self.chance(40) {
            let (name, mut field) = (self.field_name(filling), Map::default());
            let value = self.random.u8(0..2);
            field.put("continues", value.to_string());
            if value == 0 || self.random.bool() {
                field.put("send", (1 - value).to_string());
            }
            let field = self.with_types(field, &["bits"], 0);
            filling.add(&name, field, 1);
            bus.continues = true;
        }
        if filling.next - below >= 9 && self.chance(30) {
            let (name, field) = (self.field_name(filling), self.selector(2));
            filling.add(&name, field, 2);
            bus.spare = Some(name);
        }
        let bits = filling.next - below;
        let (name, field) = (self.field_name(filling), self.selector(bits));
        filling.add(&name, field, bits);
        bus.command = Some(Chooser { name, bits });
    }

    /// Adds the fields above the addresses as a transport needs them. It returns the name of the page.
    fn of_transport(&mut self, bus: &mut Bus, filling: &mut Filling) -> String {
        self.priority(bus, filling);
        let page = self.field_name(filling);
        let mut field = self.selector(2);
        if self.random.bool() {
            field.put("const", "0");
        }
        filling.add(&page, field, 2);
        let (name, field) = (self.field_name(filling), self.selector(8));
        filling.add(&name, field, 8);
        bus.command = Some(Chooser { name, bits: 8 });
        page
    }

    /// Adds bits without a name, and a constant.
    fn fixed(&mut self, filling: &mut Filling) {
        for key in ["ones", "zeros"] {
            if self.chance(30) && filling.scope.take(key) {
                let place = filling.place(1);
                filling.identifier.put(key, place);
            }
        }
        if self.chance(30) {
            let (name, mut field) = (self.field_name(filling), self.selector(2));
            field.put("const", self.random.u8(..4).to_string());
            let field = self.with_types(field, &["bits"], 0);
            filling.add(&name, field, 2);
        }
    }

    fn priority(&mut self, bus: &mut Bus, filling: &mut Filling) {
        let (name, mut field) = (self.field_name(filling), self.selector(3));
        for key in ["send", "normal"] {
            if self.chance(35) {
                let value = self.random.u8(..8);
                let text = self.number(value);
                field.put(key, text);
                bus.has_code |= key == "normal";
                if key == "normal" && self.chance(40) {
                    field.put("starting", ((value + 1) % 8).to_string());
                    bus.has_starting = true;
                }
            }
        }
        let field = self.with_types(field, &["bits"], 0);
        filling.add(&name, field, 3);
        bus.priority = Some(name);
    }

    /// Returns what a field that tells frames apart can have beside its place.
    fn selector(&mut self, bits: u8) -> Map {
        let mut field = Map::default();
        if self.chance(30) {
            self.named_numbers(&mut field, bits);
        }
        self.remark(&mut field);
        field
    }

    fn named_numbers(&mut self, field: &mut Map, bits: u8) {
        let mut scope = Scope::default();
        let greatest = u64::MAX >> (64 - bits);
        let mut raw = self.some(&[0, 1, greatest]);
        raw.dedup();
        let names: Vec<_> = raw.into_iter().map(|raw| (raw.to_string(), self.names.name(&mut scope))).collect();
        field.put("values", Map::of(names));
    }

    /// Lets the controller's addresses show the direction.
    fn by_addresses(&mut self, bus: &mut Bus, filling: &mut Filling) {
        let page = if self.chance(30) { Some(self.of_transport(bus, filling)) } else { None };
        if page.is_none() {
            self.above(bus, filling, 16);
        }
        let (target, source) = (self.field_name(filling), self.field_name(filling));
        if let (Some(page), Some(command)) = (page, &bus.command) {
            let mut transport = Map::of([("kind", "j1939")]);
            transport.put("group", list([page, command.name.clone(), target.clone()]));
            transport.put("target", target.clone());
            transport.put("source", source.clone());
            bus.transport = Some(transport);
        }
        for name in [&target, &source] {
            let field = self.selector(8);
            filling.add(name, field, 8);
        }
        let controller = self.address(0xF0, 0xF8, true);
        let module = self.address(0, 0x3B, false);
        let pattern = |target_is: &str, source_is: &str| Map::of([(&target, target_is), (&source, source_is)]);
        self.mode(bus, "one", Some(pattern(&module, &controller)), &pattern(&controller, &module), true);
        if self.chance(40) {
            let group = self.address(0x80, 0x9E, false);
            self.mode(bus, "each", Some(pattern(&group, &controller)), &pattern(&controller, &module), true);
            if self.random.bool() {
                self.mode(bus, "coordinator", Some(pattern(&group, &controller)), &pattern(&controller, &group), true);
            }
        }
        if self.chance(40) {
            self.mode(bus, "each", Some(pattern("0x7F", &controller)), &pattern(&controller, &module), true);
        }
        if self.chance(40) {
            self.mode(bus, "one", None, &pattern("0xFF", &module), true);
        }
    }

    /// Lets one bit show the direction.
    fn by_direction(&mut self, bus: &mut Bus, filling: &mut Filling, extended: bool) {
        let (direction, field) = (self.field_name(filling), self.selector(1));
        filling.add(&direction, field, 1);
        self.above(bus, filling, 4);
        let node = self.field_name(filling);
        let field = self.selector(4);
        filling.add(&node, field, 4);
        let module = self.address(0, 9, false);
        let pattern = |bit: &str, node_is: &str| Map::of([(&direction, bit), (&node, node_is)]);
        self.mode(bus, "one", Some(pattern("1", &module)), &pattern("0", &module), true);
        if self.chance(40) {
            self.mode(bus, "each", Some(pattern("1", "0xF")), &pattern("0", &module), true);
        }
        if self.chance(30) && extended {
            self.mode(bus, "coordinator", Some(pattern("1", "0xE")), &pattern("0", "0xE"), false);
        }
        if self.chance(40) {
            // A report can look like a request. Then only its command tells the two apart.
            let bit = self.one(&["0", "0", "1"]);
            self.mode(bus, "one", None, &pattern(bit, &module), true);
        }
    }

    /// Adds a type of addresses whose raw values these are.
    fn address(&mut self, first: i64, last: i64, is_sender: bool) -> String {
        let mut keys = Map::default();
        let (sign, offset) = self.one(&[(1, 0), (1, 0), (1, 1000), (1, -20), (-1, 0xFF), (-1, 70_000)]);
        let number = |raw: i64| raw * sign + offset;
        let (first, last) = (number(first).min(number(last)), number(first).max(number(last)));
        if self.chance(20) {
            let mut numbers = vec![first, i64::midpoint(first, last), last];
            numbers.dedup();
            let mut scope = Scope::default();
            let names = numbers.into_iter().map(|number| (number.to_string(), self.names.name(&mut scope)));
            let names: Vec<_> = names.collect();
            keys.put("values", Map::of(names));
        } else {
            keys.put("range", format!("{first}..{last}"));
        }
        if sign < 0 || self.chance(10) {
            keys.put("scale", sign.to_string());
        }
        if offset != 0 {
            keys.put("offset", offset.to_string());
        }
        if is_sender {
            keys.put("send", last.to_string());
            keys.put("outside", "refused");
        }
        if self.chance(40) && offset == 0 && sign == 1 {
            let mut example = Map::of([("bytes", format!("{first:02X}")), ("means", first.to_string())]);
            self.refer(&mut example);
            keys.put("examples", list([example]));
        }
        self.remark(&mut keys);
        let name = self.type_name(false);
        self.types.put(name.clone(), keys);
        name
    }

    fn mode(&mut self, bus: &mut Bus, who: &'static str, request: Option<Map>, reply: &Map, shows_sender: bool) {
        let mut scope = Scope::default();
        bus.modes.iter().for_each(|mode| _ = scope.take(&mode.name));
        let (name, mut mode, mut answers) = (self.names.name(&mut scope), Map::default(), vec![who]);
        let is_asked = request.is_some();
        if let Some(request) = request {
            mode.put("request", request);
        }
        for other in ["one", "each", "coordinator"] {
            if other == who || self.chance(15) {
                mode.put(other, reply.clone());
                answers.extend((other != who).then_some(other));
            }
        }
        self.remark(&mut mode);
        bus.addressing.put(name.clone(), mode);
        bus.modes.push(Mode { name, is_asked, answers, shows_sender });
    }

    /// Adds data bytes that choose messages.
    fn header(&mut self, bus: &mut Bus, scope: &mut Scope) {
        // A transport announces nothing that the data choose.
        if bus.function.is_none() && bus.transport.is_none() && self.chance(60) {
            let name = self.header_field(bus, scope, 1, |draft, field| {
                if draft.chance(30) {
                    draft.named_numbers(field, 8);
                }
            });
            bus.function = Some(Chooser { name, bits: 8 });
        }
        if !bus.has_starting && self.chance(30) {
            let value = self.random.u8(..3);
            let is_only = !bus.has_code;
            self.header_field(bus, scope, 1, |draft, field| {
                field.put("normal", value.to_string());
                if is_only && draft.chance(50) {
                    field.put("starting", draft.random.u8(3..).to_string());
                }
                if draft.chance(50) {
                    draft.named_numbers(field, 8);
                }
            });
        }
        if self.chance(40) {
            self.header_word(bus, scope);
        }
        let name = self.header_field(bus, scope, 1, |draft, field| {
            if draft.chance(30) {
                draft.named_numbers(field, 8);
            }
        });
        bus.register = Some(Chooser { name, bits: 8 });
    }

    fn header_field(
        &mut self,
        bus: &mut Bus,
        scope: &mut Scope,
        count: u8,
        fill: impl FnOnce(&mut Self, &mut Map),
    ) -> String {
        let name = self.names.plain(scope);
        let mut field = Map::of([("bytes", bus.header_bytes.to_string())]);
        fill(self, &mut field);
        self.remark(&mut field);
        let field = self.with_types(field, &[], 0);
        bus.header.put(name.clone(), field);
        bus.header_bytes += count;
        name
    }

    fn header_word(&mut self, bus: &mut Bus, scope: &mut Scope) {
        let (more, page) = (self.names.plain(scope), self.names.plain(scope));
        let (mut high, mut low) = (Map::of([("bits", "7..4")]), Map::of([("bits", "3..0")]));
        if !bus.continues && self.chance(70) {
            high.put("continues", "2");
            bus.continues = true;
        }
        self.remark(&mut low);
        let low = self.with_types(low, &[], 0);
        if bus.spare.is_none() && self.random.bool() {
            bus.spare = Some(page.clone());
        }
        let mut word = Map::of([("bytes", bus.header_bytes.to_string())]);
        word.put("fields", Map::of([(more, high), (page, low)]));
        self.refer(&mut word);
        let (name, word) = (self.names.plain(scope), self.with_types(word, &[], 0));
        bus.header.put(name, word);
        bus.header_bytes += 1;
    }
}
