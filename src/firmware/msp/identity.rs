//! The identity of the flight controller.

use super::Call;
use crate::msp::{
    ApiVersion, BETAFLIGHT, BoardInfo, BuildInfo, FLIGHT_PLAN_OPTION, FcVersion, PROCESSOR_NAMED,
};

const API: ApiVersion = ApiVersion { major: 1, minor: 49 };
/// The year since 2000, month and patch of the firmware version.
const VERSION: [u8; 3] = [26, 12, 0];
/// The target and board identifier.
const TARGET: &str = "SITL";

/// The numbers of the options that are built in. Configurators show only the tabs of these.
const BUILD_OPTIONS: [u16; 6] = [
    16_422, // ALTITUDE_HOLD
    FLIGHT_PLAN_OPTION,
    16_412, // GPS
    16_415, // MAG
    16_425, // POSITION_HOLD
    8_235,  // PWM_OUTPUT
];

pub(super) fn api_version(call: &mut Call<'_>) {
    API.encode(&mut call.reply);
}

pub(super) fn fc_variant(call: &mut Call<'_>) {
    call.reply.bytes(BETAFLIGHT);
}

pub(super) fn fc_version(call: &mut Call<'_>) {
    let text = Some(call.facts.build.version.clone());
    FcVersion { numbers: VERSION, text }.encode(&mut call.reply);
}

pub(super) fn board_info(call: &mut Call<'_>) {
    let board = BoardInfo {
        identifier: TARGET.to_owned(),
        target: Some(TARGET.to_owned()),
        name: Some(call.configuration.board_name.clone()),
        manufacturer: Some(call.configuration.manufacturer_id.clone()),
        configured: Some(true),
        gyro_hz: Some(call.facts.gyro_hz.try_into().unwrap_or(u16::MAX)),
    };
    board.encode(&mut call.reply);
}

pub(super) fn build_info(call: &mut Call<'_>) {
    let build = call.facts.build.clone();
    let options = Some(BUILD_OPTIONS.to_vec());
    BuildInfo { date: build.date, time: build.time, revision: build.revision, options }
        .encode(&mut call.reply);
}

pub(super) fn uid(call: &mut Call<'_>) {
    for part in 0_u8..3 {
        call.reply.u32(part);
    }
}

pub(super) fn mcu_info(call: &mut Call<'_>) {
    call.reply.u8(PROCESSOR_NAMED);
    call.reply.prefixed("SIMULATOR");
}
