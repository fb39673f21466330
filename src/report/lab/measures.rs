//! The numbers that are compared: those that a scenario takes itself, and those that all flights have in common.

use crate::report::compare::{Track, measures};
use crate::report::route::Route;
use crate::scenario::{Better, Case};

/// A number that the flights of both builds have.
#[derive(Debug, Clone, PartialEq)]
pub struct LabMeasure {
    /// The scenario that takes it; `None` = all flights.
    pub scenario: Option<String>,
    /// Its key among the measures of a flight.
    pub key: String,
    /// Its name for people.
    pub title: String,
    /// Its unit; empty if it has none.
    pub unit: &'static str,
    /// The direction in which it improves.
    pub better: Option<Better>,
}

/// The measures of all flights: the key, the title, the unit and the direction in which they improve.
const COMMON: &[(&str, &str, &str, Option<Better>)] = &[
    ("flown_s", "time from the engagement to the end", "s", None),
    ("leg_speed_mps", "speed on a leg", "m/s", None),
    ("corner_speed_mps", "speed at a corner", "m/s", None),
    ("cross_track_rms_m", "cross-track error on a leg, RMS", "m", Some(Better::Less)),
    ("cross_track_max_m", "cross-track error on a leg, max", "m", Some(Better::Less)),
    ("overshoot_m", "overshoot at a waypoint", "m", Some(Better::Less)),
    ("leg_altitude_rms_m", "altitude error on a leg, RMS", "m", Some(Better::Less)),
    ("alt_error_m", "altitude error at a waypoint", "m", Some(Better::Less)),
    ("nose_error_rms_deg", "nose off the course on a leg, RMS", "°", Some(Better::Less)),
    ("ring_radius_m", "radius of an ORBIT", "m", None),
    ("ring_rate_dps", "rate of an ORBIT", "°/s", None),
    ("hold_distance_max_m", "distance from the place of a HOLD, max", "m", Some(Better::Less)),
    ("sink_rate_mps", "sink rate before the touchdown", "m/s", Some(Better::Less)),
    ("touchdown_speed_mps", "speed at the touchdown", "m/s", Some(Better::Less)),
    ("touchdown_distance_m", "touchdown beside the LAND point", "m", Some(Better::Less)),
    ("touchdown_to_disarm_s", "touchdown to disarming", "s", Some(Better::Less)),
    ("tilt_max_deg", "tilt, max", "°", Some(Better::Less)),
    ("yaw_rate_max_dps", "yaw rate, max", "°/s", None),
];

/// Returns the measures of all flights.
pub fn common() -> impl Iterator<Item = LabMeasure> {
    COMMON.iter().map(|&(key, title, unit, better)| LabMeasure {
        scenario: None,
        key: key.to_owned(),
        title: title.to_owned(),
        unit,
        better,
    })
}

/// Returns the measures that a case of a scenario takes itself.
pub fn measures_of_case(scenario: &str, case: &Case) -> impl Iterator<Item = LabMeasure> {
    case.measures.iter().map(move |measure| LabMeasure {
        scenario: Some(scenario.to_owned()),
        key: measure.name.clone(),
        title: format!("{}: {}", scenario.trim_start_matches("lab-"), measure.name.replace('_', " ")),
        unit: measure.dimension.unit().map_or("", |unit| unit.name),
        better: measure.better,
    })
}

/// Returns the values of [`common`] in a flight. The key of one at a waypoint has its index behind a blank.
pub fn measures_of(route: &Route, track: &Track) -> Vec<(String, f64)> {
    let found = measures(route, track).into_iter().filter(|(_, value)| value.is_finite());
    let known = found.filter(|(measure, _)| COMMON.iter().any(|(key, ..)| *key == measure.key().0));
    let named = known.map(|(measure, value)| match measure.key() {
        (key, None) => (key.to_owned(), value.abs()),
        (key, Some(wp)) => (format!("{key} {wp}"), value.abs()),
    });
    named.collect()
}
