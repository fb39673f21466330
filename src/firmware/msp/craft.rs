//! Features, mixer, alignment, motors, ports, flight recorder.

use super::layout::{Field, byte, i16, u8, u16, word};
use super::{Call, Refused};
use crate::firmware::blackbox::{DISABLED_FIELDS, Schedule, disabled_mask};
use crate::firmware::config::{BAUD_RATES, Features, MixerKind};
use crate::firmware::settings::Value;

/// The identifier of UART1 in the port messages.
const UART1: u8 = 51;
/// The functions of a port.
const FUNCTION_MSP: u32 = 1 << 0;
const FUNCTION_GPS: u32 = 1 << 1;
const FUNCTION_RX: u32 = 1 << 6;
const FUNCTION_BLACKBOX: u32 = 1 << 7;
/// The settings that give a port its function.
const PORT_SETTINGS: [(&str, u32); 6] = [
    ("msp_uart_1", FUNCTION_MSP),
    ("msp_uart_2", FUNCTION_MSP),
    ("msp_uart_3", FUNCTION_MSP),
    ("gps_uart", FUNCTION_GPS),
    ("rx_uart", FUNCTION_RX),
    ("blackbox_uart", FUNCTION_BLACKBOX),
];

pub(super) fn features(call: &mut Call<'_>) {
    call.reply.u32(call.configuration.features.0);
}

pub(super) fn set_features(call: &mut Call<'_>) {
    call.configuration.features = Features(call.request.u32());
}

pub(super) fn mixer(call: &mut Call<'_>) {
    let reversed = call.setting("yaw_motors_reversed");
    call.reply.u8(call.configuration.mixer as u8);
    call.reply.u8(reversed);
}

pub(super) fn set_mixer(call: &mut Call<'_>) -> Result<(), Refused> {
    call.configuration.mixer = MixerKind::from_repr(call.request.u8()).ok_or(Refused)?;
    if call.request.remaining() > 0 {
        let reversed = i64::from(call.request.u8());
        call.set("yaw_motors_reversed", reversed);
    }
    Ok(())
}

/// `BOARD_ALIGNMENT_CONFIG`.
pub(super) const BOARD_ALIGNMENT: &[Field] =
    &[i16("align_board_roll"), i16("align_board_pitch"), i16("align_board_yaw")];

/// `ARMING_CONFIG`.
pub(super) const ARMING: &[Field] =
    &[u8("auto_disarm_delay"), byte(0), u8("small_angle"), u8("gyro_cal_on_first_arm")];

/// `SENSOR_CONFIG`.
pub(super) const SENSORS: &[Field] =
    &[u8("acc_hardware"), u8("baro_hardware"), u8("mag_hardware"), byte(0), byte(0)];

/// `ACC_TRIM`.
pub(super) const ACC_TRIM: &[Field] = &[i16("acc_trim_pitch"), i16("acc_trim_roll")];

/// `MOTOR_3D_CONFIG`.
pub(super) const MOTOR_3D: &[Field] = &[u16("3d_deadband_low"), u16("3d_deadband_high"), u16("3d_neutral")];

/// `SENSOR_ALIGNMENT`: gyro, accelerometer, magnetometer, gyros found, gyros used, magnetometer angles.
pub(super) const ALIGNMENT: &[Field] = &[
    byte(0),
    byte(0),
    u8("align_mag"),
    byte(1),
    byte(1),
    i16("mag_align_roll"),
    i16("mag_align_pitch"),
    i16("mag_align_yaw"),
];

/// `SET_SENSOR_ALIGNMENT`, without the gyros found.
pub(super) const SET_ALIGNMENT: &[Field] = &[
    byte(0),
    byte(0),
    u8("align_mag"),
    byte(1),
    i16("mag_align_roll"),
    i16("mag_align_pitch"),
    i16("mag_align_yaw"),
];

/// `MOTOR_CONFIG`: lowest throttle (unused), motor range, motors, poles, DShot telemetry, ESC sensor.
pub(super) const MOTOR: &[Field] =
    &[word(0), u16("max_throttle"), u16("min_command"), byte(4), u8("motor_poles"), byte(0), byte(0)];

/// `SET_MOTOR_CONFIG`, without the values that only the craft can report.
pub(super) const SET_MOTOR: &[Field] =
    &[word(0), u16("max_throttle"), u16("min_command"), u8("motor_poles"), byte(0)];

const REORDERING: &str = "motor_output_reordering";

pub(super) fn motor_reordering(call: &mut Call<'_>) {
    let order = call.configuration.settings.array(REORDERING);
    call.reply.u8(order.len() as i64);
    for &output in order {
        call.reply.u8(output);
    }
}

pub(super) fn set_motor_reordering(call: &mut Call<'_>) -> Result<(), Refused> {
    let mut order = call.configuration.settings.array(REORDERING).to_vec();
    let count = usize::from(call.request.u8());
    for output in order.iter_mut().take(count) {
        *output = i64::from(call.request.u8());
    }
    call.configuration.settings.set(REORDERING, Value::Array(order)).map_err(|_| Refused)
}

/// Returns for every port its identifier, its functions, and the indices of the MSP, GPS, telemetry and flight recorder
/// speeds in the list of speeds.
fn ports(call: &Call<'_>) -> Vec<(u8, u32, [u8; 4])> {
    let rows = &call.configuration.serial.0;
    let ports = (UART1..).zip(1_i64..).zip(rows);
    ports
        .map(|((id, number), row)| {
            let named = PORT_SETTINGS.iter().filter(|(name, _)| call.setting(name) == number);
            let functions = named.fold(row.functions, |functions, (_, function)| functions | function);
            let bauds = [row.msp_baud, row.gps_baud, row.telemetry_baud, row.blackbox_baud];
            (id, functions, bauds.map(baud_index))
        })
        .collect()
}

fn baud_index(baud: u32) -> u8 {
    BAUD_RATES.iter().position(|&rate| rate == baud).unwrap_or(0) as u8
}

pub(super) fn serial_config(call: &mut Call<'_>) {
    for (id, functions, bauds) in ports(call) {
        call.reply.u8(id);
        call.reply.u16(functions);
        call.reply.bytes(&bauds);
    }
}

pub(super) fn common_serial_config(call: &mut Call<'_>) {
    let ports = ports(call);
    call.reply.u8(ports.len() as i64);
    for (id, functions, bauds) in ports {
        call.reply.u8(id);
        call.reply.u32(functions);
        call.reply.bytes(&bauds);
    }
}

pub(super) fn blackbox(call: &mut Call<'_>) {
    let (device, rate) = (call.setting("blackbox_device"), call.setting("blackbox_sample_rate"));
    let schedule = Schedule::new(call.facts.pid_cycle_time_us, rate as u8);
    let disabled = disabled_mask(&call.configuration.settings);
    call.reply.u8(1); // supported
    call.reply.u8(device);
    call.reply.u8(1);
    call.reply.u8(1 << rate);
    call.reply.u16(schedule.i_interval() / schedule.p_interval());
    call.reply.u8(rate);
    call.reply.u32(disabled);
}

pub(super) fn set_blackbox(call: &mut Call<'_>) {
    let device = i64::from(call.request.u8());
    call.request.u8();
    let denominator = call.request.u8();
    call.request.u16();
    let rate = match call.request.remaining() {
        0 => i64::from(denominator.max(1).ilog2()),
        _ => i64::from(call.request.u8()),
    };
    call.set("blackbox_device", device);
    call.set("blackbox_sample_rate", rate);
    if call.request.remaining() > 0 {
        let disabled = call.request.u32();
        for (bit, name) in DISABLED_FIELDS {
            call.set(name, i64::from(disabled >> bit & 1));
        }
    }
}

/// `OSD_CANVAS`: empty, because there is no OSD.
pub(super) const NOTHING: &[Field] = &[];
