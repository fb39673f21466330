//! Reports the results of an update for displays, logs and samples.

use arrayvec::ArrayVec;

use super::Navigator;
use super::fly::Flown;
use super::observed::Observed;
use crate::autopilot::control::FlightControllers;
use crate::autopilot::guidance::hold_remaining_s;
use crate::autopilot::io::NavInputs;
use crate::autopilot::machine::{Facts, waiting_for};
use crate::autopilot::params::Params;
use crate::plan::Seconds;
use crate::telemetry::{L1Mode, NavState, NavTelemetry};

/// The ground speed below which a time to the waypoint is meaningless, m/s.
const ETA_MIN_MPS: f64 = 0.5;

impl Navigator {
    /// Reports an update. `flown` has the facts of the decision and the result of flying it, if anything was flown.
    pub(super) fn report(
        &mut self,
        now: &NavInputs,
        params: &Params,
        seen: &Observed,
        controllers: &FlightControllers,
        flown: Option<(&Facts, Flown)>,
    ) {
        let speed = seen.ground_speed_mps;
        let home_distance_m = seen.home_distance_m.filter(|_| now.fix);
        let status = NavTelemetry {
            speed_mps: speed,
            home_distance_m,
            fence_margin_m: params.fence_m().zip(home_distance_m).map(|(limit, distance)| limit - distance),
            touchdown_held_s: controllers.land.held_us().map(|held| held as f64 * 1e-6),
            hover_us: controllers.altitude.hover_us(),
            ..NavTelemetry::idle()
        };
        let guards = flown.map_or_else(ArrayVec::new, |(facts, _)| waiting_for(self.state, facts));
        let on_leg = flown.is_some() && self.state == NavState::Approaching;
        self.telemetry = match flown {
            None => status,
            Some((_, Flown { output, path })) => NavTelemetry {
                distance_m: Some(seen.distance_m),
                bearing_rad: Some(
                    seen.to_waypoint.y.atan2(seen.to_waypoint.x).rem_euclid(std::f64::consts::TAU),
                ),
                xte_m: path.xte_m.filter(|_| on_leg),
                along_m: path.along_m.filter(|_| on_leg),
                lookahead_m: path.lookahead_m.filter(|_| on_leg),
                l1_mode: Some(if on_leg { path.l1_mode } else { L1Mode::Off }),
                aim_ne: Some(path.aim_ne),
                a_lat_mps2: path.a_lat_mps2.filter(|_| on_leg),
                target_ne: Some(self.target_ne),
                target_alt_m: Some(self.target_alt_m),
                leg_start: on_leg.then_some(self.leg.start),
                speed_setpoint_mps: Some(controllers.position.speed_setpoint_mps()),
                pattern_angle_rad: matches!(self.state, NavState::Orbiting | NavState::Figure8)
                    .then(|| self.hold.phase_rad()),
                hold_remaining_s: Some(self.hold_remaining_s(now)),
                held_by_command: self.hold.is_by_command(),
                eta_s: (on_leg && speed >= ETA_MIN_MPS).then(|| seen.distance_m / speed),
                stick_override: seen.stick_override,
                cannot_hold: self.station.reported(),
                yaw_override: output.yaw_rate_rps.is_none(),
                guards,
                output,
                ..status
            },
        };
        self.report_status();
    }

    /// Reports state, plan and refusal, also between two updates.
    pub(super) fn report_status(&mut self) {
        let is_flying = self.is_flying();
        let telemetry = &mut self.telemetry;
        telemetry.state = self.state;
        telemetry.engaged = is_flying;
        telemetry.climbing = self.climb.is_on();
        telemetry.refusal = self.engagement.refused().filter(|_| !is_flying);
        telemetry.reason = self.reason;
        telemetry.wp = self.cursor.index();
        telemetry.next_wp = self.cursor.next_index();
        telemetry.count = self.cursor.count();
        telemetry.source = self.cursor.source();
        telemetry.kind = self.cursor.current().map(|waypoint| waypoint.kind);
    }

    fn hold_remaining_s(&self, now: &NavInputs) -> f64 {
        match self.state {
            NavState::Holding if self.hold.is_by_command() => hold_remaining_s(Seconds::default(), 0),
            NavState::Holding | NavState::Orbiting | NavState::Figure8 => {
                let duration = self.cursor.current().unwrap_or_default().duration;
                hold_remaining_s(duration, self.hold.elapsed_us(now.time))
            }
            NavState::Idle
            | NavState::Approaching
            | NavState::Arrived
            | NavState::Landing
            | NavState::Complete => 0.0,
        }
    }
}
