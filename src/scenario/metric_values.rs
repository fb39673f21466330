//! Takes the numbers of a campaign from a flight.

use strum::IntoEnumIterator as _;

use super::case::Case;
use super::happening::{EventName, Happening, HappeningKind};
use super::metric::Metric;
use super::run::Flown;
use super::trace::{Sample, Trace};
use crate::math;
use crate::plan::WaypointType;
use crate::telemetry::signal::Signal;
use crate::telemetry::{NavState, PlanSource};

impl Metric {
    /// Returns its value in a flight; `None` if the flight has none.
    pub fn take(self, flown: &Flown) -> Option<f64> {
        let own = || flown.truth.waypoints.iter().filter(|flown| flown.source == PlanSource::Stored);
        let greatest = |values: &mut dyn Iterator<Item = f64>| values.reduce(f64::max);
        let value = match self {
            Self::CrossTrack => cross_track(&flown.trace),
            Self::AltitudeError => {
                greatest(&mut own().filter_map(|waypoint| waypoint.alt_error_m).map(f64::abs))
            }
            Self::WaypointMiss => greatest(&mut own().map(|waypoint| waypoint.miss_m)),
            Self::Touchdown => {
                own().rfind(|waypoint| waypoint.kind == WaypointType::Land).map(|land| land.miss_m)
            }
            Self::TouchdownNorth => touchdown(flown).map(|[north, _]| north),
            Self::TouchdownEast => touchdown(flown).map(|[_, east]| east),
            Self::Time => Some(flown.flown_s).filter(|_| flown.trace.engaged_at.is_some()),
            Self::BatteryLeft => flown.truth.battery_used_pct.map(|used| (1.0 - used / 100.0).max(0.0)),
            Self::FenceMargin => {
                let margins = flown.trace.samples.iter().map(|sample| sample.value(Signal::FenceMargin));
                margins.filter(|margin| margin.is_finite()).reduce(f64::min)
            }
        };
        value.filter(|value| value.is_finite())
    }
}

/// Returns all metrics of a flight that it has, in their order, then its measures.
pub fn metrics(case: &Case, flown: &Flown, measures: &[(String, f64)]) -> Vec<(String, f64)> {
    let own = Metric::iter().filter_map(|metric| Some((metric.to_string(), metric.take(flown)?)));
    let named = |name: &str| case.measures.iter().any(|measure| measure.name == name);
    let of_file = measures.iter().filter(|(name, value)| named(name) && value.is_finite()).cloned();
    own.chain(of_file).collect()
}

/// Returns the greatest distance from the leg on which the craft was. The first leg begins at the engagement. A leg counts
/// from the moment at which its waypoint became the present one.
fn cross_track(trace: &Trace) -> Option<f64> {
    let engaged = trace.engaged_at?;
    let mut worst: Option<f64> = None;
    let mut leg: Option<(u8, [f64; 2], [f64; 2])> = None;
    for sample in trace.samples.iter().filter(|sample| sample.time >= engaged) {
        if sample.state != NavState::Approaching || sample.source != PlanSource::Stored {
            continue;
        }
        if leg.is_none_or(|(wp, ..)| wp != sample.wp) {
            leg = leg_to(sample, trace);
        }
        let Some((_, from, to)) = leg else { continue };
        let distance = beside(sample.place(), from, to);
        worst = Some(worst.map_or(distance, |worst| worst.max(distance)));
    }
    worst
}

/// Returns the leg to the current waypoint, from the waypoint before it or from the position of the craft.
fn leg_to(sample: &Sample, trace: &Trace) -> Option<(u8, [f64; 2], [f64; 2])> {
    let to = trace.waypoint(sample.wp, PlanSource::Stored, sample.time)?;
    let plan = trace.plan(PlanSource::Stored, sample.time)?;
    let is_place =
        |wp: &u8| plan.waypoints.get(usize::from(*wp)).is_some_and(|waypoint| waypoint.kind.is_positional());
    let before = (0..sample.wp).rev().find(is_place);
    let from = before.and_then(|wp| trace.waypoint(wp, PlanSource::Stored, sample.time));
    Some((sample.wp, from.unwrap_or_else(|| sample.place()), to))
}

/// Returns the distance of a place from the line through two others; from the second one if they are the same.
fn beside(place: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let (north, east) = (to[0] - from[0], to[1] - from[1]);
    let length = math::hypot(north, east);
    let (place_north, place_east) = (place[0] - to[0], place[1] - to[1]);
    if length < 0.1 {
        return math::hypot(place_north, place_east);
    }
    ((place_east * north - place_north * east) / length).abs()
}

/// Returns the position of the last touchdown, north and east of the LAND of the plan, m.
fn touchdown(flown: &Flown) -> Option<[f64; 2]> {
    let trace = &flown.trace;
    let land = flown
        .truth
        .waypoints
        .iter()
        .rfind(|flown| flown.source == PlanSource::Stored && flown.kind == WaypointType::Land)?;
    let is_touchdown = |happening: &&Happening| {
        matches!(happening.kind, HappeningKind::Event { name: EventName::Touchdown, .. })
    };
    let at = trace.happenings.iter().rfind(is_touchdown)?.time;
    let place = trace.samples.get(trace.index_at(at.0 as i64)?)?.place();
    let wanted = trace.waypoint(land.wp, PlanSource::Stored, at)?;
    Some([place[0] - wanted[0], place[1] - wanted[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_from_a_leg_is_that_from_its_line() {
        let from = [0.0, 0.0];
        assert!((beside([50.0, 3.0], from, [100.0, 0.0]) - 3.0).abs() < 1e-12);
        assert!((beside([-5.0, -4.0], from, [0.0, 10.0]) - 5.0).abs() < 1e-12);
        assert!((beside([3.0, 4.0], from, from) - 5.0).abs() < 1e-12, "a leg without a length");
    }
}
