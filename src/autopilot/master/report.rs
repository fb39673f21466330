//! Reports the results of an update for displays, logs and samples.

use arrayvec::ArrayVec;

use super::leg::{Flown, Leg, bearing_rad};
use super::line::{TOO_FAST_MPS, most_lead_m};
use super::mission::{Clocks, Mission, Order};
use super::navigator::Controls;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::{local_offset, offset_to_latlon};
use crate::plan::WaypointType;
use crate::telemetry::{Guard, GuardName, GuardOp, L1Mode, NavState, NavTelemetry};

/// The ground speed below which a time to the waypoint is meaningless, m/s.
const ETA_MIN_MPS: f64 = 0.5;

/// Reports an update. Engagement and refusal are left to the caller.
pub(super) fn report(
    mission: &Mission,
    controls: &Controls,
    order: Option<&Order>,
    now: &NavInputs,
    params: &Params,
) -> NavTelemetry {
    let route = mission.route();
    let speed_mps = now.vel_ne.norm();
    let home_distance_m =
        now.home.filter(|_| now.fix).map(|home| (local_offset(now.origin, home) - now.pos_ne).norm());
    let status = NavTelemetry {
        state: mission.state(),
        reason: mission.reason(),
        wp: route.index(),
        next_wp: route.following().unwrap_or(route.index()),
        count: route.plan().waypoints.len() as u8,
        source: route.source(),
        kind: route.current().map(|waypoint| waypoint.kind),
        speed_mps,
        home_distance_m,
        fence_margin_m: params.fence_m().zip(home_distance_m).map(|(limit, distance)| limit - distance),
        hover_us: controls.hover_us(params),
        ..NavTelemetry::idle()
    };
    let Some(Order::Fly(course)) = order else { return status };
    let (clocks, end) = (mission.clocks(), route.end(now));
    let on_leg = mission.state() == NavState::Approaching;
    let to_waypoint = end.map(|end| end.ne - now.pos_ne);
    let distance_m = to_waypoint.map(|way| way.norm());
    let flown = mission.flown().filter(|_| on_leg);
    let line = flown.and_then(|flown| flown.line);
    let start = match mission.leg() {
        Some(Leg::Line(line)) => Some(line.start()),
        Some(Leg::Point(_)) | None => None,
    };
    NavTelemetry {
        distance_m,
        bearing_rad: to_waypoint.map(|way| bearing_rad(way).rem_euclid(std::f64::consts::TAU)),
        xte_m: line.map(|(_, line)| line.across_m),
        along_m: line.map(|(_, line)| line.along_m),
        lookahead_m: line.map(|(_, line)| line.lead_m),
        l1_mode: Some(if line.is_some() { L1Mode::Track } else { L1Mode::Off }),
        aim_ne: Some(course.target.point.ne),
        target_ne: Some(end.map_or(course.target.point.ne, |end| match on_leg {
            true => end.ne,
            false => course.target.point.ne,
        })),
        target_alt_m: Some(course.target.height.altitude_m),
        leg_start: start.map(|start| offset_to_latlon(now.origin, start)),
        speed_setpoint_mps: Some(course.target.point.vel_ne.norm()),
        pattern_angle_rad: clocks.phase_rad.filter(|_| is_pattern(mission.state())),
        hold_remaining_s: Some(hold_left_s(mission, &clocks)),
        eta_s: distance_m.filter(|_| on_leg && speed_mps >= ETA_MIN_MPS).map(|distance| distance / speed_mps),
        touchdown_held_s: clocks.grounded_s.filter(|_| mission.state() == NavState::Landing),
        yaw_override: controls.output.yaw_rate_rps.is_none(),
        guards: guards(mission, flown, &clocks, now, params),
        roll_demand_rad: controls.output.roll_rad,
        pitch_down_demand_rad: controls.output.pitch_down_rad,
        ..status
    }
}

fn is_pattern(state: NavState) -> bool {
    matches!(state, NavState::Orbiting | NavState::Figure8)
}

fn hold_left_s(mission: &Mission, clocks: &Clocks) -> f64 {
    match mission.state() {
        NavState::Holding | NavState::Orbiting | NavState::Figure8 => {
            (mission.route().hold_s().unwrap_or_default() - clocks.held_s).max(0.0)
        }
        _ => 0.0,
    }
}

/// Returns the conditions that the mission waits for.
fn guards(
    mission: &Mission,
    flown: Option<&Flown>,
    clocks: &Clocks,
    now: &NavInputs,
    params: &Params,
) -> ArrayVec<Guard, 9> {
    let mut guards = ArrayVec::new();
    let mut push = |name, value, op, limit| _ = guards.try_push(Guard::new(name, value, op, limit));
    match mission.state() {
        NavState::Approaching => {
            let Some((flown, end)) = flown.zip(mission.route().end(now)) else { return guards };
            let distance_m = (end.ne - now.pos_ne).norm();
            if let Some((corner, line)) = flown.line {
                push(GuardName::Gate, distance_m, GuardOp::AtMost, flown.gate_m);
                push(GuardName::CornerSpeed, now.vel_ne.norm(), GuardOp::AtMost, corner.speed_mps);
                push(GuardName::Carrot, line.lead_m, GuardOp::AtMost, most_lead_m(now.vel_ne.norm(), params));
                push(GuardName::Overspeed, line.excess_mps, GuardOp::Above, TOO_FAST_MPS);
            } else {
                push(GuardName::Arrival, distance_m, GuardOp::AtMost, flown.gate_m);
                if matches!(end.kind, WaypointType::Hold | WaypointType::Land | WaypointType::Takeoff) {
                    let error_m = (end.altitude_m - now.alt_m).abs();
                    push(GuardName::Altitude, error_m, GuardOp::AtMost, flown.gate_m);
                }
            }
            if let Some([stalled, away]) = clocks.progress {
                push(GuardName::NoProgress, stalled.value, GuardOp::Above, stalled.limit);
                push(GuardName::Flyaway, away.value, GuardOp::Above, away.limit);
            }
            push(GuardName::WrongHeading, clocks.heading.value, GuardOp::Above, clocks.heading.limit);
        }
        NavState::Holding | NavState::Orbiting | NavState::Figure8 => {
            let wanted_s = mission.route().hold_s().unwrap_or_default();
            push(GuardName::HoldTime, clocks.held_s, GuardOp::AtLeast, wanted_s);
        }
        NavState::Landing => {
            let sink_mps = -now.climb_mps;
            push(GuardName::TouchdownSink, sink_mps, GuardOp::Below, 0.25 * params.descent_rate_mps());
            let most_mps = 0.01 * f64::from(params.landing_velocity_threshold);
            push(GuardName::TouchdownSpeed, now.climb_mps.abs(), GuardOp::Below, most_mps);
            let wanted_s = 0.1 * f64::from(params.landing_detection_time);
            push(GuardName::TouchdownTime, clocks.grounded_s.unwrap_or_default(), GuardOp::AtLeast, wanted_s);
        }
        NavState::Idle | NavState::Arrived | NavState::Complete => {}
    }
    guards
}
