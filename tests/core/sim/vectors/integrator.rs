//! The integrator against itself: the step with one evaluation of the loads, Runge–Kutta, and short steps.

use betadeck_core::sim::{Airframe, BodyState};
use nalgebra::Vector3;

use crate::sim::vectors::stand::{Stand, without_drag};

/// The step of the integrator, s, and that of the reference.
const H: f64 = 0.001;
const SHORT_H: f64 = H / 8.0;
/// The period of the flight controller, s. It holds its commands that long.
const CONTROL_S: f64 = 0.001;

/// Tilt angles to the right and forwards, rad, that change every two seconds.
const TILTS: [[f64; 2]; 5] = [[0.0, 0.4], [0.4, 0.0], [0.0, -0.5], [-0.6, 0.1], [0.0, 0.0]];

/// Stands in for a flight controller: tilts the craft by rates and angles. Returns the motor commands, 0…1.
fn control(body: &BodyState, [right, forwards]: [f64; 2]) -> [f64; 4] {
    let up = body.attitude.inverse_transform_vector(&Vector3::z());
    let rate = body.rate_flu;
    let roll = 0.30 * (right - up.y) - 0.05 * rate.x;
    let pitch = 0.30 * (forwards + up.x) - 0.05 * rate.y;
    let yaw = -0.1 * rate.z;
    let lift = 0.53 / up.z.max(0.5).sqrt() - 0.02 * body.vel_enu.z;
    // Motors: rear right, front right, rear left, front left.
    [
        lift - roll + pitch + yaw,
        lift - roll - pitch - yaw,
        lift + roll + pitch - yaw,
        lift + roll - pitch + yaw,
    ]
}

fn steady(_: f64) -> Vector3<f64> {
    Vector3::new(4.0, -2.0, 0.0)
}

fn rough(time_s: f64) -> Vector3<f64> {
    steady(time_s) + Vector3::new((7.0 * time_s).sin(), (5.0 * time_s).cos(), 0.5 * (11.0 * time_s).sin())
}

/// Returns the craft after 20 s of turns in wind that changes a hundred times a second, as that of the world does.
fn flown(mut stand: Stand, h: f64, wind: fn(f64) -> Vector3<f64>) -> BodyState {
    stand.rotors = [stand.airframe.hover_rotor_speed(); 4];
    let per_command = (CONTROL_S / h).round() as u32;
    for command in 0..20_000_u32 {
        if command % 10 == 0 {
            stand.air.wind_enu = wind(f64::from(command) * CONTROL_S);
        }
        let tilt = TILTS[command as usize / 2000 % TILTS.len()];
        stand.command(control(&stand.body, tilt));
        (0..per_command).for_each(|_| stand.step());
    }
    stand.body
}

fn high_above_the_ground(h: f64) -> Stand {
    Stand::new(Airframe::iris(), 500.0, h)
}

#[test]
fn a_flight_with_one_evaluation_a_step_ends_where_a_flight_with_short_steps_does() {
    // The hold of the commands moves a flight with 1 kHz by 4 mm from one with 8 kHz. In rough air each change of the wind
    // takes effect half a step late.
    for (wind, largest_m) in [(steady as fn(f64) -> _, 1e-4), (rough, 2e-3)] {
        let reference = flown(high_above_the_ground(SHORT_H).by_runge_kutta(), SHORT_H, wind);
        let error = |body: BodyState| {
            let turn_rad = body.attitude.angle_to(&reference.attitude);
            [(body.pos_enu - reference.pos_enu).norm(), (body.vel_enu - reference.vel_enu).norm(), turn_rad]
        };
        assert!(reference.pos_enu.xy().norm() > 20.0, "it flew: {reference:?}");
        let four = error(flown(high_above_the_ground(H).by_runge_kutta(), H, wind));
        let one @ [position_m, velocity_mps, turn_rad] = error(flown(high_above_the_ground(H), H, wind));
        assert!(four[0] < 1e-6, "the reference is good: {four:?}");
        assert!(position_m < largest_m && velocity_mps < 2e-4 && turn_rad < 1e-4, "{one:?}");
    }
}

#[test]
fn the_step_with_one_evaluation_is_of_fourth_order() {
    let end = |h: f64| {
        let mut stand = high_above_the_ground(h);
        stand.body.vel_enu = Vector3::new(6.0, 2.0, -0.5);
        stand.body.rate_flu = Vector3::new(4.0, -3.0, 2.0);
        stand.rotors = [stand.airframe.hover_rotor_speed(); 4];
        stand.command([0.6, 0.50, 0.51, 0.45]);
        stand.run(1.0);
        stand.body
    };
    let exact = end(H / 16.0);
    let error = |h| {
        let body = end(h);
        ((body.pos_enu - exact.pos_enu).norm_squared()
            + (body.vel_enu - exact.vel_enu).norm_squared()
            + (body.rate_flu - exact.rate_flu).norm_squared()
            + (body.attitude.coords - exact.attitude.coords).norm_squared())
        .sqrt()
    };
    let (whole, half) = (error(H), error(0.5 * H));
    assert!(whole / half >= 12.0, "halving the step divides the error {whole:e} by {}", whole / half);
}

#[test]
fn a_tumbling_craft_without_air_keeps_energy_momentum_and_the_length_of_its_quaternion() {
    let mut stand = Stand::new(without_drag(Airframe::iris()), 5000.0, H);
    stand.body.rate_flu = Vector3::new(6.0, 0.5, 3.0);
    let (mass, inertia) = (stand.airframe.mass_kg, stand.airframe.inertia_kgm2);
    let energy = |body: &BodyState| {
        let turning = 0.5 * inertia.component_mul(&body.rate_flu).dot(&body.rate_flu);
        let moving = 0.5 * mass * body.vel_enu.norm_squared();
        [turning, moving + mass * 9.806_65 * body.pos_enu.z]
    };
    let momentum = |body: &BodyState| body.attitude * inertia.component_mul(&body.rate_flu);
    let (before, turn) = (energy(&stand.body), momentum(&stand.body));
    stand.run(20.0);
    let after = energy(&stand.body);
    let lost = [0, 1].map(|part| (after[part] / before[part] - 1.0).abs());
    let turned = (momentum(&stand.body) - turn).norm() / turn.norm();
    assert!(lost[0] < 1e-8 && lost[1] < 1e-12 && turned < 1e-8, "energy {lost:?}, momentum {turned}");
    assert!((stand.body.attitude.coords.norm() - 1.0).abs() < 1e-14);
}

#[test]
fn a_fall_onto_the_ground_ends_as_with_runge_kutta() {
    let fallen = |mut stand: Stand| {
        stand.body.rate_flu = Vector3::new(0.2, -0.3, 0.1);
        stand.body.vel_enu = Vector3::new(1.5, 0.0, 0.0);
        let mut hardest = 0.0_f64;
        for _ in 0..3000 {
            hardest = hardest.max(stand.specific_force().norm());
            stand.step();
        }
        (stand.body, hardest)
    };
    let stand = || Stand::new(Airframe::iris(), 3.0, H);
    let ((one, hard), (four, harder)) = (fallen(stand()), fallen(stand().by_runge_kutta()));
    assert!((one.pos_enu - four.pos_enu).norm() < 1e-4, "{one:?} instead of {four:?}");
    assert!(hard > 50.0 && (hard / harder - 1.0).abs() < 1e-3, "{hard} instead of {harder} m/s²");
    assert!(one.vel_enu.norm() < 1e-3 && one.pos_enu.z < 0.3, "it came to rest: {one:?}");
}

#[test]
fn a_push_in_flight_moves_a_craft_as_with_runge_kutta() {
    let pushed = |mut stand: Stand| {
        stand.rotors = [stand.airframe.hover_rotor_speed(); 4];
        for tick in 0..2000 {
            if tick == 1000 {
                stand.body.vel_enu += Vector3::new(3.0, -2.0, 1.0);
                stand.body.rate_flu += Vector3::new(1.0, 0.0, -2.0);
            }
            stand.command(control(&stand.body, TILTS[0]));
            stand.step();
        }
        stand.body
    };
    let (one, four) = (pushed(high_above_the_ground(H)), pushed(high_above_the_ground(H).by_runge_kutta()));
    let (way, turn) = ((one.pos_enu - four.pos_enu).norm(), one.attitude.angle_to(&four.attitude));
    assert!(way < 1e-6 && turn < 1e-6, "{way} m, {turn} rad");
}
