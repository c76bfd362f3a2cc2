//! Multiplexors: their values choose the signals of a message.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use can_dbc::{Message, MessageId, MultiplexIndicator, Signal};

use super::index::Index;

/// The frames of a message in which each multiplexor has one value.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Variant {
    /// Values of multiplexors, by the index of the signal.
    pub constants: BTreeMap<usize, u64>,
    /// The other signals, by their indices.
    pub signals: Vec<usize>,
}

/// What a signal depends on: nothing, or some values of a multiplexor.
type Parent = Option<(usize, Ranges)>;

/// First and last values.
type Ranges = Vec<(u64, u64)>;

/// Largest number of messages of one identifier. Nobody reads more.
const MOST: usize = 256;

/// Largest number of multiplexors. More do not fit the bits of a frame.
const DEEPEST: usize = 64;

/// Returns the variants of a message, or why they cannot be listed.
pub fn variants(index: &Index, message: &Message) -> Result<Vec<Variant>, String> {
    let mut signals = message.signals.iter();
    let places = message.signals.iter().enumerate().rev().map(|(place, signal)| (signal.name.as_str(), place));
    let context = Context {
        index,
        message: message.id,
        places: places.collect(),
        only: signals.position(|signal| signal.multiplexer_indicator == MultiplexIndicator::Multiplexor),
    };
    let mut tree = Tree::default();
    for (place, signal) in message.signals.iter().enumerate() {
        tree.add(place, context.parent(signal)?);
    }
    let mut found = Vec::new();
    tree.expand(Variant::default(), tree.free.clone(), &mut found)?;
    Ok(found)
}

/// What is needed to find the multiplexors of a message.
struct Context<'a> {
    index: &'a Index<'a>,
    message: MessageId,
    /// Places of the signals, by name.
    places: HashMap<&'a str, usize>,
    /// The only multiplexor.
    only: Option<usize>,
}

impl Context<'_> {
    /// Returns the multiplexor of a signal, from the file's extended multiplexing or else the only
    /// multiplexor.
    fn parent(&self, signal: &Signal) -> Result<Parent, String> {
        let missing = || format!("the multiplexor of `{}` is missing", signal.name);
        if let Some(known) = self.index.multiplexor(self.message, &signal.name) {
            let values = known.mappings.iter().map(|values| (values.min_value, values.max_value)).collect();
            let place = self.places.get(known.multiplexor_signal_name.as_str());
            return Ok(Some((*place.ok_or_else(missing)?, values)));
        }
        match signal.multiplexer_indicator {
            MultiplexIndicator::MultiplexedSignal(value)
            | MultiplexIndicator::MultiplexorAndMultiplexedSignal(value) => {
                Ok(Some((self.only.ok_or_else(missing)?, vec![(value, value)])))
            }
            MultiplexIndicator::Multiplexor | MultiplexIndicator::Plain => Ok(None),
        }
    }
}

fn too_many() -> String {
    format!("its multiplexors have more than {MOST} values")
}

/// Which signals depend on which multiplexor.
#[derive(Default)]
struct Tree {
    /// Signals that depend on nothing.
    free: Vec<usize>,
    /// Signals by their multiplexor, with the values that they depend on.
    below: HashMap<usize, Vec<(usize, Ranges)>>,
}

impl Tree {
    fn add(&mut self, signal: usize, parent: Parent) {
        match parent {
            None => self.free.push(signal),
            Some((multiplexor, values)) => self.below.entry(multiplexor).or_default().push((signal, values)),
        }
    }

    /// Returns the signals that depend on a multiplexor.
    fn below(&self, multiplexor: usize) -> &[(usize, Ranges)] {
        self.below.get(&multiplexor).map_or(&[], Vec::as_slice)
    }

    /// Returns the signals at a value of a multiplexor.
    fn at(&self, multiplexor: usize, value: u64) -> impl Iterator<Item = usize> {
        let hangs = move |values: &Ranges| values.iter().any(|(first, last)| (*first..=*last).contains(&value));
        self.below(multiplexor).iter().filter(move |(_, values)| hangs(values)).map(|(signal, _)| *signal)
    }

    /// Returns the values of a multiplexor that signals depend on.
    fn values(&self, multiplexor: usize) -> Result<BTreeSet<u64>, String> {
        let mut found = BTreeSet::new();
        for (first, last) in self.below(multiplexor).iter().flat_map(|(_, values)| values) {
            found.extend((*first..=*last).take(MOST + 1));
        }
        if found.len() > MOST { Err(too_many()) } else { Ok(found) }
    }

    /// Adds the signals that are left to a variant. A multiplexor makes one variant for each of its
    /// values.
    fn expand(&self, mut variant: Variant, left: Vec<usize>, found: &mut Vec<Variant>) -> Result<(), String> {
        if variant.constants.len() > DEEPEST {
            return Err(format!("more than {DEEPEST} of its multiplexors depend on each other"));
        }
        let mut left = left.into_iter();
        while let Some(index) = left.next() {
            let values = self.values(index)?;
            if values.is_empty() {
                variant.signals.push(index);
                continue;
            }
            for value in values {
                let constants = variant.constants.iter().map(|(index, value)| (*index, *value)).chain([(index, value)]);
                let variant = Variant { constants: constants.collect(), signals: variant.signals.clone() };
                let left = left.clone().chain(self.at(index, value)).collect();
                self.expand(variant, left, found)?;
            }
            return Ok(());
        }
        found.push(variant);
        if found.len() > MOST { Err(too_many()) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use can_dbc::Dbc;

    use super::*;

    /// Returns constants and signals of each variant, by name.
    fn named(signals: &str, extended: &str) -> Result<Vec<String>, String> {
        let text = format!("BO_ 1 m: 8 x\n{signals}\n{extended}");
        let dbc = Dbc::try_from(text.as_str()).expect("the DBC is right");
        let name = |index: &usize| dbc.messages[0].signals[*index].name.clone();
        let shown = |variant: &Variant| {
            let constants = variant.constants.iter().map(|(index, value)| format!("{}={value}", name(index)));
            constants.chain(variant.signals.iter().map(name)).collect::<Vec<_>>().join(" ")
        };
        variants(&Index::new(&dbc), &dbc.messages[0]).map(|found| found.iter().map(shown).collect())
    }

    fn signal(name: &str, start: u8) -> String {
        format!(" SG_ {name} : {start}|8@1+ (1,0) [0|0] \"\" y\n")
    }

    #[test]
    fn each_value_of_a_multiplexor_is_a_variant() {
        let signals = [signal("p", 0), signal("q M", 8), signal("a m0", 16), signal("b m3", 16)].concat();
        assert_eq!(named(&signals, ""), Ok(vec!["q=0 p a".to_owned(), "q=3 p b".to_owned()]));
    }

    #[test]
    fn multiplexors_below_and_beside_each_other_are_combined() {
        let signals = [signal("q M", 0), signal("r m1M", 8), signal("a m0", 16), signal("b m2", 16)].concat();
        let below = "SG_MUL_VAL_ 1 r q 1-1;\nSG_MUL_VAL_ 1 a q 0-0;\nSG_MUL_VAL_ 1 b r 2-3;";
        let expected = ["q=0 a", "q=1 r=2 b", "q=1 r=3 b"].map(str::to_owned).to_vec();
        assert_eq!(named(&signals, below), Ok(expected));
        let signals = [signal("q M", 0), signal("r M", 8), signal("a m0", 16), signal("b m2", 24)].concat();
        let beside = "SG_MUL_VAL_ 1 a q 0-1;\nSG_MUL_VAL_ 1 b r 2-2;";
        let expected = ["q=0 r=2 a b", "q=1 r=2 a b"].map(str::to_owned).to_vec();
        assert_eq!(named(&signals, beside), Ok(expected));
    }

    #[test]
    fn too_many_values_and_missing_multiplexors_are_refused() {
        let signals = [signal("q M", 0), signal("a m0", 16)].concat();
        let many = named(&signals, "SG_MUL_VAL_ 1 a q 0-4000000000;");
        assert_eq!(many, Err("its multiplexors have more than 256 values".to_owned()));
        assert_eq!(named(&signal("a m0", 16), ""), Err("the multiplexor of `a` is missing".to_owned()));
        let chain = (1..20_000).map(|at| signal(&format!("s{at} m1M"), 0)).collect::<String>();
        let below: Vec<_> = (1..20_000).map(|at| format!("SG_MUL_VAL_ 1 s{at} s{} 1-1;", at - 1)).collect();
        let deep = named(&(signal("s0 M", 0) + &chain), &below.join("\n"));
        assert_eq!(deep, Err("more than 64 of its multiplexors depend on each other".to_owned()));
    }
}
