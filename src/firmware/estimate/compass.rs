//! The check that the magnetometer and the GPS agree on the heading.

/// The disagreement above which the magnetometer is doubted, and below which it is trusted again, rad.
const DOUBTED: f64 = 20.0 * std::f64::consts::PI / 180.0;
const BELIEVED: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// The time for which either must last, s.
const PATIENCE_S: f64 = 5.0;

/// The outcome of a check that changed the state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CompassVerdict {
    /// The magnetometer is doubted from now on: the course is the heading.
    Doubted,
    /// The magnetometer is trusted again.
    Believed,
}

/// Watches the difference between the magnetometer and the course of the GPS.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct CompassCheck {
    /// The magnetic heading minus the heading by the course, rad.
    innovation: f64,
    doubted: bool,
    /// The time for which the disagreement has contradicted `doubted`, s.
    contrary_s: f64,
}

impl CompassCheck {
    /// Trusts the magnetometer again. Called at the start of a new flight.
    pub(super) fn reset(&mut self) {
        *self = Self::default();
    }

    /// Takes a reliable disagreement, `dt` seconds after the one before.
    pub(super) fn update(&mut self, innovation: f64, dt: f64) -> Option<CompassVerdict> {
        self.innovation = innovation;
        let is_contrary = if self.doubted { innovation.abs() < BELIEVED } else { innovation.abs() > DOUBTED };
        self.contrary_s = if is_contrary { self.contrary_s + dt } else { 0.0 };
        if self.contrary_s < PATIENCE_S {
            return None;
        }
        self.contrary_s = 0.0;
        self.doubted = !self.doubted;
        Some(if self.doubted { CompassVerdict::Doubted } else { CompassVerdict::Believed })
    }

    /// Returns `true` if the magnetometer may correct the heading: it is neither doubted nor suspected.
    pub(super) fn may_correct(&self) -> bool {
        !self.doubted && self.contrary_s == 0.0
    }

    /// Returns `true` if it is suspected but not yet doubted.
    pub(super) fn is_suspected(&self) -> bool {
        !self.doubted && self.contrary_s > 0.0
    }

    /// Returns the error of the magnetometer, rad, while it is doubted.
    pub(super) fn doubt(&self) -> Option<f64> {
        self.doubted.then_some(self.innovation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lasting_disagreement_is_a_doubt_and_a_short_one_is_not() {
        let mut check = CompassCheck::default();
        let mut verdicts = |innovation_deg: f64, seconds: u32| -> Vec<CompassVerdict> {
            (0..seconds * 10).filter_map(|_| check.update(innovation_deg.to_radians(), 0.1)).collect()
        };
        assert_eq!(verdicts(60.0, 4), []);
        assert_eq!(verdicts(5.0, 1), []);
        assert_eq!(verdicts(-60.0, 6), [CompassVerdict::Doubted]);
        assert_eq!(verdicts(15.0, 20), [], "not yet close enough");
        assert_eq!(verdicts(5.0, 20), [CompassVerdict::Believed]);
    }
}
