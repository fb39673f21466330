//! What happened to the child, on its way to the session: every change of its state, and as many lines as can be read.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::ChildEvent;

/// Most lines that wait to be told.
const WAITING_MAX: usize = 512;
/// Most lines that are told in a [`WINDOW`]: what shows and records them has to keep up.
const TOLD_MAX: usize = 500;
/// In which the lines are counted.
const WINDOW: Duration = Duration::from_secs(1);

/// The events that wait. Nobody who adds one is held up, for a firmware whose output is not read stands still.
#[derive(Debug, Default)]
pub(super) struct Events(Mutex<Queue>);

#[derive(Debug, Default)]
struct Queue {
    events: VecDeque<ChildEvent>,
    lines: usize,
    window: Option<Instant>,
    /// Lines that were taken in since the window began.
    told: usize,
    /// Lines that were left out and are not counted in an event yet.
    not_shown: u64,
}

impl Events {
    /// Adds a line of its output, or counts it.
    pub(super) fn add_line(&self, line: &[u8], now: Instant) {
        self.lock().add_line(line, now);
    }

    /// Adds a change of its state.
    pub(super) fn add(&self, event: ChildEvent) {
        let mut queue = self.lock();
        queue.count_not_shown();
        queue.events.push_back(event);
    }

    pub(super) fn take(&self, now: Instant) -> Option<ChildEvent> {
        self.lock().take(now)
    }

    fn lock(&self) -> MutexGuard<'_, Queue> {
        // Nobody panics with it.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Queue {
    fn add_line(&mut self, line: &[u8], now: Instant) {
        if self.is_window_over(now) {
            self.window = Some(now);
            self.told = 0;
            self.count_not_shown();
        }
        if self.told >= TOLD_MAX || self.lines >= WAITING_MAX {
            self.not_shown += 1;
            return;
        }
        self.told += 1;
        self.lines += 1;
        self.events.push_back(ChildEvent::Line(String::from_utf8_lossy(line).into_owned()));
    }

    fn take(&mut self, now: Instant) -> Option<ChildEvent> {
        if self.events.is_empty() && self.is_window_over(now) {
            self.count_not_shown();
        }
        let event = self.events.pop_front();
        if let Some(ChildEvent::Line(_)) = event {
            self.lines -= 1;
        }
        event
    }

    fn is_window_over(&self, now: Instant) -> bool {
        self.window.is_none_or(|began| now.saturating_duration_since(began) >= WINDOW)
    }

    /// Has the lines that were left out told.
    fn count_not_shown(&mut self) {
        let more = std::mem::take(&mut self.not_shown);
        match self.events.back_mut() {
            _ if more == 0 => {}
            Some(ChildEvent::NotShown(count)) => *count += more,
            _ => self.events.push_back(ChildEvent::NotShown(more)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::ChildEnd;

    /// Lines and lines not shown among the events that wait, and the last event.
    fn drain(queue: &mut Queue, now: Instant) -> (usize, u64, Option<ChildEvent>) {
        let (mut lines, mut not_shown, mut last) = (0, 0, None);
        while let Some(event) = queue.take(now) {
            match &event {
                ChildEvent::Line(_) => lines += 1,
                ChildEvent::NotShown(count) => not_shown += count,
                _ => {}
            }
            last = Some(event);
        }
        (lines, not_shown, last)
    }

    #[test]
    #[allow(clippy::disallowed_methods, reason = "an instant to count from")]
    fn lines_beyond_what_can_be_read_are_counted_and_told() {
        let (mut queue, begin) = (Queue::default(), Instant::now());
        for _ in 0..TOLD_MAX + 7 {
            queue.add_line(b"y", begin);
        }
        // Whether more follow is not known yet.
        assert_eq!(drain(&mut queue, begin), (TOLD_MAX, 0, Some(ChildEvent::Line("y".to_owned()))));
        assert_eq!(drain(&mut queue, begin + WINDOW), (0, 7, Some(ChildEvent::NotShown(7))));
        queue.add_line(b"later", begin + WINDOW);
        let later = Some(ChildEvent::Line("later".to_owned()));
        assert_eq!(drain(&mut queue, begin + WINDOW), (1, 0, later));
    }

    #[test]
    #[allow(clippy::disallowed_methods, reason = "an instant to count from")]
    fn events_that_nobody_takes_do_not_add_up_and_its_end_is_kept() {
        let (events, begin) = (Events::default(), Instant::now());
        for second in 0..1000 {
            for _ in 0..TOLD_MAX {
                events.add_line(b"y", begin + second * WINDOW);
            }
        }
        events.add(ChildEvent::Ended(ChildEnd::Code(1)));
        let mut queue = events.lock();
        assert_eq!(queue.events.len(), WAITING_MAX + 2);
        let (lines, not_shown, last) = drain(&mut queue, begin);
        assert_eq!(lines as u64 + not_shown, 1000 * TOLD_MAX as u64);
        assert_eq!(last, Some(ChildEvent::Ended(ChildEnd::Code(1))));
    }
}
