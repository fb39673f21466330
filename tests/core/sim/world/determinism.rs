//! The same build, seed and inputs give the same bits, for any grouping of the steps and on any thread.

use std::hash::{DefaultHasher, Hasher};

use betadeck_core::signals::{MotorCommand, SensorFrame};
use betadeck_core::sim::{Noise, ScheduledFault, World, WorldConfig};
use betadeck_core::telemetry::Turbulence;

use crate::sim::world::{ideal, put_on, stand, world};

const STEPS: u64 = 12_000;

/// Returns a configuration with rough air, real sensors and faults on the way.
fn stormy(seed: u64) -> WorldConfig {
    let fault = |text: &str| text.parse::<ScheduledFault>().unwrap_or_else(|error| panic!("{error}"));
    WorldConfig {
        seed,
        noise: Noise::Real,
        wind: "6@230".parse().expect("a wind"),
        gust_mps: 3.0,
        turbulence: Turbulence::Moderate,
        faults: vec![
            fault("teleport@boot+1,,0,0,200"),
            fault("gps-glitch@boot+4,2"),
            fault("motor@boot+6,3,3:0.7"),
            fault("vibration@boot+2,3"),
        ],
        ..WorldConfig::default()
    }
}

/// Stands in for a flight controller: damps the rates of the gyro.
fn command(frame: &SensorFrame) -> MotorCommand {
    let rate = 0.02 * frame.rate_flu;
    let base = 0.53;
    MotorCommand([
        base - rate.x + rate.y,
        base - rate.x - rate.y,
        base + rate.x + rate.y,
        base + rate.x - rate.y,
    ])
}

fn advance(world: &mut World, steps: u64, hash: &mut DefaultHasher) {
    for _ in 0..steps {
        let next = command(world.sensors());
        world.step(&next);
        let truth = world.truth();
        if truth.time.0.is_multiple_of(10_000) {
            hash.write_u64(truth.time.0);
            let vectors = [truth.pos_enu, truth.vel_enu, truth.rate_flu, world.sensors().rate_flu];
            for value in vectors.iter().flatten().chain(&truth.attitude.coords).chain(&truth.rotor_speeds) {
                hash.write(&value.to_le_bytes());
            }
            if let Some(gps) = world.sensors().gps {
                hash.write_i32(gps.position.lat_e7);
                hash.write_u64(gps.vel_enu.x.to_bits());
            }
        }
    }
}

fn trace(config: WorldConfig, chunk: u64) -> u64 {
    let (mut world, mut hash) = (world(config), DefaultHasher::new());
    let mut left = STEPS;
    while left > 0 {
        let now = chunk.min(left);
        advance(&mut world, now, &mut hash);
        left -= now;
    }
    hash.finish()
}

#[test]
fn repeated_chunked_and_threaded_runs_are_equal() {
    let once = trace(stormy(1), STEPS);
    for chunk in [1, 7, 100, 4096] {
        assert_eq!(trace(stormy(1), chunk), once, "chunks of {chunk}");
    }
    let others: Vec<_> = (0..4).map(|_| std::thread::spawn(|| trace(stormy(1), 33))).collect();
    for other in others {
        assert_eq!(other.join().ok(), Some(once));
    }
    assert_ne!(trace(stormy(2), STEPS), once);
}

#[test]
fn a_thawed_world_goes_on_as_the_frozen_one() {
    let mut original = world(stormy(3));
    advance(&mut original, 4_321, &mut DefaultHasher::new());
    let mut thawed = original.clone();
    let finish = |world: &mut World| {
        let mut hash = DefaultHasher::new();
        advance(world, 5_000, &mut hash);
        (hash.finish(), format!("{world:?}"))
    };
    assert_eq!(finish(&mut original), finish(&mut thawed));
}

#[test]
fn the_seed_shows_in_the_gps_but_not_in_an_ideal_world() {
    let first_fix = |noise, seed| {
        let mut world = world(WorldConfig { seed, ..WorldConfig { noise, ..ideal() } });
        let mut fix = None;
        stand(&mut world, 5.0, |world| fix = fix.or(world.sensors().gps.filter(|gps| gps.fix)));
        fix.expect("a fix")
    };
    assert_ne!(first_fix(Noise::Real, 1), first_fix(Noise::Real, 2));
    assert_eq!(first_fix(Noise::None, 1), first_fix(Noise::None, 2));
    assert_eq!(trace(WorldConfig { seed: 1, ..ideal() }, 10), trace(WorldConfig { seed: 2, ..ideal() }, 10));
}

/// Returns all samples of one sensor of a craft on the ground.
fn samples<T>(config: WorldConfig, faults: &[&str], pick: impl Fn(&SensorFrame) -> Option<T>) -> Vec<T> {
    let mut world = world(config);
    for fault in faults {
        put_on(&mut world, fault, None);
    }
    let mut seen = Vec::new();
    stand(&mut world, 8.0, |world| seen.extend(pick(world.sensors())));
    seen
}

#[test]
fn one_source_of_noise_does_not_touch_the_others() {
    let gyro = |frame: &SensorFrame| Some(frame.rate_flu);
    let gps = |frame: &SensorFrame| frame.gps;
    let real = WorldConfig::default;
    let rough = || WorldConfig { turbulence: Turbulence::Light, ..real() };
    let plain = samples(real(), &[], gyro);
    assert_eq!(
        plain,
        samples(real(), &["gps-noise", "mag-off", "vibration", "baro-spike", "gps-loss"], gyro)
    );
    let plain = samples(real(), &[], gps);
    assert_eq!(
        plain,
        samples(real(), &["vibration", "gyro-bias", "mag-off", "imu-freeze", "baro-drift"], gps)
    );
    let pressures = |frame: &SensorFrame| frame.pressure_pa;
    assert_eq!(
        samples(real(), &[], pressures),
        samples(real(), &["gps-loss", "gps-noise", "vibration"], pressures)
    );
    // Rough air moves the craft on its legs by less than a count; another stream would differ by σ = 3 counts.
    let mag = |frame: &SensorFrame| frame.mag_flu;
    let (calm, moved) = (samples(real(), &[], mag), samples(rough(), &[], mag));
    assert!(
        calm.iter().zip(&moved).all(|(a, b)| (a - b).amax() < 2.0),
        "turbulence draws from its own stream"
    );
}

#[test]
fn the_air_is_the_same_for_every_rate() {
    // Not to the last bit: the craft sinks a little differently into its legs, and height and airspeed are inputs.
    let wind = |rate_hz| {
        let mut world =
            world(WorldConfig { rate_hz, turbulence: Turbulence::Light, gust_mps: 4.0, ..ideal() });
        let mut seen = Vec::new();
        stand(&mut world, 30.0, |world| {
            if world.time().0.is_multiple_of(10_000) {
                seen.push(world.truth().wind_enu);
            }
        });
        seen
    };
    let at_400 = wind(400);
    assert!(at_400.iter().any(|wind| wind.norm() > 1.0));
    for rate in [500, 1000, 2000, 4000, 8000] {
        let other = wind(rate);
        let worst = at_400.iter().zip(&other).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(other.len() == at_400.len() && worst < 1e-4, "{rate} Hz differs by {worst} m/s");
    }
}
