//! The state of the GPS receiver.

use crate::signals::{GpsSample, SimTime};

/// The number of repetitions of a solution that mean a frozen receiver.
const FROZEN_SAMPLES: u8 = 3;
/// The speed (m/s) up to which solutions may repeat, because the craft is at rest.
const STANDING_MPS: f64 = 0.02;

/// The values of a good solution: dilution of precision, accuracies of position (m) and speed (m/s).
const GOOD_HDOP: f64 = 0.8;
const GOOD_HORIZONTAL_M: f64 = 1.0;
const GOOD_VERTICAL_M: f64 = 1.6;
const GOOD_SPEED_MPS: f64 = 0.05;
/// The largest factor by which a solution counts as worse than a good one.
const WORST: f64 = 20.0;

/// The errors that a solution reports, as multiples of those of a good solution, 1…20.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dilution {
    pub horizontal: f64,
    pub vertical: f64,
    pub speed: f64,
}

impl Dilution {
    /// Uses the worse of dilution of precision and accuracy. Values that are not reported (0) do not count.
    pub(super) fn of(sample: &GpsSample) -> Self {
        let geometry = (sample.hdop / GOOD_HDOP).max(1.0);
        let worse = |reported: f64, good: f64| geometry.max(reported / good).min(WORST);
        Self {
            horizontal: worse(sample.horizontal_accuracy_m, GOOD_HORIZONTAL_M),
            vertical: worse(sample.vertical_accuracy_m, GOOD_VERTICAL_M),
            speed: worse(sample.speed_accuracy_mps, GOOD_SPEED_MPS),
        }
    }
}

/// The state of the GPS receiver.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GpsStatus {
    /// `true` while there is a fresh 3-D fix.
    pub fix: bool,
    /// The number of satellites in the newest message; 0 without messages.
    pub sats: u8,
    /// The horizontal dilution of precision; 0 = not reported.
    pub hdop: f64,
    /// The newest solution with a fix.
    pub solution: Option<GpsSample>,
    /// The number of messages so far.
    pub messages: u32,
    /// The time since the newest message, s.
    pub age_s: f64,
    /// `true` if the receiver repeats the same solution although the craft moves.
    pub frozen: bool,
}

/// Judges the messages of the receiver.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct GpsMonitor {
    pub status: GpsStatus,
    has_fix: bool,
    repeats: u8,
    arrived: SimTime,
}

impl GpsMonitor {
    /// Takes a message. Returns it if it is a usable solution.
    pub(super) fn receive(&mut self, sample: GpsSample, now: SimTime) -> Option<GpsSample> {
        let is_sane = sample.vel_enu.iter().all(|v| v.is_finite()) && sample.position.is_on_globe();
        let usable = sample.fix && is_sane;
        self.arrived = now;
        let status = &mut self.status;
        status.messages = status.messages.wrapping_add(1);
        (status.sats, status.hdop) = (sample.sats, sample.hdop);
        if !usable {
            (self.has_fix, self.repeats) = (false, 0);
            return None;
        }
        let is_repeated = status.solution == Some(sample) && sample.vel_enu.norm() > STANDING_MPS;
        self.repeats = if is_repeated { self.repeats.saturating_add(1) } else { 0 };
        status.frozen = self.repeats >= FROZEN_SAMPLES;
        status.solution = Some(sample);
        self.has_fix = !status.frozen;
        // A repeated solution describes a past that was already processed.
        (!is_repeated).then_some(sample)
    }

    /// Updates age and fix.
    pub(super) fn update(&mut self, now: SimTime, timeout_s: f64) {
        let status = &mut self.status;
        status.age_s = now.seconds_since(self.arrived);
        if status.messages == 0 || status.age_s > timeout_s {
            (self.has_fix, status.sats) = (false, 0);
        }
        status.fix = self.has_fix;
        status.frozen &= status.sats > 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn solution(speed: f64) -> GpsSample {
        GpsSample { fix: true, sats: 12, vel_enu: Vector3::new(speed, 0.0, 0.0), ..GpsSample::default() }
    }

    fn at(seconds: f64) -> SimTime {
        SimTime::from_secs_f64(seconds)
    }

    #[test]
    fn silence_ends_the_fix() {
        let mut gps = GpsMonitor::default();
        gps.update(at(1.0), 0.3);
        assert!(!gps.status.fix);
        gps.receive(solution(1.0), at(1.0));
        gps.update(at(1.29), 0.3);
        assert!(gps.status.fix);
        gps.update(at(1.31), 0.3);
        assert!(!gps.status.fix);
        assert_eq!(gps.status.sats, 0);
    }

    #[test]
    fn a_frozen_receiver_has_no_fix_but_a_parked_one_does() {
        for (speed, fix) in [(3.0, false), (0.0, true)] {
            let mut gps = GpsMonitor::default();
            for tenth in 0..10 {
                gps.receive(solution(speed), at(f64::from(tenth) * 0.1));
            }
            gps.update(at(0.91), 0.3);
            assert_eq!(gps.status.fix, fix);
            assert_eq!(gps.status.frozen, !fix);
        }
    }

    #[test]
    fn a_solution_counts_by_what_it_reports() {
        let good = GpsSample { horizontal_accuracy_m: 0.5, hdop: 0.8, ..solution(0.0) };
        assert_eq!(Dilution::of(&good), Dilution { horizontal: 1.0, vertical: 1.0, speed: 1.0 });
        let poor = GpsSample { horizontal_accuracy_m: 6.0, speed_accuracy_mps: 0.3, hdop: 1.6, ..good };
        let dilution = Dilution::of(&poor);
        assert_eq!((dilution.horizontal, dilution.vertical), (6.0, 2.0));
        assert!((dilution.speed - 6.0).abs() < 1e-12);
        let absurd = GpsSample { hdop: 99.0, ..good };
        assert_eq!(Dilution::of(&absurd), Dilution { horizontal: 20.0, vertical: 20.0, speed: 20.0 });
    }

    #[test]
    fn nonsense_is_no_fix() {
        let mut gps = GpsMonitor::default();
        gps.receive(solution(f64::NAN), at(0.0));
        gps.update(at(0.0), 0.3);
        assert!(!gps.status.fix);
    }
}
