//! One waypoint while it is flown: the measurements in each state, by its own rule.

use nalgebra::Vector2;

use super::approach::ClosestApproach;
use super::craft::CraftTruth;
use super::hold::{HoldLimits, HoldWatch};
use super::pattern::Pattern;
use crate::plan::{Approach, WaypointType};
use crate::signals::SimTime;
use crate::telemetry::snapshot::SettingsView;
use crate::telemetry::{Guard, ParkedTruth, PlanSource, TransitionReason, WaypointTruth};

/// The waypoint and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Target {
    pub(super) source: PlanSource,
    pub(super) wp: u8,
    pub(super) kind: WaypointType,
    /// North and east of the boot place in the world's projection, m; for a TAKEOFF the place of the craft.
    pub(super) ne: Vector2<f64>,
    /// Altitude of the leg, m above home.
    pub(super) alt_m: f64,
    /// Speed of the leg, m/s.
    pub(super) speed_mps: f64,
}

/// The waypoint that is flown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run {
    target: Target,
    settings: SettingsView,
    tolerance_m: f64,
    stage: Stage,
    /// Largest distance in the wait before a landing, m.
    waited_max_m: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    Leg(ClosestApproach),
    /// Hold with its time running.
    Hold(HoldWatch),
    /// Descent. The way to the place of the landing is watched like a hold.
    Landing(HoldWatch),
    /// Parked after the last waypoint.
    Parked(HoldWatch),
}

impl Run {
    /// Returns the run of a leg that begins now.
    pub(super) fn leg(target: Target, settings: SettingsView, tolerance_m: f64) -> Self {
        let stage = Stage::Leg(ClosestApproach::default());
        Self { target, settings, tolerance_m, stage, waited_max_m: None }
    }

    /// Returns the plan that the waypoint belongs to.
    pub(super) fn source(&self) -> PlanSource {
        self.target.source
    }

    /// Returns the index in that plan.
    pub(super) fn wp(&self) -> u8 {
        self.target.wp
    }

    pub(super) fn look(&mut self, craft: &CraftTruth) {
        let Target { ne, alt_m, .. } = self.target;
        match &mut self.stage {
            Stage::Leg(closest) => closest.look(craft, ne),
            Stage::Hold(watch) | Stage::Landing(watch) | Stage::Parked(watch) => watch.look(craft, ne, alt_m),
        }
    }

    /// Reports that the waypoint is reached. Returns the truth of a FLYOVER, FLYBY or TAKEOFF, or `None` if it is
    /// measured later or the pilot flew.
    pub(super) fn arrive(
        &self,
        craft: &CraftTruth,
        reason: TransitionReason,
        guard: Option<&Guard>,
    ) -> Option<WaypointTruth> {
        let Stage::Leg(closest) = self.stage else { return None };
        if craft.stick_override {
            return None;
        }
        let alt_error_m = Some(craft.alt_m - self.target.alt_m);
        match self.target.kind.capability().approach {
            Approach::Pass | Approach::Turn => {
                let (distance_m, at) = closest.get()?;
                let turn = match (self.target.kind, guard) {
                    (_, Some(guard)) => (reason == TransitionReason::TurnRadius).then_some(guard.limit),
                    // A remote firmware does not report where it began the turn, so the latest point for this speed
                    // counts.
                    (WaypointType::Flyby, None) => Some(self.settings.turn_radius_m(craft.speed_mps)),
                    (_, None) => None,
                };
                let (miss_m, radius_m) = match turn {
                    Some(turn_radius_m) => ((distance_m - turn_radius_m).max(0.0), 0.0),
                    None => (distance_m, self.settings.arrival_radius_m),
                };
                Some(WaypointTruth { alt_error_m, radius_m, ..self.truth(miss_m, at) })
            }
            Approach::Climb => {
                let distance_m = (craft.ne - self.target.ne).norm();
                Some(WaypointTruth { alt_error_m, ..self.truth(distance_m, craft.time) })
            }
            Approach::Level | Approach::Stop | Approach::Modify(_) => None,
        }
    }

    /// Begins a hold on its pattern.
    pub(super) fn hold(&mut self, pattern: Pattern, craft: &CraftTruth) {
        self.stage = Stage::Hold(self.watch(pattern, craft));
    }

    /// Returns the truth of the hold that is over. The wait of a LAND only begins its landing, so it gives no truth
    /// yet.
    pub(super) fn end_hold(&mut self) -> Option<WaypointTruth> {
        let truth = self.hold_truth()?;
        if self.target.kind == WaypointType::Land {
            self.waited_max_m = truth.hold_max_m;
            return None;
        }
        Some(truth)
    }

    /// Returns the truth of the hold in progress.
    pub(super) fn hold_truth(&self) -> Option<WaypointTruth> {
        let Stage::Hold(watch) = self.stage else { return None };
        let (miss_m, at) = watch.worst()?;
        let alt_error_m = watch.worst_alt_m();
        Some(WaypointTruth { hold_max_m: Some(miss_m), alt_error_m, ..self.truth(miss_m, at) })
    }

    /// Begins the descent of a LAND.
    pub(super) fn land(&mut self, craft: &CraftTruth) {
        self.stage = Stage::Landing(self.watch(Pattern::Point, craft));
    }

    /// Returns the truth of the touchdown, or `None` if the pilot flew or has just flown.
    pub(super) fn touch_down(&mut self, craft: &CraftTruth) -> Option<WaypointTruth> {
        let Stage::Landing(watch) = &mut self.stage else { return None };
        let miss_m = watch.error_m(craft, self.target.ne)?;
        Some(WaypointTruth { hold_max_m: self.waited_max_m, ..self.truth(miss_m, craft.time) })
    }

    /// Parks the craft from now on: on the pattern that was held, else at the waypoint.
    pub(super) fn park(&mut self, craft: &CraftTruth) {
        let watch = match self.stage {
            Stage::Hold(watch) | Stage::Parked(watch) => watch,
            Stage::Leg(_) | Stage::Landing(_) => self.watch(Pattern::Point, craft),
        };
        self.stage = Stage::Parked(watch);
    }

    /// Returns the present truth of the parked craft.
    pub(super) fn parked(&self, craft: &CraftTruth) -> Option<ParkedTruth> {
        let Stage::Parked(mut watch) = self.stage else { return None };
        let Target { wp, kind, ne, alt_m, .. } = self.target;
        Some(ParkedTruth {
            wp,
            kind,
            distance_m: watch.error_m(craft, ne),
            alt_error_m: craft.alt_m - alt_m,
            speed_mps: craft.speed_mps,
            radius_m: match kind {
                WaypointType::Flyover | WaypointType::Flyby => self.settings.arrival_radius_m,
                _ => self.settings.hold_radius_m,
            },
        })
    }

    fn watch(&self, pattern: Pattern, craft: &CraftTruth) -> HoldWatch {
        let limits = HoldLimits {
            small_m: self.settings.hold_radius_m,
            // Half of it, since a craft at the edge of the tolerance is still on its way.
            small_alt_m: 0.5 * self.tolerance_m,
            speed_mps: self.target.speed_mps,
            climb_mps: self.settings.climb_mps,
        };
        HoldWatch::begin(pattern, limits, craft.time, craft.alt_m - self.target.alt_m)
    }

    /// Returns a truth with the hold radius, without altitude and hold.
    fn truth(&self, miss_m: f64, at: SimTime) -> WaypointTruth {
        let Target { source, wp, kind, .. } = self.target;
        let radius_m = self.settings.hold_radius_m;
        WaypointTruth { source, wp, kind, miss_m, alt_error_m: None, hold_max_m: None, radius_m, at }
    }
}
