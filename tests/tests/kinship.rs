//! Two vendors' documents describe protocols of one family. Their specs say the same where the documents do.

use std::collections::{BTreeMap, BTreeSet};

use canspec_codegen::model::{
    AddressPattern, AddressType, Answers, Encoding, Foreign, Id, IdentifierField, Message, Mode, NamedValue, Protocol,
    Signal, SignalId, StatusBit, Who,
};
use canspec_tests::protocol;

/// Where the two differ, what INFY has there, what GCP has there, and why.
const DIFFERENCES: [[&str; 4]; 9] = [
    [
        "command 0x04 module_status.status_0 bit 3",
        "input_or_bus_abnormal, fault",
        "pfc_abnormal, alarm",
        "GCP 3.4 names the PFC circuit and prints a yellow LED",
    ],
    ["command 0x04 module_status.status_0 bit 4", "sleeping, state", "-", "GCP has no sleep, and leaves the row empty"],
    [
        "command 0x04 module_status.status_0 bit 5",
        "discharge_abnormal, fault",
        "discharge_abnormal, alarm",
        "GCP 3.4 prints a yellow LED; S34 and S21 say how severities are found",
    ],
    [
        "command 0x04 module_status.status_1 bit 5",
        "output_overvoltage, alarm",
        "output_overvoltage, fault",
        "GCP 3.4 prints a red LED beside the output; S34 and S21 say how severities are found",
    ],
    [
        "command 0x06",
        "input_voltage",
        "input_voltage, input_voltage_dc",
        "GCP 3.3 has a second layout for DC/DC modules",
    ],
    [
        "command 0x13 set_walk_in.interval",
        "-",
        "request: big endian 16 bits from 0 up, Unsigned, scale 0.01, offset 0, special 0=unspecified, s",
        "GCP 3.3 has the time in bytes 6 and 7, which INFY 2.4 prints as 0",
    ],
    [
        "identifier error",
        "3 bits from 26 up, normal 0: 0=normal 2=command_invalid 3=data_invalid 4=address_invalid 7=starting_up",
        "3 bits from 26 up, normal 0: 0=normal 2=command_invalid 3=data_invalid 7=starting_up",
        "GCP 3.2.1 has nothing between 0x03 and 0x07",
    ],
    ["mode all_groups", "exists", "-", "only INFY 2.4 asks all groups at once"],
    ["mode mppt", "-", "exists", "only GCP has modules with such a mode"],
];

/// Stands for what a protocol does not have.
const NOTHING: &str = "-";

/// One thing that a spec says.
struct Fact {
    /// What both protocols must have, or the fact is not compared.
    about: Vec<String>,
    place: String,
    says: String,
}

impl Fact {
    fn new<const N: usize>(about: [&str; N], place: impl Into<String>, says: impl Into<String>) -> Self {
        Self { about: about.map(str::to_owned).to_vec(), place: place.into(), says: says.into() }
    }
}

/// Puts into words what is compared.
struct Words<'a>(&'a Protocol);

impl Words<'_> {
    fn facts(&self) -> Vec<Fact> {
        let fields = self.0.identifier.fields.iter().map(|field| self.field(field));
        let addresses = self.0.address_types.iter().map(address);
        let modes = self.0.modes.iter().flat_map(|mode| self.mode(mode));
        let foreign = self.0.foreign.iter().map(foreign);
        let commands = self.commands().into_iter().map(|(command, names)| Fact::new([&command], &command, names));
        let messages = self.0.messages.iter().flat_map(|message| self.message(message));
        fields.chain(addresses).chain(modes).chain(foreign).chain(commands).chain(messages).collect()
    }

    fn field(&self, field: &IdentifierField) -> Fact {
        let values = field.enumeration.map(|known| values(&self.0.enumerations[known].values)).unwrap_or_default();
        let says = format!("{} bits from {} up, normal {}: {values}", field.width, field.shift, optional(field.normal));
        Fact::new([], format!("identifier {}", field.name), says)
    }

    /// Returns that the mode exists, and its patterns.
    fn mode(&self, mode: &Mode) -> [Fact; 2] {
        let name = format!("mode {}", mode.name);
        let patterns = [&mode.request, &mode.one, &mode.each, &mode.coordinator];
        let says = patterns.map(|pattern| pattern.as_ref().map_or(NOTHING.to_owned(), |pattern| self.pattern(pattern)));
        [Fact::new([], &name, "exists"), Fact::new([&name], format!("{name}, patterns"), says.join("; "))]
    }

    fn pattern(&self, pattern: &AddressPattern) -> String {
        let constants = self.0.identifier.fields.iter().filter(|field| field.mask() & pattern.mask == field.mask());
        let constants = constants.map(|field| format!("{}={:#X}", field.name, field.get(pattern.value)));
        let addresses = pattern.addresses.iter().map(|address| {
            let field = &self.0.identifier.fields[address.field].name;
            format!("{field}={}", self.0.address_types[address.address_type].name)
        });
        constants.chain(addresses).collect::<Vec<_>>().join(" ")
    }

    /// Returns the names of the messages that have the same constants.
    fn commands(&self) -> BTreeMap<String, String> {
        let mut commands = BTreeMap::<_, Vec<_>>::new();
        for message in &self.0.messages {
            commands.entry(self.constants(message)).or_default().push(message.name.as_str());
        }
        commands.into_iter().map(|(command, names)| (command, names.join(", "))).collect()
    }

    fn constants(&self, message: &Message) -> String {
        let constants = self.0.frames_of(message).flat_map(|frame| &frame.constants);
        let constants = constants.map(|known| (known.selector, known.value)).collect::<BTreeSet<_>>();
        let named = constants.iter().map(|(selector, value)| format!("{} {value:#04X}", self.0[*selector].name));
        named.collect::<Vec<_>>().join(" ")
    }

    fn message(&self, message: &Message) -> Vec<Fact> {
        let name = format!("{} {}", self.constants(message), message.name);
        let answers = message.exchanges.iter().flat_map(|exchange| self.answers(&name, &exchange.answers));
        let signals = message.signals.entries();
        let signals = signals.flat_map(|(id, signal)| self.signal(&name, message, id, signal));
        let length = Fact::new([&name], format!("{name}, length"), format!("{:?}", message.lengths));
        std::iter::once(length).chain(answers).chain(signals).collect()
    }

    fn answers(&self, message: &str, answers: &Answers) -> Vec<Fact> {
        let modes = self.0.modes.iter().zip(answers);
        let fact = |(mode, who): (&Mode, &Option<Who>)| {
            let mode = format!("mode {}", mode.name);
            Fact::new([message, &mode], format!("{message}, {mode}"), format!("{who:?}"))
        };
        modes.map(fact).collect()
    }

    fn signal(&self, message: &str, owner: &Message, id: SignalId, signal: &Signal) -> Vec<Fact> {
        let bits = signal.place.bits_of_payload();
        let kinds = self.0.frames_of(owner).filter(|frame| frame.signals.contains(&id)).map(|frame| frame.kind.name());
        let kinds = kinds.collect::<Vec<_>>().join(" and ");
        let order = format!("{:?}", signal.place.order()).to_lowercase();
        let place = format!("{order} endian {} bits from {} up", bits.width(), bits.shift());
        let unit = signal.unit.as_ref().map_or(NOTHING, |unit| &*unit.symbol);
        let says = format!("{kinds}: {place}, {}, {unit}", self.encoding(signal));
        let name = format!("{message}.{}", signal.name);
        let bits = self.bits(signal).iter().map(|bit| status_bit(message, &name, bit));
        std::iter::once(Fact::new([message], &name, says)).chain(bits).collect()
    }

    fn encoding(&self, signal: &Signal) -> String {
        match &signal.encoding {
            Encoding::Number { numeral, scale, offset } => {
                format!("{numeral:?}, scale {scale}, offset {offset}, special {}", values(&signal.specials))
            }
            Encoding::Named(known) => values(&self.0.enumerations[*known].values),
            Encoding::Status(_) => "status".to_owned(),
            other => format!("{other:?}"),
        }
    }

    fn bits(&self, signal: &Signal) -> &[StatusBit] {
        match signal.encoding {
            Encoding::Status(word) => &self.0.status_words[word].bits,
            _ => &[],
        }
    }
}

fn optional(number: Option<impl ToString>) -> String {
    number.map_or(NOTHING.to_owned(), |number| number.to_string())
}

fn values(values: &[NamedValue]) -> String {
    values.iter().map(|value| format!("{}={}", value.raw, value.name)).collect::<Vec<_>>().join(" ")
}

fn address(known: &AddressType) -> Fact {
    let name = format!("address {}", known.name);
    let AddressType { first, last, offset, sign, strict, send, .. } = known;
    let says = format!("{first}..{last}, step {sign} from {offset}, strict {strict}, send {}", optional(*send));
    Fact::new([&name], &name, says)
}

fn foreign(foreign: &Foreign) -> Fact {
    Fact::new([], format!("foreign {}", foreign.name), format!("{:X?}", foreign.ranges))
}

fn status_bit(message: &str, word: &str, bit: &StatusBit) -> Fact {
    let severity = bit.severity.map_or(NOTHING.to_owned(), |severity| format!("{severity:?}").to_lowercase());
    Fact::new([message], format!("{word} bit {}", bit.bit), format!("{}, {severity}", bit.name))
}

/// Returns the places where two protocols differ, with what each says, as far as both have what the place is about.
fn differences(one: &Protocol, other: &Protocol) -> Vec<[String; 3]> {
    let [one, other] = [one, other].map(|protocol| Words(protocol).facts());
    let [known, shared] =
        [&one, &other].map(|facts| facts.iter().flat_map(|fact| &fact.about).collect::<BTreeSet<_>>());
    let shared: BTreeSet<_> = known.intersection(&shared).collect();
    let compared = |facts: &[Fact]| -> BTreeMap<_, _> {
        let compared = facts.iter().filter(|fact| fact.about.iter().all(|about| shared.contains(&about)));
        compared.map(|fact| (fact.place.clone(), fact.says.clone())).collect()
    };
    let [one, other] = [compared(&one), compared(&other)];
    let places = one.keys().chain(other.keys()).collect::<BTreeSet<_>>();
    let said =
        |facts: &BTreeMap<String, String>, place: &str| facts.get(place).map_or(NOTHING.to_owned(), Clone::clone);
    let rows = places.into_iter().map(|place| [place.clone(), said(&one, place), said(&other, place)]);
    rows.filter(|[_, one, other]| one != other).collect()
}

fn specs() -> [Protocol; 2] {
    ["../specs/infy.yaml", "../specs/gcp.yaml"].map(protocol)
}

#[test]
fn shared_messages_and_modes_differ_only_where_the_documents_do() {
    let [infy, gcp] = specs();
    let accepted = DIFFERENCES.map(|[place, infy, gcp, _]| [place, infy, gcp].map(str::to_owned));
    assert_eq!(differences(&infy, &gcp), accepted);
}

#[test]
fn what_is_compared_is_all_that_they_share() {
    let [infy, gcp] = specs();
    let [infy, gcp] = [&infy, &gcp].map(|protocol| Words(protocol).commands().into_keys().collect::<BTreeSet<_>>());
    let shared = infy.intersection(&gcp).map(String::as_str).collect::<Vec<_>>();
    let printed = [0x01, 0x02, 0x03, 0x04, 0x06, 0x0C, 0x13, 0x14, 0x1A, 0x1B, 0x1C];
    assert_eq!(shared, printed.map(|command| format!("command {command:#04X}")));
}

#[test]
fn a_shared_status_bit_that_moves_is_seen() {
    let [infy, mut gcp] = specs();
    let before = differences(&infy, &gcp).len();
    let word = gcp.status_words.iter_mut().find(|word| word.name == "status_1").expect("the word");
    word.bits.iter_mut().find(|bit| bit.name == "walk_in_enabled").expect("the bit").bit = 8;
    assert_eq!(differences(&infy, &gcp).len(), before + 2);
}

#[test]
fn a_shared_signal_that_is_scaled_otherwise_is_seen() {
    let [mut infy, gcp] = specs();
    let before = differences(&infy, &gcp).len();
    let message = infy.messages.iter_mut().find(|message| message.name == "external_voltage").expect("the message");
    message.signals[SignalId::new(0)].encoding = Encoding::Float;
    assert_eq!(differences(&infy, &gcp).len(), before + 1);
}
