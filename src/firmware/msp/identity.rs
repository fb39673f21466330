//! The identity of the flight controller.

use super::{Call, Refused};

/// The version of the MSP protocol.
const PROTOCOL: u8 = 0;
/// The major and minor API version.
const API: (u8, u8) = (1, 49);
/// The year since 2000, month and patch of the firmware version.
const VERSION: [u8; 3] = [26, 12, 0];
/// The target and board identifier.
const TARGET: &str = "SITL";
/// The code of a microcontroller that is named by a text.
const MCU_NAMED: u8 = 0xfe;
/// A board without OSD chip. Configurators stop polling if this is neither 0 nor 2.
const WITHOUT_OSD_CHIP: u8 = 0;
/// The code for a configured board.
const CONFIGURED: u8 = 1;

/// The numbers of the options that are built in. Configurators show only the tabs of these.
pub(super) const BUILD_OPTIONS: [u16; 6] = [
    16_422, // ALTITUDE_HOLD
    16_427, // FLIGHT_PLAN
    16_412, // GPS
    16_415, // MAG
    16_425, // POSITION_HOLD
    8_235,  // PWM_OUTPUT
];

pub(super) fn api_version(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.bytes(&[PROTOCOL, API.0, API.1]);
    Ok(())
}

pub(super) fn fc_variant(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.bytes(b"BTFL");
    Ok(())
}

pub(super) fn fc_version(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.bytes(&VERSION);
    call.reply.prefixed(&call.facts.build.version);
    Ok(())
}

pub(super) fn board_info(call: &mut Call<'_>) -> Result<(), Refused> {
    let reply = &mut call.reply;
    reply.bytes(TARGET.as_bytes());
    reply.u16(0); // hardware revision
    reply.u8(WITHOUT_OSD_CHIP);
    reply.u8(0); // capabilities
    reply.prefixed(TARGET);
    reply.prefixed(&call.configuration.board_name);
    reply.prefixed(&call.configuration.manufacturer_id);
    reply.zeros(32); // signature
    reply.u8(MCU_NAMED);
    reply.u8(CONFIGURED);
    reply.u16(call.facts.gyro_hz);
    reply.u32(0); // problems
    reply.bytes(&[0, 0]); // SPI and I2C devices
    Ok(())
}

pub(super) fn build_info(call: &mut Call<'_>) -> Result<(), Refused> {
    let build = &call.facts.build;
    for (text, size) in [(&build.date, 11), (&build.time, 8), (&build.revision, 7)] {
        let mut field = vec![b' '; size];
        for (place, byte) in field.iter_mut().zip(text.bytes()) {
            *place = byte;
        }
        call.reply.bytes(&field);
    }
    for option in BUILD_OPTIONS {
        call.reply.u16(option);
    }
    Ok(())
}

pub(super) fn uid(call: &mut Call<'_>) -> Result<(), Refused> {
    for part in 0_u8..3 {
        call.reply.u32(part);
    }
    Ok(())
}

pub(super) fn mcu_info(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.u8(MCU_NAMED);
    call.reply.prefixed("SIMULATOR");
    Ok(())
}
