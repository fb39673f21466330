//! The errors of building or changing a world.

use crate::sim::value_text::ParseError;
use crate::telemetry::FaultKind;

/// The reason why a world cannot be built or a command cannot be carried out.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// A step rate that is too slow to be stable.
    #[error(
        "a rate of {0} Hz is a step longer than 2.5 ms, and the physics is not stable with longer steps; \
         choose 400, 500, 1000, 2000, 4000 or 8000 Hz"
    )]
    StepTooLong(u32),
    /// A step rate that does not fit the clock.
    #[error("a rate of {0} Hz does not fit the clock; choose 400, 500, 1000, 2000, 4000 or 8000 Hz")]
    OddRate(u32),
    /// An airframe that cannot fly.
    #[error("airframe {0}: {1}")]
    Airframe(String, String),
    /// A home that is not a place.
    #[error("home {0} {1} is out of range; allowed are {2} to {3}")]
    Home(&'static str, f64, f64, f64),
    /// A fault of the external link in a world without one.
    #[error(
        "fault {0} acts on the link to an external simulator, and this flight has none; leave it out, or use betadeck serve --physics external"
    )]
    NeedsLink(FaultKind),
    /// A fault of the craft or the air while an external simulator controls both.
    #[error(
        "fault {0} is up to the simulator that moves the craft: make it there; here there are rx-loss, gps-loss, stall, fdm-loss, fdm-late, fdm-dup and fdm-jitter"
    )]
    OutsideFault(FaultKind),
    /// A change of the air, the sensors or the craft's place while an external simulator controls them.
    #[error(
        "the simulator makes the air and places the craft: change that there; here there are faults of the links (fault=NAME, end=NAME)"
    )]
    Outside,
    /// More faults than the world can keep.
    #[error("there can be at most {0} faults, waiting and active ones together")]
    TooManyFaults(usize),
    /// The ground of elevation tiles without a tile.
    #[error(
        "ground=terrain needs an elevation tile that knows the height of home: name the directory of the tiles with --terrain DIR"
    )]
    NoTerrain,
    /// A fault or a switch with a value that is not allowed.
    #[error(transparent)]
    Value(#[from] ParseError),
    /// A number that is not allowed.
    #[error("{name} {value} is out of range; allowed are {min} to {max}")]
    OutOfRange {
        /// Meaning of the number.
        name: &'static str,
        /// The value.
        value: f64,
        /// The smallest value that is allowed.
        min: f64,
        /// The greatest value that is allowed.
        max: f64,
    },
}

/// Checks that a value is allowed.
///
/// # Errors
/// Fails with the name, the value and what is allowed.
pub(super) fn in_range(name: &'static str, value: f64, min: f64, max: f64) -> Result<(), WorldError> {
    if (min..=max).contains(&value) { Ok(()) } else { Err(WorldError::OutOfRange { name, value, min, max }) }
}
