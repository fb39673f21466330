//! A part of a series, thinned out: the least and the greatest value of each step.

use crate::signals::SimTime;

/// A series in equal steps of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    first: SimTime,
    step_us: f64,
    /// The least and the greatest value of each step, if there is one.
    steps: Vec<Option<(f64, f64)>>,
}

impl Curve {
    /// Returns a curve from `first` to `last`. Each step has its least and its greatest value, if it has any.
    pub fn new(first: SimTime, last: SimTime, steps: Vec<Option<(f64, f64)>>) -> Self {
        let step_us = last.0.saturating_sub(first.0) as f64 / steps.len().max(1) as f64;
        Self { first, step_us: step_us.max(1.0), steps }
    }

    /// Returns the steps that overlap a time, each with its middle, s. A step without a value is `None`.
    pub fn between(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = (f64, Option<(f64, f64)>)> + '_ {
        let (first_s, step_s) = (self.first.as_secs_f64(), self.step_us / 1e6);
        // A negative number becomes zero.
        let from = ((from_s - first_s) / step_s).floor().max(0.0) as usize;
        let to = ((to_s - first_s) / step_s).ceil().max(0.0) as usize;
        let steps = self.steps.iter().enumerate().skip(from).take(to.saturating_sub(from));
        steps.map(move |(at, extent)| (first_s + (at as f64 + 0.5) * step_s, *extent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve() -> Curve {
        let steps = (0..10).map(|step| (step != 4).then_some((f64::from(step), f64::from(step) + 0.5)));
        Curve::new(SimTime(1_000_000), SimTime(1_100_000), steps.collect())
    }

    #[test]
    fn a_step_has_its_time_and_its_values() {
        let steps: Vec<_> = curve().between(0.0, 10.0).collect();
        assert_eq!(steps.len(), 10);
        let (middle_s, extent) = steps[3];
        assert!((middle_s - 1.035).abs() < 1e-9, "{middle_s}");
        assert_eq!((extent, steps[4].1), (Some((3.0, 3.5)), None));
    }

    #[test]
    fn only_the_steps_of_the_window_are_returned() {
        let times: Vec<_> =
            curve().between(1.031, 1.049).map(|(time_s, _)| (time_s * 1000.0).round()).collect();
        assert_eq!(times, [1035.0, 1045.0]);
        assert_eq!(curve().between(-5.0, 0.5).count(), 0);
        assert_eq!(curve().between(3.0, 2.0).count(), 0);
        assert_eq!(Curve::new(SimTime(5), SimTime(5), Vec::new()).between(0.0, 9.0).count(), 0);
    }
}
