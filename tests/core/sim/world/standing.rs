//! Minutes at rest on the ground.

use betadeck_core::signals::MotorCommand;
use betadeck_core::sim::{Airframe, Fault, World, WorldCommand, WorldConfig};

use super::{ideal, put_on, run};

/// Returns a craft `height` metres above its place on the ground.
fn lifted(config: WorldConfig, height: f64) -> World {
    let mut world = super::world(config);
    put_on(&mut world, &format!("teleport=0,0,{height}"), None);
    world
}

#[test]
fn it_does_not_move_in_the_wind_for_four_minutes() {
    let mut world = World::new(WorldConfig { wind: "20@230".parse().unwrap(), ..ideal() }).unwrap();
    let start = world.truth().pos_enu;
    run(&mut world, 240.0, 0.0);
    let truth = world.truth();
    assert!((truth.pos_enu - start).norm() < 1e-3, "{}", truth.pos_enu - start);
    assert!(truth.vel_enu.norm() < 1e-5);
    assert!(!truth.crashed && truth.on_ground);
    assert_eq!(world.take_event(), None);
}

#[test]
fn back_at_home_the_sensors_have_forgotten_where_the_craft_was() {
    // Only real sensors are late.
    let mut world = World::new(WorldConfig::default()).unwrap();
    run(&mut world, 60.0, 0.0);
    let at_home = world.truth().pos_enu;
    let home_pa = world.sensors().pressure_pa.unwrap();
    world.apply(WorldCommand::FaultOn(Fault::Teleport([200.0, 0.0, 40.0]), None)).unwrap();
    // A position is sent 10 ms after the reset.
    run(&mut world, 1.19, 0.0);
    world.reset_to_home();
    assert!((world.truth().pos_enu - at_home).norm() < 1e-3);
    let mut positions = 0;
    for _ in 0..500 {
        world.step(&MotorCommand::default());
        let frame = world.sensors();
        if let Some(gps) = frame.gps {
            assert!(gps.fix);
            let north_m = f64::from(gps.position.lat_e7 - 404_635_000) * 0.0111;
            assert!(north_m.abs() < 50.0, "{north_m} m at {:?}", frame.time);
            positions += 1;
        }
        let lost_pa = frame.pressure_pa.map_or(0.0, |now_pa| home_pa - now_pa);
        assert!(lost_pa.abs() < 100.0, "{lost_pa} Pa at {:?}", frame.time);
    }
    assert!(positions >= 2);
}

#[test]
fn the_built_in_craft_stand_still_at_every_step_with_moments_of_inertia_twenty_per_cent_off() {
    for airframe in [Airframe::iris(), Airframe::five_inch()] {
        for (inertia, mass) in [(0.8, 0.8), (0.8, 1.2), (1.2, 0.8), (1.2, 1.2)] {
            for rate_hz in [400, 1000] {
                let mut airframe = airframe.clone();
                airframe.inertia_kgm2 *= inertia;
                airframe.mass_kg *= mass;
                let name = format!("{} {inertia} {mass} {rate_hz}", airframe.name);
                let mut world = lifted(WorldConfig { airframe, rate_hz, ..ideal() }, 0.02);
                run(&mut world, 5.0, 0.0);
                let truth = world.truth();
                assert!(!truth.diverged, "{name}");
                assert!(truth.on_ground && truth.vel_enu.norm() < 1e-3, "{name}: {}", truth.vel_enu);
                assert!(truth.rate_flu.norm() < 1e-3, "{name}: {}", truth.rate_flu);
            }
        }
    }
}
