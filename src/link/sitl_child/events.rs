//! The events of the child on their way to the session: every change of its state, and as many lines as can
//! be read.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::ChildEvent;

/// The maximum number of lines that may wait.
const WAITING_MAX: usize = 512;
/// The maximum number of lines in a [`WINDOW`]. Display and recording must keep up with them.
const TOLD_MAX: usize = 500;
/// The period in which the lines are counted.
const WINDOW: Duration = Duration::from_secs(1);

/// The queue of events. Adding an event never blocks, because a firmware whose output is not read would stop.
#[derive(Debug, Default)]
pub(super) struct Events(Mutex<Queue>);

#[derive(Debug, Default)]
struct Queue {
    events: VecDeque<ChildEvent>,
    lines: usize,
    window: Option<Instant>,
    /// The number of lines accepted since the window began.
    reported: usize,
    /// The number of omitted lines that no event counts yet.
    not_shown: u64,
}

impl Events {
    /// Adds a line of the output, or counts it as omitted.
    pub(super) fn add_line(&self, line: &[u8], now: Instant) {
        self.lock().add_line(line, now);
    }

    /// Counts further lines as omitted.
    pub(super) fn omit(&self, lines: u64) {
        self.lock().not_shown += lines;
    }

    /// Adds a change of the child's state.
    pub(super) fn add(&self, event: ChildEvent) {
        let mut queue = self.lock();
        queue.count_not_shown();
        queue.events.push_back(event);
    }

    pub(super) fn take(&self, now: Instant) -> Option<ChildEvent> {
        self.lock().take(now)
    }

    fn lock(&self) -> MutexGuard<'_, Queue> {
        // No code panics while it holds the lock.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Queue {
    fn add_line(&mut self, line: &[u8], now: Instant) {
        if self.is_window_over(now) {
            self.window = Some(now);
            self.reported = 0;
            self.count_not_shown();
        }
        if self.reported >= TOLD_MAX || self.lines >= WAITING_MAX {
            self.not_shown += 1;
            return;
        }
        self.reported += 1;
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

    /// Adds an event with the number of omitted lines.
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

    /// Returns the numbers of lines and of omitted lines among the waiting events, and the last event.
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
    fn lines_beyond_what_can_be_read_are_counted_and_reported() {
        let (mut queue, begin) = (Queue::default(), Instant::now());
        for _ in 0..TOLD_MAX + 7 {
            queue.add_line(b"y", begin);
        }
        // It is not known yet if more lines follow.
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
