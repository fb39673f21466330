//! The rate loop.

use super::PidTerms;
use super::boost::GainBoost;
use super::derived::Derived;
use super::tuning::{DMax, RateTuning};
use crate::firmware::filter::{LowPassState, Pt1};

/// The index of yaw among the axes.
const YAW: usize = 2;
/// The setpoint change (°/s) at which the integral stops: for sticks, and for levelling, where the angle loop moves the
/// setpoint.
const RELAX_ACRO_DPS: f64 = 40.0;
const RELAX_LEVEL_DPS: f64 = 8.0;

/// The inputs of the rate loop in one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RateDemand {
    /// The setpoints, °/s.
    pub setpoint: [f64; 3],
    /// The filtered gyro rates, °/s.
    pub gyro: [f64; 3],
    /// `true` for each levelled axis, whose setpoint comes from the angle loop.
    pub levelled: [bool; 3],
    /// The stick deflection of each axis, 0…1.
    pub deflection: [f64; 3],
    /// TPA, the factor that reduces D (and P).
    pub tpa: f64,
    /// The rise of the gains in quick throttle changes.
    pub boost: GainBoost,
    pub integrate: bool,
}

/// The state of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Axis {
    integral: f64,
    last_setpoint: f64,
    slow_setpoint: Pt1,
    slow_gyro: Pt1,
    p_filter: Pt1,
    d_boost: Pt1,
}

/// The rate loop of three axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct RateLoop {
    axes: [Axis; 3],
    d_filters: [LowPassState; 2],
    last_d_input: [f64; 3],
    terms: PidTerms,
}

impl RateLoop {
    pub(super) fn clear_integrals(&mut self) {
        for axis in &mut self.axes {
            axis.integral = 0.0;
        }
    }

    /// Returns the terms of the last sums.
    pub(super) fn terms(&self) -> &PidTerms {
        &self.terms
    }

    /// Rotates the integrals against the turn of the craft (°/s), so that as a vector they keep their direction in the
    /// world. Yaw counts clockwise, the opposite of the axis that makes a right-handed system with roll and pitch.
    fn rotate_iterms(&mut self, gyro: &[f64; 3], dt: f64) {
        let turn = gyro.map(|rate| rate.to_radians() * dt);
        let [roll, pitch, yaw] = [0, 1, 2].map(|axis| self.axes[axis].integral);
        let change = [
            pitch * -turn[2] + yaw * turn[1],
            -yaw * turn[0] + roll * turn[2],
            -(roll * turn[1] - pitch * turn[0]),
        ];
        for (axis, change) in self.axes.iter_mut().zip(change) {
            if change.is_finite() {
                axis.integral += change;
            }
        }
    }

    /// Runs one step. Returns the sums in thousandths of the mixer's range, before their limits.
    pub(super) fn step(&mut self, demand: &RateDemand, tuning: &RateTuning, derived: &Derived) -> [f64; 3] {
        let mut sums = [0.0; 3];
        let rate_hz = 1.0 / derived.pid_dt;
        if tuning.iterm_rotation {
            self.rotate_iterms(&demand.gyro, derived.pid_dt);
        }
        let slopes = self.slopes(&demand.gyro, rate_hz, derived);
        for (index, (axis, sum)) in self.axes.iter_mut().zip(&mut sums).enumerate() {
            let gains = &tuning.gains[index];
            let (setpoint, gyro) = (demand.setpoint[index], demand.gyro[index]);
            let is_level = demand.levelled[index];
            let error = setpoint - gyro;
            let mut p = gains.p * error;
            if tuning.tpa_on_p {
                p *= demand.tpa;
            }
            if index == YAW {
                p = axis.p_filter.apply(p, derived.yaw_lowpass);
            } else {
                p *= demand.boost.p;
            }
            let relaxed = axis.relax(index, error, demand, is_level, tuning, derived);
            if demand.integrate {
                let limit = tuning.integral_limit[index];
                let grown = axis.integral + gains.i * demand.boost.i * relaxed * derived.pid_dt;
                axis.integral = grown.clamp(-limit, limit);
            } else {
                axis.integral = 0.0;
            }
            let setpoint_rate = (setpoint - axis.last_setpoint) * rate_hz;
            axis.last_setpoint = setpoint;
            let d = if gains.d == 0.0 && tuning.d_max.most[index] == 0.0 {
                0.0
            } else {
                let slope = slopes[index];
                let moved = slope.abs().max(tuning.d_max.setpoint_share * setpoint_rate.abs());
                -axis.d_gain(gains.d, index, moved, &tuning.d_max, derived) * slope * demand.tpa
            };
            let f = if is_level {
                0.0
            } else {
                gains.f * setpoint_rate * fade(demand.deflection[index], tuning.feedforward_transition)
            };
            let (p, d, f) =
                if demand.integrate || tuning.at_min_throttle { (p, d, f) } else { (0.0, 0.0, 0.0) };
            let raw = p + axis.integral + d + f;
            let terms = &mut self.terms;
            (terms.p[index], terms.i[index]) = (p, axis.integral);
            (terms.d[index], terms.f[index]) = (d, f);
            *sum = if raw.is_finite() { raw } else { 0.0 };
        }
        sums
    }

    /// Returns the slopes of the filtered gyro rates, °/s².
    #[inline]
    fn slopes(&mut self, gyro: &[f64; 3], rate_hz: f64, derived: &Derived) -> [f64; 3] {
        let [first, second] = &mut self.d_filters;
        let filtered = second.apply(&first.apply(gyro, &derived.d_lpf1), &derived.d_lpf2);
        let last = std::mem::replace(&mut self.last_d_input, filtered);
        std::array::from_fn(|axis| (filtered[axis] - last[axis]) * rate_hz)
    }
}

impl Axis {
    /// Returns the D gain between its base and its maximum, depending on the movement of the craft, °/s².
    fn d_gain(&mut self, base: f64, index: usize, moved: f64, d_max: &DMax, derived: &Derived) -> f64 {
        let most = d_max.most[index];
        if d_max.readiness <= 0.0 || most <= base {
            return base;
        }
        let share = self.d_boost.apply((d_max.readiness * moved).min(1.0), derived.d_boost);
        base + (most - base) * share
    }

    /// Returns the error that the integral uses. A fast-moving setpoint must not wind it up.
    fn relax(
        &mut self,
        index: usize,
        error: f64,
        demand: &RateDemand,
        is_level: bool,
        tuning: &RateTuning,
        derived: &Derived,
    ) -> f64 {
        let relax = &tuning.relax;
        if !relax.axes[index] {
            return error;
        }
        let setpoint = demand.setpoint[index];
        let change = (setpoint - self.slow_setpoint.apply(setpoint, derived.relax)).abs();
        if relax.increments_only && self.integral * error < 0.0 {
            return error;
        }
        if relax.by_gyro {
            // Only the part of the setpoint outside the band about the slow gyro counts.
            let slow = self.slow_gyro.apply(demand.gyro[index], derived.relax);
            let (low, high) = (slow - change, slow + change);
            return setpoint - setpoint.clamp(low, high);
        }
        let threshold = if is_level { RELAX_LEVEL_DPS } else { RELAX_ACRO_DPS };
        error * (1.0 - change / threshold).max(0.0)
    }
}

/// Returns the feed-forward factor. It rises with the stick up to `transition`.
fn fade(deflection: f64, transition: f64) -> f64 {
    if transition > 0.0 { (deflection / transition).min(1.0) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::super::tuning::Tuning;
    use super::*;

    fn demand(setpoint: f64, gyro: f64) -> RateDemand {
        RateDemand {
            setpoint: [setpoint; 3],
            gyro: [gyro; 3],
            levelled: [false; 3],
            deflection: [1.0; 3],
            tpa: 1.0,
            boost: GainBoost::NONE,
            integrate: true,
        }
    }

    #[test]
    fn a_steady_error_gives_p_and_a_growing_i() {
        let tuning = Tuning::default();
        let derived = Derived::new(&tuning, 0.001);
        let mut rate_loop = RateLoop::default();
        let mut sums = [0.0; 3];
        for _ in 0..1000 {
            sums = rate_loop.step(&demand(0.0, -10.0), &tuning.rate, &derived);
        }
        let gains = &tuning.rate.gains[0];
        assert!((sums[0] - 10.0 * (gains.p + gains.i)).abs() < 0.5, "{sums:?}");
        for _ in 0..10_000 {
            sums = rate_loop.step(&demand(0.0, -10.0), &tuning.rate, &derived);
        }
        // The integral stops at 400.
        assert!((sums[0] - (10.0 * gains.p + 400.0)).abs() < 0.5, "{sums:?}");
        assert_eq!(sums[2], 400.0_f64.min(10.0 * tuning.rate.gains[2].p + 320.0));
    }

    #[test]
    fn the_integral_waits_while_the_setpoint_jumps() {
        let tuning = Tuning::default();
        let derived = Derived::new(&tuning, 0.001);
        let mut rate_loop = RateLoop::default();
        rate_loop.step(&demand(0.0, 0.0), &tuning.rate, &derived);
        rate_loop.step(&demand(300.0, 0.0), &tuning.rate, &derived);
        assert_eq!(rate_loop.axes[0].integral, 0.0);
        assert!(rate_loop.axes[YAW].integral > 0.0);
    }

    #[test]
    fn without_integration_only_the_other_terms_work() {
        let mut tuning = Tuning::default();
        let derived = Derived::new(&tuning, 0.001);
        let mut rate_loop = RateLoop::default();
        let idle = RateDemand { integrate: false, ..demand(0.0, -10.0) };
        for _ in 0..100 {
            rate_loop.step(&idle, &tuning.rate, &derived);
        }
        let sums = rate_loop.step(&idle, &tuning.rate, &derived);
        assert!((sums[0] - 10.0 * tuning.rate.gains[0].p).abs() < 0.5);
        tuning.rate.at_min_throttle = false;
        assert_eq!(rate_loop.step(&idle, &tuning.rate, &derived), [0.0; 3]);
    }

    #[test]
    fn d_rises_in_fast_moves_as_far_as_it_may() {
        // The D part for a gyro rate that accelerates at `slope` (°/s²).
        let d = |gain: i64, advance: i64, most: i64, slope: f64| {
            let mut settings = crate::firmware::settings::Settings::default();
            for (name, value) in [
                ("d_max_gain", gain),
                ("d_max_advance", advance),
                ("d_max_roll", most),
                ("p_roll", 0),
                ("i_roll", 0),
            ] {
                settings.set_number(name, value).unwrap();
            }
            let kind = crate::firmware::config::MixerKind::QuadX;
            let tuning = Tuning::from_settings(&settings, kind, &[]);
            let derived = Derived::new(&tuning, 0.001);
            let mut rate_loop = RateLoop::default();
            let mut sum = 0.0;
            for step in 0..200 {
                let gyro = slope * 0.001 * f64::from(step);
                sum = -rate_loop.step(&demand(0.0, gyro), &tuning.rate, &derived)[0];
            }
            sum / slope
        };
        let base = 30.0 * 0.000_529;
        assert!((d(0, 100, 60, 4000.0) / base - 1.0).abs() < 0.02, "no gain, no rise");
        assert!((d(50, 0, 20, 4000.0) / base - 1.0).abs() < 0.02, "below the base it is nothing");
        let by_gain = [0, 10, 30, 60].map(|gain| d(gain, 0, 60, 4000.0));
        assert!(by_gain.windows(2).all(|pair| pair[0] < pair[1]), "{by_gain:?}");
        assert!((by_gain[3] / base - 2.0).abs() < 0.02, "60 is twice 30: {by_gain:?}");
        let by_speed = [500.0, 2000.0, 4000.0].map(|slope| d(30, 0, 60, slope));
        assert!(by_speed.windows(2).all(|pair| pair[0] < pair[1]), "{by_speed:?}");
    }

    #[test]
    fn a_moving_setpoint_raises_d_by_the_advance() {
        let dynamic = |advance: f64| DMax { most: [1.0; 3], readiness: 1e-4, setpoint_share: advance };
        let sums = [0.0, 0.5, 2.0].map(|advance| {
            let mut tuning = Tuning::default();
            tuning.rate.d_max = dynamic(advance);
            let derived = Derived::new(&tuning, 0.001);
            let mut rate_loop = RateLoop::default();
            for step in 0..100 {
                let at = f64::from(step);
                rate_loop.step(&demand(4.0 * at, 0.5 * at), &tuning.rate, &derived);
            }
            // A gain of 0 returns the state.
            rate_loop.axes[0].d_boost.apply(0.0, 0.0)
        });
        assert!(sums.windows(2).all(|pair| pair[0] < pair[1]), "{sums:?}");
    }

    #[test]
    fn integrals_turn_with_the_craft() {
        let mut tuning = Tuning::default();
        let turned = |rotates: bool, gyro: [f64; 3], tuning: &mut Tuning| {
            tuning.rate.iterm_rotation = rotates;
            for gains in &mut tuning.rate.gains {
                gains.i = 0.0;
            }
            let derived = Derived::new(tuning, 0.001);
            let mut rate_loop = RateLoop::default();
            rate_loop.axes[0].integral = 100.0;
            for _ in 0..1000 {
                rate_loop.step(&RateDemand { gyro, ..demand(0.0, 0.0) }, &tuning.rate, &derived);
            }
            rate_loop.axes.map(|axis| axis.integral.round())
        };
        // A quarter turn clockwise: the integral that rolled the craft right now pushes its nose down.
        let quarter = [0.0, 0.0, 90.0];
        assert_eq!(turned(false, quarter, &mut tuning), [100.0, 0.0, 0.0]);
        let [roll, pitch, yaw] = turned(true, quarter, &mut tuning);
        assert_eq!((roll.abs(), pitch, yaw), (0.0, 100.0, 0.0));
        let [roll, pitch, yaw] = turned(true, [0.0, 90.0, 0.0], &mut tuning);
        assert_eq!((roll.abs(), pitch, yaw), (0.0, 0.0, -100.0));
    }

    #[test]
    fn nonsense_never_reaches_the_motors() {
        let tuning = Tuning::default();
        let derived = Derived::new(&tuning, 0.001);
        let sums = RateLoop::default().step(&demand(0.0, f64::NAN), &tuning.rate, &derived);
        assert!(sums.iter().all(|sum| sum.is_finite()));
    }

    #[test]
    fn with_inc_an_integral_may_shrink_but_not_grow_while_the_setpoint_jumps() {
        // The integral of roll, 100 before a jump of the setpoint to 300 °/s and one step in which the craft turns
        // at `gyro`.
        let after_jump = |increments_only: bool, gyro: f64| {
            let mut tuning = Tuning::default();
            tuning.rate.relax.increments_only = increments_only;
            let derived = Derived::new(&tuning, 0.001);
            let mut rate_loop = RateLoop::default();
            rate_loop.step(&demand(0.0, 0.0), &tuning.rate, &derived);
            rate_loop.axes[0].integral = 100.0;
            rate_loop.step(&demand(300.0, gyro), &tuning.rate, &derived);
            rate_loop.axes[0].integral
        };
        assert!(after_jump(true, 600.0) < 99.0, "the integral of a craft that turns too fast shrinks");
        assert_eq!(after_jump(true, 0.0), 100.0, "the integral of a craft that lags does not grow");
        assert_eq!(after_jump(false, 600.0), 100.0, "without INC it waits in both directions");
    }

    #[test]
    fn tpa_weakens_d() {
        // The answer to a craft that turns ever faster, without P and I.
        let damping = |tpa: f64, tpa_on_p: bool| {
            let mut tuning = Tuning::default();
            tuning.rate.tpa_on_p = tpa_on_p;
            for gains in &mut tuning.rate.gains {
                (gains.p, gains.i) = (0.0, 0.0);
            }
            let derived = Derived::new(&tuning, 0.001);
            let mut rate_loop = RateLoop::default();
            let mut sum = 0.0;
            for step in 0..100 {
                let turning = RateDemand { tpa, ..demand(0.0, f64::from(step)) };
                sum = rate_loop.step(&turning, &tuning.rate, &derived)[0];
            }
            sum
        };
        for tpa_on_p in [false, true] {
            let full = damping(1.0, tpa_on_p);
            assert!(full < -1.0, "D acts against the turn: {full}");
            assert!((damping(0.4, tpa_on_p) / full - 0.4).abs() < 0.01);
            assert_eq!(damping(0.0, tpa_on_p), 0.0);
        }
    }

    #[test]
    fn d_needs_a_base_or_a_maximum() {
        // The answer to a craft that turns ever faster, without P and I.
        let damping = |base: f64, most: f64| {
            let mut tuning = Tuning::default();
            tuning.rate.d_max = DMax { most: [most; 3], readiness: 1.0, setpoint_share: 0.0 };
            for gains in &mut tuning.rate.gains {
                (gains.p, gains.i, gains.d) = (0.0, 0.0, base);
            }
            let derived = Derived::new(&tuning, 0.001);
            let mut rate_loop = RateLoop::default();
            let steps =
                (0..100).map(|step| rate_loop.step(&demand(0.0, f64::from(step)), &tuning.rate, &derived));
            steps.last().unwrap_or_default()[0]
        };
        assert!(damping(0.01, 0.0) < -1.0, "without a maximum the base damps");
        assert!(damping(0.0, 0.01) < -1.0, "without a base D rises to its maximum");
        assert_eq!(damping(0.0, 0.0), 0.0);
    }

    #[test]
    fn feedforward_fades_in_with_the_stick_up_to_the_transition() {
        // The answer to a setpoint that has just moved, without P, I and D.
        let push = |deflection: f64, transition: f64| {
            let mut tuning = Tuning::default();
            tuning.rate.feedforward_transition = transition;
            tuning.rate.d_max.most = [0.0; 3];
            for gains in &mut tuning.rate.gains {
                (gains.p, gains.i, gains.d, gains.f) = (0.0, 0.0, 0.0, 0.01);
            }
            let derived = Derived::new(&tuning, 0.001);
            let moved = RateDemand { deflection: [deflection; 3], ..demand(10.0, 0.0) };
            RateLoop::default().step(&moved, &tuning.rate, &derived)[0]
        };
        // 10 °/s in a millisecond.
        for (deflection, transition, share) in [
            (0.0, 0.0, 1.0),
            (1.0, 0.0, 1.0),
            (0.0, 0.5, 0.0),
            (0.25, 0.5, 0.5),
            (0.5, 0.5, 1.0),
            (1.0, 0.5, 1.0),
        ] {
            let pushed = push(deflection, transition);
            assert!((pushed - 100.0 * share).abs() < 1e-9, "{deflection} of {transition}: {pushed}");
        }
    }
}
