//! Takes arrays apart: what is given for an array becomes what is given for its elements.

use std::borrow::Cow;

use super::refusal::{refuse, twice};
use super::{Content, Refusal};
use crate::model::{Array, Message};

/// Returns the content with the values of arrays among those of the signals.
pub fn parted<'a>(message: &Message, content: &'a Content) -> Result<Cow<'a, Content>, Refusal> {
    if content.arrays.is_empty() {
        return Ok(Cow::Borrowed(content));
    }
    let mut whole = Content { arrays: Vec::new(), ..content.clone() };
    for (name, values) in &content.arrays {
        let array = message.array(name).ok_or_else(|| refuse(message, &format!("there is no array `{name}`")))?;
        let elements = elements(message, array, values.len())?;
        let given = elements.zip(values).filter_map(|(name, value)| Some((name, value.clone()?)));
        whole.signals.extend(given);
    }
    match twice(&whole.signals) {
        Some(name) => Err(refuse(message, &format!("the signal `{name}` is given twice"))),
        None => Ok(Cow::Owned(whole)),
    }
}

/// Parts the texts of arrays, as in `voltage=3.3V,3.2V`.
pub fn parted_texts(message: &Message, given: &[(String, String)]) -> Result<Vec<(String, String)>, Refusal> {
    let mut whole = Vec::new();
    for (name, text) in given {
        match message.array(name) {
            None => whole.push((name.clone(), text.clone())),
            Some(array) => {
                let values = values(text);
                let elements = elements(message, array, values.len())?;
                whole.extend(elements.zip(values.into_iter().map(str::to_owned)));
            }
        }
    }
    Ok(whole)
}

/// Returns the names of the first elements of an array, one for each value, if it has that many.
fn elements<'a>(
    message: &'a Message,
    array: &'a Array,
    values: usize,
) -> Result<impl Iterator<Item = String> + use<'a>, Refusal> {
    let Array { name, elements, .. } = array;
    if values > elements.len() {
        let text = format!("`{name}` has {} elements, and {values} values are given", elements.len());
        return Err(refuse(message, &text));
    }
    Ok(elements.iter().map(|id| message[*id].name.clone()))
}

/// Parts a text at its commas, but not at those in brackets.
fn values(text: &str) -> Vec<&str> {
    let mut depth = 0_u32;
    let is_between = |letter: char| {
        match letter {
            '[' => depth += 1,
            ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        letter == ',' && depth == 0
    };
    text.split(is_between).map(str::trim).collect()
}
