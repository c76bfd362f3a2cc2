//! Resolves quantities: vendor-neutral names to signals.

use indexmap::IndexSet;

use super::Resolver;
use crate::encoding::said;
use crate::model::{
    Encoding, FieldPath, Fixed, Message, MessageId, QuantityPaths, Said, Signal, SignalId, SignalPath, Table,
};
use crate::read::syntax::ast;
use crate::report::diagnostic::At;
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::number::Rational;

/// How a path is written.
const FORM: &str = "write the message and its signal, as in `output.voltage`, and a status bit behind its word";

impl Resolver<'_> {
    pub fn quantities(&mut self, messages: &Table<MessageId, Message>) -> Vec<QuantityPaths> {
        let root = Path::default().key("quantities");
        let entries = self.spec.quantities.iter();
        entries.map(|(name, written)| self.quantity_paths(&root.key(name), name, written, messages)).collect()
    }

    fn quantity_paths(
        &mut self,
        path: &Path,
        name: &str,
        written: &ast::Quantity,
        messages: &Table<MessageId, Message>,
    ) -> QuantityPaths {
        self.check_name(path, name);
        self.check_not_empty(path, &["also"]);
        if written.read.is_none() && written.set.is_none() && written.also.is_empty() {
            let text = format!("`{name}` is neither read nor set");
            self.error_with_help(
                &rules::QUANTITY_PATH,
                path.at_key(),
                text,
                "write its `read` or its `set`, or take it out",
            );
        }
        let mut at = |key: &str, known: &Option<ast::SignalPath>| {
            known.as_ref().and_then(|known| self.signal_path(&path.key(key), known, messages))
        };
        let (read, set) = (at("read", &written.read), at("set", &written.set));
        if let Some(fixed) = written.read.as_ref().filter(|read| !read.with.is_empty()) {
            let first = fixed.with.keys().next().map_or("", String::as_str);
            let text = format!("nothing is sent with what is read, so `{first}` has no meaning here");
            let help = "write `with` at `set`, or take it out";
            self.error_with_help(&rules::MISPLACED_KEY, path.key("read").key("with").at_key(), text, help);
        }
        let also = written.also.iter().enumerate();
        let also = also.filter_map(|(index, text)| self.field_path(&path.key("also").index(index), text, messages));
        QuantityPaths { name: name.to_owned(), read, set, also: also.collect(), path: path.clone() }
    }

    /// Reads the path to a field of a message, which can travel in several frames.
    fn field_path(&mut self, path: &Path, written: &str, messages: &Table<MessageId, Message>) -> Option<FieldPath> {
        let Some((name, field)) = written.split_once('.').filter(|(_, field)| !field.contains('.')) else {
            let text = format!("`{written}` is no path to a field");
            let help = "write the message and its field, as in `set_total.voltage`";
            self.error_with_help(&rules::QUANTITY_PATH, path.at_value(), text, help);
            return None;
        };
        let known = self.spec.messages.keys().map(String::as_str);
        self.lookup(path, "message", name, known)?;
        let message = messages.position(|known| known.name == name)?;
        let long = messages[message].long.map(|long| self.tables.long_messages[long].content.clone());
        let content = long.as_ref().unwrap_or(&messages[message]);
        let given_up = self.tables.given_up.get(name).is_some_and(|names| names.contains(field));
        if content.signals_of(field).next().is_none() {
            let fields: IndexSet<_> = content.signals.iter().map(|signal| content.field_name(signal)).collect();
            let fields: Vec<_> = fields.into_iter().collect();
            if !given_up {
                self.report_name(path.at_value(), "field", field, &fields, None);
            }
            return None;
        }
        Some(FieldPath { message, field: field.to_owned(), path: path.clone() })
    }

    fn signal_path(
        &mut self,
        path: &Path,
        written: &ast::SignalPath,
        messages: &Table<MessageId, Message>,
    ) -> Option<SignalPath> {
        let at = if written.is_map { path.key("signal") } else { path.clone() };
        let parts: Vec<_> = written.signal.split('.').collect();
        let ([message, signal] | [message, signal, _]) = parts[..] else {
            let text = format!("`{}` is no path to a signal", written.signal);
            self.error_with_help(&rules::QUANTITY_PATH, at.at_value(), text, FORM);
            return None;
        };
        let known = self.spec.messages.keys().map(String::as_str);
        self.lookup(&at, "message", message, known)?;
        // A message with an error of its own is none.
        let id = messages.position(|known| known.name == message)?;
        let message = &messages[id];
        if message.long.is_some() {
            let text = format!("`{}` travels in several frames", message.name);
            let help = "a quantity is a signal of one frame; leave it out";
            self.error_with_help(&rules::QUANTITY_PATH, at.at_value(), text, help);
            return None;
        }
        let found = self.signal_of(at.at_value(), signal, message)?;
        let known = &message[found];
        let place = match parts.get(2) {
            Some(bit) => known.place.bit(self.status_bit_of(&at, known, bit)?),
            None => known.place,
        };
        let states = match &written.states {
            Some(states) => Some(self.states(path, &at, known, parts.len() > 2, states)?),
            None => None,
        };
        let with = written.with.iter();
        let with = with.filter_map(|(name, text)| self.fixed_value(&path.key("with").key(name), name, text, message));
        let bit = parts.get(2).map(|name| (*name).to_owned());
        Some(SignalPath { message: id, signal: found, bit, place, states, with: with.collect(), path: at })
    }

    /// Finds a signal by its name, unless its field has an error of its own.
    fn signal_of(&mut self, at: At, name: &str, message: &Message) -> Option<SignalId> {
        let found = message.signals.position(|signal| signal.name == name);
        let given_up = self.tables.given_up.get(&message.name).is_some_and(|names| names.contains(name));
        if found.is_none() && !given_up {
            let names: Vec<_> = message.signals.iter().map(|signal| signal.name.as_str()).collect();
            self.report_name(at, "signal", name, &names, None);
        }
        found
    }

    fn status_bit_of(&mut self, path: &Path, signal: &Signal, name: &str) -> Option<u8> {
        let Some(word) = signal.encoding.status_word() else {
            let text = format!("`{}` is no status word, so it has no bit `{name}`", signal.name);
            self.error_with_help(&rules::QUANTITY_PATH, path.at_value(), text, "name the signal alone");
            return None;
        };
        let bits: Vec<_> = self.tables.status_words[word].bits_in(signal.place).cloned().collect();
        let names = bits.iter().map(|bit| bit.name.as_str());
        self.lookup(path, "status bit", name, names).map(|index| bits[index].bit)
    }

    /// Reads the states of a switch, the one that is off first.
    fn states(
        &mut self,
        path: &Path,
        at: &Path,
        signal: &Signal,
        is_bit: bool,
        states: &[Option<String>; 2],
    ) -> Option<[u64; 2]> {
        if let (Some(what), false) = (stateless(signal), is_bit) {
            let text = format!("`{}` is {what}, and has no states", signal.name);
            let help = "name a signal with named values, a single bit, or a status bit behind its word";
            self.error_with_help(&rules::QUANTITY_PATH, at.at_value(), text, help);
            return None;
        }
        let [Some(inactive), Some(active)] = states else {
            let missing = if states[0].is_none() { "inactive" } else { "active" };
            let text = format!("this switch has no state `{missing}`");
            let help = "write both states, as in `active: 0, inactive: 1`; a number has none";
            self.error_with_help(&rules::QUANTITY_PATH, path.at_key(), text, help);
            return None;
        };
        let (inactive, active) =
            (self.state(&path.key("inactive"), signal, inactive), self.state(&path.key("active"), signal, active));
        let (inactive, active) = (inactive?, active?);
        if inactive == active {
            let text = "both states of this switch are the same".to_owned();
            let help = "write the values as the document prints them, one for each state";
            self.error_with_help(&rules::QUANTITY_PATH, path.key("inactive").at_value(), text, help);
            return None;
        }
        Some([inactive, active])
    }

    /// Reads the bits of a state: a named value by its name or its raw number, or a bit.
    fn state(&mut self, path: &Path, signal: &Signal, text: &str) -> Option<u64> {
        let Some(known) = signal.encoding.enumeration() else { return self.integer(path, text, 0, 1) };
        let values = self.tables.enumerations[known].values.clone();
        let raw = Rational::parse(text).and_then(Rational::to_integer);
        if let Some(listed) = raw.filter(|raw| values.iter().any(|value| value.raw == *raw)) {
            return signal.bits_of(listed);
        }
        let names = values.iter().map(|value| value.name.as_str());
        let index = self.lookup(path, "named value", text, names)?;
        signal.bits_of(values[index].raw)
    }

    /// Reads the value that another signal of the request always has.
    fn fixed_value(&mut self, path: &Path, name: &str, text: &str, message: &Message) -> Option<Fixed> {
        let signal = self.signal_of(path.at_key(), name, message)?;
        let misfit = match said(self.words(), &message[signal], text) {
            Ok(Said::Bits(bits)) => return Some(Fixed { signal, bits, path: path.clone() }),
            Ok(Said::Rounded(_) | Said::Text(_)) => format!("`{text}` is no exact value of `{name}`").into(),
            Err(misfit) => misfit,
        };
        let help = misfit.help.unwrap_or_else(|| "write a value of the signal, as in `means`".to_owned());
        self.error_with_help(&rules::VALUE, path.at_value(), misfit.why, help);
        None
    }
}

/// Says what a signal is whose values are no states of a switch.
fn stateless(signal: &Signal) -> Option<&'static str> {
    match &signal.encoding {
        Encoding::Named(_) => None,
        Encoding::Number { .. } if signal.unit.is_some() => Some("a number with a unit"),
        Encoding::Number { scale, offset, .. } => {
            let is_bit = signal.place.width() == 1 && (*scale, *offset) == (Rational::ONE, Rational::ZERO);
            (!is_bit).then_some("a number")
        }
        Encoding::ByModel { .. } | Encoding::Float => Some("a number"),
        Encoding::Status(_) => Some("a whole status word"),
        Encoding::Text(_) | Encoding::Packed { .. } => Some("a text"),
    }
}
