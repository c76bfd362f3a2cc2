#![doc = include_str!("../rules/direction.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{AddressPattern, FieldTest, IdentifierField, Mode, Protocol};
use crate::syntax::tree::Path;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let pairs =
        protocol.to_module.any.iter().flat_map(|one| protocol.to_controller.any.iter().map(move |other| (one, other)));
    for (one, other) in pairs {
        if !one.iter().any(|test| other.iter().any(|opposite| excludes(test, opposite) || excludes(opposite, test))) {
            report(protocol, diagnostics);
            return;
        }
    }
}

/// Names the patterns that lack the constant by which the others show their direction, or all of them.
fn report(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let text = "nothing in the identifier tells a request from a reply";
    let patterns = patterns(protocol);
    let fields = protocol.identifier.fields.iter();
    let nearly = fields.filter(|field| tells(&patterns, field.mask()));
    let lacking = |field: &&IdentifierField| patterns.iter().filter(|known| !known.has(field.mask())).count();
    let Some(field) = nearly.min_by_key(lacking) else {
        let help = "give the controller's address type `outside: refused`, \
                    or one field a constant in `request` and another in the replies";
        let at = Path::default().key("addressing").at_key();
        diagnostics.push(Diagnostic::error("direction", at, text).help(help));
        return;
    };
    for known in patterns.iter().filter(|known| !known.has(field.mask())) {
        let text = format!("{text}: `{}` of `{}` has no constant in `{}`", known.key, known.mode.name, field.name);
        let help = format!("give `{}` a constant here, as the other patterns have", field.name);
        let at = known.mode.doc.path.key(known.key).at_key();
        diagnostics.push(Diagnostic::error("direction", at, text).help(help));
    }
}

/// A pattern of an addressing mode and the key it stands under.
struct Known<'a> {
    mode: &'a Mode,
    key: &'static str,
    pattern: &'a AddressPattern,
}

impl Known<'_> {
    /// Tests whether the pattern has a constant in a field.
    fn has(&self, field: u32) -> bool {
        self.pattern.mask & field != 0
    }
}

fn patterns(protocol: &Protocol) -> Vec<Known<'_>> {
    protocol.modes.iter().flat_map(patterns_of).collect()
}

fn patterns_of(mode: &Mode) -> impl Iterator<Item = Known<'_>> {
    let Mode { request, one, each, coordinator, .. } = mode;
    let keys = [("request", request), ("one", one), ("each", each), ("coordinator", coordinator)];
    keys.into_iter().filter_map(move |(key, pattern)| Some(Known { mode, key, pattern: pattern.as_ref()? }))
}

/// Tests whether requests and replies that have a constant in the field have different ones.
fn tells(patterns: &[Known], field: u32) -> bool {
    let having = patterns.iter().filter(|known| known.has(field));
    let (requests, replies): (Vec<_>, Vec<_>) = having.partition(|known| known.key == "request");
    let pairs = || requests.iter().flat_map(|one| replies.iter().map(move |other| (one.pattern, other.pattern)));
    pairs().next().is_some() && pairs().all(|(one, other)| (one.value ^ other.value) & field != 0)
}

/// Tests whether no value passes both tests of one field.
fn excludes(one: &FieldTest, other: &FieldTest) -> bool {
    let apart = |(first, last): &(u32, u32), (start, end): &(u32, u32)| last < start || end < first;
    let contains = |(first, last): &(u32, u32), (start, end): &(u32, u32)| first <= start && end <= last;
    one.field == other.field
        && one.inside
        && one.ranges.iter().all(|range| {
            if other.inside {
                other.ranges.iter().all(|opposite| apart(range, opposite))
            } else {
                other.ranges.iter().any(|opposite| contains(opposite, range))
            }
        })
}
