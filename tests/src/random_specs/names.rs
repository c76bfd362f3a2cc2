//! Names and texts that are free in a spec, as hostile as they may be.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use canspec_codegen::emit::{self, Goal, Options, Scaled, Switch, is_word_of_rust};
use fastrand::Rng;
use proc_macro2::{TokenStream, TokenTree};

use crate::{protocol, specs};

/// Words of Rust, of its prelude and of its crates, which stand in no generated code.
const WORDS: &str = "abstract alloc as async await become bool box break char const continue core crate do dyn else enum \
    extern false final fn for gen if impl in let loop macro macro_rules match mod move mut override priv pub raw ref \
    return safe self static std str struct super trait true try type typeof u8 union unsafe unsized use virtual where \
    while yield i128 f64 usize as_mut as_ref borrow box clone clone_from clone_into cmp copy debug default drop eq err \
    extend fmt fn_mut fn_once from hash into into_iterator iterator ne none ok option ord partial_cmp partial_eq \
    partial_ord result send some string sync to_owned to_string try_from try_into type_id unpin vec all max min bits \
    derive test inline must_use panic assert vec_deque values value identifier ones zeros l o i x e1 n1 a_1 a1 a_1_0 \
    a_10 unknown reserved";

/// Endings that generated code gives to names.
const ENDINGS: [&str; 26] = [
    "access",
    "access_2",
    "address",
    "code",
    "exchange",
    "frame",
    "limits",
    "message",
    "mode",
    "reply",
    "report",
    "request",
    "result",
    "selector",
    "selector_2",
    "signal",
    "unknown",
    "value",
    "word",
    "read",
    "set",
    "never",
    "v",
    "s",
    "1",
    "2",
];

/// Names as hostile as they may be: words of Rust, and every name in generated code.
static HOSTILE: LazyLock<Vec<String>> = LazyLock::new(|| {
    let mut names: BTreeSet<String> = WORDS.split_whitespace().map(str::to_owned).collect();
    let [serde, defmt, arbitrary] = [const { Switch::Always }; 3];
    let every = Options { scaled: Scaled::F32, goal: Goal::Speed, serde, defmt, arbitrary };
    for path in specs("tests/specs/features") {
        collect(emit::tokens(&protocol(path), &every), &mut names);
    }
    names.into_iter().filter(|name| is_name(name)).collect()
});

/// Collects the identifiers of code as names of a spec.
fn collect(tokens: TokenStream, names: &mut BTreeSet<String>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => collect(group.stream(), names),
            TokenTree::Ident(name) => drop(names.insert(snake_case(&name.to_string()))),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}

/// Converts `SetOutput` and `SET_OUTPUT` to `set_output`.
fn snake_case(name: &str) -> String {
    let name = name.trim_start_matches("r#");
    let begins = |(at, letter): (usize, char)| {
        let is_word = letter.is_ascii_uppercase() && name[..at].ends_with(|last: char| last.is_ascii_lowercase());
        let blank = if is_word { "_" } else { "" };
        format!("{blank}{}", letter.to_ascii_lowercase())
    };
    name.char_indices().map(begins).collect()
}

/// Tells whether the language takes a name for a field.
fn is_name(name: &str) -> bool {
    let fits = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
    name.starts_with(|letter: char| letter.is_ascii_lowercase())
        && name.chars().all(fits)
        && !name.ends_with('_')
        && !name.contains("__")
}

/// Texts that are hostile to Rust, to its documentation, to Lua, to a DBC or to YAML.
const TEXTS: [&str; 22] = [
    "Output voltage",
    "0 until a group has been set",
    "a \"quoted\" 'text' with `ticks` and \\ and \\\" and \\n",
    "*/ /* // /// //! #![allow(x)] #[derive]",
    "[link](nowhere) [`Message`] [x] <b> & &lt; {} {0} {x",
    "r#\"raw\"# ]] --[[ end }} ${x} $(x) %d %s %",
    "Strom in Ampère, 電流, Ω, ½, \u{1F50B}",
    "-",
    "# heading",
    "1. list",
    "> quote",
    "on",
    "no",
    "null",
    "`",
    "\"",
    "\\",
    "a. b. c.",
    "ends with a full stop.",
    "SG_ BO_ CM_ \"x\";",
    "--",
    "=== ***",
];

/// Names that one map or one kind of item has already, as Rust may tell them apart.
#[derive(Clone, Default)]
pub struct Scope(BTreeSet<String>);

impl Scope {
    /// Takes a name, unless it is taken.
    pub fn take(&mut self, name: &str) -> bool {
        self.0.insert(name.to_owned())
    }

    /// Takes a name, unless another one has the same letters and digits.
    pub fn take_letters(&mut self, name: &str) -> bool {
        self.take(&name.replace('_', "").to_ascii_lowercase())
    }
}

/// Chooses names.
pub struct Names {
    random: Rng,
    /// The names of the spec so far.
    used: Vec<String>,
}

impl Names {
    pub fn new(random: Rng) -> Self {
        Self { random, used: Vec::new() }
    }

    /// Returns a name that a scope does not have.
    pub fn name(&mut self, scope: &mut Scope) -> String {
        self.new_name(|name| scope.take(name))
    }

    /// Returns a name that Rust can have as it is; one of two hundred it cannot.
    pub fn plain(&mut self, scope: &mut Scope) -> String {
        let careless = self.random.u8(..200) == 0;
        self.new_name(|name| (careless || !is_word_of_rust(name)) && scope.take(name))
    }

    /// Returns a name that stays apart in camel case; one of two hundred does not.
    pub fn apart(&mut self, scope: &mut Scope, letters: &mut Scope) -> String {
        let careless = self.random.u8(..200) == 0;
        self.new_name(|name| (letters.take_letters(name) || careless) && scope.take(name))
    }

    /// Returns a name as documents have it, with capitals.
    pub fn of_document(&mut self, scope: &mut Scope) -> String {
        let form = self.random.u8(..5);
        let made = |name: &str| match form {
            0 => name.to_ascii_uppercase(),
            1 => name[..1].to_ascii_uppercase() + &name[1..],
            2 => format!("{name}_"),
            _ => name.to_owned(),
        };
        let name = self.new_name(|name| scope.take(&made(name)));
        made(&name)
    }

    fn new_name(&mut self, mut fits: impl FnMut(&str) -> bool) -> String {
        loop {
            let name = self.any();
            if is_name(&name) && fits(&name) {
                self.used.push(name.clone());
                return name;
            }
        }
    }

    /// Returns a hostile name, or one close to those that the spec has.
    fn any(&mut self) -> String {
        let known = self.random.choice(&self.used).cloned();
        let hostile = HOSTILE[self.random.usize(..HOSTILE.len())].clone();
        let Some(known) = known else { return hostile };
        match self.random.u8(..16) {
            0 | 1 => known,
            2 => format!("{known}_{}", ENDINGS[self.random.usize(..ENDINGS.len())]),
            3 => format!("{known}_{hostile}"),
            4 => known.replacen('_', "", 1),
            5 => split(&known, self.random.usize(..known.len())),
            6 | 7 => {
                let other = &self.used[self.random.usize(..self.used.len())];
                format!("{known}_{other}")
            }
            _ => hostile,
        }
    }

    /// Returns a text.
    pub fn text(&mut self) -> String {
        TEXTS[self.random.usize(..TEXTS.len())].to_owned()
    }
}

/// Puts a `_` into a name.
fn split(name: &str, at: usize) -> String {
    format!("{}_{}", &name[..at], &name[at..])
}
