//! Finds the name that somebody probably meant.

/// Returns the nearest of the known names, if it differs by at most a third of the letters.
pub fn nearest<'n>(name: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    let most = name.chars().count().max(3) / 3;
    let distances = known.into_iter().map(|known| (strsim::damerau_levenshtein(name, known), known));
    let near = distances.filter(|(distance, _)| *distance <= most).min_by_key(|(distance, _)| *distance);
    near.map(|(_, known)| known)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_third_of_the_letters_may_differ() {
        let known = ["temperature", "pressure", "power"];
        let meant = [("temprature", Some("temperature")), ("pwoer", Some("power")), ("perssrue", Some("pressure"))];
        for (name, expected) in meant.into_iter().chain([("flow", None), ("", None)]) {
            assert_eq!(nearest(name, known), expected, "{name}");
        }
    }

    #[test]
    fn of_two_names_the_nearer_one_is_meant() {
        assert_eq!(nearest("fan_sped", ["fan_spin", "fan_speed"]), Some("fan_speed"));
    }
}
