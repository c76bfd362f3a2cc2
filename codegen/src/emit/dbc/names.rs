//! Names that are unique, and not longer than other tools allow.

use std::collections::BTreeSet;

/// Returns a name that is not yet taken, and takes it.
pub fn unique(wanted: &str, taken: &mut BTreeSet<String>) -> String {
    let numbered = (2..).map(|number| format!("{wanted}_{number}"));
    let mut free = std::iter::once(wanted.to_owned()).chain(numbered).skip_while(|name| taken.contains(name));
    let name = free.next().unwrap_or_default();
    taken.insert(name.clone());
    name
}

/// Shortens the names that are longer than `longest`, with a number at their end.
pub fn short<'a>(names: impl Iterator<Item = &'a str> + Clone, longest: usize) -> Vec<String> {
    let mut taken: BTreeSet<String> = names.clone().filter(|name| name.len() <= longest).map(str::to_owned).collect();
    let shortened = |name: &str| match name.get(..longest.saturating_sub(4)).filter(|_| name.len() > longest) {
        Some(start) => unique(start.trim_end_matches('_'), &mut taken),
        None => name.to_owned(),
    };
    names.map(shortened).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_are_cut_stay_apart() {
        let names = ["pressure_of_oil", "pressure", "pressure_of_air", "oil"];
        assert_eq!(short(names.into_iter(), 12), ["pressure_2", "pressure", "pressure_3", "oil"]);
    }
}
