//! The verdict on a flight that nobody judged, from its events.

use super::event::{Happened, RecordedEvent};
use crate::flight::{Crash, FlightResult, Verdict};
use crate::telemetry::{
    DisarmReason, EventKind, FirmwareEvent, NavEvent, NavState, PlanSource, VehicleNotice,
};

/// What the events of a flight say about its end. Unlike the judge of `fly`, it does not know the truth.
#[derive(Debug, Clone, Copy, Default)]
pub struct Ending {
    diverged: bool,
    crash: Option<Crash>,
    /// The last reported state of the navigator, with its waypoint.
    state: (NavState, u8),
    /// The origin of the plan that the autopilot flies.
    source: PlanSource,
    /// The origin of the plan that it has completed since the arming.
    completed: Option<PlanSource>,
    touched_down: bool,
    disarmed: Option<DisarmReason>,
}

impl Ending {
    /// Returns what these events say, oldest first.
    pub fn of<'e>(events: impl IntoIterator<Item = &'e RecordedEvent>) -> Self {
        let mut ending = Self::default();
        for event in events {
            if let Happened::Vehicle(kind) = &event.what {
                ending.note(kind);
            }
        }
        ending
    }

    fn note(&mut self, event: &EventKind) {
        match event {
            EventKind::Crash { cause } => {
                let (state, wp) = self.state;
                self.crash =
                    Some(Crash { cause: Some(*cause), state, wp, source: self.source, attitude_deg: None });
            }
            EventKind::Touchdown { .. } => self.touched_down = true,
            EventKind::Notice(VehicleNotice::Diverged(_)) => self.diverged = true,
            EventKind::Firmware(FirmwareEvent::Armed) => {
                *self = Self { source: self.source, ..Self::default() };
            }
            EventKind::Firmware(FirmwareEvent::Disarmed(reason)) => self.disarmed = Some(*reason),
            EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Plan { source, .. })) => self.source = *source,
            EventKind::Firmware(FirmwareEvent::Nav(NavEvent::State { to, wp, .. })) => {
                self.state = (*to, *wp);
                if *to == NavState::Complete {
                    self.completed = Some(self.source);
                }
            }
            _ => {}
        }
    }

    /// Returns the verdict, in the words of `fly`.
    pub fn verdict(&self) -> Verdict {
        if self.diverged {
            return Verdict::new(FlightResult::Diverged, "the simulation diverged");
        }
        if let Some(crash) = self.crash {
            return Verdict::new(FlightResult::Crashed, crash.to_string());
        }
        let Some(reason) = self.disarmed else {
            return Verdict::new(FlightResult::Interrupted, "the recording ends in flight");
        };
        match (self.completed, reason) {
            (Some(PlanSource::Stored), DisarmReason::Landing) => {
                Verdict::new(FlightResult::Complete, "mission complete, landed and disarmed")
            }
            (Some(PlanSource::Stored), reason) => {
                Verdict::new(FlightResult::Complete, format!("mission complete, disarmed by {reason}"))
            }
            (Some(PlanSource::Rth), _) => {
                Verdict::new(FlightResult::Landed, "landed at home after a return to home")
            }
            (Some(PlanSource::Emergency), _) => {
                Verdict::new(FlightResult::Landed, "landed by an emergency landing")
            }
            (None, DisarmReason::Landing) => {
                Verdict::new(FlightResult::Landed, "landed, but not by the plan")
            }
            (None, DisarmReason::Failsafe) if self.touched_down => {
                Verdict::new(FlightResult::Landed, "landed under failsafe, and disarmed by it")
            }
            (None, reason) if self.touched_down => {
                Verdict::new(FlightResult::Landed, format!("landed, disarmed by {reason}"))
            }
            (None, reason) => Verdict::new(FlightResult::Disarmed, format!("disarmed by {reason}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::FlightPlan;
    use crate::signals::SimTime;
    use crate::telemetry::CrashCause;

    fn verdict(kinds: &[EventKind]) -> String {
        let events =
            kinds.iter().map(|kind| RecordedEvent { time: SimTime::ZERO, what: kind.clone().into() });
        let events: Vec<_> = events.collect();
        let Verdict { result, reason } = Ending::of(&events).verdict();
        format!("{result}: {reason}")
    }

    fn firmware(event: FirmwareEvent) -> EventKind {
        EventKind::Firmware(event)
    }

    #[test]
    fn a_flight_ends_as_its_events_say() {
        use FirmwareEvent::{Armed, Disarmed};
        let plan = |source| {
            firmware(FirmwareEvent::Nav(NavEvent::Plan { source, plan: Box::new(FlightPlan::default()) }))
        };
        let complete = firmware(FirmwareEvent::Nav(NavEvent::State {
            from: NavState::Landing,
            to: NavState::Complete,
            wp: 1,
            kind: None,
            reason: crate::telemetry::TransitionReason::Touchdown,
            guard: None,
            target: crate::geo::LatLon::default(),
            target_alt_m: 0.0,
        }));
        let (armed, landed) = (firmware(Armed), firmware(Disarmed(DisarmReason::Landing)));
        let switched_off = firmware(Disarmed(DisarmReason::Switch));
        let touchdown = EventKind::Touchdown { impact_mps: 0.4, peak_mps2: 12.0 };
        let crash = EventKind::Crash { cause: CrashCause::HullContact };
        assert_eq!(verdict(std::slice::from_ref(&armed)), "interrupted: the recording ends in flight");
        assert_eq!(
            verdict(&[armed.clone(), touchdown, switched_off.clone()]),
            "landed: landed, disarmed by SWITCH"
        );
        let failsafe = firmware(Disarmed(DisarmReason::Failsafe));
        let touchdown = EventKind::Touchdown { impact_mps: 0.4, peak_mps2: 12.0 };
        assert_eq!(
            verdict(&[armed.clone(), touchdown, failsafe.clone()]),
            "landed: landed under failsafe, and disarmed by it"
        );
        assert_eq!(verdict(&[armed.clone(), failsafe]), "disarmed: disarmed by FAILSAFE");
        assert_eq!(verdict(&[armed.clone(), switched_off.clone()]), "disarmed: disarmed by SWITCH");
        assert_eq!(
            verdict(&[armed.clone(), crash.clone(), switched_off.clone()]),
            "crashed: the craft crashed: it touched the ground with its hull"
        );
        // What came before the arming does not count.
        assert_eq!(verdict(&[crash, armed.clone(), landed.clone()]), "landed: landed, but not by the plan");
        for (source, said) in [
            (PlanSource::Stored, "complete: mission complete, landed and disarmed"),
            (PlanSource::Rth, "landed: landed at home after a return to home"),
            (PlanSource::Emergency, "landed: landed by an emergency landing"),
        ] {
            assert_eq!(verdict(&[armed.clone(), plan(source), complete.clone(), landed.clone()]), said);
        }
        assert_eq!(
            verdict(&[armed, plan(PlanSource::Stored), complete, switched_off]),
            "complete: mission complete, disarmed by SWITCH"
        );
    }
}
