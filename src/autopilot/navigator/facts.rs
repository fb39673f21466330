//! Collects the facts of one update for the machine.

use super::Navigator;
use super::observed::Observed;
use super::progress::LegTurn;
use crate::autopilot::control::{AltitudeController, FlightControllers};
use crate::autopilot::fence::FenceFacts;
use crate::autopilot::guidance::{CornerArc, PlaneCrossing, plane_crossing, turn_radius_m};
use crate::autopilot::io::NavInputs;
use crate::autopilot::land_detector::{AT_REST_MPS, GroundFacts, TouchdownFacts, TouchdownGuards};
use crate::autopilot::machine::{ApproachFacts, Facts, WaypointFacts};
use crate::autopilot::params::Params;
use crate::plan::Approach;
use crate::telemetry::{NavEvent, NavState};

impl Navigator {
    /// Runs clocks and overlays before the decision.
    pub(super) fn prepare(
        &mut self,
        now: &NavInputs,
        params: &Params,
        seen: &Observed,
        speed_setpoint_mps: f64,
    ) {
        self.move_pattern(now, params);
        self.begin_climb(now, params, seen);
        self.watch_progress(now, params, seen, speed_setpoint_mps);
        self.wait_for_altitude(now, params, seen);
    }

    pub(super) fn facts(
        &self,
        now: &NavInputs,
        params: &Params,
        seen: &Observed,
        controllers: &FlightControllers,
    ) -> Facts {
        let waypoint = self.cursor.current().unwrap_or_default();
        let plane = self.previous.map_or(PlaneCrossing::NoLeg, |previous| {
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
            fence: self.fence_facts(params, seen),
            approach: ApproachFacts {
                distance_m: seen.distance_m,
                altitude_error_m: self.leg.altitude_m - now.alt_m,
                plane,
                turn_radius_m: turn_radius_m(seen.ground_speed_mps, params.max_lean_rad()),
                arrival_radius_m: params.arrival_radius_m(),
                hold_radius_m: params.hold_radius_m(),
                held_off_s: self.altitude_wait.held_off_s(now.time),
            },
            climb: self.climb.is_on().then(|| (now.alt_m, self.climb_goal_m(params))),
            progress: self.progress.facts(self.progress_distance_m(now, seen), now.time),
            held_by_command: self.hold.is_by_command(),
            hold_elapsed_us: self.hold.elapsed_us(now.time),
            touchdown: TouchdownGuards::new(
                &touchdown_facts(now, params, seen, &controllers.altitude),
                &GroundFacts::new(now, params, &controllers.altitude, &controllers.land),
            ),
            touchdown_held_us: controllers.land.held_us(),
            detection_time_ds: params.landing_detection_time,
            stationary_s: controllers.land.stationary_s(),
        }
    }

    pub(super) fn fence_facts(&self, params: &Params, seen: &Observed) -> FenceFacts {
        FenceFacts {
            limit_m: params.fence_m(),
            distance_m: seen.home_distance_m,
            state: self.state,
            source: self.cursor.source(),
            action: params.geofence_action,
        }
    }

    /// Returns the altitude at which the climb before the first leg is done, m.
    pub(super) fn climb_goal_m(&self, params: &Params) -> f64 {
        let rescue = self.rescue.map_or(f64::NEG_INFINITY, |rescue| rescue.altitude_m - 1.0);
        f64::from(params.min_nav_altitude_m).max(rescue)
    }

    fn begin_climb(&mut self, now: &NavInputs, params: &Params, seen: &Observed) {
        if self.state != NavState::Approaching || !self.climb.is_pending() {
            return;
        }
        let goal = self.climb_goal_m(params);
        if goal <= 0.0 || now.alt_m >= goal {
            self.finish_climb();
            return;
        }
        let stops_here = self.cursor.kind().stops() && seen.distance_m <= params.hold_radius_m();
        if !stops_here {
            self.climb.begin(now.pos_ne);
            self.push(NavEvent::Climbing(true));
        }
    }

    fn progress_distance_m(&self, now: &NavInputs, seen: &Observed) -> f64 {
        if self.cursor.kind().capability().approach == Approach::Climb {
            (self.leg.altitude_m - now.alt_m).abs()
        } else {
            seen.distance_m
        }
    }

    /// Watches a HOLD that waits for its altitude. A climb or descent on the spot is progress, too.
    fn wait_for_altitude(&mut self, now: &NavInputs, params: &Params, seen: &Observed) {
        let approaches = self.state == NavState::Approaching
            && self.cursor.kind().capability().approach == Approach::Level;
        let is_free = !seen.stick_override && !self.climb.is_on();
        let is_at_place = approaches && is_free && seen.distance_m <= params.hold_radius_m();
        let error_m = (self.leg.altitude_m - now.alt_m).abs();
        if self.altitude_wait.update(error_m, is_at_place, now.time) {
            self.progress.credit(now.time);
        }
    }

    /// Runs the monitors on a leg. They start again whenever the craft was not free to make progress.
    fn watch_progress(&mut self, now: &NavInputs, params: &Params, seen: &Observed, speed_setpoint_mps: f64) {
        let unwatched = self.rescue.is_some_and(|rescue| !rescue.is_watched);
        let free = self.state == NavState::Approaching && !seen.stick_override && !self.climb.is_on();
        if !free || unwatched {
            self.progress.pause();
        } else {
            let turn = LegTurn {
                ground_speed_mps: seen.ground_speed_mps,
                speed_mps: seen.ground_speed_mps.max(speed_setpoint_mps),
                max_lean_rad: params.max_lean_rad(),
                arc_rps: self.leg.arc.as_ref().map(CornerArc::turn_rate_rps),
            };
            self.progress.update(self.progress_distance_m(now, seen), &turn, now.time);
        }
    }
}

fn touchdown_facts(
    now: &NavInputs,
    params: &Params,
    seen: &Observed,
    altitude: &AltitudeController,
) -> TouchdownFacts {
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
