//! What happened in the world, as typed facts.

use crate::signals::SimTime;

use super::fault::Fault;

/// Something that happened at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorldEvent {
    /// When.
    pub time: SimTime,
    /// What.
    pub kind: WorldEventKind,
}

/// What can happen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WorldEventKind {
    /// First touch after a flight.
    Contact {
        /// Sink rate, m/s.
        impact_mps: f64,
    },
    /// All legs have carried load for 0.2 s.
    Touchdown {
        /// Sink rate of the contact, m/s.
        impact_mps: f64,
        /// Greatest specific force since the contact, m/s².
        peak_mps2: f64,
    },
    /// The craft is lost.
    Crash {
        /// How.
        cause: CrashCause,
    },
    /// A fault began or ended. Impulses and displacements have no end, so only their beginning is told.
    Fault {
        /// Which; its `Display` is the value.
        fault: Fault,
        /// Whether it began.
        on: bool,
    },
    /// The integration failed; the world stands still from here on.
    Diverged {
        /// How.
        cause: DivergeCause,
    },
}

/// How a craft was lost.
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

/// How an integration failed.
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
