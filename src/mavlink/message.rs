//! Messages: their table, and a type for each with its encoding and decoding.

mod table;

pub use table::*;

use super::crc;
use super::wire::Field;

/// The way of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From the craft to the ground station.
    Down,
    /// From the ground station to the craft.
    Up,
    /// Both ways.
    Both,
}

/// A row of the table of messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MessageInfo {
    /// The number of the message.
    pub id: u32,
    /// The name in message definitions.
    pub name: &'static str,
    /// One sentence about the message.
    pub summary: &'static str,
    /// The way of the message.
    pub direction: Direction,
    /// The byte that is added to the checksum. It follows from the names and types of the fields.
    pub crc_extra: u8,
    /// The length of the payload in version 1, which has no extension fields, bytes.
    pub base_length: usize,
    /// The length of the whole payload with extension fields, bytes.
    pub length: usize,
}

impl MessageInfo {
    /// Returns the row of a message.
    pub fn find(id: u32) -> Option<&'static Self> {
        TABLE.binary_search_by_key(&id, |info| info.id).ok().and_then(|at| TABLE.get(at))
    }
}

/// Returns the table of messages, in the order of their numbers.
pub fn table() -> &'static [MessageInfo] {
    TABLE
}

/// A field as the checksum sees it.
struct Checked {
    kind: &'static str,
    name: &'static str,
    elements: u8,
    fields: u8,
}

impl Checked {
    const fn of<T: Field>(name: &'static str) -> Self {
        Self { kind: T::TYPE, name, elements: T::ELEMENTS, fields: T::FIELDS }
    }
}

/// Returns the checksum byte of a definition: its name, and the type, name and number of elements of each field in the
/// order of the wire, without extension fields.
const fn crc_extra(name: &str, fields: &[Checked]) -> u8 {
    let mut sum = crc::with_byte(crc::with_bytes(crc::START, name.as_bytes()), b' ');
    let mut at = 0;
    while at < fields.len() {
        let Checked { kind, name, elements, fields: numbered } = fields[at];
        // A field without a number counts as number 0.
        let mut number = (numbered > 0) as u8;
        while number <= numbered {
            sum = crc::with_byte(crc::with_bytes(sum, kind.as_bytes()), b' ');
            sum = crc::with_byte(with_name(sum, name.as_bytes(), number), b' ');
            number += 1;
        }
        if elements > 0 {
            sum = crc::with_byte(sum, elements);
        }
        at += 1;
    }
    sum as u8 ^ (sum >> 8) as u8
}

/// Returns the checksum after the name of a field, without the mark of a raw identifier, with a number from 1 before the
/// first `_`.
const fn with_name(mut sum: u16, name: &[u8], mut number: u8) -> u16 {
    let mut at = if let [b'r', b'#', ..] = name { 2 } else { 0 };
    while at < name.len() {
        if name[at] == b'_' && number > 0 {
            if number >= 10 {
                sum = crc::with_byte(sum, b'0' + number / 10);
            }
            sum = crc::with_byte(sum, b'0' + number % 10);
            number = 0;
        }
        sum = crc::with_byte(sum, name[at]);
        at += 1;
    }
    sum
}

/// Defines the messages. A row has the number, the name in definitions, the name of the type, the direction, a summary, the
/// fields in the order of the wire with their units, and the extension fields.
macro_rules! messages {
    ($($id:literal $wire:ident $name:ident $direction:ident $summary:literal
        { $($field:ident : $kind:ty $([$unit:literal])?),* $(,)? }
        $(+ { $($extra:ident : $extra_kind:ty $([$extra_unit:literal])?),* $(,)? })?
    )*) => {
        $(
            #[doc = concat!("`", stringify!($wire), "`: ", $summary)]
            #[derive(Debug, Clone, Copy, PartialEq)]
            pub struct $name {
                $($(#[doc = $unit])? pub $field: $kind,)*
                $($($(#[doc = $extra_unit])? pub $extra: $extra_kind,)*)?
            }

            impl $name {
                /// The row of this message.
                pub const INFO: MessageInfo = MessageInfo {
                    id: $id,
                    name: stringify!($wire),
                    summary: $summary,
                    direction: Direction::$direction,
                    crc_extra: crc_extra(
                        stringify!($wire),
                        &[$(Checked::of::<$kind>(stringify!($field))),*],
                    ),
                    base_length: 0 $(+ <$kind as Field>::SIZE)*,
                    length: 0 $(+ <$kind as Field>::SIZE)* $($(+ <$extra_kind as Field>::SIZE)*)?,
                };
                /// The number of this message.
                pub const ID: u32 = $id;
            }

            impl Default for $name {
                fn default() -> Self {
                    Self {
                        $($field: <$kind as Field>::ZERO,)*
                        $($($extra: <$extra_kind as Field>::ZERO,)*)?
                    }
                }
            }

            impl From<$name> for Message {
                fn from(message: $name) -> Self {
                    Self::$name(message)
                }
            }
        )*

        /// A message of the table.
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[allow(clippy::large_enum_variant, reason = "a box would cost an allocation a frame")]
        pub enum Message {
            $(#[doc = concat!("`", stringify!($wire), "`")] $name($name),)*
        }

        impl Message {
            /// Returns the row of the message.
            pub fn info(&self) -> &'static MessageInfo {
                match self {
                    $(Self::$name(_) => &$name::INFO,)*
                }
            }

            /// Decodes a payload. Missing bytes count as 0, bytes beyond the known fields are ignored. Returns `None`
            /// if the table has no such message.
            pub fn decode(id: u32, payload: &[u8]) -> Option<Self> {
                let reader = &mut Reader(payload);
                match id {
                    $($id => Some(Self::$name($name {
                        $($field: Field::read(reader),)*
                        $($($extra: Field::read(reader),)*)?
                    })),)*
                    _ => None,
                }
            }

            /// Appends the whole payload with all extension fields.
            pub fn encode(&self, out: &mut Vec<u8>) {
                match self {
                    $(Self::$name(message) => {
                        $(message.$field.write(out);)*
                        $($(message.$extra.write(out);)*)?
                    })*
                }
            }
        }

        pub(super) static TABLE: &[MessageInfo] = &[$($name::INFO),*];
    };
}

use messages;

#[cfg(test)]
mod tests;
