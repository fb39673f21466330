//! Messages that change the configuration, and the values that they refuse.

use betadeck_core::firmware::config::{Feature, RxFailMode};

use super::{ask, craft};
use test_support::hex;

/// Pairs of a getter and a setter with the same layout.
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
    // Flips the lowest bit of every byte. A setter may refuse the result.
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
fn sliders_move_gains_and_filters_and_are_validated() {
    let mut configuration = craft();
    let mut payload = ask(&mut configuration, 140, &[]).unwrap();
    payload[1] = 200; // master
    payload[18] = 50; // D-term filter
    let computed = ask(&mut configuration, 142, &payload[..17]).unwrap();
    assert_eq!(hex::encode(&computed[..6]), hex::encode(&[90, 160, 60, 80, 240, 0]));
    assert_eq!(configuration, craft(), "calculating stores nothing");
    ask(&mut configuration, 141, &payload);
    assert_eq!(configuration.settings.number("p_roll"), 90);
    assert_eq!(configuration.settings.number("d_max_pitch"), 92);
    assert_eq!(configuration.settings.number("dterm_lpf1_static_hz"), 38);
    assert_eq!(configuration.settings.number("gyro_lpf1_static_hz"), 250);
    assert_eq!(hex::encode(&ask(&mut configuration, 145, &[]).unwrap()), "010101");
    configuration.settings.set_number("p_roll", 91).unwrap();
    configuration.settings.set_number("gyro_lpf2_static_hz", 499).unwrap();
    assert_eq!(hex::encode(&ask(&mut configuration, 145, &[]).unwrap()), "000001");
}

#[test]
fn failure_rules_keep_their_pulse() {
    let mut configuration = craft();
    ask(&mut configuration, 78, &[5, 2, 0x4c, 4]);
    assert_eq!(configuration.rx_fail.0[5].mode, RxFailMode::Set);
    let reply = ask(&mut configuration, 77, &[]).unwrap();
    assert_eq!(hex::encode(&reply[15..18]), "024c04");
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
