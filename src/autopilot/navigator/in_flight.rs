//! Commands while the stored plan is flown: go to a waypoint, hold here, continue.

use super::Navigator;
use super::leg::Leg;
use crate::autopilot::engage::{self, EngageFacts};
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::plan::FlightPlan;
use crate::telemetry::{InFlightCommand, InFlightRefusal, NavState, PlanSource, TransitionReason};

impl Navigator {
    /// Carries out a command between two updates.
    ///
    /// # Errors
    /// Fails with the reason. Nothing has changed then.
    pub fn command(
        &mut self,
        command: InFlightCommand,
        inputs: &NavInputs,
        params: &Params,
        stored: &FlightPlan,
    ) -> Result<(), InFlightRefusal> {
        let inputs = &self.inputs.apply(inputs);
        if !self.is_flying() {
            return Err(InFlightRefusal::NotFlying);
        }
        if inputs.failsafe {
            return Err(InFlightRefusal::Failsafe);
        }
        if self.task.cursor.source() != PlanSource::Stored {
            return Err(InFlightRefusal::Injected(self.task.cursor.source()));
        }
        match command {
            InFlightCommand::GoTo(index) => self.go_to(index, inputs, params, stored),
            InFlightCommand::HoldHere => self.hold_here(inputs),
            InFlightCommand::Resume => self.resume_held(inputs, params),
        }
    }

    /// Begins a leg from here to waypoint `index`, with the modifiers before it. A delay is not repeated.
    fn go_to(
        &mut self,
        index: u8,
        inputs: &NavInputs,
        params: &Params,
        stored: &FlightPlan,
    ) -> Result<(), InFlightRefusal> {
        // A plan has at most 30 waypoints.
        let count = stored.waypoints.len() as u8;
        let following = stored.waypoints.iter().skip(usize::from(index));
        let Some((positional, _)) =
            (index..).zip(following).find(|(_, waypoint)| waypoint.kind.is_positional())
        else {
            return Err(InFlightRefusal::NoWaypoint { wp: index, count });
        };
        if *self.task.cursor.plan() != *stored {
            let (plan, fence) = EngageFacts::plan_facts(stored, inputs.home, params);
            engage::check(&EngageFacts { plan, fence, ..EngageFacts::READY })
                .map_err(InFlightRefusal::Plan)?;
            self.task.cursor.load(stored);
            self.announce_plan();
        }
        // The mission can then be resumed when the switch is cycled, even after it was complete.
        self.task.cursor.begin_mission(stored);
        self.task.yaw_cap_dps = None;
        self.begin_first_leg(positional, true, TransitionReason::SetCurrent, inputs, params);
        Ok(())
    }

    fn hold_here(&mut self, inputs: &NavInputs) -> Result<(), InFlightRefusal> {
        if self.state == NavState::Complete {
            return Err(InFlightRefusal::Parked);
        }
        self.task.leg = Leg::here(inputs);
        self.task.leg.hold.begin_by_command(inputs.time);
        self.enter(NavState::Holding, TransitionReason::HoldHere);
        Ok(())
    }

    fn resume_held(&mut self, inputs: &NavInputs, params: &Params) -> Result<(), InFlightRefusal> {
        if !self.task.leg.hold.by_command {
            return Err(InFlightRefusal::NotHeld);
        }
        let index = self.task.cursor.index();
        self.begin_first_leg(index, true, TransitionReason::Resume, inputs, params);
        Ok(())
    }
}
