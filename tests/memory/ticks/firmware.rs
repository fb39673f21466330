//! A step of the firmware allocates nothing between transitions, under manual control and under the
//! autopilot.

use betadeck::firmware::cli::Interpreter;
use betadeck::firmware::config::Configuration;
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::signals::{RcFrame, RcSource};
use betadeck::sim::{World, WorldConfig};

use crate::meter::allocations;

#[test]
fn a_step_without_an_event_allocates_nothing() {
    let mut configuration = Configuration::default();
    configuration.starter_modes();
    let mut firmware = Firmware::new(configuration, FirmwareOptions::default());
    let mut session = Interpreter::default();
    for line in [
        "set ap_hover_throttle = 1500",
        "set ap_rx_loss_policy = LAND",
        "waypoint insert 0 40.4636801 -79.5182000 1500 500 HOLD 50 ORBIT",
        "waypoint insert 1 40.4635000 -79.5180000 1000 500 FLYBY 0 NONE",
        "waypoint insert 2 40.4635000 -79.5182000 1000 500 HOLD 0 NONE",
    ] {
        assert!(!firmware.run_cli(&mut session, line).failed);
    }
    let mut world = World::new(WorldConfig::default()).unwrap();
    let mut sticks = RcFrame::SAFE;
    let (mut steps_with_events, mut allocated) = (0, 0);
    while world.time().as_secs_f64() < 90.0 {
        let now = world.time();
        let seconds = now.as_secs_f64();
        // Arms, climbs by hand, engages, and later loses the link.
        sticks.channels[4] = if seconds > 5.5 { 2000 } else { 1000 };
        sticks.channels[2] = if seconds > 8.0 {
            1500
        } else if seconds > 6.0 {
            1700
        } else {
            1000
        };
        sticks.channels[6] = if seconds > 7.0 { 2000 } else { 1000 };
        sticks.channels[5] = if seconds > 12.0 { 2000 } else { 1000 };
        if now.0.is_multiple_of(20_000) && seconds < 60.0 {
            firmware.receive_rc(&sticks, RcSource::Sticks);
        }
        let before = allocations();
        let command = firmware.step(world.sensors());
        let used = allocations() - before;
        let events = std::iter::from_fn(|| firmware.take_event()).count();
        if events == 0 {
            allocated += used;
        } else {
            steps_with_events += 1;
        }
        world.step(&command);
    }
    assert!(steps_with_events > 10, "the flight was flown: {steps_with_events}");
    assert_eq!(allocated, 0);
}
