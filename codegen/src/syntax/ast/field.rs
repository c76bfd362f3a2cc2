//! The one table of a field's keys: each row says what is read, and whether a type passes it on.
//!
//! Whatever else is true of a key is a `match` that names every [`Key`]. `resolve/keys.rs` says who reads it, and
//! `schema/values.rs` which values it takes.

use indexmap::IndexMap;
use serde::Deserialize;

use super::{Map, Names, Pattern, StatusBit, ValueExample};

/// What can stand after a key, or be missing.
trait Entry: Clone {
    /// Whether it can be written and yet say nothing.
    const CAN_BE_EMPTY: bool;

    fn is_written(&self) -> bool;
}

impl Entry for Option<String> {
    const CAN_BE_EMPTY: bool = false;

    fn is_written(&self) -> bool {
        self.is_some()
    }
}

impl<V: Clone> Entry for IndexMap<String, V> {
    const CAN_BE_EMPTY: bool = true;

    fn is_written(&self) -> bool {
        !self.is_empty()
    }
}

impl<V: Clone> Entry for Vec<V> {
    const CAN_BE_EMPTY: bool = true;

    fn is_written(&self) -> bool {
        !self.is_empty()
    }
}

impl Entry for Names {
    const CAN_BE_EMPTY: bool = true;

    fn is_written(&self) -> bool {
        !self.0.is_empty()
    }
}

macro_rules! keys {
    ($($(#[$doc:meta])* $key:ident $name:literal: $field:ident: $kind:ty, $passing:ident;)*) => {
        /// A named bit range with a meaning: in the identifier, the header, a message, a word, or a type to take keys from.
        #[derive(Clone, Debug, Default, Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[serde(deny_unknown_fields)]
        pub struct Field {
            $($(#[$doc])* #[serde(rename = $name, default)] pub $field: $kind,)*
        }

        /// A key of a field.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Key {
            $(#[doc = concat!("The key `", $name, "`.")] $key,)*
        }

        impl Key {
            /// Every key, in the order of the language reference.
            pub const ALL: &[Self] = &[$(Self::$key,)*];

            /// Returns the key as it is written.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$key => $name,)*
                }
            }

            /// Tells whether what stands after the key is a map or a list, which can be empty.
            pub const fn can_be_empty(self) -> bool {
                match self {
                    $(Self::$key => <$kind as Entry>::CAN_BE_EMPTY,)*
                }
            }
        }

        impl From<Key> for String {
            fn from(key: Key) -> Self {
                key.name().to_owned()
            }
        }

        impl Field {
            /// Returns the keys that it writes.
            pub fn keys(&self) -> impl Iterator<Item = Key> + use<> {
                let keys = [$(self.$field.is_written().then_some(Key::$key),)*];
                keys.into_iter().flatten()
            }

            /// Takes from a type the keys that it does not have itself.
            pub fn inherit(&mut self, from: &Self) {
                $(keys!(@$passing self from $field);)*
            }
        }
    };
    (@inherited $self:ident $from:ident $field:ident) => {
        if !$self.$field.is_written() {
            $self.$field.clone_from(&$from.$field);
        }
    };
    (@own $self:ident $from:ident $field:ident) => {};
}

keys! {
    /// Bytes of the frame, 0 to 7, from the most to the least significant: `0..3` is big-endian, `7..4` little-endian,
    /// `2` a single byte. A field has either `bytes` or `bits`.
    Bytes "bytes": bytes: Option<String>, inherited;
    /// Bits of the identifier or of the word around the field, from the most to the least significant, which is 0:
    /// `31..16`, or `7` for a single bit.
    Bits "bits": bits: Option<String>, inherited;
    /// Entry of `types`, or a list of them, from which the field takes the keys that it does not have itself: `real` or
    /// `[real, volts]`, where the last one wins; none if absent.
    Type "type": types: Names, own;
    /// Number format: `unsigned`, `signed` (two's complement), `bcd` (decimal digits of four bits each), `float`
    /// (IEEE 754 in 32 bits) or `text` (ASCII in whole bytes); `unsigned` if absent.
    As "as": format_of_number: Option<String>, inherited;
    /// Step of the raw value in the field's unit, exact: `1/10` or `0.02`; 1 if absent. The physical value is raw x
    /// scale + offset; an address has a scale of 1 or -1.
    Scale "scale": scale: Option<String>, inherited;
    /// Physical value of raw 0 in the field's unit, exact: `-40` or `0xFD`; 0 if absent.
    Offset "offset": offset: Option<String>, inherited;
    /// Unit of the physical value: `V`, `A`, `W`, `Hz`, `°C`, `%`, `s`, `ms`, `min`, `h`, `rpm` or `m`; none if absent.
    Unit "unit": unit: Option<String>, inherited;
    /// Lowest and highest physical value in the field's unit, both allowed: `41.5..58.5`; all that the bits hold if
    /// absent. An address type must have it, with the addresses that the document names: `0x00..0x3B`.
    Range "range": range: Option<String>, inherited;
    /// Names of raw values, before scale and offset: `{0: standby, 1: running}`; none if absent. Beside `unit`,
    /// `scale`, `offset` or `range` they are special values, which lie outside the range.
    Values "values": values: Map<String>, inherited;
    /// Fields by name that are the parts of a word, or of a text with a `format`:
    /// `{mode: {bits: 7..4}, stage: {bits: 3..0}}`; none if absent.
    Fields "fields": fields: Map<Field>, inherited;
    /// Bits of a status word by name, in place of `fields`: `{fan_fault: {bit: 3, severity: fault}}`; none if absent.
    Status "status": status: Map<StatusBit>, inherited;
    /// Text of a packed value: the names of its parts in braces, and behind a colon the least digits of a number:
    /// `"{letter}-{number:4}"`; none if absent.
    Format "format": format: Option<String>, inherited;
    /// Raw value that is always sent and required: `0x1205`; none if absent. Another value in the identifier is another
    /// protocol, in a message it is another message.
    Const "const": constant: Option<String>, inherited;
    /// Raw value of a field of the identifier, or number of an address type, that is sent unless the caller chooses
    /// another: `0xF0`. If absent, the field is 0 and the address the caller's to choose.
    Send "send": send: Option<String>, inherited;
    /// Raw value of a reply that is no error reply, in a field of the identifier or the header: `0`; none if absent.
    /// Any other value gets the note `error_code`.
    Normal "normal": normal: Option<String>, inherited;
    /// Raw value of a field of the identifier or the header that says that more frames of a set follow: `1`; any other
    /// value says that this one is the last. None if absent; only one field of a protocol has it.
    Continues "continues": continues: Option<String>, inherited;
    /// Physical value without its unit, or name, that the device starts with and that stands for a signal left out:
    /// `60` or `automatic`; none if absent.
    Default "default": default: Option<String>, inherited;
    /// What a number outside the `range` of an address type is: with `refused` something else than such an address. If
    /// absent, it is accepted with the note `address`.
    Outside "outside": outside: Option<String>, inherited;
    /// Raw values that fields of the identifier and the header have in every reply of a message with this field:
    /// `{result_type: 0x41}`; none if absent.
    Reply "reply": reply: Pattern, inherited;
    /// The only kinds of frames that have the field, of `request`, `reply` and `report`: `[request]`; if absent, those
    /// that the access says.
    In "in": kinds: Vec<String>, inherited;
    /// Bytes and what they mean, in an entry of `types` only: `[{bytes: 43FA0000, means: 500}]`; none if absent.
    Examples "examples": examples: Vec<ValueExample>, own;
    /// What it is, in a few words without a full stop: `Output voltage`; if absent, what its type says.
    Title "title": title: Option<String>, inherited;
    /// What else a reader must know, in one sentence: `0 until a group has been set`.
    Note "note": note: Option<String>, own;
    /// Section of the document that says so, in quotes: `"2.4"`; if absent, that of the item around it.
    Section "section": section: Option<String>, own;
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    Erratum "erratum": erratum: Names, own;
}
