//! The measures of a flight.

use super::hold::in_hold;
use super::leg::on_leg;
use super::passage::passages;
use super::track::Track;
use crate::plan::WaypointType;
use crate::report::route::{Route, TrackSample};

/// The heights above the touchdown between which the sink rate is taken, m. Below them the craft brakes or the ground cushions
/// it.
const SINK_M: [f64; 2] = [8.0, 2.0];
/// The time over which a yaw rate is taken, s. Shorter ones show the noise of the loop.
const YAW_S: f64 = 0.2;

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
    /// Greatest yaw rate, °/s, over [`YAW_S`].
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

/// Returns the measures of a flight, without those of places that it did not reach.
pub fn measures(route: &Route, track: &Track) -> Vec<(Measure, f64)> {
    let mut found = Vec::new();
    found.extend(track.flown_s.map(|flown_s| (Measure::Flown, flown_s)));
    if let Some(landing) = track.touchdown {
        found.push((Measure::TouchdownTime, landing.time_s));
        let land = route.points.iter().find(|point| point.kind == WaypointType::Land);
        let distance = land.and_then(|point| point.ne).map(|land| (landing.ne - land).norm());
        found.extend(distance.map(|distance| (Measure::TouchdownDistance, distance)));
        found.extend(landing.impact_mps.map(|speed_mps| (Measure::TouchdownSpeed, speed_mps)));
        found.extend(landing.disarmed_after_s.map(|delay_s| (Measure::DisarmDelay, delay_s)));
        found.extend(sink_rate_mps(&track.samples, landing.time_s).map(|rate| (Measure::SinkRate, rate)));
    }
    let tilts = track.samples.iter().filter_map(|sample| Some(sample.attitude?.tilt_deg));
    found.extend(tilts.reduce(f64::max).map(|tilt_deg| (Measure::TiltMax, tilt_deg)));
    found.extend(yaw_rate_dps(&track.samples).map(|rate| (Measure::YawRateMax, rate)));
    let distances = track.samples.iter().map(|sample| sample.ne.norm());
    found.extend(distances.reduce(f64::max).map(|distance_m| (Measure::HomeDistance, distance_m)));
    let passed = passages(route, track);
    for (index, passage) in passed.iter().enumerate() {
        let wp = passage.point.wp;
        let Some(reached) = track.samples.get(passage.reached) else { continue };
        found.push((Measure::TimeTo(wp), reached.time_s));
        found.push((Measure::AltitudeError(wp), reached.alt_m - passage.point.alt_m));
        let stay = track.samples.get(passage.reached..=passage.left).unwrap_or_default();
        found.extend(in_hold(passage, stay));
        found.extend(on_leg(&passed, index, track));
    }
    found
}

/// Returns the mean sink rate in the last metres above a touchdown; `None` if the craft was never so high.
fn sink_rate_mps(samples: &[TrackSample], touchdown_s: f64) -> Option<f64> {
    let before = samples.iter().filter(|sample| sample.time_s <= touchdown_s);
    let ground_m = before.clone().next_back()?.alt_m;
    let above = |height_m: f64| {
        before
            .clone()
            .rev()
            .find(move |sample| sample.alt_m - ground_m >= height_m)
            .map(|sample| sample.time_s)
    };
    let [high_m, low_m] = SINK_M;
    let (from_s, to_s) = (above(high_m)?, above(low_m)?);
    (to_s > from_s).then(|| (high_m - low_m) / (to_s - from_s))
}

/// Returns the greatest yaw rate; `None` for a log.
fn yaw_rate_dps(samples: &[TrackSample]) -> Option<f64> {
    let [first, second, ..] = samples else { return None };
    let apart = ((YAW_S / (second.time_s - first.time_s)).round() as usize).max(1);
    let rates = samples.iter().zip(samples.get(apart..)?).filter_map(|(from, to)| {
        let turned_deg = wrapped_deg(to.attitude?.heading_deg - from.attitude?.heading_deg);
        Some(turned_deg.abs() / (to.time_s - from.time_s))
    });
    rates.reduce(f64::max)
}

/// Returns an angle as −180 to 180 degrees.
pub(super) fn wrapped_deg(angle_deg: f64) -> f64 {
    (angle_deg + 180.0).rem_euclid(360.0) - 180.0
}
