//! The step of a craft in the air, with one evaluation of the loads: Adams–Bashforth of fourth order.
//!
//! The method extrapolates what changes the motion from the present and the last three instants, so that must not
//! jump. Thrust and torque of the rotors bend wherever a motor command changes, which is in every step. But they depend on
//! the rotor speeds alone, and these are known for the whole step. So the mean of thrust and torque over the step is
//! exact, and only the rest is extrapolated: gyroscopic torques, damping, drag, and the turn of the thrust.
//!
//! The weights are those of Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, III.1. The angle of
//! the turn is the fourth-order Magnus expansion (Iserles et al., *Lie-group methods*, Acta Numerica 2000), with the
//! integrals by Hermite's rule.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::sim::body::{AirSample, BodyState};
use crate::sim::motors::RotorStep;

use super::Plant;
use super::craft::{PAST, Present, Trend};

/// The weights of the present instant and those before it in the mean of a quantity over the step.
const MEAN: [f64; PAST + 1] = [55.0 / 24.0, -59.0 / 24.0, 37.0 / 24.0, -9.0 / 24.0];
/// The same in its double integral over a step of length one.
const TWICE: [f64; PAST + 1] = [323.0 / 360.0, -264.0 / 360.0, 159.0 / 360.0, -38.0 / 360.0];
/// The same in its value at the end of the step.
const END: [f64; PAST + 1] = [4.0, -6.0, 4.0, -1.0];

impl Plant {
    /// Returns the state after one step. `trends` are those of the present and the last three instants.
    pub(super) fn fly(
        &self,
        body: &BodyState,
        rotors: &RotorStep<'_>,
        air: &AirSample,
        now: &Present,
        trends: [&Trend; PAST + 1],
    ) -> BodyState {
        let h = self.h;
        let BodyState { pos_enu, vel_enu, attitude, rate_flu: rate } = body;
        let mean = self.rotors.static_loads(&rotors.mean_squares(), air.density_ratio);

        // Angular momentum, and the body rates that it leaves to the body.
        let momentum = self.momentum(rate, now.sums.spin);
        let (turns, accelerations) = (trends.map(|trend| &trend.turn), trends.map(|trend| &trend.acc));
        let (turn, thrust) = weighted(&MEAN, turns);
        let (end, spin_up) = (rotors.at_end(), rotors.accelerations());
        let end_momentum = momentum + (turn + mean.torque_flu) * h;
        let end_rate = self.rate(&end_momentum, self.rotors.spin(&end));

        // The attitude, by Magnus: the angle from both rates and their derivatives, and what the turn of the axis adds.
        let at_start = now.loads.torque_flu - rate.cross(&momentum);
        let end_squares = std::array::from_fn(|i| end[i] * end[i]);
        let at_end =
            self.rotors.static_loads(&end_squares, air.density_ratio).torque_flu + weighted(&END, turns).0;
        let [rate_dot, end_rate_dot] = [(at_start, spin_up[0]), (at_end, spin_up[1])]
            .map(|(torque, acceleration)| self.rate(&torque, self.rotors.spin(&acceleration)));
        let angle = (rate + end_rate) * (0.5 * h)
            + (rate_dot - end_rate_dot + rate.cross(&end_rate)) * (h * h / 12.0);

        // Velocity and position. The thrust that the mean of the trends misses acts along the axis at half the step.
        let (acc, _) = weighted(&MEAN, accelerations);
        let missing = (mean.force_flu.z - thrust) * self.mass_inv;
        let axis = now.rotation * Vector3::new(0.5 * h * rate.y, -0.5 * h * rate.x, 1.0);
        let (twice, _) = weighted(&TWICE, accelerations);
        BodyState {
            pos_enu: pos_enu + (vel_enu + twice * h) * h,
            vel_enu: vel_enu + (acc + axis * missing) * h,
            attitude: turned(attitude, &angle),
            rate_flu: end_rate,
        }
    }
}

/// Returns the weighted sum of four rows: a vector and a number.
#[inline]
fn weighted(weights: &[f64; PAST + 1], rows: [&[f64; 4]; PAST + 1]) -> (Vector3<f64>, f64) {
    let [a, b, c, d] = weights;
    let [first, second, third, fourth] = rows;
    let [x, y, z, number] =
        std::array::from_fn(|i| first[i] * a + second[i] * b + third[i] * c + fourth[i] * d);
    (Vector3::new(x, y, z), number)
}

/// Returns an attitude after a turn about body axes, rad.
#[inline]
fn turned(attitude: &UnitQuaternion<f64>, angle: &Vector3<f64>) -> UnitQuaternion<f64> {
    // The exponential to fifth order, because the turn of one step is far below a radian.
    let square = angle.norm_squared();
    let half = angle * (0.5 - square * (1.0 / 48.0 - square / 3840.0));
    let turn = Quaternion::new(1.0 - square * (0.125 - square / 384.0), half.x, half.y, half.z);
    let q = attitude.into_inner() * turn;
    // One Newton step keeps the length at one.
    UnitQuaternion::new_unchecked(q * (1.5 - 0.5 * q.norm_squared()))
}
