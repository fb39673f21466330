//! The throttle stick under a hold after an aborted mission.

use crate::autopilot::Params;
use crate::firmware::modes::AfterAbort;

/// The stick is at a position from before the abort, so it has no effect until the pilot moves it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) enum ThrottleTakeover {
    /// No hold is on after an aborted mission. The stick has its usual effect.
    #[default]
    Flown,
    /// The stick has been at this pulse since the mission was aborted, µs.
    Standing(f64),
    Moved,
}

impl ThrottleTakeover {
    /// Returns the pulse (µs) that counts in this update; `None` until the stick has moved by more than
    /// `ap_throttle_deadband` since the mission was aborted.
    pub(super) fn update(&mut self, after_abort: AfterAbort, stick_us: f64, params: &Params) -> Option<f64> {
        *self = match *self {
            _ if after_abort == AfterAbort::Nothing => Self::Flown,
            Self::Flown => Self::Standing(stick_us),
            Self::Standing(standing_us)
                if (stick_us - standing_us).abs() > f64::from(params.throttle_deadband) =>
            {
                Self::Moved
            }
            same => same,
        };
        (!matches!(self, Self::Standing(_))).then_some(stick_us)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stick_counts_again_when_it_was_moved() {
        let params = Params::default();
        let mut stick = ThrottleTakeover::default();
        assert_eq!(stick.update(AfterAbort::Nothing, 1300.0, &params), Some(1300.0));
        for pulse in [1500.0, 1550.0, 1450.0] {
            assert_eq!(stick.update(AfterAbort::Altitude, pulse, &params), None, "{pulse}");
        }
        for pulse in [1449.0, 1500.0] {
            assert_eq!(stick.update(AfterAbort::Altitude, pulse, &params), Some(pulse));
        }
        assert_eq!(stick.update(AfterAbort::Nothing, 1500.0, &params), Some(1500.0));
        assert_eq!(stick.update(AfterAbort::Descent, 1500.0, &params), None, "given up again");
    }
}
