//! Events of the vehicle in the words of expectations.

use crate::scenario::happening::{Entered, EventName, Field, Happening, HappeningKind, mode_word};
use crate::scenario::trace::{KnownPlan, Trace};
use crate::signals::SimTime;
use crate::telemetry::{Event, EventKind, FirmwareEvent, ModeFlags, NavEvent, NavState, PlanSource, Refusal};

/// The facts from earlier events that later events need.
#[derive(Debug, Default)]
pub(super) struct Log {
    modes: ModeFlags,
    source: PlanSource,
}

impl Log {
    pub(super) fn note(&mut self, event: &Event, trace: &mut Trace) {
        let time = event.time;
        let plain = |name| Happening::event(time, name, &[]);
        let happening = match &event.kind {
            EventKind::Boot { .. } => return,
            EventKind::Firmware(event) => return self.note_firmware(event, time, trace),
            EventKind::Fault { kind, on, .. } => {
                Happening::event(time, EventName::Fault, &[(*kind).into(), on_off(*on)])
            }
            EventKind::Contact { impact_mps } => plain(EventName::Contact).with(Field::Impact, *impact_mps),
            EventKind::Touchdown { impact_mps, peak_mps2 } => {
                plain(EventName::Touchdown).with(Field::Impact, *impact_mps).with(Field::Peak, *peak_mps2)
            }
            EventKind::Crash { cause } => plain(EventName::Crash).saying(cause.to_string()),
            EventKind::BatteryEmpty { cell_v } => {
                plain(EventName::BatteryEmpty).with(Field::CellVoltage, *cell_v)
            }
            EventKind::Notice(notice) => plain(EventName::Notice).saying(notice.to_string()),
        };
        trace.happenings.push(happening);
    }

    fn note_firmware(&mut self, event: &FirmwareEvent, time: SimTime, trace: &mut Trace) {
        let plain = |name| Happening::event(time, name, &[]);
        let happening = match event {
            FirmwareEvent::GpsFix { sats } => plain(EventName::GpsFix).with(Field::Sats, f64::from(*sats)),
            FirmwareEvent::GpsLost { sats } => plain(EventName::GpsLost).with(Field::Sats, f64::from(*sats)),
            FirmwareEvent::Armed => plain(EventName::Armed),
            FirmwareEvent::Disarmed(reason) => {
                Happening::event(time, EventName::Disarmed, &[&reason.to_string()])
            }
            FirmwareEvent::Mode(modes) => return self.note_modes(*modes, time, trace),
            FirmwareEvent::RxLoss => plain(EventName::RxLoss),
            FirmwareEvent::RxRecovered => plain(EventName::RxRecovered),
            FirmwareEvent::Failsafe { policy: _, stage, procedure } => {
                Happening::event(time, EventName::Failsafe, &[&stage.to_string(), (*procedure).into()])
            }
            FirmwareEvent::Nav(event) => return self.note_nav(event, time, trace),
            FirmwareEvent::Battery { state, cell_v } => {
                Happening::event(time, EventName::Battery, &[&state.to_string()])
                    .with(Field::CellVoltage, *cell_v)
            }
            FirmwareEvent::HeadingDoubt { on, error_deg } => {
                Happening::event(time, EventName::HeadingDoubt, &[on_off(*on)]).with(Field::Error, *error_deg)
            }
            FirmwareEvent::TiltDoubt { on, error_deg } => {
                Happening::event(time, EventName::TiltDoubt, &[on_off(*on)]).with(Field::Error, *error_deg)
            }
            FirmwareEvent::Notice(notice) => plain(EventName::Notice).saying(notice.to_string()),
        };
        trace.happenings.push(happening);
    }

    fn note_modes(&mut self, modes: ModeFlags, time: SimTime, trace: &mut Trace) {
        let changed = |before: ModeFlags, now: ModeFlags| {
            now.iter().filter(move |&mode| !before.has(mode)).map(mode_word).collect::<Vec<_>>()
        };
        let (went_on, went_off) = (changed(self.modes, modes), changed(modes, self.modes));
        self.modes = modes;
        for (names, word) in [(went_on, "on"), (went_off, "off")] {
            let happenings = names.iter().map(|name| Happening::event(time, EventName::Mode, &[name, word]));
            trace.happenings.extend(happenings);
        }
    }

    fn note_nav(&mut self, event: &NavEvent, time: SimTime, trace: &mut Trace) {
        let happening = match event {
            NavEvent::Plan { source, plan } => {
                self.source = *source;
                trace.plans.push(KnownPlan { since: time, source: *source, plan: (**plan).clone() });
                Happening::event(time, EventName::Plan, &[&source.to_string()])
                    .with(Field::Count, plan.waypoints.len() as f64)
                    .saying(types(plan))
            }
            NavEvent::State { from, to, wp, reason, .. } => {
                if *from == NavState::Idle && *to != NavState::Idle {
                    trace.happenings.push(Happening::event(time, EventName::Engaged, &[]));
                }
                let entered = Entered { state: *to, wp: *wp, source: self.source, reason: reason.word() };
                Happening { time, kind: HappeningKind::State(entered) }
            }
            NavEvent::Climbing(on) => Happening::event(time, EventName::Climbing, &[on_off(*on)]),
            NavEvent::Limited { tilt_rad } => {
                Happening::event(time, EventName::Limited, &[]).with(Field::TiltLimit, tilt_rad.to_degrees())
            }
            NavEvent::Geofence { distance_m, limit_m, action } => {
                Happening::event(time, EventName::Geofence, &[(*action).into()])
                    .with(Field::Distance, *distance_m)
                    .with(Field::Limit, *limit_m)
            }
            NavEvent::CannotHold { on, deviation } => {
                Happening::event(time, EventName::CannotHold, &[on_off(*on), deviation.limit.into()])
                    .with(Field::Distance, deviation.distance_m)
                    .with(Field::Vertical, deviation.vertical_m)
            }
            NavEvent::Refused(refusal) => refused(time, refusal),
            NavEvent::Disarm => return,
        };
        trace.happenings.push(happening);
    }
}

fn refused(time: SimTime, refusal: &Refusal) -> Happening {
    let (word, wp) = match refusal {
        Refusal::Aborted(why) => ((*why).into(), None),
        Refusal::Geofence { wp, .. } | Refusal::BadWaypoint(wp) => (refusal.into(), Some(*wp)),
        other => (other.into(), None),
    };
    let mut happening = Happening::event(time, EventName::Refused, &[word]).saying(refusal.sentence());
    if let Some(wp) = wp {
        happening = happening.with(Field::Wp, f64::from(wp));
    }
    if let Refusal::Geofence { distance_cm, limit_m, .. } = refusal {
        happening = happening
            .with(Field::Distance, f64::from(*distance_cm) / 100.0)
            .with(Field::Limit, f64::from(*limit_m));
    }
    happening
}

/// Returns the types of the waypoints: `FLYOVER, LAND`.
fn types(plan: &crate::plan::FlightPlan) -> String {
    let names: Vec<String> = plan.waypoints.iter().map(|waypoint| waypoint.kind.to_string()).collect();
    names.join(", ")
}

fn on_off(on: bool) -> &'static str {
    if on { "on" } else { "off" }
}
