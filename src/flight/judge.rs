//! Decides when a headless flight is over, and judges its result.

use std::borrow::Cow;

use super::verdict::{Crash, FlightResult, Verdict};
use crate::signals::SimTime;
use crate::telemetry::{AbortReason, DisarmReason, NavState, PlanSource, Refusal, TransitionReason};

/// The time that a completed mission without a LAND is watched while it is parked, s.
const PARKED_S: f64 = 5.0;
/// The time after a disarm or a crash in which the last events are still collected, s.
const AFTERMATH_S: f64 = 1.0;
/// The time that a refusal with the same reason may last, s.
const REFUSED_S: f64 = 10.0;
/// The time that the machine may stay IDLE after an engagement, s.
const IDLE_S: f64 = 30.0;
/// The time at full throttle after which a craft that has not lifted off is too heavy, s.
const HEAVY_S: f64 = 5.0;
/// The minimum descent in that time that shows that a landing without a fix continues, m.
const COMING_DOWN_M: f64 = 1.0;

/// The facts for the judge, once per tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JudgeFacts {
    /// Simulated time since boot.
    pub time: SimTime,
    /// `true` while the autopilot is engaged.
    pub engaged: bool,
    /// `true` while the craft is armed.
    pub armed: bool,
    /// Last reason of a disarm since boot.
    pub last_disarm: Option<DisarmReason>,
    /// State of the machine.
    pub state: NavState,
    /// Cause of the last transition.
    pub entered_for: Option<TransitionReason>,
    /// True altitude above the boot place, m.
    pub alt_m: f64,
    /// Index of the current waypoint in the active plan.
    pub wp: u8,
    /// Origin of the active plan.
    pub source: PlanSource,
    /// Reason why the switch has no effect.
    pub refusal: Option<Refusal>,
    /// `true` while a failsafe procedure flies.
    pub failsafe: bool,
    /// `true` if the mission's last positional waypoint is a LAND.
    pub ends_in_land: bool,
    /// Thrust over weight of a craft that stays on the ground although it should climb and is at full throttle.
    pub lift_share: Option<f64>,
    /// `true` if the craft is at rest on the ground.
    pub touched_down: bool,
    /// The crash; `None` while the craft is whole.
    pub crash: Option<Crash>,
    /// `true` if the simulation has left the range in which its numbers are meaningful.
    pub diverged: bool,
}

/// The reason of a mission that the firmware gave up without one.
pub(super) const UNEXPLAINED: &str = "mission given up: the firmware gives no reason";

/// Decides when a flight is over, and with which result.
#[derive(Debug, Clone)]
pub struct Judge {
    timeout: SimTime,
    engaged_at: Option<SimTime>,
    was_armed: bool,
    complete_at: Option<SimTime>,
    completed_source: PlanSource,
    over_at: Option<SimTime>,
    refused: Option<(Refusal, SimTime)>,
    /// Time since which full throttle has not lifted the craft.
    heavy_since: Option<SimTime>,
    /// Time since which the machine has been IDLE, and the altitude then, m.
    idle_since: Option<(SimTime, f64)>,
    state: NavState,
    /// Source of the last plan that was flown.
    source: PlanSource,
    /// The reason of the last change to IDLE. A remote firmware may report it only once.
    given_up: Option<AbortReason>,
    /// `true` if the fix was lost in a landing, or on the way home, which continues without it as a descent.
    lands_without_fix: bool,
}

impl Judge {
    /// Returns a judge with a timeout of `timeout` after boot.
    pub fn new(timeout: SimTime) -> Self {
        Self {
            timeout,
            engaged_at: None,
            was_armed: false,
            complete_at: None,
            completed_source: PlanSource::Stored,
            over_at: None,
            refused: None,
            heavy_since: None,
            idle_since: None,
            state: NavState::Idle,
            source: PlanSource::Stored,
            given_up: None,
            lands_without_fix: false,
        }
    }

    /// Returns the time at which the autopilot first engaged.
    pub fn engaged_at(&self) -> Option<SimTime> {
        self.engaged_at
    }

    /// Takes the facts of a tick. A verdict ends the flight.
    pub fn look(&mut self, facts: &JudgeFacts) -> Option<Verdict> {
        let now = facts.time;
        if facts.diverged {
            return verdict(
                FlightResult::Diverged,
                "the simulation diverged: its numbers mean nothing any more",
            );
        }
        if facts.engaged && self.engaged_at.is_none() {
            self.engaged_at = Some(now);
        }
        self.was_armed |= facts.armed;
        if facts.state == NavState::Complete {
            if self.complete_at.is_none() {
                self.complete_at = Some(now);
                self.completed_source = facts.source;
            }
        } else if facts.armed {
            self.complete_at = None;
        }
        self.note_state(facts);
        self.judge_ground(facts)
            .or_else(|| self.judge_complete(facts))
            .or_else(|| self.judge_refusal(facts))
            .or_else(|| self.judge_lift(facts))
            .or_else(|| self.judge_idle(facts))
            .or_else(|| (now >= self.timeout).then(|| self.timeout_verdict(facts)))
    }

    fn note_state(&mut self, facts: &JudgeFacts) {
        if facts.state != self.state {
            self.given_up = match facts.entered_for {
                Some(TransitionReason::GivenUp(why)) => Some(why),
                _ => None,
            };
            match facts.state {
                NavState::Idle => {
                    let may_land = self.state == NavState::Landing || self.source == PlanSource::Rth;
                    self.lands_without_fix = may_land && self.given_up == Some(AbortReason::GpsLost);
                }
                // The firmware reports this state after a touchdown without a fix.
                NavState::Complete => {}
                _ => self.lands_without_fix = false,
            }
            self.state = facts.state;
        }
        if facts.state != NavState::Idle {
            self.source = facts.source;
        }
    }

    fn judge_ground(&mut self, facts: &JudgeFacts) -> Option<Verdict> {
        let over = facts.crash.is_some() || (self.was_armed && !facts.armed);
        if !over {
            self.over_at = None;
            return None;
        }
        let since = *self.over_at.get_or_insert(facts.time);
        let landed = facts.last_disarm == Some(DisarmReason::Landing) && facts.crash.is_none();
        let settled = facts.time.seconds_since(since) >= AFTERMATH_S;
        if !(settled || landed && facts.touched_down) {
            return None;
        }
        if let Some(crash) = facts.crash {
            return Some(Verdict::new(FlightResult::Crashed, crash.to_string()));
        }
        if landed && self.lands_without_fix {
            return verdict(FlightResult::Landed, "landed without a GPS fix");
        }
        if landed {
            return match (self.complete_at, self.completed_source) {
                (Some(_), PlanSource::Stored) => {
                    verdict(FlightResult::Complete, "mission complete, landed and disarmed")
                }
                (Some(_), PlanSource::Rth) => {
                    verdict(FlightResult::Landed, "landed at home after a return to home")
                }
                (Some(_), PlanSource::Emergency) => {
                    verdict(FlightResult::Landed, "landed by an emergency landing")
                }
                (None, _) => verdict(FlightResult::Landed, "landed, but not by the plan"),
            };
        }
        // Firmwares other than the embedded one also disarm for this reason after a landing that their failsafe flew.
        if facts.last_disarm == Some(DisarmReason::Failsafe) && facts.touched_down {
            return verdict(FlightResult::Landed, "landed under failsafe, and disarmed by it");
        }
        let reason = facts.last_disarm.map_or_else(|| "unknown".to_owned(), |reason| reason.to_string());
        Some(Verdict {
            result: FlightResult::Disarmed,
            reason: format!("disarmed by {reason} before the end"),
        })
    }

    /// Judges a craft that is parked in the air after the last waypoint.
    fn judge_complete(&self, facts: &JudgeFacts) -> Option<Verdict> {
        let since = self.complete_at?;
        if facts.ends_in_land && facts.source == PlanSource::Stored {
            return None;
        }
        (facts.time.seconds_since(since) >= PARKED_S).then(|| Verdict {
            result: FlightResult::Complete,
            reason: "mission complete, parked at the last waypoint".to_owned(),
        })
    }

    fn judge_refusal(&mut self, facts: &JudgeFacts) -> Option<Verdict> {
        let Some(refusal) = facts.refusal.filter(|refusal| {
            // The IDLE rule handles a mission that is given up after an engagement.
            !facts.engaged && !matches!(refusal, Refusal::Aborted(_))
        }) else {
            self.refused = None;
            return None;
        };
        match self.refused {
            Some((same, since)) if same == refusal => {
                (facts.time.seconds_since(since) >= REFUSED_S).then(|| Verdict {
                    result: FlightResult::Refused,
                    reason: format!("autopilot refused: {}", refusal.sentence()),
                })
            }
            _ => {
                self.refused = Some((refusal, facts.time));
                None
            }
        }
    }

    /// Judges a craft that is too heavy to take off.
    fn judge_lift(&mut self, facts: &JudgeFacts) -> Option<Verdict> {
        let Some(share) = facts.lift_share else {
            self.heavy_since = None;
            return None;
        };
        let since = *self.heavy_since.get_or_insert(facts.time);
        (facts.time.seconds_since(since) >= HEAVY_S).then(|| {
            Verdict::new(
                FlightResult::Refused,
                format!(
                    "the craft does not lift off: with all the throttle of ap_throttle_max its thrust is {share:.2} of its weight"
                ),
            )
        })
    }

    fn judge_idle(&mut self, facts: &JudgeFacts) -> Option<Verdict> {
        if self.engaged_at.is_none() || facts.state != NavState::Idle {
            self.idle_since = None;
            return None;
        }
        let (mut since, from_m) = *self.idle_since.get_or_insert((facts.time, facts.alt_m));
        if self.lands_without_fix && facts.alt_m <= from_m - COMING_DOWN_M {
            since = facts.time;
            self.idle_since = Some((since, facts.alt_m));
        }
        (facts.time.seconds_since(since) >= IDLE_S).then(|| {
            let given_up = match facts.refusal {
                Some(Refusal::Aborted(why)) => Some(why),
                _ => self.given_up,
            };
            let why: Cow<'static, str> = match (given_up, facts.refusal) {
                // The sentences of these refusals begin with the giving up.
                (Some(AbortReason::Stalled), _) => "the craft made no progress: cycle the switch.".into(),
                (Some(AbortReason::Flyaway), _) => {
                    "the craft moved away from its waypoint: cycle the switch.".into()
                }
                (_, Some(refusal)) => refusal.sentence(),
                (Some(AbortReason::GpsLost), None) => "the GPS fix was lost.".into(),
                (Some(AbortReason::NoPlan), None) => "the plan was cleared in flight.".into(),
                (Some(AbortReason::MagFault), None) => "the course did not fit the heading.".into(),
                _ if facts.failsafe => "a failsafe procedure flies.".into(),
                _ if facts.entered_for == Some(TransitionReason::Disengage) => {
                    "the AUTOPILOT switch was turned off; turned on again it resumes.".into()
                }
                _ => return Verdict::new(FlightResult::Aborted, UNEXPLAINED),
            };
            Verdict::new(FlightResult::Aborted, format!("mission given up: {why}"))
        })
    }

    fn timeout_verdict(&self, facts: &JudgeFacts) -> Verdict {
        let limit = self.timeout.as_secs_f64();
        let doing = if !self.was_armed {
            "the craft never armed".to_owned()
        } else if self.engaged_at.is_none() {
            "the autopilot never engaged".to_owned()
        } else {
            format!("still {} at waypoint {}", facts.state, facts.wp)
        };
        Verdict { result: FlightResult::Timeout, reason: format!("not over {limit} s after boot: {doing}") }
    }
}

fn verdict(result: FlightResult, reason: &str) -> Option<Verdict> {
    Some(Verdict::new(result, reason))
}

#[cfg(test)]
mod tests;
