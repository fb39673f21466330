//! The settings: one table from which get, set, dump, diff, help, completion, storage and the documentation follow.
//!
//! * [`SETTINGS`] describes every setting: name, type, range, default, meaning.
//! * [`Settings`] holds the values, including those of the PID, rate and battery profiles.
//! * [`judge`] says what is wrong with a setting before a craft gets it.
//! * [`foreign_name`] knows the settings of other builds, which are kept but have no effect.
//!
//! The control code never reads settings in a step: [`parameters`](super::parameters) makes typed coefficients of
//! them, at boot and again after every command line and every message that may have changed them.

mod current_firmware;
mod foreign;
mod judge;
mod parse;
mod store;
mod table;

pub use current_firmware::beyond_current_firmware;
pub use foreign::foreign_name;
pub use judge::judge;
pub use parse::AssignError;
pub use store::{Settings, Value};
pub use table::{PORT_NAMES, SETTINGS, find, group_of, needs_restart};

/// Where a setting lives: once for the craft, or once in each profile of a kind.
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
    /// How many instances of the scope exist.
    pub const fn instances(self) -> u8 {
        match self {
            Self::Master => 1,
            Self::Profile | Self::RateProfile => 4,
            Self::BatteryProfile => 3,
        }
    }

    /// The command that selects an instance, and the word that heads it in a dump.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Master => "master",
            Self::Profile => "profile",
            Self::RateProfile => "rateprofile",
            Self::BatteryProfile => "battery_profile",
        }
    }
}

/// Integer type that carries the value on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum Width {
    /// Unsigned, 8 bits; texts are strings of these.
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
    /// Smallest and largest value the type carries.
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

/// What values a setting takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// An integer in a range.
    Number {
        min: i64,
        max: i64,
        /// Value of a fresh vehicle.
        default: i64,
    },
    /// One word of a list; the value is the position in the list.
    Choice {
        /// The words in canonical case.
        words: &'static [&'static str],
        /// Position of the word of a fresh vehicle.
        default: i64,
    },
    /// A fixed number of integers of the setting's width.
    Array {
        /// Values of a fresh vehicle; their number is the length.
        default: &'static [i64],
    },
    /// A text, empty on a fresh vehicle.
    Text { max: usize },
    /// A serial port: the value 0 is `NONE`, n is `UARTn`.
    Port {
        /// Port of a fresh vehicle.
        default: i64,
    },
}

/// What a setting does in this vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum Role {
    /// It changes how the vehicle behaves.
    Live,
    /// It is validated, stored and printed, and has no effect.
    #[strum(to_string = "carried")]
    Carry,
}

/// One row of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// The name used by get, set, dump, diff and the settings file.
    pub name: &'static str,
    pub scope: Scope,
    /// Type on the wire.
    pub width: Width,
    /// Allowed values and default.
    pub kind: Kind,
    /// What it does here.
    pub role: Role,
    /// Printed by the `hardware` scope of dump and diff.
    pub hardware: bool,
    /// One line for people.
    pub help: &'static str,
    /// Position among the settings of its scope.
    slot: usize,
}

impl Setting {
    /// The value of a fresh vehicle.
    pub fn default_value(&self) -> Value {
        match self.kind {
            Kind::Number { default, .. } | Kind::Choice { default, .. } | Kind::Port { default } => {
                Value::Number(default)
            }
            Kind::Array { default } => Value::Array(default.to_vec()),
            Kind::Text { .. } => Value::Text(String::new()),
        }
    }

    /// The line that tells the allowed values: `Allowed range: 10 - 70`; empty for ports, which have none.
    pub fn range_line(&self) -> String {
        match self.kind {
            Kind::Number { min, max, .. } => format!("Allowed range: {min} - {max}"),
            Kind::Choice { words, .. } => format!("Allowed values: {}", words.join(", ")),
            Kind::Array { default } => format!("Array length: {}", default.len()),
            Kind::Text { max } => format!("String length: 1 - {max}"),
            Kind::Port { .. } => String::new(),
        }
    }

    /// A value in the spelling of the command line: `25`, `VELOCITY`, `0,0,0`, `-` for an empty text.
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
