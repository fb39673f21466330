//! Turns PID sums and throttle into motor commands.
//!
//! Quad X seen from above, nose up the page. The table shows the turn that more thrust of a motor causes.
//!
//! ```text
//!   4 clockwise          2 anticlockwise         motor    roll right  nose down  clockwise
//!       ╲    front    ╱                          1        −           +          −
//!         ╲         ╱                            2        −           −          +
//!           ╲     ╱                              3        +           +          +
//!           ╱     ╲                              4        +           −          −
//!         ╱         ╲
//!       ╱             ╲                          A propeller turns the craft against its own direction.
//!   3 anticlockwise      1 clockwise
//! ```

use super::tuning::MixerTuning;
use crate::math;
use crate::signals::{MotorCommand, PerMotor};

/// The zero of a motor command, µs, and its range.
const COMMAND_ZERO_US: f64 = 1000.0;
const COMMAND_RANGE_US: f64 = 1000.0;

/// The inputs of the mixer in one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MixDemand {
    /// The PID sums of roll, pitch, yaw (clockwise positive), thousandths.
    pub sums: [f64; 3],
    /// The throttle, 0…1.
    pub throttle: f64,
    /// Keeps full authority at any throttle.
    pub airmode: bool,
    /// Allows the motors to stop: the lowest pulse is that of a stopped motor.
    pub may_stop: bool,
}

/// Returns the pulses of the running motors, µs.
pub(super) fn mix(demand: &MixDemand, tuning: &MixerTuning) -> PerMotor {
    let [roll, pitch, yaw] = demand.sums.map(|sum| sum / 1000.0);
    let yaw = if tuning.yaw_reversed { -yaw } else { yaw };
    let mut mixes = tuning.rows.map(|row| roll * row.roll + pitch * row.pitch_down + yaw * row.yaw);
    let (mut low, mut high) = bounds(&mixes);
    let range = high - low;
    let mut scale = if range > 1.0 { 1.0 / range } else { 1.0 };
    if !demand.airmode && demand.throttle < 0.5 {
        scale *= 0.5 + demand.throttle;
    }
    for mix in &mut mixes {
        *mix *= scale;
    }
    (low, high) = (low * scale, high * scale);
    // −low ≤ 1 − high, because the scaled range is at most 1. `max` guards against rounding errors.
    let throttle = before_boost(demand.throttle, tuning.thrust_linear).clamp(-low, (1.0 - high).max(-low));
    let ceiling = tuning.stop_us + (tuning.max_us - tuning.stop_us) * tuning.output_limit;
    let idle = tuning.idle_us.min(ceiling);
    let floor = if demand.may_stop { tuning.stop_us } else { idle };
    std::array::from_fn(|motor| {
        let share = boosted(mixes[motor] + throttle * tuning.rows[motor].throttle, tuning.thrust_linear);
        let output = idle + (ceiling - idle) * share;
        output.clamp(floor, ceiling)
    })
}

/// Returns the output (0…1) for a more linear thrust. Propellers give little thrust at low outputs, so these are raised
/// by k·x·(1 − x)².
fn boosted(output: f64, k: f64) -> f64 {
    if k <= 0.0 {
        return output;
    }
    let output = output.clamp(0.0, 1.0);
    output * (1.0 + k * math::powi(1.0 - output, 2))
}

/// Returns the throttle whose boosted output is this one, so that the throttle stick feels unchanged. The iteration
/// approaches the fixed point from above; a few rounds come within a hundredth.
fn before_boost(throttle: f64, k: f64) -> f64 {
    const ROUNDS: usize = 12;
    if k <= 0.0 {
        return throttle;
    }
    (0..ROUNDS)
        .fold(throttle, |before, _| 0.5 * (before + throttle / (1.0 + k * math::powi(1.0 - before, 2))))
}

/// Converts pulses to a motor command.
pub(super) fn command(pulses_us: &PerMotor) -> MotorCommand {
    MotorCommand(pulses_us.map(|pulse| ((pulse - COMMAND_ZERO_US) / COMMAND_RANGE_US).clamp(0.0, 1.0)))
}

fn bounds(mixes: &PerMotor) -> (f64, f64) {
    mixes.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &mix| (low.min(mix), high.max(mix)))
}

#[cfg(test)]
mod tests {
    use super::super::tuning::Tuning;
    use super::*;
    use proptest::prelude::*;

    fn demand(sums: [f64; 3], throttle: f64, airmode: bool) -> MixDemand {
        MixDemand { sums, throttle, airmode, may_stop: false }
    }

    fn quad() -> MixerTuning {
        Tuning::default().mixer
    }

    #[test]
    fn each_axis_raises_its_motors() {
        let rising =
            |sums| mix(&demand(sums, 0.5, true), &quad()).map(|pulse| pulse > 1055.0 + 945.0 * 0.5 + 1.0);
        assert_eq!(rising([100.0, 0.0, 0.0]), [false, false, true, true]);
        assert_eq!(rising([0.0, 100.0, 0.0]), [true, false, true, false]);
        // Clockwise: the anticlockwise propellers, 2 and 3, turn faster.
        assert_eq!(rising([0.0, 0.0, 100.0]), [false, true, true, false]);
    }

    #[test]
    fn airmode_lifts_the_throttle_to_keep_authority() {
        let with = mix(&demand([200.0, 0.0, 0.0], 0.0, true), &quad());
        assert!((with[2] - with[0] - 945.0 * 0.4).abs() < 1e-9);
        assert_eq!(with[0], 1055.0);
        let without = mix(&demand([200.0, 0.0, 0.0], 0.0, false), &quad());
        assert!((without[2] - without[0] - 945.0 * 0.2).abs() < 1e-9);
    }

    #[test]
    fn the_output_limit_scales_the_range() {
        let limited = MixerTuning { output_limit: 0.5, ..quad() };
        assert_eq!(mix(&demand([0.0; 3], 1.0, true), &limited), [1500.0; 4]);
        assert_eq!(mix(&demand([0.0; 3], 0.0, true), &limited), [1055.0; 4]);
    }

    #[test]
    fn linear_thrust_keeps_the_hover_and_steers_harder_at_low_throttle() {
        let outputs = |k: f64, throttle: f64, roll: f64| {
            mix(&demand([roll, 0.0, 0.0], throttle, true), &MixerTuning { thrust_linear: k, ..quad() })
        };
        for k in [0.2, 0.5, 1.5] {
            for throttle in [0.0, 0.1, 0.3, 0.5, 0.9, 1.0] {
                let [plain, linear] = [outputs(0.0, throttle, 0.0)[0], outputs(k, throttle, 0.0)[0]];
                assert!((plain - linear).abs() < 15.0, "{k} {throttle}: {plain} {linear}");
            }
        }
        let authority = [0.0, 0.2, 0.5, 1.5].map(|k| {
            let pulses = outputs(k, 0.2, 50.0);
            pulses[2] - pulses[0]
        });
        assert!(authority.windows(2).all(|pair| pair[0] < pair[1]), "{authority:?}");
        let rising: Vec<f64> = (0..=20).map(|at| boosted(f64::from(at) / 20.0, 1.5)).collect();
        assert!(rising.windows(2).all(|pair| pair[0] < pair[1]), "{rising:?}");
    }

    #[test]
    fn reversed_propellers_get_the_opposite_yaw() {
        let reversed = MixerTuning { yaw_reversed: true, ..quad() };
        let yaw = |sum, tuning: &MixerTuning| mix(&demand([0.0, 0.0, sum], 0.5, true), tuning);
        assert_eq!(yaw(100.0, &reversed), yaw(-100.0, &quad()));
    }

    proptest! {
        #[test]
        fn outputs_stay_in_range_and_keep_the_differences(
            sums in prop::array::uniform3(-1000.0..1000.0), throttle in 0.0..1.0, airmode: bool
        ) {
            let pulses = mix(&demand(sums, throttle, airmode), &quad());
            for pulse in pulses {
                prop_assert!((1055.0..=2000.0).contains(&pulse));
            }
            // Roll, pitch and yaw keep their proportions: only the common part is clipped.
            let part = |shares: PerMotor| (0..4).map(|m| pulses[m] * shares[m]).sum::<f64>();
            let roll = part([-1.0, -1.0, 1.0, 1.0]);
            let pitch = part([1.0, -1.0, 1.0, -1.0]);
            prop_assert!((roll * sums[1] - pitch * sums[0]).abs() < 1e-4 * (1.0 + sums[0].abs() + sums[1].abs()));
        }
    }
}
