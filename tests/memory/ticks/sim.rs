//! One step of the world allocates nothing, whatever happens in it.

use std::sync::Arc;

use betadeck::signals::MotorCommand;
use betadeck::sim::{Fault, Noise, World, WorldCommand, WorldConfig};
use betadeck::telemetry::Turbulence;
use betadeck::terrain::{Grid, Samples, Square, Tiles};

use crate::meter::allocations;

#[test]
fn a_flight_with_faults_wind_and_a_crash_allocates_nothing() {
    let faults = [
        "gps-loss@boot+1,1",
        "gps-glitch@boot+2,1",
        "gyro-bias@boot+2,1",
        "wind@boot+1,2,9@0",
        "gust@boot+1",
        "push@boot+3",
        "teleport@boot+1,,1,2,30",
        "payload@boot+2,1,0.1",
        "motor@boot+5,,2:0",
        "vibration@boot+2",
        "prop-imbalance@boot+2",
        "battery@boot+2",
        "baro-spike@boot+2",
        "imu-freeze@boot+4,0.5",
        "rx-loss@2,1",
    ];
    let mut world = World::new(WorldConfig {
        noise: Noise::Real,
        turbulence: Turbulence::Severe,
        wind: "7@200".parse().expect("a wind"),
        gust_mps: 4.0,
        faults: faults.iter().map(|text| text.parse().expect(text)).collect(),
        ..WorldConfig::default()
    })
    .expect("a world");
    let hover = world.airframe().hover_rotor_speed() / world.airframe().rotor_speed_max;
    let mut events = 0;
    let before = allocations();
    for step in 0..20_000_u32 {
        if step == 100 {
            let now = world.time();
            world.clock_mut().set_engaged(now);
        }
        let command = if step % 1000 == 7 { f64::NAN } else { hover };
        world.set_added_wind([f64::from(step % 9), 0.0, -1.0].into()).expect("a wind");
        world.step(&MotorCommand([command; 4]));
        while world.take_event().is_some() {
            events += 1;
        }
    }
    assert_eq!(allocations(), before, "steps allocate");
    assert!(world.truth().crashed && events > 20, "{events} events");
}

#[test]
fn a_flight_over_elevation_tiles_allocates_nothing() {
    let side = 1201;
    let step_deg = 1.0 / 1200.0;
    let grid = Grid {
        rows: side,
        cols: side,
        north_deg: 41.0,
        west_deg: -80.0,
        lat_step_deg: step_deg,
        lon_step_deg: step_deg,
        samples: Samples::Metres((0..side * side).map(|index| (index % side) as i16).collect()),
    };
    let mut tiles = Tiles::default();
    tiles.insert(Square { lat_deg: 40, lon_deg: -80 }, grid);
    let mut config = WorldConfig { terrain: Some(Arc::new(tiles)), ..WorldConfig::default() };
    config.switches.set("ground=terrain").expect("a switch");
    config.switches.set("ground_effect=on").expect("a switch");
    let mut world = World::new(config).expect("a world");
    let hover = world.airframe().hover_rotor_speed() / world.airframe().rotor_speed_max;
    let before = allocations();
    for step in 0..6000_u32 {
        let command = if step < 2000 { 1.1 * hover } else { 0.5 * hover };
        world.step(&MotorCommand([command; 4]));
        while world.take_event().is_some() {}
    }
    assert_eq!(allocations(), before, "steps allocate");
    assert!(world.truth().on_ground || world.truth().crashed, "{:?}", world.truth().pos_enu);
}

#[test]
fn commands_that_carry_no_text_allocate_nothing() {
    let mut world = World::new(WorldConfig::default()).expect("a world");
    let before = allocations();
    for command in [
        WorldCommand::SetWind("3@20".parse().expect("a wind")),
        WorldCommand::SetTurbulence(Turbulence::Light),
        WorldCommand::SetGust(3.0),
        WorldCommand::FaultOff(Fault::GpsLoss.key()),
        WorldCommand::ResetToHome,
    ] {
        assert!(world.apply(command).is_ok());
    }
    assert_eq!(allocations(), before);
}
