//! The progress monitors: detect a craft that gets no nearer, or flies away.

use crate::autopilot::machine::{ProgressFacts, STALL_S};
use crate::geo::GRAVITY;
use crate::math;
use crate::signals::SimTime;

/// The decrease of the distance that counts as progress, m.
const PROGRESS_M: f64 = 2.0;
/// The distance that the craft may be farther than its best, as a share of the leg, and its limits, m.
const FLYAWAY_SHARE: f64 = 0.25;
const FLYAWAY_LEAST_M: f64 = 20.0;
const FLYAWAY_MOST_M: f64 = 100.0;
/// The time until a craft that flew past its waypoint tilts against its speed, s.
const TILT_DELAY_S: f64 = 1.0;

/// The turn at the start of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LegTurn {
    /// Ground speed, m/s.
    pub ground_speed_mps: f64,
    /// Ground speed, or the speed setpoint while that is greater, m/s. The speed has to decrease first.
    pub speed_mps: f64,
    /// Maximum tilt, rad.
    pub max_tilt_rad: f64,
    /// Turn rate of the corner arc, rad/s, while one is flown.
    pub arc_rps: Option<f64>,
}

impl LegTurn {
    /// Returns the distance that the craft may be carried away from the waypoint before it has turned, m: its
    /// stopping distance plus the diameter of the arc.
    fn overshoot_m(&self) -> f64 {
        self.stop_m(self.speed_mps) + self.arc_rps.map_or(0.0, |rate| 2.0 * self.speed_mps / rate)
    }

    /// Returns the stopping distance of a craft at this speed that brakes at the maximum tilt, m.
    fn stop_m(&self, speed_mps: f64) -> f64 {
        math::powi(speed_mps, 2) / (2.0 * GRAVITY * math::tan(self.max_tilt_rad).max(0.1))
    }
}

/// The distances of this leg, m.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Progress {
    began: SimTime,
    leg_m: f64,
    best_m: f64,
    /// Distance that the speed at the best point carries the craft past a near waypoint.
    carry_m: f64,
    /// Distance and time at which progress was last seen.
    mark_m: f64,
    marked_at: SimTime,
    /// Distance that the turn explains.
    overshoot_m: f64,
    on_arc: bool,
}

impl Progress {
    fn begin(distance_m: f64, turn: &LegTurn, time: SimTime) -> Self {
        Self {
            began: time,
            leg_m: distance_m,
            best_m: distance_m,
            carry_m: 0.0,
            mark_m: distance_m,
            marked_at: time,
            overshoot_m: turn.overshoot_m(),
            on_arc: turn.arc_rps.is_some(),
        }
    }

    /// Returns `true` while the turn is not over: the arc is still flown, or the craft has not come nearer yet.
    fn is_turning(&self, time: SimTime) -> bool {
        let has_improved = self.best_m <= self.leg_m - PROGRESS_M;
        self.on_arc || !has_improved && time.seconds_since(self.began) <= STALL_S
    }

    fn update(&mut self, distance_m: f64, turn: &LegTurn, time: SimTime) {
        if distance_m < self.best_m {
            self.best_m = distance_m;
            self.carry_m = turn.ground_speed_mps * TILT_DELAY_S + turn.stop_m(turn.ground_speed_mps);
        }
        if self.on_arc {
            // The craft accelerates on the arc.
            self.overshoot_m = self.overshoot_m.max(turn.overshoot_m());
            self.marked_at = time;
        }
        if self.is_turning(time) {
            // Coming back from the overshoot of the turn is progress, too.
            self.mark_m = self.mark_m.max(distance_m);
        }
        if distance_m <= self.mark_m - PROGRESS_M {
            self.mark_m = distance_m;
            self.marked_at = time;
        }
    }
}

/// The monitors, with their state for one leg.
#[derive(Debug, Clone, Default)]
pub(super) struct ProgressMonitor(Option<Progress>);

impl ProgressMonitor {
    /// Pauses the monitors because the craft is not free to make progress, or has another task. They start again
    /// afterwards.
    pub(super) fn pause(&mut self) {
        self.0 = None;
    }

    /// Takes the distance to the waypoint, m. No progress is required on an arc; the leg is measured from its end.
    pub(super) fn update(&mut self, distance_m: f64, turn: &LegTurn, time: SimTime) {
        if self.0.is_some_and(|progress| progress.on_arc && turn.arc_rps.is_none()) {
            self.0 = None;
        }
        self.0.get_or_insert_with(|| Progress::begin(distance_m, turn, time)).update(distance_m, turn, time);
    }

    /// Reports progress of another kind than towards the waypoint.
    pub(super) fn credit(&mut self, time: SimTime) {
        if let Some(progress) = &mut self.0 {
            progress.marked_at = time;
        }
    }

    /// Returns the facts for the machine, or `None` while paused.
    pub(super) fn facts(&self, distance_m: f64, time: SimTime) -> Option<ProgressFacts> {
        self.0.map(|progress| {
            let margin = (FLYAWAY_SHARE * progress.leg_m).clamp(FLYAWAY_LEAST_M, FLYAWAY_MOST_M);
            let turn = if progress.is_turning(time) { progress.overshoot_m } else { progress.carry_m };
            ProgressFacts {
                no_progress_s: time.seconds_since(progress.marked_at),
                distance_m,
                flyaway_m: progress.best_m + margin + turn,
            }
        })
    }
}
