//! Continuous turbulence: Dryden spectra with the low-altitude scales of MIL-F-8785C.
//!
//! Longitudinal: first order, `u' = a·u + b·n` with `a = exp(−VΔt/L)`. Lateral and vertical: second order,
//! `σ·√(L/πV)·(1 + √3·Ls/V)/(1 + Ls/V)²`. All three have unit variance and are scaled by σ when read.

use std::f64::consts::FRAC_1_SQRT_2;

use nalgebra::Vector3;

use crate::math;
use crate::sim::random::{Normals, Stream};
use crate::sim::wind::Wind;
use crate::telemetry::Turbulence;

const FEET_PER_METRE: f64 = 1.0 / 0.3048;
const KNOT_MPS: f64 = 1852.0 / 3600.0;
/// The heights for which the low-altitude scales are specified, ft.
const HEIGHT_FT: (f64, f64) = (10.0, 1000.0);
/// The rate at which the wind at 20 ft follows a change of level, kt/s. That wind represents the level.
const LEVEL_RAMP_KT_PER_S: f64 = 22.5;
/// The minimum airspeed through the frozen field, m/s, so that a hovering craft meets turbulence too.
const MIN_AIRSPEED_MPS: f64 = 1.0;

/// Scale lengths (m) and standard deviations (m/s) of turbulence at a height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrydenScales {
    /// Longitudinal and lateral scale length, m.
    pub length_uv_m: f64,
    /// Vertical scale length, m.
    pub length_w_m: f64,
    /// Longitudinal and lateral standard deviation, m/s.
    pub sigma_uv_mps: f64,
    /// Vertical standard deviation, m/s.
    pub sigma_w_mps: f64,
}

impl DrydenScales {
    /// Returns the scales at a height above ground (m) for a wind at 20 ft (kt): `L_w = h`, `L_u = L_v = h/(0.177 +
    /// 0.000823·h)^1.2`, `σ_w = 0.1·W20`, `σ_u = σ_v = σ_w/(0.177 + 0.000823·h)^0.4` with h in feet.
    pub fn at(height_m: f64, wind_at_20ft_kt: f64) -> Self {
        let (low, high) = HEIGHT_FT;
        let height_ft = (height_m * FEET_PER_METRE).clamp(low, high);
        // base^1.2 = (base^0.4)³.
        let root = math::powf(0.177 + 0.000_823 * height_ft, 0.4);
        let sigma_w_mps = 0.1 * wind_at_20ft_kt * KNOT_MPS;
        Self {
            length_uv_m: height_ft / (root * root * root) / FEET_PER_METRE,
            length_w_m: height_ft / FEET_PER_METRE,
            sigma_uv_mps: sigma_w_mps / root,
            sigma_w_mps,
        }
    }
}

impl DrydenScales {
    /// Returns the longitudinal filter of unit variance, `u' = a·u + b·n`, at an airspeed (m/s) and tick (s): `a =
    /// exp(−VΔt/L)`, `b = √(1 − a²)`.
    pub fn longitudinal_filter(&self, airspeed_mps: f64, dt: f64) -> (f64, f64) {
        let keep = decay(airspeed_mps * dt, self.length_uv_m);
        (keep, unit_drive(keep))
    }
}

/// Returns the rest of a disturbance after a flight of `way_m` through air of the given scale length.
fn decay(way_m: f64, length_m: f64) -> f64 {
    math::exp(-way_m / length_m)
}

/// Returns the drive that gives a first-order lag unit variance.
fn unit_drive(keep: f64) -> f64 {
    (1.0 - keep * keep).sqrt()
}

/// A second-order Dryden filter of unit variance: two lags in a row, `√3·first + (1 − √3)·second`.
#[derive(Debug, Clone, Copy, Default)]
struct SecondOrder {
    first: f64,
    second: f64,
}

impl SecondOrder {
    /// Returns a filter in a settled state.
    fn settled(normals: &mut Normals) -> Self {
        // Variances ½ and ¼, covariance ¼.
        let first = FRAC_1_SQRT_2 * normals.next();
        Self { first, second: 0.5 * first + 0.5 * FRAC_1_SQRT_2 * normals.next() }
    }

    /// Advances by one tick with `keep = exp(−VΔt/L)`.
    fn advance(&mut self, keep: f64, normal: f64) {
        let before = self.first;
        // The first lag has half the variance of the output.
        self.first = keep * before + FRAC_1_SQRT_2 * unit_drive(keep) * normal;
        self.second = keep * self.second + (1.0 - keep) * 0.5 * (before + self.first);
    }

    fn output(&self) -> f64 {
        let root3 = 3.0_f64.sqrt();
        root3 * self.first + (1.0 - root3) * self.second
    }
}

/// The turbulence at the craft.
#[derive(Debug, Clone)]
pub(in crate::sim) struct TurbulenceFilter {
    pub level: Turbulence,
    /// Wind at 20 ft for the present strength, kt: that of the level, or on the way to it.
    strength_kt: f64,
    normals: Normals,
    /// Longitudinal, lateral and vertical filter; `None` before the first turbulence.
    filters: Option<(f64, SecondOrder, SecondOrder)>,
    scales: DrydenScales,
}

impl TurbulenceFilter {
    pub(crate) fn new(seed: u64, level: Turbulence) -> Self {
        let strength_kt = level.wind_at_20ft_kt();
        Self {
            level,
            strength_kt,
            normals: Normals::new(seed, Stream::Turbulence),
            filters: None,
            scales: DrydenScales::at(0.0, strength_kt),
        }
    }

    /// Advances by one tick of `dt` seconds at a height above ground (m) and speed through the mean air (m/s).
    pub(crate) fn advance(&mut self, height_m: f64, airspeed_mps: f64, dt: f64) {
        let ramp = LEVEL_RAMP_KT_PER_S * dt;
        self.strength_kt += (self.level.wind_at_20ft_kt() - self.strength_kt).clamp(-ramp, ramp);
        if self.strength_kt == 0.0 {
            self.scales = DrydenScales { sigma_uv_mps: 0.0, sigma_w_mps: 0.0, ..self.scales };
            return;
        }
        self.scales = DrydenScales::at(height_m, self.strength_kt);
        let airspeed_mps = airspeed_mps.max(MIN_AIRSPEED_MPS);
        let (keep_uv, drive_u) = self.scales.longitudinal_filter(airspeed_mps, dt);
        let keep_w = decay(airspeed_mps * dt, self.scales.length_w_m);
        let normals = &mut self.normals;
        let (u, v, w) = self.filters.get_or_insert_with(|| {
            (normals.next(), SecondOrder::settled(normals), SecondOrder::settled(normals))
        });
        let normal = normals.next3();
        *u = keep_uv * *u + drive_u * normal.x;
        v.advance(keep_uv, normal.y);
        w.advance(keep_w, normal.z);
    }

    /// Returns the velocity along the mean wind, to its left, and up, m/s.
    fn velocity_uvw(&self) -> Vector3<f64> {
        self.filters.map_or_else(Vector3::zeros, |(u, v, w)| {
            let (sigma_uv, sigma_w) = (self.scales.sigma_uv_mps, self.scales.sigma_w_mps);
            Vector3::new(u * sigma_uv, v.output() * sigma_uv, w.output() * sigma_w)
        })
    }

    /// Returns the velocity, ENU, m/s, for a mean wind from the given direction.
    pub(crate) fn velocity_enu(&self, from_deg: f64) -> Vector3<f64> {
        let along = Wind { speed_mps: 1.0, from_deg }.velocity_enu();
        let left = Vector3::new(-along.y, along.x, 0.0);
        let uvw = self.velocity_uvw();
        along * uvw.x + left * uvw.y + Vector3::z() * uvw.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns standard deviations, means and the autocorrelation of u at `lag` ticks over 20 000 s at 5 m/s and
    /// 15.24 m.
    fn statistics(level: Turbulence) -> (Vector3<f64>, Vector3<f64>, f64) {
        let mut filter = TurbulenceFilter::new(11, level);
        let n = 2_000_000;
        let lag = (94.728 / 5.0 / 0.01) as usize;
        let mut along = Vec::with_capacity(n);
        let (mut sum, mut squares) = (Vector3::zeros(), Vector3::zeros());
        for _ in 0..n {
            filter.advance(15.24, 5.0, 0.01);
            let uvw = filter.velocity_uvw();
            sum += uvw;
            squares += uvw.component_mul(&uvw);
            along.push(uvw.x);
        }
        let mean = sum / n as f64;
        let variance: Vector3<f64> = squares / n as f64 - mean.component_mul(&mean);
        let product: f64 = along.iter().zip(&along[lag..]).map(|(a, b)| a * b).sum();
        (variance.map(f64::sqrt), mean, product / (n - lag) as f64 / variance.x)
    }

    #[test]
    fn every_level_has_its_deviations_and_correlation() {
        for level in [Turbulence::Light, Turbulence::Moderate, Turbulence::Severe] {
            let scales = DrydenScales::at(15.24, level.wind_at_20ft_kt());
            let (sigma, mean, correlation) = statistics(level);
            for (got, want) in [
                (sigma.x, scales.sigma_uv_mps),
                (sigma.y, scales.sigma_uv_mps),
                (sigma.z, scales.sigma_w_mps),
            ] {
                assert!((got / want - 1.0).abs() < 0.1, "{level}: {got} instead of {want}");
            }
            assert!(mean.x.abs() < 0.2 * scales.sigma_uv_mps && mean.y.abs() < 0.2 * scales.sigma_uv_mps);
            assert!(mean.z.abs() < 0.2 * scales.sigma_w_mps);
            assert!((correlation - 0.37).abs() < 0.12, "{level}: {correlation}");
        }
    }

    /// Returns the one-sided power density at a frequency, (m/s)²/Hz, averaged over Hann windows of 100 s.
    fn density(samples: &[f64], frequency_hz: f64) -> f64 {
        const SEGMENT: usize = 10_000;
        let (mut sum, mut count) = (0.0, 0.0);
        for segment in samples.chunks_exact(SEGMENT) {
            let (mut re, mut im) = (0.0, 0.0);
            for (i, sample) in segment.iter().enumerate() {
                let window = 1.0 - (std::f64::consts::TAU * i as f64 / SEGMENT as f64).cos();
                let (sin, cos) = (std::f64::consts::TAU * frequency_hz * 0.01 * i as f64).sin_cos();
                re += window * sample * cos;
                im += window * sample * sin;
            }
            // The squares of the window average 1.5 per sample.
            sum += 2.0 * (re * re + im * im) * 0.01 / (1.5 * SEGMENT as f64);
            count += 1.0;
        }
        sum / count
    }

    fn spectra_are_those_of_dryden(level: Turbulence) {
        let mut filter = TurbulenceFilter::new(7, level);
        let mut axes = [Vec::new(), Vec::new(), Vec::new()];
        for _ in 0..2_000_000 {
            filter.advance(15.24, 5.0, 0.01);
            let uvw = filter.velocity_uvw();
            axes.iter_mut().zip(uvw.iter()).for_each(|(axis, value)| axis.push(*value));
        }
        let scales = DrydenScales::at(15.24, level.wind_at_20ft_kt());
        let (uv, w) =
            ((scales.sigma_uv_mps, scales.length_uv_m / 5.0), (scales.sigma_w_mps, scales.length_w_m / 5.0));
        for frequency_hz in [0.05, 0.1, 0.3, 1.0, 3.0] {
            // The squared phase at the frequency and the power at zero frequency, of a first-order filter.
            let shape = |(sigma, lag): (f64, f64)| {
                ((std::f64::consts::TAU * frequency_hz * lag).powi(2), sigma * sigma * lag)
            };
            let first = |(x2, power): (f64, f64)| 4.0 * power / (1.0 + x2);
            let second = |(x2, power): (f64, f64)| 2.0 * power * (1.0 + 3.0 * x2) / (1.0 + x2).powi(2);
            let want = [first(shape(uv)), second(shape(uv)), second(shape(w))];
            for (axis, want) in axes.iter().zip(want) {
                // Two hundred windows have 7 % of scatter.
                let got = density(axis, frequency_hz);
                assert!(
                    (got / want - 1.0).abs() < 0.25,
                    "{level} at {frequency_hz} Hz: {got} instead of {want}"
                );
            }
        }
    }

    #[test]
    fn moderate_turbulence_has_the_spectra_of_dryden() {
        spectra_are_those_of_dryden(Turbulence::Moderate);
    }

    #[test]
    #[ignore = "search: the other levels of the test before it"]
    fn light_and_severe_turbulence_have_the_spectra_of_dryden() {
        spectra_are_those_of_dryden(Turbulence::Light);
        spectra_are_those_of_dryden(Turbulence::Severe);
    }

    #[test]
    fn smooth_air_is_still_and_draws_nothing() {
        let mut filter = TurbulenceFilter::new(1, Turbulence::None);
        filter.advance(20.0, 5.0, 0.01);
        assert_eq!(filter.velocity_enu(0.0), Vector3::zeros());
        assert!(filter.filters.is_none());
    }

    #[test]
    fn it_begins_settled_and_changes_level_without_a_step() {
        let at_boot: Vec<f64> = (0..400)
            .map(|seed| {
                let mut filter = TurbulenceFilter::new(seed, Turbulence::Light);
                filter.advance(15.24, 0.0, 0.01);
                filter.velocity_uvw().y
            })
            .collect();
        let sigma = (at_boot.iter().map(|v| v * v).sum::<f64>() / 400.0).sqrt();
        assert!((sigma / 1.4188 - 1.0).abs() < 0.15, "{sigma}");
        let mut filter = TurbulenceFilter::new(1, Turbulence::None);
        let mut last = Vector3::zeros();
        for tick in 0..1000 {
            filter.level = if tick < 500 { Turbulence::Severe } else { Turbulence::None };
            filter.advance(15.24, 5.0, 0.01);
            let now = filter.velocity_uvw();
            // The noise of one tick is √(2VΔt/L)·σ ≈ 0.14 m/s, vertically 0.18; the ramp adds 1 % of the full
            // strength.
            assert!((now - last).amax() < 1.0, "{last} {now}");
            last = now;
        }
        assert_eq!(last, Vector3::zeros());
    }
}
