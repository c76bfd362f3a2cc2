//! Which access a request has.

use std::env;

use crate::failure::Failure;

/// Refuses a request that several accesses can make, and shows the call with the first of them.
pub fn refuse_several(message: &str, accesses: &[&str]) -> Result<(), Failure> {
    let [first, _, ..] = accesses else { return Ok(()) };
    let known: Vec<_> = accesses.iter().map(|access| format!("`{access}`")).collect();
    let words: Vec<_> = env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
    let call = with_access(words, first, message);
    Err(Failure::Call(format!("{message}: say which access, {}, before the message:\n  {call}", known.join(" or "))))
}

/// Returns the call with an access before the message, for a shell.
fn with_access(mut words: Vec<String>, access: &str, message: &str) -> String {
    let place = words.iter().rposition(|word| word == message).unwrap_or(words.len());
    words.insert(place, access.to_owned());
    let words = words.iter().map(|word| format!(" {}", quoted(word)));
    format!("canspec{}", words.collect::<String>())
}

/// Quotes a word in which a shell would see more than letters.
fn quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "_-./:=,@%+".contains(letter);
    let stays = !word.is_empty() && word.chars().all(is_plain);
    if stays { word.to_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::with_access;

    #[test]
    fn a_shell_reads_the_shown_call_as_it_was_made() {
        let words = ["encode", "--spec", "my pump's.yaml", "limit", "--to", "module:3", "value=7 °C", "a=$b", "c="];
        let call = with_access(words.map(str::to_owned).to_vec(), "write", "limit");
        let shown = r"canspec encode --spec 'my pump'\''s.yaml' write limit --to module:3 'value=7 °C' 'a=$b' c=";
        assert_eq!(call, shown);
    }

    #[test]
    fn the_access_stands_before_the_message_and_not_before_a_protocol_of_its_name() {
        let call = with_access(["encode", "--protocol", "pump", "pump"].map(str::to_owned).to_vec(), "read", "pump");
        assert_eq!(call, "canspec encode --protocol pump read pump");
    }
}
