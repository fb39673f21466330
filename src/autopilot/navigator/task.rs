//! The task of an engagement: the active plan with its place, the current leg, and the values kept from leg to leg.

use super::climb::Climb;
use super::cursor::PlanCursor;
use super::leg::Leg;
use super::rescue::Rescue;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::LatLon;
use crate::plan::{Modifier, Waypoint};

/// The plan and the leg of an engagement.
#[derive(Debug, Clone, Default)]
pub(super) struct Task {
    pub cursor: PlanCursor,
    pub leg: Leg,
    pub climb: Climb,
    pub rescue: Option<Rescue>,
    /// Yaw rate cap of a YAW_RATE waypoint, deg/s.
    pub yaw_cap_dps: Option<f64>,
}

impl Task {
    /// Begins the first leg of an engagement, from the craft. A resumed leg keeps its altitude change and the yaw cap
    /// of the plan before it. A delay is not repeated.
    pub(super) fn begin_first_leg(&mut self, index: u8, resumed: bool, now: &NavInputs, params: &Params) {
        let before = self.cursor.plan().waypoints.iter().take(usize::from(index));
        let run = before.rev().take_while(|waypoint| !waypoint.kind.is_positional()).count();
        // Both are below 30.
        self.begin_leg(index, index - run as u8, now.here(), now, params);
        if resumed {
            self.leg.delay = None;
            if let Some(cap) = self.cursor.yaw_rate_before(index) {
                self.yaw_cap_dps = yaw_cap(cap);
            }
        }
    }

    /// Starts the leg from `start` to waypoint `index` and applies the modifiers from `modifiers_from` on.
    pub(super) fn begin_leg(
        &mut self,
        index: u8,
        modifiers_from: u8,
        start: LatLon,
        now: &NavInputs,
        params: &Params,
    ) {
        let Some(waypoint) = self.cursor.waypoint(index) else { return };
        self.cursor.move_to(index);
        self.leg = Leg::to(&waypoint, start, now, params);
        for modifier in (modifiers_from..index).map_while(|at| self.cursor.waypoint(at)) {
            match modifier.kind.modifier() {
                Some(Modifier::Altitude) => self.leg.altitude_m = modifier.altitude.above_home_m(),
                Some(Modifier::YawRate) => self.yaw_cap_dps = yaw_cap(&modifier),
                Some(Modifier::Delay) => self.leg.set_delay(&modifier, now),
                None => {}
            }
        }
    }

    /// Returns the maximum speed on the leg, m/s.
    pub(super) fn speed_mps(&self, now: &NavInputs, params: &Params) -> f64 {
        self.leg.speed_mps(self.cursor.current().unwrap_or_default().speed, now, params)
    }

    /// Returns the altitude at which the climb before the first leg is done, m.
    pub(super) fn climb_goal_m(&self, params: &Params) -> f64 {
        let rescue = self.rescue.map_or(f64::NEG_INFINITY, |rescue| rescue.altitude_m - 1.0);
        f64::from(params.min_nav_altitude_m).max(rescue)
    }

    /// Returns the settings with the climb rate of a rescue.
    pub(super) fn with_rescue_climb(&self, params: &Params) -> Params {
        match self.rescue {
            // Saturates at the range of the setting.
            Some(rescue) => {
                Params { alt_hold_climb_rate: (rescue.climb_mps * 10.0).clamp(1.0, 200.0) as u8, ..*params }
            }
            None => *params,
        }
    }
}

fn yaw_cap(modifier: &Waypoint) -> Option<f64> {
    (modifier.yaw_rate_dps > 0).then(|| f64::from(modifier.yaw_rate_dps))
}
