//! The failsafe machine: the reaction to a lost receiver link, and the ways in which the pilot gets the craft back.
//!
//! ```text
//!            link down                  procedure over            link up
//!   IDLE ───────────────► LANDING ┐
//!    ▲                    MISSION ├───────────────► MONITORING ─────────┐
//!    │                    (drop)  ┘  disarm                             │
//!    └──────────────────────── recovered ◄──────────────────────────────┘
//!              link up (MISSION: and a stick moved, or started by the switch)
//! ```
//!
//! The link is debounced by [`LinkMonitor`]. The machine itself runs a hundred times a second.

pub mod link;

pub use link::LinkMonitor;

use crate::signals::SimTime;
use crate::telemetry::FailsafeProcedure;

/// The time without the autopilot after which a mission is over, s.
const MISSION_GONE_S: f64 = 1.0;

/// The action of the FAILSAFE switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SwitchMode {
    /// Counts as signal loss.
    #[default]
    Stage1,
    Kill,
    /// Starts the procedure at once.
    Stage2,
}

/// The action of stage 2, unless the autopilot's policy overrides it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Procedure {
    #[default]
    Drop,
    /// Levels the craft, holds the position and descends.
    AutoLand,
    /// Flies home and lands.
    GpsRescue,
}

/// The action of stage 2 in the present situation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Response {
    Procedure(Procedure),
    /// The mission continues.
    Continue,
    /// The navigator lands at the present position.
    EmergencyLand,
    /// The navigator is already landing and continues.
    KeepLanding,
}

impl Response {
    /// Returns the name used for it in logs and events.
    pub fn procedure(self) -> FailsafeProcedure {
        match self {
            Self::Procedure(Procedure::Drop) => FailsafeProcedure::Drop,
            Self::Procedure(Procedure::AutoLand) => FailsafeProcedure::AutoLand,
            Self::Procedure(Procedure::GpsRescue) => FailsafeProcedure::GpsRescue,
            Self::Continue => FailsafeProcedure::Continue,
            Self::EmergencyLand | Self::KeepLanding => FailsafeProcedure::Land,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailsafeConfig {
    /// The time after boot at which the machine starts, s.
    pub start_s: f64,
    /// The longest AUTO-LAND descent, s.
    pub landing_time_s: f64,
    /// The time at low throttle before the loss after which the craft is just disarmed, s.
    pub throttle_low_s: f64,
    /// The stick deflection that takes control back, % of full stick.
    pub stick_threshold_percent: f64,
    /// The action of the FAILSAFE switch.
    pub switch_mode: SwitchMode,
    pub procedure: Procedure,
}

/// The status of the navigator's mission.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MissionStatus {
    /// It is being flown.
    Flying,
    /// It is complete or was aborted.
    Over,
    /// The autopilot is not engaged.
    Absent,
}

/// The inputs of the machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailsafeFacts {
    pub now: SimTime,
    pub armed: bool,
    /// `true` while the FAILSAFE switch is on.
    pub switch: bool,
    /// `true` while the debounced link is up.
    pub link_up: bool,
    /// `true` while the raw signal is present.
    pub signal: bool,
    /// `true` while the pilot's throttle is low.
    pub throttle_low: bool,
    /// `true` if the craft is airborne in a mode in which the throttle stick has no meaning.
    pub held: bool,
    /// The largest stick deflection as received, % of full stick.
    pub stick_percent: f64,
    pub fix: bool,
    pub home: bool,
    /// The status of the mission.
    pub mission: MissionStatus,
    /// The action that stage 2 would take now.
    pub response: Response,
}

/// The action to take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FailsafeAction {
    /// The signal is lost and the guard time runs.
    Stage1,
    /// Stage 2 begins with this response.
    Stage2(Response),
    /// This response replaces the one in force, because its mission ended or the fix was lost.
    Switch(Response),
    Disarm,
    /// The pilot has control again.
    Recovered,
}

/// The phase of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Phase {
    #[default]
    Idle,
    Landing {
        since: SimTime,
    },
    Mission {
        response: Response,
        absent_since: Option<SimTime>,
    },
    Monitoring,
}

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Failsafe {
    phase: Phase,
    guard_time: bool,
    by_switch: bool,
    shown: bool,
    throttle_high_at: Option<SimTime>,
}

impl Failsafe {
    /// Returns `true` from the start of stage 2 until recovery. The pilot's sticks have no effect then.
    pub fn active(&self) -> bool {
        self.phase != Phase::Idle
    }

    /// Returns `true` if the FAILSAFE mode must be shown.
    pub fn shown(&self) -> bool {
        self.active() || self.shown
    }

    /// Returns the stage: 0 = normal, 1 = guard time, 2 = procedure.
    pub fn stage(&self) -> u8 {
        match (self.active(), self.guard_time) {
            (true, _) => 2,
            (false, true) => 1,
            (false, false) => 0,
        }
    }

    /// Returns `true` if a failsafe ended the flight and the link has not recovered yet.
    pub fn landed(&self) -> bool {
        self.phase == Phase::Monitoring
    }

    /// Returns `true` while the craft descends by AUTO-LAND.
    pub fn auto_landing(&self) -> bool {
        matches!(self.phase, Phase::Landing { .. })
    }

    /// Returns the response that the navigator flies for the failsafe, if any.
    pub fn mission(&self) -> Option<Response> {
        match self.phase {
            Phase::Mission { response, .. } => Some(response),
            Phase::Idle | Phase::Landing { .. } | Phase::Monitoring => None,
        }
    }

    /// Returns `true` if the switch started the failsafe. The link then counts as up as soon as the switch goes off.
    pub fn by_switch(&self) -> bool {
        self.by_switch
    }

    pub fn update(&mut self, config: &FailsafeConfig, facts: &FailsafeFacts) -> Option<FailsafeAction> {
        if facts.now.as_secs_f64() < config.start_s {
            return None;
        }
        self.track_throttle(facts);
        let switched = facts.switch && config.switch_mode == SwitchMode::Stage2;
        let link_up = facts.link_up && !switched;
        match self.phase {
            Phase::Idle => self.idle(config, facts, link_up),
            Phase::Landing { since } => {
                if link_up {
                    return self.recover();
                }
                let expired = facts.now.seconds_since(since) >= config.landing_time_s;
                if facts.armed && !expired {
                    return None;
                }
                self.phase = Phase::Monitoring;
                facts.armed.then_some(FailsafeAction::Disarm)
            }
            Phase::Mission { response, absent_since } => {
                self.fly_mission(config, facts, link_up, response, absent_since)
            }
            Phase::Monitoring => {
                let killed = facts.switch && config.switch_mode == SwitchMode::Kill;
                if link_up && !killed { self.recover() } else { None }
            }
        }
    }

    fn track_throttle(&mut self, facts: &FailsafeFacts) {
        if !facts.armed {
            self.throttle_high_at = None;
        } else if facts.signal && !facts.throttle_low {
            self.throttle_high_at = Some(facts.now);
        }
    }

    fn idle(
        &mut self,
        config: &FailsafeConfig,
        facts: &FailsafeFacts,
        link_up: bool,
    ) -> Option<FailsafeAction> {
        let was_guarding = std::mem::replace(&mut self.guard_time, facts.armed && !facts.signal);
        self.shown = !facts.armed && facts.switch;
        if !facts.armed {
            return None;
        }
        if facts.switch && config.switch_mode == SwitchMode::Kill {
            return Some(self.start(facts, Response::Procedure(Procedure::Drop)));
        }
        if link_up {
            return (self.guard_time && !was_guarding).then_some(FailsafeAction::Stage1);
        }
        let long_low =
            self.throttle_high_at.is_none_or(|at| facts.now.seconds_since(at) >= config.throttle_low_s);
        let just_disarm = long_low && config.procedure != Procedure::GpsRescue && !facts.held;
        let response = if just_disarm { Response::Procedure(Procedure::Drop) } else { facts.response };
        Some(self.start(facts, response))
    }

    /// Starts the phase of a response.
    fn start(&mut self, facts: &FailsafeFacts, wanted: Response) -> FailsafeAction {
        self.by_switch = facts.switch;
        let response = feasible(facts, wanted);
        self.enter(facts, response);
        FailsafeAction::Stage2(response)
    }

    fn enter(&mut self, facts: &FailsafeFacts, response: Response) {
        self.guard_time = false;
        self.phase = match response {
            Response::Procedure(Procedure::Drop) => Phase::Monitoring,
            Response::Procedure(Procedure::AutoLand) => Phase::Landing { since: facts.now },
            Response::Procedure(Procedure::GpsRescue)
            | Response::Continue
            | Response::EmergencyLand
            | Response::KeepLanding => Phase::Mission { response, absent_since: None },
        };
    }

    fn fly_mission(
        &mut self,
        config: &FailsafeConfig,
        facts: &FailsafeFacts,
        link_up: bool,
        response: Response,
        absent_since: Option<SimTime>,
    ) -> Option<FailsafeAction> {
        if link_up && (self.by_switch || facts.stick_percent >= config.stick_threshold_percent) {
            return self.recover();
        }
        if !facts.armed {
            self.phase = Phase::Monitoring;
            return None;
        }
        let absent_since = match facts.mission {
            MissionStatus::Absent => Some(absent_since.unwrap_or(facts.now)),
            MissionStatus::Flying | MissionStatus::Over => None,
        };
        let gone = absent_since.is_some_and(|since| facts.now.seconds_since(since) >= MISSION_GONE_S);
        if facts.fix && facts.mission != MissionStatus::Over && !gone {
            self.phase = Phase::Mission { response, absent_since };
            return None;
        }
        // Without a fix, or under a policy that overrides the procedure, a descent is the only option.
        let next = match (response, config.procedure) {
            (Response::Continue, Procedure::Drop) if facts.fix => Procedure::Drop,
            _ => Procedure::AutoLand,
        };
        self.enter(facts, Response::Procedure(next));
        Some(FailsafeAction::Switch(Response::Procedure(next)))
    }

    fn recover(&mut self) -> Option<FailsafeAction> {
        *self = Self { throttle_high_at: self.throttle_high_at, ..Self::default() };
        Some(FailsafeAction::Recovered)
    }
}

/// Returns the response that is feasible: a rescue without fix or home becomes a descent.
fn feasible(facts: &FailsafeFacts, wanted: Response) -> Response {
    match wanted {
        Response::Procedure(Procedure::GpsRescue) if !(facts.fix && facts.home) => {
            Response::Procedure(Procedure::AutoLand)
        }
        Response::Procedure(_) | Response::Continue | Response::EmergencyLand | Response::KeepLanding => {
            wanted
        }
    }
}

#[cfg(test)]
mod tests;
