//! The changes of the air and the faults in this flight, by the user, a door or a plan of faults.

use std::collections::VecDeque;

use crate::signals::SimTime;

/// The number of changes kept.
const MOST: usize = 200;
/// A value that changes again within this time, such as a wind that rises, is one change, s.
const ONE_CHANGE_S: f64 = 3.0;

/// Something in the world that got another value.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui) struct WorldChange {
    pub(in crate::ui) time: SimTime,
    pub(in crate::ui) name: &'static str,
    /// The new value with its unit; a dash for a fault that has ended.
    pub(in crate::ui) value: String,
    /// `true` if the value may rise or fall step by step.
    pub(in crate::ui) is_gradual: bool,
}

/// The changes of a flight, the oldest first.
#[derive(Debug, Default)]
pub struct WorldHistory {
    changes: VecDeque<WorldChange>,
}

impl WorldHistory {
    /// Notes a change.
    pub(in crate::ui) fn note(&mut self, change: WorldChange) {
        let last = self.changes.iter_mut().rev().find(|last| last.name == change.name);
        let is_same = |last: &&mut WorldChange| change.time.seconds_since(last.time) < ONE_CHANGE_S;
        match last.filter(is_same) {
            Some(last) if change.is_gradual => last.value = change.value,
            _ => {
                if self.changes.len() == MOST {
                    self.changes.pop_front();
                }
                self.changes.push_back(change);
            }
        }
    }

    /// Forgets the changes after this time: the flight goes on from there, or has begun again.
    pub(in crate::ui) fn forget_after(&mut self, time: SimTime) {
        self.changes.retain(|change| change.time <= time);
    }

    /// Returns the changes up to a time, the newest first.
    pub(in crate::ui) fn until(&self, time: SimTime) -> impl Iterator<Item = &WorldChange> {
        self.changes.iter().rev().filter(move |change| change.time <= time)
    }
}
