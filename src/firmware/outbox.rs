//! Events on their way out of the firmware: a fixed number, and a count of those that did not fit.

use crate::telemetry::FirmwareEvent;

/// The most events between two drains.
pub const CAPACITY: usize = 64;

/// The events since the last drain, oldest first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outbox {
    events: arrayvec::ArrayVec<FirmwareEvent, CAPACITY>,
    lost: u32,
}

impl Outbox {
    /// Adds an event. If there is no room, it is counted as lost.
    pub fn push(&mut self, event: FirmwareEvent) {
        if self.events.try_push(event).is_err() {
            self.lost = self.lost.saturating_add(1);
        }
    }

    /// Takes the oldest event.
    pub fn take(&mut self) -> Option<FirmwareEvent> {
        self.events.pop_at(0)
    }

    /// Returns the number of events lost since the last call because the outbox was full.
    pub fn take_lost(&mut self) -> u32 {
        std::mem::take(&mut self.lost)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_counted() {
        let mut outbox = Outbox::default();
        for _ in 0..CAPACITY + 3 {
            outbox.push(FirmwareEvent::Armed);
        }
        assert_eq!(outbox.take_lost(), 3);
        assert_eq!(outbox.take_lost(), 0);
        assert_eq!(std::iter::from_fn(|| outbox.take()).count(), CAPACITY);
        assert!(outbox.take().is_none());
    }
}
