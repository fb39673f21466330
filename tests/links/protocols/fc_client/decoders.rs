//! Payloads and outputs of real flight controllers, of older releases, and of random bytes.

use betadeck::fc::telemetry::{Mission, MissionPhase, Observation, mode_ranges, setting, settings};
use betadeck::geo::LatLon;
use betadeck::msp::{
    ApiVersion, Attitude, BETAFLIGHT, BatteryReading, BatteryState, BoardInfo, BuildInfo, Channels,
    FcVersion, HomeVector, Motors, RawGps, Status, code,
};
use betadeck::plan::WaypointType;
use betadeck::telemetry::snapshot::ModeRange;
use betadeck::telemetry::{AbortReason, ArmingFlag, ModeBox, NavState};
use proptest::prelude::*;

use crate::protocols::fc_client::captured::payload_of;

/// Returns the boxes of the captured craft.
fn boxes() -> Vec<u8> {
    payload_of(23)
}

fn version(payload: &[u8]) -> Option<String> {
    FcVersion::decode(payload).map(|version| version.to_string())
}

#[test]
fn the_captured_identity() {
    assert_eq!(ApiVersion::decode(&payload_of(1)), Some(ApiVersion { major: 1, minor: 49 }));
    assert_eq!(payload_of(12), BETAFLIGHT);
    assert_eq!(version(&payload_of(13)).as_deref(), Some("2026.12.0-alpha"));
    let board = BoardInfo::decode(&payload_of(15)).unwrap();
    assert_eq!((&*board.identifier, board.target.as_deref(), board.name), ("SITL", Some("SITL"), None));
    assert_eq!((board.configured, board.gyro_hz), (Some(true), Some(1000)));
    let build = BuildInfo::decode(&payload_of(14)).unwrap();
    assert_eq!([&*build.date, &build.time, &build.revision], ["Nov 21 2026", "02:51:34", "301d01a"]);
    assert_eq!(build.has_flight_plan(), Some(true));
    assert_eq!(build.options.unwrap(), [16422, 16427, 16412, 16415, 16425, 8235]);
}

#[test]
fn the_identity_of_older_releases() {
    assert_eq!(version(&[4, 5, 1]).as_deref(), Some("4.5.1"));
    assert_eq!(version(&[25, 12, 0]).as_deref(), Some("2025.12.0"));
    let build = BuildInfo::decode(b"Jun 01 202312:00:00abc1234").unwrap();
    assert_eq!((build.options.clone(), build.has_flight_plan()), (None, None));
    let board = BoardInfo::decode(b"S405\0\0\x02\0").unwrap();
    assert_eq!((&*board.identifier, board.target, board.gyro_hz), ("S405", None, None));
}

#[test]
fn the_captured_state() {
    let disarmed = Status::decode(&payload_of(22)).unwrap();
    assert_eq!((disarmed.cycle_time_us, disarmed.load_percent), (947, 0));
    assert_eq!(disarmed.is_armed(&boxes()), Some(false));
    assert!(disarmed.arming_blocked_by.unwrap().is_empty());
    assert_eq!(disarmed.reboot_required, Some(false));
    let armed = Status::decode(&payload_of(43)).unwrap();
    assert_eq!(armed.is_armed(&boxes()), Some(true));
    assert_eq!(armed.modes(&boxes()).iter().count(), 1);
    assert_eq!(armed.is_armed(&[]), None);
    let gps = RawGps::decode(&payload_of(30)).unwrap();
    assert!(gps.fix && gps.sats == 12 && gps.dop.is_none(), "{gps:?}");
    assert_eq!((gps.position, gps.alt_amsl_m), (LatLon::from_degrees(-27.5, 153.0), 30.0));
    let attitude = Attitude::decode(&payload_of(31)).unwrap();
    assert_eq!(attitude, Attitude { roll_deg: 0.0, pitch_deg: 0.0, heading_deg: 358.0 });
    let rc = Channels::decode(&payload_of(32)).unwrap().of_transmitter();
    assert_eq!(rc[..5], [1500, 1500, 1000, 1500, 1000]);
    assert_eq!(Motors::decode(&payload_of(46)).map(|motors| motors.outputs()), Some([0.055; 4]));
    let home = HomeVector { distance_m: 0.0, bearing_deg: 89.0, toggle: true };
    assert_eq!(HomeVector::decode(&payload_of(47)), Some(home));
    let range = |mode_box, channel| ModeRange { mode_box, channel, start_us: 1700, end_us: 2100 };
    let wanted = [
        range(ModeBox::Arm, 4),
        range(ModeBox::Autopilot, 5),
        range(ModeBox::Angle, 6),
        range(ModeBox::GpsRescue, 7),
    ];
    assert_eq!(mode_ranges(&payload_of(26), None), wanted);
    // The second range is linked to another mode.
    let mut extra = vec![0; 61];
    extra[6] = 1;
    assert_eq!(mode_ranges(&payload_of(26), Some(&extra)).len(), 3);
}

#[test]
fn arming_flags_of_a_release_with_fewer_end_in_the_arm_switch() {
    let payload = |count: u8, bits: u32| {
        let mut payload = vec![0; 15];
        payload.extend([0, count]);
        payload.extend(bits.to_le_bytes());
        payload
    };
    for (count, bits, flags) in [
        (30, 1 << 29 | 1 << 2, vec![ArmingFlag::RxLoss, ArmingFlag::ArmSwitch]),
        (26, 1 << 25 | 1 << 13, vec![ArmingFlag::Cli, ArmingFlag::ArmSwitch]),
        (26, 1 << 28, vec![]),
        (255, 1 << 29, vec![ArmingFlag::ArmSwitch]),
        (0, 0, vec![]),
    ] {
        let reported = Status::decode(&payload(count, bits)).unwrap().arming_blocked_by.unwrap();
        assert_eq!(reported.iter().collect::<Vec<_>>(), flags, "{count} {bits:#x}");
    }
    // Before the flags had a count, no flags were at this place.
    assert_eq!(Status::decode(&[0; 15]).unwrap().arming_blocked_by, None);
}

#[test]
fn a_battery_with_and_without_its_fine_voltage() {
    let fine = [4, 0x14, 5, 168, 100, 0, 44, 1, 1, 0x8f, 6];
    let reading = BatteryReading::decode(&fine).unwrap();
    assert_eq!((reading.cells, reading.voltage_v, reading.current_a), (Some(4), 16.79, 3.0));
    assert_eq!((reading.drawn_mah, reading.state), (100.0, Some(BatteryState::Warning)));
    assert!((BatteryReading::decode(&fine[..9]).unwrap().voltage_v - 16.8).abs() < 1e-9);
    assert!(!BatteryReading::decode(&[0, 0, 0, 0, 0, 0, 0, 0, 3]).unwrap().is_present());
    // The battery is being measured and nothing is known of it yet.
    assert!(!BatteryReading::decode(&[0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0]).unwrap().is_present());
    assert!(BatteryReading::decode(&[0, 0, 0, 0, 0, 0, 0, 0, 4, 0x18, 1]).unwrap().is_present());
}

#[test]
fn missions_in_both_vocabularies() {
    let flying = "Waypoint count: 1\r\n\nConfigured waypoints:\r\n  [0] -27.4973051 153.0000000 40.00m FLYOVER\r\n\nRuntime \
                  status:\r\n  state: TARGETING\r\n  current waypoint: 1/1\r\n  distance: 210.44m  bearing: 0 deg  eta: 39s\r\n";
    let mission = Mission::parse(flying).unwrap();
    assert_eq!(mission.phase, Some(MissionPhase::Flying(NavState::Approaching)));
    assert_eq!((mission.waypoint, mission.count), (Some(0), Some(1)));
    assert_eq!(
        (mission.distance_m, mission.bearing_deg, mission.eta_s),
        (Some(210.44), Some(0.0), Some(39.0))
    );
    let [waypoint] = &mission.waypoints[..] else { panic!("{mission:?}") };
    assert_eq!(
        (waypoint.position, waypoint.kind),
        (LatLon::new(-274_973_051, 1_530_000_000), WaypointType::Flyover)
    );
    let phase = |words: &str| Mission::parse(&format!("Runtime status:\r\n{words}")).unwrap().phase;
    for (word, state) in [
        ("HOLDING", NavState::Holding),
        ("LANDING", NavState::Landing),
        ("COMPLETE", NavState::Complete),
        ("ORBITING", NavState::Orbiting),
        ("FIGURE8", NavState::Figure8),
    ] {
        assert_eq!(phase(&format!("  state: {word}\r\n")), Some(MissionPhase::Flying(state)));
    }
    assert_eq!(phase("  state: SOMETHING_NEW\r\n"), None);
    assert_eq!(phase("  inactive\r\n"), Some(MissionPhase::Inactive { refused: None }));
    let refused = MissionPhase::Inactive { refused: Some("No waypoints: upload a plan.".to_owned()) };
    assert_eq!(phase("  inactive\r\n  refused: No waypoints: upload a plan.\r\n"), Some(refused));
    for (text, reason) in [
        ("GPS LOST", Some(AbortReason::GpsLost)),
        ("STALLED", Some(AbortReason::Stalled)),
        ("FLYAWAY", Some(AbortReason::Flyaway)),
        ("MAG FAULT", None),
    ] {
        let output = format!("Runtime status:\r\n  state: ABORTED\r\n  abort reason: {text}\r\n");
        let mission = Mission::parse(&output).unwrap();
        assert_eq!(mission.phase, Some(MissionPhase::Aborted { cause: text.to_owned() }));
        assert_eq!(mission.abort_reason(), reason);
    }
    assert_eq!(Mission::parse("ERR_CMD_NA: waypoint status"), None);
}

#[test]
fn the_value_of_one_setting_among_those_that_get_shows() {
    let output = "ap_max_angle = 33\r\nAllowed range: 10 - 70\r\nDefault value: 30\r\n\r\nap_max_angle_rate = \
                  \r\nprofile 0\r\nacc_calibration = 0,0,0,0\r\nArray length: 4\r\n";
    let names: Vec<_> = settings(output).collect();
    assert_eq!(names, [("ap_max_angle", "33"), ("ap_max_angle_rate", ""), ("acc_calibration", "0,0,0,0")]);
    assert_eq!(setting(output, "AP_MAX_ANGLE"), Some("33"));
    assert_eq!(setting(output, "ap_max"), None);
    assert_eq!(setting("###ERROR IN get: INVALID NAME: x = 1###\r\n", "x"), None);
}

proptest! {
    #[test]
    fn any_payload_is_read_or_left(code in 0_u16..256, payload in prop::collection::vec(any::<u8>(), 0..120)) {
        let mut observation = Observation::default();
        observation.take(code::BOXIDS, &boxes());
        observation.take(code, &payload);
        observation.take(code::STATUS_EX, &payload);
        let estimate = observation.estimate_view(None);
        prop_assert!(estimate.heading_deg.is_none_or(|heading| (0.0..360.0).contains(&heading)));
        let craft = observation.craft_view();
        prop_assert!(craft.motors.iter().flatten().all(|motor| (0.0..=1.0).contains(motor)));
        prop_assert!(craft.mode_ranges().iter().all(|range| range.channel < 16 && range.start_us < range.end_us));
        prop_assert!(BoardInfo::decode(&payload).is_none_or(|board| board.identifier.len() <= 4));
        let _ = (BuildInfo::decode(&payload), FcVersion::decode(&payload), ApiVersion::decode(&payload));
    }

    #[test]
    fn a_shorter_payload_says_less_and_nothing_else(number in prop::sample::select(vec![22_u32, 30, 31, 32, 43, 46, 47]), cut in 0_usize..40) {
        let whole = payload_of(number);
        let part = &whole[..cut.min(whole.len())];
        let (short, long) = (Status::decode(part), Status::decode(&whole));
        if let (Some(short), Some(long)) = (short, long) {
            prop_assert_eq!(short.cycle_time_us, long.cycle_time_us);
            prop_assert!(short.arming_blocked_by.is_none() || short.arming_blocked_by == long.arming_blocked_by);
        }
        prop_assert!(Attitude::decode(part).is_none_or(|attitude| Some(attitude) == Attitude::decode(&whole)));
    }

    #[test]
    fn any_output_is_a_mission_or_none(text in "(Runtime status:\n)?(([a-z ]{0,12}|state|distance|current waypoint|abort reason|\\[0\\]): ?[-A-Z0-9./m: ]{0,30}\n){0,6}") {
        if let Some(mission) = Mission::parse(&text) {
            prop_assert!(mission.bearing_deg.is_none_or(|bearing| (0.0..360.0).contains(&bearing)));
            prop_assert!(mission.distance_m.is_none_or(f64::is_finite));
        }
        let _ = settings(&text).count();
    }
}
