//! The actions that are refused with a remote flight controller, and further ones that are refused with a real craft.

use crate::fc::{NOTHING_MOVES, NOTHING_SIMULATED, RemoteState, RemoteView};

use super::{Action, EditAction, PanelAction};

/// The refusal for a flight controller without waypoints.
const NO_PLANS: &str = "This flight controller has no waypoints: build its firmware with flight plans, \
                        EXTRA_FLAGS=\"-DENABLE_FLIGHT_PLANNING=1\" (board or SITL).";

/// The refusal for orders to the navigator of another program.
const NO_ORDERS: &str = "A remote firmware takes no such order in flight: switch the autopilot off and fly there, or upload another plan.";

/// The refusal for a firmware that has not yet reported its settings.
pub(super) const NOT_KNOWN_YET: &str =
    "The remote firmware has not reported its identity and switches: wait until it answers.";

/// Returns the reason to refuse an action with this remote flight controller.
pub(super) fn refusal(remote: &RemoteView, action: Action) -> Option<&'static str> {
    let is_real = remote.access.is_limited();
    match action {
        _ if is_real && moves(action) => Some(NOTHING_MOVES),
        _ if is_real && changes_world(action) => Some(NOTHING_SIMULATED),
        Action::GoTo | Action::HoldHere | Action::Resume => Some(NO_ORDERS),
        Action::Fly if remote.state != RemoteState::Ready => Some(NOT_KNOWN_YET),
        Action::Fly if !remote.has_plans => Some(NO_PLANS),
        Action::Upload | Action::Edit(EditAction::Download)
            if remote.state == RemoteState::Ready && !remote.has_plans =>
        {
            Some(NO_PLANS)
        }
        _ => None,
    }
}

/// Returns `true` if the action moves a switch or a stick, or makes the craft fly elsewhere.
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
            | Action::Panel(PanelAction::Lower)
            | Action::Panel(PanelAction::Raise)
            | Action::Panel(PanelAction::LowerMuch)
            | Action::Panel(PanelAction::RaiseMuch)
            | Action::Panel(PanelAction::Flip)
            | Action::Panel(PanelAction::Record)
            | Action::Panel(PanelAction::Play)
    )
}

/// Returns `true` if the action changes place, air or faults of a simulated craft.
fn changes_world(action: Action) -> bool {
    matches!(
        action,
        Action::ResetCraft
            | Action::Panel(PanelAction::KnobLess)
            | Action::Panel(PanelAction::KnobMore)
            | Action::Panel(PanelAction::KnobEnter)
            | Action::Panel(PanelAction::KnobEdit)
            | Action::Panel(PanelAction::KnobDefault)
    )
}
