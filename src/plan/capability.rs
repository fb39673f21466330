//! The values that each waypoint type uses, and how it is flown: one row a type.

use super::WaypointType;

/// The row of a waypoint type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Capability {
    /// The latitude and the longitude have a meaning.
    pub place: bool,
    /// The altitude has a meaning.
    pub altitude: bool,
    /// The use of the speed field.
    pub speed: SpeedUse,
    /// The use of the duration.
    pub time: TimeUse,
    /// The pattern has a meaning.
    pub pattern: bool,
    /// How the craft gets to the waypoint.
    pub approach: Approach,
    /// The action after the arrival.
    pub then: Then,
}

/// The use of the speed field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpeedUse {
    /// The field has no meaning.
    Unused,
    /// The field holds the speed of the leg, m/s.
    Leg,
    /// The field holds a rate in degrees/s.
    YawRate,
}

/// The use of the duration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeUse {
    /// The field has no meaning.
    Unused,
    /// The autopilot waits so long, but the editor does not offer it.
    Wait,
    /// A stay that is endless without a duration.
    Stay,
    /// A duration that must be given.
    Needed,
}

/// How the craft gets to the waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Approach {
    /// The craft never flies to it. It changes the flight to the next waypoint.
    Modify(Modifier),
    /// Crosses the plane through the point.
    Pass,
    /// Like `Pass`, but the turn begins before the point.
    Turn,
    /// Stops at the point, at any altitude.
    Stop,
    /// Stops at the point and waits for the altitude.
    Level,
    /// Climbs to the altitude on the spot.
    Climb,
}

/// The change by a modifier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Modifier {
    /// Another altitude.
    Altitude,
    /// A wait.
    Delay,
    /// Another rate of yaw.
    YawRate,
}

/// The action after the arrival. Every type but `GoOn` waits for its duration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Then {
    /// Goes on to the next waypoint.
    GoOn,
    /// Waits for the duration, if there is one, and goes on.
    Loiter,
    /// Holds, on the pattern if there is one.
    Hold,
    /// Waits for the duration, if there is one, and lands.
    Land,
}

/// A point that the craft passes at the altitude and the speed of the waypoint.
const PASS: Capability = Capability {
    place: true,
    altitude: true,
    speed: SpeedUse::Leg,
    time: TimeUse::Unused,
    pattern: false,
    approach: Approach::Pass,
    then: Then::GoOn,
};

const fn modifier(modifier: Modifier) -> Capability {
    let approach = Approach::Modify(modifier);
    Capability { place: false, altitude: false, speed: SpeedUse::Unused, approach, ..PASS }
}

impl WaypointType {
    /// Returns the row of the type.
    pub const fn capability(self) -> Capability {
        match self {
            Self::Flyover => PASS,
            Self::Flyby => Capability { approach: Approach::Turn, ..PASS },
            Self::Hold => Capability {
                time: TimeUse::Stay,
                pattern: true,
                approach: Approach::Level,
                then: Then::Hold,
                ..PASS
            },
            Self::Land => {
                Capability { time: TimeUse::Wait, approach: Approach::Stop, then: Then::Land, ..PASS }
            }
            Self::Takeoff => Capability {
                place: false,
                time: TimeUse::Wait,
                approach: Approach::Climb,
                then: Then::Loiter,
                ..PASS
            },
            Self::AltChange => Capability { altitude: true, ..modifier(Modifier::Altitude) },
            Self::Delay => Capability { time: TimeUse::Needed, ..modifier(Modifier::Delay) },
            Self::YawRate => Capability { speed: SpeedUse::YawRate, ..modifier(Modifier::YawRate) },
        }
    }

    /// Returns `true` if the record is a place to fly to. Modifiers only change the flight to the next one.
    pub fn is_positional(self) -> bool {
        self.modifier().is_none()
    }

    /// Returns the change by a modifier.
    pub fn modifier(self) -> Option<Modifier> {
        match self.capability().approach {
            Approach::Modify(modifier) => Some(modifier),
            _ => None,
        }
    }

    /// Returns `true` if the record's latitude and longitude have a meaning. A TAKEOFF climbs at the craft's own place.
    pub fn uses_position(self) -> bool {
        self.capability().place
    }

    /// Returns `true` if the craft passes the point without a stop.
    pub fn passes(self) -> bool {
        matches!(self.capability().approach, Approach::Pass | Approach::Turn)
    }

    /// Returns `true` if the craft stops at the point.
    pub fn stops(self) -> bool {
        self.is_positional() && !self.passes()
    }

    /// Returns `true` if the speed field holds a yaw rate.
    pub fn has_yaw_rate(self) -> bool {
        self.capability().speed == SpeedUse::YawRate
    }
}
