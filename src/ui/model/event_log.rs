//! Events and notices as lines.

use std::collections::VecDeque;

use crate::events::{ReplayNotice, SessionEvent};
use crate::fc::RemoteNotice;
use crate::signals::SimTime;
use crate::telemetry::{BatteryAlarm, DisarmReason, EventKind, FirmwareEvent, NavEvent, NavState};

use crate::ui::theme::Role;

const MAX_LINES: usize = 5000;

/// The severity of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    Info,
    /// The mission progressed.
    Step,
    Good,
    Warn,
    Fault,
}

impl Severity {
    /// Returns the severity of an event.
    pub fn of(kind: &SessionEvent) -> Self {
        match kind {
            SessionEvent::Vehicle(event) => Self::from_vehicle(event),
            SessionEvent::Warning(_) => Self::Warn,
            SessionEvent::Branch { .. } => Self::Step,
            SessionEvent::Remote(RemoteNotice::Lost(_) | RemoteNotice::Restarted(_)) => Self::Warn,
            SessionEvent::Remote(RemoteNotice::Failed(_)) | SessionEvent::Replay(ReplayNotice::Failed(_)) => {
                Self::Fault
            }
            SessionEvent::Replay(ReplayNotice::Warning(_)) => Self::Warn,
            SessionEvent::Replay(ReplayNotice::Begins(_)) => Self::Step,
            SessionEvent::Remote(RemoteNotice::Output(_) | RemoteNotice::Reported(_))
            | SessionEvent::Endpoints(_)
            | SessionEvent::Notice(_)
            | SessionEvent::ArmingBlocked(_)
            | SessionEvent::Simulator(_)
            | SessionEvent::FirstState { .. }
            | SessionEvent::FirstRc { .. }
            | SessionEvent::Restarted => Self::Info,
        }
    }

    fn from_vehicle(kind: &EventKind) -> Self {
        match kind {
            EventKind::Boot { .. } | EventKind::Contact { .. } | EventKind::Notice(_) => Self::Info,
            EventKind::Touchdown { .. } => Self::Good,
            EventKind::Fault { on, .. } => {
                if *on {
                    Self::Warn
                } else {
                    Self::Good
                }
            }
            EventKind::Crash { .. } | EventKind::BatteryEmpty { .. } => Self::Fault,
            EventKind::Firmware(event) => Self::from_firmware(event),
        }
    }

    fn from_firmware(event: &FirmwareEvent) -> Self {
        match event {
            FirmwareEvent::GpsFix { .. } | FirmwareEvent::RxRecovered | FirmwareEvent::Armed => Self::Good,
            FirmwareEvent::Disarmed(DisarmReason::Landing) => Self::Good,
            // The user requested the restart.
            FirmwareEvent::Disarmed(DisarmReason::Switch | DisarmReason::System)
            | FirmwareEvent::Mode(_)
            | FirmwareEvent::Notice(_) => Self::Info,
            FirmwareEvent::Disarmed(_) | FirmwareEvent::Failsafe { .. } => Self::Fault,
            FirmwareEvent::GpsLost { .. } | FirmwareEvent::RxLoss => Self::Warn,
            FirmwareEvent::HeadingDoubt { on: false, .. } | FirmwareEvent::TiltDoubt { on: false, .. } => {
                Self::Good
            }
            FirmwareEvent::Battery { state: BatteryAlarm::Warning, .. }
            | FirmwareEvent::HeadingDoubt { on: true, .. } => Self::Warn,
            FirmwareEvent::TiltDoubt { on: true, .. } => Self::Fault,
            FirmwareEvent::Battery { .. } => Self::Fault,
            FirmwareEvent::Nav(event) => match event {
                NavEvent::State { to: NavState::Complete, .. } => Self::Good,
                NavEvent::State { .. } => Self::Step,
                NavEvent::CannotHold { on: false, .. } => Self::Good,
                NavEvent::Refused(_)
                | NavEvent::Geofence { .. }
                | NavEvent::Limited { .. }
                | NavEvent::CannotHold { .. } => Self::Warn,
                NavEvent::Plan { .. } | NavEvent::Climbing(_) | NavEvent::Disarm => Self::Info,
            },
        }
    }

    /// Returns the mark in front of the line.
    pub fn glyph(self) -> &'static str {
        match self {
            Self::Info => "·",
            Self::Step => "◆",
            Self::Good => "✓",
            Self::Warn => "▲",
            Self::Fault => "✗",
        }
    }

    /// Returns its role in the theme.
    pub fn role(self) -> Role {
        match self {
            Self::Info => Role::Text,
            Self::Step => Role::Title,
            Self::Good => Role::Ok,
            Self::Warn => Role::Warn,
            Self::Fault => Role::Fault,
        }
    }
}

/// A line of the log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogLine {
    /// The number of the line, counted from the first line ever.
    pub number: u64,
    pub time: SimTime,
    pub severity: Severity,
    pub text: String,
    /// `true` if it belongs to a branch of the flight that was left.
    pub left_behind: bool,
}

/// The log, bounded.
#[derive(Debug, Default)]
pub struct LogState {
    lines: VecDeque<LogLine>,
    count: u64,
}

impl LogState {
    /// Appends a line. The oldest is removed if the log is full. Line breaks and control characters become blanks.
    pub fn push(&mut self, time: SimTime, severity: Severity, text: String) {
        if self.lines.len() == MAX_LINES {
            self.lines.pop_front();
        }
        let text = if text.contains(char::is_control) { text.replace(char::is_control, " ") } else { text };
        self.lines.push_back(LogLine { number: self.count, time, severity, text, left_behind: false });
        self.count += 1;
    }

    /// Removes all lines.
    pub(in crate::ui) fn clear(&mut self) {
        self.lines.clear();
    }

    /// Marks the lines after `time` as left behind, because the flight continues from there.
    pub fn leave_behind(&mut self, time: SimTime) {
        self.lines.iter_mut().filter(|line| line.time > time).for_each(|line| line.left_behind = true);
    }

    /// Returns the lines, the newest first.
    pub fn newest_first(&self) -> impl DoubleEndedIterator<Item = &LogLine> {
        self.lines.iter().rev()
    }

    /// Returns the number of lines.
    pub fn len(&self) -> usize {
        self.lines.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_restart_that_was_asked_for_is_no_fault() {
        let disarmed = |reason| Severity::from_firmware(&FirmwareEvent::Disarmed(reason));
        assert_eq!(disarmed(DisarmReason::System), Severity::Info);
        assert_eq!(disarmed(DisarmReason::Failsafe), Severity::Fault);
    }

    #[test]
    fn the_log_is_bounded_and_keeps_the_newest() {
        let mut log = LogState::default();
        for n in 0..MAX_LINES + 10 {
            log.push(SimTime(n as u64), Severity::Info, format!("line\r\n{n}"));
        }
        assert_eq!(log.len(), MAX_LINES);
        let newest = log.newest_first().next().expect("a line");
        assert_eq!(newest.text, format!("line  {}", MAX_LINES + 9));
    }
}
