//! The GPS: position and velocity of one past instant, with acquisition, errors and faults.

use nalgebra::Vector3;
use rand::RngExt;

use crate::geo::{LatLon, LocalFrame};
use crate::signals::GpsSample;
use crate::sim::config::Noise;
use crate::sim::fault::{GpsFaults, MAX_GPS_DELAY_S};
use crate::sim::random::{GaussMarkov, Normals, Stream};
use crate::sim::truth::Truth;

mod multipath;

use crate::sim::gps_grade::{GpsGrade, GradeErrors};
use multipath::Multipath;

/// The number of slow ticks per second.
const TICKS_PER_S: u64 = 100;
/// The age of a solution, slow ticks: 100 ms.
const LATENCY_TICKS: usize = 10;
/// Vertical position errors and reported accuracies over horizontal ones.
const VERTICAL_FACTOR: f64 = 1.6;
/// The acquisition: first satellites, first fix, full constellation, s after boot. A common factor varies all times
/// by ± 20 %.
const FIRST_SATS_S: f64 = 1.5;
const FIRST_FIX_S: f64 = 3.0;
const FULL_S: f64 = 4.5;
const ACQUISITION_SPREAD: f64 = 0.2;
/// The time from the end of a loss to the next fix, s.
const REACQUISITION_S: f64 = 1.5;
/// The satellites during the search and at the first fix, and the HDOP at the first fix.
const SEARCH_SATS: u8 = 4;
const FIX_SATS: u8 = 7;
const FIX_HDOP: f64 = 2.5;
/// The errors at the first fix over the errors with the full constellation.
const FIX_ERROR_FACTOR: f64 = 3.0;
/// The default rate, Hz.
const DEFAULT_RATE_HZ: u8 = 10;
/// The highest rate, Hz.
const MAX_RATE_HZ: usize = 20;

/// The receiver's view of the sky.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sky {
    fix: bool,
    sats: u8,
    hdop: f64,
    error_factor: f64,
}

impl Sky {
    const BLIND: Self = Self { fix: false, sats: 0, hdop: 99.0, error_factor: 1.0 };

    /// Returns the view with all satellites of a grade.
    fn full(grade: &GradeErrors) -> Self {
        Self { fix: true, sats: grade.sats, hdop: grade.hdop, error_factor: 1.0 }
    }

    /// Returns the view during acquisition, `t` nominal seconds after boot.
    fn acquiring(t: f64, grade: &GradeErrors) -> Self {
        if t < FIRST_SATS_S {
            Self::BLIND
        } else if t < FIRST_FIX_S {
            Self { sats: SEARCH_SATS, ..Self::BLIND }
        } else {
            let grown = ((t - FIRST_FIX_S) / (FULL_S - FIRST_FIX_S)).min(1.0);
            Self {
                fix: true,
                sats: FIX_SATS + (grown * f64::from(grade.sats - FIX_SATS)) as u8,
                hdop: FIX_HDOP + grown * (grade.hdop - FIX_HDOP),
                error_factor: FIX_ERROR_FACTOR + grown * (1.0 - FIX_ERROR_FACTOR),
            }
        }
    }
}

/// The longest delay, solutions: that of the fault at the highest rate.
const MAX_DELAY: usize = (MAX_GPS_DELAY_S as usize) * MAX_RATE_HZ;

/// Position and velocity at a slow tick, ENU, m and m/s.
type Moment = (Vector3<f64>, Vector3<f64>);

#[derive(Debug, Clone)]
pub(in crate::sim) struct Gps {
    rate_hz: u8,
    grade: GpsGrade,
    normals: Normals,
    multipath: Multipath,
    wander: Vector3<f64>,
    wander_process: GaussMarkov,
    /// Duration of the acquisition of this receiver over the nominal one.
    acquisition_scale: f64,
    /// The last moments, a ring indexed by tick number.
    past: [Moment; LATENCY_TICKS + 1],
    /// Nominal time at which the last loss ended, s after boot.
    lost_until_s: Option<f64>,
    /// The newest solutions, a ring, and the number of solutions so far.
    solutions: [GpsSample; MAX_DELAY + 1],
    count: usize,
    last: GpsSample,
}

impl Gps {
    pub(crate) fn new(seed: u64, grade: GpsGrade) -> Self {
        let mut normals = Normals::new(seed, Stream::Gps);
        let spread = 1.0 - ACQUISITION_SPREAD..1.0 + ACQUISITION_SPREAD;
        Self {
            rate_hz: DEFAULT_RATE_HZ,
            grade,
            wander: normals.next3() * grade.errors().wander_sigma_m,
            normals,
            multipath: Multipath::new(seed),
            wander_process: wander_process(grade, DEFAULT_RATE_HZ),
            acquisition_scale: Stream::GpsAcquisition.rng(seed).random_range(spread),
            past: [(Vector3::zeros(), Vector3::zeros()); LATENCY_TICKS + 1],
            lost_until_s: None,
            solutions: [GpsSample::default(); MAX_DELAY + 1],
            count: 0,
            last: GpsSample::default(),
        }
    }

    /// Returns the number of solutions per second.
    pub(crate) fn rate_hz(&self) -> u8 {
        self.rate_hz
    }

    /// Sets the number of solutions per second, 1…20.
    pub(crate) fn set_rate(&mut self, rate_hz: u8) {
        self.rate_hz = rate_hz;
        self.wander_process = wander_process(self.grade, rate_hz);
    }

    /// Changes the grade. The wandering error keeps its place in its distribution.
    pub(crate) fn set_grade(&mut self, grade: GpsGrade) {
        self.wander *= grade.errors().wander_sigma_m / self.grade.errors().wander_sigma_m;
        self.grade = grade;
        self.wander_process = wander_process(grade, self.rate_hz);
    }

    /// Forgets the history, as if the craft had always been here.
    pub(crate) fn settle(&mut self, pos_enu: Vector3<f64>, vel_enu: Vector3<f64>) {
        self.past = [(pos_enu, vel_enu); LATENCY_TICKS + 1];
    }

    /// Advances by one slow tick. Returns the navigation message if one is due.
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
        let slots = self.solutions.len();
        self.solutions[self.count % slots] = sample;
        let delay = (faults.delay_s * f64::from(self.rate_hz)).round() as usize;
        if !faults.freeze {
            self.last = self.solutions[(self.count - delay.min(self.count).min(MAX_DELAY)) % slots];
        }
        self.count += 1;
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
        let grade = self.grade.errors();
        let sky = self.sky(tick as f64 / TICKS_PER_S as f64, faults.loss, noise);
        if noise == Noise::Real {
            // The errors are drawn even without a fix, so that a loss does not change the later errors.
            let (position, velocity) = self.errors(&grade);
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
            horizontal_accuracy_m: grade.horizontal_accuracy_m * sky.error_factor,
            vertical_accuracy_m: grade.horizontal_accuracy_m * VERTICAL_FACTOR * sky.error_factor,
            speed_accuracy_mps: grade.velocity_white_mps[0] * sky.error_factor,
            latency_s: 0.0,
        }
    }

    /// Returns the errors of position (m) and velocity (m/s) with the full constellation.
    fn errors(&mut self, grade: &GradeErrors) -> (Vector3<f64>, Vector3<f64>) {
        let normal = self.normals.next3();
        self.wander = self.wander.zip_map(&normal, |value, normal| self.wander_process.next(value, normal));
        let mut position = self.wander + self.normals.next3() * grade.position_white_m;
        position.z *= VERTICAL_FACTOR;
        if grade.is_urban {
            self.multipath.advance(1.0 / f64::from(self.rate_hz));
            position += self.multipath.shift_enu();
        }
        let [horizontal, vertical] = grade.velocity_white_mps;
        let velocity = self.normals.next3().component_mul(&Vector3::new(horizontal, horizontal, vertical));
        (position, velocity)
    }

    fn sky(&mut self, now_s: f64, loss: bool, noise: Noise) -> Sky {
        if loss {
            self.lost_until_s = Some(now_s + 1.0 / f64::from(self.rate_hz));
            return Sky::BLIND;
        }
        let grade = self.grade.errors();
        match noise {
            Noise::None if now_s >= FIRST_FIX_S => Sky::full(&GpsGrade::Open.errors()),
            Noise::None => Sky::BLIND,
            // The epsilon keeps rounding from turning a return after 1.5 s into 1.6 s.
            Noise::Real if self.lost_until_s.is_some_and(|end| now_s - end < REACQUISITION_S - 1e-6) => {
                Sky { sats: SEARCH_SATS, ..Sky::BLIND }
            }
            Noise::Real => {
                let sky = Sky::acquiring(now_s / self.acquisition_scale, &grade);
                let sats = if grade.is_urban { self.multipath.sats_in_view(sky.sats) } else { sky.sats };
                Sky { sats, ..sky }
            }
        }
    }
}

fn wander_process(grade: GpsGrade, rate_hz: u8) -> GaussMarkov {
    let errors = grade.errors();
    GaussMarkov::stationary(errors.wander_sigma_m, errors.wander_tau_s, 1.0 / f64::from(rate_hz))
}
