//! Smoothing of the sticks: to a loop of 1000 Hz, an RC stream of 50 frames a second is a staircase.

use super::tuning::Tuning;
use crate::firmware::filter::Pt3;

/// The frame rate assumed before it is measured, and the range of plausible rates, Hz.
const ASSUMED_FRAME_HZ: f64 = 50.0;
const FRAME_HZ: std::ops::RangeInclusive<f64> = 10.0..=1000.0;
/// The lowest automatic cutoff, Hz.
const LOWEST_CUTOFF_HZ: f64 = 15.0;
/// The share of the newest interval in the mean interval.
const INTERVAL_SHARE: f64 = 0.1;
/// The relative change of the mean interval that updates the cutoff.
const INTERVAL_CHANGE: f64 = 0.1;

/// Smooths roll, pitch, yaw and throttle.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Smoothing {
    filters: [Pt3; 4],
    /// The gains and cutoffs of sticks and throttle.
    gains: [f64; 2],
    cutoffs_hz: [f64; 2],
    since_frame_s: f64,
    interval_s: f64,
    /// The interval that the gains were computed for.
    used_interval_s: f64,
    /// The values that the filters have reached, so that the same values leave them as they are.
    settled: Option<[f64; 4]>,
}

impl Smoothing {
    pub(super) fn new() -> Self {
        Self {
            filters: [Pt3::default(); 4],
            gains: [1.0; 2],
            cutoffs_hz: [0.0; 2],
            since_frame_s: 0.0,
            interval_s: 1.0 / ASSUMED_FRAME_HZ,
            used_interval_s: 0.0,
            settled: None,
        }
    }

    /// Returns the cutoffs of sticks and throttle in use, Hz; 0 while nothing is smoothed.
    pub(super) fn cutoffs_hz(&self) -> [f64; 2] {
        self.cutoffs_hz
    }

    /// Makes the next step compute the gains again.
    pub(super) fn invalidate(&mut self) {
        self.used_interval_s = 0.0;
        self.settled = None;
    }

    /// Runs one step. `values` are the setpoints of roll, pitch, yaw (°/s) and the throttle (0…1).
    pub(super) fn apply(&mut self, values: &[f64; 4], is_frame: bool, tuning: &Tuning, dt: f64) -> [f64; 4] {
        self.since_frame_s += dt;
        if is_frame {
            let hz = 1.0 / self.since_frame_s.max(1e-6);
            if FRAME_HZ.contains(&hz) {
                self.interval_s += INTERVAL_SHARE * (self.since_frame_s - self.interval_s);
            }
            self.since_frame_s = 0.0;
        }
        if !tuning.smoothing {
            self.cutoffs_hz = [0.0; 2];
            self.settled = None;
            for (filter, value) in self.filters.iter_mut().zip(values) {
                filter.reset(*value);
            }
            return *values;
        }
        if (self.interval_s - self.used_interval_s).abs() > INTERVAL_CHANGE * self.used_interval_s {
            self.used_interval_s = self.interval_s;
            self.settled = None;
            for which in 0..2 {
                let cutoff = cutoff_hz(
                    1.0 / self.interval_s,
                    tuning.smoothing_factor[which],
                    tuning.smoothing_cutoff_hz[which],
                );
                self.gains[which] = Pt3::gain(cutoff, dt);
                self.cutoffs_hz[which] = cutoff;
            }
        }
        if self.settled != Some(*values) {
            let before = self.filters;
            let [sticks, throttle] = self.gains;
            for (index, (filter, value)) in self.filters.iter_mut().zip(values).enumerate() {
                filter.apply(*value, if index < 3 { sticks } else { throttle });
            }
            self.settled = (self.filters == before).then_some(*values);
        }
        self.filters.map(|filter| filter.state())
    }
}

/// Returns the cutoff for a frame rate: the fixed one if set, otherwise by the automatic factor.
fn cutoff_hz(frame_hz: f64, factor: f64, fixed_hz: f64) -> f64 {
    if fixed_hz > 0.0 {
        return fixed_hz;
    }
    (frame_hz * 1.5 / (1.0 + factor / 10.0)).max(LOWEST_CUTOFF_HZ)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_factor_gives_three_eighths_of_the_frame_rate() {
        assert!((cutoff_hz(50.0, 30.0, 0.0) - 18.75).abs() < 1e-12);
        assert!((cutoff_hz(20.0, 30.0, 0.0) - 15.0).abs() < 1e-12);
        assert!((cutoff_hz(50.0, 30.0, 7.0) - 7.0).abs() < 1e-12);
    }

    #[test]
    fn the_cutoff_follows_the_frame_rate() {
        let tuning = Tuning::default();
        let mut smoothing = Smoothing::new();
        smoothing.apply(&[0.0; 4], false, &tuning, 0.001);
        let at_50 = smoothing.gains[0];
        for step in 0..2000 {
            smoothing.apply(&[0.0; 4], step % 4 == 0, &tuning, 0.001);
        }
        assert!(smoothing.gains[0] > 2.5 * at_50);
    }

    #[test]
    fn settled_filters_follow_a_new_value_as_others_do() {
        let tuning = Tuning::default();
        let mut settled = Smoothing::new();
        for _ in 0..10_000 {
            settled.apply(&[100.0, 0.0, 0.0, 0.5], false, &tuning, 0.001);
        }
        assert!(settled.settled.is_some());
        let mut other = Smoothing { settled: None, ..settled.clone() };
        for _ in 0..10 {
            let [at_rest, filtered] =
                [&mut settled, &mut other].map(|it| it.apply(&[100.0, 0.0, 0.0, 0.5], false, &tuning, 0.001));
            assert_eq!(at_rest, filtered);
            other.settled = None;
        }
        let [first, second] =
            [&mut settled, &mut other].map(|it| it.apply(&[90.0, 0.0, 0.0, 0.5], true, &tuning, 0.001));
        assert!(first == second && first[0] < 100.0);
    }

    #[test]
    fn a_step_is_smooth_and_complete() {
        let tuning = Tuning::default();
        let mut smoothing = Smoothing::new();
        let mut last = 0.0;
        for step in 0..100 {
            let [roll, ..] = smoothing.apply(&[100.0, 0.0, 0.0, 0.0], step % 20 == 0, &tuning, 0.001);
            assert!(roll >= last && roll - last < 10.0);
            last = roll;
        }
        assert!(last > 99.0);
    }
}
