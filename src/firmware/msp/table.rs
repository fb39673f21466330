//! Every message that the server supports. Any other code gets the protocol's error.

use super::layout::{self, Field};
use super::{
    Call, Refused, commands, craft, flash, gps, identity, modes, multiple, power, receiver, setting,
    simplified, state, text, tuning,
};
use crate::msp::code::{self, MessageKind};

/// The way in which a message is answered.
#[derive(Debug, Clone, Copy)]
pub(super) enum Handler {
    Answer(fn(&mut Call<'_>)),
    /// Checks the request before it answers.
    Check(fn(&mut Call<'_>) -> Result<(), Refused>),
    /// Replies with the values of settings.
    Get(&'static [Field]),
    /// Sets settings, unless the payload is shorter than this.
    Set(&'static [Field], usize),
}

impl Handler {
    pub(super) fn run(&self, call: &mut Call<'_>) -> Result<(), Refused> {
        match *self {
            Self::Answer(answer) => answer(call),
            Self::Check(check) => return check(call),
            Self::Get(fields) => layout::read(fields, &call.configuration.settings, &mut call.reply),
            Self::Set(_, shortest) if call.request.remaining() < shortest => return Err(Refused),
            Self::Set(fields, _) => {
                layout::write(fields, &mut call.configuration.settings, &mut call.request);
            }
        }
        Ok(())
    }
}

/// A message that the server answers.
#[derive(Debug, Clone, Copy)]
#[doc(hidden)]
pub struct Message {
    pub kind: MessageKind,
    pub(super) handler: Handler,
}

const fn row(code: u16, handler: Handler) -> Message {
    Message { kind: code::row(code), handler }
}

const fn answer(code: u16, handler: fn(&mut Call<'_>)) -> Message {
    row(code, Handler::Answer(handler))
}

const fn check(code: u16, handler: fn(&mut Call<'_>) -> Result<(), Refused>) -> Message {
    row(code, Handler::Check(handler))
}

const fn get(code: u16, fields: &'static [Field]) -> Message {
    row(code, Handler::Get(fields))
}

const fn set(code: u16, fields: &'static [Field]) -> Message {
    set_from(code, fields, 0)
}

const fn set_from(code: u16, fields: &'static [Field], shortest: usize) -> Message {
    row(code, Handler::Set(fields, shortest))
}

/// Returns the message with this code.
pub(super) fn find(code: u16) -> Option<&'static Message> {
    let index = MESSAGES.binary_search_by_key(&code, |message| message.kind.code).ok()?;
    MESSAGES.get(index)
}

/// All messages in the order of their codes.
#[doc(hidden)]
pub static MESSAGES: &[Message] = &[
    answer(code::API_VERSION, identity::api_version),
    answer(code::FC_VARIANT, identity::fc_variant),
    answer(code::FC_VERSION, identity::fc_version),
    answer(code::BOARD_INFO, identity::board_info),
    answer(code::BUILD_INFO, identity::build_info),
    answer(code::NAME, text::name),
    check(code::SET_NAME, text::set_name),
    answer(code::BATTERY_CONFIG, power::battery_config),
    check(code::SET_BATTERY_CONFIG, power::set_battery_config),
    answer(code::MODE_RANGES, modes::mode_ranges),
    check(code::SET_MODE_RANGE, modes::set_mode_range),
    answer(code::FEATURE_CONFIG, craft::features),
    answer(code::SET_FEATURE_CONFIG, craft::set_features),
    get(code::BOARD_ALIGNMENT_CONFIG, craft::BOARD_ALIGNMENT),
    set(code::SET_BOARD_ALIGNMENT_CONFIG, craft::BOARD_ALIGNMENT),
    answer(code::CURRENT_METER_CONFIG, power::current_meter_config),
    answer(code::SET_CURRENT_METER_CONFIG, power::set_current_meter_config),
    answer(code::MIXER_CONFIG, craft::mixer),
    check(code::SET_MIXER_CONFIG, craft::set_mixer),
    get(code::RX_CONFIG, receiver::RX),
    set(code::SET_RX_CONFIG, receiver::RX),
    get(code::RSSI_CONFIG, power::RSSI),
    set(code::SET_RSSI_CONFIG, power::RSSI),
    answer(code::ADJUSTMENT_RANGES, modes::adjustment_ranges),
    check(code::SET_ADJUSTMENT_RANGE, modes::set_adjustment_range),
    answer(code::CF_SERIAL_CONFIG, craft::serial_config),
    answer(code::VOLTAGE_METER_CONFIG, power::voltage_meter_config),
    answer(code::SET_VOLTAGE_METER_CONFIG, power::set_voltage_meter_config),
    answer(code::SONAR_ALTITUDE, state::sonar_altitude),
    get(code::PID_CONTROLLER, tuning::PID_CONTROLLER),
    set(code::SET_PID_CONTROLLER, tuning::PID_CONTROLLER),
    get(code::ARMING_CONFIG, craft::ARMING),
    set(code::SET_ARMING_CONFIG, craft::ARMING),
    answer(code::RX_MAP, receiver::rx_map),
    check(code::SET_RX_MAP, receiver::set_rx_map),
    check(code::REBOOT, commands::reboot),
    answer(code::DATAFLASH_SUMMARY, flash::summary),
    check(code::DATAFLASH_READ, flash::read),
    check(code::DATAFLASH_ERASE, flash::erase),
    get(code::FAILSAFE_CONFIG, receiver::FAILSAFE),
    set(code::SET_FAILSAFE_CONFIG, receiver::FAILSAFE),
    answer(code::RXFAIL_CONFIG, receiver::rxfail),
    check(code::SET_RXFAIL_CONFIG, receiver::set_rxfail),
    answer(code::SDCARD_SUMMARY, state::sdcard_summary),
    answer(code::BLACKBOX_CONFIG, craft::blackbox),
    answer(code::SET_BLACKBOX_CONFIG, craft::set_blackbox),
    get(code::TRANSPONDER_CONFIG, power::NONE),
    answer(code::ADVANCED_CONFIG, tuning::advanced),
    set(code::SET_ADVANCED_CONFIG, tuning::ADVANCED),
    answer(code::FILTER_CONFIG, tuning::filters),
    answer(code::SET_FILTER_CONFIG, tuning::set_filters),
    get(code::PID_ADVANCED, tuning::PID_ADVANCED),
    check(code::SET_PID_ADVANCED, tuning::set_pid_advanced),
    get(code::SENSOR_CONFIG, craft::SENSORS),
    set(code::SET_SENSOR_CONFIG, craft::SENSORS),
    answer(code::SET_ARMING_DISABLED, commands::set_arming_disabled),
    answer(code::STATUS, state::status),
    answer(code::RAW_IMU, state::raw_imu),
    answer(code::MOTOR, state::motor),
    answer(code::RC, state::rc),
    answer(code::RAW_GPS, state::raw_gps),
    answer(code::COMP_GPS, state::comp_gps),
    answer(code::ATTITUDE, state::attitude),
    answer(code::ALTITUDE, state::altitude),
    answer(code::ANALOG, state::analog),
    get(code::RC_TUNING, tuning::RATES),
    get(code::PID, tuning::PID),
    answer(code::BOXNAMES, modes::box_names),
    answer(code::PIDNAMES, tuning::pid_names),
    answer(code::BOXIDS, modes::box_ids),
    get(code::MOTOR_3D_CONFIG, craft::MOTOR_3D),
    get(code::RC_DEADBAND, receiver::DEADBAND),
    get(code::SENSOR_ALIGNMENT, craft::ALIGNMENT),
    answer(code::VOLTAGE_METERS, state::voltage_meters),
    answer(code::CURRENT_METERS, state::current_meters),
    answer(code::BATTERY_STATE, state::battery_state),
    get(code::MOTOR_CONFIG, craft::MOTOR),
    get(code::GPS_CONFIG, gps::GPS),
    get(code::COMPASS_CONFIG, gps::COMPASS),
    get(code::GPS_RESCUE, gps::RESCUE),
    get(code::GPS_RESCUE_PIDS, gps::RESCUE_PIDS),
    answer(code::MOTOR_TELEMETRY, state::motor_telemetry),
    answer(code::SIMPLIFIED_TUNING, simplified::tuning),
    answer(code::SET_SIMPLIFIED_TUNING, simplified::set_tuning),
    answer(code::CALCULATE_SIMPLIFIED_PID, simplified::calculate_pid),
    answer(code::CALCULATE_SIMPLIFIED_GYRO, simplified::calculate_gyro),
    answer(code::CALCULATE_SIMPLIFIED_DTERM, simplified::calculate_dterm),
    answer(code::VALIDATE_SIMPLIFIED_TUNING, simplified::validate),
    answer(code::STATUS_EX, state::status_ex),
    answer(code::UID, identity::uid),
    answer(code::GPSSVINFO, state::satellites),
    answer(code::ATTITUDE_QUATERNION, state::attitude_quaternion),
    check(code::COPY_PROFILE, commands::copy_profile),
    answer(code::TX_INFO, state::tx_info),
    get(code::OSD_CANVAS, craft::NOTHING),
    check(code::SET_RAW_RC, commands::set_raw_rc),
    answer(code::SET_RAW_GPS, commands::set_raw_gps),
    set(code::SET_PID, tuning::PID),
    set_from(code::SET_RC_TUNING, tuning::RATES, tuning::RATES_MIN),
    answer(code::ACC_CALIBRATION, commands::calibrate_acc),
    answer(code::MAG_CALIBRATION, commands::calibrate_mag),
    answer(code::RESET_CONF, commands::reset_conf),
    answer(code::SELECT_SETTING, commands::select_setting),
    answer(code::SET_HEADING, commands::set_heading),
    check(code::SET_MOTOR, commands::set_motor),
    set(code::SET_MOTOR_3D_CONFIG, craft::MOTOR_3D),
    set(code::SET_RC_DEADBAND, receiver::DEADBAND),
    check(code::SET_RESET_CURR_PID, commands::reset_pid_profile),
    set(code::SET_SENSOR_ALIGNMENT, craft::SET_ALIGNMENT),
    set(code::SET_MOTOR_CONFIG, craft::SET_MOTOR),
    set(code::SET_GPS_CONFIG, gps::GPS),
    set(code::SET_COMPASS_CONFIG, gps::COMPASS),
    set(code::SET_GPS_RESCUE, gps::RESCUE),
    set(code::SET_GPS_RESCUE_PIDS, gps::RESCUE_PIDS),
    check(code::MULTIPLE_MSP, multiple::multiple),
    answer(code::MODE_RANGES_EXTRA, modes::mode_ranges_extra),
    set(code::SET_ACC_TRIM, craft::ACC_TRIM),
    get(code::ACC_TRIM, craft::ACC_TRIM),
    answer(code::SET_PASSTHROUGH, commands::set_passthrough),
    answer(code::SET_RTC, commands::set_rtc),
    answer(code::RTC, state::rtc),
    check(code::EEPROM_WRITE, commands::eeprom_write),
    answer(code::DEBUG, state::debug),
    answer(code::COMMON_SERIAL_CONFIG, craft::common_serial_config),
    answer(code::MOTOR_OUTPUT_REORDERING, craft::motor_reordering),
    check(code::SET_MOTOR_OUTPUT_REORDERING, craft::set_motor_reordering),
    check(code::GET_TEXT, text::get_text),
    check(code::SET_TEXT, text::set_text),
    answer(code::SENSOR_CONFIG_ACTIVE, state::sensors_active),
    answer(code::MCU_INFO, identity::mcu_info),
    answer(code::GYRO_SENSOR_ACTIVE, state::gyros_active),
    check(code::BATTERY_PROFILE, power::battery_profile),
    check(code::SET_BATTERY_PROFILE, power::set_battery_profile),
    check(code::CLI_SETTING, setting::setting),
    check(code::CLI_SETTING_INFO, setting::setting_info),
];
