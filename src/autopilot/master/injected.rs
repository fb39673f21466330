//! Plans that replace the pilot's: home, a rescue, a landing here.

use super::mission::{Mission, Return};
use crate::autopilot::io::NavInputs;
use crate::autopilot::navigator::Rescue;
use crate::autopilot::params::Params;
use crate::geo::{LatLon, offset_to_latlon};
use crate::plan::{Altitude, FlightPlan, LegSpeed, Seconds, Waypoint, WaypointType};
use crate::telemetry::{Guard, PlanSource, TransitionReason};

/// A rescue that starts near home flies at least this far above it, m.
const NEAR_HOME_M: f64 = 7.5;

impl Mission {
    /// Replaces the mission by a way home with a landing. Without a known home nothing changes.
    pub(super) fn fly_home(
        &mut self,
        home: Return,
        reason: TransitionReason,
        guard: Option<Guard>,
        now: &NavInputs,
        params: &Params,
    ) {
        let Some(place) = now.home else { return };
        let leg = |kind| injected(kind, place, home.altitude_m.max(now.alt_m), home.speed_mps);
        let legs = [leg(WaypointType::Flyover), leg(WaypointType::Land)];
        self.inject(PlanSource::Rth, &legs, reason, guard, now, params);
    }

    /// Replaces the mission by a rescue: up to the altitude of the return here, home, and down.
    pub(super) fn fly_rescue(&mut self, rescue: Rescue, now: &NavInputs, params: &Params) {
        let Some(home) = now.home else { return };
        let altitude_m = match rescue.near_climb_m {
            Some(climb_m) => NEAR_HOME_M.max(now.alt_m + climb_m),
            None => rescue.altitude_m,
        };
        let leg = |kind, place| injected(kind, place, altitude_m.max(now.alt_m), rescue.speed_mps);
        let here = offset_to_latlon(now.origin, now.pos_ne);
        let climb = Waypoint { duration: Seconds::AT_ONCE, ..leg(WaypointType::Hold, here) };
        let legs = [climb, leg(WaypointType::Flyover, home), leg(WaypointType::Land, home)];
        self.inject(PlanSource::Rth, &legs, TransitionReason::ReturnHome, None, now, params);
        self.rescue = Some(rescue);
    }

    /// Replaces the mission by a landing here.
    pub(super) fn land_here(&mut self, now: &NavInputs, params: &Params) {
        let here = offset_to_latlon(now.origin, now.pos_ne);
        let land = injected(WaypointType::Land, here, now.alt_m, 0.0);
        self.inject(PlanSource::Emergency, &[land], TransitionReason::Emergency, None, now, params);
    }

    fn inject(
        &mut self,
        source: PlanSource,
        waypoints: &[Waypoint],
        reason: TransitionReason,
        guard: Option<Guard>,
        now: &NavInputs,
        params: &Params,
    ) {
        let mut plan = FlightPlan::default();
        plan.waypoints.extend(waypoints.iter().copied());
        self.start((&plan, source, 0.0), reason, guard, now, params);
    }
}

fn injected(kind: WaypointType, position: LatLon, altitude_m: f64, speed_mps: f64) -> Waypoint {
    Waypoint {
        kind,
        position,
        altitude: Altitude::above_home(altitude_m),
        speed: LegSpeed::from_mps(speed_mps),
        ..Waypoint::default()
    }
}
