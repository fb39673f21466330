//! The names of the measures of a flight.

use crate::report::route::Route;

/// A measure of a flight; waypoints are given by their index in the plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Measure {
    /// Seconds from the engagement until a waypoint was reached.
    TimeTo(u8),
    /// Seconds from the engagement until the craft touched the ground.
    TouchdownTime,
    /// Seconds from the engagement to the end.
    Flown,
    /// Greatest cross-track error on the straight leg to a waypoint, m.
    CrossTrackMax(u8),
    /// Root mean square of that cross-track error, m.
    CrossTrackRms(u8),
    /// Distance by which the craft went beyond the new leg in its turn at a waypoint, m.
    Overshoot(u8),
    /// Altitude at the instant of reaching a waypoint, less the altitude in the plan, m.
    AltitudeError(u8),
    /// Root mean square distance from the ring of an ORBIT at a waypoint in its last lap, m.
    RingError(u8),
    /// Mean distance from the waypoint in that lap, m.
    RingRadius(u8),
    /// Mean rate of that lap, °/s; clockwise is positive.
    RingRate(u8),
    /// Greatest distance from a waypoint in its hold without a pattern, m.
    HoldDistance(u8),
    /// Root mean square angle between the nose and the course over ground on the leg to a waypoint, degrees.
    NoseError(u8),
    /// Mean ground speed in the middle half of the leg to a waypoint, m/s.
    LegSpeed(u8),
    /// Ground speed at a waypoint that the craft passes without a hold, m/s.
    CornerSpeed(u8),
    /// Root mean square altitude error in the second half of the leg to a waypoint, m.
    LegAltitude(u8),
    /// Distance of the touchdown from the LAND point, m.
    TouchdownDistance,
    /// Mean sink rate from 8 to 2 m above the touchdown, m/s.
    SinkRate,
    /// Speed at the touchdown, m/s.
    TouchdownSpeed,
    /// Seconds from the touchdown until the craft was disarmed.
    DisarmDelay,
    /// Greatest angle between the thrust axis and the vertical, degrees.
    TiltMax,
    /// Greatest yaw rate over a fifth of a second, °/s.
    YawRateMax,
    /// Greatest horizontal distance from home, m.
    HomeDistance,
}

impl Measure {
    /// Returns all measures of a route, in the order of the output.
    pub(super) fn all(route: &Route) -> impl Iterator<Item = Self> + '_ {
        let of_each = |measure: fn(u8) -> Self| route.points.iter().map(move |point| measure(point.wp));
        of_each(Self::TimeTo)
            .chain([Self::TouchdownTime, Self::Flown])
            .chain(of_each(Self::CrossTrackMax))
            .chain(of_each(Self::CrossTrackRms))
            .chain(of_each(Self::Overshoot))
            .chain(of_each(Self::AltitudeError))
            .chain(of_each(Self::LegAltitude))
            .chain(of_each(Self::LegSpeed))
            .chain(of_each(Self::CornerSpeed))
            .chain(of_each(Self::RingError))
            .chain(of_each(Self::RingRadius))
            .chain(of_each(Self::RingRate))
            .chain(of_each(Self::HoldDistance))
            .chain(of_each(Self::NoseError))
            .chain([Self::TouchdownDistance, Self::SinkRate, Self::TouchdownSpeed, Self::DisarmDelay])
            .chain([Self::TiltMax, Self::YawRateMax, Self::HomeDistance])
    }

    /// Returns the title for people.
    pub(super) fn title(self) -> String {
        match self {
            Self::TimeTo(wp) => format!("time to WP{wp}"),
            Self::TouchdownTime => "time to the touchdown".to_owned(),
            Self::Flown => "time to the end".to_owned(),
            Self::CrossTrackMax(wp) => format!("cross-track max, leg to WP{wp}"),
            Self::CrossTrackRms(wp) => format!("cross-track RMS, leg to WP{wp}"),
            Self::Overshoot(wp) => format!("overshoot at WP{wp}"),
            Self::AltitudeError(wp) => format!("altitude error at WP{wp}"),
            Self::RingError(wp) => format!("ring error RMS, WP{wp}"),
            Self::RingRadius(wp) => format!("ring radius, WP{wp}"),
            Self::RingRate(wp) => format!("ring rate, WP{wp}"),
            Self::HoldDistance(wp) => format!("hold distance max, WP{wp}"),
            Self::NoseError(wp) => format!("nose error RMS, leg to WP{wp}"),
            Self::LegSpeed(wp) => format!("speed, leg to WP{wp}"),
            Self::CornerSpeed(wp) => format!("speed at WP{wp}"),
            Self::LegAltitude(wp) => format!("altitude error RMS, leg to WP{wp}"),
            Self::TouchdownDistance => "touchdown beside the LAND point".to_owned(),
            Self::SinkRate => "sink rate before the touchdown".to_owned(),
            Self::TouchdownSpeed => "speed at the touchdown".to_owned(),
            Self::DisarmDelay => "touchdown to disarming".to_owned(),
            Self::TiltMax => "tilt max".to_owned(),
            Self::YawRateMax => "yaw rate max".to_owned(),
            Self::HomeDistance => "distance from home max".to_owned(),
        }
    }

    /// Returns the name in JSON, and the waypoint.
    pub(in crate::report) fn key(self) -> (&'static str, Option<u8>) {
        match self {
            Self::TimeTo(wp) => ("time_to_wp_s", Some(wp)),
            Self::TouchdownTime => ("touchdown_s", None),
            Self::Flown => ("flown_s", None),
            Self::CrossTrackMax(wp) => ("cross_track_max_m", Some(wp)),
            Self::CrossTrackRms(wp) => ("cross_track_rms_m", Some(wp)),
            Self::Overshoot(wp) => ("overshoot_m", Some(wp)),
            Self::AltitudeError(wp) => ("alt_error_m", Some(wp)),
            Self::RingError(wp) => ("ring_error_rms_m", Some(wp)),
            Self::RingRadius(wp) => ("ring_radius_m", Some(wp)),
            Self::RingRate(wp) => ("ring_rate_dps", Some(wp)),
            Self::HoldDistance(wp) => ("hold_distance_max_m", Some(wp)),
            Self::NoseError(wp) => ("nose_error_rms_deg", Some(wp)),
            Self::LegSpeed(wp) => ("leg_speed_mps", Some(wp)),
            Self::CornerSpeed(wp) => ("corner_speed_mps", Some(wp)),
            Self::LegAltitude(wp) => ("leg_altitude_rms_m", Some(wp)),
            Self::TouchdownDistance => ("touchdown_distance_m", None),
            Self::SinkRate => ("sink_rate_mps", None),
            Self::TouchdownSpeed => ("touchdown_speed_mps", None),
            Self::DisarmDelay => ("touchdown_to_disarm_s", None),
            Self::TiltMax => ("tilt_max_deg", None),
            Self::YawRateMax => ("yaw_rate_max_dps", None),
            Self::HomeDistance => ("home_distance_max_m", None),
        }
    }

    pub(super) fn unit(self) -> &'static str {
        match self {
            Self::TimeTo(_) | Self::TouchdownTime | Self::Flown | Self::DisarmDelay => "s",
            Self::RingRate(_) | Self::YawRateMax => "°/s",
            Self::NoseError(_) | Self::TiltMax => "°",
            Self::LegSpeed(_) | Self::CornerSpeed(_) | Self::SinkRate | Self::TouchdownSpeed => "m/s",
            Self::CrossTrackMax(_)
            | Self::CrossTrackRms(_)
            | Self::Overshoot(_)
            | Self::AltitudeError(_)
            | Self::LegAltitude(_)
            | Self::RingError(_)
            | Self::RingRadius(_)
            | Self::HoldDistance(_)
            | Self::HomeDistance
            | Self::TouchdownDistance => "m",
        }
    }
}
