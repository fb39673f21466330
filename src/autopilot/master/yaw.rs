//! Yaw control: the rate that turns the nose to a wanted heading.

use crate::autopilot::params::{Params, YawMode};
use crate::geo::wrap_pi;

/// The time in which the rate grows to its full value after there was no wanted heading, s.
const RAMP_S: f64 = 1.0;
/// The share of `ap_min_forward_velocity` down to which the course is kept.
const RELEASE: f64 = 0.75;
/// Degrees/s per degree of error, and per degree/s of yaw rate, for each point of the gains.
const GAIN: f64 = 0.01;

/// The inputs of yaw control. Angles in rad, clockwise from north.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct YawFacts {
    pub(super) heading_rad: f64,
    pub(super) yaw_rate_rps: f64,
    pub(super) course_rad: f64,
    pub(super) ground_speed_mps: f64,
    /// The bearing to the target; `None` within its acceptance radius.
    pub(super) bearing_rad: Option<f64>,
    /// The heading that the leg commands.
    pub(super) commanded_rad: Option<f64>,
}

/// The yaw controller.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct YawLaw {
    has_course: bool,
    ramp: f64,
}

impl YawLaw {
    /// Starts again, without a course.
    pub(super) fn reset(&mut self) {
        *self = Self::default();
    }

    /// Returns the yaw rate, rad/s clockwise; `None` if nothing turns the nose. `cap_dps` is that of a YAW_RATE.
    pub(super) fn rate_rps(
        &mut self,
        facts: &YawFacts,
        cap_dps: Option<f64>,
        params: &Params,
        dt: f64,
    ) -> Option<f64> {
        let least_mps = 0.01 * f64::from(params.min_forward_velocity);
        let least_mps = if self.has_course { RELEASE * least_mps } else { least_mps };
        self.has_course = facts.ground_speed_mps >= least_mps;
        let course = self.has_course.then_some(facts.course_rad);
        let wanted = facts.commanded_rad.or(match params.yaw_mode {
            YawMode::Velocity => course,
            YawMode::Bearing => facts.bearing_rad,
            YawMode::Hybrid => course.or(facts.bearing_rad),
            YawMode::Fixed | YawMode::Dampener => None,
        });
        let Some(wanted) = wanted else {
            self.ramp = 0.0;
            return None;
        };
        self.ramp = (self.ramp + dt / RAMP_S).min(1.0);
        let error = wrap_pi(wanted - facts.heading_rad).to_degrees();
        let rate = GAIN
            * (error * f64::from(params.yaw_p) - facts.yaw_rate_rps.to_degrees() * f64::from(params.yaw_d));
        let most = cap_dps.unwrap_or(f64::INFINITY).min(f64::from(params.max_yaw_rate));
        Some((rate * self.ramp).clamp(-most, most).to_radians())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts() -> YawFacts {
        YawFacts {
            heading_rad: 0.0,
            yaw_rate_rps: 0.0,
            course_rad: 20_f64.to_radians(),
            ground_speed_mps: 5.0,
            bearing_rad: None,
            commanded_rad: None,
        }
    }

    /// Returns the rate, degrees/s, after the ramp.
    fn rate(law: &mut YawLaw, facts: &YawFacts, cap_dps: Option<f64>, params: &Params) -> Option<f64> {
        (0..200).map(|_| law.rate_rps(facts, cap_dps, params, 0.01)).last().flatten().map(f64::to_degrees)
    }

    #[test]
    fn the_course_turns_the_nose_while_the_craft_is_fast_enough() {
        let (mut law, params) = (YawLaw::default(), Params::default());
        let at = |ground_speed_mps| YawFacts { ground_speed_mps, ..facts() };
        assert_eq!(rate(&mut law, &at(2.5), None, &params), None);
        assert!((rate(&mut law, &at(3.0), None, &params).unwrap() - 10.0).abs() < 1e-9);
        assert!(rate(&mut law, &at(2.5), None, &params).is_some(), "down to three quarters");
        assert_eq!(rate(&mut law, &at(2.2), None, &params), None);
    }

    #[test]
    fn the_rate_grows_within_a_second_and_is_limited() {
        let (mut law, params) = (YawLaw::default(), Params::default());
        let first = law.rate_rps(&facts(), None, &params, 0.5).unwrap().to_degrees();
        assert!((first - 5.0).abs() < 1e-9);
        let back = YawFacts { commanded_rad: Some(std::f64::consts::PI), ..facts() };
        assert!((rate(&mut law, &back, None, &params).unwrap().abs() - 30.0).abs() < 1e-9);
        assert!((rate(&mut law, &back, Some(8.0), &params).unwrap().abs() - 8.0).abs() < 1e-9);
    }

    #[test]
    fn a_fixed_nose_is_turned_only_by_the_leg() {
        let (mut law, params) = (YawLaw::default(), Params { yaw_mode: YawMode::Fixed, ..Params::default() });
        assert_eq!(rate(&mut law, &facts(), None, &params), None);
        let commanded = YawFacts { commanded_rad: Some(0.1), ..facts() };
        assert!(rate(&mut law, &commanded, None, &params).is_some());
    }
}
