//! Recognises a flight that would go on as it is for ever.

use super::report::ForecastEnd;
use crate::flight::waiting;
use crate::signals::SimTime;
use crate::telemetry::NavState;
use crate::vehicle::Vehicle;

/// How long a hold without end is followed, s: long enough to see where it is held.
const HOLD_S: f64 = 20.0;
/// How long a craft is followed with which nothing happens while its sticks stay where they are, s.
const QUIET_S: f64 = 60.0;
/// The same while the scripted pilot waits for something, s.
const PILOT_QUIET_S: f64 = 120.0;
/// A change of height that is something happening, m.
const HEIGHT_M: f64 = 1.0;
/// What is said of a craft that no autopilot flies and that nothing happens to.
pub(super) const LEFT_TO_STICKS: &str = "the sticks have the craft, and the flight has no end";
/// Hold time left that stands for an endless hold, ds.
const ENDLESS_DS: u16 = u16::MAX;

/// The memory of the watch.
#[derive(Debug, Clone, Default)]
pub(super) struct EndlessWatch {
    hold_since: Option<SimTime>,
    /// Since when nothing has happened, and the true altitude then, m.
    quiet_since: Option<(SimTime, f64)>,
}

impl EndlessWatch {
    /// Looks at the vehicle after a tick in which something `happened` or not.
    pub(super) fn look(&mut self, vehicle: &Vehicle, happened: bool) -> Option<(ForecastEnd, String)> {
        let now = vehicle.time();
        let nav = vehicle.controller().nav()?;
        if nav.engaged {
            self.quiet_since = None;
            let holds = matches!(nav.state, NavState::Holding | NavState::Orbiting | NavState::Figure8);
            if !(holds && nav.hold_remaining_ds == Some(ENDLESS_DS)) {
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
        let alt_m = vehicle.world()?.truth().pos_enu.z;
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
