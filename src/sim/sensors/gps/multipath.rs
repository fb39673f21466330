//! The effects of buildings on a receiver: masked satellites, and reflected signals that shift the position for a
//! while.

use nalgebra::Vector3;
use rand::RngExt;

use crate::math;
use crate::sim::random::{Stream, StreamRng, exponential};

/// The mean time between the beginnings of two steps, s.
const MEAN_SPACING_S: f64 = 40.0;
/// The size, m, and length, s, of a step, uniformly distributed.
const SIZE_M: std::ops::Range<f64> = 2.0..8.0;
const LENGTH_S: std::ops::Range<f64> = 3.0..15.0;
/// The maximum number of masked satellites, and the mean time after which their number changes, s.
const MAX_MASKED: u8 = 2;
/// The number of satellites that are high enough to be visible between walls.
const HIGH_SATS: u8 = 8;
const MASK_SPACING_S: f64 = 10.0;

/// Multipath and masking at the receiver.
#[derive(Debug, Clone)]
pub(super) struct Multipath {
    rng: StreamRng,
    /// The present step, ENU, m, and its remaining time, s.
    step_enu: Vector3<f64>,
    step_left_s: f64,
    next_step_s: f64,
    masked: u8,
    next_mask_s: f64,
}

impl Multipath {
    pub(super) fn new(seed: u64) -> Self {
        let mut rng = Stream::GpsMultipath.rng(seed);
        let next_step_s = wait(&mut rng, MEAN_SPACING_S);
        Self {
            masked: rng.random_range(0..=MAX_MASKED),
            next_mask_s: wait(&mut rng, MASK_SPACING_S),
            rng,
            step_enu: Vector3::zeros(),
            step_left_s: 0.0,
            next_step_s,
        }
    }

    /// Advances by `dt` seconds. A new step replaces one that is still active.
    pub(super) fn advance(&mut self, dt: f64) {
        self.step_left_s -= dt;
        self.next_step_s -= dt;
        self.next_mask_s -= dt;
        if self.next_step_s <= 0.0 {
            self.next_step_s += wait(&mut self.rng, MEAN_SPACING_S);
            let (north, east) = math::sin_cos(self.rng.random_range(0.0..std::f64::consts::TAU));
            self.step_enu = Vector3::new(east, north, 0.0) * self.rng.random_range(SIZE_M);
            self.step_left_s = self.rng.random_range(LENGTH_S);
        }
        if self.next_mask_s <= 0.0 {
            self.next_mask_s += wait(&mut self.rng, MASK_SPACING_S);
            self.masked = self.rng.random_range(0..=MAX_MASKED);
        }
    }

    /// Returns the shift of the position by reflected signals, ENU, m.
    pub(super) fn shift_enu(&self) -> Vector3<f64> {
        if self.step_left_s > 0.0 { self.step_enu } else { Vector3::zeros() }
    }

    /// Returns the number of satellites in view between the walls, out of those tracked under open sky.
    pub(super) fn sats_in_view(&self, tracked: u8) -> u8 {
        tracked.saturating_sub(self.masked).max(tracked.min(HIGH_SATS))
    }
}

/// Returns the time to the next event of a Poisson process with this mean spacing, s.
fn wait(rng: &mut StreamRng, mean_s: f64) -> f64 {
    mean_s * exponential(rng)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_come_every_forty_seconds_and_last_three_to_fifteen() {
        let mut multipath = Multipath::new(1);
        let (mut steps, mut lengths, mut sizes) = (0_u32, Vec::new(), Vec::new());
        let (mut last, mut length, mut counts) = (Vector3::zeros(), 0_u32, [0_u32; 3]);
        const TICKS: u32 = 4_000_000;
        for _ in 0..TICKS {
            multipath.advance(0.1);
            counts[usize::from(10 - multipath.sats_in_view(10))] += 1;
            let now = multipath.shift_enu();
            if now != last {
                if last.norm() > 0.0 && now.norm() == 0.0 {
                    lengths.push(f64::from(length) * 0.1);
                }
                if now.norm() > 0.0 {
                    steps += 1;
                    sizes.push(now.norm());
                    length = 0;
                }
                last = now;
            }
            length += 1;
        }
        let spacing = f64::from(TICKS) * 0.1 / f64::from(steps);
        assert!((spacing / MEAN_SPACING_S - 1.0).abs() < 0.05, "{spacing} s");
        assert!(sizes.iter().all(|size| SIZE_M.contains(size)));
        assert!(lengths.iter().all(|length| (2.9..=15.1).contains(length)), "{lengths:?}");
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        assert!((mean(&sizes) - 5.0).abs() < 0.1, "{}", mean(&sizes));
        // The next step cuts long steps short more often, and those do not count here.
        assert!((mean(&lengths) - 9.0).abs() < 0.6, "{}", mean(&lengths));
        assert!(counts.iter().all(|&count| (f64::from(count) * 3.0 / f64::from(TICKS) - 1.0).abs() < 0.1));
    }
}
