//! What a mistake is, and where it stands.

use std::fmt::{self, Display, Formatter};

/// A mistake that can be planted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// `Type::method`, or `module::function`.
    pub function: String,
    /// The whole function, as tokens.
    pub whole: String,
    /// What sort of mistake it is.
    pub kind: Kind,
    /// What is right, as tokens.
    pub right: String,
    /// What stands there instead.
    pub wrong: String,
}

/// The sorts of mistakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A limit belongs to the other side, or equal is unequal.
    Comparison,
    /// `and` for `or`, a lost `!`.
    Logic,
    /// Plus for minus, times for divided by, a lost sign.
    Arithmetic,
    /// Another operator on bits, a shift the other way.
    Bits,
    /// A number that is one too large.
    Number,
    /// A truth that is a lie.
    Truth,
    /// The end of a range counts, or does not.
    Range,
    /// A condition, a guard or a predicate that is turned round.
    Condition,
    /// The name of the opposite: the first for the last, the low byte first for the high byte first.
    Name,
    /// A step of a chain of calls that is left out.
    Step,
    /// Two arguments that are swapped.
    Arguments,
    /// Two arms of a `match` that are swapped.
    Arms,
    /// A statement that is left out.
    Statement,
    /// A function that returns nothing, or what it was given.
    Result,
}

impl Kind {
    /// The kinds, by the names that the lists of accepted survivors use.
    pub const ALL: [(Self, &str); 14] = [
        (Self::Comparison, "comparison"),
        (Self::Logic, "logic"),
        (Self::Arithmetic, "arithmetic"),
        (Self::Bits, "bits"),
        (Self::Number, "number"),
        (Self::Truth, "truth"),
        (Self::Range, "range"),
        (Self::Condition, "condition"),
        (Self::Name, "name"),
        (Self::Step, "step"),
        (Self::Arguments, "arguments"),
        (Self::Arms, "arms"),
        (Self::Statement, "statement"),
        (Self::Result, "result"),
    ];

    /// Returns the kind's name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(kind, _)| *kind == self).map_or("", |(_, name)| name)
    }
}

impl Display for Mistake {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let (right, wrong) = differing(&self.right, &self.wrong);
        write!(formatter, "{}: {}: {wrong} for {right}", self.function, self.kind.name())
    }
}

/// Returns what differs between two texts, with some of what stands around it.
fn differing(right: &str, wrong: &str) -> (String, String) {
    const AROUND: usize = 3;
    let (right, wrong): (Vec<_>, Vec<_>) = (right.split(' ').collect(), wrong.split(' ').collect());
    let alike = |pairs: &mut dyn Iterator<Item = (&&str, &&str)>| pairs.take_while(|(one, other)| one == other).count();
    let start = alike(&mut right.iter().zip(&wrong)).saturating_sub(AROUND);
    let end = alike(&mut right[start..].iter().rev().zip(wrong[start..].iter().rev())).saturating_sub(AROUND);
    (quoted(&right[start..right.len() - end]), quoted(&wrong[start..wrong.len() - end]))
}

/// Cuts a text that is too long for a line.
fn quoted(words: &[&str]) -> String {
    const LETTERS: usize = 60;
    let text = words.join(" ").replace('\n', " ");
    let cut: String = text.chars().take(LETTERS).collect();
    match text.as_str() {
        "" => "nothing".to_owned(),
        _ if cut.len() < text.len() => format!("`{cut}...`"),
        _ => format!("`{text}`"),
    }
}
