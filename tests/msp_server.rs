//! The MSP server against exchanges captured from the real executable, and what the messages do.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use betadeck::firmware::cli::BuildInfo;
use betadeck::firmware::config::{Configuration, Feature, ModeCondition, RxFailMode};
use betadeck::firmware::modes::BoxSet;
use betadeck::firmware::msp::{
    Access, BatteryReading, BatteryState, GpsReading, HomeReading, MESSAGES, MspAction, MspFacts, UtcTime,
    handle,
};
use betadeck::firmware::settings::Scope;
use betadeck::geo::LatLon;
use betadeck::link::proto::msp::{Decoder, Frame};
use betadeck::telemetry::{Mode, ModeFlags};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

fn unhex(text: &str) -> Vec<u8> {
    (0..text.len() / 2).map(|i| u8::from_str_radix(&text[2 * i..2 * i + 2], 16).unwrap()).collect()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The craft of the captured exchanges.
fn craft() -> Configuration {
    let mut configuration = Configuration::default();
    configuration.settings.set_text("craft_name", "SITLQUAD").unwrap();
    configuration.settings.set_number("small_angle", 180).unwrap();
    for (slot, box_id) in [0, 56, 1, 46].into_iter().enumerate() {
        configuration.modes[slot] = ModeCondition {
            box_id,
            aux_channel: slot as u8,
            start_us: 1700,
            end_us: 2100,
            ..ModeCondition::default()
        };
    }
    configuration
}

/// What that craft sensed.
fn facts() -> MspFacts {
    let mut channels = [1500; 16];
    channels[3..10].fill(1000);
    MspFacts {
        build: BuildInfo {
            version: "2026.12.0-alpha".to_owned(),
            api: "1.49".to_owned(),
            date: "Nov 21 2026".to_owned(),
            time: "02:51:34".to_owned(),
            revision: "301d01a".to_owned(),
        },
        cycle_time_us: 939,
        heading_deg: 358.0,
        gps: GpsReading {
            fix: true,
            sats: 12,
            position: LatLon::new(-275_000_000, 1_530_000_000),
            alt_amsl_m: 30.0,
            ..GpsReading::default()
        },
        channels,
        ..MspFacts::default()
    }
}

fn ask(configuration: &mut Configuration, code: u16, request: &[u8]) -> Option<Vec<u8>> {
    handle(code, request, configuration, &facts()).reply
}

/// Bytes in, bytes out, as a link does it.
fn exchange(request: &[u8], configuration: &mut Configuration, facts: &MspFacts) -> Vec<u8> {
    let mut decoder = Decoder::server();
    let mut answer = Vec::new();
    for frame in request.iter().filter_map(|&byte| decoder.push(byte)) {
        let outcome = handle(frame.code, &frame.payload, configuration, facts);
        frame.answer(outcome.reply).encode(&mut answer);
    }
    answer
}

#[test]
fn every_captured_exchange_gets_the_same_bytes() {
    let mut configuration = craft();
    let mut checked = 0;
    for line in include_str!("vectors/msp.tsv").lines().filter(|line| !line.starts_with('#')) {
        let cells: Vec<&str> = line.split('\t').collect();
        let number: u32 = cells[0].parse().unwrap();
        let request = unhex(cells[2]);
        if request[0] != b'$' {
            continue;
        }
        let mut facts = facts();
        match number {
            22 => facts.cycle_time_us = 947,
            43.. => {
                facts.armed = true;
                facts.modes.set(Mode::Arm, true);
                facts.cycle_time_us = 964;
                facts.motors_us = [1055; 4];
                facts.gps.solution = 1;
                facts.home = Some(HomeReading { distance_m: 0.2, bearing_deg: 89.3 });
            }
            _ => {}
        }
        let reply = exchange(&request, &mut configuration, &facts);
        assert_eq!(hex(&reply), cells[3].trim_start_matches('-'), "{number} {}", cells[1]);
        checked += 1;
    }
    assert_eq!(checked, 43);
}

/// The replies of the executable with that craft, by code.
const DEFAULTS: &[(u16, &str)] = &[
    (36, "82004010"),
    (32, "212b23000000024a01ae015e01"),
    (38, "000000000000"),
    (40, "02060a019001000006500000000000"),
    (42, "0300"),
    (44, "006c07dc051a0400750343080000e20400000000000000000000001e00001e0100000000000000"),
    (50, "00"),
    (56, "01050a006e0a01"),
    (59, "01"),
    (61, "0500b400"),
    (75, "0f3ce80300640001"),
    (77, "00dc0500dc0500dc05006b0301dc0501dc0501dc0501dc0501dc0501dc0501dc0501dc0501dc0501dc0501dc0501dc05"),
    (80, "0100010408000200000000"),
    (90, "01010100e001260200000000307d000000020067"),
    (
        92,
        "fa4b006400000000000000000000000000000000fa00f4010000960000fa00f4014b00960000000000000000000000050000000000000000",
    ),
    (
        94,
        "00000000000000000000000000000000003c000000500000000000010100050078007d00780000282e00002300000f64000001410f5a07000001414605",
    ),
    (96, "0001000000"),
    (111, "07004343430032000000000707000064ce07ce07ce070332"),
    (112, "2d501e2f54222d5000324b4b280000"),
    (117, "524f4c4c3b50495443483b5941573b4c4556454c3b4d41473b"),
    (124, "7e05ea05b405"),
    (125, "0000053200"),
    (126, "0000000101000000000000"),
    (131, "0000d007e803040e0000"),
    (0x3001, "080001020304050607"),
    (132, "030501000000"),
    (133, "0000"),
    (135, "32001e001400ee024c046c07fb040208ee02960000000f000a00"),
    (
        140,
        "026464646464646464000000000000000001644b0096004b00960000000000000000000164fa00f401fa00f4010000000000000000",
    ),
    (145, "010101"),
    (240, "00000000"),
    (0x300e, "004a01ae015e019a010000000a"),
    (82, "00"),
    (189, ""),
    (160, "000000000100000002000000"),
    (0x300c, "fe0953494d554c41544f52"),
    (0x300a, "1b1a0d00ffff"),
    (0x300d, "011b"),
    (70, "00000000000000000000000000"),
    (79, "0000000000000000000000"),
    (164, "00"),
    (245, "00"),
    (247, ""),
    (10, "5349544c51554144"),
];

#[test]
fn defaults_are_those_of_the_executable() {
    for (code, expected) in DEFAULTS {
        let reply = ask(&mut craft(), *code, &[]).unwrap();
        assert_eq!(hex(&reply), *expected, "message {code}");
    }
}

#[test]
fn the_rescue_gains_are_the_autopilots() {
    let mut configuration = craft();
    for (index, name) in
        ["ap_altitude_p", "ap_altitude_i", "ap_altitude_d", "ap_position_p", "ap_position_i", "ap_position_d"]
            .into_iter()
            .enumerate()
    {
        configuration.settings.set_number(name, 30 + index as i64).unwrap();
    }
    assert_eq!(hex(&ask(&mut configuration, 136, &[]).unwrap()), "1e001f0020002100220023001400");
}

#[test]
fn ports_have_the_layout_of_the_executable() {
    let reply = ask(&mut craft(), 0x1009, &[]).unwrap();
    assert_eq!(hex(&reply[..19]), "08330100000005000405340000000005000405");
    assert_eq!(reply.len(), 1 + 8 * 9);
    assert_eq!(ask(&mut craft(), 54, &[]).unwrap().len(), 56);
    assert_eq!(ask(&mut craft(), 0x100a, &[0]), None);
}

/// Messages whose setter has the layout of the getter.
const PAIRS: &[(u16, u16)] = &[
    (32, 33),
    (36, 37),
    (38, 39),
    (42, 43),
    (44, 45),
    (50, 51),
    (61, 62),
    (64, 65),
    (75, 76),
    (92, 93),
    (94, 95),
    (96, 97),
    (111, 204),
    (112, 202),
    (124, 217),
    (125, 218),
    (132, 223),
    (133, 224),
    (135, 225),
    (136, 226),
    (140, 141),
    (240, 239),
    (0x3001, 0x3002),
    (0x300e, 0x300f),
];

#[test]
fn writing_back_what_was_read_changes_nothing() {
    for (read, write) in PAIRS {
        let mut configuration = craft();
        let payload = ask(&mut configuration, *read, &[]).unwrap();
        assert_eq!(ask(&mut configuration, *write, &payload), Some(Vec::new()), "message {write}");
        assert_eq!(configuration, craft(), "message {write}");
    }
}

#[test]
fn what_is_written_is_read_back() {
    // Every byte that belongs to a setting of the default craft moves by one where its range allows.
    for (read, write) in PAIRS.iter().filter(|(read, _)| ![32, 36, 42, 64, 140, 0x300e].contains(read)) {
        let mut configuration = craft();
        let before = ask(&mut configuration, *read, &[]).unwrap();
        let changed: Vec<u8> = before.iter().map(|byte| byte ^ 1).collect();
        if ask(&mut configuration, *write, &changed).is_some() {
            let after = ask(&mut configuration, *read, &[]).unwrap();
            assert_ne!(after, before, "message {write}");
            let mut again = craft();
            ask(&mut again, *write, &after);
            assert_eq!(ask(&mut again, *read, &[]).unwrap(), after, "message {write}");
        }
    }
}

#[test]
fn settings_take_effect_and_values_out_of_range_stop_at_the_range() {
    let mut configuration = craft();
    ask(&mut configuration, 225, &[45, 0]);
    assert_eq!(configuration.settings.number("ap_max_angle"), 45);
    assert_eq!(configuration.settings.number("gps_rescue_return_alt"), 30, "no byte came for it");
    ask(&mut configuration, 225, &[200, 0]);
    assert_eq!(configuration.settings.number("ap_max_angle"), 70);
    ask(&mut configuration, 223, &[9, 5]);
    assert_eq!(configuration.settings.text("gps_provider"), "VIRTUAL", "there is no provider 9");
    ask(&mut configuration, 202, &[50, 81, 31]);
    assert_eq!(configuration.settings.number("p_roll"), 50);
    assert_eq!(configuration.settings.number("p_pitch"), 47);
    ask(&mut configuration, 37, &Feature::RxMsp.bit().to_le_bytes());
    assert!(configuration.features.has(Feature::RxMsp) && !configuration.features.has(Feature::Gps));
}

#[test]
fn requests_with_something_wrong_are_refused_and_change_nothing() {
    let wrong: &[(u16, &[u8])] = &[
        (33, &[33, 43, 35]),
        (33, &[33, 43, 50, 0, 0, 0, 2]),
        (35, &[0, 200, 0, 32, 48]),
        (35, &[0, 1, 0, 32, 48, 0, 200]),
        (35, &[0, 1, 14, 32, 48]),
        (53, &[30]),
        (65, &[0, 0, 1, 2, 3, 4, 5, 6]),
        (68, &[2]),
        (68, &[3]),
        (68, &[5]),
        (78, &[18, 1, 0, 0]),
        (78, &[5, 0, 0, 0]),
        (78, &[5, 3, 0, 0]),
        (183, &[0, 4, 0]),
        (183, &[2, 1, 0]),
        (200, &[0; 38]),
        (204, &[1; 9]),
        (214, &[0; 7]),
        (230, &[]),
        (230, &[116]),
        (230, &[1, 68]),
        (0x3006, &[]),
        (0x3006, &[6]),
        (0x3006, &[7]),
        (0x3007, &[5, 1, b'x']),
        (0x300e, &[3]),
        (0x300f, &[0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]),
        (0x3010, b"no_such_setting = 1"),
        (0x3010, b"ap_max_angle = 99"),
        (118, &[]),
        (209, &[]),
        (121, &[]),
        (0x100a, &[]),
        (88, &[]),
    ];
    for (code, payload) in wrong {
        let mut configuration = craft();
        assert_eq!(ask(&mut configuration, *code, payload), None, "message {code} {payload:?}");
        assert_eq!(configuration, craft(), "message {code} {payload:?}");
    }
    let mut averaging = ask(&mut craft(), 94, &[]).unwrap();
    averaging[50] = 4;
    assert_eq!(ask(&mut craft(), 95, &averaging), None);
}

#[test]
fn a_mode_range_carries_logic_and_link() {
    let mut configuration = craft();
    assert!(ask(&mut configuration, 35, &[5, 13, 2, 16, 32, 1, 1]).is_some());
    let extra = ask(&mut configuration, 238, &[]).unwrap();
    assert_eq!(extra[0], 20);
    assert_eq!(extra[1 + 15..1 + 18], [13, 1, 1]);
    assert_eq!(configuration.modes[5].start_us, 1300);
}

#[test]
fn names_are_cut_and_cleaned() {
    let mut configuration = craft();
    ask(&mut configuration, 11, b"a#very\x00long\xffname of a craft");
    assert_eq!(configuration.settings.text("craft_name"), "averylongname of");
    for kind in [1, 2, 3, 4, 11] {
        assert!(ask(&mut configuration, 0x3007, &[kind, 3, b'a', b'b', b'c', b'd']).is_some());
        assert_eq!(ask(&mut configuration, 0x3006, &[kind]).unwrap(), [kind, 3, b'a', b'b', b'c']);
    }
    ask(&mut configuration, 0x3007, &[2, 0]);
    assert_eq!(ask(&mut configuration, 0x3006, &[2]).unwrap(), [2, 0]);
}

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
        specific_force_flu: Vector3::new(0.0, 0.0, betadeck::geo::GRAVITY),
        rate_flu: Vector3::new(1.0, 0.5, -0.25),
        altitude_m: -1.5,
        climb_mps: 2.5,
        battery: Some(BatteryReading {
            voltage_v: 15.64,
            current_a: 12.5,
            drawn_mah: 345.6,
            cells: 4,
            state: BatteryState::Warning,
        }),
        clock: Some(UtcTime { unix_s: 1_700_000_000, millis: 500 }),
        ..facts()
    };
    let read = |code| handle(code, &[], &mut craft(), &facts).reply.unwrap();
    assert_eq!(hex(&read(108)), hex(&[123_i16, -100, 0].map(i16::to_le_bytes).concat()));
    // East is a turn of -90 degrees from north, seen from above in north-west-up.
    assert_eq!(hex(&read(167)), hex(&[23170_i16, 0, 0, -23170].map(i16::to_le_bytes).concat()));
    assert_eq!(hex(&read(102)), hex(&[0_i16, 0, 256, 57, 29, -14, 0, 0, 0].map(i16::to_le_bytes).concat()));
    assert_eq!(hex(&read(109)), "6affffff".to_owned() + "fa00");
    assert_eq!(hex(&read(110)), "9c5a010000e2041c06");
    assert_eq!(hex(&read(130)), "0400009c5a01e204011c06");
    assert_eq!(hex(&read(247)), "e7070b0e160d14f401");
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
fn commands_ask_the_owner() {
    let action = |code, payload: &[u8]| handle(code, payload, &mut craft(), &facts()).action;
    assert_eq!(action(250, &[]), Some(MspAction::Save));
    assert_eq!(action(68, &[]), Some(MspAction::Reboot));
    assert_eq!(action(208, &[]), Some(MspAction::SaveAndReboot));
    assert_eq!(action(205, &[]), Some(MspAction::CalibrateAcc));
    assert_eq!(action(206, &[]), Some(MspAction::CalibrateMag));
    assert_eq!(action(99, &[1, 0]), Some(MspAction::RunawayPrevention(true)));
    assert_eq!(action(99, &[1, 1]), Some(MspAction::RunawayPrevention(false)));
    assert_eq!(
        action(246, &unhex("00f15365f401")),
        Some(MspAction::SetClock { unix_s: 1_700_000_000, millis: 500 })
    );
    assert_eq!(action(211, &[0xa6, 0xff]), Some(MspAction::HoldHeading(-90)));
    assert_eq!(
        action(214, &[0, 4, 0, 8, 0x4c, 4, 0xe8, 3]),
        Some(MspAction::MotorTest([1024, 2000, 1100, 1000]))
    );
    let Some(MspAction::RawRc(frame)) = action(200, &[0xdc, 5, 0xdd, 5, 0xe8, 3]) else { panic!("no frame") };
    assert_eq!(frame.channels[..5], [1500, 1501, 1000, 0, 0]);
    let armed = MspFacts { armed: true, ..facts() };
    for code in [205, 206, 208, 250] {
        assert_eq!(handle(code, &[], &mut craft(), &armed).action, None, "message {code} while armed");
    }
    assert_eq!(handle(214, &[0; 8], &mut craft(), &armed).action, None);
    let reboot = handle(68, &[], &mut craft(), &armed);
    assert_eq!((reboot.reply, reboot.action), (None, None), "an armed craft is not restarted");
}

#[test]
fn profiles_are_chosen_copied_and_reset() {
    let mut configuration = craft();
    for (payload, scope, index) in [
        (2, Scope::Profile, 2),
        (9, Scope::Profile, 0),
        (0x81, Scope::RateProfile, 1),
        (0x42, Scope::BatteryProfile, 2),
    ] {
        ask(&mut configuration, 210, &[payload]);
        assert_eq!(configuration.settings.active(scope), index);
    }
    let armed = MspFacts { armed: true, ..facts() };
    assert!(handle(210, &[3], &mut configuration, &armed).reply.is_some());
    assert_eq!(configuration.settings.active(Scope::Profile), 0);

    configuration.settings.set_number("p_roll", 99).unwrap();
    ask(&mut configuration, 183, &[0, 3, 0]);
    ask(&mut configuration, 219, &[]);
    assert_eq!(configuration.settings.number("p_roll"), 45);
    ask(&mut configuration, 210, &[3]);
    assert_eq!(configuration.settings.number("p_roll"), 99);
}

#[test]
fn sliders_move_gains_and_filters_and_are_validated() {
    let mut configuration = craft();
    let mut payload = ask(&mut configuration, 140, &[]).unwrap();
    payload[1] = 200; // master
    payload[18] = 50; // D-term filter
    let computed = ask(&mut configuration, 142, &payload[..17]).unwrap();
    assert_eq!(hex(&computed[..6]), hex(&[90, 160, 60, 80, 240, 0]));
    assert_eq!(configuration, craft(), "calculating stores nothing");
    ask(&mut configuration, 141, &payload);
    assert_eq!(configuration.settings.number("p_roll"), 90);
    assert_eq!(configuration.settings.number("d_max_pitch"), 92);
    assert_eq!(configuration.settings.number("dterm_lpf1_static_hz"), 38);
    assert_eq!(configuration.settings.number("gyro_lpf1_static_hz"), 250);
    assert_eq!(hex(&ask(&mut configuration, 145, &[]).unwrap()), "010101");
    configuration.settings.set_number("p_roll", 91).unwrap();
    configuration.settings.set_number("gyro_lpf2_static_hz", 499).unwrap();
    assert_eq!(hex(&ask(&mut configuration, 145, &[]).unwrap()), "000001");
}

#[test]
fn failure_rules_keep_their_pulse() {
    let mut configuration = craft();
    ask(&mut configuration, 78, &[5, 2, 0x4c, 4]);
    assert_eq!(configuration.rx_fail.0[5].mode, RxFailMode::Set);
    let reply = ask(&mut configuration, 77, &[]).unwrap();
    assert_eq!(hex(&reply[15..18]), "024c04");
}

#[test]
fn several_questions_in_one_are_cut_at_what_fits() {
    let codes = [94; 20];
    let reply = ask(&mut craft(), 230, &codes).unwrap();
    assert_eq!(reply.len(), 8 * 62, "eight answers of 61 bytes fit into 512");
}

#[test]
fn settings_by_name() {
    let mut configuration = craft();
    assert_eq!(ask(&mut configuration, 0x3010, b"ap_max_angle = 35").unwrap(), b"ap_max_angle = 35");
    assert_eq!(ask(&mut configuration, 0x3010, b"ap_max_angle").unwrap(), b"ap_max_angle = 35");
    let info = ask(&mut configuration, 0x3011, b"ap_yaw_mode").unwrap();
    let text = String::from_utf8(info[2..].to_vec()).unwrap();
    assert_eq!(usize::from(u16::from_le_bytes([info[0], info[1]])), text.len());
    assert!(text.contains("values=VELOCITY,BEARING,HYBRID,FIXED,DAMPENER\n"), "{text}");
    assert!(text.contains("default=VELOCITY\n"), "{text}");
    let paged = ask(&mut configuration, 0x3011, b"ap_yaw_mode\x00\x05\x00").unwrap();
    assert_eq!(paged[2..], info[2 + 5..]);
}

#[test]
fn the_table_is_sorted_and_every_reading_message_answers() {
    assert!(MESSAGES.is_sorted_by_key(|message| message.code));
    for message in MESSAGES.iter().filter(|message| message.access == Access::Read) {
        let mut configuration = craft();
        let outcome = handle(message.code, &[], &mut configuration, &facts());
        assert!(outcome.reply.is_some(), "{}", message.name);
        assert_eq!(outcome.action, None, "{}", message.name);
        assert_eq!(configuration, craft(), "{}", message.name);
    }
}

/// The rows of the manual's table of messages.
fn manual_rows() -> String {
    use std::fmt::Write;
    let mut rows = "| code | message | |\n| --- | --- | --- |\n".to_owned();
    for message in MESSAGES {
        writeln!(rows, "| {} | {} | {} |", message.code, message.name, message.access).unwrap();
    }
    rows
}

#[test]
fn the_manual_lists_every_message() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/links.md");
    let manual = std::fs::read_to_string(path).unwrap();
    let marks = ["`the_manual_lists_every_message` -->\n", "<!-- end of messages -->"];
    let start = manual.find(marks[0]).unwrap() + marks[0].len();
    let end = manual.find(marks[1]).unwrap();
    if std::env::var_os("UPDATE_MANUAL").is_some() {
        let updated = format!("{}{}{}", &manual[..start], manual_rows(), &manual[end..]);
        return std::fs::write(path, updated).unwrap();
    }
    assert_eq!(&manual[start..end], manual_rows(), "run this test with UPDATE_MANUAL=1");
}

proptest! {
    #[test]
    fn no_payload_does_harm(index in 0..MESSAGES.len(), payload in prop::collection::vec(any::<u8>(), 0..192)) {
        let mut configuration = craft();
        let message = &MESSAGES[index];
        let outcome = handle(message.code, &payload, &mut configuration, &facts());
        if let Some(reply) = outcome.reply {
            let frame = Frame::request(betadeck::link::proto::msp::Form::V2, message.code, &[]).answer(Some(reply));
            prop_assert!(frame.payload.len() <= 4096);
        }
        // Whatever came, the craft can still be described.
        for message in MESSAGES.iter().filter(|message| message.access == Access::Read) {
            prop_assert!(handle(message.code, &[], &mut configuration, &facts()).reply.is_some());
        }
    }
}
