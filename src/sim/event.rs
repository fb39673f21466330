//! The events of a world, as typed facts.

use crate::signals::SimTime;
use crate::telemetry::{CrashCause, DivergeCause};

use super::fault::Fault;

/// An event at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorldEvent {
    /// Simulated time since boot.
    pub time: SimTime,
    /// The event.
    pub kind: WorldEventKind,
}

/// An event of the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WorldEventKind {
    /// The first touch after a flight.
    Contact {
        /// Sink rate, m/s.
        impact_mps: f64,
    },
    /// All legs have carried load for 0.2 s.
    Touchdown {
        /// Sink rate of the contact, m/s.
        impact_mps: f64,
        /// Maximum specific force since the contact, m/s².
        peak_mps2: f64,
    },
    /// The craft is lost.
    Crash {
        /// The cause.
        cause: CrashCause,
    },
    /// A fault began or ended. Impulses and displacements have no end, so only their beginning is reported.
    Fault {
        /// The fault; its `Display` is the value.
        fault: Fault,
        /// `true` if it began.
        on: bool,
    },
    /// The full charge of the battery has been drawn.
    BatteryEmpty {
        /// Voltage per cell under load, V.
        cell_v: f64,
    },
    /// The integration failed. The world no longer changes.
    Diverged {
        /// The cause.
        cause: DivergeCause,
    },
}
