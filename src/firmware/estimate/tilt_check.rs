//! The check that gyro and accelerometer agree on the tilt, with the accelerations that the GPS shows.

/// The error of the tilt above which the gyro is doubted, and below which it is trusted again, rad.
const DOUBTED: f64 = 9.0 * std::f64::consts::PI / 180.0;
const BELIEVED: f64 = 3.0 * std::f64::consts::PI / 180.0;
/// The time for which they must agree again, s.
const QUIET_S: f64 = 2.0;

/// Watches the error of the estimated tilt.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct TiltCheck {
    /// The error at which the doubt began, rad.
    doubt: Option<f64>,
    /// The time for which the two have agreed, s.
    quiet_s: f64,
}

impl TiltCheck {
    /// Takes the error of the tilt that the accelerations show, rad, `dt` seconds after the one before.
    pub(super) fn update(&mut self, error: f64, dt: f64) {
        if error > DOUBTED {
            self.doubt.get_or_insert(error);
        }
        self.quiet_s = if error < BELIEVED { self.quiet_s + dt } else { 0.0 };
        if self.quiet_s >= QUIET_S {
            self.doubt = None;
        }
    }

    /// Returns the error at which the doubt began, rad, while it lasts.
    pub(super) fn doubt(&self) -> Option<f64> {
        self.doubt
    }
}

/// Returns the factor by which the tilt follows a missing acceleration of this size faster, m/s². Beyond the size that wind,
/// noise and a usual gyro offset leave, a gyro has stepped, and the craft falls before the usual correction has found it.
pub(super) fn urgency(missing: f64) -> f64 {
    1.0 + (missing - 1.0).clamp(0.0, 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_error_is_a_doubt_until_the_two_agree_for_a_while() {
        let mut check = TiltCheck::default();
        let mut after = |error_deg: f64, seconds: f64| {
            (0..(seconds * 100.0) as u32).for_each(|_| check.update(error_deg.to_radians(), 0.01));
            check.doubt().map(|doubt| doubt.to_degrees().round())
        };
        assert_eq!(after(8.0, 60.0), None);
        assert_eq!(after(16.0, 0.1), Some(16.0));
        assert_eq!(after(8.0, 10.0), Some(16.0));
        assert_eq!(after(2.0, 1.9), Some(16.0));
        assert_eq!(after(2.0, 0.2), None);
    }
}
