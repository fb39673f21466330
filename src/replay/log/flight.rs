//! One log of a file as a flight that is over.

use std::io;
use std::sync::Arc;

use super::{about, happenings, picture};
use crate::blackbox::decode::LogSource;
use crate::flight_log::{Extent, LogFlight, LogHome, LogSample};
use crate::replay::{Curve, CurvesRequest, Moment, Overview, PastFlight, Picture, Series};
use crate::signals::SimTime;
use crate::telemetry::Snapshot;

/// The time between two pictures, µs.
const PICTURE_US: u64 = 100_000;
/// The most pictures of a flight.
const MAX_PICTURES: u64 = 20_000;
/// The most frames of a log that is read a second time for its pictures.
const MAX_REREAD: u64 = 400_000;
/// The most frames that are read for the curve of a series.
const MAX_DRAWN: u64 = 150_000;

/// A log of a file.
pub(super) struct PastLog<S> {
    /// The name of the file in messages.
    name: Arc<str>,
    log: Arc<LogFlight>,
    source: S,
    overview: Arc<Overview>,
    /// The place of the drawn charge in the signals.
    charge: Option<usize>,
}

impl<S: LogSource + Send> PastLog<S> {
    /// Reads what a display needs of the whole log.
    ///
    /// # Errors
    /// Returns a sentence if the file cannot be read.
    pub(super) fn new(name: Arc<str>, log: Arc<LogFlight>, source: S) -> Result<Self, String> {
        let charge = log.find("charge");
        let mut past = Self { name, log, source, overview: Arc::default(), charge };
        let pictures = past.pictures().map_err(|error| past.sentence(&error))?;
        past.overview = Arc::new(past.overview_with(&pictures));
        Ok(past)
    }

    fn sentence(&self, error: &io::Error) -> String {
        format!("{} cannot be read any more: {error}.", self.name)
    }

    fn snapshot(&self, sample: &LogSample) -> Snapshot {
        snapshot(sample, self.log.home(), self.charge)
    }

    /// Returns the time between two pictures, µs.
    fn picture_interval_us(&self) -> u64 {
        let length_us = self.log.last().0.saturating_sub(self.log.first().0);
        PICTURE_US.max(length_us / MAX_PICTURES + 1)
    }

    fn pictures(&mut self) -> io::Result<Vec<Snapshot>> {
        let interval_us = self.picture_interval_us();
        if self.log.counts().main > MAX_REREAD {
            return Ok(self.coarse_pictures(interval_us));
        }
        let log = Arc::clone(&self.log);
        let (first, last) = (log.first(), log.last());
        let mut pictures = Vec::new();
        let Some(mut cursor) = log.cursor(&mut self.source, first)? else { return Ok(pictures) };
        let mut due = first;
        loop {
            cursor.advance_to(due)?;
            pictures.push(snapshot(&cursor.sample(), log.home(), self.charge));
            if due >= last {
                return Ok(pictures);
            }
            due = SimTime(due.0.saturating_add(interval_us)).min(last);
        }
    }

    /// Returns pictures of the samples that are in memory already.
    fn coarse_pictures(&self, interval_us: u64) -> Vec<Snapshot> {
        let mut next = SimTime::ZERO;
        let mut is_due = |sample: &&LogSample| {
            let is_due = sample.time >= next;
            if is_due {
                next = SimTime(sample.time.0.saturating_add(interval_us));
            }
            is_due
        };
        self.log
            .coarse_samples()
            .filter(|sample| is_due(sample))
            .map(|sample| self.snapshot(sample))
            .collect()
    }

    fn overview_with(&self, pictures: &[Snapshot]) -> Overview {
        let log = &self.log;
        let armed_at =
            pictures.iter().find(|snapshot| snapshot.craft.armed == Some(true)).map(|snapshot| snapshot.time);
        let happenings = happenings::of(log.marks(), armed_at);
        let series = log
            .signals()
            .iter()
            .map(|signal| Series { is_assumed: signal.is_assumed, ..Series::new(&signal.name, signal.unit) });
        let length_us = log.last().0.saturating_sub(log.first().0);
        Overview {
            first: log.first(),
            last: log.last(),
            frame_us: (length_us / log.counts().main.max(2).saturating_sub(1)).max(1),
            origin: log.home().map(|home| home.position),
            about: about::of(log),
            events: happenings.events,
            marks: happenings.marks,
            pictures: pictures.iter().map(Picture::of).collect(),
            series: series.collect(),
        }
    }

    /// Returns a curve with as many steps as can be read in a short time.
    fn curve(&mut self, series: usize, request: &CurvesRequest) -> io::Result<Curve> {
        let range = request.from..request.to;
        let length_us = request.to.0.saturating_sub(request.from.0);
        let frames = length_us / self.overview.frame_us.max(1);
        let known = self.log.coarse_parts(&range).max(1);
        let steps = if frames > MAX_DRAWN { request.steps.min(known) } else { request.steps };
        let extents = self.log.series(&mut self.source, series, range, steps)?;
        let steps = extents.into_iter().map(|extent| extent.map(|Extent { min, max }| (min, max))).collect();
        Ok(Curve::new(request.from, request.to, steps))
    }
}

impl<S: LogSource + Send> PastFlight for PastLog<S> {
    fn overview(&self) -> Arc<Overview> {
        Arc::clone(&self.overview)
    }

    fn at(&mut self, time: SimTime) -> Result<Moment, String> {
        let read = self.log.sample(&mut self.source, time);
        let sample = read.map_err(|error| self.sentence(&error))?.unwrap_or_default();
        let mut snapshot = self.snapshot(&sample);
        // The last frame of a log is from before the disarming that ends it.
        if happenings::is_disarmed(self.log.marks(), time) {
            snapshot.craft.armed = Some(false);
        }
        Ok(Moment { snapshot, values: sample.values })
    }

    fn curves(&mut self, request: &CurvesRequest) -> Result<Vec<Curve>, String> {
        let count = self.overview.series.len();
        let series = request.series.iter().filter(|series| **series < count);
        let curves: io::Result<_> = series.map(|series| self.curve(*series, request)).collect();
        curves.map_err(|error| self.sentence(&error))
    }
}

/// Returns the craft of a sample. `charge` is the place of the drawn charge in its values.
fn snapshot(sample: &LogSample, home: Option<LogHome>, charge: Option<usize>) -> Snapshot {
    let drawn_mah = charge.and_then(|charge| sample.values.get(charge)).copied();
    picture::of(sample, home, drawn_mah.filter(|drawn| drawn.is_finite()))
}
