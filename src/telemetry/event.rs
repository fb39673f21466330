//! Everything that happens to the vehicle, with its time.

use crate::signals::SimTime;
use crate::telemetry::{FaultKind, FaultValue, FirmwareEvent};

/// An event and when it happened.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Simulated time since boot.
    pub time: SimTime,
    pub kind: EventKind,
}

#[derive(Debug, Clone, PartialEq)]
pub enum EventKind {
    /// The vehicle was started.
    Boot {
        /// Seed of all randomness.
        seed: u64,
        rate_hz: u32,
        /// Name of the airframe.
        airframe: String,
        /// Whether other programs can influence the flight, so that it is not repeatable.
        live: bool,
    },
    Firmware(FirmwareEvent),
    /// A fault began or ended.
    Fault {
        kind: FaultKind,
        on: bool,
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
    Crash {
        cause: CrashCause,
    },
    /// All of the battery's charge is drawn: a real pack is empty now, whether it acts on the rotors or not.
    BatteryEmpty {
        /// Voltage a cell, V.
        cell_v: f64,
    },
    /// Something else that the user should know.
    Notice(VehicleNotice),
}

/// How a craft was lost; `Display` ends a sentence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CrashCause {
    /// It came down too fast, m/s.
    HardLanding(f64),
    /// It was moving sideways too fast when it touched, m/s.
    SidewaysLanding(f64),
    /// The hull touched the ground.
    HullContact,
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

/// How an integration failed; `Display` ends a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
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

/// What the vehicle itself has to say; `Display` is the sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VehicleNotice {
    /// The firmware's last events of a step were lost: how many.
    EventsLost(u32),
    /// The simulation left the range where its numbers mean something.
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
