//! The types a parameter can have.

use strum::VariantNames as _;

use crate::telemetry::{FenceAction, FirmwareProfile, RxLossPolicy};

/// The direction of the nose while the autopilot flies.
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
    strum::VariantNames,
)]
#[strum(serialize_all = "UPPERCASE")]
#[repr(u8)]
pub enum YawMode {
    /// Along the ground course.
    #[default]
    Velocity = 0,
    Bearing = 1,
    /// To the waypoint when far, along the course when near.
    Hybrid = 2,
    /// Direction at engagement.
    Fixed = 3,
    /// For wings; a multirotor treats it as [`YawMode::Fixed`].
    Dampener = 4,
}

/// A type that a parameter can have. Conversions saturate, so no number can be out of range of the type.
pub(super) trait Value: Copy {
    /// The names of the values of an enumeration in the order of their numbers; empty for plain numbers.
    const WORDS: &'static [&'static str];
    fn from_number(number: i64) -> Self;
}

macro_rules! numbers {
    ($($ty:ty)*) => {$(
        impl Value for $ty {
            const WORDS: &'static [&'static str] = &[];
            fn from_number(number: i64) -> Self {
                Self::try_from(number.max(0)).unwrap_or(Self::MAX)
            }
        }
    )*};
}
numbers!(u8 u16);

impl Value for bool {
    const WORDS: &'static [&'static str] = &["OFF", "ON"];
    fn from_number(number: i64) -> Self {
        number != 0
    }
}

macro_rules! enumerations {
    ($($ty:ty)*) => {$(
        impl Value for $ty {
            const WORDS: &'static [&'static str] = Self::VARIANTS;
            fn from_number(number: i64) -> Self {
                u8::try_from(number).ok().and_then(Self::from_repr).unwrap_or_default()
            }
        }
    )*};
}
enumerations!(YawMode RxLossPolicy FenceAction);

impl Value for FirmwareProfile {
    const WORDS: &'static [&'static str] = &["GUIDE", "MASTER"];
    fn from_number(number: i64) -> Self {
        if number == 0 { Self::Guide } else { Self::Master }
    }
}
