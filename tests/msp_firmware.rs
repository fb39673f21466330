//! Messages to a running firmware.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use betadeck::firmware::config::Configuration;
use betadeck::firmware::msp::{MspAction, UtcTime};
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::geo::LatLon;
use betadeck::signals::{BatterySample, GpsSample, MotorCommand, SensorFrame, SimTime};
use nalgebra::Vector3;

/// A firmware on a bench under an open sky.
struct Bench {
    firmware: Firmware,
    now_ms: u64,
    motors: MotorCommand,
}

impl Bench {
    fn new() -> Self {
        let mut configuration = Configuration::default();
        configuration.starter_modes();
        Self {
            firmware: Firmware::new(configuration, FirmwareOptions::default()),
            now_ms: 0,
            motors: MotorCommand::default(),
        }
    }

    /// Lets time pass; a stick position goes out every 20 ms.
    fn run(&mut self, ms: u64, sticks: Option<&[u16]>) {
        for _ in 0..ms {
            if let Some(sticks) = sticks.filter(|_| self.now_ms.is_multiple_of(20)) {
                let payload: Vec<u8> = sticks.iter().flat_map(|pulse| pulse.to_le_bytes()).collect();
                assert!(self.ask(200, &payload).is_some());
            }
            let gps = GpsSample {
                fix: true,
                sats: 12,
                position: LatLon::new(404_635_000, -795_182_000),
                alt_amsl_cm: 30_000,
                hdop: 0.8,
                ..GpsSample::default()
            };
            let battery = BatterySample { voltage_v: 16.0, current_a: 0.5, drawn_mah: 10.0 };
            self.motors = self.firmware.step(&SensorFrame {
                time: SimTime(self.now_ms * 1000),
                pressure_pa: (self.now_ms.is_multiple_of(20)).then_some(101_325.0),
                mag_flu: (self.now_ms.is_multiple_of(10)).then_some(Vector3::new(0.0, -2046.8, -3547.2)),
                gps: (self.now_ms.is_multiple_of(100)).then_some(gps),
                battery: (self.now_ms.is_multiple_of(20)).then_some(battery),
                ..SensorFrame::default()
            });
            self.now_ms += 1;
        }
    }

    fn ask(&mut self, code: u16, request: &[u8]) -> Option<Vec<u8>> {
        self.firmware.run_msp(code, request, None).reply
    }
}

const IDLE: [u16; 5] = [1500, 1500, 1000, 1500, 1000];
const ARM: [u16; 5] = [1500, 1500, 1000, 1500, 1800];

#[test]
fn a_craft_tells_what_it_senses() {
    let mut bench = Bench::new();
    bench.run(3000, None);
    let gps = bench.ask(106, &[]).unwrap();
    assert_eq!(gps[..2], [2, 12]);
    assert_eq!(i32::from_le_bytes(gps[2..6].try_into().unwrap()), 404_635_000);
    assert_eq!(u16::from_le_bytes([gps[10], gps[11]]), 300, "metres above the sea");
    let imu = bench.ask(102, &[]).unwrap();
    assert_eq!(i16::from_le_bytes([imu[4], imu[5]]), 256, "1 g");
    assert_eq!(i16::from_le_bytes([imu[14], imu[15]]), -2047, "the field as sensed");
    assert_eq!(bench.ask(130, &[]).unwrap()[0], 4, "cells");
    let clock = Some(UtcTime { unix_s: 0, millis: 0 });
    assert_eq!(bench.firmware.run_msp(247, &[], clock).reply.unwrap()[..2], [0xb2, 7], "1970");
}

#[test]
fn rc_by_messages_arms_the_craft_and_saving_is_refused_then() {
    let mut bench = Bench::new();
    bench.run(6000, Some(&IDLE));
    let blocked = |status: &[u8]| u32::from_le_bytes(status[17..21].try_into().unwrap());
    assert_eq!(blocked(&bench.ask(101, &[]).unwrap()), 0);
    assert_eq!(bench.firmware.run_msp(250, &[], None).action, Some(MspAction::Save));
    bench.run(200, Some(&ARM));
    assert!(bench.firmware.is_armed());
    assert_eq!(bench.ask(101, &[]).unwrap()[6] & 1, 1, "the first mode bit");
    let rc = bench.ask(105, &[]).unwrap();
    assert_eq!(rc[6..8], 1000_u16.to_le_bytes(), "the throttle is the fourth");
    assert_eq!(rc[8..10], 1800_u16.to_le_bytes());
    assert_eq!(bench.firmware.run_msp(250, &[], None).reply, None);
    bench.run(400, None);
    assert_eq!(blocked(&bench.ask(101, &[]).unwrap()), 0, "armed: nothing is blocked");
}

#[test]
fn motors_turn_on_the_bench_only() {
    let mut bench = Bench::new();
    bench.run(6000, Some(&IDLE));
    let payload: Vec<u8> =
        [1100_u16, 1200, 1300, 1400, 0, 0, 0, 0].iter().flat_map(|us| us.to_le_bytes()).collect();
    assert!(bench.ask(214, &payload).is_some());
    bench.run(2, None);
    assert_eq!(bench.motors.0.map(|motor| (motor * 1000.0).round()), [100.0, 200.0, 300.0, 400.0]);
    assert_eq!(bench.ask(104, &[]).unwrap()[2..4], 1200_u16.to_le_bytes());
    let stop: Vec<u8> = [1000_u16; 8].iter().flat_map(|us| us.to_le_bytes()).collect();
    assert!(bench.ask(214, &stop).is_some());
    bench.run(2, None);
    assert_eq!(bench.motors, MotorCommand::default());
}

#[test]
fn a_written_setting_is_in_force_at_once() {
    let mut bench = Bench::new();
    bench.run(100, None);
    assert_ne!(bench.firmware.parameters().nav.max_angle, 33);
    assert!(bench.ask(225, &[33, 0]).is_some());
    assert_eq!(bench.firmware.parameters().nav.max_angle, 33);
    assert!(bench.ask(35, &[6, 13, 5, 16, 32]).is_some());
    assert_eq!(bench.firmware.configuration().modes[6].box_id, 13);
}
