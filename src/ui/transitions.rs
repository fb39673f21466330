//! The last transitions of the state machine, for the State panel.

use std::collections::VecDeque;
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent};

use crate::signals::SimTime;
use crate::telemetry::{NavState, TransitionReason};

use super::shared::Shared;
use super::text_field::TextField;

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
    pub(super) search: TextField,
    /// `true` while the search is typed.
    pub(super) is_typing: bool,
}

impl Transitions {
    pub(super) fn push(&mut self, transition: Transition) {
        if self.list.len() == MAX_TRANSITIONS {
            self.list.pop_front();
        }
        self.list.push_back(transition);
    }

    /// Returns `true` while the transitions are searched.
    pub(super) fn is_searched(&self) -> bool {
        self.is_typing || !self.search.is_empty()
    }

    pub(super) fn begin_search(&mut self) {
        self.end_search();
        self.is_typing = true;
    }

    pub(super) fn end_search(&mut self) {
        self.search = TextField::default();
        self.is_typing = false;
        self.scroll = 0;
    }

    /// Handles a key while the search is typed.
    pub(super) fn search_key(&mut self, event: KeyEvent) {
        match event.code {
            KeyCode::Esc => self.end_search(),
            KeyCode::Enter => self.is_typing = false,
            _ => {
                self.search.key(event);
                self.scroll = 0;
            }
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
