//! The record of a flight that is over, from what a display knows of it.

use super::{FlightRecord, MAX_SAMPLES, RecordedSample, push_bounded};
use crate::events::{Event, SessionEvent};
use crate::replay::{Overview, PastEventKind, Picture};
use crate::report::sentence;
use crate::signals::SimTime;

impl FlightRecord {
    /// Returns the record of a flight that is over.
    pub fn from_past(overview: &Overview) -> Self {
        let mut record = Self { begins_at: Some(overview.first), ..Self::default() };
        for about in &overview.about {
            record.note_past(overview.first, about);
        }
        for event in &overview.events {
            record.note_past(event.time, &event.kind);
        }
        let every = overview.pictures.len().div_ceil(MAX_SAMPLES).max(1);
        let (mut transitions, mut state) = (record.transitions.iter().peekable(), None);
        let sample = |picture: &Picture| {
            while let Some(transition) = transitions.next_if(|transition| transition.time <= picture.time) {
                state = Some(transition.to);
            }
            let (time, modes) = (picture.time, picture.modes);
            RecordedSample { time, values: *picture.values(), state, modes }
        };
        record.samples = overview.pictures.iter().step_by(every).map(sample).collect();
        record
    }

    fn note_past(&mut self, time: SimTime, kind: &PastEventKind) {
        match kind {
            PastEventKind::Vehicle(kind) => {
                self.note(&Event { time, kind: SessionEvent::Vehicle(kind.clone()) });
            }
            PastEventKind::Warning(text) | PastEventKind::Notice(text) => {
                push_bounded(&mut self.sentences, (time, sentence::sentence_end(text)), &mut self.is_cut);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::replay::PastEvent;
    use crate::telemetry::snapshot::EstimateView;
    use crate::telemetry::{EventKind, FirmwareEvent, NavEvent, NavState, Snapshot, TransitionReason};

    fn at(seconds: u64) -> SimTime {
        SimTime(seconds * 1_000_000)
    }

    #[test]
    fn samples_have_the_state_of_the_last_transition_and_times_since_the_beginning() {
        let picture = |second| {
            let estimate = EstimateView { n: Some(second as f64), e: Some(0.0), ..EstimateView::default() };
            Picture::of(&Snapshot { time: at(second), estimate, ..Snapshot::default() })
        };
        let state = NavEvent::State {
            from: NavState::Idle,
            to: NavState::Approaching,
            wp: 0,
            kind: None,
            reason: TransitionReason::Reset,
            guard: None,
            target: LatLon::default(),
            target_alt_m: 3.0,
        };
        let overview = Overview {
            first: at(10),
            about: vec![PastEventKind::Notice("Written by someone".to_owned())],
            events: vec![PastEvent {
                time: at(12),
                kind: PastEventKind::Vehicle(EventKind::Firmware(FirmwareEvent::Nav(state))),
            }],
            pictures: (10..15).map(picture).collect(),
            ..Overview::default()
        };
        let record = FlightRecord::from_past(&overview);
        let known: Vec<bool> = record.samples.iter().map(|sample| sample.state.is_some()).collect();
        assert_eq!(known, [false, false, true, true, true]);
        assert_eq!(record.place(&record.samples[4]), Some([14.0, 0.0]));
        assert_eq!(record.sentences[0], (at(10), "Written by someone.".to_owned()));
        assert!((record.seconds(at(12)) - 2.0).abs() < 1e-9);
    }
}
