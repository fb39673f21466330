//! Compares the reports of the firmware with the truth, each waypoint by its own rule.
//!
//! The check follows the active plan by the navigator's events and measures the true place of the craft against that
//! of the waypoint in the world's projection. Manual flight does not count, and neither do waypoints that were left
//! by a command or a return home. For a waypoint that is flown again the last run counts.

mod approach;
mod craft;
mod hold;
mod pattern;
mod run;
mod settle;
mod verdict;

use nalgebra::Vector2;

pub(super) use craft::CraftTruth;
use pattern::Pattern;
use run::{Run, Target};

use crate::geo::{LatLon, LocalFrame};
use crate::plan::{FlightPlan, MAX_WAYPOINTS};
use crate::telemetry::snapshot::SettingsView;
use crate::telemetry::{FlightTruth, Guard, NavEvent, NavState, PlanSource, TransitionReason, WaypointTruth};

/// The slowest leg speed that a waypoint can set, m/s.
const SLOWEST_MPS: f64 = 1.0;

/// The comparison, tick by tick.
#[derive(Debug, Clone)]
pub(super) struct TruthCheck {
    tolerance_m: f64,
    source: PlanSource,
    active: FlightPlan,
    stored: FlightPlan,
    run: Option<Run>,
    ended: Vec<WaypointTruth>,
}

impl TruthCheck {
    /// Returns a check that allows `tolerance_m` beyond a waypoint's own radius.
    pub(super) fn new(tolerance_m: f64) -> Self {
        Self {
            tolerance_m,
            source: PlanSource::Stored,
            active: FlightPlan::default(),
            stored: FlightPlan::default(),
            run: None,
            ended: Vec::with_capacity(MAX_WAYPOINTS),
        }
    }

    /// Takes the measurements of a tick.
    pub(super) fn look(&mut self, craft: &CraftTruth) {
        if let Some(run) = &mut self.run {
            run.look(craft);
        }
    }

    /// Follows the navigator. `frame` places the waypoints in the world.
    pub(super) fn follow(
        &mut self,
        event: &NavEvent,
        craft: &CraftTruth,
        settings: &SettingsView,
        frame: &LocalFrame,
    ) {
        match event {
            NavEvent::Plan { source, plan } => self.begin_plan(*source, plan),
            NavEvent::State { to, wp, kind, reason, guard, target, target_alt_m, .. } => {
                // A remote firmware can fly a plan that it does not show, such as that of a rescue.
                let Some(kind) = *kind else {
                    self.run = None;
                    return;
                };
                let position = self.planned_place(*wp).unwrap_or(*target);
                let ne = if kind.uses_position() { place(frame, position) } else { craft.ne };
                let target = Target {
                    source: self.source,
                    wp: *wp,
                    kind,
                    ne,
                    alt_m: *target_alt_m,
                    speed_mps: self.leg_speed_mps(*wp, settings),
                };
                let leg = Run::leg(target, *settings, self.tolerance_m);
                self.enter(*to, *reason, guard.as_ref(), leg, craft, settings);
            }
            NavEvent::Climbing(_)
            | NavEvent::Limited { .. }
            | NavEvent::Geofence { .. }
            | NavEvent::CannotHold { .. }
            | NavEvent::Refused(_)
            | NavEvent::Disarm => {}
        }
    }

    /// Returns the truth of the flight, including a hold in progress.
    pub(super) fn truth(&self, craft: &CraftTruth, battery_used_pct: Option<f64>) -> FlightTruth {
        let under_way = self.run.as_ref().and_then(Run::hold_truth);
        FlightTruth {
            waypoints: self.ended.iter().copied().chain(under_way).collect(),
            parked: self.run.as_ref().and_then(|run| run.parked(craft)),
            battery_used_pct,
        }
    }

    /// Returns the worst miss beyond the permitted distance, as half a sentence.
    pub(super) fn worst_miss(&self, truth: &FlightTruth) -> Option<String> {
        verdict::worst_miss(truth, self.tolerance_m)
    }

    fn begin_plan(&mut self, source: PlanSource, plan: &FlightPlan) {
        let goes_on = source == PlanSource::Stored && *plan == self.stored;
        if !goes_on {
            // Of injected plans the last one counts, of stored ones the present one.
            let same_kind = |of: PlanSource| (of == PlanSource::Stored) == (source == PlanSource::Stored);
            self.ended.retain(|ended| !same_kind(ended.source));
        }
        if source == PlanSource::Stored {
            self.stored.clone_from(plan);
        }
        self.source = source;
        self.active.clone_from(plan);
    }

    /// Enters a state. `leg` is the waypoint that is flown from now on, on its way.
    fn enter(
        &mut self,
        to: NavState,
        reason: TransitionReason,
        guard: Option<&Guard>,
        leg: Run,
        craft: &CraftTruth,
        settings: &SettingsView,
    ) {
        let over =
            matches!(reason, TransitionReason::Advance | TransitionReason::HoldTime | TransitionReason::Land);
        if over && let Some(truth) = self.run.as_mut().and_then(Run::end_hold) {
            self.keep(truth);
        }
        match to {
            NavState::Idle => self.run = None,
            NavState::Approaching => {
                self.forget(leg.source(), leg.wp());
                self.run = Some(leg);
            }
            NavState::Arrived => {
                if let Some(truth) = self.run.as_ref().and_then(|run| run.arrive(craft, reason, guard)) {
                    self.keep(truth);
                }
            }
            // A waypoint that was left by a command does not count.
            NavState::Holding if reason == TransitionReason::HoldHere => self.run = None,
            NavState::Holding => self.hold(Pattern::Point, craft),
            NavState::Orbiting => self.hold(Pattern::Orbit(settings.orbit_radius_m), craft),
            NavState::Figure8 => self.hold(Pattern::Figure8(settings.figure8_width_m / 2.0), craft),
            NavState::Landing => {
                let same = matches!(reason, TransitionReason::Land | TransitionReason::HoldTime);
                let mut run = self.run.take().filter(|_| same).unwrap_or(leg);
                run.land(craft);
                self.run = Some(run);
            }
            NavState::Complete if reason == TransitionReason::Touchdown => {
                if let Some(truth) = self.run.take().and_then(|mut run| run.touch_down(craft)) {
                    self.keep(truth);
                }
            }
            NavState::Complete => {
                let mut run = self.run.take().unwrap_or(leg);
                run.park(craft);
                self.run = Some(run);
            }
        }
    }

    fn hold(&mut self, pattern: Pattern, craft: &CraftTruth) {
        if let Some(run) = &mut self.run {
            run.hold(pattern, craft);
        }
    }

    fn keep(&mut self, truth: WaypointTruth) {
        self.forget(truth.source, truth.wp);
        self.ended.push(truth);
    }

    fn forget(&mut self, source: PlanSource, wp: u8) {
        self.ended.retain(|ended| (ended.source, ended.wp) != (source, wp));
    }

    /// Returns the place of a waypoint in the stored plan while that is flown. The navigator's own target differs
    /// from it after a loss of the fix in a landing.
    fn planned_place(&self, wp: u8) -> Option<LatLon> {
        let waypoint = self.active.waypoints.get(usize::from(wp))?;
        (self.source == PlanSource::Stored).then_some(waypoint.position)
    }

    fn leg_speed_mps(&self, wp: u8, settings: &SettingsView) -> f64 {
        let asked = self.active.waypoints.get(usize::from(wp)).and_then(|waypoint| waypoint.speed.own_mps());
        let most = settings.max_velocity_mps.max(SLOWEST_MPS);
        asked.map_or(most, |mps| mps.clamp(SLOWEST_MPS, most))
    }
}

/// Returns the text for a mission that agrees with the truth.
pub(super) fn agreement(truth: &FlightTruth) -> Option<String> {
    verdict::agreement(truth)
}

/// Returns a place north and east of the boot place in the world's projection, m.
pub(super) fn place(frame: &LocalFrame, position: LatLon) -> Vector2<f64> {
    let enu = frame.to_enu(position.lat_deg(), position.lon_deg(), frame.alt_amsl_m);
    Vector2::new(enu.y, enu.x)
}

#[cfg(test)]
mod tests;
