//! Decides on the reaction of a mission to a lost receiver, when stage 2 of the failsafe begins.

use crate::telemetry::{NavState, RxLossPolicy};

/// Facts for the decision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RxLossFacts {
    /// `ap_rx_loss_policy`.
    pub policy: RxLossPolicy,
    /// `true` if the autopilot flies.
    pub engaged: bool,
    /// State of the machine.
    pub state: NavState,
    /// `true` if a 3-D fix is present.
    pub fix: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
#[strum(serialize_all = "SCREAMING_SNAKE_CASE")]
pub enum RxLossAction {
    /// No action. The present flight continues.
    None,
    /// Land where the link was lost. The navigator flies the landing under the failsafe.
    EmergencyLand,
    /// End the mission and run the configured failsafe procedure.
    Procedure,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RxLossDecision {
    pub action: RxLossAction,
    /// `true` if the AUTOPILOT mode flag stays on.
    pub autopilot_flag: bool,
}

/// Decides by policy and state.
pub fn decide(facts: &RxLossFacts) -> RxLossDecision {
    let (action, autopilot_flag) = match facts.policy {
        RxLossPolicy::Disable => (RxLossAction::Procedure, false),
        RxLossPolicy::Continue => {
            if flying(facts) && facts.state != NavState::Complete {
                (RxLossAction::None, true)
            } else {
                (RxLossAction::Procedure, false)
            }
        }
        RxLossPolicy::Land => {
            if !flying(facts) {
                (RxLossAction::Procedure, false)
            } else if facts.state == NavState::Landing {
                (RxLossAction::None, false)
            } else {
                (RxLossAction::EmergencyLand, false)
            }
        }
    };
    RxLossDecision { action, autopilot_flag }
}

fn flying(facts: &RxLossFacts) -> bool {
    facts.engaged && facts.fix && facts.state != NavState::Idle
}
