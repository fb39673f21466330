//! The current waypoint, with the way it is flown and everything that belongs to this one leg.

use nalgebra::Vector2;

use super::altitude_wait::AltitudeWait;
use super::descent::Descent;
use super::hold::Hold;
use super::observed::Observed;
use super::progress::ProgressMonitor;
use crate::autopilot::guidance::{
    CornerArc, L1Limits, L1Result, PlaneCrossing, l1, leg_speed_mps, plane_crossing,
};
use crate::autopilot::io::NavInputs;
use crate::autopilot::params::Params;
use crate::geo::{LatLon, local_offset};
use crate::math;
use crate::plan::{LegSpeed, Waypoint};
use crate::signals::SimTime;

/// The distance below which two waypoints count as one, m.
pub(super) const CO_LOCATED_M: f64 = 0.1;
/// The slowest speed of a DELAY, m/s.
const SLOWEST_MPS: f64 = 0.1;
/// The ground speed from which a course is known well enough for an arc, m/s.
const MOVING_MPS: f64 = 0.5;

/// The current waypoint, resolved to the position and the way it is flown.
#[derive(Debug, Clone, Default)]
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
    arc: Option<CornerArc>,
    /// `true` once it was reported that the thrust limits the tilt.
    pub reported_limited: bool,
    pub progress: ProgressMonitor,
    pub altitude_wait: AltitudeWait,
    pub hold: Hold,
    pub descent: Descent,
}

impl Leg {
    /// Returns a leg whose waypoint is the place of the craft.
    pub(super) fn here(now: &NavInputs) -> Self {
        let here = now.here();
        Self { waypoint: here, altitude_m: now.alt_m, start: here, ..Self::default() }
    }

    /// Returns the leg from `start` to a waypoint. A craft that is already behind the plane can reach the waypoint only
    /// by coming back.
    pub(super) fn to(waypoint: &Waypoint, start: LatLon, now: &NavInputs, params: &Params) -> Self {
        let position = if waypoint.kind.uses_position() { waypoint.position } else { now.here() };
        let (from, to) = (local_offset(now.origin, start), local_offset(now.origin, position));
        Self {
            waypoint: position,
            altitude_m: waypoint.altitude.above_home_m(),
            start,
            missed: plane_crossing(from, to, now.pos_ne, now.pos_ne) == PlaneCrossing::Behind,
            arc: corner_arc(to - now.pos_ne, now.vel_ne, params),
            ..Self::default()
        }
    }

    /// Forgets the hold, the landing, the progress and the wait.
    pub(super) fn clear_clocks(&mut self) {
        self.hold = Hold::default();
        self.descent = Descent::default();
        self.progress.pause();
        self.altitude_wait = AltitudeWait::default();
    }

    /// Starts the time of a DELAY.
    pub(super) fn set_delay(&mut self, modifier: &Waypoint, now: &NavInputs) {
        self.delay = (!modifier.duration.is_zero()).then(|| {
            let horizontal = (local_offset(now.origin, self.waypoint) - now.pos_ne).norm();
            let length = math::hypot(horizontal, self.altitude_m - now.alt_m);
            let speed = length / modifier.duration.get();
            let until = SimTime(now.time.0.saturating_add(modifier.duration.micros()));
            (speed.max(SLOWEST_MPS), until)
        });
    }

    /// Returns the maximum speed, m/s. `own` is the speed of the waypoint.
    pub(super) fn speed_mps(&self, own: LegSpeed, now: &NavInputs, params: &Params) -> f64 {
        let own = leg_speed_mps(own, params);
        match self.delay {
            Some((cap, until)) if now.time < until => own.min(cap),
            Some(_) | None => own,
        }
    }

    /// Returns the turn rate of the arc, rad/s, while one is flown.
    pub(super) fn arc_rps(&self) -> Option<f64> {
        self.arc.as_ref().map(CornerArc::turn_rate_rps)
    }

    /// Ends the arc, since no line is followed.
    pub(super) fn end_arc(&mut self) {
        self.arc = None;
    }

    /// Returns the aim on the line to `target`, or on the arc while one is flown, and the line behind it.
    pub(super) fn aim(&mut self, target: Vector2<f64>, seen: &Observed) -> (Vector2<f64>, L1Result) {
        let now = seen.now;
        let result = l1(seen.start_ne, target, now.pos_ne, now.vel_ne, &L1Limits::from_params(seen.params));
        if result.reanchor {
            self.start = now.here();
        }
        (self.arc_aim(&result, now), result)
    }

    fn arc_aim(&mut self, result: &L1Result, now: &NavInputs) -> Vector2<f64> {
        let Some(arc) = &mut self.arc else { return result.aim };
        let to_aim = result.aim - now.pos_ne;
        if !arc.advance(now.dt, math::atan2(to_aim.y, to_aim.x)) {
            self.arc = None;
            return result.aim;
        }
        let (sin, cos) = math::sin_cos(arc.bearing_rad);
        now.pos_ne + Vector2::new(cos, sin) * result.lookahead_m
    }
}

fn corner_arc(to_target: Vector2<f64>, velocity: Vector2<f64>, params: &Params) -> Option<CornerArc> {
    if velocity.norm() < MOVING_MPS || to_target.norm() < CO_LOCATED_M {
        return None;
    }
    let course = math::atan2(velocity.y, velocity.x);
    let leg = math::atan2(to_target.y, to_target.x);
    CornerArc::begin(course, leg, f64::from(params.l1_turn_rate).to_radians())
}
