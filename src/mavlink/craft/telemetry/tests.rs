use super::super::super::state::{BatteryState, GpsState, NavigationState, RcState};
use super::super::super::value::GpsFix;
use super::super::state::MissionProgress;
use super::*;

const HOME: GeoPosition = GeoPosition { lat_deg: 40.4635, lon_deg: -79.5182, alt_amsl: 300.0 };

fn message(state: &CraftState, id: u32) -> Option<Message> {
    message_of(Identity::Generic, state, id)
}

fn message_of(identity: Identity, state: &CraftState, id: u32) -> Option<Message> {
    let sim = Duration::from_millis(12_345);
    Source { identity, state, sim, mission_length: 3, has_home_item: false }.message(id)
}

macro_rules! expect {
    ($state:expr, $name:ident) => {{
        let message = message(&$state, $name::ID);
        let Some(Message::$name(message)) = message else { panic!("{message:?}") };
        message
    }};
}

#[test]
fn the_position_is_in_the_units_of_the_message() {
    let state = CraftState {
        position: Some(GeoPosition { alt_amsl: 312.5, ..HOME }),
        home: Some(HOME),
        velocity_ned: Some([1.5, -2.25, 0.5]),
        attitude: Some([0.0, 0.0, -0.1]),
        ..CraftState::default()
    };
    let found = expect!(state, GlobalPositionInt);
    assert_eq!((found.time_boot_ms, found.lat, found.lon), (12_345, 404_635_000, -795_182_000));
    assert_eq!((found.alt, found.relative_alt), (312_500, 12_500));
    assert_eq!((found.vx, found.vy, found.vz, found.hdg), (150, -225, 50, 35_427));
    let found =
        expect!(CraftState { altitude_above_home: Some(7.0), attitude: None, ..state }, GlobalPositionInt);
    assert_eq!((found.relative_alt, found.hdg), (7000, u16::MAX));
    let found = expect!(state, VfrHud);
    assert_eq!((found.alt, found.climb, found.heading), (312.5, -0.5, 354));
    let found = expect!(state, HomePosition);
    assert_eq!((found.latitude, found.longitude, found.altitude), (404_635_000, -795_182_000, 300_000));
}

#[test]
fn a_heading_of_a_full_circle_is_zero() {
    for yaw in [0.0, std::f64::consts::TAU, -1e-9, 360.0_f64.to_radians() - 1e-9] {
        assert_eq!(compass(yaw), 0, "{yaw}");
    }
    assert_eq!(compass(std::f64::consts::PI), 18_000);
}

#[test]
fn the_quaternion_is_that_of_the_angles() {
    let state = CraftState {
        attitude: Some([0.3, -0.2, 2.0]),
        rates: Some([0.1, 0.2, 0.3]),
        ..CraftState::default()
    };
    let found = expect!(state, AttitudeQuaternion);
    let [w, x, y, z] = [found.q1, found.q2, found.q3, found.q4].map(f64::from);
    assert!(((w * w + x * x + y * y + z * z) - 1.0).abs() < 1e-6);
    let pitch = (2.0 * (w * y - z * x)).asin();
    assert!((pitch + 0.2).abs() < 1e-6);
    assert_eq!((found.rollspeed, found.yawspeed), (0.1, 0.3));
}

#[test]
fn the_battery_is_in_millivolts_and_centiamperes() {
    let battery =
        BatteryState { voltage: 16.12, current: Some(12.5), drawn_mah: Some(321.0), remaining: Some(0.755) };
    let state = CraftState { battery: Some(battery), ..CraftState::default() };
    let found = expect!(state, SysStatus);
    assert_eq!((found.voltage_battery, found.current_battery, found.battery_remaining), (16_120, 1250, 76));
    let found = expect!(state, BatteryStatus);
    assert_eq!((found.voltages[0], found.voltages[1], found.current_consumed), (16_120, u16::MAX, 321));
    let found = expect!(CraftState::default(), SysStatus);
    assert_eq!((found.voltage_battery, found.current_battery, found.battery_remaining), (u16::MAX, -1, -1));
    assert_eq!(message(&CraftState::default(), BatteryStatus::ID), None);
}

#[test]
fn sensors_that_fail_are_not_healthy_and_the_fence_always_is() {
    let state = CraftState {
        sensors_present: sensor::GYRO | sensor::GPS,
        sensors_healthy: sensor::GYRO | sensor::BAROMETER,
        is_ready_to_arm: Some(true),
        ..CraftState::default()
    };
    let found = expect!(state, SysStatus);
    assert_eq!(found.onboard_control_sensors_present, sensor::GYRO | sensor::GPS | sensor::READY_TO_ARM);
    assert_eq!(found.onboard_control_sensors_health, sensor::GYRO | sensor::FENCE | sensor::READY_TO_ARM);
}

#[test]
fn the_receiver_reports_what_it_knows() {
    let gps = GpsState {
        fix: GpsFix::Fix3d,
        position: HOME,
        hdop: Some(0.8),
        vdop: None,
        speed: Some(3.0),
        course: Some(1.0),
        satellites: Some(14),
    };
    let found = expect!(CraftState { gps: Some(gps), ..CraftState::default() }, GpsRawInt);
    assert_eq!((found.fix_type, found.eph, found.epv, found.vel, found.cog), (3, 80, u16::MAX, 300, 5730));
    assert_eq!((found.alt, found.satellites_visible), (300_000, 14));
}

#[test]
fn channels_beyond_the_last_are_not_known() {
    let rc = RcState { channels_us: [1500; 18], count: 8, rssi: Some(1.0) };
    let state = CraftState { rc: Some(rc), ..CraftState::default() };
    let found = expect!(state, RcChannels);
    assert_eq!(
        (found.chancount, found.chan_raw.0[7], found.chan_raw.0[8], found.rssi),
        (8, 1500, u16::MAX, 254)
    );
    assert_eq!(expect!(state, RcChannelsRaw).chan_raw.0, [1500; 8]);
}

#[test]
fn the_navigator_reports_its_target() {
    let navigation =
        NavigationState { distance: 120.4, bearing: 1.0, cross_track: -2.0, altitude_error: 3.0 };
    let found =
        expect!(CraftState { navigation: Some(navigation), ..CraftState::default() }, NavControllerOutput);
    assert_eq!(
        (found.wp_dist, found.target_bearing, found.xtrack_error, found.alt_error),
        (120, 57, -2.0, 3.0)
    );
}

#[test]
fn the_mission_has_a_number_a_total_and_a_state() {
    let mission = MissionProgress { current: Some(1), state: MissionState::Active };
    let state = CraftState { mission, mode: Some(FlightMode::Autopilot), ..CraftState::default() };
    let found = expect!(state, MissionCurrent);
    assert_eq!((found.seq, found.total, found.mission_state, found.mission_mode), (1, 3, 3, 1));
}

#[test]
fn the_wind_has_the_form_of_the_identity() {
    // 5 m/s from the south-west.
    let state = CraftState { wind_ned: Some([3.0, 4.0, 0.0]), ..CraftState::default() };
    let Some(Message::Wind(wind)) = message_of(Identity::Ardupilot, &state, Wind::ID) else { panic!() };
    assert!((wind.direction - 233.13).abs() < 0.01 && wind.speed == 5.0);
    let Some(Message::WindCov(wind)) = message_of(Identity::Px4, &state, WindCov::ID) else { panic!() };
    assert_eq!((wind.wind_x, wind.wind_y), (3.0, 4.0));
    assert_eq!(message_of(Identity::Px4, &state, Wind::ID), None);
}
