//! Target and aim of a leg, a hold, a pattern and a landing.

use nalgebra::Vector2;

use super::hold::Pattern;
use super::leg::Leg;
use super::observed::Observed;
use super::task::Task;
use crate::autopilot::control::{PositionLaw, PositionTarget};
use crate::autopilot::guidance::{Spiral, spiral_offset};
use crate::autopilot::land_detector::LandDetector;
use crate::telemetry::{L1Mode, NavState};

/// Below this altitude, m, a landing moves sideways no faster than this, m/s. A jump of the fix just above the ground
/// would tip the craft over.
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

impl Task {
    /// Returns target and aim of the state. `kept_ne` is the place that a craft without a leg keeps.
    pub(super) fn horizontal_target(
        &mut self,
        state: NavState,
        kept_ne: Vector2<f64>,
        seen: &Observed,
        land: &mut LandDetector,
    ) -> (PositionTarget, PathView) {
        let (now, params) = (seen.now, seen.params);
        let speed_mps = self.speed_mps(now, params);
        let mut target = PositionTarget { speed_mps, ..PositionTarget::stay(seen.waypoint_ne, params) };
        let mut path = PathView::default();
        match state {
            NavState::Idle | NavState::Complete => {
                target.target = kept_ne;
                target.aim = kept_ne;
            }
            NavState::Approaching | NavState::Arrived => {
                target.law = PositionLaw::Speed;
                path = self.leg_target(&mut target, seen);
            }
            NavState::Holding | NavState::Orbiting | NavState::Figure8 => {
                if let Some(pattern) = Pattern::of(state) {
                    let point = pattern.point(self.leg.hold.phase_rad, params);
                    let rate = pattern.rate_rps(speed_mps, params);
                    target.target += point.offset;
                    target.target_velocity = point.tangent * rate;
                    target.target_accel = point.curvature * (rate * rate);
                    target.aim = target.target;
                }
            }
            NavState::Landing => {
                let Leg { descent, altitude_m, .. } = &mut self.leg;
                let elapsed_s = descent.advance(now, params, *altitude_m, self.rescue, land);
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
        path.aim_ne = target.aim;
        (target, path)
    }

    /// Returns target and aim on a leg: straight to the waypoint, or along the line to it.
    fn leg_target(&mut self, target: &mut PositionTarget, seen: &Observed) -> PathView {
        if let Some(at) = self.climb.at {
            target.target = at;
            target.aim = at;
            return PathView::default();
        }
        let passes = self.cursor.kind().passes();
        target.pass_through = passes && !seen.is_last && !self.leg.missed && !seen.is_co_located;
        if !seen.params.l1_enable || self.cursor.positional_count() < 2 {
            self.leg.end_arc();
            return PathView::default();
        }
        let (aim, line) = self.leg.aim(target.target, seen);
        target.aim = aim;
        PathView {
            aim_ne: aim,
            l1_mode: line.mode,
            xte_m: Some(line.xte_m),
            along_m: Some(line.along_m),
            lookahead_m: Some(line.effective_lookahead_m),
            a_lat_mps2: Some(line.a_lat_mps2),
        }
    }
}
