//! Messages that several frames carry: by a transport, or in parts.

use super::{Access, Role, Traffic};
use crate::random_specs::draft::Draft;
use crate::random_specs::fields::Length;
use crate::random_specs::identifier::Bus;
use crate::random_specs::names::Scope;
use crate::random_specs::yaml::{Map, list};

/// The name of a transport.
const TRANSPORT: &str = "zz_transport";

impl Draft {
    /// Adds the transport of the identifier, if there is one.
    pub(super) fn transport(&mut self, bus: &Bus, traffic: &mut Traffic) {
        let Some(mut transport) = bus.transport.clone() else { return };
        if let Some(priority) = bus.priority.as_ref().filter(|_| self.random.bool()) {
            let value = self.random.u8(..8);
            transport.put("send", Map::of([(priority.clone(), self.number(value))]));
        }
        self.remark(&mut transport);
        traffic.transports.put(TRANSPORT, transport);
    }

    /// Adds a message of up to seven bytes by ISO-TP to few specs. A constant gives each kind of frame a byte. Specs
    /// without it stay as they are, so the number that decides is drawn apart.
    pub fn by_isotp(&mut self, bus: &Bus, traffic: &mut Traffic) {
        if bus.transport.is_some() || bus.header_bytes > 0 || self.random.clone().u8(..100) >= 5 {
            return;
        }
        let is_fit = |known: &&Access| known.role == Role::Ordinary && !known.has_command;
        let Some(access) = traffic.accesses.iter().find(is_fit).cloned() else { return };
        let mut transport = Map::of([("kind", "isotp")]);
        if self.chance(70) {
            transport.put("fill", self.one(&["none", "0x00", "255"]));
        }
        self.remark(&mut transport);
        traffic.transports.put(TRANSPORT, transport);
        let (name, value) = self.command(bus, traffic);
        let mut message = Map::of([("match", Map::of([(name, value)]))]);
        message.put("access", list([access.name]));
        message.put("via", TRANSPORT);
        let (mut fields, mut scope) = (Map::default(), Scope::default());
        let (first, count) = (self.random.u8(1..3), self.random.u8(1..=5));
        let mut field = Map::of([("bytes", self.bytes(first, count))]);
        self.fill(&mut field, 8 * count);
        let names = [(); 2].map(|()| self.names.plain(&mut scope));
        let [kind, value] = names;
        let mut constant = Map::of([("bytes", "0")]);
        constant.put("const", self.one(&["0", "0x7F"]));
        fields.put(kind, constant);
        fields.put(value, field);
        message.put("fields", fields);
        self.add_message(traffic, message);
    }

    /// Adds what a message carries by the transport.
    pub(super) fn by_transport(&mut self, message: &mut Map) {
        let (fields, length) = self.long_fields();
        message.put("via", TRANSPORT);
        match length {
            Length::Fixed(lengths) if self.chance(40) => {
                message.put("length", list(lengths.map(|length| length.to_string())));
            }
            Length::Open(range) => message.put("length", range),
            Length::Fixed(_) | Length::Elements => {}
        }
        message.put("fields", fields);
    }

    /// Returns where each part has elements, and the array that they are of. Data begin with a byte of the frame.
    fn elements(&mut self, first: u8) -> (Map, Map) {
        let size = self.random.u8(1..=(8 - first) / 2);
        let count = self.random.u8(2..=(8 - first) / size);
        let last = first + size - 1;
        let bytes = if size == 1 { first.to_string() } else { format!("{first}..{last}") };
        let data = Map::of([("bytes", bytes), ("repeat", count.to_string())]);
        let (mut fields, mut scope) = (Map::default(), Scope::default());
        let mut array = self.element(0, size, &mut scope);
        let most = self.random.u8(count..=30);
        array.put("repeat", if self.random.bool() { format!("1..{most}") } else { most.to_string() });
        let name = self.names.plain(&mut scope);
        fields.put(name, array);
        (data, fields)
    }

    /// Adds what a message carries in several frames. Frames of what is reported may show elements.
    pub(super) fn in_parts(&mut self, bus: &Bus, traffic: &mut Traffic, message: &mut Map, is_reported: bool) {
        let (number, mut data) = (bus.header_bytes, bus.header_bytes + 1);
        let mut parts = Map::of([("number", Map::of([("bytes", number.to_string())]))]);
        if self.chance(30) {
            let bits = self.one(&["7..5", "3..0"]);
            parts.put("counter", Map::of([("bytes", data.to_string()), ("bits", bits.to_owned())]));
            data += 1;
        }
        if self.models.is_empty() || self.random.bool() {
            let first = self.random.u64(..3);
            parts.put("first", self.number(first));
        } else {
            let models = self.models.clone();
            let firsts = self.some(&models).into_iter().enumerate();
            parts.put("first", Map::of(firsts.map(|(index, model)| (model, index.to_string()))));
        }
        // Specs without elements stay as they are, so the number that decides is drawn apart.
        if is_reported && data <= 6 && self.random.clone().u8(..100) < 50 {
            let (data, fields) = self.elements(data);
            parts.put("data", data);
            message.put("parts", parts);
            message.put("fields", fields);
            return;
        }
        let last = self.random.u8(data..8);
        parts.put("data", if data == last { data.to_string() } else { format!("{data}..{last}") });
        let says_length = last >= data + 2 && self.chance(30);
        if says_length {
            let bytes = if self.random.bool() { [data, data + 1] } else { [data + 1, data] };
            parts.put("length", Map::of([("bytes", format!("{}..{}", bytes[0], bytes[1]))]));
        }
        let (fields, length) = self.long_fields();
        let ordinary = |access: &&Access| access.role == Role::Ordinary && !access.has_command;
        let access = traffic.accesses.iter().find(ordinary).cloned();
        let is_open = !says_length && !matches!(length, Length::Fixed(_));
        if let Some(access) = access.filter(|_| is_open && self.random.bool()) {
            let (name, value) = self.command(bus, traffic);
            let mut counting = Map::of([("match", Map::of([(name, value)]))]);
            counting.put("access", list([access.name]));
            counting.put("value", Map::of([("bytes", number.to_string())]));
            let name = self.add_message(traffic, counting);
            parts.put("count", format!("{name}.value"));
        }
        if !self.times.is_empty() && self.random.bool() {
            parts.put("silence", self.times[0].clone());
        }
        message.put("parts", parts);
        match length {
            Length::Open(range) => message.put("length", range),
            Length::Fixed(lengths) if says_length && self.chance(40) => {
                message.put("length", list(lengths.map(|length| length.to_string())));
            }
            Length::Fixed(_) | Length::Elements => {}
        }
        message.put("fields", fields);
    }
}
