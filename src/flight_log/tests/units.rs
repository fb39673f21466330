//! Values in their units and frames.

use super::maker::{Maker, header};
use super::{at, only};
use crate::flight_log::{LogFlight, SignalFrame};
use crate::geo::GRAVITY;

/// Writes a log with one frame of each kind.
fn one_of_each(lines: &str) -> Vec<u8> {
    let mut maker = Maker::default();
    maker.begin(lines).main(7, 1_000_000, 10, 1234).home(404_640_000, -795_175_000, 3000);
    maker.gps(1_000_000, 14, 404_650_000, -795_165_000, 3123, 512, 455).main(8, 1_001_000, 10, 1234);
    maker.bytes
}

fn near(value: Option<f64>, expected: f64) {
    let value = value.unwrap();
    assert!((value - expected).abs() < 1e-6 * expected.abs().max(1.0), "{value}, not {expected}");
}

#[test]
fn a_sample_has_si_units_and_the_frames_of_the_program() {
    let bytes = one_of_each(&header());
    let sample = at(&only(&bytes), &bytes, 1_000_000);
    assert_eq!((sample.time.0, sample.iteration), (1_000_000, 7));
    assert_eq!(sample.gyro_dps.unwrap().as_slice(), [10.0, -20.0, 30.0]);
    assert_eq!(sample.accel_mps2.unwrap().as_slice(), [0.0, 0.5 * GRAVITY, GRAVITY]);
    assert_eq!(sample.rc_command, Some([100.0, -100.0, 5.0]));
    assert_eq!(sample.rc_throttle_us, Some(1500.0));
    assert_eq!(sample.setpoint_dps, Some([11.0, 12.0, 13.0]));
    near(sample.setpoint_throttle, 0.456);
    near(sample.battery_v, 16.2);
    near(sample.battery_a, 36.0);
    near(sample.alt, 12.34);
    near(Some(sample.motors[0]), 0.1);
    near(Some(sample.motors[1]), 1.0);
    assert_eq!(sample.motors.len(), 2);
    // The accelerometer shows the craft rolled to the right.
    let attitude = sample.attitude.unwrap();
    near(Some(attitude.roll_deg), 0.5_f64.atan().to_degrees());
    // The GPS: 0.001° north and 0.001° east of home.
    assert_eq!(sample.sats, Some(14));
    assert!(
        (sample.n.unwrap() - 111.04).abs() < 0.05 && (sample.e.unwrap() - 84.8).abs() < 0.1,
        "{sample:?}"
    );
    near(sample.alt_amsl_m, 312.3);
    near(sample.ground_speed_mps, 5.12);
    near(sample.course_deg, 45.5);
    assert_eq!((sample.boxes, sample.gps_fix, sample.climb_mps), (None, None, None));
}

#[test]
fn signals_have_names_units_and_values() {
    let bytes = one_of_each(&header());
    let flight = only(&bytes);
    let sample = at(&flight, &bytes, 1_001_000);
    let read = |name: &str| {
        let signal = flight.find(name).unwrap();
        (sample.values[signal], flight.signals()[signal].unit, flight.signals()[signal].frame)
    };
    let whole = |(value, unit, frame): (f64, &'static str, Option<SignalFrame>)| {
        ((value * 100.0).round() / 100.0, unit, frame)
    };
    assert_eq!(whole(read("altitude")), (12.34, "m", None));
    assert_eq!(whole(read("battery")), (16.2, "V", None));
    assert_eq!(whole(read("charge")), (0.01, "mAh", None));
    assert_eq!(whole(read("gyroADC[2]")), (30.0, "°/s", Some(SignalFrame::Main)));
    assert_eq!(whole(read("motor[0]")), (10.0, "%", Some(SignalFrame::Main)));
    assert!((read("GPS_coord[0]").0 - 40.465).abs() < 1e-9);
    assert!(read("flightModeFlags").0.is_nan(), "no slow frame was logged");
    assert_eq!(flight.find("nothing"), None);
}

fn altitude_and_voltage(flight: &LogFlight, bytes: &[u8]) -> (f64, f64) {
    let sample = at(flight, bytes, 1_001_000);
    (sample.alt_amsl_m.unwrap(), sample.battery_v.unwrap())
}

#[test]
fn units_depend_on_the_firmware() {
    let of = |revision: &str| {
        let bytes = one_of_each(&header().replace("Betaflight 4.5.2", revision));
        altitude_and_voltage(&only(&bytes), &bytes)
    };
    assert_eq!(of("Betaflight 3.5.0"), (312.3, 162.0));
    assert_eq!(of("Betaflight 3.1.0"), (3123.0, 162.0));
    assert_eq!(of("INAV 7.1.0"), (3123.0, 16.2));
    let (_, old) = of("Cleanflight 1.14.2");
    assert!((old - 1620.0 * 3.3 * 11.0 / 4095.0).abs() < 1e-9, "{old}");
}

#[test]
fn high_resolution_is_ten_times_finer() {
    let bytes = one_of_each(&(header() + "H blackbox_high_resolution:1\n"));
    let sample = at(&only(&bytes), &bytes, 1_000_000);
    assert_eq!(sample.gyro_dps.unwrap().as_slice(), [1.0, -2.0, 3.0]);
    assert_eq!((sample.rc_command, sample.rc_throttle_us), (Some([10.0, -10.0, 0.5]), Some(150.0)));
    near(sample.setpoint_throttle, 0.456);
}

#[test]
fn a_quaternion_gives_the_attitude() {
    // 90° to the right about up: x north, y west, z up. Then 20° nose up.
    let quaternion = |parts: [f64; 3]| parts.map(|part| (part * 32_767.0).round() as i32);
    let turn = nalgebra::UnitQuaternion::from_axis_angle(&nalgebra::Vector3::z_axis(), -90_f64.to_radians());
    let raise = nalgebra::UnitQuaternion::from_axis_angle(&nalgebra::Vector3::y_axis(), -20_f64.to_radians());
    let attitude = turn * raise;
    let lines = header().replace("gyroADC[1]", "imuQuaternion[0]").replace("gyroADC[2]", "imuQuaternion[1]");
    let lines = lines.replace("accSmooth[0]", "imuQuaternion[2]");
    let mut maker = Maker::default();
    maker.begin(&lines).raw(b"I").unsigned(1).unsigned(1_000_000).signed(0).signed(0);
    for part in quaternion([attitude.i, attitude.j, attitude.k]) {
        maker.signed(part);
    }
    // The other fields as zeros.
    maker.raw(&[0; 14]);
    let sample = at(&only(&maker.bytes), &maker.bytes, 1_000_000).attitude.unwrap();
    assert!((sample.pitch_deg - 20.0).abs() < 0.01 && (sample.heading_deg - 90.0).abs() < 0.01, "{sample:?}");
    assert!(sample.roll_deg.abs() < 0.01, "{sample:?}");
}

#[test]
fn without_a_home_the_first_fix_counts() {
    let mut maker = Maker::default();
    let lines = header().replace("0,0,7,7,0,0,0", "0,0,0,0,0,0,0").replace("baroAlt", "other");
    maker.begin(&lines).main(0, 1_000_000, 0, 0);
    maker.gps(0, 9, 809_280_000, -1_590_350_000, 3000, 0, 0).main(1, 1_001_000, 0, 0);
    maker.gps(0, 9, 809_281_000, -1_590_350_000, 3050, 0, 0).main(2, 1_002_000, 0, 0);
    let flight = only(&maker.bytes);
    assert_eq!(flight.home().unwrap().position.lat_e7, 404_640_000);
    assert_eq!(flight.track().len(), 2);
    let sample = at(&flight, &maker.bytes, 1_002_000);
    assert!((sample.n.unwrap() - 11.1).abs() < 0.1);
    near(sample.alt, 5.0);
}

#[test]
fn places_without_fix_or_home_do_not_count() {
    let mut maker = Maker::default();
    maker.begin(&header()).main(0, 1_000_000, 0, 0);
    // No home yet; then a home, but no fix.
    maker.gps(0, 3, 404_640_000, -795_175_000, 3000, 0, 0).home(404_640_000, -795_175_000, 3000);
    maker.slow([0, 1, 0, 1, 1]).gps(0, 3, 404_640_000, -795_175_000, 3000, 0, 0).main(1, 1_001_000, 0, 0);
    let flight = only(&maker.bytes);
    assert!(flight.track().is_empty());
    let sample = at(&flight, &maker.bytes, 1_001_000);
    assert_eq!((sample.position, sample.n, sample.sats, sample.gps_fix), (None, None, Some(3), Some(false)));
}

#[test]
fn the_first_course_orients_a_craft_without_a_compass() {
    let mut maker = Maker::default();
    maker.begin(&header()).main(0, 1_000_000, 0, 0).home(404_640_000, -795_175_000, 3000);
    maker.gps(0, 9, 404_640_000, -795_175_000, 3000, 299, 900).main(1, 1_001_000, 0, 0);
    maker.gps(0, 9, 404_640_000, -795_175_000, 3000, 300, 900).main(2, 1_002_000, 0, 0);
    maker.gps(0, 9, 404_640_000, -795_175_000, 3000, 300, 1800).main(3, 1_003_000, 0, 0);
    let flight = only(&maker.bytes);
    let heading = |time_us| at(&flight, &maker.bytes, time_us).attitude.unwrap().heading_deg;
    let from_north = |degrees: f64| (degrees + 180.0).rem_euclid(360.0) - 180.0;
    assert!(from_north(heading(1_001_000)).abs() < 1.0);
    assert!((heading(1_002_000) - 90.0).abs() < 1.0);
    assert!((heading(1_003_000) - 90.0).abs() < 1.0, "once");
}
