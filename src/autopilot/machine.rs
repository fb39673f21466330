//! The waypoint state machine: facts → guards → one outcome. It is pure; the navigator carries the outcome out.
//!
//! ```text
//!  engage ──► APPROACHING ──arrival──► ARRIVED ─┬─ FLYOVER, FLYBY, TAKEOFF ──► next APPROACHING, or COMPLETE
//!                 ▲   (CLIMBING overlay)        ├─ HOLD ──► HOLDING ─┬─ time ──► next, or COMPLETE
//!                 │                             │                    └─► ORBITING / FIGURE8 ── time ──► next, or COMPLETE
//!                 └──── next ◄──────────────────┴─ LAND ──► (HOLDING) ──► LANDING ── touchdown ──► COMPLETE, disarm
//!  any state: no fix, plan cleared ──► IDLE        outside the fence ──► LANDING here, or APPROACHING home
//! ```

mod rules;
#[cfg(test)]
mod tests;

use arrayvec::ArrayVec;

use super::fence::FenceFacts;
use super::guidance::PlaneCrossing;
use super::land_detector::{GroundFacts, TouchdownFacts, TouchdownGuards};
use crate::plan::{HoldPattern, Seconds, WaypointType};
use crate::telemetry::{AbortReason, FenceAction, Guard, GuardName, NavState, PlanSource, TransitionReason};

pub use rules::rules;

/// The time without progress after which a mission is given up, s.
pub const STALL_S: f64 = 30.0;

/// The time at the place of a HOLD without getting nearer to its altitude after which the hold begins anyway, s.
pub const HELD_OFF_S: f64 = 10.0;

/// The largest altitude error at which a HOLD begins at once, m, unless the hold radius is greater.
const HOLD_ALTITUDE_M: f64 = 2.0;

/// The current waypoint and its place in the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaypointFacts {
    pub kind: WaypointType,
    pub pattern: HoldPattern,
    /// Hold time.
    pub duration: Seconds,
    /// `true` if no positional waypoint follows.
    pub last: bool,
    /// `true` if the next positional waypoint is less than 10 cm away.
    pub co_located: bool,
    /// `true` if the craft passed the plane of the waypoint too far beside. It must come back to the point.
    pub missed: bool,
}

/// The position of the craft relative to the waypoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ApproachFacts {
    /// Horizontal distance, m.
    pub distance_m: f64,
    /// Altitude of the target minus the craft's, m.
    pub altitude_error_m: f64,
    /// This update's step relative to the waypoint's plane.
    pub plane: PlaneCrossing,
    /// Distance before a FLYBY at which the turn begins, m.
    pub turn_radius_m: f64,
    /// `ap_waypoint_arrival_radius`, m.
    pub arrival_radius_m: f64,
    /// `ap_waypoint_hold_radius`, m.
    pub hold_radius_m: f64,
    /// Time within the hold radius of a HOLD without getting nearer to its altitude, s.
    pub held_off_s: f64,
}

/// The facts of the progress monitors; `None` in [`Facts`] while they are paused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProgressFacts {
    /// Time since the distance last shrank, s.
    pub no_progress_s: f64,
    /// Distance now, m.
    pub distance_m: f64,
    /// Distance beyond which the craft is flying away, m.
    pub flyaway_m: f64,
}

/// Everything that a transition depends on, as plain numbers and flags.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facts {
    /// `true` if a 3-D fix is present.
    pub fix: bool,
    /// Number of waypoints in the active plan.
    pub count: u8,
    pub waypoint: WaypointFacts,
    pub fence: FenceFacts,
    pub approach: ApproachFacts,
    /// Altitude and the altitude to reach, m, while CLIMBING.
    pub climb: Option<(f64, f64)>,
    /// The progress monitors, unless paused.
    pub progress: Option<ProgressFacts>,
    /// `true` if the hold was commanded. Only a command ends it.
    pub held_by_command: bool,
    /// Time since HOLDING was entered, µs.
    pub hold_elapsed_us: u64,
    /// The conditions of a touchdown.
    pub touchdown: TouchdownGuards,
    /// Time that all of them have held, µs.
    pub touchdown_held_us: Option<u64>,
    /// Time that they must hold, ds.
    pub detection_time_ds: u8,
    /// Time without any motion although the craft is commanded to descend, s.
    pub stationary_s: f64,
}

impl Default for Facts {
    /// Returns facts with a fix, one FLYOVER, and nothing near.
    fn default() -> Self {
        Self {
            fix: true,
            count: 1,
            waypoint: WaypointFacts {
                kind: WaypointType::Flyover,
                pattern: HoldPattern::None,
                duration: Seconds::default(),
                last: true,
                co_located: false,
                missed: false,
            },
            fence: FenceFacts {
                limit_m: None,
                distance_m: None,
                state: NavState::Idle,
                source: PlanSource::Stored,
                action: FenceAction::Land,
            },
            approach: ApproachFacts {
                distance_m: 0.0,
                altitude_error_m: 0.0,
                plane: PlaneCrossing::NoLeg,
                turn_radius_m: 0.0,
                arrival_radius_m: 5.0,
                hold_radius_m: 2.0,
                held_off_s: 0.0,
            },
            climb: None,
            progress: None,
            held_by_command: false,
            hold_elapsed_us: 0,
            touchdown: TouchdownGuards::new(&TouchdownFacts::default(), &GroundFacts::CERTAIN),
            touchdown_held_us: None,
            detection_time_ds: 10,
            stationary_s: 0.0,
        }
    }
}

/// The decision of an update.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The mission is over: IDLE.
    Abort(AbortReason),
    /// A return home is given up: land here, with an injected plan.
    LandHere,
    /// Outside the fence: land here or return home, with an injected plan.
    Fence(FenceAction),
    /// The climb before the first leg is done. The state stays APPROACHING.
    Climbed,
    /// The craft passed the plane too far beside. The state stays APPROACHING, the waypoint becomes a stop.
    Missed,
    /// The craft has reached the waypoint.
    Arrive,
    /// Hold the position. The clock of the hold starts.
    Hold,
    Orbit,
    /// Start the figure of eight.
    Figure8,
    Land,
    /// Go on to the next positional waypoint.
    Next,
    /// The plan is complete.
    Complete,
    /// On the ground: COMPLETE and disarm.
    Touchdown,
}

impl Outcome {
    /// Returns the state that the outcome leads to.
    pub fn state(self) -> NavState {
        match self {
            Self::Abort(_) => NavState::Idle,
            Self::LandHere | Self::Fence(FenceAction::Land) | Self::Land => NavState::Landing,
            Self::Fence(FenceAction::Rth) | Self::Climbed | Self::Missed | Self::Next => {
                NavState::Approaching
            }
            Self::Arrive => NavState::Arrived,
            Self::Hold => NavState::Holding,
            Self::Orbit => NavState::Orbiting,
            Self::Figure8 => NavState::Figure8,
            Self::Complete | Self::Touchdown => NavState::Complete,
        }
    }
}

/// A way out of a state. It fires when all its guards hold, or at once if it has no guards.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// The conditions, in the order they are shown.
    pub guards: ArrayVec<Guard, 7>,
    pub outcome: Outcome,
    /// The cause that events report.
    pub reason: TransitionReason,
}

impl Rule {
    /// Returns the guard to report when the rule fires: for an arrival the one with the least margin, which became
    /// true last; otherwise the last one.
    fn fired(&self) -> Option<Guard> {
        let room = |guard: &&Guard| guard.margin() / guard.limit.abs().max(f64::MIN_POSITIVE);
        match self.reason {
            TransitionReason::Arrival => {
                self.guards.iter().min_by(|one, other| room(one).total_cmp(&room(other))).copied()
            }
            _ => self.guards.last().copied(),
        }
    }
}

/// The rules of a state for given facts, in the order in which they are tried.
pub type Rules = ArrayVec<Rule, 8>;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transition {
    pub outcome: Outcome,
    /// The guard that fired, if the rule had one.
    pub guard: Option<Guard>,
    pub reason: TransitionReason,
}

/// Returns the transition of an update in `state`, or `None` if nothing happens.
pub fn transition(state: NavState, facts: &Facts) -> Option<Transition> {
    rules(state, facts).iter().find(|rule| rule.guards.iter().all(Guard::holds)).map(|rule| Transition {
        outcome: rule.outcome,
        guard: rule.fired(),
        reason: rule.reason,
    })
}

/// Returns the guards to show for `state`: the conditions that it waits for, without the guards for fix and plan.
pub fn waiting_for(state: NavState, facts: &Facts) -> ArrayVec<Guard, 9> {
    rules(state, facts)
        .iter()
        .flat_map(|rule| rule.guards.iter().copied())
        .filter(|guard| !matches!(guard.name, GuardName::Fix | GuardName::Plan))
        .take(9)
        .collect()
}
