//! Reads which quantity a name or a title means.

/// What is measured, and its units. A percentage can be one of any quantity.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Quantity {
    pub name: &'static str,
    pub units: &'static [&'static str],
}

/// What words say.
#[derive(Clone, Copy)]
pub enum Reading {
    Of(Quantity),
    /// There is no word of a quantity.
    Unknown,
    /// There is one, but the text may mean something else.
    Unclear,
}

const VOLTAGE: Quantity = Quantity { name: "a voltage", units: &["V"] };
const CURRENT: Quantity = Quantity { name: "a current", units: &["A"] };
const POWER: Quantity = Quantity { name: "a power", units: &["W", "VA", "var"] };
const TEMPERATURE: Quantity = Quantity { name: "a temperature", units: &["°C", "K"] };
const FREQUENCY: Quantity = Quantity { name: "a frequency", units: &["Hz"] };
const SPEED: Quantity = Quantity { name: "a speed", units: &["rpm", "Hz"] };
const TIME: Quantity = Quantity { name: "a time", units: &["s", "ms", "min", "h"] };
const PERCENTAGE: Quantity = Quantity { name: "a percentage", units: &["%"] };
const LENGTH: Quantity = Quantity { name: "a length", units: &["m"] };
const ENERGY: Quantity = Quantity { name: "an energy", units: &["Wh"] };
const CHARGE: Quantity = Quantity { name: "a charge or an energy", units: &["Ah", "Wh"] };
const RESISTANCE: Quantity = Quantity { name: "a resistance", units: &["Ω"] };
const PRESSURE: Quantity = Quantity { name: "a pressure", units: &["Pa"] };

/// Words and their quantities.
const QUANTITIES: [(&[&str], Quantity); 13] = [
    (&["voltage", "volts", "overvoltage", "undervoltage"], VOLTAGE),
    (&["current", "amperes", "amps", "overcurrent"], CURRENT),
    (&["power", "watts"], POWER),
    (&["temperature", "degrees", "overtemperature", "undertemperature"], TEMPERATURE),
    (&["frequency", "hertz"], FREQUENCY),
    (&["speed"], SPEED),
    (&["time", "interval", "duration", "delay", "timeout", "seconds", "minutes", "hours"], TIME),
    (&["percent", "percentage"], PERCENTAGE),
    (&["altitude", "height", "distance", "metres", "meters"], LENGTH),
    (&["energy"], ENERGY),
    (&["capacity"], CHARGE),
    (&["resistance", "ohms"], RESISTANCE),
    (&["pressure"], PRESSURE),
];

/// Words that do not change the quantity before them.
const ATTRIBUTES: &str = "actual average default high highest in level limit limits low lower lowest max maximum min minimum \
    nominal out peak point rated reading reference ripple set setting setpoint threshold total upper value";

/// Words after which the text is about something else.
const PREPOSITIONS: &str =
    "after as at before between by during for from inside of since that to until when which with within";

/// Reads the last word of a quantity. The result is unclear if the word only describes what
/// follows, or if there are two things.
pub fn read(text: &str) -> Reading {
    let lower = text.to_lowercase();
    let clause = lower.split(['(', ',', ';', ':']).next().unwrap_or_default();
    let words: Vec<_> = clause.split(|letter: char| !letter.is_alphabetic()).filter(|word| !word.is_empty()).collect();
    let phrase = words.split(|word| has(PREPOSITIONS, word)).next().unwrap_or_default();
    let last = phrase.iter().enumerate().rev().find_map(|(at, word)| Some((at, quantity(word)?)));
    match last {
        None => Reading::Unknown,
        Some(_) if phrase.iter().any(|word| has("and or", word)) => Reading::Unclear,
        Some((at, quantity)) if keeps(quantity, at, &phrase[at + 1..]) => Reading::Of(quantity),
        Some(_) => Reading::Unclear,
    }
}

fn quantity(word: &str) -> Option<Quantity> {
    let (_, quantity) = QUANTITIES.iter().find(|(words, _)| words.contains(&word))?;
    Some(*quantity)
}

/// Tests whether the words after a quantity keep its meaning. A `current value` may be the present
/// value of anything.
fn keeps(quantity: Quantity, at: usize, after: &[&str]) -> bool {
    let is_of_now = quantity == CURRENT && at == 0;
    after
        .iter()
        .all(|word| word.len() == 1 || if is_of_now { word.starts_with("limit") } else { has(ATTRIBUTES, word) })
}

fn has(list: &str, word: &str) -> bool {
    list.split_whitespace().any(|known| known == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_word_of_a_quantity_decides() {
        for (text, name) in [
            ("current_limit", "a current"),
            ("Voltage ripple", "a voltage"),
            ("power_on_time", "a time"),
            ("walk_in_time", "a time"),
            ("minimum_voltage_from_2017_02", "a voltage"),
            ("Speed of the fan at full current", "a speed"),
            ("Output current (the voltage is fixed)", "a current"),
            ("phase_voltage_a", "a voltage"),
        ] {
            assert!(matches!(read(text), Reading::Of(quantity) if quantity.name == name), "{text}");
        }
    }

    #[test]
    fn a_word_that_describes_another_is_unclear() {
        for text in ["current_mode", "power_factor", "voltage_imbalance", "current_value", "Current and speed"] {
            assert!(matches!(read(text), Reading::Unclear), "{text}");
        }
    }

    #[test]
    fn other_words_say_nothing() {
        for text in ["", "count", "Share of the current", "Rise of the output current"] {
            assert!(matches!(read(text), Reading::Unknown), "{text}");
        }
    }
}
