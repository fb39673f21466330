//! The state of a craft, as telemetry needs it. SI units; the world is north, east, down; the body is forward, right, down.

use std::time::Duration;

use super::super::state::{BatteryState, GeoPosition, GpsState, NavigationState, RcState};
use super::super::value::{LandedState, MissionState};
use super::modes::FlightMode;

/// The state of a craft. `None` is "not known".
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CraftState {
    /// Time since 1970.
    pub unix_time: Option<Duration>,
    /// The mode in force.
    pub mode: Option<FlightMode>,
    /// `true` if the motors may turn.
    pub is_armed: bool,
    /// `true` if the craft can be armed.
    pub is_ready_to_arm: Option<bool>,
    /// `true` during a failsafe.
    pub is_failsafe: bool,
    /// On the ground, in the air, or between; `None` if unknown.
    pub landed: Option<LandedState>,
    /// Sensors that exist: bits of [`sensor`](super::super::value::sensor).
    pub sensors_present: u32,
    /// Sensors that work, of those that exist.
    pub sensors_healthy: u32,
    /// Processor load, 0…1.
    pub load: Option<f64>,
    /// Roll, pitch (nose up) and yaw (from north over east), rad.
    pub attitude: Option<[f64; 3]>,
    /// Body rates, rad/s.
    pub rates: Option<[f64; 3]>,
    /// The estimated position.
    pub position: Option<GeoPosition>,
    /// Altitude above home, m.
    pub altitude_above_home: Option<f64>,
    /// Position from home, m.
    pub local_ned: Option<[f64; 3]>,
    /// Velocity over ground, m/s.
    pub velocity_ned: Option<[f64; 3]>,
    /// Speed through the air, m/s.
    pub airspeed: Option<f64>,
    /// Throttle, 0…1.
    pub throttle: Option<f64>,
    /// Home.
    pub home: Option<GeoPosition>,
    /// The solution of the receiver.
    pub gps: Option<GpsState>,
    /// The battery.
    pub battery: Option<BatteryState>,
    /// The RC channels.
    pub rc: Option<RcState>,
    /// The commands to motors and servos, µs. Outputs that do not exist are 0.
    pub outputs_us: Option<[u16; 16]>,
    /// The steering of the navigator.
    pub navigation: Option<NavigationState>,
    /// The mission.
    pub mission: MissionProgress,
    /// Velocity of the air, m/s.
    pub wind_ned: Option<[f64; 3]>,
    /// Static pressure, Pa.
    pub pressure_pa: Option<f64>,
    /// Temperature, °C.
    pub temperature_c: Option<f64>,
}

/// The progress of a mission. Items count from 0, without the home item of some ground stations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MissionProgress {
    /// The item that is flown to.
    pub current: Option<u16>,
    /// The state of the mission.
    pub state: MissionState,
}

impl Default for MissionProgress {
    fn default() -> Self {
        Self { current: None, state: MissionState::Unknown }
    }
}
