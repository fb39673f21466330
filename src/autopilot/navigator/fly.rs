//! Flies a state: the demands of the controllers.

use nalgebra::Vector2;

use super::observed::Observed;
use super::steer::PathView;
use super::task::Task;
use crate::autopilot::control::{
    AltitudeMeasurement, AltitudeTarget, FlightControllers, PositionMeasurement, YawController, YawFacts,
    earth_to_body, throttle_share,
};
use crate::autopilot::io::{NavInputs, NavOutput};
use crate::autopilot::params::Params;
use crate::math;
use crate::telemetry::NavState;

/// The deflection of a stick at its end.
const FULL_STICK: f64 = 500.0;

/// The result of flying an update.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flown {
    pub output: NavOutput,
    pub path: PathView,
    /// Maximum tilt, rad, if it must be reported now that the thrust is too low for the tilt. This is once per leg.
    pub limited_tilt_rad: Option<f64>,
}

/// No setpoint outside a landing goes below this altitude, m, unless the waypoint is well below home.
const LOWEST_M: f64 = 1.0;
const BELOW_HOME_M: f64 = -2.0;

/// Returns the altitude target (m) that keeps the craft off the ground: not below 1 m above home or, if the setpoint
/// is already lower, not below the setpoint. To a waypoint well below home, where the ground must be lower, too, the
/// craft sinks as slowly as in a landing.
fn above_ground_m(target_m: f64, now: &NavInputs, params: &Params, setpoint_m: f64) -> f64 {
    if target_m >= BELOW_HOME_M {
        return target_m.max(LOWEST_M.min(setpoint_m));
    }
    if now.alt_m >= f64::from(params.landing_altitude_m) {
        return target_m;
    }
    // The setpoint moves at √(2·1 m/s²·remaining distance).
    target_m.max(setpoint_m - 0.5 * math::powi(params.descent_rate_mps(), 2))
}

/// Returns the share of the full deflection beyond the deadband, −1…1. The share begins at zero, so that there is no
/// step at the deadband.
fn stick_share(stick: f64, params: &Params) -> f64 {
    let deadband = f64::from(params.stick_deadband);
    let beyond = (stick.abs() - deadband).max(0.0) / (FULL_STICK - deadband).max(1.0);
    beyond.min(1.0).copysign(stick)
}

/// The controls of an engagement: the target to keep, and the heading.
#[derive(Debug, Clone, Default)]
pub(super) struct Steering {
    /// Target of the last update, north and east, m.
    pub target_ne: Vector2<f64>,
    pub target_alt_m: f64,
    /// `true` if the craft was taken over since the last update and the controllers are not engaged yet.
    takes_over: bool,
    yaw: YawController,
}

impl Steering {
    /// Takes over the craft where it is. If nothing was flown before, the next update engages the controllers.
    pub(super) fn take_over(&mut self, now: &NavInputs, was_idle: bool) {
        if was_idle {
            self.takes_over = true;
            self.yaw.reset();
        }
        self.target_ne = now.pos_ne;
        self.target_alt_m = now.alt_m;
    }

    /// Leaves the craft to something else.
    pub(super) fn release(&mut self) {
        self.takes_over = false;
        self.yaw.reset();
    }

    /// Engages the controllers once after taking over the craft.
    pub(super) fn engage(&mut self, now: &NavInputs, params: &Params, controllers: &mut FlightControllers) {
        if std::mem::take(&mut self.takes_over) {
            controllers.engage(now, params);
        }
    }

    /// Returns the demands of this update.
    pub(super) fn fly(
        &mut self,
        state: NavState,
        task: &mut Task,
        seen: &Observed,
        controllers: &mut FlightControllers,
    ) -> Flown {
        let (now, params) = (seen.now, &task.with_rescue_climb(seen.params));
        let seen = &Observed { params, ..*seen };
        let (target, path) = task.horizontal_target(state, self.target_ne, seen, &mut controllers.land);
        self.target_ne = target.target;
        let altitude = self.altitude_target(state, task, seen, controllers);
        let FlightControllers { altitude: altitude_controller, land, .. } = controllers;
        altitude_controller.set_relief_us(land.relief_us());
        let throttle_us =
            altitude_controller.update(&AltitudeMeasurement::from(now), altitude, params, now.dt);
        self.target_alt_m = match altitude {
            AltitudeTarget::Altitude(altitude_m) => altitude_m,
            AltitudeTarget::Landing { setpoint_m, .. } => setpoint_m,
            AltitudeTarget::Rate(_) => altitude_controller.setpoint_m(),
        };
        controllers.limit_tilt(now, params);
        let is_limited =
            controllers.thrust_limits_tilt() && !std::mem::replace(&mut task.leg.reported_limited, true);
        let limited_tilt_rad = is_limited.then(|| controllers.position.max_tilt_rad(params));
        let position_controller = &mut controllers.position;
        let horizontal = PositionMeasurement::from(now);
        let tilt = if seen.stick_override {
            position_controller.track(&horizontal, now.dt);
            Vector2::new(stick_share(now.stick_pitch, params), stick_share(now.stick_roll, params))
                .cap_magnitude(1.0)
                * position_controller.max_tilt_rad(params)
        } else {
            let demand = position_controller.update(&horizontal, &target, params, now.dt);
            earth_to_body(demand, now.heading_rad)
        };
        let output = NavOutput {
            roll_rad: tilt.y,
            pitch_down_rad: tilt.x,
            yaw_rate_rps: self.yaw_rate(task, seen),
            throttle: throttle_share(throttle_us, params),
            throttle_us,
        };
        Flown { output, path, limited_tilt_rad }
    }

    fn altitude_target(
        &self,
        state: NavState,
        task: &mut Task,
        seen: &Observed,
        controllers: &mut FlightControllers,
    ) -> AltitudeTarget {
        let (now, params) = (seen.now, seen.params);
        let FlightControllers { altitude, land, .. } = controllers;
        match state {
            NavState::Landing => task
                .leg
                .descent
                .target(now, params, (altitude.setpoint_m(), altitude.throttle_us()), land)
                .unwrap_or(AltitudeTarget::Altitude(self.target_alt_m)),
            NavState::Complete | NavState::Idle => AltitudeTarget::Altitude(above_ground_m(
                self.target_alt_m,
                now,
                params,
                altitude.setpoint_m(),
            )),
            NavState::Approaching if task.climb.is_on() => {
                AltitudeTarget::Altitude(task.leg.altitude_m.max(task.climb_goal_m(params) + 1.0))
            }
            NavState::Approaching
            | NavState::Arrived
            | NavState::Holding
            | NavState::Orbiting
            | NavState::Figure8 => AltitudeTarget::Altitude(above_ground_m(
                task.leg.altitude_m,
                now,
                params,
                altitude.setpoint_m(),
            )),
        }
    }

    fn yaw_rate(&mut self, task: &Task, seen: &Observed) -> Option<f64> {
        let (now, params) = (seen.now, seen.params);
        if now.stick_yaw.abs() > f64::from(params.stick_deadband) {
            self.yaw.reset();
            return None;
        }
        let stops = task.cursor.kind().stops();
        let facts = YawFacts {
            heading_rad: now.heading_rad,
            yaw_rate_rps: now.yaw_rate_rps,
            course_rad: math::atan2(now.vel_ne.y, now.vel_ne.x),
            ground_speed_mps: seen.ground_speed_mps,
            bearing_rad: math::atan2(seen.to_waypoint.y, seen.to_waypoint.x),
            distance_m: seen.distance_m,
            acceptance_radius_m: if stops { params.hold_radius_m() } else { params.arrival_radius_m() },
        };
        Some(self.yaw.update(&facts, task.yaw_cap_dps, params, now.dt))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::Navigator;
    use crate::plan::{Altitude, FlightPlan, Waypoint, WaypointType};
    use crate::signals::SimTime;

    #[test]
    fn what_the_autopilot_has_learned_fades_while_the_pilot_overrides_it() {
        let params = Params::default();
        let mut at_point = NavInputs::hovering();
        let hold = Waypoint {
            position: at_point.origin,
            altitude: Altitude::above_home(20.0),
            kind: WaypointType::Hold,
            ..Waypoint::default()
        };
        let plan = FlightPlan { waypoints: [hold].into_iter().collect() };
        let (mut navigator, mut controllers) = (Navigator::new(), FlightControllers::default());
        navigator.engage(&at_point, &params, &plan).unwrap();
        let mut pitch_deg = |north_m: f64, stick_pitch: f64, seconds: f64| {
            let mut pitch_down_rad = 0.0;
            for _ in 0..(seconds / at_point.dt).round() as usize {
                at_point.time = SimTime(at_point.time.0 + 10_000);
                let now = NavInputs { pos_ne: Vector2::new(north_m, 0.0), stick_pitch, ..at_point.clone() };
                pitch_down_rad = navigator.update(&now, &params, &plan, &mut controllers).pitch_down_rad;
            }
            assert_eq!(navigator.state(), NavState::Holding);
            pitch_down_rad.to_degrees()
        };
        pitch_deg(0.0, 0.0, 1.0);
        pitch_deg(-1.0, 0.0, 10.0);
        let learned = pitch_deg(0.0, 0.0, 1.5);
        assert!(learned > 3.0, "{learned}°");
        assert!(pitch_deg(0.0, FULL_STICK, 10.0) > 45.0);
        let left = pitch_deg(0.0, 0.0, 1.5);
        assert!(left.abs() < 0.2 * learned, "{left}° of {learned}°");
    }
}
