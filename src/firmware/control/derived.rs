//! Filter coefficients for one step length, computed when the tuning or the step changes.

use super::tuning::Tuning;
use crate::firmware::filter::{LowPass, Pt3, pt1_gain};

/// The cutoff of the demanded rates of the angle loop, Hz.
const LEVEL_RATE_HZ: f64 = 50.0;

/// The cutoff of the D boost, Hz.
const D_BOOST_HZ: f64 = 20.0;

/// The coefficients of the filters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Derived {
    /// The gyro step, s.
    pub dt: f64,
    /// The step of the rate loop, s.
    pub pid_dt: f64,
    pub gyro_lpf1: LowPass,
    pub gyro_lpf2: LowPass,
    pub d_lpf1: LowPass,
    pub d_lpf2: LowPass,
    pub yaw_lowpass: f64,
    pub relax: f64,
    pub level_rate: f64,
    /// The low-passes of the throttle that detect its quick changes.
    pub anti_gravity: f64,
    pub throttle_boost: f64,
    /// The low-pass gain of the D boost.
    pub d_boost: f64,
    /// The throttle that the moving cutoffs are for; `None` before the first one.
    filters_for: Option<f64>,
}

impl Derived {
    pub(super) fn new(tuning: &Tuning, dt: f64) -> Self {
        let rate = &tuning.rate;
        let pid_dt = dt * f64::from(rate.denominator);
        let mut derived = Self {
            dt,
            pid_dt,
            gyro_lpf1: LowPass::Off,
            gyro_lpf2: LowPass::new(rate.gyro_lpf2.kind, rate.gyro_lpf2.hz, dt),
            d_lpf1: LowPass::Off,
            d_lpf2: LowPass::new(rate.d_lpf2.kind, rate.d_lpf2.hz, pid_dt),
            yaw_lowpass: pt1_gain(rate.yaw_lowpass_hz, pid_dt),
            relax: pt1_gain(rate.relax.cutoff_hz, pid_dt),
            level_rate: Pt3::gain(LEVEL_RATE_HZ, pid_dt),
            anti_gravity: pt1_gain(tuning.boost.anti_gravity_cutoff_hz, pid_dt),
            throttle_boost: pt1_gain(tuning.boost.throttle_cutoff_hz, pid_dt),
            d_boost: pt1_gain(D_BOOST_HZ, pid_dt),
            filters_for: None,
        };
        derived.set_filters_for(tuning, 0.0);
        derived
    }

    /// Moves the cutoffs that depend on the throttle (0…1).
    pub(super) fn set_filters_for(&mut self, tuning: &Tuning, throttle: f64) {
        if self.filters_for == Some(throttle) {
            return;
        }
        self.filters_for = Some(throttle);
        let (gyro, d) = (&tuning.rate.gyro_lpf1, &tuning.rate.d_lpf1);
        self.gyro_lpf1 = LowPass::new(gyro.kind, gyro.cutoff_hz(throttle), self.dt);
        self.d_lpf1 = LowPass::new(d.kind, d.cutoff_hz(throttle), self.pid_dt);
    }
}
