//! Recognises a flight that would continue for ever.

use super::report::ForecastEnd;
use crate::flight::waiting;
use crate::signals::SimTime;
use crate::telemetry::NavState;
use crate::vehicle::Vehicle;

/// The time that a hold without end is followed, s: long enough to see the place of the hold.
const HOLD_S: f64 = 20.0;
/// The time that a craft without any event is followed while its sticks do not move, s.
const QUIET_S: f64 = 60.0;
/// The same while the scripted pilot waits for something, s.
const PILOT_QUIET_S: f64 = 120.0;
/// The change of height that counts as an event, m.
const HEIGHT_M: f64 = 1.0;
/// The text for a craft without autopilot and without events.
pub(super) const LEFT_TO_STICKS: &str = "the sticks have the craft, and the flight has no end";

/// The state of the watch.
#[derive(Debug, Clone, Default)]
pub(super) struct EndlessWatch {
    hold_since: Option<SimTime>,
    /// Time since which nothing has happened, and the true altitude then, m.
    quiet_since: Option<(SimTime, f64)>,
}

impl EndlessWatch {
    /// Observes the vehicle after a tick. `happened` is `true` if there was an event in it. Returns the end if the
    /// flight is endless.
    pub(super) fn look(&mut self, vehicle: &Vehicle, happened: bool) -> Option<(ForecastEnd, String)> {
        let now = vehicle.time();
        let nav = vehicle.controller().nav()?;
        if nav.engaged {
            self.quiet_since = None;
            let holds = matches!(nav.state, NavState::Holding | NavState::Orbiting | NavState::Figure8);
            if !(holds && nav.hold_remaining_s == Some(f64::INFINITY)) {
                self.hold_since = None;
                return None;
            }
            let since = *self.hold_since.get_or_insert(now);
            return (now.seconds_since(since) >= HOLD_S).then(|| {
                let place =
                    if nav.held_by_command { "here".to_owned() } else { format!("at waypoint {}", nav.wp) };
                (ForecastEnd::Endless, format!("holds {place} without end"))
            });
        }
        self.hold_since = None;
        let alt_m = vehicle.truth()?.pos_enu.z;
        let (since, from_m) = *self.quiet_since.get_or_insert((now, alt_m));
        if happened || (alt_m - from_m).abs() > HEIGHT_M {
            self.quiet_since = Some((now, alt_m));
            return None;
        }
        let doing = vehicle.transmitter().pilot_doing();
        let limit_s = if doing.is_some() { PILOT_QUIET_S } else { QUIET_S };
        (now.seconds_since(since) >= limit_s).then(|| quiet_end(vehicle, doing))
    }
}

fn quiet_end(vehicle: &Vehicle, pilot_doing: Option<&str>) -> (ForecastEnd, String) {
    let is_armed = vehicle.controller().is_armed();
    match (is_armed, pilot_doing) {
        (false, _) => {
            let why = waiting::sentence(vehicle, 0.0).map_or_else(String::new, |why| format!(": {why}"));
            (ForecastEnd::Grounded, format!("the craft does not take off{why}"))
        }
        (true, Some(doing)) => (ForecastEnd::Endless, format!("the scripted pilot is still {doing}")),
        (true, None) => (ForecastEnd::Endless, LEFT_TO_STICKS.to_owned()),
    }
}
