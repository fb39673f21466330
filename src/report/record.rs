//! The record of a flight for reports, in bounded memory: samples, transitions of the state machine, sentences.
//!
//! A flight fills it with its events and snapshots. Whatever else knows a flight, such as a log, can fill it, too.

mod past;

use super::sentence;
use crate::events::{Event, SessionEvent};
use crate::plan::WaypointType;
use crate::signals::SimTime;
use crate::telemetry::signal::{Observed, Signal, SignalValues};
use crate::telemetry::snapshot::{Snapshot, WorldView};
use crate::telemetry::{EventKind, FirmwareEvent, Guard, ModeFlags, NavEvent, NavState, TransitionReason};

/// The most samples. When they are reached, every second one is dropped and the interval doubles.
const MAX_SAMPLES: usize = 12_000;
/// The most transitions, and the most sentences.
const MAX_LINES: usize = 4_000;
/// The interval of the samples of a short flight, µs.
const INTERVAL_US: u64 = 100_000;

/// The record.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlightRecord {
    /// Samples at equal intervals, oldest first.
    pub samples: Vec<RecordedSample>,
    /// Transitions, oldest first.
    pub transitions: Vec<Transition>,
    /// The other events as sentences, oldest first.
    pub sentences: Vec<(SimTime, String)>,
    /// The beginning of the record of a flight that is over. Its times count from there.
    pub begins_at: Option<SimTime>,
    /// The time of the first engagement.
    pub engaged_at: Option<SimTime>,
    /// The time of the first arming.
    pub armed_at: Option<SimTime>,
    /// The time of the last touchdown.
    pub touchdown_at: Option<SimTime>,
    /// Seed, steps a second and airframe.
    pub boot: Option<Boot>,
    /// The air at the first sample.
    pub world: Option<WorldView>,
    /// `true` if there were more transitions or sentences than are kept.
    pub is_cut: bool,
    /// How often the interval of the samples was doubled, because the flight was long.
    pub doubled: u32,
}

/// The state of a flight at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordedSample {
    pub time: SimTime,
    pub values: SignalValues,
    /// The state of the state machine, if it is known.
    pub state: Option<NavState>,
    /// The active modes, if they are known.
    pub modes: Option<ModeFlags>,
}

/// A transition of the state machine.
#[derive(Debug, Clone, PartialEq)]
pub struct Transition {
    pub time: SimTime,
    pub from: NavState,
    pub to: NavState,
    /// Index of the waypoint in the active plan.
    pub wp: u8,
    /// Type of the waypoint, if there is one.
    pub kind: Option<WaypointType>,
    pub reason: TransitionReason,
    /// The guard that fired, if there is one.
    pub guard: Option<Guard>,
}

/// The start of a simulated flight.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Boot {
    pub seed: u64,
    pub rate_hz: u32,
    pub airframe: String,
}

impl FlightRecord {
    /// Adds an event.
    pub fn note(&mut self, event: &Event) {
        if let SessionEvent::Vehicle(kind) = &event.kind {
            self.note_vehicle(event.time, kind);
        }
        let is_transition = matches!(
            event.kind,
            SessionEvent::Vehicle(EventKind::Firmware(FirmwareEvent::Nav(NavEvent::State { .. })))
        );
        if is_transition {
            return;
        }
        if let Some(text) = sentence::text(&event.kind) {
            push_bounded(&mut self.sentences, (event.time, text), &mut self.is_cut);
        }
    }

    fn note_vehicle(&mut self, time: SimTime, kind: &EventKind) {
        match kind {
            EventKind::Boot { seed, rate_hz, airframe, .. } => {
                self.boot = Some(Boot { seed: *seed, rate_hz: *rate_hz, airframe: airframe.clone() });
            }
            EventKind::Touchdown { .. } => self.touchdown_at = Some(time),
            EventKind::Firmware(FirmwareEvent::Armed) => {
                self.armed_at.get_or_insert(time);
            }
            EventKind::Firmware(FirmwareEvent::Nav(NavEvent::State {
                from,
                to,
                wp,
                kind,
                reason,
                guard,
                ..
            })) => {
                let (from, to, wp, kind, reason) = (*from, *to, *wp, *kind, *reason);
                let transition = Transition { time, from, to, wp, kind, reason, guard: *guard };
                push_bounded(&mut self.transitions, transition, &mut self.is_cut);
            }
            EventKind::Firmware(_)
            | EventKind::Fault { .. }
            | EventKind::Contact { .. }
            | EventKind::Crash { .. }
            | EventKind::BatteryEmpty { .. }
            | EventKind::Notice(_) => {}
        }
    }

    /// Returns `true` if a sample is due after a tick of this length, µs.
    pub fn is_due(&self, now: SimTime, step_us: u64) -> bool {
        let every_us = INTERVAL_US << self.doubled;
        now.0 / every_us != now.0.saturating_sub(step_us) / every_us
    }

    /// Adds a sample.
    pub fn sample(&mut self, snapshot: &Snapshot, engaged_at: Option<SimTime>) {
        self.engaged_at = self.engaged_at.or(engaged_at);
        self.world.get_or_insert_with(|| snapshot.world.clone());
        let observed = Observed { engaged_at, ..Observed::of(snapshot) };
        let (state, modes) = (snapshot.nav.as_ref().map(|nav| nav.state), snapshot.craft.modes);
        let values = SignalValues::of(&observed);
        self.samples.push(RecordedSample { time: snapshot.time, values, state, modes });
        if self.samples.len() >= MAX_SAMPLES {
            // The samples that stay are those that are due at the longer interval.
            let mut keep = true;
            self.samples.retain(|_| {
                keep = !keep;
                keep
            });
            self.doubled += 1;
        }
    }

    /// Returns the seconds since the beginning of the record of a flight that is over; of another flight since the first
    /// engagement, or since boot if there was none.
    pub fn seconds(&self, time: SimTime) -> f64 {
        time.as_secs_f64() - self.begins_at.or(self.engaged_at).map_or(0.0, SimTime::as_secs_f64)
    }

    /// Returns the known values of a signal.
    pub fn values(&self, signal: Signal) -> impl Iterator<Item = f64> + '_ {
        let values = self.samples.iter().map(move |sample| sample.values.get(signal));
        values.filter(|value| value.is_finite())
    }

    /// Returns the horizontal place of the craft at a sample, m north and east of the boot place: the true one, or that
    /// of the estimator if the truth is unknown.
    pub fn place(&self, sample: &RecordedSample) -> Option<[f64; 2]> {
        [[Signal::North, Signal::East], [Signal::EstNorth, Signal::EstEast]]
            .map(|signals| signals.map(|signal| sample.values.get(signal)))
            .into_iter()
            .find(|place| place.iter().all(|value| value.is_finite()))
    }
}

fn push_bounded<T>(list: &mut Vec<T>, item: T, is_cut: &mut bool) {
    if list.len() < MAX_LINES {
        list.push(item);
    } else {
        *is_cut = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::snapshot::TruthView;

    fn at(time: SimTime) -> Snapshot {
        let truth = Some(TruthView { n: time.as_secs_f64(), ..TruthView::default() });
        Snapshot { time, truth, ..Snapshot::default() }
    }

    #[test]
    fn a_long_flight_takes_no_more_memory_than_a_short_one() {
        let mut record = FlightRecord::default();
        let step_us = 2_000;
        for tick in 0..3_600_000_u64 {
            let now = SimTime(tick * step_us);
            if record.is_due(now, step_us) {
                record.sample(&at(now), None);
            }
        }
        assert!((MAX_SAMPLES / 2..=MAX_SAMPLES).contains(&record.samples.len()));
        let gaps: Vec<u64> = record.samples.windows(2).map(|pair| pair[1].time.0 - pair[0].time.0).collect();
        assert!(gaps.iter().all(|gap| *gap == gaps[0]), "equal intervals");
        assert!(record.samples.last().expect("samples").time > SimTime(7_190_000_000));
    }

    #[test]
    fn transitions_have_their_guards_and_all_other_events_are_sentences() {
        let mut record = FlightRecord::default();
        let nav = |event| SessionEvent::Vehicle(EventKind::Firmware(FirmwareEvent::Nav(event)));
        record.note(&Event { time: SimTime(5), kind: nav(NavEvent::Climbing(true)) });
        record.note(&Event::notice(SimTime(7), "A notice"));
        let state = NavEvent::State {
            from: NavState::Idle,
            to: NavState::Approaching,
            wp: 0,
            kind: Some(WaypointType::Land),
            reason: TransitionReason::Reset,
            guard: None,
            target: crate::geo::LatLon::default(),
            target_alt_m: 3.0,
        };
        record.note(&Event { time: SimTime(9), kind: nav(state) });
        assert_eq!(record.transitions.len(), 1);
        let texts: Vec<&str> = record.sentences.iter().map(|(_, text)| text.as_str()).collect();
        assert_eq!(texts, ["Climbing to the minimum altitude first.", "A notice."]);
        for _ in 0..=MAX_LINES {
            record.note(&Event::notice(SimTime(7), "A notice"));
        }
        assert!(record.is_cut && record.sentences.len() == MAX_LINES);
    }

    #[test]
    fn the_place_is_the_estimate_if_the_truth_is_unknown() {
        let mut record = FlightRecord::default();
        let mut snapshot = Snapshot::default();
        snapshot.estimate.n = Some(3.0);
        snapshot.estimate.e = Some(4.0);
        record.sample(&snapshot, None);
        assert_eq!(record.place(&record.samples[0]), Some([3.0, 4.0]));
        record.sample(&at(SimTime(8_000_000)), None);
        assert_eq!(record.place(&record.samples[1]), Some([8.0, 0.0]));
    }
}
