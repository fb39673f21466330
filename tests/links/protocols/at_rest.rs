//! The state that an external simulator sends for a craft on the ground.

use betadeck::link::proto::fdm::{State, pressure_pa};
use nalgebra::{UnitQuaternion, Vector3};

/// Returns the state of a craft at rest, level, facing north.
pub(crate) fn at_rest(stamp_s: f64) -> State {
    State {
        stamp_s,
        rate_flu: Vector3::zeros(),
        specific_force_flu: Vector3::new(0.0, 0.0, betadeck::geo::GRAVITY),
        attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2),
        vel_enu: Vector3::zeros(),
        lon_deg: -79.51825,
        lat_deg: 40.4635,
        alt_m: 0.0,
        pressure_pa: pressure_pa(0.0),
    }
}
