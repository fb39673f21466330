//! The integrals of the position controller.

use betadeck_core::autopilot::Params;
use betadeck_core::autopilot::control::{PositionController, PositionMeasurement, PositionTarget};
use nalgebra::Vector2;

use crate::autopilot::flight::{DT, guide};

#[test]
fn a_craft_that_is_held_back_at_its_greatest_tilt_winds_nothing_up() {
    let params = Params { max_angle: 10, ..guide() };
    let here = PositionMeasurement {
        position: Vector2::zeros(),
        velocity: Vector2::zeros(),
        accel: Vector2::zeros(),
        tilt_body: Vector2::zeros(),
        heading_rad: 0.0,
    };
    let mut controller = PositionController::default();
    controller.engage(&here);
    let mut tilt_after = |point: Vector2<f64>, seconds: f64| {
        let target = PositionTarget::stay(point, &params);
        let steps = (seconds / DT) as usize;
        let tilts = (0..steps).map(|_| controller.update(&here, &target, &params, DT).norm().to_degrees());
        tilts.last().unwrap()
    };
    assert!(tilt_after(Vector2::new(200.0, 0.0), 20.0) > 9.9, "it pulls with all it has");
    let left = tilt_after(Vector2::zeros(), 5.0);
    assert!(left < 5.0, "{left} degrees are left when the target is reached");
}
