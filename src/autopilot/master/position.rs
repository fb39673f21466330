//! Position control: the tilt that leads to a point and follows a velocity.

use nalgebra::Vector2;

use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::math;

/// Distances and speeds count in cm, the tilt in degrees.
const CM_PER_M: f64 = 100.0;
/// Degrees per cm, for each point of `ap_position_p`.
const P: f64 = 0.0015;
/// Degrees per cm and second, for each point of `ap_position_i`.
const I: f64 = 0.000_15;
/// Degrees per cm/s, for each point of `ap_position_d`.
const D: f64 = 0.003;
/// Degrees per cm/s², for each point of `ap_position_a`.
const A: f64 = 0.0006;
/// Degrees per cm/s² of the commanded velocity, for each point of `ap_position_f`.
const F: f64 = 0.0003;
/// Degrees per cm/s that compensate the drag, for each point of `ap_velocity_drag_coeff`.
const DRAG: f64 = 0.0002;
/// The largest share of the damping that the drag may take away.
const DRAG_SHARE: f64 = 0.5;
/// The growth of the damping per cm/s while the craft brakes.
const BRAKE_BOOST: f64 = 0.0005;
/// The largest distance that counts while navigating, and in a hold, cm.
const NAVIGATING_CM: f64 = 500.0;
const HELD_CM: f64 = 2000.0;
/// The limit of the integral, cm·s.
const INTEGRAL: f64 = 2000.0;
/// The ratio of the cutoff of each of three equal low-passes to the cutoff of the whole.
const STAGE: f64 = 1.961_459_177;

/// The task of the position controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Task {
    /// Follows a point that moves, or leads to one.
    Navigate,
    /// Keeps a point.
    #[default]
    Hold,
    /// Comes to rest before it keeps a point.
    Brake,
    /// Damps the motion that the sticks ask for.
    Sticks,
}

/// A point and the velocity towards it, north and east, m and m/s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Point {
    pub(super) ne: Vector2<f64>,
    pub(super) vel_ne: Vector2<f64>,
}

/// Three equal first-order low-passes in a row, for both axes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct LowPass([Vector2<f64>; 3]);

impl LowPass {
    fn apply(&mut self, input: Vector2<f64>, cutoff_hz: f64, dt: f64) -> Vector2<f64> {
        let turn = std::f64::consts::TAU * STAGE * cutoff_hz * dt;
        let gain = turn / (turn + 1.0);
        self.0.iter_mut().fold(input, |input, stage| {
            *stage += gain * (input - *stage);
            *stage
        })
    }
}

/// The position controller.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct PositionLaw {
    low_pass: LowPass,
    /// cm·s.
    integral: Vector2<f64>,
    /// The velocity and the commanded velocity of the last update, cm/s.
    last: Option<[Vector2<f64>; 2]>,
}

impl PositionLaw {
    /// Starts again, with empty filters and integral.
    pub(super) fn reset(&mut self) {
        *self = Self::default();
    }

    /// Returns the tilt (forward, right), rad, `dt` seconds after the last update. The angle of the sticks (forward, right,
    /// rad) is added within `ap_max_angle`.
    pub(super) fn tilt(
        &mut self,
        now: &NavInputs,
        wanted: &Point,
        task: Task,
        sticks: Vector2<f64>,
        params: &Params,
        dt: f64,
    ) -> Vector2<f64> {
        let gain = |factor: f64, points: u8| factor * f64::from(points);
        let limit = if task == Task::Navigate { NAVIGATING_CM } else { HELD_CM };
        let away = ((wanted.ne - now.pos_ne) * CM_PER_M).map(|axis| axis.clamp(-limit, limit));
        let (velocity, commanded) = (now.vel_ne * CM_PER_M, wanted.vel_ne * CM_PER_M);
        let [last, last_commanded] =
            self.last.replace([velocity, commanded]).unwrap_or([velocity, commanded]);
        match task {
            Task::Hold => {
                self.integral = (self.integral + away * dt).map(|axis| axis.clamp(-INTEGRAL, INTEGRAL));
            }
            Task::Brake | Task::Sticks => {}
            Task::Navigate => self.integral = Vector2::zeros(),
        }
        let damping = gain(D, params.position_d);
        let boost = if task == Task::Brake { 1.0 + BRAKE_BOOST * velocity.norm() } else { 1.0 };
        let drag = (DRAG * f64::from(params.velocity_drag_coeff)).min(DRAG_SHARE * damping);
        let filtered = away * gain(P, params.position_p)
            + (last - velocity) * (gain(A, params.position_a) / dt.max(1e-3))
            + commanded * damping
            + (commanded - last_commanded) * (gain(F, params.position_f) / dt.max(1e-3));
        let filtered = self.low_pass.apply(filtered, 0.1 * f64::from(params.position_cutoff), dt);
        let direct = self.integral * gain(I, params.position_i) + velocity * (drag - damping * boost);
        let earth = (filtered + direct).map(f64::to_radians);
        let (sin, cos) = math::sin_cos(now.heading_rad);
        let body = Vector2::new(earth.x * cos + earth.y * sin, earth.y * cos - earth.x * sin);
        (body + sticks).cap_magnitude(params.max_tilt_rad())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn params() -> Params {
        Params { velocity_drag_coeff: 0, max_angle: 70, ..Params::default() }
    }

    /// Returns the steady tilt, degrees, for a velocity and a commanded point and velocity.
    fn steady(now: &NavInputs, wanted: Point, task: Task, params: &Params) -> Vector2<f64> {
        let mut law = PositionLaw::default();
        let tilts = (0..200).map(|_| law.tilt(now, &wanted, task, Vector2::zeros(), params, 0.01));
        tilts.last().unwrap().map(f64::to_degrees)
    }

    #[test]
    fn a_metre_gives_four_and_a_half_degrees_and_five_metres_are_the_most_while_navigating() {
        let now = NavInputs::hovering();
        let ahead = |m: f64| Point { ne: Vector2::new(m, 0.0), ..Point::default() };
        let tilt = |m: f64, task| steady(&now, ahead(m), task, &Params { position_i: 0, ..params() });
        assert!((tilt(1.0, Task::Navigate).x - 4.5).abs() < 1e-6);
        assert!((tilt(50.0, Task::Navigate).x - 22.5).abs() < 1e-6);
        assert!((tilt(50.0, Task::Hold).x - 70.0).abs() < 1e-6, "limited by ap_max_angle");
    }

    #[test]
    fn a_craft_at_its_commanded_velocity_flies_level_but_for_the_drag() {
        let now = NavInputs { vel_ne: Vector2::new(5.0, 0.0), ..NavInputs::hovering() };
        let along = Point { ne: now.pos_ne, vel_ne: now.vel_ne };
        assert!(steady(&now, along, Task::Navigate, &params()).norm() < 1e-6);
        let drag = Params { velocity_drag_coeff: 50, ..params() };
        assert!((steady(&now, along, Task::Navigate, &drag).x - 5.0).abs() < 1e-6);
        // Never more than half of the damping.
        let much = Params { velocity_drag_coeff: 1000, ..params() };
        assert!((steady(&now, along, Task::Navigate, &much).x - 22.5).abs() < 1e-6);
    }

    #[test]
    fn a_hold_learns_the_wind_and_braking_damps_more() {
        let now = NavInputs::hovering();
        let beside = Point { ne: Vector2::new(0.0, 1.0), ..Point::default() };
        let learned = steady(&now, beside, Task::Hold, &params());
        assert!((learned.y - 4.5 - 2.0 * 0.45).abs() < 0.01, "{learned}");
        let fast = NavInputs { vel_ne: Vector2::new(10.0, 0.0), ..NavInputs::hovering() };
        let tilt = |task| {
            steady(&fast, Point::default(), task, &Params { max_angle: 70, position_d: 10, ..params() }).x
        };
        assert!((tilt(Task::Brake) / tilt(Task::Hold) - 1.5).abs() < 1e-6);
    }

    #[test]
    fn the_tilt_turns_with_the_nose() {
        let east = NavInputs { heading_rad: std::f64::consts::FRAC_PI_2, ..NavInputs::hovering() };
        let north = Point { ne: Vector2::new(1.0, 0.0), ..Point::default() };
        let tilt = steady(&east, north, Task::Navigate, &params());
        assert!(tilt.x.abs() < 1e-9 && tilt.y < -4.4, "left: {tilt}");
    }
}
