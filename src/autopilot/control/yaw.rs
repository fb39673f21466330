//! Yaw control while the autopilot flies.

use super::bumpless::BumplessTransfer;
use crate::autopilot::params::{Params, YawMode};
use crate::geo::wrap_pi;
use crate::math;

/// The time in which yaw control fades in, s.
const RAMP_S: f64 = 2.0;
/// The distance over which HYBRID changes from bearing to course, m.
const HYBRID_M: f64 = 10.0;
/// The fastest change of the demand, deg/s².
pub const YAW_SLEW_DPS2: f64 = 180.0;
/// The fastest growth of the demand: a share of the maximum rate per second, plus this, deg/s². The rate loop
/// overshoots a quicker change, and the maximum rate is a limit of the true rate.
const GROWTH_PER_S: f64 = 0.7;
const GROWTH_DPS2: f64 = 6.0;
/// The share of the minimum speed below which the course is no longer used.
const RELEASE: f64 = 0.75;

/// The inputs that can steer the heading. Angles in rad clockwise from north, SI.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct YawFacts {
    pub heading_rad: f64,
    /// Current yaw rate, rad/s, clockwise positive.
    pub yaw_rate_rps: f64,
    pub course_rad: f64,
    /// Ground speed, m/s.
    pub ground_speed_mps: f64,
    /// Bearing to the waypoint.
    pub bearing_rad: f64,
    /// Distance to the waypoint, m.
    pub distance_m: f64,
    /// Acceptance radius of the waypoint, m. Within it, the bearing is meaningless.
    pub acceptance_radius_m: f64,
}

/// Returns the heading to steer for, rad, or `None` for no turn. `course_trusted` is `true` if the craft is fast
/// enough for a course. `captured_rad` is the heading that FIXED holds. DAMPENER is for wings; a multirotor flies it
/// as FIXED.
pub fn desired_heading(
    mode: YawMode,
    facts: &YawFacts,
    course_trusted: bool,
    captured_rad: Option<f64>,
) -> Option<f64> {
    match mode {
        YawMode::Velocity => course_trusted.then_some(facts.course_rad),
        YawMode::Bearing => (facts.distance_m >= facts.acceptance_radius_m).then_some(facts.bearing_rad),
        YawMode::Hybrid => Some(if course_trusted { hybrid(facts) } else { facts.bearing_rad }),
        YawMode::Fixed | YawMode::Dampener => captured_rad,
    }
}

/// Returns bearing and course mixed on the circle.
fn hybrid(facts: &YawFacts) -> f64 {
    let share = (facts.distance_m / HYBRID_M).clamp(0.0, 1.0);
    let (bearing, course) = (facts.bearing_rad, facts.course_rad);
    let north = share * math::cos(bearing) + (1.0 - share) * math::cos(course);
    let east = share * math::sin(bearing) + (1.0 - share) * math::sin(course);
    math::atan2(east, north)
}

/// Returns the yaw rate (deg/s, clockwise positive) towards `desired_rad`, scaled by `ramp` (0…1) and limited to
/// `max_dps`.
pub fn yaw_rate_dps(desired_rad: f64, facts: &YawFacts, ramp: f64, max_dps: f64, params: &Params) -> f64 {
    let error = wrap_pi(desired_rad - facts.heading_rad).to_degrees();
    let p = 0.01 * f64::from(params.yaw_p) * error;
    let d = 0.01 * f64::from(params.yaw_d) * facts.yaw_rate_rps.to_degrees();
    ((p - d) * ramp).clamp(-max_dps, max_dps)
}

/// Yaw control with its state: trust in the course, the captured heading, and the fade-in.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct YawController {
    course_trusted: bool,
    /// Heading at the first update since the last reset, rad.
    captured_rad: Option<f64>,
    ramp: f64,
    params: Option<Params>,
    transfer: BumplessTransfer,
    last_dps: f64,
}

impl YawController {
    /// Starts again, at engagement and while the pilot turns. The next update captures the heading and fades in.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Returns the yaw rate demand, rad/s clockwise. `cap_dps`, if present, limits it below `ap_max_yaw_rate`.
    pub fn update(&mut self, facts: &YawFacts, cap_dps: Option<f64>, params: &Params, dt: f64) -> f64 {
        let minimum = f64::from(params.min_forward_velocity) / 100.0;
        let threshold = if self.course_trusted { RELEASE * minimum } else { minimum };
        self.course_trusted = facts.ground_speed_mps >= threshold;
        let max_dps = cap_dps.unwrap_or(f64::INFINITY).min(f64::from(params.max_yaw_rate));
        let captured = *self.captured_rad.get_or_insert(facts.heading_rad);
        let desired = desired_heading(params.yaw_mode, facts, self.course_trusted, Some(captured));
        let rate = if let Some(desired) = desired {
            self.ramp = (self.ramp + dt / RAMP_S).min(1.0);
            yaw_rate_dps(desired, facts, self.ramp, max_dps, params)
        } else {
            self.ramp = 0.0;
            0.0
        };
        if self.params.is_some_and(|old| old != *params) {
            self.transfer.start(self.last_dps, rate);
        }
        self.params = Some(*params);
        let faded = self.transfer.apply(rate, dt);
        // A craft that already turns too fast gets a lower demand.
        let excess_dps = (facts.yaw_rate_rps.to_degrees().abs() - max_dps).max(0.0);
        let allowed_dps = if excess_dps > 0.0 { (max_dps - excess_dps).max(0.0) } else { f64::INFINITY };
        let wanted = if faded.is_finite() { faded.clamp(-allowed_dps, allowed_dps) } else { 0.0 };
        self.last_dps = slewed(self.last_dps, wanted, GROWTH_PER_S * max_dps + GROWTH_DPS2, dt);
        self.last_dps.to_radians()
    }
}

/// Returns the demand after `dt` seconds on its way from `last` to `wanted`, deg/s. It falls quickly and grows at
/// `growth_dps2` only.
fn slewed(last: f64, wanted: f64, growth_dps2: f64, dt: f64) -> f64 {
    let fall = YAW_SLEW_DPS2 * dt;
    let grow = growth_dps2.min(YAW_SLEW_DPS2) * dt;
    let (down, up) = match last {
        x if x > 0.0 => (fall.min(x.max(grow)), grow),
        x if x < 0.0 => (grow, fall.min((-x).max(grow))),
        _ => (grow, grow),
    };
    last + (wanted - last).clamp(-down, up)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts(speed: f64) -> YawFacts {
        YawFacts { course_rad: 1.0, ground_speed_mps: speed, distance_m: 50.0, ..YawFacts::default() }
    }

    #[test]
    fn the_course_is_released_below_three_quarters() {
        let params = Params::default();
        let mut yaw = YawController::default();
        let mut rate = |speed: f64| yaw.update(&facts(speed), None, &params, 1.0);
        assert!(rate(2.9).abs() < 1e-12);
        assert!(rate(3.0) > 0.0);
        assert!(rate(2.3) > 0.0);
        assert!(rate(2.2).abs() < 1e-12);
    }

    #[test]
    fn control_fades_in_over_two_seconds() {
        let params = Params { max_yaw_rate: 360, ..Params::default() };
        let mut yaw = YawController::default();
        let first = yaw.update(&facts(5.0), None, &params, 0.5);
        let last = (0..10).map(|_| yaw.update(&facts(5.0), None, &params, 0.5)).last().unwrap();
        assert!((first * 4.0 - last).abs() < 1e-9);
    }
}
