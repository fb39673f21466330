//! Every message that the server supports. Any other code gets the protocol's error.

use super::layout::{self, Field};
use super::{
    Call, Refused, commands, craft, gps, identity, modes, multiple, power, receiver, setting, simplified,
    state, text, tuning,
};

/// The effect of a message on the craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "lowercase")]
pub enum Access {
    /// Requested with an empty payload; changes nothing.
    Read,
    /// Requested with a payload that selects the answer.
    Ask,
    /// Changes settings or triggers an action.
    Write,
}

/// The way in which a message is answered.
#[derive(Debug, Clone, Copy)]
pub(super) enum Handler {
    Code(fn(&mut Call<'_>) -> Result<(), Refused>),
    /// Replies with the values of settings.
    Get(&'static [Field]),
    /// Sets settings, unless the payload is shorter than this.
    Set(&'static [Field], usize),
}

impl Handler {
    pub(super) fn run(&self, call: &mut Call<'_>) -> Result<(), Refused> {
        match *self {
            Self::Code(code) => return code(call),
            Self::Get(fields) => layout::read(fields, &call.configuration.settings, &mut call.reply),
            Self::Set(_, shortest) if call.request.remaining() < shortest => return Err(Refused),
            Self::Set(fields, _) => {
                layout::write(fields, &mut call.configuration.settings, &mut call.request);
            }
        }
        Ok(())
    }
}

#[derive(Debug, Clone, Copy)]
pub struct Message {
    pub code: u16,
    /// The name, without the prefix.
    pub name: &'static str,
    pub access: Access,
    pub(super) handler: Handler,
}

type Code = fn(&mut Call<'_>) -> Result<(), Refused>;

const fn read(code: u16, name: &'static str, handler: Code) -> Message {
    Message { code, name, access: Access::Read, handler: Handler::Code(handler) }
}

const fn ask(code: u16, name: &'static str, handler: Code) -> Message {
    Message { code, name, access: Access::Ask, handler: Handler::Code(handler) }
}

const fn write(code: u16, name: &'static str, handler: Code) -> Message {
    Message { code, name, access: Access::Write, handler: Handler::Code(handler) }
}

const fn get(code: u16, name: &'static str, fields: &'static [Field]) -> Message {
    Message { code, name, access: Access::Read, handler: Handler::Get(fields) }
}

const fn set(code: u16, name: &'static str, fields: &'static [Field]) -> Message {
    set_from(code, name, fields, 0)
}

const fn set_from(code: u16, name: &'static str, fields: &'static [Field], shortest: usize) -> Message {
    Message { code, name, access: Access::Write, handler: Handler::Set(fields, shortest) }
}

/// Returns the message with this code.
pub(super) fn find(code: u16) -> Option<&'static Message> {
    let index = MESSAGES.binary_search_by_key(&code, |message| message.code).ok()?;
    MESSAGES.get(index)
}

/// All messages in the order of their codes.
pub static MESSAGES: &[Message] = &[
    read(1, "API_VERSION", identity::api_version),
    read(2, "FC_VARIANT", identity::fc_variant),
    read(3, "FC_VERSION", identity::fc_version),
    read(4, "BOARD_INFO", identity::board_info),
    read(5, "BUILD_INFO", identity::build_info),
    read(10, "NAME", text::name),
    write(11, "SET_NAME", text::set_name),
    read(32, "BATTERY_CONFIG", power::battery_config),
    write(33, "SET_BATTERY_CONFIG", power::set_battery_config),
    read(34, "MODE_RANGES", modes::mode_ranges),
    write(35, "SET_MODE_RANGE", modes::set_mode_range),
    read(36, "FEATURE_CONFIG", craft::features),
    write(37, "SET_FEATURE_CONFIG", craft::set_features),
    get(38, "BOARD_ALIGNMENT_CONFIG", craft::BOARD_ALIGNMENT),
    set(39, "SET_BOARD_ALIGNMENT_CONFIG", craft::BOARD_ALIGNMENT),
    read(40, "CURRENT_METER_CONFIG", power::current_meter_config),
    write(41, "SET_CURRENT_METER_CONFIG", power::set_current_meter_config),
    read(42, "MIXER_CONFIG", craft::mixer),
    write(43, "SET_MIXER_CONFIG", craft::set_mixer),
    get(44, "RX_CONFIG", receiver::RX),
    set(45, "SET_RX_CONFIG", receiver::RX),
    get(50, "RSSI_CONFIG", power::RSSI),
    set(51, "SET_RSSI_CONFIG", power::RSSI),
    read(52, "ADJUSTMENT_RANGES", modes::adjustment_ranges),
    write(53, "SET_ADJUSTMENT_RANGE", modes::set_adjustment_range),
    read(54, "CF_SERIAL_CONFIG", craft::serial_config),
    read(56, "VOLTAGE_METER_CONFIG", power::voltage_meter_config),
    write(57, "SET_VOLTAGE_METER_CONFIG", power::set_voltage_meter_config),
    read(58, "SONAR_ALTITUDE", state::sonar_altitude),
    get(59, "PID_CONTROLLER", tuning::PID_CONTROLLER),
    set(60, "SET_PID_CONTROLLER", tuning::PID_CONTROLLER),
    get(61, "ARMING_CONFIG", craft::ARMING),
    set(62, "SET_ARMING_CONFIG", craft::ARMING),
    read(64, "RX_MAP", receiver::rx_map),
    write(65, "SET_RX_MAP", receiver::set_rx_map),
    write(68, "REBOOT", commands::reboot),
    read(70, "DATAFLASH_SUMMARY", state::dataflash_summary),
    get(75, "FAILSAFE_CONFIG", receiver::FAILSAFE),
    set(76, "SET_FAILSAFE_CONFIG", receiver::FAILSAFE),
    read(77, "RXFAIL_CONFIG", receiver::rxfail),
    write(78, "SET_RXFAIL_CONFIG", receiver::set_rxfail),
    read(79, "SDCARD_SUMMARY", state::sdcard_summary),
    read(80, "BLACKBOX_CONFIG", craft::blackbox),
    write(81, "SET_BLACKBOX_CONFIG", craft::set_blackbox),
    get(82, "TRANSPONDER_CONFIG", power::NONE),
    read(90, "ADVANCED_CONFIG", tuning::advanced),
    set(91, "SET_ADVANCED_CONFIG", tuning::ADVANCED),
    read(92, "FILTER_CONFIG", tuning::filters),
    write(93, "SET_FILTER_CONFIG", tuning::set_filters),
    get(94, "PID_ADVANCED", tuning::PID_ADVANCED),
    write(95, "SET_PID_ADVANCED", tuning::set_pid_advanced),
    get(96, "SENSOR_CONFIG", craft::SENSORS),
    set(97, "SET_SENSOR_CONFIG", craft::SENSORS),
    write(99, "SET_ARMING_DISABLED", commands::set_arming_disabled),
    read(101, "STATUS", state::status),
    read(102, "RAW_IMU", state::raw_imu),
    read(104, "MOTOR", state::motor),
    read(105, "RC", state::rc),
    read(106, "RAW_GPS", state::raw_gps),
    read(107, "COMP_GPS", state::comp_gps),
    read(108, "ATTITUDE", state::attitude),
    read(109, "ALTITUDE", state::altitude),
    read(110, "ANALOG", state::analog),
    get(111, "RC_TUNING", tuning::RATES),
    get(112, "PID", tuning::PID),
    ask(116, "BOXNAMES", modes::box_names),
    read(117, "PIDNAMES", tuning::pid_names),
    ask(119, "BOXIDS", modes::box_ids),
    get(124, "MOTOR_3D_CONFIG", craft::MOTOR_3D),
    get(125, "RC_DEADBAND", receiver::DEADBAND),
    get(126, "SENSOR_ALIGNMENT", craft::ALIGNMENT),
    read(128, "VOLTAGE_METERS", state::voltage_meters),
    read(129, "CURRENT_METERS", state::current_meters),
    read(130, "BATTERY_STATE", state::battery_state),
    get(131, "MOTOR_CONFIG", craft::MOTOR),
    get(132, "GPS_CONFIG", gps::GPS),
    get(133, "COMPASS_CONFIG", gps::COMPASS),
    get(135, "GPS_RESCUE", gps::RESCUE),
    get(136, "GPS_RESCUE_PIDS", gps::RESCUE_PIDS),
    read(139, "MOTOR_TELEMETRY", state::motor_telemetry),
    read(140, "SIMPLIFIED_TUNING", simplified::tuning),
    write(141, "SET_SIMPLIFIED_TUNING", simplified::set_tuning),
    ask(142, "CALCULATE_SIMPLIFIED_PID", simplified::calculate_pid),
    ask(143, "CALCULATE_SIMPLIFIED_GYRO", simplified::calculate_gyro),
    ask(144, "CALCULATE_SIMPLIFIED_DTERM", simplified::calculate_dterm),
    read(145, "VALIDATE_SIMPLIFIED_TUNING", simplified::validate),
    read(150, "STATUS_EX", state::status_ex),
    read(160, "UID", identity::uid),
    read(164, "GPSSVINFO", state::satellites),
    read(167, "ATTITUDE_QUATERNION", state::attitude_quaternion),
    write(183, "COPY_PROFILE", commands::copy_profile),
    read(187, "TX_INFO", state::tx_info),
    read(189, "OSD_CANVAS", craft::nothing),
    write(200, "SET_RAW_RC", commands::set_raw_rc),
    write(201, "SET_RAW_GPS", commands::set_raw_gps),
    set(202, "SET_PID", tuning::PID),
    set_from(204, "SET_RC_TUNING", tuning::RATES, tuning::RATES_MIN),
    write(205, "ACC_CALIBRATION", commands::calibrate_acc),
    write(206, "MAG_CALIBRATION", commands::calibrate_mag),
    write(208, "RESET_CONF", commands::reset_conf),
    write(210, "SELECT_SETTING", commands::select_setting),
    write(211, "SET_HEADING", commands::set_heading),
    write(214, "SET_MOTOR", commands::set_motor),
    set(217, "SET_MOTOR_3D_CONFIG", craft::MOTOR_3D),
    set(218, "SET_RC_DEADBAND", receiver::DEADBAND),
    write(219, "SET_RESET_CURR_PID", commands::reset_pid_profile),
    set(220, "SET_SENSOR_ALIGNMENT", craft::SET_ALIGNMENT),
    set(222, "SET_MOTOR_CONFIG", craft::SET_MOTOR),
    set(223, "SET_GPS_CONFIG", gps::GPS),
    set(224, "SET_COMPASS_CONFIG", gps::COMPASS),
    set(225, "SET_GPS_RESCUE", gps::RESCUE),
    set(226, "SET_GPS_RESCUE_PIDS", gps::RESCUE_PIDS),
    ask(230, "MULTIPLE_MSP", multiple::multiple),
    read(238, "MODE_RANGES_EXTRA", modes::mode_ranges_extra),
    set(239, "SET_ACC_TRIM", craft::ACC_TRIM),
    get(240, "ACC_TRIM", craft::ACC_TRIM),
    ask(245, "SET_PASSTHROUGH", commands::set_passthrough),
    write(246, "SET_RTC", commands::set_rtc),
    read(247, "RTC", state::rtc),
    write(250, "EEPROM_WRITE", commands::eeprom_write),
    read(254, "DEBUG", state::debug),
    read(0x1009, "COMMON_SERIAL_CONFIG", craft::common_serial_config),
    read(0x3001, "MOTOR_OUTPUT_REORDERING", craft::motor_reordering),
    write(0x3002, "SET_MOTOR_OUTPUT_REORDERING", craft::set_motor_reordering),
    ask(0x3006, "GET_TEXT", text::get_text),
    write(0x3007, "SET_TEXT", text::set_text),
    read(0x300a, "SENSOR_CONFIG_ACTIVE", state::sensors_active),
    read(0x300c, "MCU_INFO", identity::mcu_info),
    read(0x300d, "GYRO_SENSOR_ACTIVE", state::gyros_active),
    ask(0x300e, "BATTERY_PROFILE", power::battery_profile),
    write(0x300f, "SET_BATTERY_PROFILE", power::set_battery_profile),
    write(0x3010, "CLI_SETTING", setting::setting),
    ask(0x3011, "CLI_SETTING_INFO", setting::setting_info),
];
