//! The events of the vehicle.

use crate::signals::SimTime;
use crate::telemetry::{FaultKind, FaultValue, FirmwareEvent};

/// An event of the vehicle with its time.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Simulated time since boot.
    pub time: SimTime,
    /// The event.
    pub kind: EventKind,
}

/// A kind of event, with its data.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum EventKind {
    /// The vehicle was started.
    Boot {
        /// The seed of all randomness.
        seed: u64,
        /// Steps per second, Hz.
        rate_hz: u32,
        /// The name of the airframe.
        airframe: String,
        /// `true` if other programs can influence the flight, which makes it not repeatable.
        live: bool,
    },
    /// An event of the flight controller.
    Firmware(FirmwareEvent),
    /// A fault began or ended.
    Fault {
        /// The kind of fault.
        kind: FaultKind,
        /// `true` if it began.
        on: bool,
        /// Its value.
        value: FaultValue,
    },
    /// The craft touched the ground.
    Contact {
        /// Sink rate, m/s.
        impact_mps: f64,
    },
    /// The craft came to rest on the ground.
    Touchdown {
        /// Sink rate at the contact, m/s.
        impact_mps: f64,
        /// Greatest specific force since the contact, m/s².
        peak_mps2: f64,
    },
    /// The craft crashed.
    Crash {
        /// The cause.
        cause: CrashCause,
    },
    /// The full charge of the battery is drawn. A real pack is empty now, even if the simulated one still
    /// drives the rotors.
    BatteryEmpty {
        /// The voltage per cell, V.
        cell_v: f64,
    },
    /// Another notice for the user.
    Notice(VehicleNotice),
}

/// The cause of a crash. `Display` ends a sentence.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum CrashCause {
    /// The craft came down too fast, m/s.
    HardLanding(f64),
    /// The craft moved sideways too fast at the contact, m/s.
    SidewaysLanding(f64),
    /// The hull touched the ground.
    HullContact,
}

impl CrashCause {
    /// Returns the end of a sentence about the craft, after `it`.
    pub fn of_it(&self) -> String {
        match self {
            Self::HardLanding(_) | Self::SidewaysLanding(_) => self.to_string(),
            Self::HullContact => "touched the ground with its hull".to_owned(),
        }
    }
}

impl std::fmt::Display for CrashCause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::HardLanding(speed) => write!(f, "hit the ground sinking at {speed:.1} m/s"),
            Self::SidewaysLanding(speed) => write!(f, "touched the ground moving sideways at {speed:.1} m/s"),
            Self::HullContact => f.write_str("the hull touched the ground"),
        }
    }
}

/// The cause of a failed integration. `Display` ends a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, serde::Serialize, serde::Deserialize)]
pub enum DivergeCause {
    /// A number is not finite.
    #[strum(to_string = "the state is not finite")]
    NotFinite,
    /// More than 100 km from home.
    #[strum(to_string = "the craft is more than 100 km from home")]
    Position,
    /// Turning faster than 300 rad/s.
    #[strum(to_string = "the craft turns faster than 300 rad/s")]
    Rate,
}

/// A notice of the vehicle itself. `Display` gives the sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum VehicleNotice {
    /// This many of the last firmware events of a step were lost.
    EventsLost(u32),
    /// The simulation left the range in which its numbers are valid.
    Diverged(DivergeCause),
    /// The craft was put back home.
    BackHome,
}

impl std::fmt::Display for VehicleNotice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::EventsLost(count) => {
                write!(f, "Too many events of the firmware came between two steps; lost: the last {count}.")
            }
            Self::Diverged(cause) => write!(f, "The simulation diverged: {cause}."),
            Self::BackHome => f.write_str("The craft is back home, undamaged and disarmed."),
        }
    }
}
