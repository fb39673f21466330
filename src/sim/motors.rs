//! Motors: a first-order lag from command to rotor speed, stepped with the rest of the craft by Runge–Kutta.
//!
//! The equation `Ω̇ = (target − Ω)/τ` is linear, so the four stages of the integrator reduce to constants that depend
//! on `h/τ` only. They are exactly the stages of RK4, so angular momentum (rotors + body) is conserved to rounding.

use super::airframe::{Airframe, ROTORS};

/// Number of stages of the integrator.
pub(super) const STAGES: usize = 4;

/// The lag over one step: the share of the gap to the target that is closed at each stage and at the end.
#[derive(Debug, Clone, Copy)]
struct Lag {
    closed: [f64; STAGES],
    closed_at_end: f64,
    /// 1/τ, 1/s.
    rate: f64,
}

impl Lag {
    fn new(tau_s: f64, h: f64) -> Self {
        let x = h / tau_s;
        let second = 0.5 * x;
        let third = 0.5 * x * (1.0 - second);
        let fourth = x * (1.0 - third);
        let closed = [0.0, second, third, fourth];
        let closed_at_end = x / 6.0 * (1.0 + 2.0 * (1.0 - second) + 2.0 * (1.0 - third) + (1.0 - fourth));
        Self { closed, closed_at_end, rate: 1.0 / tau_s }
    }
}

/// The lags of one airframe for one step size.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motors {
    up: Lag,
    down: Lag,
}

/// Rotor speeds (rad/s) and accelerations (rad/s²) at the stages of one step.
#[derive(Debug, Clone, Copy)]
pub(super) struct RotorSweep {
    pub speed: [[f64; ROTORS]; STAGES],
    pub acceleration: [[f64; ROTORS]; STAGES],
    pub end: [f64; ROTORS],
}

impl Motors {
    /// Returns the motors for steps of `h` seconds.
    pub(super) fn new(airframe: &Airframe, h: f64) -> Self {
        Self { up: Lag::new(airframe.motor_tau_up_s, h), down: Lag::new(airframe.motor_tau_down_s, h) }
    }

    /// Computes one step from the given rotor speeds towards the target speeds, rad/s.
    pub(super) fn sweep(&self, speed: &[f64; ROTORS], target: &[f64; ROTORS]) -> RotorSweep {
        let mut sweep =
            RotorSweep { speed: [*speed; STAGES], acceleration: [[0.0; ROTORS]; STAGES], end: *speed };
        for i in 0..ROTORS {
            let gap = target[i] - speed[i];
            let lag = if gap > 0.0 { &self.up } else { &self.down };
            for stage in 0..STAGES {
                sweep.speed[stage][i] += gap * lag.closed[stage];
                sweep.acceleration[stage][i] = gap * (1.0 - lag.closed[stage]) * lag.rate;
            }
            sweep.end[i] += gap * lag.closed_at_end;
        }
        sweep
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_of_command_is_an_exponential() {
        let airframe = Airframe::five_inch();
        let motors = Motors::new(&airframe, 0.001);
        let mut speed = [0.0, 1000.0, 500.0, 0.0];
        let target = [1000.0, 0.0, 500.0, 0.0];
        for _ in 0..30 {
            speed = motors.sweep(&speed, &target).end;
        }
        assert!((speed[0] - 1000.0 * (1.0 - (-30.0_f64 / 20.0).exp())).abs() < 1e-4);
        assert!((speed[1] - 1000.0 * (-30.0_f64 / 30.0).exp()).abs() < 1e-4);
        assert_eq!(speed[2..], [500.0, 0.0]);
    }
}
