//! One waypoint record, in the border units of CLI, MSP and files.

use crate::geo::LatLon;

/// What a waypoint asks the autopilot to do. The discriminant is the code on the wire and in files.
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
    /// Keep station, on a pattern if asked.
    Hold = 2,
    /// Descend, detect the touchdown, disarm.
    Land = 3,
    /// Climb on the spot to the altitude.
    Takeoff = 4,
    /// The next positional waypoint flies at this record's altitude.
    AltChange = 5,
    /// The next leg takes this record's duration.
    Delay = 6,
    /// Caps the autopilot's yaw rate at this record's speed field, deg/s.
    YawRate = 7,
}

impl WaypointType {
    /// Whether the record is a place to fly to; modifiers only change how the next one is flown.
    pub fn is_positional(self) -> bool {
        match self {
            Self::Flyover | Self::Flyby | Self::Hold | Self::Land | Self::Takeoff => true,
            Self::AltChange | Self::Delay | Self::YawRate => false,
        }
    }

    /// Whether the record's latitude and longitude mean anything: a TAKEOFF climbs where it stands.
    pub fn uses_position(self) -> bool {
        self.is_positional() && self != Self::Takeoff
    }
}

/// The figure flown during a HOLD; ignored on other types. The discriminant is upstream's code on the wire.
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

/// A waypoint in the units of CLI, MSP and storage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, serde::Serialize, serde::Deserialize)]
pub struct Waypoint {
    /// Position, degrees × 10⁷.
    pub position: LatLon,
    /// Altitude above home, cm.
    pub alt_cm: i32,
    /// Leg speed, cm/s; 0 = `ap_max_velocity`.
    pub speed_cms: u16,
    /// Hold or delay time, deciseconds; 0 = endless for HOLD.
    pub duration_ds: u16,
    /// What to do there.
    pub kind: WaypointType,
    /// How to hold there.
    pub pattern: HoldPattern,
}
