//! The navigator of the profile in use, behind one interface.

use super::control::FlightControllers;
use super::io::{NavInputs, NavOutput};
use super::master::{MasterNavigator, Return};
use super::navigator::{Navigator, Rescue};
use super::params::Params;
use crate::plan::FlightPlan;
use crate::telemetry::{
    AbortReason, FirmwareProfile, InFlightCommand, InFlightRefusal, NavEvent, NavState, NavTelemetry, Refusal,
};

/// A navigator. The profile decides which one, and nothing else does.
#[derive(Debug, Clone)]
pub enum Autopilot {
    /// Flies by the laws of the test guide.
    Guide(Box<Navigator>),
    /// Flies by the laws of master.
    Master(Box<MasterNavigator>),
}

/// Calls the same function of either navigator.
macro_rules! either {
    ($autopilot:expr, $navigator:ident => $call:expr) => {
        match $autopilot {
            Autopilot::Guide($navigator) => $call,
            Autopilot::Master($navigator) => $call,
        }
    };
}

impl From<FirmwareProfile> for Autopilot {
    fn from(profile: FirmwareProfile) -> Self {
        match profile {
            FirmwareProfile::Guide => Self::Guide(Box::new(Navigator::new())),
            FirmwareProfile::Master => Self::Master(Box::default()),
        }
    }
}

impl Autopilot {
    /// Returns the profile whose laws it flies by.
    pub fn profile(&self) -> FirmwareProfile {
        match self {
            Self::Guide(_) => FirmwareProfile::Guide,
            Self::Master(_) => FirmwareProfile::Master,
        }
    }

    /// Returns the state of the mission.
    pub fn state(&self) -> NavState {
        either!(self, navigator => navigator.state())
    }

    /// Returns `true` while a mission, a return home or a landing is flown (COMPLETE in the air counts).
    pub fn is_flying(&self) -> bool {
        either!(self, navigator => navigator.is_flying())
    }

    /// Returns the plan that is flown.
    pub fn active_plan(&self) -> &FlightPlan {
        either!(self, navigator => navigator.active_plan())
    }

    /// Returns the state of the last update for displays, logs and samples.
    pub fn telemetry(&self) -> &NavTelemetry {
        either!(self, navigator => navigator.telemetry())
    }

    /// Takes the oldest event that was not taken yet.
    pub fn take_event(&mut self) -> Option<NavEvent> {
        either!(self, navigator => navigator.take_event())
    }

    /// Returns the reason why the last mission was given up, until something takes its place.
    pub fn given_up(&self) -> Option<AbortReason> {
        either!(self, navigator => navigator.given_up())
    }

    /// Returns `true` if a mission that was given up ends in a descent to the ground here.
    pub fn descends_after_abort(&self) -> bool {
        match self {
            Self::Guide(navigator) => navigator.has_landing_to_resume(),
            Self::Master(navigator) => navigator.is_rescue(),
        }
    }

    /// Returns `true` if a landing that lost its fix waits for it.
    pub fn has_landing_to_resume(&self) -> bool {
        matches!(self, Self::Guide(navigator) if navigator.has_landing_to_resume())
    }

    /// Returns `true` if there has been a fix for long enough to fly by it again.
    pub fn has_fix_back(&self, inputs: &NavInputs) -> bool {
        match self {
            Self::Guide(navigator) => navigator.has_fix_back(inputs),
            Self::Master(_) => inputs.fix,
        }
    }

    /// Forgets the mission that was given up, so that nothing waits for it.
    pub fn forget_given_up(&mut self) {
        either!(self, navigator => navigator.forget_given_up());
    }

    /// Engages while the mode switch is on. Call it in each cycle while nothing is flown. It reports a refusal once per
    /// cause.
    ///
    /// # Errors
    /// Fails with the first precondition that does not hold.
    pub fn engage(
        &mut self,
        inputs: &NavInputs,
        params: &Params,
        stored: &FlightPlan,
    ) -> Result<(), Refusal> {
        either!(self, navigator => navigator.engage(inputs, params, stored))
    }

    /// Reports why nothing is flown although it was requested. Each cause gives one event.
    pub fn refuse(&mut self, refusal: Refusal) {
        either!(self, navigator => navigator.refuse(refusal));
    }

    /// Ends the flight when the mode switch goes off.
    pub fn disengage(&mut self, inputs: &NavInputs) {
        match self {
            Self::Guide(navigator) => navigator.disengage(),
            Self::Master(navigator) => navigator.disengage(inputs),
        }
    }

    /// Lands here, now. Master has no such landing of the autopilot.
    ///
    /// # Errors
    /// Fails if the craft is not armed or has no fix or no altitude.
    pub fn emergency_land(&mut self, inputs: &NavInputs) -> Result<(), Refusal> {
        match self {
            Self::Guide(navigator) => navigator.emergency_land(inputs),
            Self::Master(_) => Ok(()),
        }
    }

    /// Flies home and lands, as a rescue if one is given.
    ///
    /// # Errors
    /// Fails if the craft is not armed or has no fix or no altitude.
    pub fn return_to_home(
        &mut self,
        inputs: &NavInputs,
        params: &Params,
        rescue: Option<Rescue>,
    ) -> Result<(), Refusal> {
        either!(self, navigator => navigator.return_to_home(inputs, params, rescue))
    }

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
        match self {
            Self::Guide(navigator) => navigator.command(command, inputs, params, stored),
            Self::Master(navigator) => navigator.command(command, inputs, params),
        }
    }

    /// Runs one update (100 Hz). Returns the demands; `None` while the holds or the pilot fly. `home` is the return of a
    /// fence. While nothing is flown, something else uses the `controllers`.
    pub fn update(
        &mut self,
        inputs: &NavInputs,
        home: Return,
        params: &Params,
        stored: &FlightPlan,
        controllers: &mut FlightControllers,
    ) -> Option<NavOutput> {
        match self {
            Self::Guide(navigator) => {
                let output = navigator.update(inputs, params, stored, controllers);
                navigator.is_flying().then_some(output)
            }
            Self::Master(navigator) => navigator.update(inputs, home, params),
        }
    }
}
