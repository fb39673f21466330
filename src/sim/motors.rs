//! Motors: a first-order lag from command to rotor speed.
//!
//! The equation `Ω̇ = (target − Ω)/τ` is solved exactly, so the speed at any time of a step follows from the gap to the
//! target by a factor that depends on `h/τ` only.

use super::airframe::{Airframe, ROTORS};
use crate::math;

/// The share of the gap to the target that a rotor closes in one step.
#[derive(Debug, Clone, Copy)]
struct Lag {
    /// The share at half the step, and at its end.
    at_half: f64,
    at_end: f64,
    /// The mean over the step of the share, and of its square.
    mean: f64,
    mean_square: f64,
    /// 1/τ, 1/s.
    rate: f64,
}

impl Lag {
    fn new(tau_s: f64, h: f64) -> Self {
        let x = h / tau_s;
        let at = |part: f64| 1.0 - math::exp(-x * part);
        let mean = 1.0 - at(1.0) / x;
        Self {
            at_half: at(0.5),
            at_end: at(1.0),
            mean,
            mean_square: 1.0 - 2.0 * at(1.0) / x + at(2.0) / (2.0 * x),
            rate: 1.0 / tau_s,
        }
    }
}

/// The lags of one airframe for one step size.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motors {
    up: Lag,
    down: Lag,
}

/// The rotors in one step. All speeds are in rad/s.
#[derive(Debug, Clone, Copy)]
pub(super) struct RotorStep<'a> {
    lags: [&'a Lag; ROTORS],
    start: [f64; ROTORS],
    gap: [f64; ROTORS],
}

impl Motors {
    /// Returns the motors for steps of `h` seconds.
    pub(super) fn new(airframe: &Airframe, h: f64) -> Self {
        Self { up: Lag::new(airframe.motor_tau_up_s, h), down: Lag::new(airframe.motor_tau_down_s, h) }
    }

    /// Returns the step from the given rotor speeds towards the target speeds, rad/s.
    #[inline]
    pub(super) fn step(&self, start: &[f64; ROTORS], target: &[f64; ROTORS]) -> RotorStep<'_> {
        let gap: [f64; ROTORS] = std::array::from_fn(|i| target[i] - start[i]);
        RotorStep { lags: gap.map(|gap| if gap > 0.0 { &self.up } else { &self.down }), start: *start, gap }
    }
}

impl RotorStep<'_> {
    /// Returns the speeds at half the step.
    #[inline]
    pub(super) fn at_half(&self) -> [f64; ROTORS] {
        self.after(self.by_rotor(|lag| lag.at_half))
    }

    /// Returns the speeds at the end of the step.
    #[inline]
    pub(super) fn at_end(&self) -> [f64; ROTORS] {
        self.after(self.by_rotor(|lag| lag.at_end))
    }

    /// Returns the means over the step of the squares of the speeds.
    #[inline]
    pub(super) fn mean_squares(&self) -> [f64; ROTORS] {
        let (mean, square) = (self.by_rotor(|lag| lag.mean), self.by_rotor(|lag| lag.mean_square));
        std::array::from_fn(|i| {
            let (start, gap) = (self.start[i], self.gap[i]);
            start * (start + 2.0 * gap * mean[i]) + gap * gap * square[i]
        })
    }

    /// Returns the accelerations at the start and at the end of the step, rad/s².
    #[inline]
    pub(super) fn accelerations(&self) -> [[f64; ROTORS]; 2] {
        let (rate, closed) = (self.by_rotor(|lag| lag.rate), self.by_rotor(|lag| lag.at_end));
        let at_start: [f64; ROTORS] = std::array::from_fn(|i| self.gap[i] * rate[i]);
        [at_start, std::array::from_fn(|i| at_start[i] * (1.0 - closed[i]))]
    }

    #[inline]
    fn after(&self, closed: [f64; ROTORS]) -> [f64; ROTORS] {
        std::array::from_fn(|i| self.start[i] + self.gap[i] * closed[i])
    }

    /// Returns a number of each rotor's lag.
    #[inline]
    fn by_rotor(&self, number: impl Fn(&Lag) -> f64) -> [f64; ROTORS] {
        self.lags.map(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The speeds of rotors that speed up, slow down, and stay as they are, and their targets.
    const START: [f64; ROTORS] = [0.0, 1000.0, 500.0, 0.0];
    const TARGET: [f64; ROTORS] = [1000.0, 0.0, 500.0, 0.0];

    /// Returns the motors of a five-inch craft with steps of `h` seconds.
    fn motors(h: f64) -> Motors {
        Motors::new(&Airframe::five_inch(), h)
    }

    #[test]
    fn a_step_of_command_is_an_exponential() {
        let h = 0.03;
        for speed in
            [motors(h).step(&START, &TARGET).at_end(), motors(2.0 * h).step(&START, &TARGET).at_half()]
        {
            assert!((speed[0] - 1000.0 * (1.0 - (-h / 0.020_f64).exp())).abs() < 1e-9);
            assert!((speed[1] - 1000.0 * (-h / 0.030_f64).exp()).abs() < 1e-9);
            assert_eq!(speed[2..], [500.0, 0.0]);
        }
    }

    #[test]
    fn means_and_accelerations_are_those_of_the_exponential() {
        const PARTS: u32 = 10_000;
        let h = 0.004;
        let whole = motors(h);
        let step = whole.step(&START, &TARGET);
        let means = step.mean_squares();
        let [start, end] = step.accelerations();
        for rotor in 0..ROTORS {
            let at = |seconds: f64| motors(seconds).step(&START, &TARGET).at_end()[rotor];
            let middles = (0..PARTS).map(|part| (f64::from(part) + 0.5) * h / f64::from(PARTS));
            let mean = middles.map(|seconds| at(seconds) * at(seconds)).sum::<f64>() / f64::from(PARTS);
            assert!(
                (means[rotor] - mean).abs() <= 1e-6 * mean,
                "{rotor}: {} instead of {mean}",
                means[rotor]
            );
            let slope = |from: f64, to: f64| (at(to) - at(from)) / (to - from);
            assert!((start[rotor] - slope(1e-9, 2e-6)).abs() <= 1e-3 * start[rotor].abs());
            assert!((end[rotor] - slope(h - 1e-6, h + 1e-6)).abs() <= 1e-3 * end[rotor].abs());
        }
    }
}
