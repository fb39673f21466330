//! The true state of the craft, which no sensor measures exactly.

use nalgebra::{UnitQuaternion, Vector3};

use crate::math;
use crate::signals::SimTime;

use super::airframe::ROTORS;

/// The true state of the craft at one instant: world ENU with home on the ground as origin, body FLU.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Truth {
    /// Simulated time since boot.
    pub time: SimTime,
    /// Centre of mass, m; on the ground z is the height of the centre of mass above the legs.
    pub pos_enu: Vector3<f64>,
    /// Velocity, m/s.
    pub vel_enu: Vector3<f64>,
    /// Attitude, body FLU → ENU.
    pub attitude: UnitQuaternion<f64>,
    /// Body rates, rad/s.
    pub rate_flu: Vector3<f64>,
    /// Rotor speeds M1…M4, rad/s.
    pub rotor_speeds: [f64; ROTORS],
    /// Last accepted motor commands M1…M4, 0…1.
    pub motor_command: [f64; ROTORS],
    /// Specific force at the centre of mass, m/s².
    pub specific_force_flu: Vector3<f64>,
    /// Wind at the craft (the direction it blows to), m/s.
    pub wind_enu: Vector3<f64>,
    /// The battery.
    pub battery: BatteryTruth,
    /// Height of the ground below the craft relative to the ground at home, m.
    pub ground_m: f64,
    /// `true` if at least one leg carries load.
    pub on_ground: bool,
    /// `true` after a crash. The rotors have stopped until a reset.
    pub crashed: bool,
    /// `true` if the integration has failed. The state is then the last sane one and no longer changes.
    pub diverged: bool,
}

/// The true state of the battery.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BatteryTruth {
    /// Terminal voltage, V.
    pub voltage_v: f64,
    /// Current, A.
    pub current_a: f64,
    /// Charge drawn since the start, mA·h.
    pub drawn_mah: f64,
    /// Energy drawn since the start, W·h.
    pub drawn_wh: f64,
    /// Capacity of a full pack, mA·h.
    pub capacity_mah: f64,
}

impl Truth {
    /// Returns the heading of the nose, degrees clockwise from north, 0…360.
    pub fn heading_deg(&self) -> f64 {
        let nose = self.attitude * Vector3::x();
        math::atan2(nose.x, nose.y).to_degrees().rem_euclid(360.0)
    }

    /// Returns the roll, right wing down positive, degrees.
    pub fn roll_deg(&self) -> f64 {
        let up = self.attitude.inverse_transform_vector(&Vector3::z());
        math::atan2(up.y, up.z).to_degrees()
    }

    /// Returns the pitch, nose up positive, degrees.
    pub fn pitch_deg(&self) -> f64 {
        let nose = self.attitude * Vector3::x();
        math::asin(nose.z.clamp(-1.0, 1.0)).to_degrees()
    }
}

/// Returns the attitude of a level craft with the given heading (degrees clockwise from north), body FLU → ENU.
pub fn level_attitude(heading_deg: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), (90.0 - heading_deg).to_radians())
}

/// Returns the attitude from heading (clockwise from north), pitch (nose up positive) and roll (right positive),
/// degrees, applied in this order; body FLU → ENU.
pub fn attitude(heading_deg: f64, pitch_up_deg: f64, roll_right_deg: f64) -> UnitQuaternion<f64> {
    // In FLU a positive turn about y puts the nose down and one about x puts the right side down.
    level_attitude(heading_deg)
        * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -pitch_up_deg.to_radians())
        * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), roll_right_deg.to_radians())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_come_back_from_the_attitude() {
        let truth = |attitude| Truth { attitude, ..Truth::default() };
        let craft = truth(attitude(200.0, -12.0, 7.0));
        assert!((craft.heading_deg() - 200.0).abs() < 1e-9);
        assert!((craft.pitch_deg() + 12.0).abs() < 1e-9);
        assert!((craft.roll_deg() - 7.0).abs() < 1e-9);
        let nose = level_attitude(90.0) * Vector3::x();
        assert!((nose - Vector3::x()).norm() < 1e-12, "heading east looks along x");
    }
}
