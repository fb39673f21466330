//! The magnetometer: the earth's field in body axes, 100 times a second.
//!
//! The field is that of Betaflight's SITL (60° dip, 2° east declination, 500 mG shown as 4096 counts), turned to the
//! configured declination. Only its direction matters to the flight controller.

use nalgebra::{UnitQuaternion, Vector3};

use crate::math;
use crate::sim::config::Noise;
use crate::sim::fault::Effects;
use crate::sim::random::{Normals, Stream};

/// The horizontal and vertical (up) part of the field, counts.
const HORIZONTAL: f64 = 2_048.048_458_899_349_5;
const UP: f64 = -3_547.2;

/// The white noise per axis, counts: 0.4 mG of a field of 500 mG.
const SIGMA: f64 = 0.4 / 500.0 * 4096.0;

#[derive(Debug, Clone)]
pub(super) struct Magnetometer {
    normals: Normals,
}

/// Returns the earth's magnetic field for a declination (degrees east), ENU, counts: 4096 counts are 500 mG.
pub fn magnetic_field_enu(declination_deg: f64) -> Vector3<f64> {
    let (sin, cos) = math::sin_cos(declination_deg.to_radians());
    Vector3::new(HORIZONTAL * sin, HORIZONTAL * cos, UP)
}

impl Magnetometer {
    pub(super) fn new(seed: u64) -> Self {
        Self { normals: Normals::new(seed, Stream::Magnetometer) }
    }

    /// Returns the measured field in body axes FLU, counts.
    pub(super) fn read(
        &mut self,
        attitude: &UnitQuaternion<f64>,
        declination_deg: f64,
        effects: &Effects,
        noise: Noise,
    ) -> Option<Vector3<f64>> {
        let error = match noise {
            Noise::Real => self.normals.next3() * SIGMA,
            Noise::None => Vector3::zeros(),
        };
        if effects.mag_off {
            return None;
        }
        let mut field = attitude.inverse_transform_vector(&magnetic_field_enu(declination_deg));
        if effects.mag_bias_rad != 0.0 {
            // North measured further left means a heading further right.
            field = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), effects.mag_bias_rad) * field;
        }
        Some(field + error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::{SITL_DECLINATION_DEG, truth};

    /// Returns the heading from a level magnetometer, degrees.
    fn heading(field: Vector3<f64>) -> f64 {
        field.y.atan2(field.x).to_degrees().rem_euclid(360.0)
    }

    #[test]
    fn the_field_is_that_of_the_reference() {
        let field = magnetic_field_enu(SITL_DECLINATION_DEG);
        assert!((field - Vector3::new(71.5, 2046.8, -3547.2)).norm() < 1e-9, "{field}");
    }

    #[test]
    fn bias_adds_to_the_heading() {
        let mut magnetometer = Magnetometer::new(1);
        let mut effects = Effects::NONE;
        let level = truth::level_attitude(90.0);
        let read = |m: &mut Magnetometer, e: &Effects| m.read(&level, 0.0, e, Noise::None).map(heading);
        assert!((read(&mut magnetometer, &effects).unwrap() - 90.0).abs() < 1e-9);
        effects.mag_bias_rad = 20_f64.to_radians();
        assert!((read(&mut magnetometer, &effects).unwrap() - 110.0).abs() < 1e-9);
        effects.mag_off = true;
        assert_eq!(read(&mut magnetometer, &effects), None);
    }
}
