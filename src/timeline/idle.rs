//! The time without events: the craft is disarmed and at rest, and there is no input.

use std::collections::VecDeque;

use super::{Mark, MarkKind};
use crate::signals::SimTime;

/// The shortest part that a display folds, µs.
const FOLD_US: u64 = 30_000_000;

/// A part of the recording without events.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IdleSpan {
    pub from: SimTime,
    /// End of the part, exclusive.
    pub to: SimTime,
}

impl IdleSpan {
    /// Returns the length of the part, µs.
    pub fn length_us(&self) -> u64 {
        self.to.0.saturating_sub(self.from.0)
    }
}

/// The idle parts of the recording.
#[derive(Debug, Default)]
pub(super) struct IdleTime {
    spans: VecDeque<IdleSpan>,
    /// Length of all idle parts since the recording began, µs.
    total_us: u64,
    /// Newest instant that was not idle.
    active_at: Option<SimTime>,
}

impl IdleTime {
    /// Records the state of the instant `at`, idle or not. A part becomes idle `settle_us` after the last activity,
    /// so that separate inputs count as activity for a while.
    pub(super) fn note(&mut self, at: SimTime, is_idle: bool, settle_us: u64) {
        let active_at = *self.active_at.get_or_insert(at);
        if !is_idle {
            self.active_at = Some(at);
            return;
        }
        let from = SimTime(active_at.0.saturating_add(settle_us));
        if at <= from {
            return;
        }
        match self.spans.back_mut() {
            Some(span) if span.from == from => {
                self.total_us += at.0.saturating_sub(span.to.0);
                span.to = at;
            }
            _ => {
                self.total_us += at.0 - from.0;
                self.spans.push_back(IdleSpan { from, to: at });
            }
        }
    }

    /// Returns the time up to the newest instant `at` without the idle parts, µs.
    pub(super) fn active_us(&self, at: SimTime) -> u64 {
        at.0.saturating_sub(self.total_us)
    }

    /// Forgets the parts that end before `first`.
    pub(super) fn forget_before(&mut self, first: SimTime) {
        while self.spans.front().is_some_and(|span| span.to <= first) {
            self.spans.pop_front();
        }
    }

    /// Forgets everything after `time`, which is the newest instant from now on.
    pub(super) fn forget_after(&mut self, time: SimTime) {
        while let Some(span) = self.spans.pop_back_if(|span| span.to > time) {
            self.total_us -= span.length_us();
            if span.from < time {
                let kept = IdleSpan { to: time, ..span };
                self.total_us += kept.length_us();
                self.spans.push_back(kept);
            }
        }
        self.active_at = Some(time);
    }

    /// Returns the parts that a display folds, oldest first. They are long and have no mark inside. There are none
    /// unless the craft was armed since `first`.
    pub(super) fn folds(&self, marks: &[Mark], first: SimTime) -> Vec<IdleSpan> {
        if !marks.iter().any(|mark| mark.time >= first && mark.kind == MarkKind::Armed) {
            return Vec::new();
        }
        let mut folds = Vec::new();
        for span in &self.spans {
            let mut from = span.from.max(first);
            let after = marks.partition_point(|mark| mark.time <= from);
            let inside = marks.iter().skip(after).map(|mark| mark.time).take_while(|time| *time < span.to);
            for to in inside.chain([span.to]) {
                folds.push(IdleSpan { from, to });
                from = to;
            }
        }
        folds.retain(|fold| fold.length_us() >= FOLD_US);
        folds
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: u64) -> SimTime {
        SimTime(seconds * 1_000_000)
    }

    fn span(from: u64, to: u64) -> IdleSpan {
        IdleSpan { from: at(from), to: at(to) }
    }

    /// Returns the idle time of a flight. `is_idle` gives the state of each second. It settles in ten seconds.
    fn noted(seconds: std::ops::Range<u64>, is_idle: impl Fn(u64) -> bool) -> IdleTime {
        let mut idle = IdleTime::default();
        seconds.for_each(|second| idle.note(at(second), is_idle(second), at(10).0));
        idle
    }

    #[test]
    fn a_part_is_idle_ten_seconds_after_the_last_activity() {
        let idle = noted(0..200, |second| second > 50 && second != 120);
        assert_eq!(idle.spans, [span(60, 119), span(130, 199)]);
        assert_eq!(idle.active_us(at(199)), at(199 - 59 - 69).0);
    }

    #[test]
    fn what_is_forgotten_is_no_longer_counted() {
        let mut idle = noted(0..200, |second| second > 50 && second != 120);
        idle.forget_after(at(90));
        assert_eq!((idle.spans.len(), idle.active_us(at(90))), (1, at(60).0));
        assert_eq!(idle.spans, [span(60, 90)]);
        (91..110).for_each(|second| idle.note(at(second), true, at(10).0));
        assert_eq!(idle.spans, [span(60, 90), span(100, 109)]);
        idle.forget_before(at(90));
        assert_eq!(idle.spans, [span(100, 109)]);
    }

    #[test]
    fn only_long_parts_without_a_mark_are_folded_and_only_beside_a_flight() {
        let idle = noted(0..200, |second| second > 50);
        let mark = |seconds, kind| Mark { time: at(seconds), kind };
        let (armed, lost) = (mark(20, MarkKind::Armed), mark(80, MarkKind::Alarm));
        assert_eq!(idle.folds(&[armed], SimTime::ZERO), [span(60, 199)]);
        // Twenty seconds before the alarm are too short.
        assert_eq!(idle.folds(&[armed, lost], SimTime::ZERO), [span(80, 199)]);
        assert_eq!(idle.folds(&[lost], SimTime::ZERO), []);
        assert_eq!(idle.folds(&[armed, lost], at(30)), [], "the flight is no longer recorded");
    }
}
