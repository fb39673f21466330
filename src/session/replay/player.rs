//! The play head of a recorded flight.

use std::sync::Arc;
use std::time::Duration;

use super::ReplayStart;
use crate::replay::{Curve, CurvesRequest, Moment, Overview, PastFlight};
use crate::runner::Pacer;
use crate::runner::SPEED_RANGE;
use crate::session::command::Seek;
use crate::session::seek::{Target, target};
use crate::signals::SimTime;
use crate::telemetry::Snapshot;

/// The step of the play head, µs.
const STEP_US: u64 = 1000;

/// Plays a recorded flight.
pub(super) struct Player {
    flight: Box<dyn PastFlight>,
    overview: Arc<Overview>,
    shown: SimTime,
    picture: Arc<Snapshot>,
    values: Arc<Vec<f64>>,
    pacer: Pacer,
    /// The wanted multiple of real time, which may be infinite.
    speed: f64,
    /// `true` once the record could not be read.
    is_broken: bool,
}

impl Player {
    /// Returns a player at the start of a flight. Without a start it plays from the first instant.
    pub(super) fn new(
        mut flight: Box<dyn PastFlight>,
        start: Option<ReplayStart>,
        speed: f64,
        now: Duration,
    ) -> Result<Self, String> {
        let overview = flight.overview();
        let shown = match start {
            None => overview.first,
            Some(ReplayStart::Clock(time)) => time,
            Some(ReplayStart::Seconds(seconds)) => {
                SimTime(overview.first.0.saturating_add(SimTime::from_secs_f64(seconds.max(0.0)).0))
            }
        };
        let shown = shown.clamp(overview.first, overview.last.max(overview.first));
        let (picture, values) = moment_at(&mut *flight, shown)?;
        let mut player = Self {
            flight,
            overview,
            shown,
            picture,
            values,
            pacer: Pacer::new(STEP_US, speed),
            speed,
            is_broken: false,
        };
        player.set_speed(speed, now);
        player.pacer.set_paused(start.is_some() || player.is_at_end(), now);
        Ok(player)
    }

    pub(super) fn overview(&self) -> Arc<Overview> {
        Arc::clone(&self.overview)
    }

    /// Returns the shown instant.
    pub(super) fn shown(&self) -> SimTime {
        self.shown
    }

    pub(super) fn picture(&self) -> Arc<Snapshot> {
        Arc::clone(&self.picture)
    }

    /// Returns the values of all series.
    pub(super) fn values(&self) -> Arc<Vec<f64>> {
        Arc::clone(&self.values)
    }

    pub(super) fn is_playing(&self) -> bool {
        !self.pacer.is_paused()
    }

    /// Returns the wanted multiple of real time.
    pub(super) fn speed(&self) -> f64 {
        self.speed
    }

    pub(super) fn speed_achieved(&self) -> f64 {
        self.pacer.achieved()
    }

    fn is_at_end(&self) -> bool {
        self.shown >= self.overview.last
    }

    /// Plays at another speed. As fast as possible is the fastest that can be seen.
    pub(super) fn set_speed(&mut self, speed: f64, now: Duration) {
        self.speed = speed;
        self.pacer.set_speed(if speed.is_infinite() { *SPEED_RANGE.end() } else { speed }, now);
    }

    /// Pauses, or goes on. At the end it begins again.
    pub(super) fn pause(&mut self, paused: bool, now: Duration) -> Result<(), String> {
        if !paused && self.is_at_end() {
            self.show(self.overview.first)?;
        }
        self.pacer.set_paused(paused, now);
        Ok(())
    }

    /// Pauses, and shows the instant this many records later.
    pub(super) fn step(&mut self, records: u32, now: Duration) -> Result<(), String> {
        self.pacer.set_paused(true, now);
        let by_us = self.overview.frame_us.max(1).saturating_mul(u64::from(records));
        self.show(SimTime(self.shown.0.saturating_add(by_us)))
    }

    /// Advances to the instant that is due. Returns `true` if another instant is shown.
    pub(super) fn play(&mut self, now: Duration) -> Result<bool, String> {
        let due = self.pacer.due(now, u64::MAX);
        self.pacer.ran(due, now);
        if due == 0 {
            return Ok(false);
        }
        self.show(SimTime(self.shown.0.saturating_add(due.saturating_mul(STEP_US))))?;
        if self.is_at_end() {
            self.pacer.set_paused(true, now);
        }
        Ok(true)
    }

    /// Shows another instant. Returns a sentence for the user if there is something to say.
    pub(super) fn seek(&mut self, seek: Seek, now: Duration) -> Result<Option<&'static str>, String> {
        let (first, last) = (self.overview.first, self.overview.last);
        // A jump by time goes on playing, a jump to an event stops there.
        if !matches!(seek, Seek::Seconds(_) | Seek::Time(_)) {
            self.pacer.set_paused(true, now);
        }
        let to = match target(seek, self.shown, last, &self.overview.marks) {
            Target::Newest => last,
            Target::Nowhere(sentence) => return Ok(Some(sentence)),
            Target::At(time) => time,
        };
        if to >= last && self.is_at_end() {
            return Ok(Some("This is the end of the recorded flight."));
        }
        self.show(to)?;
        if self.is_at_end() {
            self.pacer.set_paused(true, now);
        }
        Ok((to < first).then_some("The recorded flight begins here."))
    }

    /// Reads a part of the series.
    pub(super) fn curves(&mut self, request: &CurvesRequest) -> Result<Vec<Curve>, String> {
        self.flight.curves(request)
    }

    /// Stops for good, because the record cannot be read. Returns `true` the first time.
    pub(super) fn halt(&mut self, now: Duration) -> bool {
        self.pacer.set_paused(true, now);
        !std::mem::replace(&mut self.is_broken, true)
    }

    fn show(&mut self, time: SimTime) -> Result<(), String> {
        let time = time.clamp(self.overview.first, self.overview.last.max(self.overview.first));
        if time != self.shown {
            (self.picture, self.values) = moment_at(&mut *self.flight, time)?;
            self.shown = time;
            // A flight that can be read again is reported again if it fails again.
            self.is_broken = false;
        }
        Ok(())
    }
}

/// Returns the flight at an instant, with the time of that instant rather than that of the record before it.
fn moment_at(flight: &mut dyn PastFlight, time: SimTime) -> Result<(Arc<Snapshot>, Arc<Vec<f64>>), String> {
    let Moment { snapshot, values } = flight.at(time)?;
    Ok((Arc::new(Snapshot { time, ..snapshot }), Arc::new(values)))
}
