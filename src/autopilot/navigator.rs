//! The navigator: keeps the active plan and the state, asks the machine what to do, and flies it.
//!
//! One update, in this order: facts (fix, plan, fence, distances, progress, hold and touchdown clocks) → at most one
//! transition → target and aim of the state → position, altitude and yaw control → demands. While nothing is flown it
//! only watches, so that wind and hover throttle are known when it takes over.

mod entry;
mod facts;
mod fly;
mod leg;
mod report;
mod transit;

use arrayvec::ArrayVec;
use nalgebra::Vector2;

use super::control::{AltitudeController, PositionController, YawController};
use super::guidance::CornerArc;
use super::io::NavInputs;
use super::machine::TouchdownTimer;
use super::params::Params;
use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::signals::SimTime;
use crate::telemetry::{AbortReason, NavEvent, NavOutput, NavState, NavTelemetry, PlanSource, Refusal};

pub use entry::Rescue;

/// Most events between two drains; more are dropped, the state itself never is.
pub const EVENT_CAPACITY: usize = 16;

/// The current waypoint, resolved: where and how it is flown.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Leg {
    /// Position of the waypoint; of a TAKEOFF the place where it began.
    waypoint: LatLon,
    /// Altitude above home, m.
    altitude_m: f64,
    /// Where the leg began.
    start: LatLon,
    /// The waypoint must be come back to.
    missed: bool,
    /// Speed cap of a DELAY (m/s) and the time it ends.
    delay: Option<(f64, SimTime)>,
    /// The arc at the start of the leg.
    arc: Option<CornerArc>,
}

/// The climb on the spot before the first leg.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Climb {
    /// Never again in this engagement.
    done: bool,
    /// Where it holds while it climbs (north, east, m).
    at: Option<Vector2<f64>>,
}

/// Memory of the progress monitors on this leg.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Progress {
    best_m: f64,
    leg_m: f64,
    improved_m: f64,
    improved_at: SimTime,
}

/// A landing under way.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Landing {
    began: SimTime,
    /// Highest altitude of this landing, m.
    highest_m: f64,
    /// Start of the part at the present rate.
    rate_since: SimTime,
    rate_start_m: f64,
    rate_mps: f64,
    /// When it was first too fast over ground for the last metres.
    fast_since: Option<SimTime>,
    /// Climb rate without the jolts of the legs, m/s.
    climb_mps: f64,
    /// Throttle taken off to feel for the ground, µs.
    felt_us: f64,
}

/// A mission that was begun since arming and may be resumed.
#[derive(Debug, Clone, PartialEq)]
struct Mission {
    /// The stored plan as it was.
    plan: FlightPlan,
    /// The waypoint to resume at.
    index: u8,
}

/// The navigator; see the module's description.
#[derive(Debug, Clone)]
pub struct Navigator {
    state: NavState,
    source: PlanSource,
    active: FlightPlan,
    index: u8,
    next_index: u8,
    leg: Leg,
    climb: Climb,
    progress: Option<Progress>,
    hold_start: SimTime,
    pattern_angle: f64,
    landing: Option<Landing>,
    touchdown: TouchdownTimer,
    touchdown_held_us: Option<u64>,
    /// Yaw rate cap of a YAW_RATE waypoint, deg/s.
    yaw_cap_dps: Option<f64>,
    rescue: Option<Rescue>,
    mission: Option<Mission>,
    /// Waypoint the next mission begins at.
    start_at: Option<u8>,
    aborted: Option<AbortReason>,
    /// The fix was lost in flight; it must be back for a while.
    gps_lost: bool,
    fix_since: Option<SimTime>,
    /// Touched down and disarmed; the state reads COMPLETE until the next arming.
    landed: bool,
    was_armed: bool,
    previous: Option<Vector2<f64>>,
    target_ne: Vector2<f64>,
    target_alt_m: f64,
    stick_override: bool,
    last_good: Option<NavInputs>,
    altitude: AltitudeController,
    position: PositionController,
    yaw: YawController,
    refused: Option<Refusal>,
    telemetry: NavTelemetry,
    events: ArrayVec<NavEvent, EVENT_CAPACITY>,
}

impl Default for Navigator {
    fn default() -> Self {
        Self::new()
    }
}

impl Navigator {
    /// A navigator that flies nothing.
    #[must_use]
    pub fn new() -> Self {
        Self {
            state: NavState::Idle,
            source: PlanSource::Stored,
            active: FlightPlan::default(),
            index: 0,
            next_index: 0,
            leg: Leg::default(),
            climb: Climb::default(),
            progress: None,
            hold_start: SimTime::ZERO,
            pattern_angle: 0.0,
            landing: None,
            touchdown: TouchdownTimer::default(),
            touchdown_held_us: None,
            yaw_cap_dps: None,
            rescue: None,
            mission: None,
            start_at: None,
            aborted: None,
            gps_lost: false,
            fix_since: None,
            landed: false,
            was_armed: false,
            previous: None,
            target_ne: Vector2::zeros(),
            target_alt_m: 0.0,
            stick_override: false,
            last_good: None,
            altitude: AltitudeController::default(),
            position: PositionController::default(),
            yaw: YawController::default(),
            refused: None,
            telemetry: NavTelemetry::default(),
            events: ArrayVec::new(),
        }
    }

    /// State of the machine.
    #[must_use]
    pub fn state(&self) -> NavState {
        self.state
    }

    /// Whether a mission, a return home or a landing is being flown (COMPLETE in the air counts).
    #[must_use]
    pub fn is_flying(&self) -> bool {
        self.state != NavState::Idle && !self.landed
    }

    /// The plan being flown; empty while nothing is flown.
    #[must_use]
    pub fn active_plan(&self) -> &FlightPlan {
        &self.active
    }

    /// Where the active plan came from.
    #[must_use]
    pub fn source(&self) -> PlanSource {
        self.source
    }

    /// Index of the current waypoint in the active plan.
    #[must_use]
    pub fn index(&self) -> u8 {
        self.index
    }

    /// State of the last update for displays, logs and samples.
    #[must_use]
    pub fn telemetry(&self) -> &NavTelemetry {
        &self.telemetry
    }

    /// The hover throttle in use, µs.
    #[must_use]
    pub fn hover_us(&self) -> f64 {
        self.altitude.hover_us()
    }

    /// Takes the events since the last call, oldest first.
    pub fn drain_events(&mut self) -> arrayvec::Drain<'_, NavEvent, EVENT_CAPACITY> {
        self.events.drain(..)
    }

    /// One update (100 Hz): at most one transition, then the demands. `stored` is the plan in the craft's memory; only
    /// its clearing matters here.
    pub fn update(&mut self, inputs: &NavInputs, params: &Params, stored: &FlightPlan) -> NavOutput {
        let now = self.sane(inputs);
        self.follow_arming(&now);
        self.follow_fix(&now);
        if self.is_flying() {
            if self.source == PlanSource::Stored && stored.waypoints.is_empty() {
                self.active.waypoints.clear();
            }
            self.prepare(&now, params);
            let mut facts = self.facts(&now, params);
            self.time_touchdown(&mut facts, &now);
            self.step(&facts, &now, params);
        } else {
            self.watch(&now, params);
            self.keep_inside(&now, params);
        }
        let output = if self.is_flying() { self.fly(&now, params) } else { NavOutput::default() };
        self.previous = Some(now.pos_ne);
        self.report(&now, params, output);
        output
    }

    /// The inputs with every number finite: what is not keeps its last value, and a broken position is no fix.
    fn sane(&mut self, inputs: &NavInputs) -> NavInputs {
        let mut now = inputs.clone();
        now.dt = if now.dt.is_finite() { now.dt.clamp(0.0, 0.1) } else { 0.01 };
        let position_ok = now.pos_ne.iter().chain(now.vel_ne.iter()).all(|value| value.is_finite());
        now.fix &= position_ok;
        let last = self.last_good.as_ref();
        if !position_ok {
            now.pos_ne = last.map_or_else(Vector2::zeros, |last| last.pos_ne);
            now.vel_ne = Vector2::zeros();
        }
        let keep = |value: &mut f64, old: fn(&NavInputs) -> f64, otherwise: f64| {
            if !value.is_finite() {
                *value = last.map_or(otherwise, old);
            }
        };
        keep(&mut now.alt_m, |last| last.alt_m, 0.0);
        keep(&mut now.climb_mps, |_| 0.0, 0.0);
        keep(&mut now.heading_rad, |last| last.heading_rad, 0.0);
        keep(&mut now.yaw_rate_rps, |_| 0.0, 0.0);
        keep(&mut now.roll_rad, |_| 0.0, 0.0);
        keep(&mut now.pitch_rad, |_| 0.0, 0.0);
        keep(&mut now.cos_tilt, |_| 1.0, 1.0);
        keep(&mut now.throttle_us, |last| last.throttle_us, 1000.0);
        keep(&mut now.stick_roll, |_| 0.0, 0.0);
        keep(&mut now.stick_pitch, |_| 0.0, 0.0);
        keep(&mut now.stick_yaw, |_| 0.0, 0.0);
        now.accel_ne = now.accel_ne.map(|value| if value.is_finite() { value } else { 0.0 });
        self.last_good = Some(now.clone());
        now
    }

    fn follow_arming(&mut self, now: &NavInputs) {
        if self.was_armed && !now.armed {
            self.on_disarm();
        }
        if !self.was_armed && now.armed {
            self.landed = false;
            if self.state == NavState::Complete {
                self.state = NavState::Idle;
            }
        }
        self.was_armed = now.armed;
    }

    fn follow_fix(&mut self, now: &NavInputs) {
        self.fix_since = if now.fix { self.fix_since.or(Some(now.time)) } else { None };
    }
}
