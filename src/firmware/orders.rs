//! The sources of the navigator's orders: the AUTOPILOT switch, the GPS RESCUE switch, commands, and the failsafe.
//!
//! Priority: failsafe procedure, then commands and rescue (the later one), then the AUTOPILOT switch. A command stays until
//! touchdown, disarming, a cancel, or the AUTOPILOT switch going off. A rescue by switch stays while its switch is on,
//! whatever the AUTOPILOT switch does, and begins again after a command or a failsafe that took its place.

use crate::autopilot::io::NavInputs;
use crate::autopilot::rx_loss::{RxLossAction, RxLossFacts, decide};
use crate::autopilot::{Autopilot, Params, Rescue};
use crate::plan::FlightPlan;
use crate::telemetry::{AbortReason, FirmwareProfile, NavState, Refusal};

use super::failsafe::{MissionStatus, Procedure, Response};
use super::modes::AfterAbort;
use super::parameters::{RescueAltitude, RescueCause, RescueConfig, RescueSanity};
use crate::geo::local_offset;

/// A return home with a landing, by command or (with its own altitude and speeds) by the rescue switch.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Return(Option<Rescue>);

/// The inputs that decide the navigator's orders in one update.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrderFacts {
    /// `true` while the AUTOPILOT switch is on.
    pub autopilot_switch: bool,
    /// `true` while the GPS RESCUE switch is on and rescue is configured.
    pub rescue_switch: bool,
    /// `true` while the RC signal is present, so that switches can be trusted.
    pub signal: bool,
    /// `true` while a failsafe procedure runs.
    pub failsafe_active: bool,
    /// The response that the navigator flies for the failsafe, if any.
    pub failsafe_mission: Option<Response>,
}

/// The orders in force.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Orders {
    order: Option<Return>,
    switch_was: bool,
    was_armed: bool,
    /// `true` if the flight ended with the AUTOPILOT switch on. The switch then has no effect until it is released.
    switch_spent: bool,
    rescue_was: bool,
    by_rescue_switch: bool,
    highest_m: f64,
}

impl Orders {
    /// Returns the holds that stay on after an aborted mission, while its order remains.
    pub fn after_abort(&self, navigator: &Autopilot) -> AfterAbort {
        match navigator.given_up() {
            None => AfterAbort::Nothing,
            // The pilot of a rescue may no longer see the craft, so it does not wait in the air for a fix.
            Some(AbortReason::GpsLost) if self.by_rescue_switch => AfterAbort::Descent,
            Some(_) if navigator.descends_after_abort() => AfterAbort::Descent,
            // Without a heading, too, a tilt leads nowhere.
            Some(AbortReason::GpsLost | AbortReason::MagFault) => AfterAbort::Altitude,
            Some(AbortReason::Stalled | AbortReason::Flyaway | AbortReason::NoPlan) => AfterAbort::Position,
        }
    }

    /// Returns the status of the navigator's mission, for the failsafe.
    pub fn status(&self, navigator: &Autopilot) -> MissionStatus {
        match (navigator.is_flying(), navigator.state()) {
            (true, NavState::Complete) => MissionStatus::Over,
            (true, _) => MissionStatus::Flying,
            (false, _) if navigator.given_up().is_some() => MissionStatus::Over,
            (false, _) => MissionStatus::Absent,
        }
    }

    /// Flies home and lands.
    ///
    /// # Errors
    /// Returns a refusal if the craft is not armed or has no fix or no altitude.
    pub fn return_to_home(
        &mut self,
        navigator: &mut Autopilot,
        inputs: &NavInputs,
        params: &Params,
        rescue: Option<Rescue>,
    ) -> Result<(), Refusal> {
        navigator.return_to_home(inputs, params, rescue)?;
        self.order = Some(Return(rescue));
        self.by_rescue_switch = false;
        Ok(())
    }

    /// Returns `true` while the craft flies home by a command, not by a switch.
    pub fn is_commanded(&self) -> bool {
        self.order.is_some() && !self.by_rescue_switch
    }

    /// Returns `true` while the craft flies home by the rescue switch.
    pub fn is_rescue_by_switch(&self) -> bool {
        self.by_rescue_switch
    }

    /// Cancels a command. The switch decides again, and starts its mission again if it is on.
    pub fn take_back(&mut self, navigator: &mut Autopilot, inputs: &NavInputs) {
        if self.is_commanded() {
            self.cancel();
            navigator.disengage(inputs);
        }
    }

    fn cancel(&mut self) {
        self.order = None;
        self.by_rescue_switch = false;
    }

    /// Runs one update, before the navigator's own.
    pub fn update(
        &mut self,
        navigator: &mut Autopilot,
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
        }
        self.switch_spent = facts.autopilot_switch && (self.switch_spent || was_armed && !inputs.armed);
        if facts.failsafe_active {
            let is_replaced = matches!(
                facts.failsafe_mission,
                Some(Response::EmergencyLand | Response::Procedure(Procedure::GpsRescue))
            );
            if self.by_rescue_switch && is_replaced {
                self.cancel();
            }
            if facts.failsafe_mission.is_none() && navigator.is_flying() {
                navigator.disengage(inputs);
            }
            return;
        }
        if !facts.signal && inputs.armed {
            return;
        }
        let released =
            std::mem::replace(&mut self.switch_was, facts.autopilot_switch) && !facts.autopilot_switch;
        if released && !self.by_rescue_switch {
            self.cancel();
            navigator.disengage(inputs);
        }
        self.update_rescue_switch(navigator, inputs, params, rescue, facts);

        let wanted = facts.autopilot_switch && !self.switch_spent || self.order.is_some();
        if navigator.is_flying() {
            if !wanted {
                navigator.disengage(inputs);
            }
            return;
        }
        if !wanted {
            navigator.forget_given_up();
            return;
        }
        match self.order {
            Some(order) if !navigator.has_landing_to_resume() => {
                if let Err(refusal) = repeat(order, navigator, inputs, params) {
                    navigator.refuse(refusal);
                }
            }
            // The navigator remembers a refusal and reports it.
            Some(_) | None => _ = navigator.engage(inputs, params, stored),
        }
    }

    fn update_rescue_switch(
        &mut self,
        navigator: &mut Autopilot,
        inputs: &NavInputs,
        params: &Params,
        rescue: &RescueConfig,
        facts: &OrderFacts,
    ) {
        let was = std::mem::replace(&mut self.rescue_was, facts.rescue_switch);
        if !facts.rescue_switch {
            if self.by_rescue_switch {
                self.cancel();
                if facts.autopilot_switch {
                    // Restarts the mission that the rescue replaced.
                    navigator.disengage(inputs);
                }
            }
            return;
        }
        // The switch takes the place of a command, and waits for the end of a later one. A fix that has just come back may
        // be lost again at once.
        let waits = self.order.is_some() || inputs.fix && !navigator.has_fix_back(inputs);
        if was && waits {
            return;
        }
        let flight = self.rescue_flight(rescue, inputs, RescueCause::Switch);
        match self.return_to_home(navigator, inputs, params, Some(flight)) {
            Ok(()) => self.by_rescue_switch = true,
            Err(refusal) if !navigator.is_flying() => navigator.refuse(refusal),
            Err(_) => {}
        }
    }

    /// Returns the flight of a rescue that starts now. Near home it does not climb first, because there is nothing to
    /// climb over on the way.
    pub fn rescue_flight(&self, config: &RescueConfig, inputs: &NavInputs, cause: RescueCause) -> Rescue {
        let distance_m = inputs.home.map(|home| (local_offset(inputs.origin, home) - inputs.pos_ne).norm());
        let is_near = distance_m.is_some_and(|distance| distance < config.min_start_dist_m);
        let altitude_m = match config.altitude {
            _ if is_near => inputs.alt_m,
            RescueAltitude::HighestOfFlight => self.highest_m.max(inputs.alt_m) + config.initial_climb_m,
            RescueAltitude::Fixed => config.return_alt_m,
            RescueAltitude::Present => inputs.alt_m + config.initial_climb_m,
        };
        Rescue {
            altitude_m,
            near_climb_m: is_near.then_some(config.initial_climb_m),
            climb_mps: config.ascend_mps,
            speed_mps: config.ground_speed_mps,
            descend_mps: config.descend_mps,
            is_watched: match config.sanity {
                RescueSanity::Off => false,
                RescueSanity::On => true,
                RescueSanity::FailsafeOnly => cause == RescueCause::Failsafe,
            },
        }
    }
}

/// Repeats an aborted return, but only after a lost fix. One that makes no progress lands instead.
fn repeat(
    Return(rescue): Return,
    navigator: &mut Autopilot,
    inputs: &NavInputs,
    params: &Params,
) -> Result<(), Refusal> {
    if !navigator.has_fix_back(inputs) {
        return Err(Refusal::Aborted(AbortReason::GpsLost));
    }
    navigator.return_to_home(inputs, params, rescue)
}

/// Returns the response of stage 2 of the failsafe in the present situation.
pub fn failsafe_response(
    navigator: &Autopilot,
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
    let is_master = navigator.profile() == FirmwareProfile::Master;
    match decision.action {
        RxLossAction::None if decision.autopilot_flag => Response::Continue,
        RxLossAction::None | RxLossAction::EmergencyLand if is_master => {
            Response::Procedure(Procedure::AutoLand)
        }
        RxLossAction::None => Response::KeepLanding,
        RxLossAction::EmergencyLand => Response::EmergencyLand,
        RxLossAction::Procedure => Response::Procedure(procedure),
    }
}

#[cfg(test)]
mod tests;
