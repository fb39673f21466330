//! Airframe type and custom mix.

use strum::IntoEnumIterator;

use crate::signals::PerMotor;

/// The number of rows of the custom mix.
pub const MAX_MIX_ROWS: usize = 8;

/// The airframe types of the firmware. The discriminant is the code on the wire. Only QUADX, QUADP, QUADX1234, and
/// CUSTOM with four rows fly here.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Hash,
    strum::Display,
    strum::EnumIter,
    strum::FromRepr,
    strum::IntoStaticStr,
)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
#[repr(u8)]
#[allow(missing_docs, reason = "the variants have the names of Betaflight")]
pub enum MixerKind {
    Tri = 1,
    #[strum(to_string = "QUADP")]
    QuadP = 2,
    #[default]
    #[strum(to_string = "QUADX")]
    QuadX = 3,
    Bi = 4,
    Gimbal = 5,
    Y6 = 6,
    Hex6 = 7,
    FlyingWing = 8,
    Y4 = 9,
    #[strum(to_string = "HEX6X")]
    Hex6X = 10,
    #[strum(to_string = "OCTOX8")]
    OctoX8 = 11,
    #[strum(to_string = "OCTOFLATP")]
    OctoFlatP = 12,
    #[strum(to_string = "OCTOFLATX")]
    OctoFlatX = 13,
    Airplane = 14,
    #[strum(to_string = "HELI_120_CCPM")]
    Heli120Ccpm = 15,
    #[strum(to_string = "HELI_90_DEG")]
    Heli90Deg = 16,
    #[strum(to_string = "VTAIL4")]
    VTail4 = 17,
    #[strum(to_string = "HEX6H")]
    Hex6H = 18,
    PpmToServo = 19,
    #[strum(to_string = "DUALCOPTER")]
    DualCopter = 20,
    #[strum(to_string = "SINGLECOPTER")]
    SingleCopter = 21,
    #[strum(to_string = "ATAIL4")]
    ATail4 = 22,
    Custom = 23,
    #[strum(to_string = "CUSTOMAIRPLANE")]
    CustomAirplane = 24,
    #[strum(to_string = "CUSTOMTRI")]
    CustomTri = 25,
    #[strum(to_string = "QUADX1234")]
    QuadX1234 = 26,
    #[strum(to_string = "OCTOX8P")]
    OctoX8P = 27,
}

impl MixerKind {
    /// Returns the type of this name in any case, or the first type whose name starts with it.
    pub fn by_name(name: &str) -> Option<Self> {
        let name = name.to_ascii_uppercase();
        let starting = || Self::iter().find(|kind| kind.to_string().starts_with(&name));
        Self::iter()
            .find(|kind| kind.to_string() == name)
            .or_else(|| if name.is_empty() { None } else { starting() })
    }

    /// Returns the motor rows of the types that fly here.
    pub fn rows(self) -> Option<PerMotor<MixRow>> {
        let row = |roll, pitch_down, yaw| MixRow { throttle: 1.0, roll, pitch_down, yaw };
        match self {
            Self::QuadX => {
                Some([row(-1.0, 1.0, -1.0), row(-1.0, -1.0, 1.0), row(1.0, 1.0, 1.0), row(1.0, -1.0, -1.0)])
            }
            Self::QuadX1234 => {
                Some([row(1.0, -1.0, -1.0), row(-1.0, -1.0, 1.0), row(-1.0, 1.0, -1.0), row(1.0, 1.0, 1.0)])
            }
            Self::QuadP => {
                Some([row(0.0, 1.0, -1.0), row(-1.0, 0.0, 1.0), row(1.0, 0.0, 1.0), row(0.0, -1.0, -1.0)])
            }
            _ => None,
        }
    }
}

/// The shares of throttle, roll, pitch and yaw for one motor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MixRow {
    /// The share of throttle; zero ends the custom mix.
    pub throttle: f64,
    /// The share of roll, right positive.
    pub roll: f64,
    /// The share of pitch, nose down positive.
    pub pitch_down: f64,
    /// The share of yaw.
    pub yaw: f64,
}
