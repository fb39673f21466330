//! The speed of the plant: nanoseconds per tick at 1 kHz, and the ratio to a bare rigid-body loop.
//!
//! `cargo bench --bench plant`. Each figure is the median of several runs on one core. The bare loop is the minimum of
//! any plant: four evaluations of thrust, Newton, Euler and the quaternion equation per step, and nothing else.

#![allow(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a benchmark looks at the clock and prints"
)]

use std::hint::black_box;
use std::time::Instant;

use betadeck::signals::MotorCommand;
use betadeck::sim::{Airframe, Noise, World, WorldCommand, WorldConfig};
use betadeck::telemetry::Turbulence;
use nalgebra::{Quaternion, Vector3};

const TICKS: u32 = 400_000;
const RUNS: usize = 7;

fn main() {
    let bare = median(bare_loop);
    println!("{:<44} {bare:>7.1} ns/tick", "bare rigid body, RK4");
    for (name, config) in [
        ("plant, ideal sensors, calm", world(Noise::None, Turbulence::None, "calm")),
        ("plant, real sensors, calm", world(Noise::Real, Turbulence::None, "calm")),
        ("plant, real sensors, wind, light turbulence", world(Noise::Real, Turbulence::Light, "5@270")),
    ] {
        let tick = median(|| fly(&config));
        println!("{name:<44} {tick:>7.1} ns/tick  {:>5.2} x bare", tick / bare);
    }
    let standing = median(|| stand(&world(Noise::Real, Turbulence::Light, "5@270")));
    println!(
        "{:<44} {standing:>7.1} ns/tick  {:>5.2} x bare",
        "the same, standing on the ground",
        standing / bare
    );
}

fn median(mut run: impl FnMut() -> f64) -> f64 {
    let mut times: Vec<f64> = (0..RUNS).map(|_| run()).collect();
    times.sort_by(f64::total_cmp);
    times[RUNS / 2]
}

fn per_tick(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e9 / f64::from(TICKS)
}

fn world(noise: Noise, turbulence: Turbulence, wind: &str) -> WorldConfig {
    WorldConfig {
        noise,
        turbulence,
        wind: wind.parse().unwrap_or(betadeck::sim::Wind::CALM),
        ..WorldConfig::default()
    }
}

/// Flies a craft that is held level at 2 km by a rate and attitude damper, which is much cheaper than the plant.
fn fly(config: &WorldConfig) -> f64 {
    let Ok(mut world) = World::new(config.clone()) else { return f64::NAN };
    let high = betadeck::sim::Fault::Teleport([0.0, 0.0, 2000.0]);
    if world.apply(WorldCommand::FaultOn(high, None)).is_err() {
        return f64::NAN;
    }
    let hover = 1.1 * world.airframe().hover_rotor_speed() / world.airframe().rotor_speed_max;
    let start = Instant::now();
    for _ in 0..TICKS {
        let truth = world.truth();
        let q = truth.attitude.quaternion();
        let roll = -0.02 * truth.rate_flu.x - 0.1 * q.i;
        let pitch = -0.02 * truth.rate_flu.y - 0.1 * q.j;
        let climb = -0.02 * truth.vel_enu.z;
        let base = hover + climb;
        let command = [base - roll + pitch, base - roll - pitch, base + roll + pitch, base + roll - pitch];
        world.step(black_box(&MotorCommand(command)));
    }
    let time = per_tick(start);
    black_box(world.sensors());
    if world.truth().crashed || world.truth().diverged { f64::NAN } else { time }
}

fn stand(config: &WorldConfig) -> f64 {
    let Ok(mut world) = World::new(config.clone()) else { return f64::NAN };
    let start = Instant::now();
    for _ in 0..TICKS {
        world.step(black_box(&MotorCommand([0.05; 4])));
    }
    let time = per_tick(start);
    black_box(world.sensors());
    time
}

/// The state of the bare loop: position, velocity, attitude, body rates.
#[derive(Clone, Copy)]
struct Bare {
    p: Vector3<f64>,
    v: Vector3<f64>,
    q: Quaternion<f64>,
    w: Vector3<f64>,
}

fn bare_loop() -> f64 {
    let airframe = Airframe::iris();
    let h = 0.001;
    let mut state =
        Bare { p: Vector3::zeros(), v: Vector3::zeros(), q: Quaternion::identity(), w: Vector3::zeros() };
    let speed = airframe.hover_rotor_speed();
    let start = Instant::now();
    for tick in 0..TICKS {
        let wobble = if tick & 64 == 0 { 0.1 } else { -0.1 };
        let speeds = black_box([speed + wobble, speed - wobble, speed - wobble, speed + wobble]);
        let k1 = bare_slope(&airframe, &state, &speeds);
        let k2 = bare_slope(&airframe, &bare_along(&state, &k1, 0.5 * h), &speeds);
        let k3 = bare_slope(&airframe, &bare_along(&state, &k2, 0.5 * h), &speeds);
        let k4 = bare_slope(&airframe, &bare_along(&state, &k3, h), &speeds);
        for (slope, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            state = bare_along(&state, &slope, weight * h / 6.0);
        }
        state.q /= state.q.norm();
    }
    let time = per_tick(start);
    black_box(state.p);
    time
}

fn bare_along(state: &Bare, slope: &Bare, dt: f64) -> Bare {
    Bare {
        p: state.p + slope.p * dt,
        v: state.v + slope.v * dt,
        q: state.q + slope.q * dt,
        w: state.w + slope.w * dt,
    }
}

fn bare_slope(airframe: &Airframe, state: &Bare, speeds: &[f64; 4]) -> Bare {
    let mut thrust = 0.0;
    let mut torque = Vector3::zeros();
    let rotors = airframe.rotor_positions_m.iter().zip(&airframe.spin_sign).zip(speeds);
    for ((arm, spin), speed) in rotors {
        let t = airframe.thrust_coeff * speed * speed;
        thrust += t;
        torque.x += arm.y * t;
        torque.y -= arm.x * t;
        torque.z -= spin * airframe.torque_per_thrust_m * t;
    }
    let q = &state.q;
    let up = Vector3::new(
        2.0 * (q.i * q.k + q.w * q.j),
        2.0 * (q.j * q.k - q.w * q.i),
        1.0 - 2.0 * (q.i * q.i + q.j * q.j),
    );
    let j = &airframe.inertia_kgm2;
    let momentum = j.component_mul(&state.w);
    Bare {
        p: state.v,
        v: up * (thrust / airframe.mass_kg) - Vector3::z() * 9.806_65,
        q: state.q * Quaternion::from_imag(state.w * 0.5),
        w: (torque - state.w.cross(&momentum)).component_div(j),
    }
}
