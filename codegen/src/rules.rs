//! The rules that a spec must keep, by id.

/// A rule that a spec must keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Id of the rule, as diagnostics show it.
    pub name: &'static str,
    /// What breaks it.
    pub summary: &'static str,
}

/// Every rule, in the order of the stages.
pub const RULES: [Rule; 43] = [
    rule("file", "the file cannot be read"),
    rule("encoding", "the text is not UTF-8, or holds a character that has no place in a spec"),
    rule("yaml", "the text is not YAML, or uses a part of YAML that a spec does without"),
    rule("plain_word", "a word such as `on` or `null`, which readers of YAML take for different things, is not quoted"),
    rule("duplicate_key", "a key stands twice in one map"),
    rule("unknown_key", "a key does not exist in this place"),
    rule("misplaced_key", "a key means nothing where it stands"),
    rule("missing_key", "a key that has to be there is not"),
    rule("wrong_kind", "a text, a list or a map stands where another of the three belongs"),
    rule("version", "the spec is written in another version of the language"),
    rule("identifier_name", "a name is not made of lower-case letters, digits and `_`"),
    rule("name", "something is named that does not exist"),
    rule("number", "a text is not a number, or the number is too large or too small"),
    rule("range", "a text is not a range of numbers, or the range runs backwards"),
    rule("unit", "a unit is missing, or is not one of the language"),
    rule("place", "a field has no place, two places, or one that runs backwards"),
    rule("identifier_layout", "the fields of the identifier leave a gap, share bits, or do not fill 11 or 29 bits"),
    rule("type", "keys of a field or of its types contradict each other"),
    rule("format", "the text form of a packed value does not fit its parts"),
    rule("unused_type", "nothing uses a type"),
    rule("named_value", "two named values share a raw value or a name"),
    rule("value_width", "a named raw value does not fit the bits of its field"),
    rule("status_bit", "one bit of a status word has two names"),
    rule("value", "a physical value has no raw value: wrong unit, between two steps, or too large"),
    rule("addressing", "an addressing mode or address type cannot be used as it is written"),
    rule("access", "an access has no frames, or speaks of frames that it does not have"),
    rule("match", "one frame would need two values in one field"),
    rule("example", "a frame of the document does not mean what the spec says, or does not encode back"),
    rule("outside_frame", "a signal reaches beyond the data bytes of its message"),
    rule("overlap", "two signals of one frame share bits"),
    rule("grid", "a scale cannot be computed exactly"),
    rule("range_width", "a range exceeds what the raw value can hold"),
    rule("model_range", "a device model has limits beyond the general ones, or limits that never count"),
    rule("special_value", "a special value lies inside the range"),
    rule("default_value", "a default lies outside the range"),
    rule("direction", "an identifier does not show whether it is a request or a reply"),
    rule("ambiguous", "one frame fits two messages, or two accesses of one message"),
    rule("refusal", "a refusal is also a reply, or is the reply of no message"),
    rule("rust_name", "a name cannot be used in Rust, or two names become one"),
    rule("erratum", "an erratum is referred to but not there, or there but not referred to"),
    rule("section", "an item does not say where it stands in the document"),
    rule("reply", "an example does not answer the request before it"),
    rule("expected_failure", "an example does not fail as stated"),
];

const fn rule(name: &'static str, summary: &'static str) -> Rule {
    Rule { name, summary }
}
