//! Replies that equal those of the real executable byte for byte.

use betadeck_core::firmware::config::Configuration;
use betadeck_core::firmware::msp::{MspFacts, handle};
use betadeck_core::msp::{Decoder, HomeVector};
use betadeck_core::telemetry::Mode;
use test_support::hex;

use super::{ask, craft, facts};

/// Decodes request bytes and returns the reply bytes, as a link does.
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
    for line in include_str!("../../../vectors/msp.tsv").lines().filter(|line| !line.starts_with('#')) {
        let cells: Vec<&str> = line.split('\t').collect();
        let number: u32 = cells[0].parse().unwrap();
        let request = hex::decode(cells[2]);
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
                facts.home = HomeVector { distance_m: 0.2, bearing_deg: 89.3, toggle: true };
            }
            _ => {}
        }
        let reply = exchange(&request, &mut configuration, &facts);
        assert_eq!(hex::encode(&reply), cells[3].trim_start_matches('-'), "{number} {}", cells[1]);
        checked += 1;
    }
    assert_eq!(checked, 43);
}

/// The executable's replies for the craft of [`craft`], by message code.
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
        assert_eq!(hex::encode(&reply), *expected, "message {code}");
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
    assert_eq!(hex::encode(&ask(&mut configuration, 136, &[]).unwrap()), "1e001f0020002100220023001400");
}

#[test]
fn ports_have_the_layout_of_the_executable() {
    let reply = ask(&mut craft(), 0x1009, &[]).unwrap();
    assert_eq!(hex::encode(&reply[..19]), "08330100000005040005340000000005040005");
    assert_eq!(reply.len(), 1 + 8 * 9);
    assert_eq!(ask(&mut craft(), 54, &[]).unwrap().len(), 56);
    assert_eq!(ask(&mut craft(), 0x100a, &[0]), None);
}
