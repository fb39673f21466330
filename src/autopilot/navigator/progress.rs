//! The progress monitors: a craft that gets no nearer, or flies away.

use crate::autopilot::machine::ProgressFacts;
use crate::signals::SimTime;

/// How much nearer counts as progress, m.
const PROGRESS_M: f64 = 2.0;
/// Share of the leg that the craft may be farther than at its best, and its limits, m.
const FLYAWAY_SHARE: f64 = 0.25;
const FLYAWAY_LEAST_M: f64 = 20.0;
const FLYAWAY_MOST_M: f64 = 100.0;

/// Distances of this leg.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Progress {
    best_m: f64,
    leg_m: f64,
    improved_m: f64,
    improved_at: SimTime,
}

/// The monitors with their memory of a leg.
#[derive(Debug, Clone, Default)]
pub(super) struct ProgressMonitor(Option<Progress>);

impl ProgressMonitor {
    /// The craft is not free to make progress: the monitors begin anew.
    pub(super) fn pause(&mut self) {
        self.0 = None;
    }

    /// Takes the distance to the waypoint, m.
    pub(super) fn update(&mut self, distance_m: f64, time: SimTime) {
        let progress = self.0.get_or_insert(Progress {
            best_m: distance_m,
            leg_m: distance_m,
            improved_m: distance_m,
            improved_at: time,
        });
        progress.best_m = progress.best_m.min(distance_m);
        if distance_m <= progress.improved_m - PROGRESS_M {
            progress.improved_m = distance_m;
            progress.improved_at = time;
        }
    }

    /// What the machine decides on; `None` while paused.
    pub(super) fn facts(&self, distance_m: f64, time: SimTime) -> Option<ProgressFacts> {
        self.0.map(|progress| ProgressFacts {
            no_progress_s: time.seconds_since(progress.improved_at),
            distance_m,
            flyaway_m: progress.best_m
                + (FLYAWAY_SHARE * progress.leg_m).clamp(FLYAWAY_LEAST_M, FLYAWAY_MOST_M),
        })
    }
}
