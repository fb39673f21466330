//! The events of a log, from its marks.

use crate::blackbox::AdjustedValue;
use crate::flight_log::{FailsafePhase, LogMark, LogMarkKind};
use crate::replay::{PastEvent, PastEventKind};
use crate::signals::SimTime;
use crate::telemetry::{DisarmReason, EventKind, FirmwareEvent, ModeBox};
use crate::timeline::{MarkKind, Marks};

/// The most damaged parts that are events of their own.
const MAX_DAMAGED: usize = 100;
/// The time between the change of the ARM box and the event of a disarming, µs.
const SAME_US: u64 = 500_000;

/// The events of a log and their marks.
#[derive(Debug, Default)]
pub(super) struct Happenings {
    pub(super) events: Vec<PastEvent>,
    pub(super) marks: Marks,
}

/// Returns the events of a log. `armed_at` is the first instant at which its craft is armed.
pub(super) fn of(log: &[LogMark], armed_at: Option<SimTime>) -> Happenings {
    let mut happenings = Happenings::default();
    // Only some logs have the event of the arming.
    let has_arming = log.iter().any(|mark| mark.kind == LogMarkKind::Armed);
    let mut armed_at = armed_at.filter(|_| !has_arming);
    let mut damaged = 0;
    for mark in log {
        if let Some(at) = armed_at.take_if(|at| *at <= mark.time) {
            happenings.firmware(at, FirmwareEvent::Armed);
        }
        damaged += usize::from(matches!(mark.kind, LogMarkKind::Skipped { .. }));
        if damaged <= MAX_DAMAGED || !matches!(mark.kind, LogMarkKind::Skipped { .. }) {
            happenings.take(mark, log);
        }
    }
    if let Some(at) = armed_at {
        happenings.firmware(at, FirmwareEvent::Armed);
    }
    happenings
}

impl Happenings {
    fn take(&mut self, mark: &LogMark, log: &[LogMark]) {
        let time = mark.time;
        match mark.kind {
            LogMarkKind::Armed => self.firmware(time, FirmwareEvent::Armed),
            LogMarkKind::Disarmed(reason) => self.firmware(time, FirmwareEvent::Disarmed(reason)),
            LogMarkKind::Boxes { old, new } => {
                let (before, after) = (old.modes(), new.modes());
                let disarms = old.has(ModeBox::Arm) && !new.has(ModeBox::Arm);
                if before != after {
                    self.marks.push(time, MarkKind::Modes(after));
                    self.firmware(time, FirmwareEvent::Mode(after));
                } else {
                    let names: Vec<_> = new.names().collect();
                    self.notice(time, format!("Boxes: {}.", names.join(", ")));
                }
                if disarms && !has_disarming_near(log, time) {
                    self.firmware(time, FirmwareEvent::Disarmed(DisarmReason::Unknown));
                }
            }
            LogMarkKind::FailsafePhase(phase) => self.failsafe(time, phase),
            LogMarkKind::RxSignal(true) => self.firmware(time, FirmwareEvent::RxRecovered),
            LogMarkKind::RxSignal(false) => self.firmware(time, FirmwareEvent::RxLoss),
            LogMarkKind::GpsFix(true) => {
                self.marks.push(time, MarkKind::Recovery);
                self.notice(time, "The GPS has a fix.".to_owned());
            }
            LogMarkKind::GpsFix(false) => {
                self.marks.push(time, MarkKind::Alarm);
                self.warn(time, "The GPS lost its fix.".to_owned());
            }
            LogMarkKind::Adjustment { function, value } => {
                let value = match value {
                    AdjustedValue::Whole(value) => value.to_string(),
                    AdjustedValue::Float(value) => value.to_string(),
                };
                self.notice(time, format!("In-flight adjustment: function {function} is {value}."));
            }
            LogMarkKind::Resumed { since } => {
                let pause_s = time.seconds_since(since);
                self.notice(time, format!("Logging goes on after a pause of {pause_s:.1} s."));
            }
            LogMarkKind::Skipped { since, bytes } => {
                let gap_s = time.seconds_since(since);
                let text = format!("The log is damaged here: {bytes} bytes were skipped, {gap_s:.2} s.");
                self.warn(time, text);
            }
            LogMarkKind::End => self.notice(time, "The log ends.".to_owned()),
        }
    }

    fn failsafe(&mut self, time: SimTime, phase: FailsafePhase) {
        let is_over = matches!(phase, FailsafePhase::Idle | FailsafePhase::RxLossRecovered);
        self.marks.push(time, if is_over { MarkKind::Recovery } else { MarkKind::Alarm });
        let text = format!("Failsafe phase: {phase}.");
        if is_over { self.notice(time, text) } else { self.warn(time, text) }
    }

    fn firmware(&mut self, time: SimTime, event: FirmwareEvent) {
        let kind = EventKind::Firmware(event);
        self.marks.note(time, &kind);
        self.events.push(PastEvent { time, kind: PastEventKind::Vehicle(kind) });
    }

    fn notice(&mut self, time: SimTime, text: String) {
        self.events.push(PastEvent { time, kind: PastEventKind::Notice(text) });
    }

    fn warn(&mut self, time: SimTime, text: String) {
        self.events.push(PastEvent { time, kind: PastEventKind::Warning(text) });
    }
}

/// Returns `true` if the craft was disarmed before or at `time`, and was not armed again since.
pub(super) fn is_disarmed(log: &[LogMark], time: SimTime) -> bool {
    let change = |mark: &LogMark| match mark.kind {
        LogMarkKind::Armed => Some(false),
        LogMarkKind::Disarmed(_) => Some(true),
        LogMarkKind::Boxes { old, new } if old.has(ModeBox::Arm) != new.has(ModeBox::Arm) => {
            Some(!new.has(ModeBox::Arm))
        }
        _ => None,
    };
    log.iter().take_while(|mark| mark.time <= time).filter_map(change).last().unwrap_or(false)
}

/// Returns `true` if a log has the event of a disarming close to this time.
fn has_disarming_near(log: &[LogMark], time: SimTime) -> bool {
    log.iter()
        .any(|mark| matches!(mark.kind, LogMarkKind::Disarmed(_)) && mark.time.0.abs_diff(time.0) <= SAME_US)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight_log::{BoxFlags, BoxOrder};

    fn at(seconds: u64) -> SimTime {
        SimTime(seconds * 1_000_000)
    }

    fn boxes(bits: u32) -> BoxFlags {
        BoxFlags { bits, order: BoxOrder::from_betaflight((2026, 12, 0)) }
    }

    /// Returns the events with their seconds, in words.
    fn events(log: &[(u64, LogMarkKind)], armed_s: Option<u64>) -> (Vec<(u64, String)>, Marks) {
        let log: Vec<_> =
            log.iter().map(|(second, kind)| LogMark { time: at(*second), kind: *kind }).collect();
        let happenings = of(&log, armed_s.map(at));
        let words = happenings.events.iter().map(|event| {
            let text = match &event.kind {
                PastEventKind::Vehicle(EventKind::Firmware(event)) => format!("{event:?}"),
                PastEventKind::Notice(text) | PastEventKind::Warning(text) => text.clone(),
                PastEventKind::Vehicle(other) => format!("{other:?}"),
            };
            (event.time.0 / 1_000_000, text)
        });
        (words.collect(), happenings.marks)
    }

    #[test]
    fn arming_is_an_event_even_if_the_log_has_none() {
        let armed = (3, "Armed".to_owned());
        let end = (9, "The log ends.".to_owned());
        let with_event = [(3, LogMarkKind::Armed), (9, LogMarkKind::End)];
        assert_eq!(events(&with_event, Some(3)).0, [armed.clone(), end.clone()]);
        assert_eq!(events(&with_event[1..], Some(3)).0, [armed.clone(), end]);
        assert_eq!(events(&[], Some(3)).0, [armed]);
        assert_eq!(events(&[], None).0, []);
    }

    #[test]
    fn a_disarming_is_reported_once() {
        let off = LogMarkKind::Boxes { old: boxes(0b11), new: boxes(0b10) };
        let reason = LogMarkKind::Disarmed(DisarmReason::Switch);
        let disarmings = |log: &[(u64, LogMarkKind)]| {
            let (events, _) = events(log, None);
            events.into_iter().filter(|(_, text)| text.contains("Disarmed")).collect::<Vec<_>>()
        };
        assert_eq!(disarmings(&[(8, off), (8, reason)]), [(8, "Disarmed(Switch)".to_owned())]);
        assert_eq!(disarmings(&[(8, off)]), [(8, "Disarmed(Unknown)".to_owned())]);
    }

    #[test]
    fn a_change_of_modes_is_a_mark_to_go_back_to() {
        let autopilot = LogMarkKind::Boxes { old: boxes(0b1), new: boxes(0b1000_0000_0001) };
        let beeper = LogMarkKind::Boxes { old: boxes(0b1), new: boxes(0b1 | 1 << 15) };
        let (events, marks) = events(&[(5, autopilot), (6, beeper)], None);
        assert!(events[0].1.starts_with("Mode("), "{events:?}");
        assert_eq!(events[1], (6, "Boxes: ARM, BEEPER.".to_owned()));
        assert_eq!(marks.before(at(9), true).map(|mark| mark.time), Some(at(5)));
    }

    #[test]
    fn losses_are_alarms_and_their_ends_recoveries() {
        let log = [
            (1, LogMarkKind::RxSignal(false)),
            (2, LogMarkKind::FailsafePhase(FailsafePhase::GpsRescue)),
            (3, LogMarkKind::RxSignal(true)),
            (4, LogMarkKind::FailsafePhase(FailsafePhase::Idle)),
            (5, LogMarkKind::GpsFix(false)),
            (6, LogMarkKind::GpsFix(true)),
        ];
        let (events, marks) = events(&log, None);
        let kinds: Vec<_> = marks.all().iter().map(|mark| mark.kind).collect();
        let (alarm, over) = (MarkKind::Alarm, MarkKind::Recovery);
        assert_eq!(kinds, [alarm, alarm, over, over, alarm, over]);
        assert_eq!(events[1].1, "Failsafe phase: GPS_RESCUE.");
    }

    #[test]
    fn many_damaged_parts_do_not_hide_the_other_events() {
        let skipped = LogMarkKind::Skipped { since: at(0), bytes: 12 };
        let mut log = vec![(1, skipped); 5000];
        log.push((2, LogMarkKind::Resumed { since: at(0) }));
        let value = AdjustedValue::Whole(-7);
        log.push((3, LogMarkKind::Adjustment { function: 4, value }));
        let (events, _) = events(&log, None);
        assert_eq!(events.len(), MAX_DAMAGED + 2);
        assert_eq!(events[0].1, "The log is damaged here: 12 bytes were skipped, 1.00 s.");
        assert_eq!(events[MAX_DAMAGED].1, "Logging goes on after a pause of 2.0 s.");
        assert_eq!(events[MAX_DAMAGED + 1].1, "In-flight adjustment: function 4 is -7.");
    }
}
