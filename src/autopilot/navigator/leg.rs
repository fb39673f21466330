//! Advances in the plan: the next positional waypoint, the modifiers before it, the start of its leg.

use nalgebra::Vector2;

use super::Navigator;
use super::altitude_wait::AltitudeWait;
use super::descent::Descent;
use super::entry::here;
use super::hold::Hold;
use crate::autopilot::guidance::{CornerArc, PlaneCrossing, plane_crossing};
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::{LatLon, local_offset};
use crate::plan::{Modifier, Waypoint};
use crate::signals::SimTime;
use crate::telemetry::{Guard, NavState, TransitionReason};

/// The distance below which two waypoints count as one, m.
pub(super) const CO_LOCATED_M: f64 = 0.1;
/// The slowest speed of a DELAY, m/s.
const SLOWEST_MPS: f64 = 0.1;
/// The ground speed from which a course is known well enough for an arc, m/s.
const MOVING_MPS: f64 = 0.5;

/// The current waypoint, resolved to the position and the way it is flown.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Leg {
    /// Position of the waypoint. For a TAKEOFF, the place where it began.
    pub waypoint: LatLon,
    /// Altitude above home, m.
    pub altitude_m: f64,
    /// Start of the leg.
    pub start: LatLon,
    /// `true` if the craft must come back to the waypoint.
    pub missed: bool,
    /// Speed cap of a DELAY (m/s) and the time it ends.
    pub delay: Option<(f64, SimTime)>,
    /// The arc at the start of the leg.
    pub arc: Option<CornerArc>,
    /// `true` once it was reported that the thrust limits the lean.
    pub reported_limited: bool,
}

impl Navigator {
    pub(super) fn begin_first_leg(
        &mut self,
        index: u8,
        resumed: bool,
        reason: TransitionReason,
        inputs: &NavInputs,
        params: &Params,
    ) {
        self.begin_first_leg_with_guard(index, resumed, reason, None, inputs, params);
    }

    /// Begins the first leg of an engagement, from the craft. A resumed leg keeps its altitude change and the yaw cap
    /// of the plan before it. A delay is not repeated.
    pub(super) fn begin_first_leg_with_guard(
        &mut self,
        index: u8,
        resumed: bool,
        reason: TransitionReason,
        guard: Option<Guard>,
        inputs: &NavInputs,
        params: &Params,
    ) {
        let before = self.cursor.plan().waypoints.iter().take(usize::from(index));
        let run = before.rev().take_while(|waypoint| !waypoint.kind.is_positional()).count();
        // Both are below 30.
        let modifiers_from = index - run as u8;
        self.begin_leg(index, modifiers_from, here(inputs), reason, guard, inputs, params);
        if resumed {
            self.leg.delay = None;
            if let Some(cap) = self.cursor.yaw_rate_before(index) {
                self.yaw_cap_dps = yaw_cap(cap);
            }
        }
    }

    /// Starts the leg from `start` to waypoint `index` and applies the modifiers from `modifiers_from` on.
    #[expect(clippy::too_many_arguments, reason = "the leg, its cause and the two contexts of an update")]
    pub(super) fn begin_leg(
        &mut self,
        index: u8,
        modifiers_from: u8,
        start: LatLon,
        reason: TransitionReason,
        guard: Option<Guard>,
        inputs: &NavInputs,
        params: &Params,
    ) {
        let Some(waypoint) = self.cursor.waypoint(index) else { return };
        self.cursor.move_to(index);
        let position = if waypoint.kind.uses_position() { waypoint.position } else { here(inputs) };
        self.leg =
            Leg { waypoint: position, altitude_m: waypoint.altitude.above_home_m(), start, ..Leg::default() };
        self.clear_clocks();
        self.apply_modifiers(modifiers_from, index, inputs);
        let (from, to) = (local_offset(inputs.origin, start), local_offset(inputs.origin, position));
        // A craft that is already behind the plane can reach the waypoint only by coming back.
        self.leg.missed = plane_crossing(from, to, inputs.pos_ne, inputs.pos_ne) == PlaneCrossing::Behind;
        self.leg.arc = corner_arc(to - inputs.pos_ne, inputs.vel_ne, params);
        self.enter(NavState::Approaching, reason, guard);
    }

    /// Forgets the hold, the landing, the progress and the wait of the previous leg.
    pub(super) fn clear_clocks(&mut self) {
        self.hold = Hold::default();
        self.descent = Descent::default();
        self.progress.pause();
        self.altitude_wait = AltitudeWait::default();
    }

    fn apply_modifiers(&mut self, from: u8, to: u8, inputs: &NavInputs) {
        for at in from..to {
            let Some(modifier) = self.cursor.waypoint(at) else { return };
            match modifier.kind.modifier() {
                Some(Modifier::Altitude) => self.leg.altitude_m = modifier.altitude.above_home_m(),
                Some(Modifier::YawRate) => self.yaw_cap_dps = yaw_cap(&modifier),
                Some(Modifier::Delay) => self.leg.delay = self.delay(&modifier, inputs),
                None => {}
            }
        }
    }

    fn delay(&self, modifier: &Waypoint, inputs: &NavInputs) -> Option<(f64, SimTime)> {
        if modifier.duration.is_zero() {
            return None;
        }
        let horizontal = (local_offset(inputs.origin, self.leg.waypoint) - inputs.pos_ne).norm();
        let length = horizontal.hypot(self.leg.altitude_m - inputs.alt_m);
        let speed = length / modifier.duration.get();
        let until = SimTime(inputs.time.0.saturating_add(modifier.duration.micros()));
        Some((speed.max(SLOWEST_MPS), until))
    }
}

fn yaw_cap(modifier: &Waypoint) -> Option<f64> {
    (modifier.yaw_rate_dps > 0).then(|| f64::from(modifier.yaw_rate_dps))
}

fn corner_arc(to_target: Vector2<f64>, velocity: Vector2<f64>, params: &Params) -> Option<CornerArc> {
    if velocity.norm() < MOVING_MPS || to_target.norm() < CO_LOCATED_M {
        return None;
    }
    let course = velocity.y.atan2(velocity.x);
    let leg = to_target.y.atan2(to_target.x);
    CornerArc::begin(course, leg, f64::from(params.l1_turn_rate).to_radians())
}
