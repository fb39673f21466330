//! Altitude control: throttle for a height and a climb rate.

use crate::autopilot::control::AltitudeMeasurement;
use crate::autopilot::params::Params;

/// Error, climb rate and their gains count in cm, the throttle in µs.
const CM_PER_M: f64 = 100.0;
/// µs per cm of error, for each point of `ap_altitude_p`.
const P: f64 = 0.005;
/// µs per cm and second, for each point of `ap_altitude_i`.
const I: f64 = 0.002;
/// µs per cm/s of climb rate error, for each point of `ap_altitude_d`.
const D: f64 = 0.01;
/// µs per cm/s of commanded climb rate, for each point of `ap_altitude_f`.
const F: f64 = 0.1 / 30.0;
/// The limit of the integral, µs.
const INTEGRAL_US: f64 = 150.0;
/// The error beyond which the integral works at a tenth of its gain, cm.
const FAR_CM: f64 = 200.0;
/// The climb rate above which the damping grows up to three times, cm/s.
const FAST_CMPS: f64 = 500.0;
/// The hover throttle of a craft whose stick has not shown one, µs, and the range in which the stick does.
pub(super) const USUAL_HOVER_US: f64 = 1275.0;
const HOVER_STICK_US: std::ops::RangeInclusive<f64> = 1100.0..=1700.0;

/// A height above home, m, and the climb rate towards it, m/s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Height {
    pub(super) altitude_m: f64,
    pub(super) climb_mps: f64,
}

/// The altitude controller.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct AltitudeLaw {
    integral_us: f64,
    /// The hover throttle that the stick has shown, µs.
    shown_us: Option<f64>,
}

impl AltitudeLaw {
    /// Takes over, with an empty integral. Without a configured hover throttle the present stick is one.
    pub(super) fn engage(&mut self, stick_us: f64) {
        self.integral_us = 0.0;
        self.shown_us = Some(stick_us).filter(|us| HOVER_STICK_US.contains(us));
    }

    /// Returns the hover throttle in use, µs: the setting, or the one that the stick has shown.
    pub(super) fn hover_us(&self, params: &Params) -> f64 {
        match params.hover_throttle {
            0 => self.shown_us.unwrap_or(USUAL_HOVER_US),
            us => f64::from(us),
        }
    }

    /// Returns the throttle, µs, `dt` seconds after the last update.
    pub(super) fn throttle_us(
        &mut self,
        now: &AltitudeMeasurement,
        wanted: Height,
        params: &Params,
        dt: f64,
    ) -> f64 {
        let error = (wanted.altitude_m - now.altitude_m) * CM_PER_M;
        let (wanted_cmps, climb_cmps) = (wanted.climb_mps * CM_PER_M, now.climb_mps * CM_PER_M);
        let gain = |factor: f64, points: u8| factor * f64::from(points);
        let share = if error.abs() < FAR_CM { 1.0 } else { 0.1 };
        self.integral_us = (self.integral_us + gain(I, params.altitude_i) * error * share * dt)
            .clamp(-INTEGRAL_US, INTEGRAL_US);
        let boost = 3.0 - 2.0 * (FAST_CMPS / climb_cmps.abs()).min(1.0);
        let p = gain(P, params.altitude_p) * error;
        let d = gain(D, params.altitude_d) * (wanted_cmps - climb_cmps) * boost;
        let f = gain(F, params.altitude_f) * wanted_cmps;
        let offset = p + self.integral_us + d + f + self.hover_us(params) - 1000.0;
        let throttle_us = 1000.0 + offset / now.cos_tilt.max(0.5);
        throttle_us.clamp(f64::from(params.throttle_min), f64::from(params.throttle_max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(altitude_m: f64, climb_mps: f64) -> AltitudeMeasurement {
        AltitudeMeasurement { altitude_m, climb_mps, cos_tilt: 1.0, throttle_us: 1275.0 }
    }

    fn law() -> (AltitudeLaw, Params) {
        let params =
            Params { altitude_p: 30, altitude_i: 30, altitude_d: 30, altitude_f: 30, ..Params::default() };
        let mut law = AltitudeLaw::default();
        law.engage(1500.0);
        (law, params)
    }

    #[test]
    fn a_craft_at_its_height_gets_the_hover_throttle() {
        let (mut law, params) = law();
        let height = Height { altitude_m: 20.0, climb_mps: 0.0 };
        assert_eq!(law.throttle_us(&at(20.0, 0.0), height, &params, 0.01), 1275.0);
    }

    #[test]
    fn an_error_of_a_metre_a_climb_and_a_commanded_climb_have_their_gains() {
        let (mut law, params) = law();
        let height = |climb_mps| Height { altitude_m: 21.0, climb_mps };
        let still = law.throttle_us(&at(20.0, 0.0), height(0.0), &params, 0.0);
        assert!((still - (1275.0 + 15.0)).abs() < 1e-9, "{still}");
        let rising = law.throttle_us(&at(20.0, 1.0), height(0.0), &params, 0.0);
        assert!((still - rising - 30.0).abs() < 1e-9, "{rising}");
        let commanded = law.throttle_us(&at(20.0, 1.0), height(1.0), &params, 0.0);
        assert!((commanded - still - 10.0).abs() < 1e-9, "{commanded}");
        // Twice the climb rate of the boost has twice the damping.
        let fast = law.throttle_us(&at(20.0, 10.0), height(10.0), &params, 0.0);
        assert!((fast - still - 100.0).abs() < 1e-9, "{fast}");
    }

    #[test]
    fn the_integral_is_slow_far_away_and_limited() {
        let (mut law, params) = law();
        let height = |altitude_m| Height { altitude_m, climb_mps: 0.0 };
        law.throttle_us(&at(20.0, 0.0), height(21.0), &params, 1.0);
        assert!((law.integral_us - 6.0).abs() < 1e-9);
        law.throttle_us(&at(20.0, 0.0), height(30.0), &params, 1.0);
        assert!((law.integral_us - 12.0).abs() < 1e-9);
        (0..1000).for_each(|_| _ = law.throttle_us(&at(20.0, 0.0), height(21.0), &params, 1.0));
        assert_eq!(law.integral_us, INTEGRAL_US);
    }

    #[test]
    fn the_stick_shows_the_hover_throttle_if_none_is_set() {
        let mut law = AltitudeLaw::default();
        let params = Params { hover_throttle: 0, ..Params::default() };
        for (stick_us, hover_us) in [(1400.0, 1400.0), (1000.0, USUAL_HOVER_US), (1800.0, USUAL_HOVER_US)] {
            law.engage(stick_us);
            assert_eq!(law.hover_us(&params), hover_us);
        }
    }
}
