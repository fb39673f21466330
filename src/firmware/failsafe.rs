//! The failsafe machine: what happens when the receiver link is lost, and how the pilot gets the craft back.
//!
//! ```text
//!            link down                  procedure over            link up
//!   IDLE ───────────────► LANDING ┐
//!    ▲                    MISSION ├───────────────► MONITORING ─────────┐
//!    │                    (drop)  ┘  disarm                             │
//!    └──────────────────────── recovered ◄──────────────────────────────┘
//!              link up (MISSION: and a stick moved, or made by the switch)
//! ```
//!
//! The link is debounced by [`LinkMonitor`]; the machine itself runs a hundred times a second.

pub mod link;

pub use link::LinkMonitor;

use crate::signals::SimTime;
use crate::telemetry::FailsafeProcedure;

/// A mission that the autopilot does not fly any more for this long is over, s.
const MISSION_GONE_S: f64 = 1.0;

/// What the FAILSAFE switch does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SwitchMode {
    /// Counts as signal loss.
    #[default]
    Stage1,
    Kill,
    /// Starts the procedure at once.
    Stage2,
}

/// What stage 2 does unless the autopilot's policy says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Procedure {
    #[default]
    Drop,
    /// Level, hold the place, descend.
    AutoLand,
    /// Fly home and land.
    GpsRescue,
}

/// What stage 2 does in the present situation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Response {
    Procedure(Procedure),
    /// The mission goes on.
    Continue,
    /// The navigator lands where the craft is.
    EmergencyLand,
    /// The navigator is landing already and goes on.
    KeepLanding,
}

impl Response {
    /// What logs and events tell of it.
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

/// Settings of the failsafe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailsafeConfig {
    /// The machine starts this long after boot, s.
    pub start_s: f64,
    /// Longest AUTO-LAND descent, s.
    pub landing_time_s: f64,
    /// Throttle low for this long before the loss: just disarm, s.
    pub throttle_low_s: f64,
    /// Stick deflection that takes control back, % of full stick.
    pub stick_threshold_percent: f64,
    /// What the FAILSAFE switch does.
    pub switch_mode: SwitchMode,
    pub procedure: Procedure,
}

impl Default for FailsafeConfig {
    fn default() -> Self {
        Self {
            start_s: 5.0,
            landing_time_s: 60.0,
            throttle_low_s: 10.0,
            stick_threshold_percent: 30.0,
            switch_mode: SwitchMode::Stage1,
            procedure: Procedure::Drop,
        }
    }
}

/// How the navigator's mission stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MissionStatus {
    /// It is being flown.
    Flying,
    /// It is complete or was given up.
    Over,
    /// The autopilot is not engaged.
    Absent,
}

/// What the machine looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailsafeFacts {
    pub now: SimTime,
    pub armed: bool,
    /// The FAILSAFE switch is on.
    pub switch: bool,
    /// The debounced link is up.
    pub link_up: bool,
    /// The raw signal is there.
    pub signal: bool,
    /// The pilot's throttle is low.
    pub throttle_low: bool,
    /// The craft is airborne in a mode in which the throttle stick means nothing.
    pub held: bool,
    /// Farthest stick deflection as received, % of full stick.
    pub stick_percent: f64,
    pub fix: bool,
    pub home: bool,
    /// How the mission stands.
    pub mission: MissionStatus,
    /// What stage 2 would do now.
    pub response: Response,
}

/// What is to be done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FailsafeAction {
    /// The signal is gone: guard time runs.
    Stage1,
    /// Stage 2 begins with this response.
    Stage2(Response),
    /// The response in force is replaced by this one (its mission ended, or the fix went).
    Switch(Response),
    Disarm,
    /// The pilot has the craft back.
    Recovered,
}

/// What the machine is doing.
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
    /// Whether a procedure (stage 2) owns the sticks.
    pub fn active(&self) -> bool {
        self.phase != Phase::Idle
    }

    /// Whether the FAILSAFE mode is to be shown.
    pub fn shown(&self) -> bool {
        self.active() || self.shown
    }

    /// 0: all well, 1: guard time, 2: procedure.
    pub fn stage(&self) -> u8 {
        match (self.active(), self.guard_time) {
            (true, _) => 2,
            (false, true) => 1,
            (false, false) => 0,
        }
    }

    /// Whether a failsafe ended the flight and the link is not good again.
    pub fn landed(&self) -> bool {
        self.phase == Phase::Monitoring
    }

    /// Whether the craft descends by AUTO-LAND.
    pub fn auto_landing(&self) -> bool {
        matches!(self.phase, Phase::Landing { .. })
    }

    /// What the navigator flies for the failsafe, if it does.
    pub fn mission(&self) -> Option<Response> {
        match self.phase {
            Phase::Mission { response, .. } => Some(response),
            Phase::Idle | Phase::Landing { .. } | Phase::Monitoring => None,
        }
    }

    /// Whether the failsafe was made by the switch, so that the link counts as up the moment it goes off.
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

    /// Enters the phase of a response.
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
        // Without a fix, or under a policy that overrides the procedure, only a descent is left.
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

/// The response that can be carried out: a rescue without fix or home becomes a descent.
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
