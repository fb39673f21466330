//! Notices for the user about a flight before it begins.

use std::fmt;

use crate::firmware::config::Configuration;
use crate::geo::LatLon;
use crate::telemetry::{FaultKind, FirmwareNotice};

/// A decision made for the user, or a probable mistake. `Display` is the sentence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SetupNotice {
    /// The craft had no mode condition and got the starter modes.
    StarterModes,
    /// The default home is far from the plan, so the craft starts at the plan's first waypoint.
    HomeAtFirstWaypoint {
        /// The first waypoint with a place.
        first: LatLon,
        /// Distance from the default home, m.
        distance_m: f64,
    },
    /// The plan is far from the home that the user or the plan chose.
    PlanFarFromHome {
        /// The first waypoint with a place.
        first: LatLon,
        /// Home of the plan.
        home: LatLon,
        /// Distance between the two, m.
        distance_m: f64,
    },
    /// A fault without effect, since the flight controller is remote.
    IdleFault(FaultKind),
    /// Notice of the firmware about the given settings.
    Firmware(FirmwareNotice),
}

impl fmt::Display for SetupNotice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StarterModes => f.write_str(Configuration::STARTER_MODES_NOTICE),
            Self::HomeAtFirstWaypoint { first, distance_m } => write!(
                f,
                "The plan is {:.0} km from the default home: the craft starts at its first waypoint, {first} (--home \
                 chooses another place).",
                distance_m / 1000.0
            ),
            Self::PlanFarFromHome { first, home, distance_m } => {
                let kilometres = distance_m / 1000.0;
                write!(f, "The plan's first waypoint, {first}, is {kilometres:.0} km from home, {home}.")
            }
            Self::Firmware(notice) => notice.fmt(f),
            Self::IdleFault(FaultKind::Battery) => f.write_str(
                "The fault battery has no effect: a remote firmware gets no battery data (with --world battery_sag=on \
                 a weak one slows the motors).",
            ),
            Self::IdleFault(kind) => write!(
                f,
                "The fault {kind} has no effect: a remote firmware gets no magnetometer data."
            ),
        }
    }
}
