//! The messages that a craft, a ground station or both use here, from the dialects `common` and `ardupilotmega`.
//!
//! A row has the fields in the order of the wire: the widest numbers first, and the extension fields after a `+`. Their
//! meaning is that of the message definitions. Frames: north, east, down in the world; forward, right, down in the body.

#![allow(
    missing_docs,
    reason = "fields without a unit have the names and meanings of the message definitions"
)]

use super::super::wire::{Field, Reader, Series, Text};
use super::{Checked, Direction, MessageInfo, crc_extra, messages};

messages! {
    0 HEARTBEAT Heartbeat Both "presence, type and mode of a component"
        { custom_mode: u32, r#type: u8, autopilot: u8, base_mode: u8, system_status: u8, mavlink_version: u8 }
    1 SYS_STATUS SysStatus Down "sensors, battery and load" {
        onboard_control_sensors_present: u32, onboard_control_sensors_enabled: u32,
        onboard_control_sensors_health: u32, load: u16 ["0.1 %"], voltage_battery: u16 ["mV"],
        current_battery: i16 ["10 mA"], drop_rate_comm: u16 ["0.01 %"], errors_comm: u16, errors_count1: u16,
        errors_count2: u16, errors_count3: u16, errors_count4: u16, battery_remaining: i8 ["%"],
    } + {
        onboard_control_sensors_present_extended: u32, onboard_control_sensors_enabled_extended: u32,
        onboard_control_sensors_health_extended: u32,
    }
    2 SYSTEM_TIME SystemTime Down "time since 1970 and since boot"
        { time_unix_usec: u64 ["µs"], time_boot_ms: u32 ["ms"] }
    4 PING Ping Both "a question whose answer measures the link"
        { time_usec: u64 ["µs"], seq: u32, target_system: u8, target_component: u8 }
    11 SET_MODE SetMode Up "sets the mode"
        { custom_mode: u32, target_system: u8, base_mode: u8 }
    20 PARAM_REQUEST_READ ParamRequestRead Up "asks for a parameter by name or index"
        { param_index: i16, target_system: u8, target_component: u8, param_id: Text<16> }
    21 PARAM_REQUEST_LIST ParamRequestList Up "asks for all parameters"
        { target_system: u8, target_component: u8 }
    22 PARAM_VALUE ParamValue Down "a parameter"
        { param_value: f32, param_count: u16, param_index: u16, param_id: Text<16>, param_type: u8 }
    23 PARAM_SET ParamSet Up "sets a parameter"
        { param_value: f32, target_system: u8, target_component: u8, param_id: Text<16>, param_type: u8 }
    24 GPS_RAW_INT GpsRawInt Down "the solution of the receiver" {
        time_usec: u64 ["µs"], lat: i32 ["1e-7°"], lon: i32 ["1e-7°"], alt: i32 ["mm"], eph: u16, epv: u16,
        vel: u16 ["cm/s"], cog: u16 ["0.01°"], fix_type: u8, satellites_visible: u8,
    } + {
        alt_ellipsoid: i32 ["mm"], h_acc: u32 ["mm"], v_acc: u32 ["mm"], vel_acc: u32 ["mm/s"],
        hdg_acc: u32 ["1e-5°"], yaw: u16 ["0.01°"],
    }
    29 SCALED_PRESSURE ScaledPressure Down "pressure and temperature" {
        time_boot_ms: u32 ["ms"], press_abs: f32 ["hPa"], press_diff: f32 ["hPa"],
        temperature: i16 ["0.01 °C"],
    } + { temperature_press_diff: i16 ["0.01 °C"] }
    30 ATTITUDE Attitude Down "attitude as angles" {
        time_boot_ms: u32 ["ms"], roll: f32 ["rad"], pitch: f32 ["rad"], yaw: f32 ["rad"],
        rollspeed: f32 ["rad/s"], pitchspeed: f32 ["rad/s"], yawspeed: f32 ["rad/s"],
    }
    31 ATTITUDE_QUATERNION AttitudeQuaternion Down "attitude as a quaternion" {
        time_boot_ms: u32 ["ms"], q1: f32, q2: f32, q3: f32, q4: f32, rollspeed: f32 ["rad/s"],
        pitchspeed: f32 ["rad/s"], yawspeed: f32 ["rad/s"],
    } + { repr_offset_q: [f32; 4] }
    32 LOCAL_POSITION_NED LocalPositionNed Down "position and speed from the origin" {
        time_boot_ms: u32 ["ms"], x: f32 ["m"], y: f32 ["m"], z: f32 ["m"], vx: f32 ["m/s"], vy: f32 ["m/s"],
        vz: f32 ["m/s"],
    }
    33 GLOBAL_POSITION_INT GlobalPositionInt Down "estimated position on the globe" {
        time_boot_ms: u32 ["ms"], lat: i32 ["1e-7°"], lon: i32 ["1e-7°"], alt: i32 ["mm"],
        relative_alt: i32 ["mm"], vx: i16 ["cm/s"], vy: i16 ["cm/s"], vz: i16 ["cm/s"], hdg: u16 ["0.01°"],
    }
    35 RC_CHANNELS_RAW RcChannelsRaw Down "the first eight RC channels"
        { time_boot_ms: u32 ["ms"], chan_raw: Series<8> ["µs"], port: u8, rssi: u8 }
    36 SERVO_OUTPUT_RAW ServoOutputRaw Down "outputs to motors and servos"
        { time_usec: u32 ["µs"], servo_raw: Series<8> ["µs"], port: u8 }
        + { servo9_to_16_raw: [u16; 8] ["µs"] }
    37 MISSION_REQUEST_PARTIAL_LIST MissionRequestPartialList Up "asks for a part of the mission"
        { start_index: i16, end_index: i16, target_system: u8, target_component: u8 }
        + { mission_type: u8 }
    38 MISSION_WRITE_PARTIAL_LIST MissionWritePartialList Up "announces a part of a mission"
        { start_index: i16, end_index: i16, target_system: u8, target_component: u8 }
        + { mission_type: u8 }
    39 MISSION_ITEM MissionItemFloat Both "a mission item with a position in single precision" {
        param1: f32, param2: f32, param3: f32, param4: f32, x: f32, y: f32, z: f32, seq: u16, command: u16,
        target_system: u8, target_component: u8, frame: u8, current: u8, autocontinue: u8,
    } + { mission_type: u8 }
    40 MISSION_REQUEST MissionRequest Both "asks for a mission item of the old kind"
        { seq: u16, target_system: u8, target_component: u8 }
        + { mission_type: u8 }
    41 MISSION_SET_CURRENT MissionSetCurrent Up "sets the next mission item"
        { seq: u16, target_system: u8, target_component: u8 }
    42 MISSION_CURRENT MissionCurrent Down "the mission item that is flown to"
        { seq: u16 }
        + { total: u16, mission_state: u8, mission_mode: u8, mission_id: u32, fence_id: u32, rally_points_id: u32 }
    43 MISSION_REQUEST_LIST MissionRequestList Up "asks for the number of mission items"
        { target_system: u8, target_component: u8 }
        + { mission_type: u8 }
    44 MISSION_COUNT MissionCount Both "the number of mission items"
        { count: u16, target_system: u8, target_component: u8 }
        + { mission_type: u8, opaque_id: u32 }
    45 MISSION_CLEAR_ALL MissionClearAll Up "deletes the mission"
        { target_system: u8, target_component: u8 }
        + { mission_type: u8 }
    46 MISSION_ITEM_REACHED MissionItemReached Down "a mission item was reached"
        { seq: u16 }
    47 MISSION_ACK MissionAck Both "ends a mission transfer"
        { target_system: u8, target_component: u8, r#type: u8 }
        + { mission_type: u8, opaque_id: u32 }
    49 GPS_GLOBAL_ORIGIN GpsGlobalOrigin Down "the origin of local positions"
        { latitude: i32 ["1e-7°"], longitude: i32 ["1e-7°"], altitude: i32 ["mm"] }
        + { time_usec: u64 ["µs"] }
    51 MISSION_REQUEST_INT MissionRequestInt Both "asks for a mission item"
        { seq: u16, target_system: u8, target_component: u8 }
        + { mission_type: u8 }
    62 NAV_CONTROLLER_OUTPUT NavControllerOutput Down "what the navigator steers for" {
        nav_roll: f32 ["°"], nav_pitch: f32 ["°"], alt_error: f32 ["m"], aspd_error: f32 ["m/s"],
        xtrack_error: f32 ["m"], nav_bearing: i16 ["°"], target_bearing: i16 ["°"], wp_dist: u16 ["m"],
    }
    65 RC_CHANNELS RcChannels Down "RC channels"
        { time_boot_ms: u32 ["ms"], chan_raw: Series<18> ["µs"], chancount: u8, rssi: u8 }
    66 REQUEST_DATA_STREAM RequestDataStream Up "sets the rate of a group of messages" {
        req_message_rate: u16 ["Hz"], target_system: u8, target_component: u8, req_stream_id: u8,
        start_stop: u8,
    }
    69 MANUAL_CONTROL ManualControl Up "sticks and buttons"
        { x: i16, y: i16, z: i16, r: i16, buttons: u16, target: u8 }
        + { buttons2: u16, enabled_extensions: u8, s: i16, t: i16, aux: [i16; 6] }
    70 RC_CHANNELS_OVERRIDE RcChannelsOverride Up "replaces RC channels"
        { chan_raw: Series<8> ["µs"], target_system: u8, target_component: u8 }
        + { chan9_to_18_raw: [u16; 10] ["µs"] }
    73 MISSION_ITEM_INT MissionItemInt Both "a mission item" {
        param1: f32, param2: f32, param3: f32, param4: f32, x: i32, y: i32, z: f32, seq: u16, command: u16,
        target_system: u8, target_component: u8, frame: u8, current: u8, autocontinue: u8,
    } + { mission_type: u8 }
    74 VFR_HUD VfrHud Down "speeds, heading, throttle, altitude" {
        airspeed: f32 ["m/s"], groundspeed: f32 ["m/s"], alt: f32 ["m"], climb: f32 ["m/s"],
        heading: i16 ["°"], throttle: u16 ["%"],
    }
    75 COMMAND_INT CommandInt Up "a command with a position" {
        param1: f32, param2: f32, param3: f32, param4: f32, x: i32, y: i32, z: f32, command: u16,
        target_system: u8, target_component: u8, frame: u8, current: u8, autocontinue: u8,
    }
    76 COMMAND_LONG CommandLong Up "a command" {
        param1: f32, param2: f32, param3: f32, param4: f32, param5: f32, param6: f32, param7: f32,
        command: u16, target_system: u8, target_component: u8, confirmation: u8,
    }
    77 COMMAND_ACK CommandAck Down "the answer to a command"
        { command: u16, result: u8 }
        + { progress: u8 ["%"], result_param2: i32, target_system: u8, target_component: u8 }
    110 FILE_TRANSFER_PROTOCOL FileTransferProtocol Both "file transfer"
        { target_network: u8, target_system: u8, target_component: u8, payload: [u8; 251] }
    111 TIMESYNC Timesync Both "synchronises clocks"
        { tc1: i64 ["ns"], ts1: i64 ["ns"] }
        + { target_system: u8, target_component: u8 }
    147 BATTERY_STATUS BatteryStatus Down "a battery" {
        current_consumed: i32 ["mAh"], energy_consumed: i32 ["100 J"], temperature: i16 ["0.01 °C"],
        voltages: [u16; 10] ["mV"], current_battery: i16 ["10 mA"], id: u8, battery_function: u8, r#type: u8,
        battery_remaining: i8 ["%"],
    } + {
        time_remaining: i32 ["s"], charge_state: u8, voltages_ext: [u16; 4] ["mV"], mode: u8,
        fault_bitmask: u32,
    }
    148 AUTOPILOT_VERSION AutopilotVersion Down "version and capabilities of the autopilot" {
        capabilities: u64, uid: u64, flight_sw_version: u32, middleware_sw_version: u32, os_sw_version: u32,
        board_version: u32, vendor_id: u16, product_id: u16, flight_custom_version: [u8; 8],
        middleware_custom_version: [u8; 8], os_custom_version: [u8; 8],
    } + { uid2: [u8; 18] }
    162 FENCE_STATUS FenceStatus Down "state of the fence"
        { breach_time: u32 ["ms"], breach_count: u16, breach_status: u8, breach_type: u8 }
        + { breach_mitigation: u8 }
    168 WIND Wind Down "wind as ArduPilot estimates it"
        { direction: f32 ["°"], speed: f32 ["m/s"], speed_z: f32 ["m/s"] }
    231 WIND_COV WindCov Down "wind" {
        time_usec: u64 ["µs"], wind_x: f32 ["m/s"], wind_y: f32 ["m/s"], wind_z: f32 ["m/s"],
        var_horiz: f32 ["m/s"], var_vert: f32 ["m/s"], wind_alt: f32 ["m"], horiz_accuracy: f32 ["m/s"],
        vert_accuracy: f32 ["m/s"],
    }
    242 HOME_POSITION HomePosition Down "home" {
        latitude: i32 ["1e-7°"], longitude: i32 ["1e-7°"], altitude: i32 ["mm"], x: f32 ["m"], y: f32 ["m"],
        z: f32 ["m"], q: [f32; 4], approach_x: f32 ["m"], approach_y: f32 ["m"], approach_z: f32 ["m"],
    } + { time_usec: u64 ["µs"] }
    244 MESSAGE_INTERVAL MessageInterval Down "the interval of a message"
        { interval_us: i32 ["µs"], message_id: u16 }
    245 EXTENDED_SYS_STATE ExtendedSysState Down "on the ground or in the air"
        { vtol_state: u8, landed_state: u8 }
    253 STATUSTEXT Statustext Down "a text for the pilot, in chunks if it is long"
        { severity: u8, text: Text<50> }
        + { id: u16, chunk_seq: u8 }
    300 PROTOCOL_VERSION ProtocolVersion Down "versions of the protocol" {
        version: u16, min_version: u16, max_version: u16, spec_version_hash: [u8; 8],
        library_version_hash: [u8; 8],
    }
    435 AVAILABLE_MODES AvailableModes Down "a mode that can be set" {
        custom_mode: u32, properties: u32, number_modes: u8, mode_index: u8, standard_mode: u8,
        mode_name: Text<35>,
    }
    436 CURRENT_MODE CurrentMode Down "the mode in force and the mode that was asked for"
        { custom_mode: u32, intended_custom_mode: u32, standard_mode: u8 }
    437 AVAILABLE_MODES_MONITOR AvailableModesMonitor Down "changes when the list of modes changes"
        { seq: u8 }
}
