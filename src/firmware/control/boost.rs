//! Reactions to a quick throttle change: the motors lead it, and the rate-loop gains rise while it upsets the craft.
//!
//! A quick change is the part of the throttle that a first-order low-pass has not followed yet: throttle − slow
//! throttle.

use super::derived::Derived;
use super::tuning::BoostTuning;
use crate::firmware::filter::Pt1;

/// The scale of the rise of P relative to that of I.
const P_PER_I: f64 = 0.1;

/// Factors for the gains of the rate loop; 1 = unchanged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GainBoost {
    /// The factor for P, roll and pitch.
    pub p: f64,
    pub i: f64,
}

impl GainBoost {
    pub(super) const NONE: Self = Self { p: 1.0, i: 1.0 };
}

/// The low-passed throttle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct ThrottleBoost {
    slow_for_gains: Pt1,
    slow_for_motors: Pt1,
}

impl ThrottleBoost {
    /// Runs one step of the rate loop with the pilot's throttle (0…1). Returns the throttle with its lead and the
    /// factors for the gains.
    pub(super) fn step(
        &mut self,
        throttle: f64,
        tuning: &BoostTuning,
        derived: &Derived,
    ) -> (f64, GainBoost) {
        let punch = (throttle - self.slow_for_gains.apply(throttle, derived.anti_gravity)).abs();
        let lead = throttle - self.slow_for_motors.apply(throttle, derived.throttle_boost);
        let gains = GainBoost {
            p: 1.0 + P_PER_I * tuning.anti_gravity_p * punch,
            i: 1.0 + tuning.anti_gravity_i * punch,
        };
        ((throttle + tuning.throttle * lead).clamp(0.0, 1.0), gains)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tuning::Tuning;
    use super::*;
    use crate::firmware::config::MixerKind;
    use crate::firmware::settings::Settings;

    const DT: f64 = 0.001;

    /// Returns the greatest throttle and gains after a step from 30 to 60 %, and the throttle half a second later.
    fn punch(changes: &[(&str, i64)]) -> (f64, GainBoost, f64) {
        let mut settings = Settings::default();
        for (name, value) in changes {
            settings.set_number(name, *value).unwrap();
        }
        let tuning = Tuning::from_settings(&settings, MixerKind::QuadX, &[]);
        let derived = Derived::new(&tuning, DT);
        let mut boost = ThrottleBoost::default();
        for _ in 0..1000 {
            boost.step(0.3, &tuning.boost, &derived);
        }
        let (mut highest, mut most, mut last) = (0.0_f64, GainBoost::NONE, 0.0);
        for _ in 0..500 {
            let (throttle, gains) = boost.step(0.6, &tuning.boost, &derived);
            highest = highest.max(throttle);
            most = GainBoost { p: most.p.max(gains.p), i: most.i.max(gains.i) };
            last = throttle;
        }
        (highest, most, last)
    }

    #[test]
    fn more_throttle_boost_leads_further_and_ends_at_the_stick() {
        let reached = [0, 2, 5, 8].map(|gain| punch(&[("throttle_boost", gain)]));
        assert_eq!(reached[0].0, 0.6);
        assert!(reached.windows(2).all(|pair| pair[0].0 < pair[1].0), "{reached:?}");
        assert!(reached.iter().all(|(_, _, last)| (last - 0.6).abs() < 1e-3));
        assert_eq!(punch(&[("throttle_boost", 100)]).0, 1.0, "the motors have no more");
    }

    #[test]
    fn a_higher_cutoff_boosts_less() {
        let highest = [5, 15, 50].map(|hz| punch(&[("throttle_boost_cutoff", hz), ("throttle_boost", 10)]).0);
        assert!(highest.windows(2).all(|pair| pair[0] > pair[1]), "{highest:?}");
    }

    #[test]
    fn more_anti_gravity_raises_the_gains_further() {
        let i = [0, 40, 80, 250].map(|gain| punch(&[("anti_gravity_gain", gain)]).1.i);
        assert_eq!(i[0], 1.0);
        assert!(i.windows(2).all(|pair| pair[0] < pair[1]), "{i:?}");
        let p = [0, 50, 100, 250].map(|gain| punch(&[("anti_gravity_p_gain", gain)]).1.p);
        assert_eq!(p[0], 1.0);
        assert!(p.windows(2).all(|pair| pair[0] < pair[1]), "{p:?}");
        let slow = [50, 5, 2].map(|hz| punch(&[("anti_gravity_cutoff_hz", hz)]).1.i);
        assert!(slow.windows(2).all(|pair| pair[0] < pair[1]), "{slow:?}");
    }

    #[test]
    fn a_steady_throttle_leaves_everything() {
        let tuning = Tuning::default();
        let derived = Derived::new(&tuning, DT);
        let mut boost = ThrottleBoost::default();
        for _ in 0..3000 {
            boost.step(0.4, &tuning.boost, &derived);
        }
        let (throttle, gains) = boost.step(0.4, &tuning.boost, &derived);
        assert!(
            (throttle - 0.4).abs() < 1e-6 && (gains.i - 1.0).abs() < 1e-6 && (gains.p - 1.0).abs() < 1e-6
        );
    }
}
