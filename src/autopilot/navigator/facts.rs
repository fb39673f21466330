//! What the machine decides on: facts of one update.

use super::{Navigator, Progress};
use crate::autopilot::fence::FenceFacts;
use crate::autopilot::guidance::{PlaneCrossing, plane_crossing, turn_radius_m};
use crate::autopilot::io::NavInputs;
use crate::autopilot::machine::{
    ApproachFacts, Facts, GroundFacts, ProgressFacts, TouchdownFacts, TouchdownGuards, WaypointFacts,
};
use crate::autopilot::params::Params;
use crate::geo::local_offset;
use crate::plan::WaypointType;
use crate::telemetry::NavState;

/// How much nearer counts as progress, m.
const PROGRESS_M: f64 = 2.0;
/// How far the setpoint may be under the craft without counting as pressing on the ground, m.
const PRESSING_M: f64 = 1.5;
/// Most that the throttle must be below the learned hover throttle for a touchdown, µs.
const BELOW_HOVER_US: f64 = 50.0;

impl Navigator {
    /// Clocks and overlays that run before the decision.
    pub(super) fn prepare(&mut self, now: &NavInputs, params: &Params) {
        self.stick_override = super::fly::beyond_deadband(now, params);
        self.move_pattern(now, params);
        self.update_climb(now, params);
        self.update_progress(now);
        if let Some(landing) = self.landing.as_mut().filter(|_| self.state == NavState::Landing) {
            landing.highest_m = landing.highest_m.max(now.alt_m);
        }
    }

    pub(super) fn facts(&self, now: &NavInputs, params: &Params) -> Facts {
        let waypoint = self.record(self.index).unwrap_or_default();
        let target = local_offset(now.origin, self.leg.waypoint);
        let start = local_offset(now.origin, self.leg.start);
        let plane = self
            .previous
            .map_or(PlaneCrossing::NoLeg, |previous| plane_crossing(start, target, previous, now.pos_ne));
        let climbing = self.climb.at.is_some();
        Facts {
            fix: now.fix,
            // A plan holds at most 30.
            count: self.active.waypoints.len() as u8,
            waypoint: WaypointFacts {
                kind: waypoint.kind,
                pattern: waypoint.pattern,
                duration_ds: waypoint.duration_ds,
                last: self.following().is_none(),
                co_located: self.co_located(),
                missed: self.leg.missed,
            },
            fence: self.fence_facts(now, params),
            approach: ApproachFacts {
                distance_m: (target - now.pos_ne).norm(),
                altitude_error_m: self.leg.altitude_m - now.alt_m,
                plane,
                turn_radius_m: turn_radius_m(now.vel_ne.norm(), params.max_lean_rad()),
                arrival_radius_m: params.arrival_radius_m(),
                hold_radius_m: params.hold_radius_m(),
            },
            climb: climbing.then(|| (now.alt_m, self.climb_goal_m(params))),
            progress: self.progress.map(|progress| ProgressFacts {
                no_progress_s: now.time.seconds_since(progress.improved_at),
                distance_m: self.progress_distance(now),
                flyaway_m: progress.best_m + (0.25 * progress.leg_m).clamp(20.0, 100.0),
            }),
            hold_elapsed_us: self.hold_elapsed_us(now),
            touchdown: TouchdownGuards::new(
                &self.touchdown_facts(now, params),
                &self.ground_facts(now, params),
            ),
            touchdown_held_us: self.touchdown_held_us,
            detection_time_ds: params.landing_detection_time,
        }
    }

    pub(super) fn fence_facts(&self, now: &NavInputs, params: &Params) -> FenceFacts {
        FenceFacts {
            limit_m: params.fence_m(),
            distance_m: now.home.map(|home| (local_offset(now.origin, home) - now.pos_ne).norm()),
            state: self.state,
            source: self.source,
            action: params.geofence_action,
        }
    }

    pub(super) fn hold_elapsed_us(&self, now: &NavInputs) -> u64 {
        now.time.0.saturating_sub(self.hold_start.0)
    }

    /// Altitude at which the climb before the first leg is done, m.
    pub(super) fn climb_goal_m(&self, params: &Params) -> f64 {
        let rescue = self.rescue.map_or(f64::NEG_INFINITY, |rescue| rescue.altitude_m - 1.0);
        f64::from(params.min_nav_altitude_m).max(rescue)
    }

    fn update_climb(&mut self, now: &NavInputs, params: &Params) {
        if self.state != NavState::Approaching || self.climb.done || self.climb.at.is_some() {
            return;
        }
        let goal = self.climb_goal_m(params);
        if goal <= 0.0 || now.alt_m >= goal {
            self.climb.done = true;
            return;
        }
        let kind = self.record(self.index).unwrap_or_default().kind;
        let stops_here = match kind {
            WaypointType::Hold | WaypointType::Land | WaypointType::Takeoff => {
                let offset = local_offset(now.origin, self.leg.waypoint) - now.pos_ne;
                offset.norm() <= params.hold_radius_m()
            }
            WaypointType::Flyover
            | WaypointType::Flyby
            | WaypointType::AltChange
            | WaypointType::Delay
            | WaypointType::YawRate => false,
        };
        if !stops_here {
            self.climb.at = Some(now.pos_ne);
            self.push(crate::telemetry::NavEvent::Climbing(true));
        }
    }

    fn progress_distance(&self, now: &NavInputs) -> f64 {
        let kind = self.record(self.index).unwrap_or_default().kind;
        if kind == WaypointType::Takeoff {
            (self.leg.altitude_m - now.alt_m).abs()
        } else {
            (local_offset(now.origin, self.leg.waypoint) - now.pos_ne).norm()
        }
    }

    /// The monitors run on a leg, and begin anew whenever the craft was not free to make progress.
    fn update_progress(&mut self, now: &NavInputs) {
        let unwatched = self.rescue.is_some_and(|rescue| !rescue.is_watched);
        let free = self.state == NavState::Approaching && !self.stick_override && self.climb.at.is_none();
        if !free || unwatched {
            self.progress = None;
            return;
        }
        let distance = self.progress_distance(now);
        let progress = self.progress.get_or_insert(Progress {
            best_m: distance,
            leg_m: distance,
            improved_m: distance,
            improved_at: now.time,
        });
        progress.best_m = progress.best_m.min(distance);
        if distance <= progress.improved_m - PROGRESS_M {
            progress.improved_m = distance;
            progress.improved_at = now.time;
        }
    }

    fn touchdown_facts(&self, now: &NavInputs, params: &Params) -> TouchdownFacts {
        TouchdownFacts::new(
            params,
            self.altitude.reference_hover_us(params),
            now.alt_m,
            now.vel_ne.norm(),
            self.altitude.throttle_us(),
            now.climb_mps,
        )
    }

    fn ground_facts(&self, now: &NavInputs, params: &Params) -> GroundFacts {
        let pressing = now.alt_m - self.altitude.setpoint_m() - PRESSING_M;
        let drop = self.landing.map_or(0.0, |landing| landing.highest_m - now.alt_m);
        GroundFacts {
            descent_m: drop.max(pressing),
            below_hover_us: self.altitude.hover_us() - self.altitude.throttle_us(),
            needed_us: (0.5 * f64::from(params.landing_throttle_threshold)).min(BELOW_HOVER_US),
        }
    }

    /// Runs the touchdown timer on the conditions of this update.
    pub(super) fn time_touchdown(&mut self, facts: &mut Facts, now: &NavInputs) {
        if self.state == NavState::Landing && self.landing.is_some() {
            self.touchdown_held_us = self.touchdown.update(now.time, facts.touchdown.all_hold());
        }
        facts.touchdown_held_us = self.touchdown_held_us;
    }
}
