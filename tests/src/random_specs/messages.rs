//! Accesses, messages, sets of frames, and identifiers of others.

mod long;

use serde_yaml::{Mapping, Value};

use super::draft::Draft;
use super::fields::Site;
use super::identifier::{Bus, Chooser, Mode};
use super::names::Scope;
use super::yaml::{Map, list};

/// How messages travel.
#[derive(Clone)]
struct Access {
    name: String,
    kinds: Vec<&'static str>,
    /// Whether the access has constants of its own, so that a message can have it beside others.
    is_apart: bool,
    /// Whether it says the command too, so that its messages have a register alone.
    has_command: bool,
    role: Role,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    Ordinary,
    Report,
    /// A report of the controller.
    Call,
    /// Asks for a set.
    Scan,
    /// Can be refused.
    Refused,
    /// Refuses.
    Refusing,
}

/// The accesses and messages of a spec.
#[derive(Default)]
pub struct Traffic {
    pub access: Map,
    pub messages: Map,
    pub foreign: Map,
    pub transports: Map,
    accesses: Vec<Access>,
    names: Scope,
    access_names: Scope,
    /// How many values of each chooser are given away.
    commands: u64,
    registers: u64,
    functions: u64,
}

impl Traffic {
    /// Returns the names of messages that are asked and answered.
    pub fn asked(&self) -> Vec<String> {
        let is_asked = |access: &Value| {
            let access = self.access.0.get(access).and_then(Value::as_mapping);
            access.is_some_and(|access| access.contains_key("request") && access.contains_key("reply"))
        };
        let accesses =
            |message: &Value| message["access"].as_sequence().is_some_and(|names| names.iter().any(is_asked));
        let asked = self.messages.0.iter().filter(|(_, message)| accesses(message));
        asked.filter_map(|(name, _)| name.as_str()).map(str::to_owned).collect()
    }
}

impl Draft {
    /// Chooses what travels, and how.
    pub fn traffic(&mut self, bus: &Bus) -> Traffic {
        let mut traffic = Traffic::default();
        self.transport(bus, &mut traffic);
        self.accesses(bus, &mut traffic);
        for _ in 0..self.random.u8(1..=3) {
            self.message(bus, &mut traffic);
        }
        if bus.continues && bus.register.is_some() {
            self.set(bus, &mut traffic);
        }
        self.refusal(bus, &mut traffic);
        if self.chance(30) {
            self.alike(bus, &mut traffic);
        }
        if self.chance(40) {
            self.foreign(bus, &mut traffic);
        }
        traffic
    }

    fn accesses(&mut self, bus: &Bus, traffic: &mut Traffic) {
        self.access(bus, traffic, &["request", "reply"], Role::Ordinary);
        for _ in 0..self.random.u8(..3) {
            let kinds: &[_] = if self.chance(80) { &["request", "reply"] } else { &["request"] };
            self.access(bus, traffic, kinds, Role::Ordinary);
        }
        if bus.modes.iter().any(|mode| !mode.is_asked) && self.chance(70) {
            self.access(bus, traffic, &["report"], Role::Report);
        }
        if bus.modes.iter().any(|mode| mode.is_asked) && self.chance(30) {
            self.access(bus, traffic, &["report"], Role::Call);
        }
        if bus.continues && bus.register.is_some() {
            self.access(bus, traffic, &["request", "reply"], Role::Scan);
        }
    }

    fn access(&mut self, bus: &Bus, traffic: &mut Traffic, kinds: &[&'static str], role: Role) {
        let mut access = Map::default();
        let mut constants = Map::default();
        let is_apart = bus.function.is_some();
        if let Some(function) = &bus.function {
            traffic.functions += 1;
            let value = self.number(traffic.functions % (1 << function.bits));
            constants.put(function.name.clone(), value);
        }
        let has_command = role == Role::Ordinary && bus.register.is_some() && self.chance(30);
        if has_command {
            let (name, value) = self.command(bus, traffic);
            constants.put(name, value);
        }
        for kind in kinds {
            let mut constants = constants.clone();
            if let Some((name, values)) = self.several(bus, traffic).filter(|_| *kind == "reply") {
                constants.put(name, values);
            }
            access.put(*kind, constants);
        }
        let carrying = self.carrying(kinds, role);
        if carrying.len() < kinds.len() || self.chance(20) {
            access.put("in", list(carrying));
        }
        if role == Role::Call {
            access.put("from", "controller");
        } else if role == Role::Report && self.chance(20) {
            access.put("from", "module");
        }
        let answers = self.answers(bus, kinds, role);
        access.put("answers", answers);
        if kinds.contains(&"report") && !self.times.is_empty() && self.random.bool() {
            access.put("every", self.times[0].clone());
        }
        self.remark(&mut access);
        let name = self.names.plain(&mut traffic.access_names);
        traffic.access.put(name.clone(), access);
        traffic.accesses.push(Access { name, kinds: kinds.to_vec(), is_apart, has_command, role });
    }

    /// Returns two values of the field of the latest access, in few specs whose field stands in the header. The greatest
    /// bit of the field is in no other value. Specs without it stay as they are, so the number that decides is drawn apart.
    fn several(&mut self, bus: &Bus, traffic: &Traffic) -> Option<(String, Value)> {
        let function = bus.function.as_ref().filter(|function| function.bits >= 5)?;
        let is_open = bus.header.0.contains_key(&function.name) && self.random.clone().u8(..100) < 30;
        let value = traffic.functions;
        let other = value | 1 << (function.bits - 1);
        is_open.then(|| (function.name.clone(), list([value.to_string(), other.to_string()])))
    }

    fn carrying(&mut self, kinds: &[&'static str], role: Role) -> Vec<&'static str> {
        if role == Role::Scan {
            return vec!["reply"];
        }
        self.some(kinds)
    }

    /// Returns the modes of an access, and who answers in each.
    fn answers(&mut self, bus: &Bus, kinds: &[&str], role: Role) -> Map {
        let is_report = kinds == ["report"];
        let fits = |mode: &&Mode| {
            (role == Role::Report || mode.is_asked)
                && (role != Role::Scan || mode.shows_sender && mode.answers[0] == "one")
        };
        let modes: Vec<_> = bus.modes.iter().filter(fits).cloned().collect();
        let mut answers = Map::default();
        for (index, mode) in self.some(&modes).into_iter().enumerate() {
            let sure = index == 0 || is_report || role == Role::Scan;
            let who = match (kinds == ["request"], sure) {
                (true, _) => "nobody",
                (false, false) if self.chance(30) => "nobody",
                _ if role == Role::Scan => "one",
                _ => self.one(&mode.answers),
            };
            answers.put(mode.name, who);
        }
        answers
    }

    /// Gives away a value of the command.
    fn command(&mut self, bus: &Bus, traffic: &mut Traffic) -> (String, String) {
        let Some(Chooser { name, bits }) = &bus.command else { unreachable!("every identifier has a command") };
        traffic.commands += 1;
        assert!(traffic.commands < 1 << bits, "the command is wide enough");
        (name.clone(), self.number(traffic.commands))
    }

    fn register(&mut self, bus: &Bus, traffic: &mut Traffic) -> Option<(String, String)> {
        let Chooser { name, .. } = bus.register.as_ref()?;
        traffic.registers += 1;
        Some((name.clone(), self.number(traffic.registers)))
    }

    /// Adds a message by some accesses, with constants that no other has.
    fn message(&mut self, bus: &Bus, traffic: &mut Traffic) {
        let known: Vec<_> = traffic.accesses.iter().filter(|known| known.role != Role::Scan).cloned().collect();
        let first = self.one(&known);
        let mut accesses = vec![first.clone()];
        if first.is_apart && self.random.bool() {
            let fits = |other: &&Access| other.name != first.name && other.has_command == first.has_command;
            accesses.extend(known.iter().filter(fits).take(2).cloned());
        }
        let mut pattern = Map::default();
        if !first.has_command {
            let (name, value) = self.command(bus, traffic);
            pattern.put(name, value);
        }
        if first.has_command || self.chance(40) {
            let register = self.register(bus, traffic);
            if let Some((name, value)) = register {
                pattern.put(name, value);
            }
        }
        let has_register = pattern.0.len() > 1;
        let mut message = Map::of([("match", pattern)]);
        message.put("access", list(accesses.iter().map(|access| access.name.clone())));
        let kinds: std::collections::BTreeSet<_> = accesses.iter().flat_map(|access| &access.kinds).copied().collect();
        let kinds: Vec<_> = kinds.into_iter().collect();
        if accesses.len() == 1 && self.chance(15) {
            let answers = self.answers(bus, &first.kinds, first.role);
            message.put("answers", answers);
        }
        if kinds.contains(&"report") && !self.times.is_empty() && self.chance(40) {
            message.put("every", self.times[0].clone());
        }
        let models = self.models.clone();
        if !models.is_empty() && self.chance(15) {
            // What is in the message is on some of its models.
            self.models = self.some(&models);
            message.put("models", list(self.models.clone()));
        }
        if let Some(priority) = bus.priority.as_ref().filter(|_| self.random.u8(..100) < 20) {
            let value = self.random.u8(..8);
            message.put("send", Map::of([(priority.clone(), self.number(value))]));
        }
        if self.chance(10) {
            let reserved = self.reserved();
            message.put("reserved", reserved);
        }
        let is_by_command = !first.has_command && !has_register;
        if bus.transport.is_some() && is_by_command && self.chance(50) {
            self.by_transport(&mut message);
        } else if bus.header_bytes < 5 && self.chance(25) {
            let is_reported = accesses.iter().all(|access| access.role == Role::Report && access.kinds == ["report"]);
            self.in_parts(bus, traffic, &mut message, is_reported);
        } else {
            self.content(bus, &mut message, &kinds, false);
        }
        self.models = models;
        self.remark(&mut message);
        self.add_message(traffic, message);
    }

    /// Says what the bits are that nothing names.
    pub fn reserved(&mut self) -> Map {
        let (send, expect) = (self.one(&["0", "1"]), self.one(&["sent", "any"]));
        let (send, expect) = (Map::of([("send", send)]), Map::of([("expect", expect)]));
        let both = Map(send.0.iter().chain(expect.0.iter()).map(|(key, value)| (key.clone(), value.clone())).collect());
        self.one(&[send, expect, both])
    }

    fn add_message(&mut self, traffic: &mut Traffic, message: Map) -> String {
        let name = self.names.apart(&mut traffic.names, &mut self.letters);
        traffic.messages.put(name.clone(), message);
        name
    }

    /// Adds what a message carries.
    fn content(&mut self, bus: &Bus, message: &mut Map, kinds: &[&'static str], is_member: bool) {
        let first = bus.header_bytes;
        let shorter = !is_member && self.chance(10);
        let length = if shorter { self.random.u8(first..=8) } else { 8 };
        if shorter {
            message.put("length", length.to_string());
        }
        let spare = bus.spare.as_deref().filter(|_| !is_member && kinds.contains(&"reply"));
        let site = Site { first, length, kinds, spare, is_member };
        if !is_member && self.chance(5) || first == length {
            return;
        }
        if self.chance(40) {
            let count = self.random.u8(1..=length - first);
            let field = self.field(first, count, &mut Scope::default(), &site, &mut false);
            message.put("value", field);
        } else {
            let fields = self.fields(&site);
            if !is_member && self.chance(25) {
                lengths(message, &fields, length);
            }
            if !fields.is_empty() {
                message.put("fields", fields);
            }
        }
    }

    /// Adds a set and its members.
    fn set(&mut self, bus: &Bus, traffic: &mut Traffic) {
        let Some(scan) = traffic.accesses.iter().find(|access| access.role == Role::Scan).cloned() else { return };
        let mut members = Vec::new();
        for _ in 0..self.random.u8(1..=4) {
            let Some((name, value)) = self.register(bus, traffic) else { return };
            let mut member = Map::of([("match", Map::of([(name, value)]))]);
            let own: Vec<_> = traffic.accesses.iter().filter(|access| access.has_command).cloned().collect();
            if !own.is_empty() && self.random.bool() {
                member.put("access", list([self.one(&own).name]));
            }
            self.content(bus, &mut member, &["request", "reply"], true);
            self.remark(&mut member);
            members.push(self.add_message(traffic, member));
        }
        let (name, value) = self.command(bus, traffic);
        let mut set = Map::of([("match", Map::of([(name, value)]))]);
        set.put("access", list([scan.name]));
        set.put("members", list(members));
        if self.chance(60) {
            set.put("in", if self.random.bool() { list(["reply"]) } else { list(["request", "reply"]) });
        }
        self.remark(&mut set);
        self.add_message(traffic, set);
    }

    /// Adds a message whose request is refused by another one.
    fn refusal(&mut self, bus: &Bus, traffic: &mut Traffic) {
        let (Some(function), Some(_)) = (&bus.function, &bus.register) else { return };
        if traffic.functions + 3 >= 1 << function.bits || !self.chance(40) {
            return;
        }
        let constant = |value: u64| Map::of([(function.name.clone(), value.to_string())]);
        self.access(bus, traffic, &["request", "reply"], Role::Refused);
        traffic.functions += 1;
        let refusing = constant(traffic.functions);
        let Some(Access { name: refused, .. }) = traffic.accesses.pop() else { return };
        if let Some(access) = traffic.access.0.get_mut(&refused).and_then(serde_yaml::Value::as_mapping_mut) {
            access.insert("refusal".into(), refusing.clone().into());
        }
        let mut access = Map::of([("reply", refusing)]);
        let answers = self.answers(bus, &["request", "reply"], Role::Refusing);
        access.put("answers", answers);
        let refuse = self.names.plain(&mut traffic.access_names);
        traffic.access.put(refuse.clone(), access);
        let (name, value) = self.command(bus, traffic);
        let mut pattern = Map::of([(name, value)]);
        self.add_refusing(bus, traffic, &refuse, pattern.clone());
        let register = self.register(bus, traffic);
        if let Some((name, value)) = register {
            pattern.put(name, value);
        }
        let mut message = Map::of([("match", pattern)]);
        message.put("access", list([refused]));
        self.content(bus, &mut message, &["request", "reply"], false);
        self.add_message(traffic, message);
    }

    fn add_refusing(&mut self, bus: &Bus, traffic: &mut Traffic, access: &str, pattern: Map) {
        let mut message = Map::of([("match", pattern)]);
        message.put("access", list([access]));
        self.content(bus, &mut message, &["reply"], true);
        self.add_message(traffic, message);
    }

    /// Adds two messages that look the same, of different device models.
    fn alike(&mut self, bus: &Bus, traffic: &mut Traffic) {
        let models = self.models.clone();
        let (Some(access), [first, others @ ..]) = (traffic.accesses.first().cloned(), models.as_slice()) else {
            return;
        };
        if others.is_empty() || access.has_command {
            return;
        }
        let (name, value) = self.command(bus, traffic);
        for some in [vec![first.clone()], others.to_vec()] {
            let mut message = Map::of([("match", Map::of([(name.clone(), value.clone())]))]);
            message.put("access", list([access.name.clone()]));
            message.put("models", list(some.clone()));
            self.models = some;
            let fields = self.fields(&Site {
                first: bus.header_bytes,
                length: 8,
                kinds: &access.kinds,
                spare: None,
                is_member: true,
            });
            self.models.clone_from(&models);
            if !fields.is_empty() {
                message.put("fields", fields);
            }
            self.remark(&mut message);
            self.add_message(traffic, message);
        }
    }

    /// Adds foreign identifiers, which no message has.
    fn foreign(&mut self, bus: &Bus, traffic: &mut Traffic) {
        let (name, value) = self.command(bus, traffic);
        let pattern = match self.random.u8(..3) {
            0 => Map::of([("identifier", "0x7FF..0x7FF".to_owned())]),
            1 => Map::of([(name, format!("{value}..{value}"))]),
            _ => Map::of([(name, value)]),
        };
        let mut foreign = Map::of([("match", pattern)]);
        self.remark(&mut foreign);
        let name = self.names.name(&mut Scope::default());
        traffic.foreign.put(name, foreign);
    }
}

/// Lets frames end before the last field, if that field does not choose the message.
fn lengths(message: &mut Map, fields: &Map, length: u8) {
    let place = |field: &Mapping| -> Vec<u8> {
        let bytes = field.get("bytes").and_then(Value::as_str).unwrap_or_default();
        bytes.split("..").filter_map(|end| end.parse().ok()).collect()
    };
    let written: Vec<_> = fields.0.values().filter_map(Value::as_mapping).collect();
    let may_choose = written.last().is_none_or(|field| field.contains_key("const") || field.contains_key("type"));
    let starts = written.iter().map(|field| place(field).into_iter().min());
    let Some(start) = starts.collect::<Option<Vec<_>>>().and_then(|starts| starts.into_iter().max()) else {
        return;
    };
    if !may_choose && start > 0 && start < length {
        message.put("length", list([start.to_string(), length.to_string()]));
    }
}
