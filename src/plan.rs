//! Flight plans: pure data and rules, without I/O. Quantities are in SI; the units of files, lines and messages are in
//! `WaypointRecord` only.
//!
//! The layers, each of which uses those before it:
//!
//! * The records, quantities and rules of a plan in the files of this folder.
//! * `estimate` and `review`: times, distances and energy, and what the craft would refuse.
//! * `format`: the file formats, with the report of what another program cannot hold.
//! * `edit`: documents with their history and journal.
//!
//! ```
//! use betadeck_core::plan::WaypointType;
//! use betadeck_core::plan::format::{Format, parse};
//!
//! let text = "waypoint insert 0 47.3977000 8.5456000 2000 500 FLYOVER 0 NONE";
//! let file = parse("field", text, Format::from_contents(text.as_bytes())).unwrap();
//! assert_eq!(file.plan.waypoints[0].kind, WaypointType::Flyover);
//!
//! let errors = parse("field", "waypoint insert 0 91.0", Format::CliText).unwrap_err();
//! println!("{}", errors[0]);
//! ```

mod altitude_reference;
pub mod builtin;
mod capability;
pub mod differences;
pub mod edit;
pub mod estimate;
pub mod feature;
pub mod format;
pub mod generate;
mod leg_time;
mod quantity;
mod record;
pub mod review;
pub mod setpoint;
pub mod validate;
mod waypoint;

pub use altitude_reference::{AltitudeError, AltitudeReference, CraftPlan};
pub use capability::{Approach, Capability, Modifier, SpeedUse, Then, TimeUse};
pub use format::{plan_lines, record_lines, upload_lines};
pub use quantity::{Altitude, LegSpeed, Seconds};
pub use record::{Records, WaypointRecord};
pub use review::{LegAltitude, leg_altitudes};
pub use waypoint::{HoldPattern, Waypoint, WaypointType};

/// The most waypoints a plan holds.
pub const MAX_WAYPOINTS: usize = 30;

/// An ordered list of at most [`MAX_WAYPOINTS`] waypoints; it never allocates, so the vehicle can copy it in flight.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct FlightPlan {
    /// The waypoints in flight order.
    pub waypoints: arrayvec::ArrayVec<Waypoint, MAX_WAYPOINTS>,
}
