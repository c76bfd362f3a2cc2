//! Finds traces of messages that a program does not use.

use canspec_codegen::model::{Message, Protocol};

use crate::bare::{Binary, Codec};

/// Shorter names stand in other constants by chance.
const TELLING: usize = 4;

/// The names of all messages but one.
pub struct Others {
    /// Names of messages and signals in texts.
    names: Vec<String>,
    /// Texts that the one message brings, which can contain such a name.
    expected: Vec<String>,
    /// Structs.
    structs: Vec<String>,
}

impl Others {
    /// Returns the names of the messages that a codec has beside the one whose struct is `owner`.
    ///
    /// # Panics
    ///
    /// If there is no such message.
    pub fn new(codec: &Codec, owner: &str) -> Self {
        let protocol = codec.protocol();
        let is_one = |message: &&Message| message.name.replace('_', "").eq_ignore_ascii_case(owner);
        let one = protocol.messages.iter().find(is_one).expect("the struct has the name of its message");
        let others = protocol.messages.iter().filter(|message| message.name != one.name);
        let expected: Vec<_> = names(one).chain(names_of_ways(protocol)).map(str::to_owned).collect();
        let is_telling = |name: &&str| name.len() >= TELLING && !expected.iter().any(|known| known == name);
        let names = others.flat_map(names).filter(is_telling).map(str::to_owned).collect();
        let structs = codec.messages().into_iter().filter(|name| name != owner).collect();
        Self { names, expected, structs }
    }

    /// Returns the names that stand in the constants of a program.
    pub fn named_in(&self, program: &Binary) -> Vec<&str> {
        let constants = program.constants();
        self.names.iter().map(String::as_str).filter(|name| self.stands_in(name, &constants)).collect()
    }

    /// Returns the functions and statics that a program has of these messages.
    pub fn symbols_in(&self, program: &Binary) -> Vec<String> {
        let mut symbols = program.symbols();
        symbols.retain(|symbol| self.structs.iter().any(|name| is_of(symbol, name)));
        symbols
    }

    /// Tests whether a name stands somewhere but inside of an expected text.
    fn stands_in(&self, name: &str, constants: &[u8]) -> bool {
        let found = constants.windows(name.len()).enumerate().filter(|(_, window)| *window == name.as_bytes());
        let mut places = found.map(|(place, _)| place);
        places.any(|place| !self.expected.iter().any(|text| covers(text, name, constants, place)))
    }
}

/// Tests whether the `name` at this place is a part of a longer text.
fn covers(text: &str, name: &str, constants: &[u8], place: usize) -> bool {
    let starts = text.match_indices(name).filter_map(|(inner, _)| place.checked_sub(inner));
    starts.into_iter().any(|start| constants[start..].starts_with(text.as_bytes()))
}

/// Returns the names of a message and of its signals.
fn names(message: &Message) -> impl Iterator<Item = &str> {
    let signals = message.signals.iter().map(|signal| signal.name.as_str());
    signals.chain([message.name.as_str()])
}

/// Returns the names of accesses, modes and kinds of addresses, which messages share.
fn names_of_ways(protocol: &Protocol) -> impl Iterator<Item = &str> {
    let accesses = protocol.accesses.iter().map(|access| access.name.as_str());
    let modes = protocol.modes.iter().map(|mode| mode.name.as_str());
    let addresses = protocol.address_types.iter().map(|address| address.name.as_str());
    accesses.chain(modes).chain(addresses)
}

/// Tests whether a mangled symbol names a type.
fn is_of(symbol: &str, name: &str) -> bool {
    [format!("{}{name}", name.len()), format!("..{name}$")].iter().any(|part| symbol.contains(part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_type_is_found_in_symbols_of_both_manglings() {
        let old =
            "_ZN78_$LT$bare..infy..SetLed$u20$as$u20$canspec_runtime..layout..Layout$GT$6decode17ha8e3f6d1c43415c2E";
        let new = "_RNvXs_NtCsbmNqQUJIY6D_4bare4infyNtB4_6SetLedNtNtCs1234_15canspec_runtime6layout6Layout6decode";
        for symbol in [old, new] {
            assert!(is_of(symbol, "SetLed"));
            assert!(!is_of(symbol, "Led"));
        }
    }

    #[test]
    fn a_name_inside_of_an_expected_text_is_no_trace() {
        let others = Others {
            names: vec!["module_output".to_owned()],
            expected: vec!["set_module_output".to_owned()],
            structs: Vec::new(),
        };
        assert!(!others.stands_in("module_output", b"voltset_module_outputage"));
        assert!(others.stands_in("module_output", b"set_module_outputmodule_output"));
        assert!(others.stands_in("module_output", b"module_output"));
    }
}
