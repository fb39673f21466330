//! Each message that server and client share is read as it was written.

use super::*;
use crate::geo::LatLon;
use crate::signals::RC_CHANNELS;
use crate::telemetry::{ArmingFlag, ArmingFlags};

fn written(write: impl FnOnce(&mut Writer)) -> Vec<u8> {
    let mut writer = Writer::default();
    write(&mut writer);
    writer.into_bytes()
}

#[test]
fn the_table_is_sorted_and_finds_each_row() {
    assert!(code::KINDS.is_sorted_by(|one, next| one.code < next.code));
    for kind in code::KINDS {
        assert_eq!(code::find(kind.code), Some(kind));
    }
    assert_eq!(code::find(6), None);
    assert_eq!(code::row(code::CLI_COMMAND).name, "CLI_COMMAND");
}

#[test]
fn identity() {
    let api = ApiVersion { major: 1, minor: 49 };
    assert_eq!(ApiVersion::decode(&written(|writer| api.encode(writer))), Some(api));
    let version = FcVersion { numbers: [26, 12, 0], text: Some("2026.12.0-alpha".to_owned()) };
    assert_eq!(FcVersion::decode(&written(|writer| version.encode(writer))), Some(version));
    let board = BoardInfo {
        identifier: "S405".to_owned(),
        target: Some("TARGET".to_owned()),
        name: None,
        manufacturer: Some("MAKER".to_owned()),
        configured: Some(true),
        gyro_hz: Some(8000),
    };
    assert_eq!(BoardInfo::decode(&written(|writer| board.encode(writer))), Some(board));
    let build = BuildInfo {
        date: "Nov 21 2026".to_owned(),
        time: "02:51:34".to_owned(),
        revision: "301d01a".to_owned(),
        options: Some(vec![FLIGHT_PLAN_OPTION, 8235]),
    };
    assert_eq!(BuildInfo::decode(&written(|writer| build.encode(writer))), Some(build));
}

#[test]
fn motion() {
    let attitude = Attitude { roll_deg: -12.5, pitch_deg: 7.5, heading_deg: 271.0 };
    assert_eq!(Attitude::decode(&written(|writer| attitude.encode(writer))), Some(attitude));
    let altitude = Altitude { alt_m: -2.5, climb_mps: Some(-1.25) };
    assert_eq!(Altitude::decode(&written(|writer| altitude.encode(writer))), Some(altitude));
    for dop in [None, Some(1.25)] {
        let gps = RawGps {
            fix: true,
            sats: 17,
            position: LatLon::new(-275_000_000, 1_530_000_000),
            alt_amsl_m: 120.0,
            ground_speed_mps: 3.75,
            course_deg: 359.5,
            dop,
        };
        assert_eq!(RawGps::decode(&written(|writer| gps.encode(writer))), Some(gps));
    }
    let home = HomeVector { distance_m: 250.0, bearing_deg: 91.0, toggle: true };
    assert_eq!(HomeVector::decode(&written(|writer| home.encode(writer))), Some(home));
}

#[test]
fn battery_channels_and_motors() {
    for state in [BatteryState::Ok, BatteryState::Critical, BatteryState::NotPresent, BatteryState::Init] {
        let battery = BatteryReading {
            cells: Some(4),
            capacity_mah: 1300,
            voltage_v: 15.75,
            drawn_mah: 345.0,
            current_a: 12.5,
            state: Some(state),
        };
        assert_eq!(BatteryReading::decode(&written(|writer| battery.encode(writer))), Some(battery));
    }
    let mut pulses = [1500; RC_CHANNELS];
    (pulses[2], pulses[3], pulses[15]) = (1100, 1900, 2000);
    let channels = Channels(pulses);
    assert_eq!(Channels::decode(&written(|writer| channels.encode(writer))), Some(channels));
    assert_eq!(channels.of_transmitter()[2..4], [1900, 1100]);
    let motors = Motors([1000, 1055, 1500, 2000]);
    assert_eq!(Motors::decode(&written(|writer| motors.encode(writer))), Some(motors));
    assert_eq!(motors.outputs(), [0.0, 0.055, 0.5, 1.0]);
}

#[test]
fn status_with_further_mode_bits() {
    let status = Status {
        cycle_time_us: 125,
        sensors: 0x2f,
        profile: 1,
        profiles: 4,
        rate_profile: 2,
        rate_profiles: 6,
        battery_profile: 1,
        battery_profiles: 3,
        load_percent: 9,
        mode_bits: 1 | 1 << 31 | 1 << 45,
        arming_blocked_by: Some([ArmingFlag::RxLoss, ArmingFlag::ArmSwitch].into_iter().collect()),
        reboot_required: Some(true),
    };
    assert_eq!(Status::decode(&written(|writer| status.encode(true, writer))), Some(status));
    // `STATUS` has neither the number of profiles nor the rate profile.
    let short = Status { profiles: 0, rate_profile: 0, ..status };
    assert_eq!(Status::decode(&written(|writer| status.encode(false, writer))), Some(short));
    let unknown = Status { arming_blocked_by: None, reboot_required: None, ..status };
    let read = Status::decode(&written(|writer| unknown.encode(true, writer))).expect("readable");
    assert_eq!((read.arming_blocked_by, read.reboot_required), (Some(ArmingFlags::NONE), Some(false)));
}

#[test]
fn mode_conditions() {
    let slots = [
        ModeSlot { box_id: 0, aux_channel: 0, start_us: 1700, end_us: 2100 },
        ModeSlot { box_id: 53, aux_channel: 3, start_us: 900, end_us: 1300 },
    ];
    let payload = written(|writer| slots.iter().for_each(|slot| slot.encode(writer)));
    assert_eq!(ModeSlot::decode_all(&payload).collect::<Vec<_>>(), slots);
    assert_eq!(ModeSlot::decode_all(&payload[..7]).count(), 1, "the second is not complete");
    let links = [ModeLink { box_id: 0, logic: 1, linked: 2 }, ModeLink { box_id: 53, logic: 0, linked: 0 }];
    let payload = written(|writer| ModeLink::encode_all(links.into_iter(), writer));
    assert_eq!(ModeLink::decode_all(&payload).collect::<Vec<_>>(), links);
}
