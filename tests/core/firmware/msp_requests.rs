//! MSP messages to a running firmware.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use betadeck_core::firmware::cli::Interpreter;
use betadeck_core::firmware::config::Configuration;
use betadeck_core::firmware::msp::{MspAction, UtcTime};
use betadeck_core::firmware::{Firmware, FirmwareOptions};
use betadeck_core::geo::LatLon;
use betadeck_core::signals::{BatterySample, GpsSample, MotorCommand, SensorFrame, SimTime};
use betadeck_core::telemetry::{DisarmReason, FirmwareEvent};
use nalgebra::{UnitQuaternion, Vector3};

/// A firmware on a bench, with a GPS fix.
struct Bench {
    firmware: Firmware,
    now_ms: u64,
    motors: MotorCommand,
    /// Errors added to the readings of the sensors.
    rate_error: Vector3<f64>,
    force_error: Vector3<f64>,
    mag_error: Vector3<f64>,
    /// `true` while the craft is turned about all axes by hand.
    tumbling: bool,
}

/// Bits of the arming disable flags.
const CALIB: u32 = 1 << 12;
const CRASH: u32 = 1 << 6;
const ARM_SWITCH: u32 = 1 << 29;
const REBOOT_REQD: u32 = 1 << 21;
const MOTOR_PROTO: u32 = 1 << 24;

impl Bench {
    fn new() -> Self {
        let mut configuration = Configuration::default();
        configuration.starter_modes();
        Self {
            firmware: Firmware::new(configuration, FirmwareOptions::default()),
            now_ms: 0,
            motors: MotorCommand::default(),
            rate_error: Vector3::zeros(),
            force_error: Vector3::zeros(),
            mag_error: Vector3::zeros(),
            tumbling: false,
        }
    }

    /// Runs the firmware for `ms` milliseconds and sends the stick position, if there is one, every 20 ms.
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
            let t = if self.tumbling { self.now_ms as f64 * 0.001 } else { 0.0 };
            let field = UnitQuaternion::from_euler_angles(1.3 * t, 0.9 * t, 0.4 * t) * FIELD + self.mag_error;
            self.motors = self.firmware.step(&SensorFrame {
                time: SimTime(self.now_ms * 1000),
                rate_flu: self.rate_error,
                specific_force_flu: Vector3::new(0.0, 0.0, 9.80665) + self.force_error,
                pressure_pa: (self.now_ms.is_multiple_of(20)).then_some(101_325.0),
                mag_flu: (self.now_ms.is_multiple_of(10)).then_some(field),
                gps: (self.now_ms.is_multiple_of(100)).then_some(gps),
                battery: (self.now_ms.is_multiple_of(20)).then_some(battery),
                ..SensorFrame::default()
            });
            self.now_ms += 1;
        }
    }

    /// Returns the arming disable flags as a client reads them.
    fn blocked(&mut self) -> u32 {
        u32::from_le_bytes(self.ask(101, &[]).unwrap()[17..21].try_into().unwrap())
    }

    fn ask(&mut self, code: u16, request: &[u8]) -> Option<Vec<u8>> {
        self.firmware.run_msp(code, request, None).reply
    }
}

/// The magnetic field on the body axes of a level craft.
const FIELD: Vector3<f64> = Vector3::new(0.0, -2046.8, -3547.2);
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

#[test]
fn an_accelerometer_calibration_levels_the_craft_and_is_kept() {
    let mut bench = Bench::new();
    bench.run(6000, Some(&IDLE));
    // The accelerometer has an error: it measures a level craft as tilted.
    bench.force_error = Vector3::new(0.0, -0.5, 0.0);
    bench.run(3000, Some(&IDLE));
    assert!(bench.firmware.estimate().roll_rad.abs() > 0.04, "{}", bench.firmware.estimate().roll_rad);
    for line in ["set acc_trim_roll = 30", "set acc_trim_pitch = -20"] {
        assert!(!bench.firmware.run_cli(&mut Interpreter::default(), line).failed);
    }
    assert!(bench.ask(205, &[]).is_some());
    bench.run(60, Some(&IDLE));
    assert_eq!(bench.blocked(), CALIB, "calibrating blocks arming");
    bench.run(8000, Some(&IDLE));
    assert_eq!(bench.blocked(), 0);
    assert!(bench.firmware.estimate().roll_rad.abs() < 0.002, "{}", bench.firmware.estimate().roll_rad);
    let settings = &bench.firmware.configuration().settings;
    assert_eq!(settings.array("acc_calibration"), [0, -104, 0, 1]);
    assert_eq!((settings.number("acc_trim_roll"), settings.number("acc_trim_pitch")), (0, 0));
    bench.run(200, Some(&ARM));
    assert!(bench.ask(205, &[]).is_some());
    bench.run(60, Some(&ARM));
    assert!(!bench.firmware.estimate().calibrating, "acknowledged and ignored while armed");
}

#[test]
fn a_magnetometer_calibration_takes_the_offset_out() {
    let mut bench = Bench::new();
    bench.mag_error = Vector3::new(900.0, 0.0, 0.0);
    bench.run(6000, Some(&IDLE));
    let wrong = bench.firmware.estimate().heading_rad;
    assert!(bench.ask(206, &[]).is_some());
    bench.run(60, Some(&IDLE));
    assert_eq!(bench.blocked(), CALIB);
    bench.tumbling = true;
    bench.run(31_000, Some(&IDLE));
    bench.tumbling = false;
    bench.run(6000, Some(&IDLE));
    assert_eq!(bench.blocked() & CALIB, 0);
    let found = bench.firmware.configuration().settings.array("mag_calibration").to_vec();
    for (axis, wanted) in found.iter().zip([900, 0, 0]) {
        assert!((axis - wanted).abs() <= 2, "{found:?}");
    }
    let right = bench.firmware.estimate().heading_rad;
    assert!((right - wrong).sin().abs() > 0.2, "{wrong} {right}");
    let imu = bench.ask(102, &[]).unwrap();
    assert!(i16::from_le_bytes([imu[12], imu[13]]).abs() <= 3, "clients see the calibrated field");
    // A craft that does not move keeps its offsets.
    assert!(bench.ask(206, &[]).is_some());
    bench.run(31_000, Some(&IDLE));
    assert_eq!(bench.firmware.configuration().settings.array("mag_calibration"), found);
    assert_eq!(bench.blocked(), 0);
}

#[test]
fn a_change_that_needs_a_restart_blocks_arming_until_then() {
    let mut bench = Bench::new();
    bench.run(6000, Some(&IDLE));
    let features = bench.ask(36, &[]).unwrap();
    assert!(bench.ask(37, &(1_u32 << 4).to_le_bytes()).is_some());
    bench.run(40, Some(&IDLE));
    assert_eq!(bench.blocked(), REBOOT_REQD);
    assert_eq!(bench.ask(101, &[]).unwrap()[21], 1, "the status says so, too");
    assert!(bench.ask(37, &features).is_some());
    bench.run(40, Some(&IDLE));
    assert_eq!(bench.blocked(), 0, "taken back");
    for (line, blocks) in [
        ("set max_aux_channels = 8", true),
        ("map TAER1234", false),
        ("mixer quadp", true),
        ("serial UART2 1 115200 57600 0 115200", true),
        ("set ap_max_angle = 20", false),
        ("set p_roll = 50", false),
        ("aux 9 13 5 1700 2100", false),
    ] {
        let mut bench = Bench::new();
        bench.run(6000, Some(&IDLE));
        assert!(!bench.firmware.run_cli(&mut Interpreter::default(), line).failed, "{line}");
        bench.run(40, Some(&IDLE));
        assert_eq!(bench.blocked() & REBOOT_REQD, if blocks { REBOOT_REQD } else { 0 }, "{line}");
        bench.firmware.restart_in_place();
        bench.run(6000, Some(&IDLE));
        assert_eq!(bench.blocked() & REBOOT_REQD, 0, "{line}");
    }
}

#[test]
fn a_disabled_motor_protocol_blocks_arming_from_the_next_boot_on() {
    for (protocol, blocks) in [("DISABLED", true), ("DSHOT600", false), ("PWM", false)] {
        let mut bench = Bench::new();
        let line = format!("set motor_pwm_protocol = {protocol}");
        assert!(!bench.firmware.run_cli(&mut Interpreter::default(), &line).failed);
        bench.firmware.restart_in_place();
        bench.run(6000, Some(&IDLE));
        assert_eq!(bench.blocked(), if blocks { MOTOR_PROTO } else { 0 }, "{protocol}");
    }
}

#[test]
fn the_first_arming_calibrates_the_gyro_when_asked_to() {
    let mut bench = Bench::new();
    assert!(!bench.firmware.run_cli(&mut Interpreter::default(), "set gyro_cal_on_first_arm = ON").failed);
    bench.run(6000, Some(&IDLE));
    // The gyro has drifted since boot.
    bench.rate_error = Vector3::new(0.0, 0.0, 0.02);
    bench.run(40, Some(&IDLE));
    assert!((bench.firmware.estimate().rates.yaw + 0.02).abs() < 0.005);
    bench.run(60, Some(&ARM));
    assert!(!bench.firmware.is_armed());
    assert_eq!(bench.blocked(), CALIB);
    bench.run(1400, Some(&ARM));
    assert!(bench.firmware.is_armed(), "the switch stayed on");
    assert!(bench.firmware.estimate().rates.yaw.abs() < 0.002);
}

const FULL_ROLL: [u16; 5] = [1700, 1500, 1500, 1500, 1800];

/// Returns a craft in acro with these settings and full roll stick, a tenth of a second after it hit a branch. The
/// branch threw it about all axes at once, and it goes on turning (forward-left-up, rad/s).
fn crashed(settings: &[&str], turning: Vector3<f64>) -> Bench {
    let mut bench = Bench::new();
    for setting in settings.iter().chain(&["runaway_takeoff_prevention = OFF"]) {
        let line = format!("set {setting}");
        assert!(!bench.firmware.run_cli(&mut Interpreter::default(), &line).failed, "{line}");
    }
    bench.run(6000, Some(&IDLE));
    bench.run(200, Some(&ARM));
    bench.run(500, Some(&[1500, 1500, 1500, 1500, 1800]));
    assert!(bench.firmware.is_armed());
    bench.rate_error = Vector3::new(15.0, -15.0, 12.0);
    bench.run(3, Some(&FULL_ROLL));
    bench.rate_error = turning;
    bench.run(100, Some(&FULL_ROLL));
    bench
}

#[test]
fn a_crash_disarms_or_levels_where_asked_for() {
    for (action, disarms, levels) in [("OFF", false, false), ("ON", false, true), ("DISARM", true, false)] {
        let mut bench = crashed(&[&format!("crash_recovery = {action}")], Vector3::new(3.0, 0.0, 0.0));
        assert_eq!(bench.firmware.is_armed(), !disarms, "{action}");
        if disarms {
            assert_eq!(bench.firmware.last_disarm(), Some(DisarmReason::CrashProtection));
            assert_eq!(bench.blocked() & (CRASH | ARM_SWITCH), CRASH | ARM_SWITCH, "the switch is still on");
            bench.run(60, Some(&IDLE));
            assert_eq!(bench.blocked() & (CRASH | ARM_SWITCH), 0, "switched off");
        } else {
            // In acro the stick commands a rate to the right; levelling turns the other way.
            assert_eq!(bench.firmware.control().setpoint_dps[0] < 0.0, levels, "{action}");
        }
    }
}

#[test]
fn after_a_crash_both_axes_are_levelled_whatever_race_mode_says() {
    let race = ["crash_recovery = ON", "level_race_mode = ON"];
    let bench = crashed(&race, Vector3::new(0.0, 3.0, 0.0));
    let setpoint = bench.firmware.control().setpoint_dps;
    assert!(setpoint[1].abs() > 20.0, "{setpoint:?}");
}

#[test]
fn levelling_after_a_crash_ends_when_it_is_switched_off() {
    let mut bench = crashed(&["crash_recovery = ON"], Vector3::new(3.0, 0.0, 0.0));
    assert!(bench.firmware.control().setpoint_dps[0] < 0.0);
    let off = bench.firmware.run_cli(&mut Interpreter::default(), "set crash_recovery = OFF");
    assert!(!off.failed);
    bench.run(100, Some(&FULL_ROLL));
    assert!(bench.firmware.control().setpoint_dps[0] > 100.0, "the stick flies again");
}

#[test]
fn a_heading_by_message_is_turned_to_while_mag_is_on() {
    let mut bench = Bench::new();
    assert!(!bench.firmware.run_cli(&mut Interpreter::default(), "aux 9 5 4 1700 2100").failed);
    bench.run(6000, Some(&IDLE));
    bench.run(200, Some(&ARM));
    let mag = [1500, 1500, 1500, 1500, 1800, 1000, 1000, 1000, 1800];
    bench.run(500, Some(&mag));
    let heading = bench.firmware.estimate().heading_rad.to_degrees();
    assert!(bench.firmware.control().setpoint_dps[2].abs() < 2.0, "the heading it had is held");
    for (turn, clockwise) in [(40.0, true), (-40.0, false)] {
        let wanted = (heading + turn).rem_euclid(360.0).round() as i16;
        assert!(bench.ask(211, &wanted.to_le_bytes()).is_some());
        bench.run(20, Some(&mag));
        let yaw = bench.firmware.control().setpoint_dps[2];
        assert_eq!((yaw > 20.0, yaw < -20.0), (clockwise, !clockwise), "{yaw}");
    }
}

#[test]
fn a_value_that_current_firmware_refuses_is_taken_from_a_message_with_a_notice() {
    let mut bench = Bench::new();
    let mut notices = |request: &str| {
        let before = std::iter::from_fn(|| bench.firmware.take_event()).count();
        assert!(before < 100);
        let reply = bench.ask(0x3010, request.as_bytes()).unwrap();
        let said: Vec<String> = std::iter::from_fn(|| bench.firmware.take_event())
            .filter_map(|event| match event {
                FirmwareEvent::Notice(notice) => Some(notice.to_string()),
                _ => None,
            })
            .collect();
        (String::from_utf8(reply).unwrap(), said)
    };
    let (reply, said) = notices("ap_position_cutoff = 5");
    assert_eq!(reply, "ap_position_cutoff = 5");
    assert_eq!(
        said,
        ["ap_position_cutoff = 5 is taken here, but current Betaflight refuses it: it allows 10 to 50."]
    );
    assert_eq!(notices("ap_position_cutoff"), ("ap_position_cutoff = 5".to_owned(), Vec::new()), "reading");
    assert_eq!(notices("ap_position_cutoff = 30").1, Vec::<String>::new());
}
