//! The picture for displays, logs and samples.

use super::Navigator;
use crate::autopilot::guidance::hold_remaining_ds;
use crate::autopilot::io::NavInputs;
use crate::autopilot::machine::waiting_for;
use crate::autopilot::params::Params;
use crate::geo::local_offset;
use crate::telemetry::{L1Mode, NavOutput, NavState, NavTelemetry};

/// Ground speed below which a time to the waypoint says nothing, m/s.
const ETA_MIN_MPS: f64 = 0.5;

impl Navigator {
    pub(super) fn report(&mut self, now: &NavInputs, params: &Params, output: NavOutput) {
        let flying = self.is_flying();
        let speed = now.vel_ne.norm();
        let to_waypoint = self.waypoint_ne(now) - now.pos_ne;
        let distance = to_waypoint.norm();
        let home_distance_m =
            now.home.filter(|_| now.fix).map(|home| (local_offset(now.origin, home) - now.pos_ne).norm());
        let old = &self.telemetry;
        let on_leg = flying && self.state == NavState::Approaching;
        self.telemetry = NavTelemetry {
            state: self.state,
            engaged: flying,
            climbing: self.climb.at.is_some(),
            refusal: old.refusal.filter(|_| !flying),
            reason: old.reason,
            wp: self.index,
            next_wp: self.next_index,
            // A plan holds at most 30.
            count: self.active.waypoints.len() as u8,
            source: self.source,
            kind: self.record(self.index).map(|waypoint| waypoint.kind),
            distance_m: flying.then_some(distance),
            bearing_rad: flying.then(|| to_waypoint.y.atan2(to_waypoint.x).rem_euclid(std::f64::consts::TAU)),
            xte_m: old.xte_m.filter(|_| on_leg),
            along_m: old.along_m.filter(|_| on_leg),
            lookahead_m: old.lookahead_m.filter(|_| on_leg),
            l1_mode: if on_leg { old.l1_mode } else { L1Mode::Off },
            aim_ne: old.aim_ne.filter(|_| flying),
            a_lat_mps2: old.a_lat_mps2.filter(|_| on_leg),
            target_ne: flying.then_some(self.target_ne),
            target_alt_m: flying.then_some(self.target_alt_m),
            leg_start: on_leg.then_some(self.leg.start),
            speed_mps: speed,
            speed_setpoint_mps: flying.then(|| self.position.speed_setpoint_mps()),
            pattern_angle_rad: matches!(self.state, NavState::Orbiting | NavState::Figure8)
                .then_some(self.pattern_angle),
            hold_remaining_ds: self.hold_remaining(now),
            home_distance_m,
            fence_margin_m: params.fence_m().zip(home_distance_m).map(|(limit, distance)| limit - distance),
            eta_s: (on_leg && speed >= ETA_MIN_MPS).then(|| distance / speed),
            stick_override: flying && self.stick_override,
            yaw_override: flying && output.yaw_rate_rps.is_none(),
            touchdown_held_s: self.touchdown_held_us.map(|held| held as f64 * 1e-6),
            hover_us: self.altitude.hover_us(),
            guards: waiting_for(self.state, &self.facts(now, params)),
            output,
        };
    }

    fn hold_remaining(&self, now: &NavInputs) -> u16 {
        match self.state {
            NavState::Holding | NavState::Orbiting | NavState::Figure8 => {
                let duration = self.record(self.index).unwrap_or_default().duration_ds;
                hold_remaining_ds(duration, self.hold_elapsed_us(now))
            }
            NavState::Idle
            | NavState::Approaching
            | NavState::Arrived
            | NavState::Landing
            | NavState::Complete => 0,
        }
    }
}
