//! Checks of bounds. All of them run before a test fails.

use std::fmt::Write as _;

/// A collection of the bounds that were not met.
#[derive(Debug, Default)]
pub(crate) struct Checks {
    broken: String,
    measured: String,
}

impl Checks {
    pub(crate) fn within(&mut self, what: &str, value: f64, low: f64, high: f64) {
        let _ = writeln!(self.measured, "  {what}: {value:.3} ({low:.3} … {high:.3})");
        if !(low..=high).contains(&value) {
            let _ = writeln!(self.broken, "  {what}: {value:.3}, allowed {low:.3} … {high:.3}");
        }
    }

    /// The greatest of no values is minus infinity. It breaks the bound.
    pub(crate) fn at_most(&mut self, what: &str, value: f64, high: f64) {
        self.within(what, value, f64::MIN, high);
    }

    pub(crate) fn holds(&mut self, what: &str, ok: bool) {
        if !ok {
            let _ = writeln!(self.broken, "  {what}");
        }
    }

    pub(crate) fn same<T: PartialEq + std::fmt::Debug>(&mut self, what: &str, got: T, expected: T) {
        if got != expected {
            let _ = writeln!(self.broken, "  {what}: {got:?}, expected {expected:?}");
        }
    }

    /// Returns the broken bounds. [`assert_met`] fails the test with them after all flights.
    pub(crate) fn verdict(self, flight: &str, story: &str) -> Option<String> {
        if std::env::var_os("SHOW_FLIGHTS").is_some() {
            println!("{flight}\n{}", self.measured);
        }
        (!self.broken.is_empty()).then(|| format!("{flight}\n{}{story}", self.broken))
    }
}

/// Fails with all broken bounds.
#[track_caller]
pub(crate) fn assert_met(verdicts: impl IntoIterator<Item = Option<String>>) {
    let broken: Vec<String> = verdicts.into_iter().flatten().collect();
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
}

/// Returns the greatest of some numbers. A NaN counts as greatest, so that it breaks a bound.
pub(crate) fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, |a, b| if b.is_nan() || b > a { b } else { a })
}

/// Returns the mean of some numbers.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}
