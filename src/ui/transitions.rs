//! The last transitions of the state machine, for the State panel.

use std::collections::VecDeque;
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent};

use crate::signals::SimTime;
use crate::telemetry::{NavState, TransitionReason};

use super::search::Search;
use super::shared::Shared;

/// The number of transitions kept.
const MAX_TRANSITIONS: usize = 200;

/// A transition of the state machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Transition {
    pub(super) time: SimTime,
    /// The time at which the interface received it, wall clock.
    pub(super) received: Duration,
    pub(super) from: NavState,
    pub(super) to: NavState,
    pub(super) wp: u8,
    pub(super) reason: TransitionReason,
}

/// The last transitions, and the place in their list.
#[derive(Debug, Default)]
pub struct Transitions {
    /// The newest is the last.
    list: VecDeque<Transition>,
    /// The first visible transition, counted from the newest.
    pub scroll: usize,
    /// The words that the shown transitions have.
    pub(super) search: Search,
}

impl Transitions {
    pub(super) fn push(&mut self, transition: Transition) {
        if self.list.len() == MAX_TRANSITIONS {
            self.list.pop_front();
        }
        self.list.push_back(transition);
    }

    pub(super) fn begin_search(&mut self) {
        (self.search, self.scroll) = (Search::begun(), 0);
    }

    pub(super) fn end_search(&mut self) {
        (self.search, self.scroll) = (Search::default(), 0);
    }

    /// Handles a key while the search is typed.
    pub(super) fn search_key(&mut self, event: KeyEvent) {
        self.search.key(event);
        if event.code != KeyCode::Enter {
            self.scroll = 0;
        }
    }

    /// Returns the transitions up to the shown instant, the oldest first.
    pub(super) fn shown(
        &self,
        state: &Shared,
    ) -> impl DoubleEndedIterator<Item = &Transition> + ExactSizeIterator {
        let shown = self.list.partition_point(|step| !state.is_later_than_shown(step.time));
        self.list.iter().take(shown)
    }

    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Drops the transitions after `time`.
    pub(super) fn leave_behind(&mut self, time: SimTime) {
        let kept = self.list.partition_point(|step| step.time <= time);
        self.list.truncate(kept);
    }
}
