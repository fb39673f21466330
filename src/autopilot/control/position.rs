//! Position control: turns a target place into a tilt towards north and east.

use nalgebra::Vector2;

use super::bumpless::BumplessTransfer;
use super::disturbance::DisturbanceObserver;
use crate::autopilot::guidance::stop_speed_mps;
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::GRAVITY;
use crate::math;

/// The limit of the speed law's integral, rad.
const SPEED_INTEGRAL_LIMIT: f64 = 35.0 * DEG;
/// The limit of the direct law's integral, m·s.
const DIRECT_INTEGRAL_LIMIT: f64 = 20.0;
/// The limit of the position error of the direct law, m.
const DIRECT_ERROR_LIMIT: f64 = 5.0;
/// The half-life of the integrals while the pilot flies, s.
const BLEED_HALF_LIFE_S: f64 = 2.5;
/// The setpoint acceleration (m/s²) at which the speed integral works at half its gain. The integral must not learn
/// the lag of acceleration and braking.
const HALF_INTEGRAL_ACCEL: f64 = 0.3;
/// The rate at which the velocity setpoint closes small differences, rad/s. Without it, a turn of the direction at
/// walking pace would kick the tilt.
const SETPOINT_RPS: f64 = 5.0;
/// The factor by which the craft may be faster than its target when it follows a pattern.
const CHASE: f64 = 1.1;
/// The distance from the target within which the trim is learned, as a fraction of the radius of the pattern.
const ON_PATTERN: f64 = 0.5;
/// The maximum trim, as a fraction of the speed of the target.
const MAX_TRIM: f64 = 0.5;
/// The lag of the velocity behind its setpoint, s.
const VELOCITY_LAG_S: f64 = 0.3;
/// The maximum lead of the speed setpoint over the speed while the thrust limits the tilt, m/s.
const SPEED_LEAD_MPS: f64 = 1.0;
/// The fastest change of the tilt limit in use, rad/s.
const LIMIT_SLEW: f64 = 30.0 * DEG;
/// The fastest change of the tilt demand, rad/s.
pub const TILT_SLEW_RPS: f64 = 200.0 * DEG;
const DEG: f64 = std::f64::consts::PI / 180.0;

/// Converts a tilt towards (north, east) to (forward, right) of a craft that heads `heading_rad`.
pub fn earth_to_body(ne: Vector2<f64>, heading_rad: f64) -> Vector2<f64> {
    let (sin, cos) = math::sin_cos(heading_rad);
    Vector2::new(ne.x * cos + ne.y * sin, -ne.x * sin + ne.y * cos)
}

/// Returns the inverse of [`earth_to_body`].
fn body_to_earth(body: Vector2<f64>, heading_rad: f64) -> Vector2<f64> {
    earth_to_body(body, -heading_rad)
}

/// The horizontal state of the craft in north and east.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionMeasurement {
    /// Position, m.
    pub position: Vector2<f64>,
    /// Ground velocity, m/s.
    pub velocity: Vector2<f64>,
    /// Acceleration, m/s².
    pub accel: Vector2<f64>,
    /// Current tilt (forward, right), rad.
    pub tilt_body: Vector2<f64>,
    /// Heading, rad clockwise from north.
    pub heading_rad: f64,
}

impl From<&NavInputs> for PositionMeasurement {
    fn from(now: &NavInputs) -> Self {
        Self {
            position: now.pos_ne,
            velocity: now.vel_ne,
            accel: now.accel_ne,
            tilt_body: Vector2::new(now.pitch_down_rad, now.roll_rad),
            heading_rad: now.heading_rad,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PositionLaw {
    /// Position error → speed → tilt: legs, and holds with `ap_velocity_control_enable`.
    Speed,
    /// Position error → tilt: holds without it.
    Direct,
}

/// The target of the position controller in north and east.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionTarget {
    /// The point to steer for, m.
    pub aim: Vector2<f64>,
    /// The point to reach, m.
    pub target: Vector2<f64>,
    /// Velocity of the target, m/s. Zero unless the target moves along a pattern.
    pub target_velocity: Vector2<f64>,
    /// Acceleration of the target, m/s².
    pub target_accel: Vector2<f64>,
    /// `true` to fly on at full speed instead of stopping at the target.
    pub pass_through: bool,
    /// Maximum speed, m/s.
    pub speed_mps: f64,
    pub law: PositionLaw,
}

impl PositionTarget {
    /// Returns the target to stop at `point` and stay there.
    pub fn stay(point: Vector2<f64>, params: &Params) -> Self {
        Self {
            aim: point,
            target: point,
            target_velocity: Vector2::zeros(),
            target_accel: Vector2::zeros(),
            pass_through: false,
            speed_mps: params.max_velocity_mps(),
            law: if params.velocity_control_enable { PositionLaw::Speed } else { PositionLaw::Direct },
        }
    }
}

/// The position controller of the autopilot and position hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PositionController {
    observer: DisturbanceObserver,
    /// Speed setpoint along the way, m/s.
    speed: f64,
    velocity_setpoint: Vector2<f64>,
    accel_setpoint: Vector2<f64>,
    /// Speed added on a pattern, along it and towards its centre, m/s.
    pattern_trim: Vector2<f64>,
    accel_filtered: Vector2<f64>,
    /// Integral of the speed law, rad.
    speed_integral: Vector2<f64>,
    /// Integral of the direct law, m·s.
    direct_integral: Vector2<f64>,
    saturated: bool,
    limit_rad: Option<f64>,
    /// Tilt that the thrust allows, rad, or `None` while the thrust is not monitored.
    thrust_limit_rad: Option<f64>,
    params: Option<Params>,
    transfer: [BumplessTransfer; 2],
    /// Tilt from which to continue, flown by something else until now.
    flown: Option<Vector2<f64>>,
    /// Demand of the last update, rad.
    demand: Option<Vector2<f64>>,
}

impl PositionController {
    /// Tracks a cycle that something else flies. Wind and drag stay known, integrals decay, and the setpoints follow
    /// the craft.
    pub fn track(&mut self, now: &PositionMeasurement, dt: f64) {
        self.observe(now, dt);
        let keep = math::powf(0.5, dt / BLEED_HALF_LIFE_S);
        self.speed_integral *= keep;
        self.direct_integral *= keep;
        self.accel_filtered = now.accel;
        self.pattern_trim = Vector2::zeros();
        self.velocity_setpoint = now.velocity;
        self.speed = now.velocity.norm();
        self.saturated = false;
        self.limit_rad = None;
        let flown = body_to_earth(now.tilt_body, now.heading_rad);
        self.flown = Some(flown);
        self.demand = Some(flown);
    }

    /// Takes over with empty integrals, setpoints at the craft, and the tilt where it was.
    pub fn engage(&mut self, now: &PositionMeasurement) {
        *self = Self { observer: self.observer, thrust_limit_rad: self.thrust_limit_rad, ..Self::default() };
        self.track(now, 0.0);
    }

    /// Returns `true` if the demand is limited to the maximum tilt.
    pub fn is_saturated(&self) -> bool {
        self.saturated
    }

    /// Limits the tilt to what the thrust allows, rad. `None` if no controller keeps the altitude.
    pub(super) fn limit_tilt(&mut self, limit_rad: Option<f64>) {
        self.thrust_limit_rad = limit_rad;
    }

    /// Returns the maximum tilt that may be flown, rad.
    pub fn max_tilt_rad(&self, params: &Params) -> f64 {
        self.thrust_limit_rad.unwrap_or(f64::INFINITY).min(params.max_tilt_rad())
    }

    /// Returns the speed setpoint, m/s.
    pub fn speed_setpoint_mps(&self) -> f64 {
        self.speed
    }

    /// Returns the tilt towards (north, east) in rad that leads to `target`, `dt` seconds after the last update,
    /// inside the maximum tilt.
    pub fn update(
        &mut self,
        now: &PositionMeasurement,
        target: &PositionTarget,
        params: &Params,
        dt: f64,
    ) -> Vector2<f64> {
        self.observe(now, dt);
        self.shape_speed(now, target, params, dt);
        self.filter_accel(now, params, dt);
        self.integrate(now, target, params, dt);
        let law = self.law(now, target, params);
        if let Some(flown) = self.flown.take() {
            self.start_transfer(flown, law);
        } else if let Some(old) = self.params.filter(|old| old != params) {
            let before = self.law(now, target, &old) + self.transfer_remaining();
            self.start_transfer(before, law);
        }
        self.params = Some(*params);
        let wanted = Vector2::new(self.transfer[0].apply(law.x, dt), self.transfer[1].apply(law.y, dt));
        let limit = self.slew_limit(params, dt);
        self.saturated = wanted.norm() > limit;
        let finite = wanted.iter().all(|axis| axis.is_finite());
        let wanted = if finite { wanted.cap_magnitude(limit) } else { Vector2::zeros() };
        let slewed =
            self.demand.map_or(wanted, |last| last + (wanted - last).cap_magnitude(TILT_SLEW_RPS * dt));
        let demand = slewed.cap_magnitude(limit);
        self.demand = Some(demand);
        demand
    }

    fn observe(&mut self, now: &PositionMeasurement, dt: f64) {
        let tilt = body_to_earth(now.tilt_body, now.heading_rad);
        let accel = tilt.map(|axis| GRAVITY * math::tan(axis.clamp(-1.3, 1.3)));
        self.observer.update(now.velocity, accel, dt);
    }

    fn shape_speed(&mut self, now: &PositionMeasurement, target: &PositionTarget, params: &Params, dt: f64) {
        let demand = if target.pass_through {
            target.speed_mps
        } else {
            stop_speed_mps((target.target - now.position).norm(), target.speed_mps, params)
        };
        let direction = (target.aim - now.position).try_normalize(1e-6).unwrap_or_default();
        self.trim_pattern(now, target, params, dt);
        let frame = pattern_frame(target);
        let chase = match frame {
            Some(frame) => {
                let most = CHASE * target.speed_mps.max(target.target_velocity.norm());
                let trim = frame[0] * self.pattern_trim.x + frame[1] * self.pattern_trim.y;
                (target.target_velocity + direction * demand + trim).cap_magnitude(most)
            }
            None => direction * demand,
        };
        let demand = if frame.is_some() { chase.norm() } else { demand };
        let brake = params.max_accel_mps2();
        self.speed += (demand - self.speed).clamp(-brake * dt, params.build_up_accel_mps2() * dt);
        if self.max_tilt_rad(params) < params.max_tilt_rad() {
            // The setpoint must not exceed a speed that the tilt can hold.
            self.speed = self.speed.min(now.velocity.norm() + SPEED_LEAD_MPS);
        }
        let direction = chase.try_normalize(1e-6).unwrap_or(direction);
        let left = direction * self.speed - self.velocity_setpoint;
        let mut step = (left * (SETPOINT_RPS * dt).min(1.0)).cap_magnitude(brake * dt);
        if frame.is_some() && demand > 0.0 {
            // The turn of the pattern itself is flown without an error.
            step += target.target_accel * (dt * (self.speed / demand).min(1.0));
        }
        self.velocity_setpoint += step;
        self.accel_setpoint = if dt > 0.0 { step / dt } else { Vector2::zeros() };
    }

    /// Learns the correction that the craft needs on a pattern. For a craft that circles, drag and lags keep their
    /// direction relative to the pattern, so their sum can be found slowly. The wind estimate cannot do that.
    fn trim_pattern(&mut self, now: &PositionMeasurement, target: &PositionTarget, params: &Params, dt: f64) {
        let Some([along, inward]) = pattern_frame(target) else {
            self.pattern_trim = Vector2::zeros();
            return;
        };
        let error = target.target - now.position;
        let speed = target.target_velocity.norm();
        let radius_m = speed * speed / target.target_accel.norm().max(1e-6);
        if self.saturated || error.norm() > ON_PATTERN * radius_m {
            return;
        }
        let stiffness = 0.025 * f64::from(params.position_p);
        // While the craft answers to the trim, the pattern turns away from the direction in which it was added.
        let turn_rps = target.target_accel.norm() / speed;
        let (sin, cos) = math::sin_cos(math::atan2(turn_rps, stiffness) + turn_rps * VELOCITY_LAG_S);
        let (ahead, inside) = (along.dot(&error), inward.dot(&error));
        let step = Vector2::new(ahead * cos - inside * sin, ahead * sin + inside * cos);
        let trim = self.pattern_trim + step * (math::powi(stiffness / 2.0, 2) * dt);
        self.pattern_trim = trim.cap_magnitude(MAX_TRIM * speed);
    }

    fn filter_accel(&mut self, now: &PositionMeasurement, params: &Params, dt: f64) {
        let time_constant = 1.0 / (std::f64::consts::TAU * 0.1 * f64::from(params.position_cutoff.max(1)));
        self.accel_filtered += (now.accel - self.accel_filtered) * (dt / (time_constant + dt));
    }

    fn integrate(&mut self, now: &PositionMeasurement, target: &PositionTarget, params: &Params, dt: f64) {
        if self.saturated {
            return;
        }
        match target.law {
            PositionLaw::Speed => {
                let steady = 1.0 / (1.0 + math::powi(self.accel_setpoint.norm() / HALF_INTEGRAL_ACCEL, 2));
                let gain = 0.1 * DEG * f64::from(params.velocity_i);
                let step = (self.velocity_setpoint - now.velocity) * (gain * steady * dt);
                self.speed_integral = (self.speed_integral + step)
                    .map(|x| x.clamp(-SPEED_INTEGRAL_LIMIT, SPEED_INTEGRAL_LIMIT));
                self.direct_integral = Vector2::zeros();
            }
            PositionLaw::Direct => {
                let step = direct_error(now, target) * dt;
                self.direct_integral = (self.direct_integral + step)
                    .map(|x| x.clamp(-DIRECT_INTEGRAL_LIMIT, DIRECT_INTEGRAL_LIMIT));
                self.speed_integral = Vector2::zeros();
            }
        }
    }

    fn law(&self, now: &PositionMeasurement, target: &PositionTarget, params: &Params) -> Vector2<f64> {
        let wind = self.observer.accel().map(|axis| -math::atan(axis / GRAVITY));
        let tilt = match target.law {
            PositionLaw::Speed => self.speed_law(now, params),
            PositionLaw::Direct => self.direct_law(now, target, params),
        };
        tilt + wind
    }

    fn speed_law(&self, now: &PositionMeasurement, params: &Params) -> Vector2<f64> {
        let p = 0.1 * DEG * f64::from(params.velocity_p);
        let d = 0.1 * DEG * f64::from(params.velocity_d);
        let drag = 1e-4 * DEG * f64::from(params.velocity_drag_coeff);
        let setpoint = self.velocity_setpoint;
        (setpoint - now.velocity) * p + self.speed_integral - self.accel_filtered * d
            + setpoint * (setpoint.norm() * drag)
            + self.accel_setpoint.map(|axis| math::atan(axis / GRAVITY))
    }

    fn direct_law(
        &self,
        now: &PositionMeasurement,
        target: &PositionTarget,
        params: &Params,
    ) -> Vector2<f64> {
        let p = 0.12 * DEG * f64::from(params.position_p);
        let i = 0.01 * DEG * f64::from(params.position_i);
        let d = 0.15 * DEG * f64::from(params.position_d);
        let a = 0.08 * DEG * f64::from(params.position_a);
        direct_error(now, target) * p
            + self.direct_integral * i
            + (target.target_velocity - now.velocity) * d
            + (target.target_accel - self.accel_filtered) * a
            + target.target_accel.map(|axis| math::atan(axis / GRAVITY))
    }

    fn start_transfer(&mut self, old: Vector2<f64>, new: Vector2<f64>) {
        self.transfer[0].start(old.x, new.x);
        self.transfer[1].start(old.y, new.y);
    }

    fn transfer_remaining(&self) -> Vector2<f64> {
        Vector2::new(self.transfer[0].remaining(), self.transfer[1].remaining())
    }

    /// Returns the maximum tilt, which follows that of the parameter at a limited rate.
    fn slew_limit(&mut self, params: &Params, dt: f64) -> f64 {
        let wanted = self.max_tilt_rad(params);
        let limit = match self.limit_rad {
            Some(old) => old + (wanted - old).clamp(-LIMIT_SLEW * dt, LIMIT_SLEW * dt),
            None => wanted,
        };
        self.limit_rad = Some(limit);
        limit
    }
}

/// Returns the directions along a pattern and towards its centre, or `None` while the target does not move.
fn pattern_frame(target: &PositionTarget) -> Option<[Vector2<f64>; 2]> {
    Some([target.target_velocity.try_normalize(1e-3)?, target.target_accel.try_normalize(1e-6)?])
}

fn direct_error(now: &PositionMeasurement, target: &PositionTarget) -> Vector2<f64> {
    (target.target - now.position).cap_magnitude(DIRECT_ERROR_LIMIT)
}

#[cfg(test)]
mod tests;
