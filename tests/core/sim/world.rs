//! The world through its public interface: repeatability, sensor statistics, and the effect of each fault.

mod determinism;
mod docs;
mod faults;
mod gps_grades;
mod sensors;
mod slope;
mod standing;
mod terrain;

use betadeck_core::signals::MotorCommand;
use betadeck_core::sim::{Fault, Noise, World, WorldCommand, WorldConfig, WorldEventKind};

fn world(config: WorldConfig) -> World {
    World::new(config).expect("a world")
}

/// Returns a configuration with exact sensors, no wind and no profile.
fn ideal() -> WorldConfig {
    WorldConfig { noise: Noise::None, ..WorldConfig::default() }
}

/// Steps for a time with the motors stopped, calling `see` after each step.
fn stand(world: &mut World, seconds: f64, mut see: impl FnMut(&World)) {
    for _ in 0..(seconds * 1e6 / world.clock().step_us() as f64).round() as u64 {
        world.step(&MotorCommand::default());
        see(world);
    }
}

/// Steps for a time with four equal commands.
fn run(world: &mut World, seconds: f64, command: f64) {
    for _ in 0..(seconds * 1e6 / world.clock().step_us() as f64).round() as u64 {
        world.step(&MotorCommand([command; 4]));
    }
}

fn fault(text: &str) -> Fault {
    let (name, value) = text.split_once('=').map_or((text, None), |(name, value)| (name, Some(value)));
    Fault::parse(name, value).unwrap_or_else(|error| panic!("{error}"))
}

/// Starts a fault, for a time or until the end.
fn put_on(world: &mut World, text: &str, for_s: Option<f64>) {
    world.apply(WorldCommand::FaultOn(fault(text), for_s)).unwrap_or_else(|error| panic!("{error}"));
}

fn events(world: &mut World) -> Vec<WorldEventKind> {
    std::iter::from_fn(|| world.take_event()).map(|event| event.kind).collect()
}

/// Returns the mean and the standard deviation.
fn statistics(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
    (mean, variance.sqrt())
}
