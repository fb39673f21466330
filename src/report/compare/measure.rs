//! The measures of a flight.

use std::f64::consts::TAU;

use nalgebra::Vector2;

use super::passage::{Passage, passages};
use super::track::{Track, distance_to_segment};
use crate::math::atan2;
use crate::plan::WaypointType;
use crate::report::route::{Route, TrackSample};

/// The sine of the smallest turn that counts as a corner, about 10°.
const CORNER: f64 = 0.17;
/// The speed below which the course over ground has no meaning for the nose, m/s.
const SLOWEST_COURSE_MPS: f64 = 1.0;

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
    /// Mean rate of that lap, °/s; clockwise is positive.
    RingRate(u8),
    /// Greatest distance from a waypoint in its hold without a pattern, m.
    HoldDistance(u8),
    /// Root mean square angle between the nose and the course over ground on the leg to a waypoint, degrees.
    NoseError(u8),
    /// Distance of the touchdown from the LAND point, m.
    TouchdownDistance,
    /// Speed at the touchdown, m/s.
    TouchdownSpeed,
    /// Seconds from the touchdown until the craft was disarmed.
    DisarmDelay,
    /// Greatest angle between the thrust axis and the vertical, degrees.
    TiltMax,
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
            .chain(of_each(Self::RingError))
            .chain(of_each(Self::RingRate))
            .chain(of_each(Self::HoldDistance))
            .chain(of_each(Self::NoseError))
            .chain([Self::TouchdownDistance, Self::TouchdownSpeed, Self::DisarmDelay])
            .chain([Self::TiltMax, Self::HomeDistance])
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
            Self::RingRate(wp) => format!("ring rate, WP{wp}"),
            Self::HoldDistance(wp) => format!("hold distance max, WP{wp}"),
            Self::NoseError(wp) => format!("nose error RMS, leg to WP{wp}"),
            Self::TouchdownDistance => "touchdown beside the LAND point".to_owned(),
            Self::TouchdownSpeed => "speed at the touchdown".to_owned(),
            Self::DisarmDelay => "touchdown to disarming".to_owned(),
            Self::TiltMax => "tilt max".to_owned(),
            Self::HomeDistance => "distance from home max".to_owned(),
        }
    }

    /// Returns the name in JSON, and the waypoint.
    pub(super) fn key(self) -> (&'static str, Option<u8>) {
        match self {
            Self::TimeTo(wp) => ("time_to_wp_s", Some(wp)),
            Self::TouchdownTime => ("touchdown_s", None),
            Self::Flown => ("flown_s", None),
            Self::CrossTrackMax(wp) => ("cross_track_max_m", Some(wp)),
            Self::CrossTrackRms(wp) => ("cross_track_rms_m", Some(wp)),
            Self::Overshoot(wp) => ("overshoot_m", Some(wp)),
            Self::AltitudeError(wp) => ("alt_error_m", Some(wp)),
            Self::RingError(wp) => ("ring_error_rms_m", Some(wp)),
            Self::RingRate(wp) => ("ring_rate_dps", Some(wp)),
            Self::HoldDistance(wp) => ("hold_distance_max_m", Some(wp)),
            Self::NoseError(wp) => ("nose_error_rms_deg", Some(wp)),
            Self::TouchdownDistance => ("touchdown_distance_m", None),
            Self::TouchdownSpeed => ("touchdown_speed_mps", None),
            Self::DisarmDelay => ("touchdown_to_disarm_s", None),
            Self::TiltMax => ("tilt_max_deg", None),
            Self::HomeDistance => ("home_distance_max_m", None),
        }
    }

    pub(super) fn unit(self) -> &'static str {
        match self {
            Self::TimeTo(_) | Self::TouchdownTime | Self::Flown | Self::DisarmDelay => "s",
            Self::RingRate(_) => "°/s",
            Self::NoseError(_) | Self::TiltMax => "°",
            Self::TouchdownSpeed => "m/s",
            Self::CrossTrackMax(_)
            | Self::CrossTrackRms(_)
            | Self::Overshoot(_)
            | Self::AltitudeError(_)
            | Self::RingError(_)
            | Self::HoldDistance(_)
            | Self::HomeDistance
            | Self::TouchdownDistance => "m",
        }
    }
}

/// Returns the measures of a flight, without those of places that it did not reach.
pub(super) fn measures(route: &Route, track: &Track) -> Vec<(Measure, f64)> {
    let mut found = Vec::new();
    found.extend(track.flown_s.map(|flown_s| (Measure::Flown, flown_s)));
    if let Some(landing) = track.touchdown {
        found.push((Measure::TouchdownTime, landing.time_s));
        let land = route.points.iter().find(|point| point.kind == WaypointType::Land);
        let distance = land.and_then(|point| point.ne).map(|land| (landing.ne - land).norm());
        found.extend(distance.map(|distance| (Measure::TouchdownDistance, distance)));
        found.extend(landing.impact_mps.map(|speed_mps| (Measure::TouchdownSpeed, speed_mps)));
        found.extend(landing.disarmed_after_s.map(|delay_s| (Measure::DisarmDelay, delay_s)));
    }
    let tilts = track.samples.iter().filter_map(|sample| Some(sample.attitude?.tilt_deg));
    found.extend(tilts.reduce(f64::max).map(|tilt_deg| (Measure::TiltMax, tilt_deg)));
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
        let before = index.checked_sub(1).and_then(|before| passed.get(before));
        let Some(leg) = Leg::new(before, passage, track) else { continue };
        let flown = track.samples.get(leg.first..=passage.reached).unwrap_or_default();
        if let Some((most_m, rms_m)) = leg.cross_track_m(flown) {
            found.push((Measure::CrossTrackMax(wp), most_m));
            found.push((Measure::CrossTrackRms(wp), rms_m));
        }
        found.extend(nose_error_deg(flown).map(|error_deg| (Measure::NoseError(wp), error_deg)));
        let overshoot_m = leg.overshoot_m(passage, passed.get(index + 1), &track.samples);
        found.extend(overshoot_m.map(|overshoot_m| (Measure::Overshoot(wp), overshoot_m)));
    }
    found
}

/// Returns the measures of a hold from the samples of the stay at its waypoint.
fn in_hold(passage: &Passage, stay: &[TrackSample]) -> Vec<(Measure, f64)> {
    let point = &passage.point;
    let Some(centre) = point.ne.filter(|_| point.holds) else { return Vec::new() };
    if point.pattern_m == 0.0 {
        let greatest = stay.iter().map(|sample| (sample.ne - centre).norm()).reduce(f64::max);
        return greatest
            .map(|distance_m| (Measure::HoldDistance(point.wp), distance_m))
            .into_iter()
            .collect();
    }
    if !point.is_ring {
        return Vec::new();
    }
    // From north to east is clockwise.
    let step = |pair: &[TrackSample]| match pair {
        [from, to] => {
            let (from, to) = (from.ne - centre, to.ne - centre);
            atan2(from.perp(&to), from.dot(&to))
        }
        _ => 0.0,
    };
    // Only the last lap: the craft first flies to the waypoint, and from there to the ring.
    let (mut turned, mut begin) = (0.0_f64, stay.len().saturating_sub(1));
    while begin > 0 && turned.abs() < TAU {
        begin -= 1;
        turned += stay.get(begin..begin + 2).map_or(0.0, step);
    }
    let lap = stay.get(begin..).unwrap_or_default();
    let (Some(first), Some(last)) = (lap.first(), lap.last()) else { return Vec::new() };
    let seconds = last.time_s - first.time_s;
    if turned.abs() < TAU {
        return Vec::new();
    }
    let squares = lap.iter().map(|sample| ((sample.ne - centre).norm() - point.pattern_m).powi(2));
    vec![
        (Measure::RingError(point.wp), (squares.sum::<f64>() / lap.len() as f64).sqrt()),
        (Measure::RingRate(point.wp), turned.to_degrees() / seconds),
    ]
}

/// Returns the root mean square angle between the nose and the course over ground, degrees; `None` for a craft that
/// hardly moves, or of a log.
fn nose_error_deg(flown: &[TrackSample]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0_u32);
    for pair in flown.windows(2) {
        let [from, to] = pair else { continue };
        let (moved, seconds) = (to.ne - from.ne, to.time_s - from.time_s);
        let Some(attitude) = from.attitude.filter(|_| moved.norm() > SLOWEST_COURSE_MPS * seconds) else {
            continue;
        };
        let course_deg = atan2(moved.y, moved.x).to_degrees();
        let beside_deg = (attitude.heading_deg - course_deg + 180.0).rem_euclid(360.0) - 180.0;
        sum += beside_deg * beside_deg;
        count += 1;
    }
    (count > 0).then(|| (sum / f64::from(count)).sqrt())
}

/// The straight line to a waypoint.
#[derive(Debug, Clone, Copy)]
struct Leg {
    from: Vector2<f64>,
    to: Vector2<f64>,
    /// The first sample on the leg.
    first: usize,
}

impl Leg {
    /// Returns the leg to `passage` from the previous waypoint, or from the place of the engagement. Returns `None`
    /// if there is no straight line: to a TAKEOFF, or from a waypoint that was left out.
    fn new(before: Option<&Passage>, passage: &Passage, track: &Track) -> Option<Self> {
        let to = passage.point.ne?;
        let Some(before) = before else {
            let engaged = track.samples.first().filter(|_| passage.index == 0)?;
            return Some(Self { from: engaged.ne, to, first: 0 });
        };
        if before.index + 1 != passage.index {
            return None;
        }
        // The leg after a pattern begins at the position of the craft.
        let place = before.point.ne.filter(|_| before.point.pattern_m == 0.0);
        let left = track.samples.get(before.left)?;
        Some(Self { from: place.unwrap_or(left.ne), to, first: before.left })
    }

    /// Returns the greatest and the root mean square cross-track error, m.
    fn cross_track_m(&self, flown: &[TrackSample]) -> Option<(f64, f64)> {
        let distances = flown.iter().map(|sample| distance_to_segment(sample.ne, self.from, self.to));
        let most_m = distances.clone().reduce(f64::max)?;
        Some((
            most_m,
            (distances.map(|distance| distance * distance).sum::<f64>() / flown.len() as f64).sqrt(),
        ))
    }

    /// Returns the distance by which the craft went beyond the next leg, to the outside of the corner. At a place
    /// with a hold, and at the last place, it is the distance beyond the place itself.
    fn overshoot_m(&self, at: &Passage, next: Option<&Passage>, samples: &[TrackSample]) -> Option<f64> {
        if at.point.pattern_m > 0.0 || at.point.kind == WaypointType::Land {
            return None;
        }
        let way_in = (self.to - self.from).try_normalize(1e-3)?;
        let stays = at.point.holds || next.is_none();
        let last = match next {
            Some(_) if at.point.holds => at.left,
            Some(next) => next.reached,
            None => samples.len().saturating_sub(1),
        };
        let outside = match next.and_then(|next| next.point.ne) {
            Some(ahead) if !stays => outside_of_corner(way_in, (ahead - self.to).try_normalize(1e-3)?)?,
            _ => way_in,
        };
        let beyond = samples.get(at.reached..=last)?.iter().map(|sample| (sample.ne - self.to).dot(&outside));
        Some(beyond.fold(0.0, f64::max))
    }
}

/// Returns the direction across the way out that points to the outside of the corner. For a turn back it is the way in.
/// Returns `None` if there is no corner.
fn outside_of_corner(way_in: Vector2<f64>, way_out: Vector2<f64>) -> Option<Vector2<f64>> {
    let across = way_in - way_out * way_in.dot(&way_out);
    match across.try_normalize(CORNER) {
        None if way_in.dot(&way_out) < 0.0 => Some(way_in),
        outside => outside,
    }
}
