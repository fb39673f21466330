//! The speed of the plant: nanoseconds per tick at 1 kHz, and the ratio to a bare rigid-body loop.
//!
//! `cargo bench --bench plant`. Each figure is the median of several runs on one core. The bare loop is the minimum of
//! any plant: four evaluations of thrust, Newton, Euler and the quaternion equation per step, and nothing else.

#![allow(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a benchmark looks at the clock and prints"
)]

#[path = "support/bare_body.rs"]
mod bare_body;

use std::hint::black_box;
use std::time::Instant;

use betadeck::signals::MotorCommand;
use betadeck::sim::{Noise, World, WorldCommand, WorldConfig};
use betadeck::telemetry::Turbulence;

const TICKS: u32 = 400_000;
const RUNS: usize = 7;

fn main() {
    let bare = median(|| bare_body::ns_per_step(TICKS));
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
