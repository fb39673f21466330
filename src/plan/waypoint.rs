//! One waypoint.

use super::quantity::{Altitude, LegSpeed, Seconds};
use crate::geo::LatLon;
use crate::plan::record::WaypointRecord;

/// The action of the autopilot at a waypoint. The discriminant is the code in MSP messages and in files.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Hash,
    strum::Display,
    strum::EnumString,
    strum::EnumIter,
    strum::FromRepr,
    strum::IntoStaticStr,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE", ascii_case_insensitive)]
#[repr(u8)]
pub enum WaypointType {
    /// Cross the perpendicular plane through the point.
    #[default]
    Flyover = 0,
    /// Start turning at the turn radius.
    Flyby = 1,
    /// Hold position, optionally on a pattern.
    Hold = 2,
    /// Descend, detect the touchdown, disarm.
    Land = 3,
    /// Climb on the spot to the altitude.
    Takeoff = 4,
    /// Fly the next positional waypoint at this record's altitude.
    AltChange = 5,
    /// Fly the next leg in this record's duration.
    Delay = 6,
    /// Limit the autopilot's yaw rate to this record's speed field, deg/s.
    YawRate = 7,
}

/// The pattern of a HOLD; ignored on other types. The discriminant is the code of Betaflight in MSP messages.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Hash,
    strum::Display,
    strum::EnumString,
    strum::EnumIter,
    strum::FromRepr,
    strum::IntoStaticStr,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "UPPERCASE", ascii_case_insensitive)]
#[repr(u8)]
pub enum HoldPattern {
    /// Stay on the point.
    #[default]
    None = 0,
    /// Circle the point clockwise at `ap_hold_orbit_radius`.
    Orbit = 1,
    /// Two tangent circles east and west of the point.
    Figure8 = 2,
}

/// A waypoint. Journals store it as its record.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(from = "WaypointRecord", into = "WaypointRecord")]
pub struct Waypoint {
    /// Position, degrees × 10⁷.
    pub position: LatLon,
    /// Altitude above home.
    pub altitude: Altitude,
    /// Leg speed; zero of a YAW_RATE.
    pub speed: LegSpeed,
    /// The rate of a YAW_RATE, degrees/s; zero of any other type, because records have one field for both.
    pub yaw_rate_dps: u16,
    /// Hold or delay time; a HOLD without one is endless.
    pub duration: Seconds,
    /// The action at the waypoint.
    pub kind: WaypointType,
    /// The pattern of a HOLD.
    pub pattern: HoldPattern,
}

impl Waypoint {
    /// Returns the waypoint with another type and the same numbers in its record.
    pub fn with_kind(self, kind: WaypointType) -> Self {
        WaypointRecord { kind, ..self.into() }.into()
    }
}
