//! The waypoint state machine: facts → guards → one outcome. Pure; the navigator carries the outcome out.
//!
//! ```text
//!  engage ──► APPROACHING ──arrival──► ARRIVED ─┬─ FLYOVER, FLYBY, TAKEOFF ──► next APPROACHING, or COMPLETE
//!                 ▲   (CLIMBING overlay)        ├─ HOLD ──► HOLDING ─┬─ time ──► next, or COMPLETE
//!                 │                             │                    └─► ORBITING / FIGURE8 ── time ──► next, or COMPLETE
//!                 └──── next ◄──────────────────┴─ LAND ──► (HOLDING) ──► LANDING ── touchdown ──► COMPLETE, disarm
//!  any state: no fix, plan cleared ──► IDLE        outside the fence ──► LANDING here, or APPROACHING home
//! ```

mod rules;
mod table;

use arrayvec::ArrayVec;

use super::fence::FenceFacts;
use super::guidance::PlaneCrossing;
use super::land_detector::{GroundFacts, TouchdownFacts, TouchdownGuards};
use crate::plan::{HoldPattern, WaypointType};
use crate::telemetry::{AbortReason, FenceAction, Guard, GuardName, NavState, PlanSource, TransitionReason};

pub use rules::rules;
pub use table::transition_table;

/// Time without progress after which a mission is given up, s.
pub const STALL_S: f64 = 30.0;

/// Time at the place of a HOLD without getting nearer to its altitude after which the hold begins all the same, s.
pub const HELD_OFF_S: f64 = 10.0;

/// Least altitude error at which a HOLD begins at once, m; the hold radius where that is greater.
const HOLD_ALTITUDE_M: f64 = 2.0;

/// The current waypoint and its place in the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaypointFacts {
    pub kind: WaypointType,
    pub pattern: HoldPattern,
    /// Hold time, ds.
    pub duration_ds: u16,
    /// No positional waypoint follows.
    pub last: bool,
    /// The next positional waypoint lies less than 10 cm away.
    pub co_located: bool,
    /// The craft passed its plane too far beside; it must come back to the point.
    pub missed: bool,
}

/// How the craft lies to the waypoint.
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

/// What the progress monitors know; `None` in [`Facts`] while they are paused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProgressFacts {
    /// Time since the distance last shrank, s.
    pub no_progress_s: f64,
    /// Distance now, m.
    pub distance_m: f64,
    /// Distance beyond which the craft is flying away, m.
    pub flyaway_m: f64,
}

/// Everything a transition depends on, as plain numbers and flags.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facts {
    /// Whether a 3-D fix is present.
    pub fix: bool,
    /// Waypoints in the active plan.
    pub count: u8,
    pub waypoint: WaypointFacts,
    pub fence: FenceFacts,
    /// The approach to the waypoint.
    pub approach: ApproachFacts,
    /// While CLIMBING: altitude and the altitude to reach, m.
    pub climb: Option<(f64, f64)>,
    /// The progress monitors, unless paused.
    pub progress: Option<ProgressFacts>,
    /// The hold was commanded: only a command ends it.
    pub held_by_command: bool,
    /// Time since HOLDING was entered, µs.
    pub hold_elapsed_us: u64,
    /// The conditions of a touchdown.
    pub touchdown: TouchdownGuards,
    /// Time all of them have held, µs.
    pub touchdown_held_us: Option<u64>,
    /// Time they must hold, ds.
    pub detection_time_ds: u8,
    /// Time without any motion although the craft is commanded to descend, s.
    pub stationary_s: f64,
}

impl Default for Facts {
    /// A fix, one FLYOVER, nothing near.
    fn default() -> Self {
        Self {
            fix: true,
            count: 1,
            waypoint: WaypointFacts {
                kind: WaypointType::Flyover,
                pattern: HoldPattern::None,
                duration_ds: 0,
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

/// What an update decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The mission is over: IDLE.
    Abort(AbortReason),
    /// A return home is given up: land here, on an injected plan.
    LandHere,
    /// Outside the fence: land here or return home, on an injected plan.
    Fence(FenceAction),
    /// The climb before the first leg is done; stays APPROACHING.
    Climbed,
    /// The plane was passed too far beside; stays APPROACHING, the waypoint becomes a stop.
    Missed,
    /// The waypoint is reached.
    Arrive,
    /// Keep station; the clock of the hold starts.
    Hold,
    Orbit,
    /// Start the figure of eight.
    Figure8,
    Land,
    /// On to the next positional waypoint.
    Next,
    /// The plan is flown.
    Complete,
    /// On the ground: COMPLETE and disarm.
    Touchdown,
}

impl Outcome {
    /// The state it leads to.
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

    /// What happens besides, in a few words; empty when nothing does.
    pub fn effect(self) -> &'static str {
        match self {
            Self::Abort(AbortReason::GpsLost) => "mission off, reason GPS_LOST",
            Self::Abort(AbortReason::NoPlan) => "mission off, reason NO_PLAN",
            Self::Abort(AbortReason::Stalled) => "mission off until the switch is cycled, reason STALLED",
            Self::Abort(AbortReason::Flyaway) => "mission off until the switch is cycled, reason FLYAWAY",
            Self::LandHere | Self::Fence(FenceAction::Land) => "active plan: LAND here",
            Self::Fence(FenceAction::Rth) => "active plan: FLYOVER home, LAND home",
            Self::Climbed => "climb over, the leg starts here",
            Self::Missed => "the waypoint becomes a stop",
            Self::Hold => "the hold clock starts",
            Self::Orbit | Self::Figure8 => "phase 0, centre = waypoint",
            Self::Land => "descent from the altitude now",
            Self::Next => "advance to the next positional waypoint",
            Self::Complete => "target and altitude held",
            Self::Touchdown => "disarm, reason LANDING",
            Self::Arrive => "",
        }
    }
}

/// A way out of a state: fires when all its guards hold (at once when it has none).
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// The conditions, in the order they are shown.
    pub guards: ArrayVec<Guard, 7>,
    pub outcome: Outcome,
    /// The cause, for events.
    pub reason: TransitionReason,
}

impl Rule {
    /// The guard to report when the rule fires: of an arrival the one with the least room, which became true last; else
    /// the last one.
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

/// The rules of a state for given facts, in the order they are tried.
pub type Rules = ArrayVec<Rule, 8>;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transition {
    pub outcome: Outcome,
    /// The guard that fired, if the rule had one.
    pub guard: Option<Guard>,
    pub reason: TransitionReason,
}

/// Decides what an update in `state` leads to; `None` = nothing happens.
pub fn transition(state: NavState, facts: &Facts) -> Option<Transition> {
    rules(state, facts).iter().find(|rule| rule.guards.iter().all(Guard::holds)).map(|rule| Transition {
        outcome: rule.outcome,
        guard: rule.fired(),
        reason: rule.reason,
    })
}

/// The guards to show for `state`: what it waits for, without those that only say that fix and plan are there.
pub fn waiting_for(state: NavState, facts: &Facts) -> ArrayVec<Guard, 9> {
    rules(state, facts)
        .iter()
        .flat_map(|rule| rule.guards.iter().copied())
        .filter(|guard| !matches!(guard.name, GuardName::Fix | GuardName::Plan))
        .take(9)
        .collect()
}
