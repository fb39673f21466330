//! Commands to the navigator while it flies a plan, and the reasons for which it refuses them.

use super::nav::PlanSource;
use super::refusal::Refusal;

/// A command to a navigator that flies the stored plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InFlightCommand {
    /// Fly to this waypoint of the stored plan now. If another plan was stored meanwhile, that one is flown
    /// from here on.
    GoTo(u8),
    /// Hold this position and altitude until another command.
    HoldHere,
    /// Continue to the current waypoint after a hold.
    Resume,
}

/// The reason for a refusal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InFlightRefusal {
    /// The autopilot does not fly.
    NotFlying,
    /// A procedure of the receiver failsafe is running.
    Failsafe,
    /// A return home or an emergency landing is in progress.
    Injected(PlanSource),
    /// The stored plan has no waypoint with this index to fly to.
    NoWaypoint {
        /// Index of the waypoint.
        wp: u8,
        /// The number of waypoints in the plan.
        count: u8,
    },
    /// The plan that was stored meanwhile cannot be flown.
    Plan(Refusal),
    /// The plan is complete and the craft parked.
    Parked,
    /// No hold by command is active.
    NotHeld,
    /// The navigator of the profile `master` has no such command.
    NotInProfile,
    /// The flight controller is remote and has no such commands.
    Remote,
}

impl InFlightRefusal {
    /// Returns one sentence with the reason and the remedy.
    pub fn sentence(&self) -> String {
        match self {
            Self::NotFlying => "The autopilot does not fly: engage it first.".to_owned(),
            Self::Failsafe => "The receiver failsafe flies: restore the link first.".to_owned(),
            Self::Injected(PlanSource::Rth) => "A return home is flown: take it back first.".to_owned(),
            Self::Injected(_) => "An emergency landing is flown: cycle the AUTOPILOT switch.".to_owned(),
            Self::NoWaypoint { wp, count: 0 } => {
                format!("There is no waypoint {wp} to fly to: the stored plan is empty, upload one.")
            }
            Self::NoWaypoint { wp, count } if wp >= count => {
                format!("There is no waypoint {wp}: the stored plan has 0 to {}.", count - 1)
            }
            Self::NoWaypoint { wp, .. } => {
                format!("Nothing to fly to at waypoint {wp}: no place follows, choose an earlier one.")
            }
            Self::Plan(refusal) => format!("The new plan cannot be flown. {}", refusal.sentence()),
            Self::Parked => {
                "The plan is complete and the craft keeps its place: go to a waypoint.".to_owned()
            }
            Self::NotHeld => "Nothing is held by command, so there is nothing to resume.".to_owned(),
            Self::NotInProfile => {
                "The profile master has no such command: it can only go to a waypoint.".to_owned()
            }
            Self::Remote => "The flight controller is another program, which has no such command.".to_owned(),
        }
    }
}
