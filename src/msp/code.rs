//! The table of messages: code, name and effect. Server and client use these rows.

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

/// A kind of message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MessageKind {
    pub code: u16,
    /// The name, without the prefix.
    pub name: &'static str,
    pub access: Access,
}

/// Makes a constant with the code of each row, and the list of all rows.
macro_rules! table {
    ($($code:literal $name:ident $access:ident;)*) => {
        $(pub const $name: u16 = $code;)*

        /// All messages in the order of their codes.
        pub const KINDS: &[MessageKind] = &[
            $(MessageKind { code: $code, name: stringify!($name), access: Access::$access },)*
        ];
    };
}

table! {
    1 API_VERSION Read;
    2 FC_VARIANT Read;
    3 FC_VERSION Read;
    4 BOARD_INFO Read;
    5 BUILD_INFO Read;
    10 NAME Read;
    11 SET_NAME Write;
    32 BATTERY_CONFIG Read;
    33 SET_BATTERY_CONFIG Write;
    34 MODE_RANGES Read;
    35 SET_MODE_RANGE Write;
    36 FEATURE_CONFIG Read;
    37 SET_FEATURE_CONFIG Write;
    38 BOARD_ALIGNMENT_CONFIG Read;
    39 SET_BOARD_ALIGNMENT_CONFIG Write;
    40 CURRENT_METER_CONFIG Read;
    41 SET_CURRENT_METER_CONFIG Write;
    42 MIXER_CONFIG Read;
    43 SET_MIXER_CONFIG Write;
    44 RX_CONFIG Read;
    45 SET_RX_CONFIG Write;
    50 RSSI_CONFIG Read;
    51 SET_RSSI_CONFIG Write;
    52 ADJUSTMENT_RANGES Read;
    53 SET_ADJUSTMENT_RANGE Write;
    54 CF_SERIAL_CONFIG Read;
    56 VOLTAGE_METER_CONFIG Read;
    57 SET_VOLTAGE_METER_CONFIG Write;
    58 SONAR_ALTITUDE Read;
    59 PID_CONTROLLER Read;
    60 SET_PID_CONTROLLER Write;
    61 ARMING_CONFIG Read;
    62 SET_ARMING_CONFIG Write;
    64 RX_MAP Read;
    65 SET_RX_MAP Write;
    68 REBOOT Write;
    70 DATAFLASH_SUMMARY Read;
    71 DATAFLASH_READ Ask;
    72 DATAFLASH_ERASE Write;
    75 FAILSAFE_CONFIG Read;
    76 SET_FAILSAFE_CONFIG Write;
    77 RXFAIL_CONFIG Read;
    78 SET_RXFAIL_CONFIG Write;
    79 SDCARD_SUMMARY Read;
    80 BLACKBOX_CONFIG Read;
    81 SET_BLACKBOX_CONFIG Write;
    82 TRANSPONDER_CONFIG Read;
    90 ADVANCED_CONFIG Read;
    91 SET_ADVANCED_CONFIG Write;
    92 FILTER_CONFIG Read;
    93 SET_FILTER_CONFIG Write;
    94 PID_ADVANCED Read;
    95 SET_PID_ADVANCED Write;
    96 SENSOR_CONFIG Read;
    97 SET_SENSOR_CONFIG Write;
    99 SET_ARMING_DISABLED Write;
    101 STATUS Read;
    102 RAW_IMU Read;
    104 MOTOR Read;
    105 RC Read;
    106 RAW_GPS Read;
    107 COMP_GPS Read;
    108 ATTITUDE Read;
    109 ALTITUDE Read;
    110 ANALOG Read;
    111 RC_TUNING Read;
    112 PID Read;
    116 BOXNAMES Ask;
    117 PIDNAMES Read;
    119 BOXIDS Ask;
    124 MOTOR_3D_CONFIG Read;
    125 RC_DEADBAND Read;
    126 SENSOR_ALIGNMENT Read;
    128 VOLTAGE_METERS Read;
    129 CURRENT_METERS Read;
    130 BATTERY_STATE Read;
    131 MOTOR_CONFIG Read;
    132 GPS_CONFIG Read;
    133 COMPASS_CONFIG Read;
    135 GPS_RESCUE Read;
    136 GPS_RESCUE_PIDS Read;
    139 MOTOR_TELEMETRY Read;
    140 SIMPLIFIED_TUNING Read;
    141 SET_SIMPLIFIED_TUNING Write;
    142 CALCULATE_SIMPLIFIED_PID Ask;
    143 CALCULATE_SIMPLIFIED_GYRO Ask;
    144 CALCULATE_SIMPLIFIED_DTERM Ask;
    145 VALIDATE_SIMPLIFIED_TUNING Read;
    150 STATUS_EX Read;
    160 UID Read;
    164 GPSSVINFO Read;
    167 ATTITUDE_QUATERNION Read;
    183 COPY_PROFILE Write;
    187 TX_INFO Read;
    189 OSD_CANVAS Read;
    200 SET_RAW_RC Write;
    201 SET_RAW_GPS Write;
    202 SET_PID Write;
    204 SET_RC_TUNING Write;
    205 ACC_CALIBRATION Write;
    206 MAG_CALIBRATION Write;
    208 RESET_CONF Write;
    210 SELECT_SETTING Write;
    211 SET_HEADING Write;
    214 SET_MOTOR Write;
    217 SET_MOTOR_3D_CONFIG Write;
    218 SET_RC_DEADBAND Write;
    219 SET_RESET_CURR_PID Write;
    220 SET_SENSOR_ALIGNMENT Write;
    222 SET_MOTOR_CONFIG Write;
    223 SET_GPS_CONFIG Write;
    224 SET_COMPASS_CONFIG Write;
    225 SET_GPS_RESCUE Write;
    226 SET_GPS_RESCUE_PIDS Write;
    230 MULTIPLE_MSP Ask;
    238 MODE_RANGES_EXTRA Read;
    239 SET_ACC_TRIM Write;
    240 ACC_TRIM Read;
    245 SET_PASSTHROUGH Ask;
    246 SET_RTC Write;
    247 RTC Read;
    250 EEPROM_WRITE Write;
    254 DEBUG Read;
    0x1009 COMMON_SERIAL_CONFIG Read;
    0x3000 BETAFLIGHT_BIND Write;
    0x3001 MOTOR_OUTPUT_REORDERING Read;
    0x3002 SET_MOTOR_OUTPUT_REORDERING Write;
    0x3003 SEND_DSHOT_COMMAND Write;
    0x3006 GET_TEXT Ask;
    0x3007 SET_TEXT Write;
    0x300a SENSOR_CONFIG_ACTIVE Read;
    0x300c MCU_INFO Read;
    0x300d GYRO_SENSOR_ACTIVE Read;
    0x300e BATTERY_PROFILE Ask;
    0x300f SET_BATTERY_PROFILE Write;
    0x3010 CLI_SETTING Write;
    0x3011 CLI_SETTING_INFO Ask;
    0x3012 CLI_COMMAND Write;
}

/// Returns the message with this code.
pub fn find(code: u16) -> Option<&'static MessageKind> {
    KINDS.get(KINDS.binary_search_by_key(&code, |kind| kind.code).ok()?)
}

/// Returns the message with this code. A constant of a code that the table does not have does not compile.
pub(crate) const fn row(code: u16) -> MessageKind {
    let mut at = 0;
    while KINDS[at].code != code {
        at += 1;
    }
    KINDS[at]
}
