//! The kinds of faults, and the value of a fault as plain data.

use std::fmt;

/// A kind of fault. `Display` gives its name on the command line.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    strum::Display,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantNames,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "kebab-case")]
pub enum FaultKind {
    /// No RC frame arrives.
    RxLoss,
    /// RC frames are lost at random.
    RxJitter,
    /// The GPS has no solution.
    GpsLoss,
    /// The GPS position is shifted.
    GpsGlitch,
    /// The GPS repeats the same solution.
    GpsFreeze,
    /// GPS solutions arrive late, without a word of it in them.
    GpsDelay,
    /// All errors of the GPS are greater.
    GpsNoise,
    /// The pressure drifts.
    BaroDrift,
    /// Single pressure samples are off.
    BaroSpike,
    /// The barometer repeats the same sample.
    BaroFreeze,
    /// The magnetometer gives no data.
    MagOff,
    /// The magnetic heading is off.
    MagBias,
    /// Step on the gyro's x axis.
    GyroBias,
    /// Step on the accelerometer's x axis.
    AccBias,
    /// The last inertial sample is repeated.
    ImuFreeze,
    /// A weak or dead motor.
    Motor,
    /// A motor's command is frozen.
    MotorStuck,
    /// A propeller is out of balance.
    PropImbalance,
    /// The frame vibrates.
    Vibration,
    /// The battery is weak.
    Battery,
    /// One gust.
    Gust,
    /// Another mean wind.
    Wind,
    /// The craft is pushed once.
    Push,
    /// The craft is moved instantly.
    Teleport,
    /// A weight below the craft.
    Payload,
    /// External link: nothing arrives.
    Stall,
    /// External link: packets are lost.
    FdmLoss,
    /// External link: packets are late.
    FdmLate,
    /// External link: packets come twice.
    FdmDup,
    /// External link: packets are late at random.
    FdmJitter,
}

/// The value of a fault. `Display` gives its form on the command line.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum FaultValue {
    /// A kind without a value.
    None,
    /// One number, in the unit of its kind.
    Number(f64),
    /// A number for one motor.
    Motor {
        /// Motor number, 1…4.
        motor: u8,
        /// Efficiency, command or acceleration.
        value: f64,
    },
    /// A size with the direction to which it points or from which it comes.
    Bearing {
        /// Metres, or metres per second.
        size: f64,
        /// Degrees clockwise from north.
        deg: f64,
    },
    /// One battery cell fails short.
    CellOut,
    /// An impulse.
    Push {
        /// Size, N·s.
        impulse: f64,
        /// `north`, `east`, `south`, `west`, `up` or `down`.
        #[serde(deserialize_with = "direction")]
        direction: Word,
    },
    /// A displacement north, east and up, m.
    Offset([f64; 3]),
}

/// A word of this program. Under this name serde does not try to borrow it from its input.
type Word = &'static str;

/// The words for the direction of a push.
const DIRECTIONS: [Word; 6] = ["north", "east", "south", "west", "up", "down"];

/// Reads the word of a direction.
fn direction<'de, D: serde::Deserializer<'de>>(source: D) -> Result<Word, D::Error> {
    let word = <std::borrow::Cow<'de, str> as serde::Deserialize>::deserialize(source)?;
    let known = DIRECTIONS.into_iter().find(|known| *known == word);
    known.ok_or_else(|| serde::de::Error::custom("an unknown direction"))
}

impl fmt::Display for FaultValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => Ok(()),
            Self::Number(value) => write!(f, "{value}"),
            Self::Motor { motor, value } => write!(f, "{motor}:{value}"),
            Self::Bearing { size, deg } => write!(f, "{size}@{deg}"),
            Self::CellOut => f.write_str("cell-out"),
            Self::Push { impulse, direction } => write!(f, "{impulse},{direction}"),
            Self::Offset([north, east, up]) => write!(f, "{north},{east},{up}"),
        }
    }
}
