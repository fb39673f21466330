//! The changes of a world while it runs.

use super::error::in_range;
use super::fault::{Fault, FaultKey, MAX_TIME_S, ScheduledFault};
use crate::sim::config::Noise;
use crate::sim::error::WorldError;
use crate::sim::wind::Wind;
use crate::telemetry::Turbulence;

mod text;

pub use crate::sim::command::text::{COMMAND_WORDS, CommandWord};

/// A change of the world by a user, a scenario or a script. It takes effect from the next step on.
#[derive(Debug, Clone, PartialEq)]
pub enum WorldCommand {
    /// The mean wind changes to this over two seconds.
    SetWind(Wind),
    /// Random gusts of this strength from now on, m/s; 0 for none.
    SetGust(f64),
    /// One gust of this size and direction, now.
    GustNow(Wind),
    /// Level of turbulence from now on.
    SetTurbulence(Turbulence),
    /// Sensor errors on or off.
    SetNoise(Noise),
    /// A rare switch as `NAME=VALUE`. The capacity of the battery takes effect from the next reset on.
    SetSwitch(String),
    /// GPS solutions per second, 1…20.
    SetGpsRate(u8),
    /// A fault now, for this many seconds or to the end.
    FaultOn(Fault, Option<f64>),
    /// Ends the active faults of this kind.
    FaultOff(FaultKey),
    /// Ends all active faults and forgets all waiting ones.
    ClearFaults,
    /// A fault at a given time.
    Schedule(ScheduledFault),
    /// Puts the craft back at home, undamaged, with a full battery. Air, noise and faults stay as they are.
    ResetToHome,
}

impl WorldCommand {
    /// Returns the fault that the command begins, now or later.
    pub fn fault(&self) -> Option<&Fault> {
        match self {
            Self::FaultOn(fault, _) => Some(fault),
            Self::Schedule(scheduled) => Some(&scheduled.fault),
            _ => None,
        }
    }

    /// Checks that the numbers of the command are in range.
    pub(super) fn check(&self) -> Result<(), WorldError> {
        match *self {
            Self::SetWind(wind) | Self::GustNow(wind) => check_wind(wind),
            Self::SetGust(size) => in_range("gust", size, 0.0, Wind::MAX_MPS),
            Self::SetGpsRate(rate) => in_range("GPS rate", f64::from(rate), 1.0, 20.0),
            Self::FaultOn(_, Some(seconds)) => in_range("duration", seconds, 0.0, MAX_TIME_S),
            Self::SetSwitch(_)
            | Self::SetTurbulence(_)
            | Self::SetNoise(_)
            | Self::FaultOn(_, None)
            | Self::FaultOff(_)
            | Self::ClearFaults
            | Self::Schedule(_)
            | Self::ResetToHome => Ok(()),
        }
    }
}

pub(super) fn check_wind(wind: Wind) -> Result<(), WorldError> {
    in_range("wind speed", wind.speed_mps, 0.0, Wind::MAX_MPS)?;
    in_range("wind direction", wind.from_deg, -360.0, 360.0)
}
