//! Rust names for the names of a spec. Two items never get the same name.

use std::collections::BTreeSet;
use std::iter;

use proc_macro2::{Ident, Span};

use super::unit::Unit;
use crate::emit::Scaled;
use crate::model::{Message, Signal};

/// Types that generated code takes from the runtime or the prelude, or that every module has.
const TAKEN: [&str; 104] = [
    "Access",
    "Address",
    "AddressType",
    "Addressed",
    "Addressing",
    "AfterSilence",
    "AnySignal",
    "AnySignals",
    "Bcd",
    "Bits",
    "Bytes",
    "Clone",
    "Continuation",
    "Copy",
    "Data",
    "Debug",
    "Decode",
    "Default",
    "Destination",
    "Document",
    "Drop",
    "Elements",
    "Entry",
    "Eq",
    "Err",
    "Error",
    "Exchange",
    "Failure",
    "Filter",
    "Fn",
    "Frame",
    "FrameSet",
    "From",
    "Hash",
    "Headed",
    "Heading",
    "IdFilter",
    "Identifier",
    "IdentifierFields",
    "Incoming",
    "Into",
    "Iterator",
    "Kind",
    "Lack",
    "Layout",
    "Legend",
    "LongLayout",
    "LongPayload",
    "LongSignal",
    "LongText",
    "Message",
    "Meaning",
    "Mode",
    "Model",
    "None",
    "Number",
    "Ok",
    "Option",
    "PartialEq",
    "PackedText",
    "Parted",
    "Particulars",
    "Pattern",
    "Payload",
    "Piece",
    "Place",
    "Problem",
    "Protocol",
    "Quantities",
    "Quantity",
    "Raw",
    "ReadPath",
    "Reading",
    "Received",
    "Replies",
    "Reply",
    "Report",
    "Request",
    "Result",
    "Route",
    "Said",
    "Selector",
    "Self",
    "Send",
    "Sent",
    "SetPath",
    "Severity",
    "Shown",
    "Signal",
    "Some",
    "States",
    "StatusBit",
    "String",
    "Sync",
    "Target",
    "Task",
    "Text",
    "Time",
    "Timing",
    "Transferred",
    "Way",
    "Who",
    "Within",
    "Word",
];

/// Constants that every module has.
const CONSTANTS: [&str; 6] = ["BIT_RATES", "CONTINUATION", "DOCUMENTS", "FRAME", "MESSAGES", "TIMING"];

/// Methods and constants that every message has.
const OF_MESSAGES: [&str; 14] = [
    "RESERVED",
    "LENGTHS",
    "decode",
    "encode",
    "signals",
    "within",
    "clone",
    "eq",
    "hash",
    "fmt",
    "from",
    "into",
    "clone_from",
    "borrow",
];

/// A pool that gives every name only once.
#[derive(Default)]
pub struct Pool {
    taken: BTreeSet<String>,
}

impl Pool {
    /// Returns the pool of the types of a module.
    pub fn of_types() -> Self {
        Self::without(TAKEN.into_iter().map(str::to_owned))
    }

    /// Returns the pool of the constants of a module.
    pub fn of_constants() -> Self {
        Self::without(CONSTANTS.into_iter().map(str::to_owned))
    }

    /// Returns the pool of a message's methods and constants.
    pub fn of_members() -> Self {
        Self::with_members(iter::empty())
    }

    /// Returns the pool of a message's methods and constants, some of them named already.
    pub fn with_members(names: impl Iterator<Item = String>) -> Self {
        Self::without(names.chain(OF_MESSAGES.into_iter().map(str::to_owned)))
    }

    /// Returns a pool in which these names are taken already.
    pub fn without(taken: impl Iterator<Item = String>) -> Self {
        Self { taken: taken.collect() }
    }

    /// Takes the name of a constant. Names of the spec can differ only in case.
    pub fn constant(&mut self, name: &str) -> Ident {
        self.take(name.to_ascii_uppercase(), "_")
    }

    /// Takes a name. If it is taken already, it gets as many suffixes as it needs.
    pub fn take(&mut self, name: String, suffix: &str) -> Ident {
        ident(&self.take_text(unreserved(name), suffix))
    }

    /// Takes the name of a variant in texts: that of the spec, if serde would not make it of the variant.
    pub fn renamed(&mut self, variant: &Ident, name: &str, suffix: &str) -> Option<String> {
        let name = self.take_text(name.to_owned(), suffix);
        (snake_case(variant) != name).then_some(name)
    }

    fn take_text(&mut self, name: String, suffix: &str) -> String {
        let mut name = name;
        while self.taken.contains(&name) {
            name.push_str(suffix);
        }
        self.taken.insert(name.clone());
        name
    }
}

/// Tests whether a name is a keyword of Rust.
pub fn is_word_of_rust(name: &str) -> bool {
    // `syn` does not know this one, because the edition decides.
    name == "gen" || syn::parse_str::<Ident>(name).is_err()
}

/// Makes an identifier. A keyword of Rust becomes a raw identifier.
pub fn ident(name: &str) -> Ident {
    match name {
        _ if RESERVED.contains(&name) => Ident::new(&unreserved(name.to_owned()), Span::call_site()),
        _ if is_word_of_rust(name) => Ident::new_raw(name, Span::call_site()),
        _ => Ident::new(name, Span::call_site()),
    }
}

/// The words that no raw identifier can be.
const RESERVED: [&str; 5] = ["self", "super", "crate", "Self", "_"];

/// Returns a name that can be an identifier.
fn unreserved(name: String) -> String {
    if RESERVED.contains(&name.as_str()) { name + "_" } else { name }
}

/// Converts `set_output` to `SetOutput`.
pub fn camel_case(name: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters.next().map(|first| first.to_ascii_uppercase()).into_iter().chain(letters).collect::<String>()
    };
    name.split('_').map(capital).collect()
}

/// Converts `SetOutput` to `set_output` as serde does it: `_` stands before capitals alone, so that `X1` is `x1`.
fn snake_case(variant: &Ident) -> String {
    let name = variant.to_string();
    let letter = |(at, letter): (usize, char)| {
        let before = (at > 0 && letter.is_ascii_uppercase()).then_some('_');
        before.into_iter().chain([letter.to_ascii_lowercase()])
    };
    name.char_indices().flat_map(letter).collect()
}

/// Names the variants of an enum, and the one that keeps values without a name.
pub fn variants<'a>(names: impl Iterator<Item = &'a str>) -> (Vec<Ident>, Ident) {
    let mut pool = Pool::default();
    let variants = names.map(|name| pool.take(camel_case(name), "_")).collect();
    (variants, pool.take("Unknown".to_owned(), "Value"))
}

/// Names the variant of a device model, `SM_750_30A` as `Sm750_30a`. Only between two digits `_`
/// stays.
pub fn model_variant(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    words.fold(String::new(), |known, word| {
        let word = camel_case(&word.to_ascii_lowercase());
        let digits = known.ends_with(|last: char| last.is_ascii_digit())
            && word.starts_with(|first: char| first.is_ascii_digit());
        format!("{known}{}{word}", if digits { "_" } else { "" })
    })
}

/// Converts `set_output` to `SET_OUTPUT`.
pub fn screaming(name: &str) -> Ident {
    ident(&name.to_ascii_uppercase())
}

/// Names the member of a signal or of its array, with the unit of its values as the ending.
pub fn member(message: &Message, signal: &Signal, scaled: Scaled) -> String {
    let (name, ending) = (message.field_name(signal), Unit::new(signal, scaled).ending);
    ending.map_or_else(|| name.to_owned(), |ending| format!("{name}_{ending}"))
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::{fs, io};

    use super::*;

    #[test]
    fn the_reference_lists_every_name_that_is_taken() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/language/rust.md");
        let reference = fs::read_to_string(path).expect("the reference is there");
        let (_, part) = reference.split_once("**Names that are taken.**").expect("the reference has the part");
        let (part, _) = part.split_once("\n## ").expect("another part follows");
        let types = part.split("```").nth(1).expect("the types stand in a block").split_whitespace().skip(1);
        assert_eq!(types.collect::<Vec<_>>(), TAKEN);
        for name in CONSTANTS.iter().chain(&OF_MESSAGES) {
            assert!(part.contains(&format!("`{name}`")), "{name}");
        }
    }

    /// Returns the names that the prelude in a file of the runtime exports by `pub use`.
    fn exported(file: &str) -> io::Result<Vec<String>> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../runtime/src").join(file);
        let text = fs::read_to_string(path)?;
        let prelude = text.split_once("pub mod prelude").map_or(&*text, |(_, prelude)| prelude);
        let uses = prelude.split("pub use ").skip(1).filter_map(|rest| rest.split(';').next());
        let names = uses.flat_map(|list| list.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_'));
        Ok(names.filter(|name| !name.is_empty()).map(str::to_owned).collect())
    }

    #[test]
    fn no_type_is_called_as_what_every_module_takes_from_the_runtime() -> io::Result<()> {
        let exported = [exported("plumbing.rs")?, exported("prelude.rs")?].concat();
        let types: Vec<_> =
            exported.iter().filter(|name| name.starts_with(|first: char| first.is_uppercase())).collect();
        assert!(types.len() > 35, "{types:?}");
        let free: Vec<_> = types.into_iter().filter(|name| !TAKEN.contains(&name.as_str())).collect();
        assert_eq!(free, Vec::<&String>::new());
        Ok(())
    }

    #[test]
    fn names_that_differ_in_case_alone_get_constants_of_their_own() {
        let mut constants = Pool::of_constants();
        let names = ["module_ADDRESS", "Module_ADDRESS", "frame"].map(|name| constants.constant(name).to_string());
        assert_eq!(names, ["MODULE_ADDRESS", "MODULE_ADDRESS_", "FRAME_"]);
    }

    #[test]
    fn a_name_that_rust_reserves_meets_no_other_one() {
        let mut pool = Pool::default();
        let names = ["Self", "Self", "Self_", "gen", "gen"].map(|name| pool.take(name.to_owned(), "_").to_string());
        assert_eq!(names, ["Self_", "Self__", "Self___", "r#gen", "gen_"]);
    }

    #[test]
    fn variants_go_by_the_names_of_the_spec_in_texts() {
        let mut texts = Pool::default();
        let mut renamed = |variant, name| texts.renamed(&ident(variant), name, "_message");
        assert_eq!(renamed("SetOutput", "set_output"), None);
        assert_eq!(renamed("X1", "x_1").as_deref(), Some("x_1"));
        assert_eq!(renamed("ModelMessage", "model").as_deref(), Some("model"));
        assert_eq!(renamed("X1Message", "x_1").as_deref(), Some("x_1_message"));
    }

    #[test]
    fn every_word_of_the_edition_is_one() {
        assert!(["gen", "type", "async", "self", "try", "yield"].into_iter().all(is_word_of_rust));
        assert!(!["union", "auto", "raw", "default"].into_iter().any(is_word_of_rust));
        assert_eq!(["gen", "self", "union"].map(|name| ident(name).to_string()), ["r#gen", "self_", "union"]);
    }
}
