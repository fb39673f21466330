//! Target and aim of a leg, a hold, a pattern and a landing.

use nalgebra::Vector2;

use super::Navigator;
use super::observed::Observed;
use crate::autopilot::control::{PositionLaw, PositionTarget};
use crate::autopilot::guidance::{
    L1Limits, L1Result, PatternPoint, Spiral, figure8, l1, leg_speed_mps, orbit, pattern_rate_rps,
    spiral_offset,
};
use crate::autopilot::io::NavInputs;
use crate::autopilot::land_detector::LandDetector;
use crate::autopilot::params::Params;
use crate::telemetry::{L1Mode, NavState};

/// Below this altitude, m, a landing moves sideways no faster than this, m/s. A jump of the fix just above the ground
/// would tip the craft over.
/// tip the craft over.
const LOW_M: f64 = 2.0;
const LOW_MPS: f64 = 0.5;

/// The aim of an update and the way it was chosen.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PathView {
    /// The aim, north and east, m.
    pub aim_ne: Vector2<f64>,
    /// Mode in which it was chosen.
    pub l1_mode: L1Mode,
    /// Cross-track error, m.
    pub xte_m: Option<f64>,
    /// Distance along the leg, m.
    pub along_m: Option<f64>,
    /// Effective lookahead, m.
    pub lookahead_m: Option<f64>,
    /// Lateral acceleration of the L1 law, m/s².
    pub a_lat_mps2: Option<f64>,
}

impl Navigator {
    /// Returns the maximum speed on this leg, m/s.
    pub(super) fn leg_speed(&self, now: &NavInputs, params: &Params) -> f64 {
        let own = leg_speed_mps(self.cursor.current().unwrap_or_default().speed, params);
        match self.leg.delay {
            Some((cap, until)) if now.time < until => own.min(cap),
            Some(_) | None => own,
        }
    }

    /// Returns target and aim of the state.
    pub(super) fn horizontal_target(
        &mut self,
        now: &NavInputs,
        params: &Params,
        seen: &Observed,
        land: &mut LandDetector,
    ) -> (PositionTarget, PathView) {
        let speed_mps = self.leg_speed(now, params);
        let mut target = PositionTarget { speed_mps, ..PositionTarget::stay(seen.waypoint_ne, params) };
        let mut path = PathView::default();
        match self.state {
            NavState::Idle | NavState::Complete => {
                target.target = self.target_ne;
                target.aim = self.target_ne;
            }
            NavState::Approaching | NavState::Arrived => {
                target.law = PositionLaw::Speed;
                path = self.leg_target(&mut target, now, params, seen);
            }
            NavState::Holding => {}
            NavState::Orbiting | NavState::Figure8 => {
                let point = self.pattern_point(params);
                let rate = self.pattern_rate(now, params);
                target.target += point.offset;
                target.target_velocity = point.tangent * rate;
                target.target_accel = point.curvature * (rate * rate);
                target.aim = target.target;
            }
            NavState::Landing => {
                let elapsed_s = self.descent.advance(now, params, self.leg.altitude_m, self.rescue, land);
                if let Some(spiral) = Spiral::from_params(params) {
                    target.target += spiral_offset(&spiral, elapsed_s, now.alt_m);
                    target.aim = target.target;
                }
                if now.alt_m < LOW_M {
                    // The direct law does not limit the speed.
                    target.law = PositionLaw::Speed;
                    target.speed_mps = target.speed_mps.min(LOW_MPS);
                }
            }
        }
        self.target_ne = target.target;
        path.aim_ne = target.aim;
        (target, path)
    }

    /// Returns target and aim on a leg: straight to the waypoint, or along the line to it.
    fn leg_target(
        &mut self,
        target: &mut PositionTarget,
        now: &NavInputs,
        params: &Params,
        seen: &Observed,
    ) -> PathView {
        if let Some(at) = self.climb.place() {
            target.target = at;
            target.aim = at;
            return PathView::default();
        }
        let passes = self.cursor.kind().passes();
        target.pass_through = passes && !seen.is_last && !self.leg.missed && !seen.is_co_located;
        if !params.l1_enable || self.cursor.positional_count() < 2 {
            self.leg.arc = None;
            return PathView::default();
        }
        let result = l1(seen.start_ne, target.target, now.pos_ne, now.vel_ne, &L1Limits::from_params(params));
        if result.reanchor {
            self.leg.start = super::entry::here(now);
        }
        target.aim = self.arc_aim(&result, now);
        PathView {
            aim_ne: target.aim,
            l1_mode: result.mode,
            xte_m: Some(result.xte_m),
            along_m: Some(result.along_m),
            lookahead_m: Some(result.effective_lookahead_m),
            a_lat_mps2: Some(result.a_lat_mps2),
        }
    }

    /// Returns the aim of the line, or of the arc while one is flown.
    fn arc_aim(&mut self, result: &L1Result, now: &NavInputs) -> Vector2<f64> {
        let Some(arc) = &mut self.leg.arc else { return result.aim };
        let to_aim = result.aim - now.pos_ne;
        if !arc.advance(now.dt, to_aim.y.atan2(to_aim.x)) {
            self.leg.arc = None;
            return result.aim;
        }
        let (sin, cos) = arc.bearing_rad.sin_cos();
        now.pos_ne + Vector2::new(cos, sin) * result.lookahead_m
    }

    /// Returns the radius of the circles of the pattern, m.
    pub(super) fn pattern_radius_m(&self, params: &Params) -> f64 {
        if self.state == NavState::Figure8 {
            f64::from(params.hold_figure8_width) / 200.0
        } else {
            f64::from(params.hold_orbit_radius) / 100.0
        }
    }

    fn pattern_rate(&self, now: &NavInputs, params: &Params) -> f64 {
        pattern_rate_rps(self.pattern_radius_m(params), self.leg_speed(now, params), params)
    }

    fn pattern_point(&self, params: &Params) -> PatternPoint {
        let radius = self.pattern_radius_m(params);
        if self.state == NavState::Figure8 {
            figure8(2.0 * radius, self.hold.phase_rad())
        } else {
            orbit(radius, self.hold.phase_rad())
        }
    }

    /// Advances the pattern. This happens before any decision.
    pub(super) fn move_pattern(&mut self, now: &NavInputs, params: &Params) {
        let period = match self.state {
            NavState::Orbiting => std::f64::consts::TAU,
            NavState::Figure8 => 2.0 * std::f64::consts::TAU,
            NavState::Idle
            | NavState::Approaching
            | NavState::Arrived
            | NavState::Holding
            | NavState::Landing
            | NavState::Complete => return,
        };
        let step = self.pattern_rate(now, params) * now.dt;
        self.hold.advance_pattern(step, period);
    }
}
