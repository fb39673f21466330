//! Flying a state: its target and aim, and the demands of the controllers.

use nalgebra::Vector2;

use super::{Landing, Navigator};
use crate::autopilot::control::{
    AltitudeMeasurement, AltitudeTarget, PositionLaw, PositionMeasurement, PositionTarget, YawFacts,
    earth_to_body, throttle_share,
};
use crate::autopilot::guidance::{
    L1Limits, L1Result, PatternPoint, Spiral, figure8, l1, landing_setpoint_m, leg_speed_mps, orbit,
    pattern_rate_rps, spiral_offset,
};
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::local_offset;
use crate::plan::WaypointType;
use crate::telemetry::{L1Mode, NavOutput, NavState};

/// Below this altitude a landing waits while the craft is faster over ground than the speed, m and m/s; not longer than
/// the time, s.
const LAST_METRES_M: f64 = 5.0;
const TOUCHDOWN_MPS: f64 = 2.0;
const FAST_PATIENCE_S: f64 = 30.0;
/// Below this altitude a rescue sinks at the landing rate, m.
const SLOW_LANDING_M: f64 = 4.0;
/// The landing altitude that counts when the parameter is lower, m.
const LOWEST_LANDING_M: f64 = 1.0;
/// Share of the descent rate below which a landing neither sinks nor climbs.
const STILL_SHARE: f64 = 0.25;
/// Time over which the climb rate of a craft that bounces is averaged, s.
const JOLT_S: f64 = 0.3;
/// Rate at which the setpoint of a landing comes down to a craft that stopped below it, m/s.
const CATCH_UP_MPS: f64 = 2.0;
/// How far the setpoint must be below a craft that does not sink, m.
const FELT_BELOW_M: f64 = 0.3;
/// Rates at which the throttle is taken off while the ground is felt, and given back, µs/s.
const FEEL_US_PER_S: f64 = 120.0;
const LET_GO_US_PER_S: f64 = 300.0;
/// Most throttle taken off, µs: the floor of the parameters is reached in any case.
const FEEL_LIMIT_US: f64 = 600.0;
/// Throttle taken off at which the craft is flown level, µs.
const LEVEL_US: f64 = 80.0;
/// Throttle taken off at which a craft that does not sink is sure to stand, µs.
const STANDS_US: f64 = 120.0;
/// Deflection of a stick at its end.
const FULL_STICK: f64 = 500.0;

/// The vertical part of the inputs.
pub(super) fn vertical(now: &NavInputs) -> AltitudeMeasurement {
    AltitudeMeasurement {
        altitude_m: now.alt_m,
        climb_mps: now.climb_mps,
        cos_tilt: now.cos_tilt,
        throttle_us: now.throttle_us,
    }
}

/// The horizontal part of the inputs.
pub(super) fn horizontal(now: &NavInputs) -> PositionMeasurement {
    PositionMeasurement {
        position: now.pos_ne,
        velocity: now.vel_ne,
        accel: now.accel_ne,
        lean_body: Vector2::new(now.pitch_rad, now.roll_rad),
        heading_rad: now.heading_rad,
    }
}

/// Whether the pilot moves roll or pitch.
pub(super) fn beyond_deadband(now: &NavInputs, params: &Params) -> bool {
    let deadband = f64::from(params.stick_deadband);
    now.stick_roll.abs() > deadband || now.stick_pitch.abs() > deadband
}

/// Share of the full deflection beyond the deadband, −1…1, so that crossing it is no step.
fn stick_share(stick: f64, params: &Params) -> f64 {
    let deadband = f64::from(params.stick_deadband);
    let beyond = (stick.abs() - deadband).max(0.0) / (FULL_STICK - deadband).max(1.0);
    beyond.min(1.0).copysign(stick)
}

impl Navigator {
    /// Watches a cycle that somebody else flies.
    pub(super) fn watch(&mut self, now: &NavInputs, params: &Params) {
        self.altitude.watch(&vertical(now), params, now.dt);
        if now.fix {
            self.position.watch(&horizontal(now), now.dt);
        }
    }

    /// The demands of this update.
    pub(super) fn fly(&mut self, now: &NavInputs, params: &Params) -> NavOutput {
        let params = &self.with_rescue_climb(params);
        let target = self.horizontal_target(now, params);
        let altitude = self.altitude_target(now, params);
        self.altitude.set_relief_us(self.landing.map_or(0.0, |landing| landing.felt_us));
        let throttle_us = self.altitude.update(&vertical(now), altitude, params, now.dt);
        self.target_alt_m = match altitude {
            AltitudeTarget::Altitude(altitude_m) => altitude_m,
            AltitudeTarget::Landing { setpoint_m, .. } => setpoint_m,
            AltitudeTarget::Rate(_) => self.altitude.setpoint_m(),
        };
        let lean = if self.stick_override {
            self.position.watch(&horizontal(now), now.dt);
            Vector2::new(stick_share(now.stick_pitch, params), stick_share(now.stick_roll, params))
                .cap_magnitude(1.0)
                * params.max_lean_rad()
        } else {
            let demand = self.position.update(&horizontal(now), &target, params, now.dt);
            earth_to_body(demand, now.heading_rad) * self.lean_share()
        };
        NavOutput {
            roll_rad: lean.y,
            pitch_rad: lean.x,
            yaw_rate_rps: self.yaw_rate(now, params),
            throttle: throttle_share(throttle_us, params),
            throttle_us,
            stands: self.landing.is_some_and(|landing| landing.felt_us >= STANDS_US),
        }
    }

    fn with_rescue_climb(&self, params: &Params) -> Params {
        match self.rescue {
            // Saturates at the range of the setting.
            Some(rescue) => {
                Params { alt_hold_climb_rate: (rescue.climb_mps * 10.0).clamp(1.0, 200.0) as u8, ..*params }
            }
            None => *params,
        }
    }

    /// Greatest speed on this leg, m/s.
    pub(super) fn leg_speed(&self, now: &NavInputs, params: &Params) -> f64 {
        let own = leg_speed_mps(self.record(self.index).unwrap_or_default().speed_cms, params);
        match self.leg.delay {
            Some((cap, until)) if now.time < until => own.min(cap),
            Some(_) | None => own,
        }
    }

    fn horizontal_target(&mut self, now: &NavInputs, params: &Params) -> PositionTarget {
        let speed_mps = self.leg_speed(now, params);
        self.telemetry.l1_mode = L1Mode::Off;
        self.telemetry.xte_m = None;
        self.telemetry.along_m = None;
        self.telemetry.lookahead_m = None;
        self.telemetry.a_lat_mps2 = None;
        let waypoint = self.waypoint_ne(now);
        let mut target = PositionTarget { speed_mps, ..PositionTarget::stay(waypoint, params) };
        match self.state {
            NavState::Idle | NavState::Complete => {
                target.target = self.target_ne;
                target.aim = self.target_ne;
            }
            NavState::Approaching | NavState::Arrived => {
                target.law = PositionLaw::Speed;
                self.leg_target(&mut target, now, params);
            }
            NavState::Holding => {}
            NavState::Orbiting | NavState::Figure8 => {
                let point = self.pattern_point(params);
                let rate = self.pattern_rate(now, params);
                target.target += point.offset;
                target.target_velocity = point.tangent * rate;
                target.target_accel = point.curvature * (rate * rate);
                target.aim = target.target;
            }
            NavState::Landing => {
                let landing = self.landing_now(now, params);
                if let Some(spiral) = Spiral::from_params(params) {
                    let elapsed = now.time.seconds_since(landing.began);
                    target.target += spiral_offset(&spiral, elapsed, now.alt_m);
                    target.aim = target.target;
                }
            }
        }
        self.target_ne = target.target;
        self.telemetry.aim_ne = Some(target.aim);
        target
    }

    /// Target and aim on a leg: straight for the waypoint, or along the line to it.
    fn leg_target(&mut self, target: &mut PositionTarget, now: &NavInputs, params: &Params) {
        if let Some(at) = self.climb.at {
            target.target = at;
            target.aim = at;
            return;
        }
        target.pass_through = self.is_pass_through();
        if !params.l1_enable || self.positional_count() < 2 {
            return;
        }
        let start = local_offset(now.origin, self.leg.start);
        let result = l1(start, target.target, now.pos_ne, now.vel_ne, &L1Limits::from_params(params));
        if result.reanchor {
            self.leg.start = super::entry::here(now);
        }
        target.aim = self.arc_aim(&result, now);
        self.telemetry.l1_mode = result.mode;
        self.telemetry.xte_m = Some(result.xte_m);
        self.telemetry.along_m = Some(result.along_m);
        self.telemetry.lookahead_m = Some(result.effective_lookahead_m);
        self.telemetry.a_lat_mps2 = Some(result.a_lat_mps2);
    }

    /// The aim of the line, or of the arc while one is flown.
    fn arc_aim(&mut self, result: &L1Result, now: &NavInputs) -> Vector2<f64> {
        let Some(arc) = &mut self.leg.arc else { return result.aim };
        let to_aim = result.aim - now.pos_ne;
        if !arc.advance(now.dt, to_aim.y.atan2(to_aim.x)) {
            self.leg.arc = None;
            return result.aim;
        }
        let (sin, cos) = arc.bearing_rad.sin_cos();
        now.pos_ne + Vector2::new(cos, sin) * result.lookahead_m
    }

    fn is_pass_through(&self) -> bool {
        let kind = self.record(self.index).unwrap_or_default().kind;
        let passes = matches!(kind, WaypointType::Flyover | WaypointType::Flyby);
        passes && self.following().is_some() && !self.leg.missed && !self.co_located()
    }

    fn pattern_radius_m(&self, params: &Params) -> f64 {
        if self.state == NavState::Figure8 {
            f64::from(params.hold_figure8_width) / 200.0
        } else {
            f64::from(params.hold_orbit_radius) / 100.0
        }
    }

    fn pattern_rate(&self, now: &NavInputs, params: &Params) -> f64 {
        pattern_rate_rps(self.pattern_radius_m(params), self.leg_speed(now, params), params)
    }

    fn pattern_point(&self, params: &Params) -> PatternPoint {
        let radius = self.pattern_radius_m(params);
        if self.state == NavState::Figure8 {
            figure8(2.0 * radius, self.pattern_angle)
        } else {
            orbit(radius, self.pattern_angle)
        }
    }

    /// The pattern moves before anything else is decided.
    pub(super) fn move_pattern(&mut self, now: &NavInputs, params: &Params) {
        let period = match self.state {
            NavState::Orbiting => std::f64::consts::TAU,
            NavState::Figure8 => 2.0 * std::f64::consts::TAU,
            NavState::Idle
            | NavState::Approaching
            | NavState::Arrived
            | NavState::Holding
            | NavState::Landing
            | NavState::Complete => return,
        };
        self.pattern_angle =
            (self.pattern_angle + self.pattern_rate(now, params) * now.dt).rem_euclid(period);
    }

    fn altitude_target(&mut self, now: &NavInputs, params: &Params) -> AltitudeTarget {
        match self.state {
            NavState::Landing => {
                let landing = self.feel_for_ground(now, params);
                let setpoint_m = landing_setpoint_m(
                    landing.rate_start_m,
                    landing.rate_mps,
                    now.time.seconds_since(landing.rate_since),
                    now.alt_m,
                    f64::from(params.landing_altitude_m),
                );
                AltitudeTarget::Landing { setpoint_m, rate_mps: -landing.rate_mps }
            }
            NavState::Complete | NavState::Idle => AltitudeTarget::Altitude(self.target_alt_m),
            NavState::Approaching if self.climb.at.is_some() => {
                AltitudeTarget::Altitude(self.leg.altitude_m.max(self.climb_goal_m(params) + 1.0))
            }
            NavState::Approaching
            | NavState::Arrived
            | NavState::Holding
            | NavState::Orbiting
            | NavState::Figure8 => AltitudeTarget::Altitude(self.leg.altitude_m),
        }
    }

    /// The landing under way; begins with the first update in LANDING. A rescue sinks at its own rate down to the last
    /// metres.
    fn landing_now(&mut self, now: &NavInputs, params: &Params) -> Landing {
        let slow = params.descent_rate_mps();
        let sinking = match self.rescue {
            Some(rescue) if now.alt_m > SLOW_LANDING_M => rescue.descend_mps.max(slow),
            Some(_) | None => slow,
        };
        let rate = if self.waits_for_slow_ground(now) { 0.0 } else { sinking };
        let landing = self.landing.get_or_insert(Landing {
            began: now.time,
            highest_m: now.alt_m,
            rate_since: now.time,
            rate_start_m: now.alt_m,
            rate_mps: rate,
            fast_since: None,
            climb_mps: now.climb_mps,
            felt_us: 0.0,
        });
        #[expect(clippy::float_cmp, reason = "the rate is copied, not computed")]
        if landing.rate_mps != rate {
            let elapsed = now.time.seconds_since(landing.rate_since);
            landing.rate_start_m = landing_setpoint_m(
                landing.rate_start_m,
                landing.rate_mps,
                elapsed,
                now.alt_m,
                f64::from(params.landing_altitude_m),
            );
            landing.rate_since = now.time;
            landing.rate_mps = rate;
        }
        *landing
    }

    /// A craft that still flies back to its place does not sink into the ground on the way. It waits once for a while:
    /// one that the wind carries off must come down, too.
    fn waits_for_slow_ground(&mut self, now: &NavInputs) -> bool {
        let is_low = (1.0..LAST_METRES_M).contains(&now.alt_m);
        let Some(landing) = self.landing.as_mut().filter(|_| is_low && now.vel_ne.norm() > TOUCHDOWN_MPS)
        else {
            return false;
        };
        let since = *landing.fast_since.get_or_insert(now.time);
        now.time.seconds_since(since) < FAST_PATIENCE_S
    }

    /// Low and still although it should sink, the craft stands, or the air carries it. Below the landing altitude it
    /// does not climb back to a setpoint above it but goes on down from where it is, and it takes the throttle off bit
    /// by bit: on the ground until it stands firmly, in the air until it sinks again.
    fn feel_for_ground(&mut self, now: &NavInputs, params: &Params) -> Landing {
        let mut landing = self.landing_now(now, params);
        let is_low = now.alt_m < f64::from(params.landing_altitude_m).max(LOWEST_LANDING_M);
        landing.climb_mps += (now.climb_mps - landing.climb_mps) * (now.dt / (JOLT_S + now.dt));
        let still = STILL_SHARE * params.descent_rate_mps();
        let is_down = landing.rate_mps > 0.0 && is_low;
        let below = now.alt_m - self.altitude.setpoint_m();
        if is_down && landing.climb_mps > -still && below < 0.0 {
            landing.rate_start_m -= CATCH_UP_MPS * now.dt;
        }
        let feels = is_down && landing.climb_mps.abs() < still && below > FELT_BELOW_M;
        let rate = if feels { FEEL_US_PER_S } else { -LET_GO_US_PER_S };
        landing.felt_us = (landing.felt_us + rate * now.dt).clamp(0.0, FEEL_LIMIT_US);
        self.landing = Some(landing);
        landing
    }

    /// Share of the lean demand that is flown: a craft that stands is not tilted on its legs.
    fn lean_share(&self) -> f64 {
        self.landing.map_or(1.0, |landing| 1.0 - (landing.felt_us / LEVEL_US).min(1.0))
    }

    fn yaw_rate(&mut self, now: &NavInputs, params: &Params) -> Option<f64> {
        if now.stick_yaw.abs() > f64::from(params.stick_deadband) {
            self.yaw.reset();
            return None;
        }
        let to_waypoint = self.waypoint_ne(now) - now.pos_ne;
        let kind = self.record(self.index).unwrap_or_default().kind;
        let stops = matches!(kind, WaypointType::Hold | WaypointType::Land | WaypointType::Takeoff);
        let facts = YawFacts {
            heading_rad: now.heading_rad,
            yaw_rate_rps: now.yaw_rate_rps,
            course_rad: now.vel_ne.y.atan2(now.vel_ne.x),
            ground_speed_mps: now.vel_ne.norm(),
            bearing_rad: to_waypoint.y.atan2(to_waypoint.x),
            distance_m: to_waypoint.norm(),
            acceptance_radius_m: if stops { params.hold_radius_m() } else { params.arrival_radius_m() },
        };
        Some(self.yaw.update(&facts, self.yaw_cap_dps, params, now.dt))
    }
}
