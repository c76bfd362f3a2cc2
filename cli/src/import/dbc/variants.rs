//! Multiplexors: which signals a message has, by their values.

use std::collections::{BTreeMap, BTreeSet};

use can_dbc::{Dbc, Message, MultiplexIndicator};

/// The frames of a message in which each multiplexor has one value.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Variant {
    /// Values of multiplexors, by the index of the signal.
    pub constants: BTreeMap<usize, u64>,
    /// The other signals, by their indices.
    pub signals: Vec<usize>,
}

/// Where a signal hangs: at nothing, or at some values of a multiplexor.
type Parent = Option<(usize, Vec<(u64, u64)>)>;

/// More messages of one identifier nobody reads.
const MOST: usize = 256;

/// Returns the variants of a message, or why they cannot be listed.
pub fn variants(dbc: &Dbc, message: &Message) -> Result<Vec<Variant>, String> {
    let parents = (0..message.signals.len()).map(|index| parent(dbc, message, index)).collect::<Result<Vec<_>, _>>()?;
    let tree = Tree { parents };
    let mut found = Vec::new();
    tree.expand(Variant::default(), tree.under(None), &mut found)?;
    Ok(found)
}

/// Returns the multiplexor of a signal, by the extended multiplexing of the file or else by the only multiplexor.
fn parent(dbc: &Dbc, message: &Message, index: usize) -> Result<Parent, String> {
    let signal = &message.signals[index];
    let position = |name: &str| message.signals.iter().position(|other| other.name == name);
    let missing = || format!("the multiplexor of `{}` is missing", signal.name);
    let mut extended = dbc.extended_multiplex.iter();
    if let Some(known) = extended.find(|known| known.message_id == message.id && known.signal_name == signal.name) {
        let values = known.mappings.iter().map(|values| (values.min_value, values.max_value)).collect();
        return Ok(Some((position(&known.multiplexor_signal_name).ok_or_else(missing)?, values)));
    }
    let value = match signal.multiplexer_indicator {
        MultiplexIndicator::MultiplexedSignal(value) | MultiplexIndicator::MultiplexorAndMultiplexedSignal(value) => {
            value
        }
        MultiplexIndicator::Multiplexor | MultiplexIndicator::Plain => return Ok(None),
    };
    let mut signals = message.signals.iter();
    let only = signals.position(|other| other.multiplexer_indicator == MultiplexIndicator::Multiplexor);
    Ok(Some((only.ok_or_else(missing)?, vec![(value, value)])))
}

fn too_many() -> String {
    format!("its multiplexors have more than {MOST} values")
}

/// What hangs where.
struct Tree {
    parents: Vec<Parent>,
}

impl Tree {
    /// Returns the signals at a value of a multiplexor, or those that hang at nothing.
    fn under(&self, at: Option<(usize, u64)>) -> Vec<usize> {
        let hangs = |parent: &Parent| match (parent, at) {
            (Some((multiplexor, values)), Some((known, value))) => {
                *multiplexor == known && values.iter().any(|(first, last)| (*first..=*last).contains(&value))
            }
            (parent, at) => parent.is_none() && at.is_none(),
        };
        self.parents.iter().enumerate().filter(|(_, parent)| hangs(parent)).map(|(index, _)| index).collect()
    }

    /// Returns the values at which a signal has others hanging.
    fn values(&self, multiplexor: usize) -> Result<BTreeSet<u64>, String> {
        let parents = self.parents.iter().flatten().filter(|(known, _)| *known == multiplexor);
        let mut found = BTreeSet::new();
        for (first, last) in parents.flat_map(|(_, values)| values) {
            found.extend((*first..=*last).take(MOST + 1));
        }
        if found.len() > MOST { Err(too_many()) } else { Ok(found) }
    }

    /// Adds to a variant what is still to be looked at, one variant for each value of a multiplexor.
    fn expand(&self, mut variant: Variant, left: Vec<usize>, found: &mut Vec<Variant>) -> Result<(), String> {
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
                let left = left.clone().chain(self.under(Some((index, value)))).collect();
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
        variants(&dbc, &dbc.messages[0]).map(|found| found.iter().map(shown).collect())
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
    }
}
