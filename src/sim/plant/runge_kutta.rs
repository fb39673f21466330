//! The step of a craft near the ground, or in the first moments in the air: classical Runge–Kutta.
//!
//! The rotor speeds at half the step and at its end are exact, so that two of the four stages share them.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::sim::airframe::ROTORS;
use crate::sim::body::{AirSample, BodyState, Loads, rotation};
use crate::sim::motors::RotorStep;

use super::craft::{Craft, Present};
use super::rotors::RotorSums;
use super::{Moment, Plant};

/// The numbers of a stage, or their time derivatives. The quaternion need not have norm one.
#[derive(Clone, Copy)]
struct Stage {
    pos: Vector3<f64>,
    vel: Vector3<f64>,
    q: Quaternion<f64>,
    /// The angular momentum of body and rotors, FLU.
    momentum: Vector3<f64>,
}

impl Stage {
    /// Returns this stage moved along a slope for `dt` seconds.
    fn along(&self, slope: &Self, dt: f64) -> Self {
        Self {
            pos: self.pos + slope.pos * dt,
            vel: self.vel + slope.vel * dt,
            q: self.q + slope.q * dt,
            momentum: self.momentum + slope.momentum * dt,
        }
    }
}

impl Plant {
    /// Returns the state after one step.
    pub(super) fn runge_kutta(
        &self,
        craft: &Craft,
        rotors: &RotorStep<'_>,
        air: &AirSample,
        now: &Present,
    ) -> BodyState {
        let h = self.h;
        let BodyState { pos_enu, vel_enu, attitude, rate_flu } = craft.body;
        let start = Stage {
            pos: pos_enu,
            vel: vel_enu,
            q: *attitude,
            momentum: self.momentum(&rate_flu, now.sums.spin),
        };
        let (at_half, at_end) = (rotors.at_half(), rotors.at_end());
        let (half, end) = (self.rotors.sums(&at_half), self.rotors.sums(&at_end));
        let k1 = self.slope_under(&start, &now.rotation, &rate_flu, &now.loads);
        let k2 = self.slope(&start.along(&k1, 0.5 * h), &at_half, &half, air, craft);
        let k3 = self.slope(&start.along(&k2, 0.5 * h), &at_half, &half, air, craft);
        let k4 = self.slope(&start.along(&k3, h), &at_end, &end, air, craft);
        let stage = [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)]
            .iter()
            .fold(start, |stage, (slope, weight)| stage.along(slope, weight * h / 6.0));
        BodyState {
            pos_enu: stage.pos,
            vel_enu: stage.vel,
            attitude: UnitQuaternion::new_normalize(stage.q),
            rate_flu: self.rate(&stage.momentum, end.spin),
        }
    }

    fn slope(
        &self,
        stage: &Stage,
        rotors: &[f64; ROTORS],
        sums: &RotorSums,
        air: &AirSample,
        craft: &Craft,
    ) -> Stage {
        let rotation = rotation(&stage.q);
        let rate = self.rate(&stage.momentum, sums.spin);
        let moment =
            Moment { pos: &stage.pos, vel: &stage.vel, rate: &rate, rotation: &rotation, rotors, sums };
        let loads = self.loads_near_ground(&moment, air, &craft.anchors);
        self.slope_under(stage, &rotation, &rate, &loads)
    }

    fn slope_under(
        &self,
        stage: &Stage,
        rotation: &Matrix3<f64>,
        rate: &Vector3<f64>,
        loads: &Loads,
    ) -> Stage {
        Stage {
            pos: stage.vel,
            vel: self.acceleration(rotation, &loads.force_flu),
            q: stage.q * Quaternion::from_imag(rate * 0.5),
            momentum: loads.torque_flu - rate.cross(&stage.momentum),
        }
    }
}
