//! The state of the rigid body and its loads.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// Position, velocity, attitude and rotation of the craft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyState {
    /// Centre of mass, ENU from home on the ground, m.
    pub pos_enu: Vector3<f64>,
    /// Velocity, ENU, m/s.
    pub vel_enu: Vector3<f64>,
    /// Attitude, body FLU → ENU.
    pub attitude: UnitQuaternion<f64>,
    /// Body rates, FLU, rad/s.
    pub rate_flu: Vector3<f64>,
}

impl BodyState {
    /// Returns `true` if every number is finite.
    pub fn is_finite(&self) -> bool {
        let sum = self.pos_enu.sum() + self.vel_enu.sum() + self.rate_flu.sum() + self.attitude.coords.sum();
        sum.is_finite()
    }
}

/// The air around the craft, constant over a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirSample {
    /// Wind, ENU (the direction it blows to), m/s.
    pub wind_enu: Vector3<f64>,
    /// Density over the reference density.
    pub density_ratio: f64,
}

/// Force (N) and torque (N·m) on the craft in body axes, without gravity and the reaction to rotor acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loads {
    /// Force, FLU, N.
    pub force_flu: Vector3<f64>,
    /// Torque about the centre of mass, FLU, N·m.
    pub torque_flu: Vector3<f64>,
}

/// Returns the additional acceleration at an accelerometer away from the centre of mass: `α × r + ω × (ω × r)`, m/s².
pub fn lever_arm_acceleration(
    rate_flu: Vector3<f64>,
    rate_dot_flu: Vector3<f64>,
    position_m: Vector3<f64>,
) -> Vector3<f64> {
    rate_dot_flu.cross(&position_m) + rate_flu.cross(&rate_flu.cross(&position_m))
}

/// Returns the body → world matrix of a quaternion with a norm near one.
#[inline]
pub(super) fn rotation(q: &Quaternion<f64>) -> Matrix3<f64> {
    let (w, x, y, z) = (q.w, q.i, q.j, q.k);
    let (ww, xx, yy, zz) = (w * w, x * x, y * y, z * z);
    let (wx, wy, wz) = (2.0 * w * x, 2.0 * w * y, 2.0 * w * z);
    let (xy, xz, yz) = (2.0 * x * y, 2.0 * x * z, 2.0 * y * z);
    Matrix3::new(
        ww + xx - yy - zz,
        xy - wz,
        xz + wy,
        xy + wz,
        ww - xx + yy - zz,
        yz - wx,
        xz - wy,
        yz + wx,
        ww - xx - yy + zz,
    )
}
