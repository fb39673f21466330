//! The target of airframe files.

use betadeck::signals::MotorCommand;
use betadeck::sim::{Airframe, World, WorldConfig};

/// Reads the text. A craft that is accepted can be on the ground and climb.
pub fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match Airframe::from_toml(text) {
        Ok(airframe) => assert_flies(airframe),
        Err(error) => {
            let lines = text.lines().count().max(1);
            assert!(!error.problems.is_empty() && !error.in_file("a.toml").is_empty());
            for problem in &error.problems {
                assert!((1..=lines + 1).contains(&problem.line) && problem.column >= 1, "{problem}");
            }
        }
    }
}

fn assert_flies(airframe: Airframe) {
    let name = airframe.name.clone();
    let mut world = World::new(WorldConfig { airframe, rate_hz: 400, ..WorldConfig::default() })
        .unwrap_or_else(|error| panic!("{name} reads but does not fly: {error}"));
    for command in [0.0, 1.0, 0.3] {
        for _ in 0..40 {
            world.step(&MotorCommand([command; 4]));
        }
        let truth = world.truth();
        let numbers =
            truth.pos_enu.iter().chain(&truth.vel_enu).chain(&truth.rate_flu).chain(&truth.rotor_speeds);
        assert!(numbers.chain(&truth.specific_force_flu).all(|number| number.is_finite()), "{truth:?}");
        let sensors = world.sensors();
        assert!(sensors.rate_flu.iter().chain(&sensors.specific_force_flu).all(|number| number.is_finite()));
    }
}
