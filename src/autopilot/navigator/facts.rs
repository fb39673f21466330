//! Runs the clocks and monitors of the task before the decision, and collects the facts for it.

use nalgebra::Vector2;

use super::hold::Pattern;
use super::observed::Observed;
use super::progress::LegTurn;
use super::task::Task;
use crate::autopilot::control::{AltitudeController, FlightControllers};
use crate::autopilot::fence::FenceFacts;
use crate::autopilot::guidance::{PlaneCrossing, plane_crossing, turn_radius_m};
use crate::autopilot::land_detector::{AT_REST_MPS, GroundFacts, TouchdownFacts, TouchdownGuards};
use crate::autopilot::machine::{ApproachFacts, Facts, WaypointFacts};
use crate::plan::Approach;
use crate::telemetry::NavState;

impl Task {
    /// Runs clocks and overlays before the decision. Returns `true` if the climb before the first leg began.
    pub(super) fn prepare(&mut self, state: NavState, seen: &Observed, speed_setpoint_mps: f64) -> bool {
        if let Some(pattern) = Pattern::of(state) {
            let rate = pattern.rate_rps(self.speed_mps(seen.now, seen.params), seen.params);
            self.leg.hold.advance_pattern(rate * seen.now.dt, pattern.period_rad());
        }
        let climbs = self.begin_climb(state, seen);
        self.watch_progress(state, seen, speed_setpoint_mps);
        self.wait_for_altitude(state, seen);
        climbs
    }

    /// Collects the facts. `previous` is the position at the previous update.
    pub(super) fn facts(
        &self,
        state: NavState,
        previous: Option<Vector2<f64>>,
        seen: &Observed,
        controllers: &FlightControllers,
    ) -> Facts {
        let (now, params) = (seen.now, seen.params);
        let waypoint = self.cursor.current().unwrap_or_default();
        let plane = previous.map_or(PlaneCrossing::NoLeg, |previous| {
            plane_crossing(seen.start_ne, seen.waypoint_ne, previous, now.pos_ne)
        });
        Facts {
            fix: now.fix,
            count: self.cursor.count(),
            waypoint: WaypointFacts {
                kind: waypoint.kind,
                pattern: waypoint.pattern,
                duration: waypoint.duration,
                last: seen.is_last,
                co_located: seen.is_co_located,
                missed: self.leg.missed,
            },
            fence: self.fence_facts(state, seen),
            approach: ApproachFacts {
                distance_m: seen.distance_m,
                altitude_error_m: self.leg.altitude_m - now.alt_m,
                plane,
                turn_radius_m: turn_radius_m(seen.ground_speed_mps, params.max_tilt_rad()),
                arrival_radius_m: params.arrival_radius_m(),
                hold_radius_m: params.hold_radius_m(),
                held_off_s: self.leg.altitude_wait.held_off_s(now.time),
            },
            climb: self.climb.is_on().then(|| (now.alt_m, self.climb_goal_m(params))),
            progress: self.leg.progress.facts(self.progress_distance_m(seen), now.time),
            held_by_command: self.leg.hold.by_command,
            hold_elapsed_us: self.leg.hold.elapsed_us(now.time),
            touchdown: TouchdownGuards::new(
                &touchdown_facts(seen, &controllers.altitude),
                &GroundFacts::new(now, params, &controllers.altitude, &controllers.land),
            ),
            touchdown_held_us: controllers.land.held_us(),
            detection_time_ds: params.landing_detection_time,
            stationary_s: controllers.land.stationary_s(),
        }
    }

    pub(super) fn fence_facts(&self, state: NavState, seen: &Observed) -> FenceFacts {
        FenceFacts {
            limit_m: seen.params.fence_m(),
            distance_m: seen.home_distance_m,
            state,
            source: self.cursor.source(),
            action: seen.params.geofence_action,
        }
    }

    fn begin_climb(&mut self, state: NavState, seen: &Observed) -> bool {
        if state != NavState::Approaching || !self.climb.is_pending() {
            return false;
        }
        let goal = self.climb_goal_m(seen.params);
        if goal <= 0.0 || seen.now.alt_m >= goal {
            self.climb.finish();
            return false;
        }
        let stops_here = self.cursor.kind().stops() && seen.distance_m <= seen.params.hold_radius_m();
        if !stops_here {
            self.climb.begin(seen.now.pos_ne);
        }
        !stops_here
    }

    fn progress_distance_m(&self, seen: &Observed) -> f64 {
        if self.cursor.kind().capability().approach == Approach::Climb {
            (self.leg.altitude_m - seen.now.alt_m).abs()
        } else {
            seen.distance_m
        }
    }

    /// Watches a HOLD that waits for its altitude. A climb or descent on the spot is progress, too.
    fn wait_for_altitude(&mut self, state: NavState, seen: &Observed) {
        let approaches =
            state == NavState::Approaching && self.cursor.kind().capability().approach == Approach::Level;
        let is_free = !seen.stick_override && !self.climb.is_on();
        let is_at_place = approaches && is_free && seen.distance_m <= seen.params.hold_radius_m();
        let error_m = (self.leg.altitude_m - seen.now.alt_m).abs();
        if self.leg.altitude_wait.update(error_m, is_at_place, seen.now.time) {
            self.leg.progress.credit(seen.now.time);
        }
    }

    /// Runs the monitors on a leg. They start again whenever the craft was not free to make progress.
    fn watch_progress(&mut self, state: NavState, seen: &Observed, speed_setpoint_mps: f64) {
        let unwatched = self.rescue.is_some_and(|rescue| !rescue.is_watched);
        let free = state == NavState::Approaching && !seen.stick_override && !self.climb.is_on();
        if !free || unwatched {
            self.leg.progress.pause();
        } else {
            let turn = LegTurn {
                ground_speed_mps: seen.ground_speed_mps,
                speed_mps: seen.ground_speed_mps.max(speed_setpoint_mps),
                max_tilt_rad: seen.params.max_tilt_rad(),
                arc_rps: self.leg.arc_rps(),
            };
            self.leg.progress.update(self.progress_distance_m(seen), &turn, seen.now.time);
        }
    }
}

fn touchdown_facts(seen: &Observed, altitude: &AltitudeController) -> TouchdownFacts {
    let (now, params) = (seen.now, seen.params);
    let facts = TouchdownFacts::new(
        params,
        altitude.reference_hover_us(params),
        now.alt_m,
        seen.ground_speed_mps,
        altitude.throttle_us(),
        now.climb_mps,
    );
    TouchdownFacts { min_climb_mps: facts.min_climb_mps.max(-AT_REST_MPS), ..facts }
}
