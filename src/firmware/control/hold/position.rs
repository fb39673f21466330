//! Position hold with the roll and pitch sticks.

use nalgebra::Vector2;

use super::HoldTuning;
use crate::autopilot::Params;
use crate::autopilot::control::{PositionController, PositionMeasurement, PositionTarget, earth_to_body};
use crate::autopilot::io::NavInputs;
use crate::firmware::control::TiltDemand;

/// The full stick deflection, RC command units.
const FULL_STICK: f64 = 500.0;
/// The share of the maximum tilt that is used to plan the stop when the sticks are released.
const STOP_SHARE: f64 = 0.4;

#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct PositionHold {
    /// The held point, north and east, m; `None` while the pilot flies.
    point: Option<Vector2<f64>>,
    is_on: bool,
}

impl PositionHold {
    /// Releases the hold. The controller is engaged again at the next update.
    pub(super) fn release(&mut self) {
        *self = Self::default();
    }

    /// Returns the tilt that holds the position, or the tilt that the pilot demands.
    pub(super) fn update(
        &mut self,
        now: &NavInputs,
        params: &Params,
        tuning: &HoldTuning,
        controller: &mut PositionController,
    ) -> TiltDemand {
        let measured = PositionMeasurement::from(now);
        if !self.is_on {
            controller.engage(&measured);
            self.is_on = true;
        }
        let limit = controller.max_tilt_rad(params);
        if let Some(tilt) = tuning.stick_tilt(now, limit) {
            self.point = None;
            controller.track(&measured, now.dt);
            return tilt;
        }
        let point = *self.point.get_or_insert_with(|| stopping_point(now, params));
        let target = PositionTarget::stay(point, params);
        let tilt_ne = controller.update(&measured, &target, params, now.dt);
        let body = earth_to_body(tilt_ne, now.heading_rad);
        TiltDemand { pitch_down_rad: body.x, roll_rad: body.y }
    }
}

/// Returns the point at which the craft can stop without coming back; its own position if it is slow.
fn stopping_point(now: &NavInputs, params: &Params) -> Vector2<f64> {
    let brake = STOP_SHARE * params.max_accel_mps2();
    now.pos_ne + now.vel_ne * (now.vel_ne.norm() / (2.0 * brake.max(0.5)))
}

/// Returns the stick deflection beyond the deadband as a share of the rest, −1…1.
pub(super) fn share(stick: f64, deadband: f64) -> f64 {
    let deflection = stick.abs() / FULL_STICK;
    if deflection <= deadband {
        return 0.0;
    }
    ((deflection - deadband) / (1.0 - deadband).max(0.01)).min(1.0).copysign(stick)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_hold_has_learned_fades_while_the_pilot_flies_by_the_sticks() {
        let (params, tuning) = (Params::default(), HoldTuning::default());
        let (mut hold, mut controller) = (PositionHold::default(), PositionController::default());
        let mut pitch_deg = |now: &NavInputs, seconds: f64| {
            let steps = (seconds / now.dt).round() as usize;
            let demands =
                (0..steps).map(|_| hold.update(now, &params, &tuning, &mut controller).pitch_down_rad);
            demands.last().unwrap_or_default().to_degrees()
        };
        let at_point = NavInputs::hovering();
        let pushed_off = NavInputs { pos_ne: Vector2::new(-1.0, 0.0), ..at_point.clone() };
        let by_stick = NavInputs { stick_pitch: FULL_STICK, ..at_point.clone() };
        pitch_deg(&at_point, 1.0);
        pitch_deg(&pushed_off, 10.0);
        let learned = pitch_deg(&at_point, 1.5);
        assert!(learned > 3.0, "{learned}°");
        assert!(pitch_deg(&by_stick, 10.0) > 45.0);
        let left = pitch_deg(&at_point, 1.5);
        assert!(left.abs() < 0.2 * learned, "{left}° of {learned}°");
    }

    #[test]
    fn sticks_count_beyond_the_deadband() {
        assert_eq!(share(25.0, 0.05), 0.0);
        assert!((share(-500.0, 0.05) + 1.0).abs() < 1e-12);
        assert!(share(30.0, 0.05) < 0.02);
    }
}
