//! One waypoint while it is flown: what is measured of it in each state, by its own rule.

use nalgebra::Vector2;

use super::approach::ClosestApproach;
use super::craft::CraftTruth;
use super::hold::{HoldLimits, HoldWatch};
use super::pattern::Pattern;
use crate::plan::WaypointType;
use crate::signals::SimTime;
use crate::telemetry::snapshot::SettingsView;
use crate::telemetry::{Guard, ParkedTruth, PlanSource, TransitionReason, WaypointTruth};

/// Which waypoint it is and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Target {
    pub(super) source: PlanSource,
    pub(super) wp: u8,
    pub(super) kind: WaypointType,
    /// North and east of the boot place in the world's projection, m; of a TAKEOFF where the craft was.
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
    /// Greatest distance in the wait before a landing, m.
    waited_max_m: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    Leg(ClosestApproach),
    /// The time of a hold runs.
    Hold(HoldWatch),
    /// Coming down: the way to the place of the landing is watched like a hold.
    Landing(HoldWatch),
    /// Parked after the last waypoint.
    Parked(HoldWatch),
}

impl Run {
    /// A leg that begins now.
    pub(super) fn leg(target: Target, settings: SettingsView, tolerance_m: f64) -> Self {
        let stage = Stage::Leg(ClosestApproach::default());
        Self { target, settings, tolerance_m, stage, waited_max_m: None }
    }

    /// The plan it belongs to.
    pub(super) fn source(&self) -> PlanSource {
        self.target.source
    }

    /// Index in that plan.
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

    /// The waypoint counts as reached: what truth says of a FLYOVER, FLYBY or TAKEOFF. `None` when it is measured later, or
    /// when the pilot flew.
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
        match self.target.kind {
            WaypointType::Flyover | WaypointType::Flyby => {
                let (distance_m, at) = closest.get()?;
                let turn = match (self.target.kind, guard) {
                    (_, Some(guard)) => (reason == TransitionReason::TurnRadius).then_some(guard.limit),
                    // A remote firmware does not tell where it began the turn: as late as the speed allowed.
                    (WaypointType::Flyby, None) => Some(self.settings.turn_radius_m(craft.speed_mps)),
                    (_, None) => None,
                };
                let (miss_m, radius_m) = match turn {
                    Some(turn_radius_m) => ((distance_m - turn_radius_m).max(0.0), 0.0),
                    None => (distance_m, self.settings.arrival_radius_m),
                };
                Some(WaypointTruth { alt_error_m, radius_m, ..self.truth(miss_m, at) })
            }
            WaypointType::Takeoff => {
                let distance_m = (craft.ne - self.target.ne).norm();
                Some(WaypointTruth { alt_error_m, ..self.truth(distance_m, craft.time) })
            }
            WaypointType::Hold
            | WaypointType::Land
            | WaypointType::AltChange
            | WaypointType::Delay
            | WaypointType::YawRate => None,
        }
    }

    /// A hold begins, on its pattern.
    pub(super) fn hold(&mut self, pattern: Pattern, craft: &CraftTruth) {
        self.stage = Stage::Hold(self.watch(pattern, craft));
    }

    /// What truth says of the hold that is over; of the wait of a LAND, which only begins its landing, nothing yet.
    pub(super) fn end_hold(&mut self) -> Option<WaypointTruth> {
        let truth = self.hold_truth()?;
        if self.target.kind == WaypointType::Land {
            self.waited_max_m = truth.hold_max_m;
            return None;
        }
        Some(truth)
    }

    /// What truth says of the hold under way.
    pub(super) fn hold_truth(&self) -> Option<WaypointTruth> {
        let Stage::Hold(watch) = self.stage else { return None };
        let (miss_m, at) = watch.worst()?;
        let alt_error_m = watch.worst_alt_m();
        Some(WaypointTruth { hold_max_m: Some(miss_m), alt_error_m, ..self.truth(miss_m, at) })
    }

    /// The descent of a LAND begins.
    pub(super) fn land(&mut self, craft: &CraftTruth) {
        self.stage = Stage::Landing(self.watch(Pattern::Point, craft));
    }

    /// The touchdown; `None` when the pilot flew, or just had.
    pub(super) fn touch_down(&mut self, craft: &CraftTruth) -> Option<WaypointTruth> {
        let Stage::Landing(watch) = &mut self.stage else { return None };
        let miss_m = watch.error_m(craft, self.target.ne)?;
        Some(WaypointTruth { hold_max_m: self.waited_max_m, ..self.truth(miss_m, craft.time) })
    }

    /// Parked from now on: on the pattern that was held, else at the waypoint.
    pub(super) fn park(&mut self, craft: &CraftTruth) {
        let watch = match self.stage {
            Stage::Hold(watch) | Stage::Parked(watch) => watch,
            Stage::Leg(_) | Stage::Landing(_) => self.watch(Pattern::Point, craft),
        };
        self.stage = Stage::Parked(watch);
    }

    /// The parked craft, as it is now.
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
            // Half of it: a craft at the edge of the tolerance is still on its way.
            small_alt_m: 0.5 * self.tolerance_m,
            speed_mps: self.target.speed_mps,
            climb_mps: self.settings.climb_mps,
        };
        HoldWatch::begin(pattern, limits, craft.time, craft.alt_m - self.target.alt_m)
    }

    /// A truth with the hold radius, without altitude and hold.
    fn truth(&self, miss_m: f64, at: SimTime) -> WaypointTruth {
        let Target { source, wp, kind, .. } = self.target;
        let radius_m = self.settings.hold_radius_m;
        WaypointTruth { source, wp, kind, miss_m, alt_error_m: None, hold_max_m: None, radius_m, at }
    }
}
