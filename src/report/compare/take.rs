//! Takes the measures of a flight.

use super::hold::in_hold;
use super::leg::{on_leg, wrapped_deg};
use super::measure::Measure;
use super::passage::passages;
use super::track::Track;
use crate::plan::WaypointType;
use crate::report::route::{Route, TrackSample};

/// The heights above the touchdown between which the sink rate is taken, m. Below them the craft brakes or the ground cushions
/// it.
const SINK_M: [f64; 2] = [8.0, 2.0];
/// The time over which a yaw rate is taken, s. Shorter ones show the noise of the loop.
const YAW_S: f64 = 0.2;

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
