//! Reports the results of an update for displays, logs and samples.

use super::fly::{Flown, Steering};
use super::hold::Pattern;
use super::observed::Observed;
use super::task::Task;
use crate::autopilot::control::FlightControllers;
use crate::autopilot::guidance::hold_remaining_s;
use crate::autopilot::io::NavInputs;
use crate::autopilot::machine::{Facts, waiting_for};
use crate::math;
use crate::plan::Seconds;
use crate::telemetry::{CannotHold, L1Mode, NavState, NavTelemetry};

/// The ground speed below which a time to the waypoint is meaningless, m/s.
const ETA_MIN_MPS: f64 = 0.5;

/// Reports an update. `flown` has the facts of the decision and the result of flying it, if anything was flown. State,
/// plan and refusal are left to [`Navigator::report_status`](super::Navigator::report_status).
pub(super) fn report(
    state: NavState,
    task: &Task,
    steering: &Steering,
    cannot_hold: Option<CannotHold>,
    seen: &Observed,
    controllers: &FlightControllers,
    flown: Option<(&Facts, Flown)>,
) -> NavTelemetry {
    let (now, params) = (seen.now, seen.params);
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
    let Some((facts, Flown { output, path, .. })) = flown else { return status };
    let on_leg = state == NavState::Approaching;
    NavTelemetry {
        distance_m: Some(seen.distance_m),
        bearing_rad: Some(
            math::atan2(seen.to_waypoint.y, seen.to_waypoint.x).rem_euclid(std::f64::consts::TAU),
        ),
        xte_m: path.xte_m.filter(|_| on_leg),
        along_m: path.along_m.filter(|_| on_leg),
        lookahead_m: path.lookahead_m.filter(|_| on_leg),
        l1_mode: Some(if on_leg { path.l1_mode } else { L1Mode::Off }),
        aim_ne: Some(path.aim_ne),
        a_lat_mps2: path.a_lat_mps2.filter(|_| on_leg),
        target_ne: Some(steering.target_ne),
        target_alt_m: Some(steering.target_alt_m),
        leg_start: on_leg.then_some(task.leg.start),
        speed_setpoint_mps: Some(controllers.position.speed_setpoint_mps()),
        pattern_angle_rad: Pattern::of(state).map(|_| task.leg.hold.phase_rad),
        hold_remaining_s: Some(hold_left_s(state, task, now)),
        held_by_command: task.leg.hold.by_command,
        eta_s: (on_leg && speed >= ETA_MIN_MPS).then(|| seen.distance_m / speed),
        stick_override: seen.stick_override,
        cannot_hold,
        yaw_override: output.yaw_rate_rps.is_none(),
        guards: waiting_for(state, facts),
        roll_demand_rad: output.roll_rad,
        pitch_down_demand_rad: output.pitch_down_rad,
        ..status
    }
}

fn hold_left_s(state: NavState, task: &Task, now: &NavInputs) -> f64 {
    let hold = &task.leg.hold;
    match state {
        NavState::Holding if hold.by_command => hold_remaining_s(Seconds::default(), 0),
        NavState::Holding | NavState::Orbiting | NavState::Figure8 => {
            let duration = task.cursor.current().unwrap_or_default().duration;
            hold_remaining_s(duration, hold.elapsed_us(now.time))
        }
        NavState::Idle
        | NavState::Approaching
        | NavState::Arrived
        | NavState::Landing
        | NavState::Complete => 0.0,
    }
}
