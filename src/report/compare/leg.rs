//! The measures of the straight leg to a waypoint.

use nalgebra::Vector2;

use super::measure::Measure;
use super::passage::Passage;
use super::track::Track;
use crate::math::atan2;
use crate::plan::WaypointType;
use crate::report::route::{TrackSample, distance_to_segment};

/// The sine of the smallest turn that counts as a corner, about 10°.
const CORNER: f64 = 0.17;
/// The speed below which the course over ground has no meaning for the nose, m/s.
const SLOWEST_COURSE_MPS: f64 = 1.0;
/// The samples on each side of one over which its speed is taken.
const BESIDE: usize = 2;

/// Returns the measures of the leg to a passage, and of the corner at its end; none if there is no straight leg.
pub(super) fn on_leg(passed: &[Passage], index: usize, track: &Track) -> Vec<(Measure, f64)> {
    let before = index.checked_sub(1).and_then(|before| passed.get(before));
    let Some(passage) = passed.get(index) else { return Vec::new() };
    let Some(leg) = Leg::new(before, passage, track) else { return Vec::new() };
    let (wp, next) = (passage.point.wp, passed.get(index + 1));
    let flown = track.samples.get(leg.first..=passage.reached).unwrap_or_default();
    let mut found = Vec::new();
    if let Some((most_m, rms_m)) = leg.cross_track_m(flown) {
        found.push((Measure::CrossTrackMax(wp), most_m));
        found.push((Measure::CrossTrackRms(wp), rms_m));
    }
    found.extend(nose_error_deg(flown).map(|error_deg| (Measure::NoseError(wp), error_deg)));
    found.extend(leg.speed_mps(flown).map(|speed_mps| (Measure::LegSpeed(wp), speed_mps)));
    let second_half = flown.get(flown.len() / 2..).unwrap_or_default();
    let squares = second_half.iter().map(|sample| (sample.alt_m - passage.point.alt_m).powi(2));
    found.push((Measure::LegAltitude(wp), (squares.sum::<f64>() / second_half.len() as f64).sqrt()));
    let overshoot_m = leg.overshoot_m(passage, next, &track.samples);
    found.extend(overshoot_m.map(|overshoot_m| (Measure::Overshoot(wp), overshoot_m)));
    if next.is_some() && !passage.point.holds {
        let speed_mps = speed_mps(&track.samples, passage.left);
        found.extend(speed_mps.map(|speed_mps| (Measure::CornerSpeed(wp), speed_mps)));
    }
    found
}

/// Returns the ground speed at a sample.
fn speed_mps(samples: &[TrackSample], at: usize) -> Option<f64> {
    let (from, to) = (samples.get(at.saturating_sub(BESIDE))?, samples.get(at + BESIDE)?);
    Some((to.ne - from.ne).norm() / (to.time_s - from.time_s))
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
        let beside_deg = wrapped_deg(attitude.heading_deg - course_deg);
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

    /// Returns the mean ground speed in the middle half of the leg; `None` if the craft was not there.
    fn speed_mps(&self, flown: &[TrackSample]) -> Option<f64> {
        let along = self.to - self.from;
        let share = |sample: &TrackSample| (sample.ne - self.from).dot(&along) / along.norm_squared();
        let from = flown.iter().find(|sample| share(sample) >= 0.25)?;
        let to = flown.iter().find(|sample| share(sample) >= 0.75)?;
        (to.time_s > from.time_s).then(|| (to.ne - from.ne).norm() / (to.time_s - from.time_s))
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

/// Returns an angle as −180 to 180 degrees.
pub(super) fn wrapped_deg(angle_deg: f64) -> f64 {
    (angle_deg + 180.0).rem_euclid(360.0) - 180.0
}
