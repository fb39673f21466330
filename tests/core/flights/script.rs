//! The guide's RC script. It holds the ARM switch on and the throttle at 1100 from its first packet.

use crate::flights::rig::{guide_settings, world};
use betadeck_core::firmware::cli::Interpreter;
use betadeck_core::firmware::config::Configuration;
use betadeck_core::firmware::{Firmware, FirmwareOptions};
use betadeck_core::signals::{RcFrame, RcSource, SimTime};
use betadeck_core::sim::World;
use betadeck_core::telemetry::NavState;

const MODES_AND_PLAN: &str = "
aux 0 0 0 1700 2100 0 0
aux 1 56 1 1700 2100 0 0
waypoint insert 0 40.4640000 -79.5175000 5000 0 FLYOVER 0 ORBIT
waypoint insert 1 40.4630000 -79.5175000 5000 0 FLYBY 0 ORBIT
waypoint insert 2 40.4630000 -79.5190000 5000 0 HOLD 300 ORBIT
waypoint insert 3 40.4640000 -79.5190000 5000 0 LAND 0 ORBIT";

/// Returns the script's packet `n`, 20 ms after the one before.
fn packet(n: u64) -> RcFrame {
    let mut channels = [1500; 16];
    channels[4] = 2000;
    channels[2] = if n < 100 { 1100 } else { 1500 };
    if n >= 300 {
        channels[5] = 2000;
    }
    RcFrame { channels }
}

struct Bench {
    firmware: Firmware,
    world: World,
}

impl Bench {
    fn new(arm_assist: bool) -> Self {
        let options = FirmwareOptions { arm_assist, ..FirmwareOptions::default() };
        let mut firmware = Firmware::new(Configuration::default(), options);
        let mut session = Interpreter::default();
        for line in guide_settings().chain(MODES_AND_PLAN.lines()) {
            assert!(!firmware.run_cli(&mut session, line).failed, "{line}");
        }
        Self { firmware, world: World::new(world(1).0).unwrap() }
    }

    /// Runs until `end`. The script starts at `start`.
    fn run(&mut self, start: f64, end: f64, mut look: impl FnMut(&Firmware)) {
        let start = SimTime::from_secs_f64(start);
        while self.world.time() < SimTime::from_secs_f64(end) {
            let now = self.world.time();
            if now >= start && (now.0 - start.0).is_multiple_of(20_000) {
                self.firmware.receive_rc(&packet((now.0 - start.0) / 20_000), RcSource::Udp);
            }
            let command = self.firmware.step(self.world.sensors());
            self.world.step(&command);
            look(&self.firmware);
        }
    }
}

#[test]
fn with_assist_the_script_arms_and_flies_the_mission() {
    let mut bench = Bench::new(true);
    let (mut armed_at, mut states) = (None, Vec::new());
    bench.run(5.5, 260.0, |firmware| {
        if firmware.is_armed() && armed_at.is_none() {
            armed_at = Some(firmware.time().as_secs_f64());
        }
        let state = firmware.nav().state;
        if states.last() != Some(&state) {
            states.push(state);
        }
    });
    let armed_at = armed_at.unwrap();
    assert!((5.95..6.15).contains(&armed_at), "{armed_at}");
    assert!(states.ends_with(&[NavState::Landing, NavState::Complete]), "{states:?}");
    assert!(!bench.firmware.is_armed());
}

#[test]
fn without_assist_three_rules_refuse_the_script() {
    let mut bench = Bench::new(false);
    bench.run(5.5, 12.0, |firmware| assert!(!firmware.is_armed()));
    let flags: Vec<_> = bench.firmware.arming_flags().iter().map(|flag| flag.to_string()).collect();
    assert_eq!(flags, ["NOT_DISARMED", "THROTTLE", "AUTOPILOT_SW", "ARM_SWITCH"]);
}
