//! Shows a recorded flight from the pictures in its recording.

use std::sync::Arc;

use crate::recording::{Happened, Picture as Recorded, Recording};
use crate::replay::{
    Curve, CurvesRequest, Moment, Overview, PastEvent, PastEventKind, PastFlight, Picture, Series,
};
use crate::signals::SimTime;
use crate::telemetry::signal::{Observed, SIGNALS, Signal, SignalInfo};
use crate::timeline::Marks;

/// The usual time between two pictures, µs.
const FRAME_US: u64 = 100_000;
/// The most pictures for a display.
const MAX_PICTURES: usize = 20_000;
/// The most steps of a curve.
const MAX_STEPS: usize = 10_000;

/// A recorded flight with at least one picture.
pub(super) struct PastRecording {
    recording: Arc<Recording>,
    /// The signals that it has.
    signals: Vec<Signal>,
    overview: Arc<Overview>,
}

impl PastRecording {
    pub(super) fn new(recording: Arc<Recording>) -> Self {
        let pictures = recording.pictures.all();
        let step = pictures.len().div_ceil(MAX_PICTURES).max(1);
        let shown: Vec<Picture> =
            pictures.iter().step_by(step).map(|recorded| Picture::of(&recorded.snapshot())).collect();
        let signals: Vec<&SignalInfo> = SIGNALS
            .iter()
            .filter(|info| shown.iter().any(|shown| shown.value(info.signal).is_some()))
            .collect();
        let time = |picture: Option<&Recorded>| picture.map_or(SimTime::ZERO, Recorded::time);
        let mut events: Vec<PastEvent> = recording
            .events
            .iter()
            .map(|event| PastEvent { time: event.time, kind: kind(&event.what) })
            .collect();
        events.sort_by_key(|event| event.time);
        let mut marks = Marks::default();
        for event in &events {
            if let PastEventKind::Vehicle(kind) = &event.kind {
                marks.note(event.time, kind);
            }
        }
        let overview = Overview {
            first: time(pictures.first()),
            last: time(pictures.last()),
            frame_us: FRAME_US,
            origin: pictures.iter().find_map(|recorded| recorded.snapshot().origin),
            about: about(&recording),
            events,
            marks,
            series: signals.iter().map(|info| series(info)).collect(),
            pictures: shown,
        };
        let signals = signals.iter().map(|info| info.signal).collect();
        Self { recording, signals, overview: Arc::new(overview) }
    }

    /// Returns the least and the greatest value in each step of a request.
    fn curve(&self, signal: Signal, request: &CurvesRequest) -> Curve {
        let pictures = self.recording.pictures.all();
        let from = pictures.partition_point(|picture| picture.time() < request.from);
        let to = pictures.partition_point(|picture| picture.time() < request.to);
        let count = request.steps.clamp(1, MAX_STEPS);
        let length_us = u128::from(request.to.0.saturating_sub(request.from.0)).max(1);
        let mut steps: Vec<Option<(f64, f64)>> = vec![None; count];
        for picture in pictures.get(from..to).unwrap_or_default() {
            let Some(value) = value(picture, signal) else { continue };
            let since_us = u128::from(picture.time().0.saturating_sub(request.from.0));
            let at = usize::try_from(since_us * count as u128 / length_us).unwrap_or(usize::MAX);
            if let Some(step) = steps.get_mut(at) {
                let (least, greatest) = step.unwrap_or((value, value));
                *step = Some((least.min(value), greatest.max(value)));
            }
        }
        Curve::new(request.from, request.to, steps)
    }
}

impl PastFlight for PastRecording {
    fn overview(&self) -> Arc<Overview> {
        Arc::clone(&self.overview)
    }

    fn at(&mut self, time: SimTime) -> Result<Moment, String> {
        let Some(recorded) = self.recording.pictures.at(time) else { return Ok(Moment::default()) };
        let snapshot = recorded.snapshot();
        let observed = Observed::of(&snapshot);
        let values = self.signals.iter().map(|signal| signal.read(&observed).unwrap_or(f64::NAN)).collect();
        Ok(Moment { values, snapshot })
    }

    fn curves(&mut self, request: &CurvesRequest) -> Result<Vec<Curve>, String> {
        let signals = request.series.iter().filter_map(|series| self.signals.get(*series));
        Ok(signals.map(|signal| self.curve(*signal, request)).collect())
    }
}

fn value(picture: &Recorded, signal: Signal) -> Option<f64> {
    signal.read(&Observed::of(&picture.snapshot())).filter(|value| value.is_finite())
}

fn series(info: &SignalInfo) -> Series {
    Series::new(info.name, info.dimension.unit().map_or("", |unit| unit.name))
}

fn kind(what: &Happened) -> PastEventKind {
    match what {
        Happened::Vehicle(kind) => PastEventKind::Vehicle(kind.clone()),
        Happened::Notice(text) => PastEventKind::Notice(text.clone()),
    }
}

/// Returns sentences about a recording: its source, its result, and what is missing or damaged.
fn about(recording: &Recording) -> Vec<PastEventKind> {
    let header = &recording.header;
    let plan = if header.plan.is_empty() { String::new() } else { format!(", plan {}", header.plan) };
    let written = format!("Recorded by betadeck {} on {}{plan}.", header.program, header.date);
    let result = recording.end.as_ref().map(|end| format!("Result: {}, {}.", end.result, end.reason));
    let notices = std::iter::once(written).chain(result).map(PastEventKind::Notice);
    notices.chain(recording.notices().into_iter().map(PastEventKind::Warning)).collect()
}
