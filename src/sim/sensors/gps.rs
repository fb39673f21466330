//! GPS: position and velocity of one past instant, with acquisition, errors and faults.

use nalgebra::Vector3;
use rand::RngExt;

use crate::geo::{LatLon, LocalFrame};
use crate::signals::GpsSample;
use crate::sim::config::Noise;
use crate::sim::fault::GpsFaults;
use crate::sim::random::{GaussMarkov, Normals, Stream};
use crate::sim::truth::Truth;

/// Slow ticks in a second.
const TICKS_PER_S: u64 = 100;
/// Age of a solution, slow ticks: 100 ms.
const LATENCY_TICKS: usize = 10;
/// White position error and wandering one (standard deviation, m; time constant, s), horizontally.
const POSITION_WHITE_M: f64 = 0.03;
const POSITION_WANDER: (f64, f64) = (0.25, 60.0);
/// Vertical position errors over horizontal ones.
const VERTICAL_FACTOR: f64 = 1.6;
/// White velocity errors, m/s.
const VELOCITY_MPS: Vector3<f64> = Vector3::new(0.05, 0.05, 0.08);
/// Acquisition: first satellites, first fix, full constellation, s after boot; all times ± 20 % together.
const FIRST_SATS_S: f64 = 1.5;
const FIRST_FIX_S: f64 = 3.0;
const FULL_S: f64 = 4.5;
const ACQUISITION_SPREAD: f64 = 0.2;
/// A fix returns this long after the end of a loss, s.
const REACQUISITION_S: f64 = 1.5;
/// Satellites and HDOP: searching, at the first fix, with the full constellation.
const SEARCH_SATS: u8 = 4;
const FIX_SATS: u8 = 7;
const FULL_SATS: u8 = 12;
const FIX_HDOP: f64 = 2.5;
const FULL_HDOP: f64 = 0.8;
/// Errors at the first fix over errors with the full constellation.
const FIX_ERROR_FACTOR: f64 = 3.0;
/// Accuracies reported with the full constellation, m.
const HORIZONTAL_ACCURACY_M: f64 = 1.0;
const VERTICAL_ACCURACY_M: f64 = 1.6;
/// Default rate, Hz.
const DEFAULT_RATE_HZ: u8 = 10;

/// What the receiver sees of the sky.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sky {
    fix: bool,
    sats: u8,
    hdop: f64,
    error_factor: f64,
}

impl Sky {
    const BLIND: Self = Self { fix: false, sats: 0, hdop: 99.0, error_factor: 1.0 };
    const FULL: Self = Self { fix: true, sats: FULL_SATS, hdop: FULL_HDOP, error_factor: 1.0 };

    /// Acquisition `t` nominal seconds after boot.
    fn acquiring(t: f64) -> Self {
        if t < FIRST_SATS_S {
            Self::BLIND
        } else if t < FIRST_FIX_S {
            Self { sats: SEARCH_SATS, ..Self::BLIND }
        } else {
            let grown = ((t - FIRST_FIX_S) / (FULL_S - FIRST_FIX_S)).min(1.0);
            Self {
                fix: true,
                sats: FIX_SATS + (grown * f64::from(FULL_SATS - FIX_SATS)) as u8,
                hdop: FIX_HDOP + grown * (FULL_HDOP - FIX_HDOP),
                error_factor: FIX_ERROR_FACTOR + grown * (1.0 - FIX_ERROR_FACTOR),
            }
        }
    }
}

/// Position and velocity at a slow tick, ENU, m and m/s.
type Moment = (Vector3<f64>, Vector3<f64>);

/// The receiver.
#[derive(Debug, Clone)]
pub(in crate::sim) struct Gps {
    /// Solutions a second.
    rate_hz: u8,
    normals: Normals,
    wander: Vector3<f64>,
    wander_process: GaussMarkov,
    /// Duration of this receiver's acquisition over the nominal one.
    acquisition_scale: f64,
    /// The last moments, a ring by tick number.
    past: [Moment; LATENCY_TICKS + 1],
    /// Nominal time at which the last loss ended, s after boot.
    lost_until_s: Option<f64>,
    last: GpsSample,
}

impl Gps {
    pub(crate) fn new(seed: u64) -> Self {
        let mut normals = Normals::new(seed, Stream::Gps);
        let (sigma, tau_s) = POSITION_WANDER;
        let spread = 1.0 - ACQUISITION_SPREAD..1.0 + ACQUISITION_SPREAD;
        Self {
            rate_hz: DEFAULT_RATE_HZ,
            wander: normals.next3() * sigma,
            normals,
            wander_process: GaussMarkov::stationary(sigma, tau_s, 1.0 / f64::from(DEFAULT_RATE_HZ)),
            acquisition_scale: Stream::GpsAcquisition.rng(seed).random_range(spread),
            past: [(Vector3::zeros(), Vector3::zeros()); LATENCY_TICKS + 1],
            lost_until_s: None,
            last: GpsSample::default(),
        }
    }

    /// Sets the number of solutions a second, 1…20.
    pub(crate) fn set_rate(&mut self, rate_hz: u8) {
        let (sigma, tau_s) = POSITION_WANDER;
        self.rate_hz = rate_hz;
        self.wander_process = GaussMarkov::stationary(sigma, tau_s, 1.0 / f64::from(rate_hz));
    }

    /// Forgets the past: the craft has always been here.
    pub(crate) fn settle(&mut self, pos_enu: Vector3<f64>, vel_enu: Vector3<f64>) {
        self.past = [(pos_enu, vel_enu); LATENCY_TICKS + 1];
    }

    /// One slow tick; the navigation message when one is due.
    pub(crate) fn advance(
        &mut self,
        tick: u64,
        truth: &Truth,
        local: &LocalFrame,
        faults: &GpsFaults,
        noise: Noise,
    ) -> Option<GpsSample> {
        let slots = self.past.len() as u64;
        self.past[(tick % slots) as usize] = (truth.pos_enu, truth.vel_enu);
        let rate = u64::from(self.rate_hz);
        let is_due = tick == 0 || tick * rate / TICKS_PER_S != (tick - 1) * rate / TICKS_PER_S;
        if !is_due {
            return None;
        }
        let latency = match noise {
            Noise::Real => LATENCY_TICKS as u64,
            Noise::None => 0,
        };
        let moment = self.past[((tick + slots - latency) % slots) as usize];
        let mut sample = self.solve(tick, moment, local, faults, noise);
        sample.latency_s = latency as f64 / TICKS_PER_S as f64;
        if !faults.freeze {
            self.last = sample;
        }
        Some(self.last)
    }

    fn solve(
        &mut self,
        tick: u64,
        (mut pos, mut vel): Moment,
        local: &LocalFrame,
        faults: &GpsFaults,
        noise: Noise,
    ) -> GpsSample {
        let sky = self.sky(tick as f64 / TICKS_PER_S as f64, faults.loss, noise);
        if noise == Noise::Real {
            // Drawn without a fix too, so that a loss leaves the later errors as they are.
            let (position, velocity) = self.errors();
            let factor = sky.error_factor * faults.noise_factor;
            pos += position * factor;
            vel += velocity * factor;
        }
        if !sky.fix {
            return GpsSample { fix: false, sats: sky.sats, hdop: sky.hdop, ..GpsSample::default() };
        }
        let (lat_deg, lon_deg, alt_m) = local.to_geodetic(pos + faults.shift_enu);
        GpsSample {
            fix: true,
            sats: sky.sats,
            position: LatLon::from_degrees(lat_deg, lon_deg),
            alt_amsl_cm: (alt_m * 100.0).round() as i32,
            vel_enu: vel,
            hdop: sky.hdop,
            horizontal_accuracy_m: HORIZONTAL_ACCURACY_M * sky.error_factor,
            vertical_accuracy_m: VERTICAL_ACCURACY_M * sky.error_factor,
            latency_s: 0.0,
        }
    }

    /// Errors of position (m) and velocity (m/s) with the full constellation.
    fn errors(&mut self) -> (Vector3<f64>, Vector3<f64>) {
        let normal = self.normals.next3();
        self.wander = self.wander.zip_map(&normal, |value, normal| self.wander_process.next(value, normal));
        let mut position = self.wander + self.normals.next3() * POSITION_WHITE_M;
        position.z *= VERTICAL_FACTOR;
        (position, self.normals.next3().component_mul(&VELOCITY_MPS))
    }

    fn sky(&mut self, now_s: f64, loss: bool, noise: Noise) -> Sky {
        if loss {
            self.lost_until_s = Some(now_s + 1.0 / f64::from(self.rate_hz));
            return Sky::BLIND;
        }
        match noise {
            Noise::None if now_s >= FIRST_FIX_S => Sky::FULL,
            Noise::None => Sky::BLIND,
            // The epsilon keeps a return of 1.5 s from becoming 1.6 s by rounding.
            Noise::Real if self.lost_until_s.is_some_and(|end| now_s - end < REACQUISITION_S - 1e-6) => {
                Sky { sats: SEARCH_SATS, ..Sky::BLIND }
            }
            Noise::Real => Sky::acquiring(now_s / self.acquisition_scale),
        }
    }
}
