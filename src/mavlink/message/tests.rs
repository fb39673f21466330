use std::collections::BTreeSet;

use proptest::prelude::*;

use super::*;

/// Number, name, CRC_EXTRA, lengths with and without extension fields, as the generator of pymavlink computes them from the
/// message definitions of 2026-07.
const KNOWN: &[(u32, &str, u8, usize, usize)] = &[
    (0, "HEARTBEAT", 50, 9, 9),
    (1, "SYS_STATUS", 124, 43, 31),
    (2, "SYSTEM_TIME", 137, 12, 12),
    (4, "PING", 237, 14, 14),
    (11, "SET_MODE", 89, 6, 6),
    (20, "PARAM_REQUEST_READ", 214, 20, 20),
    (21, "PARAM_REQUEST_LIST", 159, 2, 2),
    (22, "PARAM_VALUE", 220, 25, 25),
    (23, "PARAM_SET", 168, 23, 23),
    (24, "GPS_RAW_INT", 24, 52, 30),
    (29, "SCALED_PRESSURE", 115, 16, 14),
    (30, "ATTITUDE", 39, 28, 28),
    (31, "ATTITUDE_QUATERNION", 246, 48, 32),
    (32, "LOCAL_POSITION_NED", 185, 28, 28),
    (33, "GLOBAL_POSITION_INT", 104, 28, 28),
    (35, "RC_CHANNELS_RAW", 244, 22, 22),
    (36, "SERVO_OUTPUT_RAW", 222, 37, 21),
    (37, "MISSION_REQUEST_PARTIAL_LIST", 212, 7, 6),
    (38, "MISSION_WRITE_PARTIAL_LIST", 9, 7, 6),
    (39, "MISSION_ITEM", 254, 38, 37),
    (40, "MISSION_REQUEST", 230, 5, 4),
    (41, "MISSION_SET_CURRENT", 28, 4, 4),
    (42, "MISSION_CURRENT", 28, 18, 2),
    (43, "MISSION_REQUEST_LIST", 132, 3, 2),
    (44, "MISSION_COUNT", 221, 9, 4),
    (45, "MISSION_CLEAR_ALL", 232, 3, 2),
    (46, "MISSION_ITEM_REACHED", 11, 2, 2),
    (47, "MISSION_ACK", 153, 8, 3),
    (49, "GPS_GLOBAL_ORIGIN", 39, 20, 12),
    (51, "MISSION_REQUEST_INT", 196, 5, 4),
    (62, "NAV_CONTROLLER_OUTPUT", 183, 26, 26),
    (65, "RC_CHANNELS", 118, 42, 42),
    (66, "REQUEST_DATA_STREAM", 148, 6, 6),
    (69, "MANUAL_CONTROL", 243, 30, 11),
    (70, "RC_CHANNELS_OVERRIDE", 124, 38, 18),
    (73, "MISSION_ITEM_INT", 38, 38, 37),
    (74, "VFR_HUD", 20, 20, 20),
    (75, "COMMAND_INT", 158, 35, 35),
    (76, "COMMAND_LONG", 152, 33, 33),
    (77, "COMMAND_ACK", 143, 10, 3),
    (110, "FILE_TRANSFER_PROTOCOL", 84, 254, 254),
    (111, "TIMESYNC", 34, 18, 16),
    (147, "BATTERY_STATUS", 154, 54, 36),
    (148, "AUTOPILOT_VERSION", 178, 78, 60),
    (162, "FENCE_STATUS", 189, 9, 8),
    (168, "WIND", 1, 12, 12),
    (231, "WIND_COV", 105, 40, 40),
    (242, "HOME_POSITION", 104, 60, 52),
    (244, "MESSAGE_INTERVAL", 95, 6, 6),
    (245, "EXTENDED_SYS_STATE", 130, 2, 2),
    (253, "STATUSTEXT", 83, 54, 51),
    (300, "PROTOCOL_VERSION", 217, 22, 22),
    (435, "AVAILABLE_MODES", 134, 46, 46),
    (436, "CURRENT_MODE", 193, 9, 9),
    (437, "AVAILABLE_MODES_MONITOR", 30, 1, 1),
];

#[test]
fn the_checksum_byte_and_the_lengths_of_every_message_are_those_of_the_definitions() {
    let ours: Vec<_> = table()
        .iter()
        .map(|info| (info.id, info.name, info.crc_extra, info.length, info.base_length))
        .collect();
    assert_eq!(ours, KNOWN);
}

#[test]
fn the_table_is_sorted_and_every_row_is_found() {
    let ids: Vec<u32> = table().iter().map(|info| info.id).collect();
    assert!(ids.is_sorted_by(|a, b| a < b));
    for info in table() {
        assert_eq!(MessageInfo::find(info.id), Some(info));
        assert!(info.length <= 255 && info.base_length <= info.length, "{info:?}");
        assert!(!info.summary.is_empty());
    }
    assert_eq!(MessageInfo::find(9999), None);
    assert_eq!(Message::decode(9999, &[]), None);
    assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), table().len());
}

#[test]
fn a_default_message_is_all_zeros() {
    let mut bytes = Vec::new();
    Message::from(HomePosition::default()).encode(&mut bytes);
    assert_eq!(bytes, [0; 60]);
}

proptest! {
    #[test]
    fn every_message_with_any_content_is_encoded_as_it_was_decoded(
        at in 0..table().len(),
        payload in prop::collection::vec(any::<u8>(), 0..=255),
    ) {
        let info = &table()[at];
        let message = Message::decode(info.id, &payload).unwrap();
        prop_assert_eq!(message.info(), info);
        let mut bytes = Vec::new();
        message.encode(&mut bytes);
        let mut whole = payload;
        whole.resize(info.length, 0);
        prop_assert_eq!(bytes, whole);
    }
}
