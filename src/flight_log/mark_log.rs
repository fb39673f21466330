//! The marks of a log while it is read.

use strum::IntoEnumIterator as _;

use super::boxes::BoxFlags;
use super::failsafe_phase::FailsafePhase;
use super::mark::{LogMark, LogMarkKind};
use super::sample::LogSample;
use crate::blackbox::LogEvent;
use crate::blackbox::decode::FirmwareName;
use crate::signals::SimTime;
use crate::telemetry::DisarmReason;

/// The most marks of a log that are kept.
const MAX_MARKS: usize = 10_000;

/// The values of slow frames whose changes are marked.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Flags {
    pub(super) boxes: Option<BoxFlags>,
    pub(super) failsafe_phase: Option<FailsafePhase>,
    pub(super) rx_signal: Option<bool>,
    pub(super) gps_fix: Option<bool>,
}

impl Flags {
    pub(super) fn of(sample: &LogSample) -> Self {
        let LogSample { boxes, failsafe_phase, rx_signal, gps_fix, .. } = *sample;
        Self { boxes, failsafe_phase, rx_signal, gps_fix }
    }
}

/// Collects marks.
#[derive(Debug, Default)]
pub(super) struct MarkLog(Vec<LogMark>);

impl MarkLog {
    fn add(&mut self, time: SimTime, kind: LogMarkKind) {
        if self.0.len() < MAX_MARKS {
            self.0.push(LogMark { time, kind });
        }
    }

    /// Marks the changes between two known states.
    pub(super) fn changed(&mut self, time: SimTime, old: Flags, new: Flags) {
        let both = old.boxes.zip(new.boxes).filter(|(old, new)| old.bits != new.bits);
        if let Some((old, new)) = both {
            self.add(time, LogMarkKind::Boxes { old, new });
        }
        if old.failsafe_phase != new.failsafe_phase
            && let (Some(_), Some(phase)) = (old.failsafe_phase, new.failsafe_phase)
        {
            self.add(time, LogMarkKind::FailsafePhase(phase));
        }
        if let (Some(was), Some(is)) = (old.rx_signal, new.rx_signal)
            && was != is
        {
            self.add(time, LogMarkKind::RxSignal(is));
        }
        if let (Some(was), Some(is)) = (old.gps_fix, new.gps_fix)
            && was != is
        {
            self.add(time, LogMarkKind::GpsFix(is));
        }
    }

    /// Marks an event; `last` is the time of the main frame before it, zero if there is none.
    pub(super) fn event(&mut self, time: SimTime, last: SimTime, event: LogEvent, firmware: FirmwareName) {
        let kind = match event {
            LogEvent::SyncBeep { .. } => LogMarkKind::Armed,
            LogEvent::Adjustment { function, value } => LogMarkKind::Adjustment { function, value },
            LogEvent::Resume { .. } if last == SimTime::ZERO => return,
            LogEvent::Resume { .. } => LogMarkKind::Resumed { since: last.min(time) },
            LogEvent::Disarm { reason } => LogMarkKind::Disarmed(disarm_reason(reason, firmware)),
            LogEvent::End => LogMarkKind::End,
            LogEvent::FlightMode { .. } => return,
        };
        self.add(time, kind);
    }

    /// Marks skipped bytes.
    pub(super) fn skipped(&mut self, time: SimTime, since: SimTime, bytes: u64) {
        self.add(time, LogMarkKind::Skipped { since: since.min(time), bytes });
    }

    /// Returns the marks. Those before the first main frame get its time.
    pub(super) fn finish(mut self, first: SimTime) -> Vec<LogMark> {
        for mark in &mut self.0 {
            mark.time = mark.time.max(first);
        }
        self.0
    }
}

/// Returns the reason of a disarming. Other firmwares than Betaflight have other numbers.
fn disarm_reason(number: u32, firmware: FirmwareName) -> DisarmReason {
    let known = DisarmReason::iter().find(|reason| *reason as u32 == number);
    known.filter(|_| firmware == FirmwareName::Betaflight).unwrap_or(DisarmReason::Unknown)
}
