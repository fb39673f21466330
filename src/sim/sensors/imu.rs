//! Gyro and accelerometer, read with every step.
//!
//! The errors are those of an ordinary MEMS part: white noise by density, turn-on bias, and a bias that wanders as a
//! Gauss–Markov process. Samples are limited and rounded to the converter's steps. Vibration adds to the
//! accelerometer: white noise with the square of the rotor speed, and an acceleration that rotates with an unbalanced
//! propeller.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use crate::geo::GRAVITY;
use crate::math;
use crate::sim::airframe::ROTORS;
use crate::sim::body::lever_arm_acceleration;
use crate::sim::config::{Noise, WorldConfig};
use crate::sim::random::{GaussMarkov, Normals, Stream};
use crate::sim::switches::Switches;

use super::{SensorInputs, quantise};

/// White noise of the gyro, rad/s/√Hz (0.0038 °/s/√Hz).
const GYRO_DENSITY: f64 = 0.0038 * std::f64::consts::PI / 180.0;
/// Turn-on bias of the gyro, rad/s rms per axis (0.5 °/s).
const GYRO_TURN_ON: f64 = 0.5 * std::f64::consts::PI / 180.0;
/// Random walk of the gyro's bias, rad/s²/√Hz, and its time constant, s.
const GYRO_WALK: (f64, f64) = (2e-5, 1000.0);
/// Range of the gyro, rad/s, and steps per rad/s (16.4 per °/s).
const GYRO_RANGE: f64 = 2000.0 * std::f64::consts::PI / 180.0;
const GYRO_STEPS: f64 = 16.4 * 180.0 / std::f64::consts::PI;
/// White noise of the accelerometer, m/s²/√Hz (70 µg/√Hz).
const ACC_DENSITY: f64 = 70e-6 * GRAVITY;
/// Turn-on bias of the accelerometer, m/s² rms per axis.
const ACC_TURN_ON: f64 = 0.05;
/// Random walk of the accelerometer's bias, m/s³/√Hz, and its time constant, s.
const ACC_WALK: (f64, f64) = (1e-4, 300.0);
/// Range of the accelerometer, m/s² (16 g), and steps per m/s² (2048 per g).
const ACC_RANGE: f64 = 16.0 * GRAVITY;
const ACC_STEPS: f64 = 2048.0 / GRAVITY;
/// Time between two updates of the wandering biases, s.
const DRIFT_DT_S: f64 = 0.01;

/// The bias of one triad: the value at turn-on and the drift since.
#[derive(Debug, Clone)]
struct Bias {
    turn_on: Vector3<f64>,
    wander: Vector3<f64>,
    walk: GaussMarkov,
    normals: Normals,
}

impl Bias {
    fn new(seed: u64, stream: Stream, turn_on_sigma: f64, (walk, tau_s): (f64, f64)) -> Self {
        let mut normals = Normals::new(seed, stream);
        let turn_on = normals.next3() * turn_on_sigma;
        let walk = GaussMarkov::random_walk(walk, tau_s, DRIFT_DT_S);
        Self { turn_on, wander: Vector3::zeros(), walk, normals }
    }

    fn drift(&mut self) {
        let normal = self.normals.next3();
        self.wander = self.wander.zip_map(&normal, |value, normal| self.walk.next(value, normal));
    }

    fn value(&self) -> Vector3<f64> {
        self.turn_on + self.wander
    }
}

#[derive(Debug, Clone)]
pub(super) struct Imu {
    position_m: Vector3<f64>,
    step_s: f64,
    hover_speed: f64,
    gyro_sigma: f64,
    acc_sigma: f64,
    gyro: Normals,
    acc: Normals,
    gyro_bias: Bias,
    acc_bias: Bias,
    /// Present biases, constant between drifts.
    bias: (Vector3<f64>, Vector3<f64>),
    /// Angle of each rotor while its imbalance has an effect, rad.
    rotor_angle: [f64; ROTORS],
}

impl Imu {
    pub(super) fn new(config: &WorldConfig, step_s: f64) -> Self {
        let seed = config.seed;
        let root_rate = step_s.sqrt().recip();
        Self {
            position_m: config.airframe.imu_position_m,
            step_s,
            hover_speed: config.airframe.hover_rotor_speed(),
            gyro_sigma: GYRO_DENSITY * root_rate,
            acc_sigma: ACC_DENSITY * root_rate,
            gyro: Normals::new(seed, Stream::Gyro),
            acc: Normals::new(seed, Stream::Accelerometer),
            gyro_bias: Bias::new(seed, Stream::GyroBias, GYRO_TURN_ON, GYRO_WALK),
            acc_bias: Bias::new(seed, Stream::AccelerometerBias, ACC_TURN_ON, ACC_WALK),
            bias: (Vector3::zeros(), Vector3::zeros()),
            rotor_angle: [0.0; ROTORS],
        }
    }

    /// Lets the biases wander for one slow tick.
    pub(super) fn drift(&mut self, switches: &Switches, noise: Noise) {
        self.bias = if noise == Noise::Real && switches.sensor_bias {
            self.gyro_bias.drift();
            self.acc_bias.drift();
            (self.gyro_bias.value(), self.acc_bias.value())
        } else {
            (Vector3::zeros(), Vector3::zeros())
        };
    }

    /// Returns the measured body rates (rad/s) and specific force (m/s²) for the true ones, FLU.
    #[inline]
    pub(super) fn read(
        &mut self,
        true_rate: Vector3<f64>,
        true_force: Vector3<f64>,
        inputs: &SensorInputs<'_>,
        noise: Noise,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let (truth, effects) = (inputs.truth, inputs.effects);
        let mut rate = true_rate + effects.gyro_bias;
        let mut force = true_force + effects.acc_bias;
        if self.position_m != Vector3::zeros() {
            let rate_dot = (true_rate - inputs.rate_before_flu) / self.step_s;
            force += lever_arm_acceleration(true_rate, rate_dot, self.position_m);
        }
        if effects.imbalance_mps2 != [0.0; ROTORS] {
            force += self.imbalance(&truth.rotor_speeds, &effects.imbalance_mps2);
        }
        let vibration = inputs.switches.vibration_mps2 + effects.vibration_mps2;
        if noise == Noise::None && vibration == 0.0 {
            return (rate, force);
        }
        let mut acc_sigma = if noise == Noise::Real { self.acc_sigma } else { 0.0 };
        if vibration != 0.0 {
            acc_sigma = math::hypot(acc_sigma, vibration * self.rotor_energy(&truth.rotor_speeds));
        }
        if noise == Noise::Real {
            rate += self.bias.0 + self.gyro.next3() * self.gyro_sigma;
            force += self.bias.1;
        }
        force += self.acc.next3() * acc_sigma;
        if noise == Noise::Real {
            rate = rate.map(|v| quantise(v.clamp(-GYRO_RANGE, GYRO_RANGE), GYRO_STEPS));
            force = force.map(|v| quantise(v.clamp(-ACC_RANGE, ACC_RANGE), ACC_STEPS));
        }
        (rate, force)
    }

    /// Returns the mean squared rotor speed over its value in hover.
    fn rotor_energy(&self, speeds: &[f64; ROTORS]) -> f64 {
        speeds.iter().map(|speed| speed * speed).sum::<f64>()
            / (ROTORS as f64 * math::powi(self.hover_speed, 2))
    }

    /// Returns the acceleration of the body by unbalanced propellers, m/s².
    fn imbalance(&mut self, speeds: &[f64; ROTORS], at_hover_mps2: &[f64; ROTORS]) -> Vector3<f64> {
        let mut sum = Vector3::zeros();
        for i in 0..ROTORS {
            self.rotor_angle[i] = (self.rotor_angle[i] + speeds[i] * self.step_s) % TAU;
            let size = at_hover_mps2[i] * math::powi(speeds[i] / self.hover_speed, 2);
            let (sin, cos) = math::sin_cos(self.rotor_angle[i]);
            sum += Vector3::new(size * cos, size * sin, 0.0);
        }
        sum
    }
}
