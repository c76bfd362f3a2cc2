//! The one table of a field's keys: each row says what is read, and whether a type passes it on.
//!
//! All else about a key stands in a `match` that names every [`Key`]. `resolve/keys.rs` says who
//! reads the key, and `reference/schema/values.rs` which values it takes.

use indexmap::IndexMap;
use serde::Deserialize;

use super::{Map, NamedValue, Names, Pattern, StatusBit, ValueExample, Words};

/// What stands after a key. It can be missing.
trait Entry: Clone {
    /// Whether it can be written and yet say nothing.
    const CAN_BE_EMPTY: bool;

    fn is_written(&self) -> bool;
}

/// An empty map says that something is there without a name.
impl<V: Clone> Entry for Option<V> {
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
        /// A named bit range with a meaning. It is in the identifier, the header, a message or a
        /// word, or is a type.
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
    /// `2` a single byte. A field has either `bytes` or `bits`. A text of a message in several frames can have more than
    /// eight bytes, and `12..` is one that ends where the message ends.
    Bytes "bytes": bytes: Option<String>, inherited;
    /// Bits of the identifier, or of the word around the field: `31..16`, or `7` for a single bit.
    /// The most significant bit comes first, and bit 0 is the least significant.
    Bits "bits": bits: Option<String>, inherited;
    /// How many equal fields stand in a row, from `2` to `32`; one if absent. They are an array,
    /// and the place is that of its first element.
    Repeat "repeat": repeat: Option<String>, inherited;
    /// How far the next element of an array is, in bytes after `bytes` and in bits after `bits`:
    /// `4`. If absent, the elements have no gap between them.
    Step "step": step: Option<String>, inherited;
    /// Number in the name of an array's first element, `0` for `cell_0`; 1 if absent.
    First "first": first: Option<String>, inherited;
    /// Entry of `types`, or a list of them: `real` or `[real, volts]`; none if absent. The field
    /// takes from them the keys that it does not have itself. In a list the last one wins.
    Type "type": types: Names, own;
    /// Number format: `unsigned`, `signed`, `bcd`, `float`, `text` or `bytes`; `unsigned` if absent.
    /// `signed` is two's complement. `bcd` has decimal digits of four bits each. `float` is IEEE
    /// 754 in 32 bits, `text` is ASCII in whole bytes, and `bytes` are raw ones in hexadecimal.
    As "as": format_of_number: Option<String>, inherited;
    /// Byte that fills up a text, `0` to `255`: `0x20` for blanks; 0 if absent. It is cut off at the
    /// end of a text that is received.
    Fill "fill": fill: Option<String>, inherited;
    /// Size of one raw step in the field's unit, exact: `1/10` or `0.02`; 1 if absent. The physical
    /// value is raw x scale + offset. The scale of an address is 1 or -1.
    Scale "scale": scale: Option<String>, inherited;
    /// Physical value of raw 0 in the field's unit, exact: `-40` or `0xFD`; 0 if absent.
    Offset "offset": offset: Option<String>, inherited;
    /// Unit of the physical value; none if absent. It is one of `V`, `A`, `W`, `VA`, `var`, `Ah`,
    /// `Wh`, `Ω`, `Hz`, `°C`, `K`, `Pa`, `%`, `s`, `ms`, `min`, `h`, `rpm` and `m`. The protocol's `units` are others.
    Unit "unit": unit: Option<String>, inherited;
    /// Lowest and highest physical value in the field's unit, both allowed: `41.5..58.5`. The unit
    /// may follow, also with a prefix: `0.2..0.75 kV`. If absent, all that the bits hold is allowed. An
    /// address type has it, with the addresses that the document names, `0x00..0x3B`, or else `values`.
    Range "range": range: Option<String>, inherited;
    /// Names of raw values, before scale and offset: `{0: standby, 1: running}`; none if absent.
    /// Beside `unit`, `scale`, `offset` or `range` these are special values, and lie outside the
    /// range. Of an address type they are the only numbers that the document names:
    /// `{0x20: gprs, 0x40: upper_computer}`. A name that only some device models have is a map:
    /// `{3: {name: boost, models: [V1_3]}}`.
    Values "values": values: Map<NamedValue>, inherited;
    /// What stands for a value that the device does not have: `ones` or `none`; the protocol's
    /// `absent` if absent. `ones` are bits that are all 1, and the greatest signed number.
    Absent "absent": absent: Option<String>, inherited;
    /// The parts of a word, or of a text with a `format`, by name:
    /// `{mode: {bits: 7..4}, stage: {bits: 3..0}}`; none if absent.
    Fields "fields": fields: Map<Field>, inherited;
    /// Bits of a status word by name, in place of `fields`: `{fan_fault: {bit: 3, severity: fault}}`; none if absent.
    /// `{}` is a word whose bits have no names.
    Status "status": status: Option<Map<StatusBit>>, inherited;
    /// Text of a packed value, with its parts in braces: `"{letter}-{number:4}"`; none if absent. A
    /// part can state its least number of digits after a colon.
    Format "format": format: Option<String>, inherited;
    /// Raw value that is always sent and required: `0x1205`; none if absent. Another value means
    /// another protocol if the field is in the identifier, and another message if it is in a
    /// message.
    Const "const": constant: Option<String>, inherited;
    /// What is sent unless the caller chooses another value: `0xF0`. It is the raw value of a field
    /// of the identifier, or a number of an address type. If absent, the field is 0, and the caller
    /// chooses the address.
    Send "send": send: Option<String>, inherited;
    /// Raw value that a field of the identifier or the header has if the reply reports no error:
    /// `0`; none if absent. Any other value gets the note `error_code`.
    Normal "normal": normal: Option<String>, inherited;
    /// Raw value that a field with `normal` has in replies while the device starts, or is busy with itself: `7`;
    /// none if absent. It can be asked later.
    Starting "starting": starting: Option<String>, inherited;
    /// Raw value of a field of the identifier or the header if more frames of a set follow: `1`;
    /// none if absent. With any other value the frame is the last one. Only one field of a protocol
    /// has this key.
    Continues "continues": continues: Option<String>, inherited;
    /// Value that the device starts with, a name or a number without its unit: `60` or `automatic`;
    /// none if absent. It is sent if the caller leaves the signal out.
    Default "default": default: Option<String>, inherited;
    /// What a device does with a value outside the range: `refused`, `ignored` or `limited`; not said if absent. A
    /// refused request is answered by an error. An ignored value leaves the one before it in effect, and the nearest
    /// one inside is taken for a limited one.
    OutOfRange "out_of_range": out_of_range: Option<String>, inherited;
    /// What becomes of a value without power: `kept` or `lost`; not said if absent.
    PowerOff "power_off": power_off: Option<String>, inherited;
    /// What to do with a number that an address type does not name: with `refused` it is not
    /// such an address. If absent, it is accepted with the note `address`.
    Outside "outside": outside: Option<String>, inherited;
    /// Raw values that fields of the identifier and the header have in every reply of a message with this field:
    /// `{result_type: 0x41}`; none if absent.
    Reply "reply": reply: Pattern, inherited;
    /// The only kinds of frames that have the field, out of `request`, `reply` and `report`:
    /// `[request]`. If absent, the access says it.
    In "in": kinds: Vec<String>, inherited;
    /// List of the only device models that have the field: `[SM_750]`; if absent, every model that has
    /// the message.
    Models "models": models: Vec<String>, inherited;
    /// Bytes and what they mean: `[{bytes: 43FA0000, means: 500}]`; none if absent. Only an entry
    /// of `types` has them.
    Examples "examples": examples: Vec<ValueExample>, own;
    /// What it is, in a few words without a full stop: `Output voltage`; that of its type if
    /// absent.
    Title "title": title: Option<Words>, inherited;
    /// What else a reader must know, in one sentence: `0 until a group has been set`.
    Note "note": note: Option<Words>, own;
    /// Section of the document that says so, in quotes: `"2.4"`; if absent, that of the item around it.
    Section "section": section: Option<Words>, own;
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    Erratum "erratum": erratum: Names, own;
}
