//! Messages that are lists of settings. The same list reads and writes them.

use crate::firmware::settings::{Kind, Settings, Value, Width, find};
use crate::msp::{PaddedReader, Writer};

/// One field of a message.
#[derive(Debug, Clone, Copy)]
pub(super) enum Field {
    /// A setting of the active profile.
    Setting(Width, &'static str),
    /// A setting that the message carries as `factor` × value + `offset`.
    Scaled {
        /// The type on the wire.
        width: Width,
        name: &'static str,
        factor: i64,
        offset: i64,
    },
    /// A value that this vehicle does not have: always this number, ignored when written.
    Fixed(Width, i64),
}

pub(super) const fn u8(name: &'static str) -> Field {
    Field::Setting(Width::U8, name)
}

pub(super) const fn i8(name: &'static str) -> Field {
    Field::Setting(Width::I8, name)
}

pub(super) const fn u16(name: &'static str) -> Field {
    Field::Setting(Width::U16, name)
}

pub(super) const fn i16(name: &'static str) -> Field {
    Field::Setting(Width::I16, name)
}

/// Returns a fixed field of one byte for data that this program does not use.
pub(super) const fn byte(value: i64) -> Field {
    Field::Fixed(Width::U8, value)
}

/// Returns a fixed field of two bytes for data that this program does not use.
pub(super) const fn word(value: i64) -> Field {
    Field::Fixed(Width::U16, value)
}

/// Returns a fixed field of four bytes for data that this program does not use.
pub(super) const fn long(value: i64) -> Field {
    Field::Fixed(Width::U32, value)
}

/// Writes the fields of a message to the reply.
pub(super) fn read(fields: &[Field], settings: &Settings, reply: &mut Writer) {
    for field in fields {
        match *field {
            Field::Setting(width, name) => write_number(reply, width, settings.number(name)),
            Field::Scaled { width, name, factor, offset } => {
                write_number(reply, width, settings.number(name) * factor + offset);
            }
            Field::Fixed(width, value) => write_number(reply, width, value),
        }
    }
}

/// Sets the fields of a message from the request. Settings without any byte keep their value.
pub(super) fn write(fields: &[Field], settings: &mut Settings, request: &mut PaddedReader<'_>) {
    for field in fields {
        if request.remaining() == 0 {
            return;
        }
        match *field {
            Field::Setting(width, name) => put(settings, name, read_number(request, width)),
            Field::Scaled { width, name, factor, offset } => {
                put(settings, name, (read_number(request, width) - offset) / factor);
            }
            Field::Fixed(width, _) => {
                read_number(request, width);
            }
        }
    }
}

/// Sets a number, limited to the setting's range. A word position that does not exist changes nothing, because there is
/// no nearest word.
pub(super) fn put(settings: &mut Settings, name: &str, number: i64) {
    let Some(setting) = find(name) else { return };
    let number = match setting.kind {
        Kind::Number { min, max, .. } => number.clamp(min, max),
        Kind::Choice { .. } | Kind::Port { .. } | Kind::Array { .. } | Kind::Text { .. } => number,
    };
    let _unknown_word = settings.set(name, Value::Number(number));
}

fn read_number(request: &mut PaddedReader<'_>, width: Width) -> i64 {
    match width {
        Width::U8 => i64::from(request.u8()),
        Width::I8 => i64::from(request.i8()),
        Width::U16 => i64::from(request.u16()),
        Width::I16 => i64::from(request.i16()),
        Width::U32 => i64::from(request.u32()),
    }
}

fn write_number(reply: &mut Writer, width: Width, number: i64) {
    match width {
        Width::U8 => reply.u8(number),
        Width::I8 => reply.i8(number),
        Width::U16 => reply.u16(number),
        Width::I16 => reply.i16(number),
        Width::U32 => reply.u32(number),
    }
}
