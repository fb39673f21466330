//! The changes of the air and the faults in this flight, by the user, a door or a plan of faults.

use std::collections::VecDeque;

use super::knobs::{Knob, knobs_of};
use super::units::Units;
use crate::signals::SimTime;
use crate::telemetry::snapshot::WorldView;

/// The number of changes kept.
const MOST: usize = 200;
/// A value that changes again within this time, such as a wind that rises, is one change, s.
const ONE_CHANGE_S: f64 = 3.0;

/// A knob that got another value.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WorldChange {
    pub(super) time: SimTime,
    pub(super) knob: Knob,
    /// The new value with its unit; a dash for a fault that has ended.
    pub(super) value: String,
}

/// The changes of a flight, the oldest first.
#[derive(Debug, Default)]
pub struct WorldHistory {
    changes: VecDeque<WorldChange>,
}

impl WorldHistory {
    /// Notes the differences between two worlds that follow each other.
    pub(super) fn follow(&mut self, time: SimTime, before: &WorldView, now: &WorldView, units: Units) {
        if before == now || before.airframe != now.airframe {
            return;
        }
        for knob in knobs_of(true) {
            let (was, is) = (knob.value_in(before, units), knob.value_in(now, units));
            // The time that a fault has left is no change.
            let is_change = match knob {
                Knob::Fault(_) => knob.is_default(before) != knob.is_default(now),
                _ => was != is,
            };
            if is_change {
                self.push(WorldChange { time, knob, value: is.trim().to_owned() });
            }
        }
    }

    fn push(&mut self, change: WorldChange) {
        let last = self.changes.iter_mut().rev().find(|last| last.knob == change.knob);
        let is_same = |last: &&mut WorldChange| change.time.seconds_since(last.time) < ONE_CHANGE_S;
        match (change.knob, last.filter(is_same)) {
            (Knob::WindSpeed | Knob::WindFrom | Knob::Gust, Some(last)) => last.value = change.value,
            _ => {
                if self.changes.len() == MOST {
                    self.changes.pop_front();
                }
                self.changes.push_back(change);
            }
        }
    }

    /// Forgets the changes after this time: the flight goes on from there, or has begun again.
    pub(super) fn forget_after(&mut self, time: SimTime) {
        self.changes.retain(|change| change.time <= time);
    }

    /// Returns the changes up to a time, the newest first.
    pub(super) fn until(&self, time: SimTime) -> impl Iterator<Item = &WorldChange> {
        self.changes.iter().rev().filter(move |change| change.time <= time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::snapshot::{FaultView, WindView};
    use crate::telemetry::{FaultKind, FaultValue};

    fn world(speed_mps: f64, left_s: Option<f64>) -> WorldView {
        let fault = left_s.map(|left_s| FaultView {
            kind: FaultKind::GpsLoss,
            value: FaultValue::None,
            left_s: Some(left_s),
        });
        WorldView {
            wind: Some(WindView { speed_mps, from_deg: 270.0 }),
            faults: fault.into_iter().collect(),
            ..WorldView::default()
        }
    }

    fn shown(history: &WorldHistory, time_s: f64) -> Vec<String> {
        let until = history.until(SimTime::from_secs_f64(time_s));
        until.map(|change| format!("{} {}", change.knob.name(), change.value)).collect()
    }

    #[test]
    fn a_rising_wind_is_one_change_and_a_fault_has_a_beginning_and_an_end() {
        let worlds = [
            (10.0, world(0.0, None)),
            (11.0, world(2.0, None)),
            (12.0, world(5.0, None)),
            (20.0, world(5.0, Some(6.0))),
            (23.0, world(5.0, Some(3.0))),
            (26.0, world(5.0, None)),
            (40.0, world(7.0, None)),
        ];
        let mut history = WorldHistory::default();
        for pair in worlds.windows(2) {
            let time = SimTime::from_secs_f64(pair[1].0);
            history.follow(time, &pair[0].1, &pair[1].1, Units::Metric);
        }
        assert_eq!(
            shown(&history, 100.0),
            ["wind speed 7.0 m/s", "gps-loss —", "gps-loss on for 6.0 s", "wind speed 5.0 m/s"]
        );
        assert_eq!(shown(&history, 22.0), ["gps-loss on for 6.0 s", "wind speed 5.0 m/s"]);
        history.forget_after(SimTime::from_secs_f64(22.0));
        assert_eq!(shown(&history, 100.0).len(), 2);
    }
}
