//! What is observed: modes, arming flags, guards and refusals, events and the snapshot of a vehicle.
//!
//! Plain data without behaviour of its own, made by the core and read by session, record, link and ui alike.

mod arming_flag;
pub mod event;
mod fault;
mod firmware_event;
mod guard;
mod link_state;
mod mode;
mod nav;
mod refusal;
pub mod snapshot;
pub mod switch;
mod transition;

pub use arming_flag::{ArmingFlag, ArmingFlags};
pub use event::{CrashCause, DivergeCause, Event, EventKind, VehicleNotice};
pub use fault::{FaultKind, FaultValue};
pub use firmware_event::{DisarmReason, FirmwareEvent};
pub use guard::{Guard, GuardName, GuardOp, GuardUnit};
pub use link_state::LinkState;
pub use mode::{Mode, ModeFlags};
pub use nav::{FenceAction, L1Mode, NavEvent, NavOutput, NavState, NavTelemetry, PlanSource};
pub use refusal::{AbortReason, Refusal};
pub use snapshot::Snapshot;
pub use transition::TransitionReason;
