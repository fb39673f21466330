//! Telemetry in the report, and events.

use super::*;

#[test]
fn a_stream_of_arducopter_becomes_a_report() {
    let mut played = Played::connected(arducopter());
    played.hear(Attitude {
        time_boot_ms: 5000,
        roll: 0.1,
        pitch: -0.2,
        yaw: 3.0,
        rollspeed: 0.01,
        ..Default::default()
    });
    played.hear(GlobalPositionInt {
        time_boot_ms: 5000,
        lat: 404_635_000,
        lon: -795_182_000,
        alt: 312_500,
        relative_alt: 12_500,
        vx: 150,
        vy: -50,
        vz: 25,
        hdg: 9000,
    });
    played.hear(VfrHud {
        airspeed: 5.0,
        groundspeed: 4.0,
        alt: 312.5,
        climb: 0.5,
        heading: 90,
        throttle: 45,
    });
    played.hear(SysStatus {
        onboard_control_sensors_present: 3,
        voltage_battery: 16_100,
        current_battery: 1250,
        battery_remaining: 80,
        load: 250,
        ..Default::default()
    });
    let voltages = [16_100, 65535, 65535, 65535, 65535, 65535, 65535, 65535, 65535, 65535];
    played.hear(BatteryStatus {
        voltages,
        current_consumed: 300,
        current_battery: 1250,
        battery_remaining: 79,
        ..Default::default()
    });
    played.hear(GpsRawInt {
        fix_type: 3,
        lat: 404_635_000,
        eph: 80,
        epv: 65535,
        vel: 400,
        cog: 9000,
        satellites_visible: 14,
        ..Default::default()
    });
    played.hear(RcChannels { chan_raw: Series([1500; 18]), chancount: 16, rssi: 254, ..Default::default() });
    played.hear(RcChannelsRaw { chan_raw: Series([1000; 8]), ..Default::default() });
    played.hear(ServoOutputRaw { servo_raw: Series([1200; 8]), ..Default::default() });
    played.hear(MissionCurrent { seq: 3, total: 7, mission_state: 3, ..Default::default() });
    played.hear(NavControllerOutput {
        wp_dist: 120,
        target_bearing: -90,
        xtrack_error: 2.0,
        alt_error: 1.0,
        ..Default::default()
    });
    played.hear(HomePosition {
        latitude: 404_635_000,
        longitude: -795_182_000,
        altitude: 300_000,
        ..Default::default()
    });
    played.hear(ExtendedSysState { landed_state: 2, vtol_state: 0 });
    played.hear(Wind { direction: 270.0, speed: 5.0, speed_z: 0.0 });
    played.hear(ScaledPressure { press_abs: 970.5, temperature: 2150, ..Default::default() });
    played.hear(SystemTime { time_unix_usec: 1_700_000_000_000_000, time_boot_ms: 5100 });
    played.hear(FenceStatus { breach_status: 1, ..Default::default() });
    let report = played.station.report().clone();
    let presence = report.presence.unwrap().value;
    assert_eq!(
        (presence.autopilot, presence.mode.as_str(), presence.is_armed, presence.is_critical),
        (AutopilotKind::Ardupilot, "LOITER", false, false)
    );
    assert_eq!(report.boot_time.unwrap().value, Duration::from_millis(5100));
    assert_eq!(report.unix_time.unwrap().value, Duration::from_secs(1_700_000_000));
    assert_eq!(
        report.position.unwrap().value,
        GeoPosition { lat_deg: 40.4635, lon_deg: -79.5182, alt_amsl: 312.5 }
    );
    assert_eq!(report.altitude_above_home.unwrap().value, 12.5);
    assert_eq!(report.velocity_ned.unwrap().value, [1.5, -0.5, 0.25]);
    assert_eq!(
        (report.airspeed.unwrap().value, report.climb.unwrap().value, report.throttle.unwrap().value),
        (5.0, 0.5, 0.45)
    );
    let battery = report.battery.unwrap().value;
    assert_eq!(
        (battery.voltage, battery.current, battery.drawn_mah, battery.remaining),
        (16.1, Some(12.5), Some(300.0), Some(0.79))
    );
    let gps = report.gps.unwrap().value;
    assert_eq!(
        (gps.fix, gps.hdop, gps.vdop, gps.speed, gps.satellites),
        (GpsFix::Fix3d, Some(0.8), None, Some(4.0), Some(14))
    );
    assert_eq!(report.rc.unwrap().value.channels_us[17], 1500);
    assert_eq!(report.outputs_us.unwrap().value[..9], [1200, 1200, 1200, 1200, 1200, 1200, 1200, 1200, 0]);
    assert_eq!(
        report.mission.unwrap().value,
        CurrentItem { seq: 3, total: Some(7), state: MissionState::Active }
    );
    assert_eq!(report.navigation.unwrap().value.distance, 120.0);
    assert_eq!(report.landed.unwrap().value, LandedState::InAir);
    let [north, east, _] = report.wind_ned.unwrap().value;
    assert!(north.abs() < 1e-6 && (east - 5.0).abs() < 1e-6);
    assert_eq!((report.pressure_pa.unwrap().value, report.temperature_c.unwrap().value), (97_050.0, 21.5));
    assert!(report.is_fence_breached.unwrap().value);
    assert_eq!(report.sensors.unwrap().value.load, 0.25);
    assert_eq!(report.attitude.unwrap().at, played.now);
}

#[test]
fn inav_and_betaflight_report_cells_and_lack_much() {
    let mut played = Played::connected(heartbeat(0, 2, 81, 3));
    let voltages = [4000, 4000, 4000, 4000, 65535, 65535, 65535, 65535, 65535, 65535];
    played.hear(BatteryStatus {
        voltages,
        current_consumed: -1,
        current_battery: -1,
        battery_remaining: -1,
        ..Default::default()
    });
    played.hear(ScaledPressure { temperature: 2500, ..Default::default() });
    played.hear(GlobalPositionInt::default());
    played.hear(RcChannelsRaw { chan_raw: Series([1000; 8]), rssi: 255, ..Default::default() });
    played.hear(ExtendedSysState::default());
    let report = played.station.report();
    let battery = report.battery.unwrap().value;
    assert_eq!(
        (battery.voltage, battery.current, battery.drawn_mah, battery.remaining),
        (16.0, None, None, None)
    );
    assert_eq!((report.pressure_pa, report.temperature_c.unwrap().value), (None, 25.0));
    assert_eq!((report.position, report.landed), (None, None));
    assert_eq!((report.rc.unwrap().value.count, report.rc.unwrap().value.rssi), (8, None));
}

#[test]
fn numbers_that_are_none_are_not_reported() {
    let mut played = Played::connected(arducopter());
    played.hear(Attitude { roll: f32::NAN, ..Default::default() });
    played.hear(LocalPositionNed { x: f32::INFINITY, ..Default::default() });
    played.hear(WindCov { wind_x: f32::NAN, ..Default::default() });
    played.hear(VfrHud { airspeed: f32::NAN, ..Default::default() });
    let report = played.station.report();
    assert_eq!(
        (report.attitude, report.local_ned, report.wind_ned, report.airspeed),
        (None, None, None, None)
    );
}

#[test]
fn the_quaternion_is_read_as_angles() {
    let mut played = Played::connected(arducopter());
    let half = std::f32::consts::FRAC_PI_8;
    played.hear(AttitudeQuaternion { q1: half.cos(), q4: half.sin(), ..Default::default() });
    let [roll, pitch, yaw] = played.station.report().attitude.unwrap().value;
    assert!(roll.abs() < 1e-6 && pitch.abs() < 1e-6 && (yaw - std::f64::consts::FRAC_PI_4).abs() < 1e-6);
}

#[test]
fn changes_are_events() {
    let mut played = Played::connected(arducopter());
    played.hear(heartbeat(3, 2, 81 + 128, 3));
    played.hear(heartbeat(3, 2, 81 + 128, 3));
    played.hear(MissionItemReached { seq: 4 });
    played.hear(Statustext { severity: 4, text: Text::new("PreArm: GPS"), ..Default::default() });
    let text = PilotText { severity: Severity::Warning, text: "PreArm: GPS".into() };
    let expected = [Event::Mode("AUTO".into()), Event::Armed(true), Event::ItemReached(4), Event::Text(text)];
    assert_eq!(played.events(), expected);
}
