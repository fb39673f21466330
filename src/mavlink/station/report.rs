//! The known state of a craft. SI units; the world is north, east, down; the body is forward, right, down.

use std::time::Duration;

use super::super::state::{BatteryState, GeoPosition, GpsState, NavigationState, RcState};
use super::super::value::{LandedState, MissionState, autopilot};

/// A value with the time at which it arrived.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heard<T> {
    /// The value.
    pub value: T,
    /// The time of arrival, on the clock of the host.
    pub at: Duration,
}

/// The autopilot of a craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AutopilotKind {
    /// None that has a number: Betaflight, INAV and others.
    Generic,
    /// ArduPilot, or INAV if it is set so.
    Ardupilot,
    /// PX4.
    Px4,
    /// Another one, with its number in `MAV_AUTOPILOT`.
    Other(u8),
}

impl AutopilotKind {
    pub(super) fn from_code(code: u8) -> Self {
        match code {
            autopilot::GENERIC => Self::Generic,
            autopilot::ARDUPILOT => Self::Ardupilot,
            autopilot::PX4 => Self::Px4,
            other => Self::Other(other),
        }
    }
}

/// The heartbeat of a craft.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Presence {
    /// The autopilot.
    pub autopilot: AutopilotKind,
    /// The kind of craft: [`system_type`](super::super::value::system_type).
    pub system_type: u8,
    /// The name of the mode, as the autopilot has it.
    pub mode: String,
    /// The number of the mode.
    pub custom_mode: u32,
    /// `true` if the motors may turn.
    pub is_armed: bool,
    /// `true` during a failsafe or an emergency.
    pub is_critical: bool,
}

/// The firmware of a craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Firmware {
    /// Major, minor, patch.
    pub version: [u8; 3],
    /// Bits of [`capability`](super::super::value::capability).
    pub capabilities: u64,
}

/// The progress of a mission, in numbers of the craft.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CurrentItem {
    /// The item that is flown to.
    pub seq: u16,
    /// The number of items without a home item, if it is known.
    pub total: Option<u16>,
    /// The state of the mission.
    pub state: MissionState,
}

/// The sensors of a craft: bits of [`sensor`](super::super::value::sensor).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorStatus {
    /// Sensors that exist.
    pub present: u32,
    /// Sensors in use.
    pub enabled: u32,
    /// Sensors that work.
    pub healthy: u32,
    /// Processor load, 0…1.
    pub load: f64,
}

/// The known state of a craft. `None` did not arrive.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CraftReport {
    /// The heartbeat.
    pub presence: Option<Heard<Presence>>,
    /// The firmware.
    pub firmware: Option<Heard<Firmware>>,
    /// The clock of the craft, since its boot.
    pub boot_time: Option<Heard<Duration>>,
    /// Time since 1970, if the craft knows it.
    pub unix_time: Option<Heard<Duration>>,
    /// Roll, pitch (nose up) and yaw (from north over east), rad.
    pub attitude: Option<Heard<[f64; 3]>>,
    /// Body rates, rad/s.
    pub rates: Option<Heard<[f64; 3]>>,
    /// The estimated position.
    pub position: Option<Heard<GeoPosition>>,
    /// Altitude above home, m.
    pub altitude_above_home: Option<Heard<f64>>,
    /// Position from the origin, m.
    pub local_ned: Option<Heard<[f64; 3]>>,
    /// Velocity over ground, m/s.
    pub velocity_ned: Option<Heard<[f64; 3]>>,
    /// Heading from north over east, rad.
    pub heading: Option<Heard<f64>>,
    /// Speed through the air, m/s. An autopilot without a sensor estimates it, or sends 0.
    pub airspeed: Option<Heard<f64>>,
    /// Speed over ground, m/s.
    pub ground_speed: Option<Heard<f64>>,
    /// Climb rate, m/s.
    pub climb: Option<Heard<f64>>,
    /// Throttle, 0…1.
    pub throttle: Option<Heard<f64>>,
    /// Home.
    pub home: Option<Heard<GeoPosition>>,
    /// The solution of the receiver.
    pub gps: Option<Heard<GpsState>>,
    /// The battery.
    pub battery: Option<Heard<BatteryState>>,
    /// The RC channels.
    pub rc: Option<Heard<RcState>>,
    /// The commands to motors and servos, µs; 0 for outputs that do not exist.
    pub outputs_us: Option<Heard<[u16; 16]>>,
    /// The steering of the navigator.
    pub navigation: Option<Heard<NavigationState>>,
    /// The mission.
    pub mission: Option<Heard<CurrentItem>>,
    /// On the ground, in the air, or between.
    pub landed: Option<Heard<LandedState>>,
    /// The sensors.
    pub sensors: Option<Heard<SensorStatus>>,
    /// Velocity of the air, m/s.
    pub wind_ned: Option<Heard<[f64; 3]>>,
    /// Static pressure, Pa.
    pub pressure_pa: Option<Heard<f64>>,
    /// Temperature, °C.
    pub temperature_c: Option<Heard<f64>>,
    /// `true` while the fence is breached.
    pub is_fence_breached: Option<Heard<bool>>,
}
