//! The output of `waypoint status`.

use crate::geo::LatLon;
use crate::plan::WaypointType;
use crate::telemetry::{AbortReason, NavState};

/// The maximum number of waypoints that are read from a list.
const MAX_WAYPOINTS: usize = 256;

/// The mission that a flight controller reports.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mission {
    /// The plan that is flown, or the stored one.
    pub waypoints: Vec<PlannedWaypoint>,
    /// The phase of the mission; `None` if it is not reported.
    pub phase: Option<MissionPhase>,
    /// The index of the current waypoint.
    pub waypoint: Option<u8>,
    /// The number of waypoints in the current plan.
    pub count: Option<u8>,
    /// Distance to the current waypoint, m.
    pub distance_m: Option<f64>,
    /// Bearing to the current waypoint, degrees clockwise from north.
    pub bearing_deg: Option<f64>,
    /// Time to the current waypoint, s.
    pub eta_s: Option<f64>,
}

/// The phase of a mission.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MissionPhase {
    /// The autopilot does not fly the mission. It may give a reason.
    Inactive {
        /// The reason for a refusal.
        refused: Option<String>,
    },
    /// The mission is flown, in this state of the waypoint machine.
    Flying(NavState),
    /// The autopilot aborted the mission.
    Aborted {
        /// The cause in the flight controller's words.
        cause: String,
    },
}

/// A waypoint as listed in the status.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedWaypoint {
    pub position: LatLon,
    /// The altitude, m, above this firmware's reference.
    pub alt_m: f64,
    /// The type of the waypoint.
    pub kind: WaypointType,
}

impl Mission {
    /// Parses the output. Returns `None` if it is no status.
    pub fn parse(output: &str) -> Option<Self> {
        let mut mission = Self::default();
        let (mut is_status, mut cause, mut state) = (false, None, None);
        for line in output.lines().map(str::trim) {
            let (label, rest) = line.split_once(':').map_or((line, ""), |(label, rest)| (label, rest.trim()));
            match label {
                "Waypoint count" | "Runtime status" => is_status = true,
                "inactive" => mission.phase = Some(MissionPhase::Inactive { refused: None }),
                "refused" => mission.phase = Some(MissionPhase::Inactive { refused: Some(rest.to_owned()) }),
                "state" => state = Some(rest),
                "abort reason" => cause = Some(rest).filter(|cause| *cause != "NONE"),
                "current waypoint" => mission.read_current(rest),
                "distance" => mission.read_distance(line),
                _ if line.starts_with('[') && mission.waypoints.len() < MAX_WAYPOINTS => {
                    mission.waypoints.extend(planned_waypoint(line));
                }
                _ => {}
            }
        }
        mission.phase = match (mission.phase, cause, state) {
            (_, Some(cause), _) => Some(MissionPhase::Aborted { cause: cause.to_owned() }),
            (_, None, Some("ABORTED")) => Some(MissionPhase::Aborted { cause: String::new() }),
            (_, None, Some("IDLE")) => Some(MissionPhase::Inactive { refused: None }),
            (_, None, Some(word)) => nav_state(word).map(MissionPhase::Flying),
            (phase, None, None) => phase,
        };
        is_status.then_some(mission)
    }

    /// Returns the cause of an abort if it is a known one.
    pub fn abort_reason(&self) -> Option<AbortReason> {
        let Some(MissionPhase::Aborted { cause }) = &self.phase else { return None };
        [AbortReason::Stalled, AbortReason::Flyaway, AbortReason::GpsLost, AbortReason::NoPlan]
            .into_iter()
            .find(|reason| reason.to_string().replace('_', " ") == cause.replace('_', " "))
    }

    /// Reads `2/5`, counted from 1.
    fn read_current(&mut self, value: &str) {
        let (number, count) = value.split_once('/').unwrap_or((value, ""));
        self.waypoint = number.trim().parse::<u8>().ok().and_then(|number| number.checked_sub(1));
        self.count = count.trim().parse().ok();
    }

    /// Reads `distance: 210.44m  bearing: 0 deg  eta: 39s`. The last two may be missing.
    fn read_distance(&mut self, line: &str) {
        let number = |label: &str| {
            let (_, rest) = line.split_once(label)?;
            let rest = rest.trim_start();
            let end =
                rest.find(|letter: char| !matches!(letter, '0'..='9' | '.' | '-')).unwrap_or(rest.len());
            rest[..end].parse::<f64>().ok().filter(|number| number.is_finite())
        };
        self.distance_m = number("distance:");
        self.bearing_deg = number("bearing:").map(|bearing| bearing.rem_euclid(360.0));
        self.eta_s = number("eta:");
    }
}

/// Returns the state with this name, in either vocabulary.
fn nav_state(word: &str) -> Option<NavState> {
    use strum::IntoEnumIterator as _;
    match word {
        "TARGETING" | "CLIMBING" => Some(NavState::Approaching),
        _ => NavState::iter().find(|state| state.to_string() == word),
    }
}

/// Parses `[0] -27.4973051 153.0000000 40.00m FLYOVER`.
fn planned_waypoint(line: &str) -> Option<PlannedWaypoint> {
    let mut words = line.split_ascii_whitespace().skip(1);
    let mut number = |unit: &str| words.next()?.trim_end_matches(unit).parse::<f64>().ok();
    let (lat_deg, lon_deg, alt_m) = (number("")?, number("")?, number("m")?);
    let position = LatLon::from_degrees(lat_deg, lon_deg);
    let kind = words.next()?.parse().ok()?;
    (position.is_on_globe() && alt_m.is_finite()).then_some(PlannedWaypoint { position, alt_m, kind })
}
