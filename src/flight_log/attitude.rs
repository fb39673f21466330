//! The attitude of a craft from its log.
//!
//! The firmware's earth frame has x north, y west and z up; its body frame has x forward, y left and z up.

use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};

use super::sample::LogAttitude;
use crate::geo::GRAVITY;
use crate::math;

/// The share of the error against the accelerometer that is corrected in a second.
const CORRECTION_PER_S: f64 = 0.3;
/// The specific forces between which the accelerometer shows where up is, as shares of gravity.
const STEADY: std::ops::Range<f64> = 0.85..1.15;
/// After a longer pause between two frames the accelerometer alone gives the attitude, s.
const MAX_STEP_S: f64 = 0.5;

/// Returns the attitude of a quaternion whose x, y and z are known and whose w is not negative.
pub(super) fn from_parts([x, y, z]: [f64; 3]) -> UnitQuaternion<f64> {
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

/// Returns the angles of an attitude, body to earth.
pub(super) fn angles(attitude: &UnitQuaternion<f64>) -> LogAttitude {
    let matrix = attitude.to_rotation_matrix();
    let down = -matrix[(2, 0)];
    LogAttitude {
        roll_deg: math::atan2(matrix[(2, 1)], matrix[(2, 2)]).to_degrees(),
        pitch_deg: -math::asin(down.clamp(-1.0, 1.0)).to_degrees(),
        heading_deg: heading((-math::atan2(matrix[(1, 0)], matrix[(0, 0)])).to_degrees()),
    }
}

/// Returns a direction between 0 and 360°.
pub(super) fn heading(degrees: f64) -> f64 {
    let folded = degrees.rem_euclid(360.0);
    // Adding zero turns a negative zero into a plain one.
    if folded < 360.0 { folded + 0.0 } else { 0.0 }
}

/// Turns an attitude to the right.
pub(super) fn turned_right(attitude: &UnitQuaternion<f64>, degrees: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -degrees.to_radians()) * attitude
}

/// Returns the level attitude, facing north, that the accelerometer shows.
fn by_accelerometer(accel_mps2: Option<Vector3<f64>>) -> UnitQuaternion<f64> {
    let up = accel_mps2.and_then(|accel| Unit::try_new(accel, 1e-3));
    up.and_then(|up| UnitQuaternion::rotation_between_axis(&up, &Vector3::z_axis())).unwrap_or_default()
}

/// Returns the attitude after a step: the rates are integrated, and the accelerometer corrects roll and pitch.
pub(super) fn integrated(
    before: Option<&UnitQuaternion<f64>>,
    step_s: f64,
    gyro_dps: Vector3<f64>,
    accel_mps2: Option<Vector3<f64>>,
) -> UnitQuaternion<f64> {
    let Some(before) = before.filter(|_| step_s <= MAX_STEP_S) else {
        let level = by_accelerometer(accel_mps2);
        return before.map_or(level, |before| turned_right(&level, angles(before).heading_deg));
    };
    let up = before.inverse_transform_vector(&Vector3::z());
    let is_steady = |accel: &Vector3<f64>| STEADY.contains(&(accel.norm() / GRAVITY));
    let error = accel_mps2.filter(is_steady).map_or(Vector3::zeros(), |accel| accel.normalize().cross(&up));
    let rate = gyro_dps.map(f64::to_radians) + error * CORRECTION_PER_S;
    let after = before * UnitQuaternion::from_scaled_axis(rate * step_s);
    if after.coords.iter().all(|part| part.is_finite()) { after } else { *before }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_right_nose_up_and_clockwise() {
        let angle =
            |axis: Vector3<f64>| angles(&UnitQuaternion::from_scaled_axis(axis * 30_f64.to_radians()));
        let near = |value: f64, expected: f64| assert!((value - expected).abs() < 1e-9, "{value} {expected}");
        near(angle(Vector3::x()).roll_deg, 30.0);
        near(angle(Vector3::y()).pitch_deg, -30.0);
        near(angle(Vector3::z()).heading_deg, 330.0);
        near(angles(&turned_right(&UnitQuaternion::identity(), 90.0)).heading_deg, 90.0);
    }

    #[test]
    fn rates_are_integrated_and_the_accelerometer_levels() {
        let mut attitude = None;
        for _ in 0..1000 {
            attitude = Some(integrated(attitude.as_ref(), 0.001, Vector3::new(30.0, 0.0, -45.0), None));
        }
        let turned = angles(&attitude.unwrap());
        assert!((turned.heading_deg - 45.0).abs() < 20.0 && turned.roll_deg > 15.0, "{turned:?}");
        for _ in 0..60_000 {
            let at_rest = Some(Vector3::new(0.0, 0.0, GRAVITY));
            attitude = Some(integrated(attitude.as_ref(), 0.001, Vector3::zeros(), at_rest));
        }
        let levelled = angles(&attitude.unwrap());
        assert!(levelled.roll_deg.abs() < 0.1 && levelled.pitch_deg.abs() < 0.1, "{levelled:?}");
    }

    #[test]
    fn after_a_pause_the_accelerometer_gives_roll_and_pitch_and_the_heading_stays() {
        let before = turned_right(&UnitQuaternion::identity(), 120.0);
        let tilt = 0.5_f64;
        let accel = Vector3::new(0.0, tilt.sin() * GRAVITY, tilt.cos() * GRAVITY);
        let after = angles(&integrated(Some(&before), 5.0, Vector3::zeros(), Some(accel)));
        assert!(
            (after.heading_deg - 120.0).abs() < 1e-6 && (after.roll_deg - tilt.to_degrees()).abs() < 1e-6
        );
    }
}
