//! The settings: one table for get, set, dump, diff, help, completion, storage and the documentation.
//!
//! * [`SETTINGS`] describes every setting: name, type, range, default, meaning.
//! * [`Settings`] holds the values, including those of the PID, rate and battery profiles.
//! * [`judge()`] reports an invalid setting before a craft gets it.
//! * [`foreign_name`] recognises the settings of other builds, which are kept but have no effect.
//!
//! The control code never reads settings in a step. `parameters` turns them into typed
//! coefficients, at boot and again after every command line and every message that may have changed them.

mod current_firmware;
mod foreign;
mod judge;
mod parse;
mod profile;
mod store;
mod table;
mod unit;

pub use current_firmware::{acts_in_master, beyond_current_firmware};
pub use foreign::foreign_name;
pub use judge::judge;
pub use parse::AssignError;
pub use store::{Settings, Value};
pub use table::{PORT_NAMES, SETTINGS, find, group_of, grouped, needs_restart};

use crate::telemetry::FirmwareProfile;

/// The scope of a setting: one value for the craft, or one in each profile of a kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, strum::EnumIter)]
pub enum Scope {
    /// One value for the craft.
    Master,
    /// One value in each PID profile.
    Profile,
    /// One value in each rate profile.
    RateProfile,
    /// One value in each battery profile.
    BatteryProfile,
}

impl Scope {
    /// Returns the number of instances of the scope.
    pub const fn instances(self) -> u8 {
        match self {
            Self::Master => 1,
            Self::Profile | Self::RateProfile => 4,
            Self::BatteryProfile => 3,
        }
    }

    /// Returns the command that selects an instance, which is also its heading in a dump.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Master => "master",
            Self::Profile => "profile",
            Self::RateProfile => "rateprofile",
            Self::BatteryProfile => "battery_profile",
        }
    }
}

/// The integer type that carries the value on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum Width {
    /// Unsigned, 8 bits. Texts are strings of these.
    #[strum(to_string = "uint8")]
    U8,
    /// Signed, 8 bits.
    #[strum(to_string = "int8")]
    I8,
    /// Unsigned, 16 bits.
    #[strum(to_string = "uint16")]
    U16,
    /// Signed, 16 bits.
    #[strum(to_string = "int16")]
    I16,
    /// Unsigned, 32 bits.
    #[strum(to_string = "uint32")]
    U32,
}

impl Width {
    /// Returns the smallest and largest value of the type.
    pub const fn bounds(self) -> (i64, i64) {
        match self {
            Self::U8 => (0, 255),
            Self::I8 => (-128, 127),
            Self::U16 => (0, 65_535),
            Self::I16 => (-32_768, 32_767),
            Self::U32 => (0, 4_294_967_295),
        }
    }
}

/// The values that a setting accepts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// An integer in a range.
    Number {
        /// The smallest value.
        min: i64,
        /// The greatest value.
        max: i64,
        /// The value of a fresh vehicle.
        default: i64,
    },
    /// One word of a list. The value is the position in the list.
    Choice {
        /// The words in canonical case.
        words: &'static [&'static str],
        /// The position of the word of a fresh vehicle.
        default: i64,
    },
    /// A fixed number of integers of the setting's width.
    Array {
        /// The values of a fresh vehicle; their number is the length.
        default: &'static [i64],
    },
    /// A text, empty on a fresh vehicle.
    Text {
        /// The most characters.
        max: usize,
    },
    /// A serial port: the value 0 is `NONE`, n is `UARTn`.
    Port {
        /// The port of a fresh vehicle.
        default: i64,
    },
}

/// The effect of a setting in this vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum Role {
    /// The setting changes the behaviour of the vehicle.
    Live,
    /// The setting changes the behaviour in one profile of the autopilot. In the other one it is carried.
    #[strum(to_string = "{0}")]
    Only(FirmwareProfile),
    /// The setting is validated, stored and printed, but has no effect.
    #[strum(to_string = "carried")]
    Carry,
}

/// One row of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// The name used by get, set, dump, diff and the settings file.
    pub name: &'static str,
    /// The part of the configuration that has a value of its own.
    pub scope: Scope,
    /// The type on the wire.
    pub width: Width,
    /// The allowed values and the default.
    pub kind: Kind,
    /// The effect of the setting here.
    pub role: Role,
    /// `true` if the `hardware` scope of dump and diff prints it.
    pub hardware: bool,
    /// A description in one line.
    pub help: &'static str,
    /// The position among the settings of its scope.
    slot: usize,
}

impl Setting {
    /// Returns the value of a fresh vehicle.
    pub fn default_value(&self) -> Value {
        match self.kind {
            Kind::Number { default, .. } | Kind::Choice { default, .. } | Kind::Port { default } => {
                Value::Number(default)
            }
            Kind::Array { default } => Value::Array(default.to_vec()),
            Kind::Text { .. } => Value::Text(String::new()),
        }
    }

    /// Returns the unit of its value, as in its description; empty if it has none.
    pub fn unit(&self) -> &'static str {
        unit::of_help(self.help)
    }

    /// Returns the line with the allowed values: `Allowed range: 10 - 70`. Empty for ports, which have no such line.
    pub fn range_line(&self) -> String {
        match self.kind {
            Kind::Number { min, max, .. } => format!("Allowed range: {min} - {max}"),
            Kind::Choice { words, .. } => format!("Allowed values: {}", words.join(", ")),
            Kind::Array { default } => format!("Array length: {}", default.len()),
            Kind::Text { max } => format!("String length: 1 - {max}"),
            Kind::Port { .. } => String::new(),
        }
    }

    /// Formats a value as on the command line: `25`, `VELOCITY`, `0,0,0`, `-` for an empty text.
    pub fn display(&self, value: &Value) -> String {
        match (value, self.kind) {
            (Value::Number(at), Kind::Choice { words, .. }) => word_at(words, *at).to_owned(),
            (Value::Number(at), Kind::Port { .. }) => word_at(&PORT_NAMES, *at).to_owned(),
            (Value::Number(number), _) => number.to_string(),
            (Value::Array(numbers), _) => {
                numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
            }
            (Value::Text(text), _) if text.is_empty() => "-".to_owned(),
            (Value::Text(text), _) => text.clone(),
        }
    }
}

fn word_at(words: &'static [&'static str], at: i64) -> &'static str {
    usize::try_from(at).ok().and_then(|at| words.get(at)).copied().unwrap_or("")
}
