//! Low-pass filters of the control loops. Coefficients are computed when a cutoff is set, not for each sample.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use crate::math;

/// The ratio of the cutoff of each stage to the cutoff of the whole, so that n equal stages together are 3 dB down.
const PT2_STAGE: f64 = 1.553_773_974;
const PT3_STAGE: f64 = 1.961_459_177;

/// Returns the gain of a first-order low-pass: ω·dt/(ω·dt + 1). A cutoff of 0 disables the filter (gain 1).
pub fn pt1_gain(cutoff_hz: f64, dt: f64) -> f64 {
    let turn = 2.0 * PI * cutoff_hz * dt;
    if turn > 0.0 { turn / (turn + 1.0) } else { 1.0 }
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pt1 {
    state: f64,
}

impl Pt1 {
    /// Filters one sample; `gain` is [`pt1_gain`].
    pub fn apply(&mut self, input: f64, gain: f64) -> f64 {
        self.state += gain * (input - self.state);
        self.state
    }
}

/// Three equal first-order low-passes in a row.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pt3 {
    stages: [f64; 3],
}

impl Pt3 {
    /// Returns the gain for a cutoff of the whole filter.
    pub fn gain(cutoff_hz: f64, dt: f64) -> f64 {
        pt1_gain(cutoff_hz * PT3_STAGE, dt)
    }

    pub fn state(&self) -> f64 {
        self.stages[2]
    }

    /// Starts again at `value`.
    pub fn reset(&mut self, value: f64) {
        self.stages = [value; 3];
    }

    /// Filters one sample; `gain` is [`Pt3::gain`].
    pub fn apply(&mut self, input: f64, gain: f64) -> f64 {
        let [a, b, c] = &mut self.stages;
        *a += gain * (input - *a);
        *b += gain * (*a - *b);
        *c += gain * (*b - *c);
        *c
    }
}

/// Two equal first-order low-passes in a row.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pt2 {
    stages: [f64; 2],
}

impl Pt2 {
    /// Returns the gain for a cutoff of the whole filter.
    pub fn gain(cutoff_hz: f64, dt: f64) -> f64 {
        pt1_gain(cutoff_hz * PT2_STAGE, dt)
    }

    /// Starts again at `value`.
    pub fn reset(&mut self, value: f64) {
        self.stages = [value; 2];
    }

    /// Filters one sample; `gain` is [`Pt2::gain`].
    pub fn apply(&mut self, input: f64, gain: f64) -> f64 {
        let [a, b] = &mut self.stages;
        *a += gain * (input - *a);
        *b += gain * (*a - *b);
        *b
    }
}

/// The shape of a low-pass. The discriminant is the value of the settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::FromRepr)]
#[repr(u8)]
pub enum LowPassKind {
    #[default]
    Pt1 = 0,
    /// Second order, Butterworth.
    Biquad = 1,
    Pt2 = 2,
    Pt3 = 3,
}

/// The coefficients of a low-pass of any shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LowPass {
    Off,
    /// One to three equal first-order stages with this gain.
    Stages {
        count: u8,
        gain: f64,
    },
    /// Second order: `b0`, `b1`, `b2`, `a1`, `a2`.
    Biquad([f64; 5]),
}

impl LowPass {
    /// Creates a low-pass of this shape; off for a cutoff of zero. The cutoff of a biquad is kept below the Nyquist
    /// frequency.
    pub fn new(kind: LowPassKind, cutoff_hz: f64, dt: f64) -> Self {
        if cutoff_hz <= 0.0 {
            return Self::Off;
        }
        match kind {
            LowPassKind::Pt1 => Self::Stages { count: 1, gain: pt1_gain(cutoff_hz, dt) },
            LowPassKind::Pt2 => Self::Stages { count: 2, gain: Pt2::gain(cutoff_hz, dt) },
            LowPassKind::Pt3 => Self::Stages { count: 3, gain: Pt3::gain(cutoff_hz, dt) },
            LowPassKind::Biquad => Self::butterworth(cutoff_hz.min(0.45 / dt), dt),
        }
    }

    /// Computes the bilinear transform of a second-order low-pass with Q = 1/√2.
    fn butterworth(cutoff_hz: f64, dt: f64) -> Self {
        let (sin, cos) = math::sin_cos(2.0 * PI * cutoff_hz * dt);
        let alpha = sin / (2.0 * FRAC_1_SQRT_2);
        let a0 = 1.0 + alpha;
        let b1 = (1.0 - cos) / a0;
        Self::Biquad([0.5 * b1, b1, 0.5 * b1, -2.0 * cos / a0, (1.0 - alpha) / a0])
    }
}

/// The state of a [`LowPass`] of roll, pitch and yaw, by stage. The axes are computed together, which is faster than one
/// by one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LowPassState {
    stages: [[f64; 3]; 3],
}

impl LowPassState {
    #[inline(always)]
    pub fn apply(&mut self, input: &[f64; 3], filter: &LowPass) -> [f64; 3] {
        let mut values = *input;
        match filter {
            LowPass::Off => {}
            LowPass::Stages { count, gain } => {
                for stage in self.stages.iter_mut().take(usize::from(*count)) {
                    for (stage, value) in stage.iter_mut().zip(&mut values) {
                        *stage += gain * (*value - *stage);
                        *value = *stage;
                    }
                }
            }
            // Transposed direct form II; the third slot is unused.
            LowPass::Biquad([b0, b1, b2, a1, a2]) => {
                let [first, second, _] = &mut self.stages;
                for ((first, second), value) in first.iter_mut().zip(second).zip(&mut values) {
                    let input = *value;
                    *value = b0 * input + *first;
                    *first = b1 * input - a1 * *value + *second;
                    *second = b2 * input - a2 * *value;
                }
            }
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the amplitude of the output for a sine of `hz` at 8 kHz.
    fn amplitude(filter: &LowPass, hz: f64) -> f64 {
        let (dt, mut state) = (1.0 / 8000.0, LowPassState::default());
        let answers =
            (0..16_000).map(|n| state.apply(&[(2.0 * PI * hz * f64::from(n) * dt).sin(); 3], filter)[0]);
        answers.skip(8000).fold(0.0, |greatest: f64, value| greatest.max(value.abs()))
    }

    #[test]
    fn every_shape_is_three_decibels_down_at_its_cutoff() {
        for kind in [LowPassKind::Pt1, LowPassKind::Biquad, LowPassKind::Pt2, LowPassKind::Pt3] {
            let filter = LowPass::new(kind, 50.0, 1.0 / 8000.0);
            let at_cutoff = amplitude(&filter, 50.0);
            assert!((at_cutoff - FRAC_1_SQRT_2).abs() < 0.03, "{kind:?} {at_cutoff}");
            assert!(amplitude(&filter, 2.0) > 0.99);
        }
    }

    #[test]
    fn off_and_out_of_range_cutoffs_are_stable() {
        assert_eq!(LowPass::new(LowPassKind::Biquad, 0.0, 0.001), LowPass::Off);
        let filter = LowPass::new(LowPassKind::Biquad, 1000.0, 0.0025);
        let mut state = LowPassState::default();
        let last = (0..1000).fold([0.0; 3], |_, _| state.apply(&[1.0; 3], &filter));
        assert!(last.iter().all(|value| (value - 1.0).abs() < 1e-6));
    }
}
