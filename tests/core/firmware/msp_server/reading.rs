//! Messages that report the state of the craft.

use betadeck_core::firmware::modes::BoxSet;
use betadeck_core::firmware::msp::{MspFacts, UtcTime, handle};
use betadeck_core::msp::{BatteryReading, BatteryState};
use betadeck_core::telemetry::{Mode, ModeFlags};
use nalgebra::{UnitQuaternion, Vector3};

use super::{ask, craft, facts};
use test_support::hex;

#[test]
fn mode_bits_stand_at_their_place_in_the_list() {
    let mut facts = facts();
    for mode in [Mode::Arm, Mode::Angle, Mode::AltHold, Mode::PosHold, Mode::Autopilot] {
        facts.modes.set(mode, true);
    }
    facts.armed = true;
    facts.switches.set(57, true);
    let reply = handle(101, &[], &mut craft(), &facts).reply.unwrap();
    let bits = u32::from_le_bytes(reply[6..10].try_into().unwrap());
    assert_eq!(bits, 1 | 1 << 1 | 1 << 4 | 1 << 7 | 1 << 9 | 1 << 25);
    facts.modes = ModeFlags::NONE;
    facts.switches = BoxSet::NONE;
    facts.switches.set(1, true);
    facts.armed = false;
    let reply = handle(101, &[], &mut craft(), &facts).reply.unwrap();
    assert_eq!(reply[6..10], [0; 4], "a flight mode whose switch is on is not yet active");
}

#[test]
fn state_messages_use_the_signs_of_the_wire() {
    let facts = MspFacts {
        roll_deg: 12.34,
        pitch_deg: 10.0,
        heading_deg: 359.7,
        attitude: UnitQuaternion::identity(), // facing east
        specific_force_flu: Vector3::new(0.0, 0.0, betadeck_core::geo::GRAVITY),
        rate_flu: Vector3::new(1.0, 0.5, -0.25),
        altitude_m: -1.5,
        climb_mps: 2.5,
        battery: Some(BatteryReading {
            voltage_v: 15.64,
            current_a: 12.5,
            drawn_mah: 345.6,
            cells: Some(4),
            state: Some(BatteryState::Warning),
            ..BatteryReading::default()
        }),
        clock: Some(UtcTime { unix_s: 1_700_000_000, millis: 500 }),
        ..facts()
    };
    let read = |code| handle(code, &[], &mut craft(), &facts).reply.unwrap();
    assert_eq!(hex::encode(&read(108)), hex::encode(&[123_i16, -100, 0].map(i16::to_le_bytes).concat()));
    // East is a turn of -90 degrees from north, seen from above in north-west-up.
    assert_eq!(
        hex::encode(&read(167)),
        hex::encode(&[23170_i16, 0, 0, -23170].map(i16::to_le_bytes).concat())
    );
    assert_eq!(
        hex::encode(&read(102)),
        hex::encode(&[0_i16, 0, 256, 57, 29, -14, 0, 0, 0].map(i16::to_le_bytes).concat())
    );
    assert_eq!(hex::encode(&read(109)), "6affffff".to_owned() + "fa00");
    assert_eq!(hex::encode(&read(110)), "9c5a010000e2041c06");
    assert_eq!(hex::encode(&read(130)), "0400009c5a01e204011c06");
    assert_eq!(hex::encode(&read(247)), "e7070b0e160d14f401");
}

#[test]
fn dates_of_the_calendar() {
    for (unix_s, expected) in [
        (0, [1970, 1, 1]),
        (951_782_400, [2000, 2, 29]),
        (951_868_800, [2000, 3, 1]),
        (4_107_542_399, [2100, 2, 28]),
        (4_107_542_400, [2100, 3, 1]),
        (u32::MAX, [2106, 2, 7]),
    ] {
        let facts = MspFacts { clock: Some(UtcTime { unix_s, millis: 0 }), ..facts() };
        let reply = handle(247, &[], &mut craft(), &facts).reply.unwrap();
        let year = u16::from_le_bytes([reply[0], reply[1]]);
        assert_eq!([year, reply[2].into(), reply[3].into()], expected, "{unix_s}");
    }
}

#[test]
fn several_questions_in_one_are_cut_at_what_fits() {
    let codes = [94; 20];
    let reply = ask(&mut craft(), 230, &codes).unwrap();
    assert_eq!(reply.len(), 8 * 62, "eight answers of 61 bytes fit into 512");
}
