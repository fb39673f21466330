//! When something happened that one may want to go back to.

use std::sync::Arc;

use crate::signals::SimTime;
use crate::telemetry::{BatteryAlarm, DisarmReason, Event, EventKind, FirmwareEvent, NavEvent, NavState};

/// Marks kept; a flight of an hour has some hundred.
const MOST: usize = 4096;
/// Marks of one mishap follow each other within this time, in seconds.
const MISHAP_GAP_S: f64 = 30.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mark {
    pub time: SimTime,
    pub kind: MarkKind,
}

/// What happened, as far as a timeline shows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkKind {
    /// The autopilot came to this state.
    State(NavState),
    /// The craft was armed.
    Armed,
    /// The craft was disarmed as it should be.
    Disarmed,
    /// Something was lost, refused, broken or exceeded.
    Alarm,
    /// What was lost is back.
    Recovery,
    /// The craft came down on the ground.
    Touchdown,
}

impl MarkKind {
    /// The mark of an event; `None` for those that nobody goes back to.
    fn of(event: &EventKind) -> Option<Self> {
        match event {
            EventKind::Firmware(event) => Self::of_firmware(event),
            EventKind::Fault { on: false, .. } => Some(Self::Recovery),
            EventKind::Fault { on: true, .. } | EventKind::Crash { .. } | EventKind::BatteryEmpty { .. } => {
                Some(Self::Alarm)
            }
            EventKind::Touchdown { .. } => Some(Self::Touchdown),
            EventKind::Boot { .. } | EventKind::Contact { .. } | EventKind::Notice(_) => None,
        }
    }

    fn of_firmware(event: &FirmwareEvent) -> Option<Self> {
        Some(match event {
            FirmwareEvent::Armed => Self::Armed,
            FirmwareEvent::Disarmed(DisarmReason::Switch | DisarmReason::System | DisarmReason::Landing) => {
                Self::Disarmed
            }
            FirmwareEvent::GpsFix { .. }
            | FirmwareEvent::RxRecovered
            | FirmwareEvent::HeadingDoubt { on: false, .. } => Self::Recovery,
            FirmwareEvent::Disarmed(_)
            | FirmwareEvent::GpsLost { .. }
            | FirmwareEvent::RxLoss
            | FirmwareEvent::Failsafe { .. }
            | FirmwareEvent::HeadingDoubt { on: true, .. }
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

    /// Whether the autopilot changed its state.
    pub fn is_state(self) -> bool {
        matches!(self, Self::State(_))
    }
}

/// The marks of the flight, the oldest first. Views share them.
#[derive(Debug, Default)]
pub struct Marks(Arc<Vec<Mark>>);

impl Marks {
    /// Notes an event that has happened.
    pub fn note(&mut self, event: &Event) {
        let Some(kind) = MarkKind::of(&event.kind) else { return };
        let marks = Arc::make_mut(&mut self.0);
        if marks.len() == MOST {
            marks.drain(..MOST / 4);
        }
        marks.push(Mark { time: event.time, kind });
    }

    /// Forgets what happened after `time`.
    pub fn forget_after(&mut self, time: SimTime) {
        Arc::make_mut(&mut self.0).retain(|mark| mark.time <= time);
    }

    pub fn all(&self) -> Arc<Vec<Mark>> {
        Arc::clone(&self.0)
    }

    /// Returns the first mark of the mishap that ends at `time`: of the alarms, and of the disarming, the touchdown and the end
    /// of the mission among them, that follow each other closely.
    pub fn mishap_before(&self, time: SimTime) -> Option<Mark> {
        let is_part = |mark: &Mark| {
            use MarkKind::{Alarm, Disarmed, State, Touchdown};
            matches!(mark.kind, Alarm | Disarmed | Touchdown | State(NavState::Idle))
        };
        let mut first: Option<Mark> = None;
        for mark in self.0.iter().rev().filter(|mark| mark.time <= time) {
            let is_close = first.is_none_or(|first| first.time.seconds_since(mark.time) <= MISHAP_GAP_S);
            if !is_part(mark) || !is_close {
                break;
            }
            first = Some(*mark);
        }
        first
    }

    /// The latest before `time`, of all or of the states alone.
    pub fn before(&self, time: SimTime, states_only: bool) -> Option<Mark> {
        self.0.iter().rfind(|mark| mark.time < time && (!states_only || mark.kind.is_state())).copied()
    }

    /// The earliest after `time`, of all or of the states alone.
    pub fn after(&self, time: SimTime, states_only: bool) -> Option<Mark> {
        self.0.iter().find(|mark| mark.time > time && (!states_only || mark.kind.is_state())).copied()
    }
}
