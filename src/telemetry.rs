//! Observations of a vehicle: modes, arming disable flags, guards and refusals, events and the snapshot.
//!
//! Plain data without behaviour, produced by the core and read by session, record, link and ui.

mod arming_flag;
mod battery_alarm;
mod cannot_hold;
pub mod event;
mod failsafe;
mod fault;
mod firmware_event;
mod firmware_notice;
mod firmware_profile;
mod flight_truth;
mod guard;
mod in_flight;
mod link_state;
mod lost_time;
mod mode;
mod mode_box;
mod nav;
pub mod quantity;
mod refusal;
pub mod signal;
pub mod snapshot;
pub mod switch;
mod transition;
mod turbulence;

pub use arming_flag::{ArmingFlag, ArmingFlags};
pub use battery_alarm::BatteryAlarm;
pub use cannot_hold::{CannotHold, HoldLimit};
pub use event::{CrashCause, DivergeCause, Event, EventKind, VehicleNotice};
pub use failsafe::{FailsafeAhead, FailsafeProcedure, RxLossPolicy};
pub use fault::{FaultKind, FaultValue};
pub use firmware_event::{DisarmReason, FirmwareEvent};
pub use firmware_notice::FirmwareNotice;
pub use firmware_profile::FirmwareProfile;
pub use flight_truth::{FlightTruth, ParkedTruth, WaypointTruth};
pub use guard::{Guard, GuardName, GuardOp, GuardUnit};
pub use in_flight::{InFlightCommand, InFlightRefusal};
pub use link_state::LinkState;
pub use lost_time::LostTime;
pub use mode::{Mode, ModeFlags};
pub use mode_box::{BoxLevel, ModeBox};
pub use nav::{FenceAction, L1Mode, NavEvent, NavState, NavTelemetry, PlanSource};
pub use refusal::{AbortReason, Refusal};
pub use snapshot::Snapshot;
pub use transition::TransitionReason;
pub use turbulence::Turbulence;
