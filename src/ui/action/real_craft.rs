//! What is not offered with a flight controller outside, and less with one whose craft is real.

use crate::session::{NOTHING_MOVES, NOTHING_SIMULATED, RemoteState, RemoteView};

use super::{Action, EditAction};

/// Why a plan cannot go to a flight controller that has none.
const NO_PLANS: &str =
    "This flight controller has no waypoints: its firmware was built without flight plans (FLIGHT_PLAN).";

/// Why an action makes no sense with this flight controller outside.
pub(super) fn refusal(remote: &RemoteView, action: Action) -> Option<&'static str> {
    let is_real = remote.access.is_limited();
    match action {
        _ if is_real && moves(action) => Some(NOTHING_MOVES),
        _ if is_real && changes_world(action) => Some(NOTHING_SIMULATED),
        Action::Upload | Action::Edit(EditAction::Download)
            if remote.state == RemoteState::Ready && !remote.has_plans =>
        {
            Some(NO_PLANS)
        }
        _ => None,
    }
}

/// Whether an action moves a switch or a stick, or has the craft fly elsewhere.
fn moves(action: Action) -> bool {
    matches!(
        action,
        Action::Fly
            | Action::Arm
            | Action::Throttle
            | Action::Autopilot
            | Action::ReturnHome
            | Action::GoTo
            | Action::HoldHere
            | Action::Resume
            | Action::CutRc
            | Action::Lower
            | Action::Raise
            | Action::LowerMuch
            | Action::RaiseMuch
            | Action::Flip
            | Action::Record
            | Action::Play
    )
}

/// Whether an action changes place, air or faults of a simulated craft.
fn changes_world(action: Action) -> bool {
    matches!(
        action,
        Action::ResetCraft
            | Action::KnobLess
            | Action::KnobMore
            | Action::KnobEnter
            | Action::KnobEdit
            | Action::KnobDefault
    )
}
