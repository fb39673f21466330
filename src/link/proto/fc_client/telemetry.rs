//! What a flight controller tells of itself, decoded to plain data in SI units.
//!
//! Messages grew over the releases: what an older one does not carry is `None`, what a newer one appends is passed over.
//! Each type has `decode(payload)`, which is `None` when the payload is no such message.

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

/// Codes of the messages that are decoded here.
pub mod code {
    /// Version of the API.
    pub const API_VERSION: u16 = 1;
    /// Name of the firmware.
    pub const FC_VARIANT: u16 = 2;
    /// Version of the firmware.
    pub const FC_VERSION: u16 = 3;
    pub const BOARD_INFO: u16 = 4;
    /// When and with what it was built.
    pub const BUILD_INFO: u16 = 5;
    pub const MODE_RANGES: u16 = 34;
    pub const MOTOR: u16 = 104;
    pub const RC: u16 = 105;
    /// What the GPS says.
    pub const RAW_GPS: u16 = 106;
    pub const COMP_GPS: u16 = 107;
    pub const ATTITUDE: u16 = 108;
    /// Altitude and climb rate.
    pub const ALTITUDE: u16 = 109;
    /// The order of the mode bits.
    pub const BOX_IDS: u16 = 119;
    pub const BATTERY_STATE: u16 = 130;
    /// Modes and what blocks arming.
    pub const STATUS_EX: u16 = 150;
    /// How the mode conditions are linked.
    pub const MODE_RANGES_EXTRA: u16 = 238;
}
