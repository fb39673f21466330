//! Who gives the navigator its orders: the AUTOPILOT switch, the GPS RESCUE switch, commands, and the failsafe.
//!
//! Priority: failsafe procedure, then commands and rescue, then the switch. Orders by command and rescue stay until
//! touchdown, disarming, the AUTOPILOT switch going off, or a cancel.

use crate::autopilot::io::{AbortReason, NavInputs, NavState, Refusal};
use crate::autopilot::rx_loss::{RxLossAction, RxLossFacts, decide};
use crate::autopilot::{Navigator, Params, Rescue};
use crate::plan::FlightPlan;

use super::failsafe::{MissionStatus, Procedure, Response};
use super::modes::AfterAbort;
use super::parameters::{RescueAltitude, RescueConfig};

/// A lost fix must be back this long before an order is repeated, s.
const FIX_BACK_S: f64 = 2.0;

/// An order that does not come from the AUTOPILOT switch.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Order {
    /// Fly home and land, by command or (with its own altitude and speeds) by the rescue switch.
    ReturnHome(Option<Rescue>),
    /// Land here.
    Land,
}

/// What decides about the navigator's orders in this update.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrderFacts {
    /// The AUTOPILOT switch is on.
    pub autopilot_switch: bool,
    /// The GPS RESCUE switch is on and rescue is configured.
    pub rescue_switch: bool,
    /// The RC signal is there, so that switches can be trusted.
    pub signal: bool,
    /// A failsafe procedure is running.
    pub failsafe_active: bool,
    /// What the navigator flies for the failsafe, if it does.
    pub failsafe_mission: Option<Response>,
    /// How long there has been a fix, s.
    pub fix_for_s: f64,
}

/// The orders in force.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Orders {
    order: Option<Order>,
    switch_was: bool,
    was_armed: bool,
    /// The flight ended with the AUTOPILOT switch on: until it is released, it asks for nothing.
    switch_spent: bool,
    rescue_was: bool,
    by_rescue_switch: bool,
    after_abort: AfterAbort,
    highest_m: f64,
}

impl Orders {
    /// What a given-up mission leaves behind while its order stays.
    #[must_use]
    pub fn after_abort(&self) -> AfterAbort {
        self.after_abort
    }

    /// How the navigator's mission stands, for the failsafe.
    #[must_use]
    pub fn status(&self, navigator: &Navigator) -> MissionStatus {
        match (navigator.is_flying(), navigator.state()) {
            (true, NavState::Complete) => MissionStatus::Over,
            (true, _) => MissionStatus::Flying,
            (false, _) if self.after_abort != AfterAbort::Nothing => MissionStatus::Over,
            (false, _) => MissionStatus::Absent,
        }
    }

    /// Fly home and land.
    ///
    /// # Errors
    /// When the craft is not armed or has no fix or no altitude.
    pub fn return_to_home(
        &mut self,
        navigator: &mut Navigator,
        inputs: &NavInputs,
        params: &Params,
        rescue: Option<Rescue>,
    ) -> Result<(), Refusal> {
        navigator.return_to_home(inputs, params, rescue)?;
        self.order = Some(Order::ReturnHome(rescue));
        self.by_rescue_switch = false;
        self.after_abort = AfterAbort::Nothing;
        Ok(())
    }

    /// Land here.
    ///
    /// # Errors
    /// When the craft is not armed or has no fix or no altitude.
    pub fn emergency_land(
        &mut self,
        navigator: &mut Navigator,
        inputs: &NavInputs,
        params: &Params,
    ) -> Result<(), Refusal> {
        navigator.emergency_land(inputs, params)?;
        self.order = Some(Order::Land);
        self.by_rescue_switch = false;
        self.after_abort = AfterAbort::Nothing;
        Ok(())
    }

    /// Takes a command back: the switch decides again.
    pub fn cancel(&mut self) {
        self.order = None;
        self.by_rescue_switch = false;
    }

    /// Remembers why the navigator gave a mission up.
    pub fn mission_aborted(&mut self, why: AbortReason) {
        self.after_abort = match why {
            AbortReason::GpsLost => AfterAbort::Altitude,
            AbortReason::Stalled | AbortReason::Flyaway | AbortReason::NoPlan => AfterAbort::Position,
        };
    }

    /// One update, before the navigator's own.
    pub fn update(
        &mut self,
        navigator: &mut Navigator,
        inputs: &NavInputs,
        params: &Params,
        rescue: &RescueConfig,
        stored: &FlightPlan,
        facts: &OrderFacts,
    ) {
        self.highest_m = if inputs.armed { self.highest_m.max(inputs.alt_m) } else { 0.0 };
        let was_armed = std::mem::replace(&mut self.was_armed, inputs.armed);
        if !inputs.armed {
            self.cancel();
            self.after_abort = AfterAbort::Nothing;
        }
        self.switch_spent = facts.autopilot_switch && (self.switch_spent || was_armed && !inputs.armed);
        if facts.failsafe_active {
            if facts.failsafe_mission.is_none() && navigator.is_flying() {
                navigator.disengage();
            }
            return;
        }
        if !facts.signal && inputs.armed {
            return;
        }
        let released =
            std::mem::replace(&mut self.switch_was, facts.autopilot_switch) && !facts.autopilot_switch;
        if released {
            self.cancel();
            self.after_abort = AfterAbort::Nothing;
            navigator.disengage();
        }
        self.follow_rescue_switch(navigator, inputs, params, rescue, facts);

        let wanted = facts.autopilot_switch && !self.switch_spent || self.order.is_some();
        if navigator.is_flying() {
            if !wanted {
                navigator.disengage();
            }
            return;
        }
        if !wanted {
            self.after_abort = AfterAbort::Nothing;
            return;
        }
        let engaged = match self.order {
            None => navigator.engage(inputs, params, stored).is_ok(),
            Some(_) if facts.fix_for_s < FIX_BACK_S => false,
            Some(Order::ReturnHome(rescue)) => navigator.return_to_home(inputs, params, rescue).is_ok(),
            Some(Order::Land) => navigator.emergency_land(inputs, params).is_ok(),
        };
        if engaged {
            self.after_abort = AfterAbort::Nothing;
        }
    }

    fn follow_rescue_switch(
        &mut self,
        navigator: &mut Navigator,
        inputs: &NavInputs,
        params: &Params,
        rescue: &RescueConfig,
        facts: &OrderFacts,
    ) {
        let was = std::mem::replace(&mut self.rescue_was, facts.rescue_switch);
        if facts.rescue_switch && !was {
            let flight = self.rescue_flight(rescue, inputs);
            self.by_rescue_switch = self.return_to_home(navigator, inputs, params, Some(flight)).is_ok();
        } else if was && !facts.rescue_switch && self.by_rescue_switch {
            self.cancel();
            if facts.autopilot_switch {
                // The mission under the rescue starts again.
                navigator.disengage();
            }
        }
    }

    /// How a rescue that starts now flies home.
    #[must_use]
    pub fn rescue_flight(&self, config: &RescueConfig, inputs: &NavInputs) -> Rescue {
        let altitude_m = match config.altitude {
            RescueAltitude::HighestOfFlight => self.highest_m.max(inputs.alt_m) + config.initial_climb_m,
            RescueAltitude::Fixed => config.return_alt_m,
            RescueAltitude::Present => inputs.alt_m + config.initial_climb_m,
        };
        Rescue {
            altitude_m,
            climb_mps: config.ascend_mps,
            speed_mps: config.ground_speed_mps,
            descend_mps: config.descend_mps,
        }
    }
}

/// What stage 2 of the failsafe does now.
#[must_use]
pub fn failsafe_response(
    navigator: &Navigator,
    params: &Params,
    procedure: Procedure,
    fix: bool,
) -> Response {
    let decision = decide(&RxLossFacts {
        policy: params.rx_loss_policy,
        engaged: navigator.is_flying(),
        state: navigator.state(),
        fix,
    });
    match decision.action {
        RxLossAction::None if decision.autopilot_flag => Response::Continue,
        RxLossAction::None => Response::KeepLanding,
        RxLossAction::EmergencyLand => Response::EmergencyLand,
        RxLossAction::Procedure => Response::Procedure(procedure),
    }
}

#[cfg(test)]
mod tests;
