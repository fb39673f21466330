//! The way down, and how to tell that it is over.

use nalgebra::Vector2;

use crate::autopilot::params::Params;
use crate::signals::SimTime;

/// Altitude setpoint of a landing, m: from `start_m` down at `rate_mps` for `elapsed_s`, on below zero until the
/// touchdown; above the landing altitude never more than 5 m below the craft, so that it cannot wind up.
#[must_use]
pub fn landing_setpoint_m(
    start_m: f64,
    rate_mps: f64,
    elapsed_s: f64,
    altitude_m: f64,
    landing_altitude_m: f64,
) -> f64 {
    let setpoint = start_m - rate_mps * elapsed_s;
    if altitude_m > landing_altitude_m { setpoint.max(altitude_m - 5.0) } else { setpoint }
}

/// Shape of the landing spiral.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spiral {
    /// Radius high up, m.
    pub radius_m: f64,
    /// Angular rate, rad/s.
    pub rate_rps: f64,
    /// Landing altitude, m: the spiral closes between it and its half.
    pub landing_altitude_m: f64,
}

impl Spiral {
    /// The spiral the parameters ask for, if any.
    #[must_use]
    pub fn from_params(params: &Params) -> Option<Self> {
        params.landing_spiral_enable.then(|| Self {
            radius_m: f64::from(params.landing_spiral_radius) / 100.0,
            rate_rps: f64::from(params.landing_spiral_rate).to_radians(),
            landing_altitude_m: f64::from(params.landing_altitude_m),
        })
    }
}

/// Offset of the horizontal target from the centre of the landing (north, east), m. With a landing altitude of zero
/// the spiral closes below 1 m.
#[must_use]
pub fn spiral_offset(spiral: &Spiral, elapsed_s: f64, altitude_m: f64) -> Vector2<f64> {
    let half = spiral.landing_altitude_m / 2.0;
    let open =
        if half > 0.0 { ((altitude_m - half) / half).clamp(0.0, 1.0) } else { f64::from(altitude_m >= 1.0) };
    let (sin, cos) = (spiral.rate_rps * elapsed_s).sin_cos();
    Vector2::new(cos, sin) * (spiral.radius_m * open)
}

/// What decides a touchdown: four measured values and their limits, SI and µs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TouchdownFacts {
    /// Altitude above home, m.
    pub altitude_m: f64,
    /// Below this altitude, m.
    pub landing_altitude_m: f64,
    /// Ground speed, m/s.
    pub ground_speed_mps: f64,
    /// Below this speed, m/s.
    pub max_speed_mps: f64,
    /// Commanded throttle, µs.
    pub throttle_us: f64,
    /// Below this throttle, µs.
    pub max_throttle_us: f64,
    /// Climb rate, m/s.
    pub climb_mps: f64,
    /// Above this (negative) climb rate, m/s: the craft does not descend any more.
    pub min_climb_mps: f64,
}

impl TouchdownFacts {
    /// The limits of the parameters around measured values; `hover_us` is the configured hover throttle, or the
    /// captured one where none is configured.
    #[must_use]
    pub fn new(
        params: &Params,
        hover_us: f64,
        altitude_m: f64,
        ground_speed_mps: f64,
        throttle_us: f64,
        climb_mps: f64,
    ) -> Self {
        Self {
            altitude_m,
            landing_altitude_m: f64::from(params.landing_altitude_m),
            ground_speed_mps,
            max_speed_mps: f64::from(params.landing_velocity_threshold) / 100.0,
            throttle_us,
            max_throttle_us: hover_us - f64::from(params.landing_throttle_threshold),
            climb_mps,
            min_climb_mps: -0.25 * params.descent_rate_mps(),
        }
    }

    /// The four conditions: low, slow, throttle low, not descending.
    #[must_use]
    pub fn conditions(&self) -> [bool; 4] {
        [
            self.altitude_m < self.landing_altitude_m,
            self.ground_speed_mps < self.max_speed_mps,
            self.throttle_us < self.max_throttle_us,
            self.climb_mps > self.min_climb_mps,
        ]
    }
}

/// How long the touchdown conditions have held without a break.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TouchdownTimer {
    since: Option<SimTime>,
}

impl TouchdownTimer {
    /// Takes the conditions of this update; returns the time they have held, µs, or `None` when they do not.
    pub fn update(&mut self, now: SimTime, all_hold: bool) -> Option<u64> {
        if !all_hold {
            self.since = None;
            return None;
        }
        let since = *self.since.get_or_insert(now);
        Some(now.0.saturating_sub(since.0))
    }
}
