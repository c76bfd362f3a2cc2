//! Resolves the document's frames and what they mean.

use canspec_runtime::Place;
use indexmap::IndexSet;

use super::Resolver;
use super::printed::Printed;
use super::texts::{remarks, suggestion};
use super::window::MOST_BYTES;
use crate::encoding::said;
use crate::model::keywords::ORIGINS;
use crate::model::{
    Array, Doc, Example, Failure, Id, Identifier, Kind, LongExample, Meaning, Message, MessageId, Misfit, NoteRule,
    Origin, Said, Signal, SignalId, StatusBit, Table, ValueExample,
};
use crate::read::syntax::ast::{self, Means};
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::{Node, Path};
use crate::resolve::rules;
use crate::words::hex;

/// The messages of the protocol.
type Messages = Table<MessageId, Message>;

impl Resolver<'_> {
    pub fn examples(&mut self, identifier: &Identifier, messages: &Messages) -> Vec<Example> {
        let spec = self.spec;
        let root = Path::default();
        let mut examples = Vec::new();
        for ((name, message), id) in spec.messages.iter().zip(messages.ids()) {
            let path = root.key("messages").key(name).key("examples");
            for (position, example) in message.examples.iter().enumerate() {
                let at = path.index(position);
                let of = self.message_in(&at, example, id, messages);
                examples.extend(self.example(&at, position, example, of, &messages[id].doc, messages));
            }
        }
        for (name, sequence) in &spec.examples {
            self.check_name(&root.key("examples").key(name), name);
            let path = root.key("examples").key(name);
            let doc = remarks!(sequence).doc(&path, None);
            for (position, example) in sequence.frames.iter().enumerate() {
                let at = path.key("frames").index(position);
                let message = self.message_of(&at, example);
                examples.extend(self.example(&at, position, example, message, &doc, messages));
            }
        }
        for example in &examples {
            self.check_identifier_width(example, identifier);
        }
        examples
    }

    /// Returns the remarks of the sequences.
    pub fn sequences(&self) -> Vec<Doc> {
        let root = Path::default().key("examples");
        self.spec.examples.iter().map(|(name, sequence)| remarks!(sequence).doc(&root.key(name), None)).collect()
    }

    /// Finds the message of an example in a message: the message itself, or a member that the
    /// example names.
    fn message_in(
        &mut self,
        path: &Path,
        example: &ast::Example,
        outer: MessageId,
        messages: &Messages,
    ) -> Option<MessageId> {
        let Some(name) = &example.message else { return Some(outer) };
        let at = path.key("message");
        let Some(set) = &messages[outer].set else {
            let text = "`message` means nothing here: the example is of the message in which it stands".to_owned();
            self.error_with_help(&rules::MISPLACED_KEY, at.at_key(), text, "take it out");
            return Some(outer);
        };
        let names = set.members.iter().map(|member| messages[*member].name.as_str());
        let position = self.lookup(&at, "member", name, names)?;
        Some(set.members[position])
    }

    /// Finds the message that an example of a sequence names.
    fn message_of(&mut self, path: &Path, example: &ast::Example) -> Option<MessageId> {
        let Some(name) = &example.message else {
            if !matches!(example.fails.as_deref(), Some("identifier" | "foreign" | "unknown_message")) {
                let text = "an example of a sequence needs its message".to_owned();
                self.error_with_help(&rules::EXAMPLE, path.at_key(), text, "write `message: NAME`");
            }
            return None;
        };
        let spec = self.spec;
        self.lookup(&path.key("message"), "message", name, spec.messages.keys().map(String::as_str)).map(MessageId::new)
    }

    fn example(
        &mut self,
        path: &Path,
        position: usize,
        example: &ast::Example,
        message: Option<MessageId>,
        outer: &Doc,
        messages: &Messages,
    ) -> Option<Example> {
        let (kind, texts) = self.printed_kind(path, example)?;
        let known = message.map(|index| &messages[index]);
        let long = known.and_then(|known| known.long);
        let is_joined = long.is_some_and(|long| self.is_joined(long));
        // A list of one frame is a message of one part.
        let written = self.diagnostics.tree().and_then(|tree| tree.get(&path.key(kind.name())));
        let is_list = long.is_some_and(|long| self.tables.long_messages[long].parts().is_some())
            && written.is_some_and(Node::is_list);
        let ([text], None, false) = (texts, &example.count, is_joined || is_list) else {
            self.long_example(path, (kind, texts), example, known, outer);
            return None;
        };
        let printed = self.printed(&path.key(kind.name()), text)?;
        let model = example.model.as_ref().and_then(|name| self.device_model(&path.key("model"), name));
        let model = model.or_else(|| known?.models.first().copied());
        let on_model = known.map(|known| known.on(model));
        let means = on_model.map(|known| self.meanings(&path.key("means"), example.means.as_ref(), &known));
        Some(Example {
            doc: example_remarks(example).doc(path, Some(outer)),
            kind,
            id: printed.id,
            extended: printed.extended,
            data: printed.data,
            message,
            model,
            means: means.unwrap_or_default(),
            notes: self.notes(&path.key("notes"), &example.notes),
            fails: example.fails.as_ref().and_then(|word| self.failure(&path.key("fails"), word)),
            origin: self.origin(path, example.origin.as_deref()),
            position,
        })
    }

    fn origin(&mut self, path: &Path, word: Option<&str>) -> Origin {
        let words = ORIGINS.iter().map(|(word, _)| *word);
        let index = word.and_then(|word| self.lookup(&path.key("origin"), "origin", word, words));
        index.map_or(Origin::Document, |index| ORIGINS[index].1)
    }

    /// Reads the rules of notes that decoding must report.
    fn notes(&mut self, path: &Path, names: &[String]) -> Vec<NoteRule> {
        let known = NoteRule::ALL.iter().map(|(_, name)| *name);
        let places = names.iter().enumerate();
        let found = places.filter_map(|(index, name)| self.lookup(&path.index(index), "note", name, known.clone()));
        found.map(|index| NoteRule::ALL[index].0).collect()
    }

    fn failure(&mut self, path: &Path, word: &str) -> Option<Failure> {
        let index = self.lookup(path, "way to fail", word, Failure::ALL.iter().map(|(_, name)| *name))?;
        Some(Failure::ALL[index].0)
    }

    /// Resolves an example that shows all frames of a message in parts.
    fn long_example(
        &mut self,
        path: &Path,
        (kind, texts): (Kind, &[String]),
        example: &ast::Example,
        message: Option<&Message>,
        outer: &Doc,
    ) {
        let name = message.map_or("", |message| &message.name);
        let written = self.spec.messages.get(name);
        let is_meant = written.is_some_and(|message| message.parts.is_some() || message.via.is_some());
        let Some(long) = message.and_then(|message| message.long) else {
            if is_meant {
                return;
            }
            let text = "a list of frames, and a `count`, are for an example of a message in `parts` or by a transport"
                .to_owned();
            let help = "write one frame without `count`, and an example for each other frame";
            return self.error_with_help(&rules::EXAMPLE, path.key(kind.name()).at_value(), text, help);
        };
        if example.fails.is_some() {
            let text = "`fails` means nothing for a list of frames".to_owned();
            let help = "write an example of the frame that fails";
            self.error_with_help(&rules::MISPLACED_KEY, path.key("fails").at_key(), text, help);
        }
        let announces = self.tables.long_messages[long].parts().is_some_and(|parts| parts.length.is_some());
        if announces && example.count.is_some() {
            let text = "`count` means nothing here: the first frame says how many bytes there are".to_owned();
            self.error_with_help(&rules::MISPLACED_KEY, path.key("count").at_key(), text, "take it out");
        }
        let content = self.tables.long_messages[long].content.clone();
        let mut frames = Vec::new();
        for (index, text) in texts.iter().enumerate() {
            let at = path.key(kind.name()).index(index);
            let Some(printed) = self.printed(&at, text) else { return };
            frames.push((printed.id, printed.data.unwrap_or_default()));
        }
        let model = example.model.as_ref().and_then(|name| self.device_model(&path.key("model"), name));
        let model = model.or_else(|| content.models.first().copied());
        let content = content.on(model);
        let count = example.count.as_ref().and_then(|text| self.integer(&path.key("count"), text, 0, MOST_BYTES));
        let means = self.meanings(&path.key("means"), example.means.as_ref(), &content);
        let example = LongExample {
            doc: example_remarks(example).doc(path, Some(outer)),
            kind,
            long,
            frames,
            model,
            count,
            means,
            notes: self.notes(&path.key("notes"), &example.notes),
            origin: self.origin(path, example.origin.as_deref()),
        };
        self.tables.long_examples.push(example);
    }

    /// Returns the frames of an example and their kind.
    fn printed_kind<'e>(&mut self, path: &Path, example: &'e ast::Example) -> Option<(Kind, &'e [String])> {
        let texts = [&example.request, &example.reply, &example.report];
        let given = Kind::ALL.into_iter().zip(texts).map(|(kind, texts)| (kind, texts.0.as_slice()));
        let mut given = given.filter(|(_, texts)| !texts.is_empty());
        let (first, second) = (given.next(), given.next());
        if first.is_none() || second.is_some() {
            let help =
                "write one of `request`, `reply` and `report`, for instance `request: ID#DATA` in hexadecimal digits";
            let found = if first.is_none() { "no frame" } else { "more than one frame" };
            self.error_with_help(&rules::EXAMPLE, path.at_key(), format!("this example shows {found}"), help);
            return None;
        }
        first
    }

    /// Reads a frame as a document prints it, or an identifier alone.
    fn printed(&mut self, path: &Path, text: &str) -> Option<Printed> {
        let Some(printed) = Printed::read(text) else {
            let help =
                "write 8 or 3 hexadecimal digits, `#`, `:` or a blank, and two digits for each of up to 8 data bytes";
            self.error_with_help(&rules::EXAMPLE, path.at_value(), format!("`{text}` is not a frame"), help);
            return None;
        };
        let (width, digits, first) = if printed.extended { (29, 8, "0 or 1") } else { (11, 3, "0 to 7") };
        if printed.id >> width != 0 {
            let message = format!("the identifier `{:0digits$X}` has more than {width} bits", printed.id);
            self.error_with_help(&rules::EXAMPLE, path.at_value(), message, format!("its first digit is {first}"));
            return None;
        }
        Some(printed)
    }

    /// Tests that an example with the other identifier width must fail.
    fn check_identifier_width(&mut self, example: &Example, identifier: &Identifier) {
        if example.extended != identifier.extended && example.fails.is_none() {
            let (found, digits) = if identifier.extended { (3, 8) } else { (8, 3) };
            let message = format!("this identifier has {found} digits, those of this protocol have {digits}");
            let help = "8 digits are an identifier of 29 bits, 3 digits one of 11; correct the frame or `identifier`";
            self.error_with_help(&rules::EXAMPLE, example.doc.path.key(example.kind.name()).at_value(), message, help);
        }
    }

    fn meanings(&mut self, path: &Path, means: Option<&Means>, message: &Message) -> Vec<Meaning> {
        match means {
            None => Vec::new(),
            Some(Means::Signals(signals)) => {
                let entries = signals.iter();
                entries.flat_map(|(name, means)| self.named_meaning(&path.key(name), name, means, message)).collect()
            }
            Some(_) if self.given_up(message).is_some_and(|names| !names.is_empty()) => Vec::new(),
            Some(means) => {
                if let Some(array) = only_array(message) {
                    return self.elements(path, array, means, message);
                }
                let [signal] = &*message.signals else {
                    if message.signals.is_empty() {
                        self.nothing_to_mean(path, message);
                        return Vec::new();
                    }
                    let text = format!("`{}` has {} signals", message.name, message.signals.len());
                    let help = "write a value for each signal: `means: {voltage: 500 V, ...}`";
                    self.error_with_help(&rules::EXAMPLE, path.at_key(), text, help);
                    return Vec::new();
                };
                self.meaning(path, SignalId::new(0), signal, means).into_iter().collect()
            }
        }
    }

    fn named_meaning(&mut self, path: &Path, name: &str, means: &Means, message: &Message) -> Vec<Meaning> {
        let is_meant = |known: &String| known == name || is_element(name, known);
        if self.given_up(message).is_some_and(|names| names.iter().any(is_meant)) {
            return Vec::new();
        }
        if let Some(array) = message.array(name) {
            return self.elements(path, array, means, message);
        }
        let found = message.signals.position(|signal| signal.name == name);
        if let (None, Means::Signals(parts)) = (found, means)
            && message.signals.iter().any(|signal| is_part(&signal.name, name))
        {
            let part = |(part, means): (&String, &Means)| {
                self.named_meaning(&path.key(part), &format!("{name}_{part}"), means, message)
            };
            return parts.iter().flat_map(part).collect();
        }
        let id = found.or_else(|| self.no_signal(path, name, message));
        id.and_then(|id| self.meaning(path, id, &message[id], means)).into_iter().collect()
    }

    /// Reads the values of an array's elements.
    fn elements(&mut self, path: &Path, array: &Array, means: &Means, message: &Message) -> Vec<Meaning> {
        let (name, count) = (&array.name, array.elements.len());
        let items = match means {
            Means::List(items) => &items[..],
            Means::Value(_) | Means::Signals(_) => &[],
        };
        if items.is_empty() || items.len() > count {
            let text = match items.len() {
                0 => format!("`{name}` is an array of {count} elements"),
                found => format!("`{name}` has {count} elements, and here are {found}"),
            };
            let help = format!("write a list of their values, or one as `{}`", message[array.elements[0]].name);
            self.error_with_help(&rules::EXAMPLE, path.at_value(), text, help);
            return Vec::new();
        }
        let items = array.elements.iter().zip(items).enumerate();
        items.filter_map(|(index, (id, item))| self.meaning(&path.index(index), *id, &message[*id], item)).collect()
    }

    /// Reports a value in an example of a message without fields.
    fn nothing_to_mean(&mut self, path: &Path, message: &Message) {
        let text = format!("`{}` has no field, but an example says what it means", message.name);
        let diagnostic = Diagnostic::error(&rules::EXAMPLE, message.doc.path.at_key(), text);
        let diagnostic = diagnostic.help("add its `value` or its `fields`, or take `means` out of the example");
        self.diagnostics.push_first(diagnostic.other(path.at_key(), "what it means"));
    }

    /// Reports a name that no field has.
    fn no_signal(&mut self, path: &Path, name: &str, message: &Message) -> Option<SignalId> {
        let known = message.signals.iter().map(|signal| &signal.name);
        let names: Vec<_> = known.chain(self.given_up(message).into_iter().flatten()).cloned().collect();
        self.lookup_key(path, "signal", name, names.iter().map(String::as_str)).map(SignalId::new)
    }

    /// Returns the names of a message's fields that have an error of their own.
    fn given_up(&self, message: &Message) -> Option<&IndexSet<String>> {
        self.tables.given_up.get(&message.name)
    }

    fn meaning(&mut self, path: &Path, id: SignalId, signal: &Signal, means: &Means) -> Option<Meaning> {
        let (text, said) = match means {
            Means::Value(text) => (text.clone(), said(self.words(), signal, text)),
            Means::List(items) => {
                let names = self.names_of_bits(path, signal, items)?;
                (format!("[{}]", names.join(", ")), self.raw_status(signal, &names)?.map(Said::Bits))
            }
            Means::Signals(_) => {
                let text = format!("`{}` is one value, not a map", signal.name);
                let is_status = signal.encoding.status_word().is_some();
                let help = if is_status { "write a list of its set bits" } else { "write its value alone" };
                self.error_with_help(&rules::EXAMPLE, path.at_key(), text, help);
                return None;
            }
        };
        Some(Meaning { signal: id, text, said, path: path.clone() })
    }

    /// Returns the names of a status word's bits.
    fn names_of_bits(&mut self, path: &Path, signal: &Signal, items: &[Means]) -> Option<Vec<String>> {
        let names = items.iter().map(|item| match item {
            Means::Value(name) => Some(name.clone()),
            Means::List(_) | Means::Signals(_) => None,
        });
        let (text, help) = match names.collect() {
            _ if signal.encoding.status_word().is_none() => {
                let text = format!("`{}` is no status word, so it has no list of bits", signal.name);
                (text, "write its value without brackets")
            }
            None => (format!("the list of `{}` has more than names", signal.name), "write the names of its set bits"),
            names => return names,
        };
        self.error_with_help(&rules::EXAMPLE, path.at_value(), text, help);
        None
    }

    fn raw_status(&self, signal: &Signal, names: &[String]) -> Option<Result<u64, Misfit>> {
        let index = signal.encoding.status_word()?;
        let bits = &self.tables.status_words[index].bits;
        Some(names.iter().try_fold(0, |raw, name| Ok(raw | 1 << status_bit(signal, bits, name)?)))
    }

    /// Resolves the examples of types: bytes and what they mean.
    pub fn value_examples(&mut self) -> Vec<ValueExample> {
        let spec = self.spec;
        let mut resolved = Vec::new();
        for (name, field) in &spec.types {
            let path = Path::default().key("types").key(name);
            let doc = remarks!(field).doc(&path, None);
            for (index, example) in field.examples.iter().enumerate() {
                resolved.extend(self.value_example(&path.key("examples").index(index), name, field, example, &doc));
            }
        }
        resolved
    }

    fn value_example(
        &mut self,
        path: &Path,
        name: &str,
        field: &ast::Field,
        example: &ast::ValueExample,
        outer: &Doc,
    ) -> Option<ValueExample> {
        let bytes = hex::bytes(&example.bytes).filter(|bytes| (1..=8).contains(&bytes.len()));
        let Some(bytes) = bytes else {
            let message = format!("`{}` is not 1 to 8 bytes", example.bytes);
            let help = "write two hexadecimal digits for each byte, without spaces";
            self.error_with_help(&rules::EXAMPLE, path.key("bytes").at_value(), message, help);
            return None;
        };
        let mut data = [0; 8];
        data.iter_mut().zip(&bytes).for_each(|(byte, given)| *byte = *given);
        let last = u8::try_from(bytes.len()).unwrap_or(8) - 1;
        let merged = self.merged(&outer.path, field)?;
        let remarks = remarks_of_value(example);
        let doc = remarks.doc(path, Some(outer));
        let signal = self.signal(name, &merged, Place::bytes(0, last), outer.clone(), "")?;
        let said = said(self.words(), &signal, &example.means);
        debug_assert_eq!(signal.start(), 0);
        let meaning = Meaning { signal: SignalId::new(0), text: example.means.clone(), said, path: path.key("means") };
        Some(ValueExample { doc, signal, data, meaning })
    }
}

fn example_remarks(example: &ast::Example) -> super::texts::Remarks<'_> {
    super::texts::Remarks { title: &None, note: &example.note, section: &example.section, erratum: &example.erratum }
}

fn remarks_of_value(example: &ast::ValueExample) -> super::texts::Remarks<'_> {
    super::texts::Remarks { title: &None, note: &None, section: &example.section, erratum: &example.erratum }
}

/// Returns the array that is all of a message.
fn only_array(message: &Message) -> Option<&Array> {
    let (first, others) = message.arrays.split_first()?;
    (others.is_empty() && first.elements.len() == message.signals.len()).then_some(first)
}

/// Tests whether a name is that of an array with a number.
fn is_element(name: &str, array: &str) -> bool {
    is_part(name, array) && name[array.len() + 1..].parse::<u16>().is_ok()
}

/// Tests whether a name is that of a group with the name of a field.
fn is_part(name: &str, group: &str) -> bool {
    name.strip_prefix(group).is_some_and(|rest| rest.starts_with('_'))
}

/// Finds the bit of a status word by its name, or by its number if it has no name.
fn status_bit(signal: &Signal, bits: &[StatusBit], name: &str) -> Result<u8, Misfit> {
    if let Some(bit) = bits.iter().find(|bit| bit.name == name) {
        return Ok(bit.bit);
    }
    let Ok(number) = name.parse::<u8>() else {
        let known: Vec<_> = bits.iter().map(|bit| bit.name.as_str()).collect();
        let why = format!("`{}` has no status bit `{name}`", signal.name);
        return Err(Misfit::with_help(why, suggestion("status bit", name, &known)));
    };
    let width = signal.place.width();
    if number >= width {
        let why = format!("there is no bit {number} in the {width} bits of `{}`", signal.name);
        return Err(Misfit::with_help(why, format!("its bits are 0 to {}", width - 1)));
    }
    match bits.iter().find(|bit| bit.bit == number) {
        Some(bit) => {
            let why = format!("bit {number} of `{}` has a name", signal.name);
            Err(Misfit::with_help(why, format!("write `{}`", bit.name)))
        }
        None => Ok(number),
    }
}
