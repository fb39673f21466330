//! The times of events that a user may want to go back to.

use std::sync::Arc;

use crate::signals::SimTime;
use crate::telemetry::{BatteryAlarm, DisarmReason, EventKind, FirmwareEvent, ModeFlags, NavEvent, NavState};

/// The maximum number of marks. A flight of an hour has some hundred.
const MOST: usize = 4096;
/// The longest time between two marks of the same mishap, s.
const MISHAP_GAP_S: f64 = 30.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mark {
    pub time: SimTime,
    pub kind: MarkKind,
}

/// The kinds of events that a timeline shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkKind {
    /// The autopilot entered this state.
    State(NavState),
    /// The active modes changed to these. Only the record of a craft without states has such marks.
    Modes(ModeFlags),
    /// The craft was armed.
    Armed,
    /// The craft was disarmed normally.
    Disarmed,
    /// Something was lost, refused, broken or exceeded.
    Alarm,
    /// A loss has ended.
    Recovery,
    /// The craft came down on the ground.
    Touchdown,
}

impl MarkKind {
    /// Returns the mark of an event, or `None` for events that are of no interest for going back.
    fn of(event: &EventKind) -> Option<Self> {
        match event {
            EventKind::Firmware(event) => Self::from_firmware(event),
            EventKind::Fault { on: false, .. } => Some(Self::Recovery),
            EventKind::Fault { on: true, .. } | EventKind::Crash { .. } | EventKind::BatteryEmpty { .. } => {
                Some(Self::Alarm)
            }
            EventKind::Touchdown { .. } => Some(Self::Touchdown),
            EventKind::Boot { .. } | EventKind::Contact { .. } | EventKind::Notice(_) => None,
        }
    }

    fn from_firmware(event: &FirmwareEvent) -> Option<Self> {
        Some(match event {
            FirmwareEvent::Armed => Self::Armed,
            FirmwareEvent::Disarmed(DisarmReason::Switch | DisarmReason::System | DisarmReason::Landing) => {
                Self::Disarmed
            }
            FirmwareEvent::GpsFix { .. }
            | FirmwareEvent::RxRecovered
            | FirmwareEvent::HeadingDoubt { on: false, .. }
            | FirmwareEvent::TiltDoubt { on: false, .. } => Self::Recovery,
            FirmwareEvent::Disarmed(_)
            | FirmwareEvent::GpsLost { .. }
            | FirmwareEvent::RxLoss
            | FirmwareEvent::Failsafe { .. }
            | FirmwareEvent::HeadingDoubt { on: true, .. }
            | FirmwareEvent::TiltDoubt { on: true, .. }
            | FirmwareEvent::Battery {
                state: BatteryAlarm::Warning | BatteryAlarm::Critical | BatteryAlarm::Empty,
                ..
            } => Self::Alarm,
            FirmwareEvent::Nav(event) => match event {
                NavEvent::State { to, .. } => Self::State(*to),
                NavEvent::Refused(_) | NavEvent::Geofence { .. } | NavEvent::CannotHold { on: true, .. } => {
                    Self::Alarm
                }
                NavEvent::CannotHold { on: false, .. } => Self::Recovery,
                NavEvent::Limited { .. }
                | NavEvent::Plan { .. }
                | NavEvent::Climbing(_)
                | NavEvent::Disarm => return None,
            },
            FirmwareEvent::Mode(_) | FirmwareEvent::Notice(_) => return None,
        })
    }

    /// Returns `true` if the autopilot changed its state, or in its place the active modes changed.
    pub fn is_state(self) -> bool {
        matches!(self, Self::State(_) | Self::Modes(_))
    }
}

/// The marks of the flight, oldest first. Views share them.
#[derive(Debug, Default)]
pub struct Marks {
    all: Arc<Vec<Mark>>,
    /// The times of crashes and of all disarming, oldest first.
    ends: Vec<SimTime>,
}

impl Marks {
    /// Adds the mark of an event.
    pub fn note(&mut self, time: SimTime, event: &EventKind) {
        let Some(kind) = MarkKind::of(event) else { return };
        self.push(time, kind);
        if matches!(event, EventKind::Crash { .. } | EventKind::Firmware(FirmwareEvent::Disarmed(_))) {
            if self.ends.len() == MOST {
                self.ends.drain(..MOST / 4);
            }
            self.ends.push(time);
        }
    }

    /// Adds a mark.
    pub fn push(&mut self, time: SimTime, kind: MarkKind) {
        let marks = Arc::make_mut(&mut self.all);
        if marks.len() == MOST {
            marks.drain(..MOST / 4);
        }
        marks.push(Mark { time, kind });
    }

    /// Forgets the marks after `time`.
    pub fn forget_after(&mut self, time: SimTime) {
        Arc::make_mut(&mut self.all).retain(|mark| mark.time <= time);
        self.ends.retain(|end| *end <= time);
    }

    pub fn all(&self) -> Arc<Vec<Mark>> {
        Arc::clone(&self.all)
    }

    /// Returns the first mark of the mishap that ended the last flight before `time`. A mishap is a sequence of alarms,
    /// touchdown and end of the mission with short times between them, which ends with the disarming or the crash. Later
    /// marks, of a wreck, do not count.
    pub fn mishap_before(&self, time: SimTime) -> Option<Mark> {
        let armed = self.all.iter().rfind(|mark| mark.time <= time && mark.kind == MarkKind::Armed);
        let since = armed.map_or(SimTime::ZERO, |mark| mark.time);
        let end = *self.ends.iter().find(|end| (since..=time).contains(end))?;
        let is_part = |mark: &Mark| {
            use MarkKind::{Alarm, Disarmed, Recovery, State, Touchdown};
            matches!(mark.kind, Alarm | Recovery | Disarmed | Touchdown | State(NavState::Idle))
        };
        let mut first: Option<Mark> = None;
        for mark in self.all.iter().rev().filter(|mark| mark.time <= end) {
            let is_close = first.is_none_or(|first| first.time.seconds_since(mark.time) <= MISHAP_GAP_S);
            if !is_part(mark) || !is_close {
                break;
            }
            first = Some(*mark);
        }
        first
    }

    /// Returns the latest mark before `time`, of all marks or only of the states.
    pub fn before(&self, time: SimTime, states_only: bool) -> Option<Mark> {
        self.all.iter().rfind(|mark| mark.time < time && (!states_only || mark.kind.is_state())).copied()
    }

    /// Returns the earliest mark after `time`, of all marks or only of the states.
    pub fn after(&self, time: SimTime, states_only: bool) -> Option<Mark> {
        self.all.iter().find(|mark| mark.time > time && (!states_only || mark.kind.is_state())).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marks(events: &[(u64, EventKind)]) -> Marks {
        let mut marks = Marks::default();
        for (second, kind) in events {
            marks.note(SimTime(second * 1_000_000), kind);
        }
        marks
    }

    #[test]
    fn what_happens_to_a_wreck_does_not_hide_the_mishap() {
        use FirmwareEvent::{Armed, Disarmed, RxLoss, RxRecovered};
        let flight = [
            (5, EventKind::Firmware(Armed)),
            (100, EventKind::Firmware(RxLoss)),
            (102, EventKind::Firmware(Disarmed(DisarmReason::Failsafe))),
            (300, EventKind::Firmware(RxRecovered)),
            (400, EventKind::Firmware(RxLoss)),
            (500, EventKind::Firmware(Disarmed(DisarmReason::Switch))),
        ];
        for known in 3..=flight.len() {
            let mishap = marks(&flight[..known]).mishap_before(SimTime(600_000_000));
            assert_eq!(mishap.map(|mark| mark.time), Some(SimTime(100_000_000)), "{known} events");
        }
        let mut marks = marks(&flight);
        marks.forget_after(SimTime(101_000_000));
        assert_eq!(marks.mishap_before(SimTime(600_000_000)), None, "the flight goes on");
    }
}
