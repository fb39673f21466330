//! The messages in which a flight controller reports its state, decoded to plain data in SI units.
//!
//! Messages grew over the releases: a field that an older message lacks is `None`, and fields appended by
//! newer releases are skipped. Each type has `decode(payload)`, which returns `None` when the payload is no
//! such message.

mod identity;
mod mission;
mod modes;
mod motion;
mod observation;
mod power;
mod reader;
mod receiver;
mod setting;
mod status;

pub use identity::{ApiVersion, BoardInfo, BuildInfo, FLIGHT_PLAN_OPTION, variant, version};
pub use mission::{Mission, MissionPhase, PlannedWaypoint};
pub use modes::mode_ranges;
pub use motion::{Altitude, Attitude, HomeVector, RawGps};
pub use observation::{Observation, Origin};
pub use power::{BatteryReading, BatteryState};
pub use receiver::{channels, motors};
pub use setting::{setting, settings};
pub use status::Status;

/// Codes of the messages that this module decodes.
pub mod code {
    /// Version of the API.
    pub const API_VERSION: u16 = 1;
    /// Name of the firmware.
    pub const FC_VARIANT: u16 = 2;
    /// Version of the firmware.
    pub const FC_VERSION: u16 = 3;
    pub const BOARD_INFO: u16 = 4;
    /// The date, time and revision of the build, and its options.
    pub const BUILD_INFO: u16 = 5;
    pub const MODE_RANGES: u16 = 34;
    pub const MOTOR: u16 = 104;
    pub const RC: u16 = 105;
    /// Fix, position and velocity of the GPS.
    pub const RAW_GPS: u16 = 106;
    pub const COMP_GPS: u16 = 107;
    pub const ATTITUDE: u16 = 108;
    /// Altitude and climb rate.
    pub const ALTITUDE: u16 = 109;
    /// The order of the mode bits.
    pub const BOX_IDS: u16 = 119;
    pub const BATTERY_STATE: u16 = 130;
    /// Active modes and the arming disable flags.
    pub const STATUS_EX: u16 = 150;
    /// Links between the mode conditions.
    pub const MODE_RANGES_EXTRA: u16 = 238;
}
