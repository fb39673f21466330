//! The sticks of a log for a simulated craft, and the track that it flies with them.

use super::north_east;
use crate::events::{Event, SessionEvent};
use crate::files::recording_file::Recorder;
use crate::flight::{Flight, FlightEnd};
use crate::flight_log::LogSticks;
use crate::process::error::AppError;
use crate::recording::End;
use crate::report::compare::{Landing, Track};
use crate::report::route::TrackSample;
use crate::runner::Subscriber;
use crate::signals::SimTime;
use crate::telemetry::{EventKind, FirmwareEvent};
use crate::vehicle::{Vehicle, VehicleCommand};

/// The interval between two samples of the track, µs.
const INTERVAL_US: u64 = 50_000;
/// A log that begins this soon after boot is flown again at the same times since boot, µs.
const SAME_BOOT_US: u64 = 120_000_000;
/// The time for the craft to become ready, µs.
const READY_US: u64 = 180_000_000;
/// The time that is flown after the last frame of the log, µs.
const AFTER_US: u64 = 2_000_000;

/// Moves the sticks as in a log, and records the track.
pub(super) struct Feed {
    sticks: LogSticks,
    /// The least time since boot at which the sticks begin to move.
    earliest: SimTime,
    /// The time at which they began.
    started: Option<SimTime>,
    /// The time from the start of the log to that of the comparison, µs.
    begin_us: u64,
    /// Altitude of the craft on the ground at home, m.
    standing_m: f64,
    track: Track,
    /// `true` if the craft was disarmed since the last look. A log has no other sign of the end of its flight.
    has_disarmed: bool,
    /// The recording of the simulated flight, if one is wanted.
    recorder: Option<Recorder>,
    /// The error that ended the recording and the flight.
    problem: Option<AppError>,
    /// `true` once the log is over, or if the craft does not become ready.
    is_over: bool,
}

impl Feed {
    /// Returns the sticks before their flight. `first` is the time of the first frame of the log. The comparison begins
    /// `begin_us` later, and its altitudes count from that of the craft on the ground.
    pub(super) fn new(
        sticks: LogSticks,
        first: SimTime,
        (begin_us, standing_m): (u64, f64),
        recorder: Option<Recorder>,
    ) -> Self {
        Self {
            sticks,
            earliest: if first.0 <= SAME_BOOT_US { first } else { SimTime::ZERO },
            started: None,
            begin_us,
            standing_m,
            track: Track::default(),
            has_disarmed: false,
            recorder,
            problem: None,
            is_over: false,
        }
    }

    /// Checks that the sticks were moved.
    ///
    /// # Errors
    /// Returns the reason why the craft did not become ready, or why the flight could not be recorded.
    pub(super) fn check(&mut self, vehicle: &Vehicle) -> Result<(), AppError> {
        if let Some(problem) = self.problem.take() {
            return Err(problem);
        }
        if self.started.is_some() {
            return Ok(());
        }
        let view = vehicle.controller().craft_view();
        let flags: Vec<String> = view.arming_flags().iter().map(|flag| flag.to_string()).collect();
        let reason = if flags.is_empty() { "it has no fix".to_owned() } else { flags.join(", ") };
        Err(AppError::input(format!(
            "the simulated craft cannot be armed with the settings of the log: {reason}"
        )))
    }

    /// Ends the recording, and returns the track of the finished flight.
    ///
    /// # Errors
    /// Returns an error if the recording cannot be written.
    pub(super) fn finish(self, end: &FlightEnd, seed: u64) -> Result<Track, AppError> {
        let begin = self.started.map_or(0, |started| started.0 + self.begin_us);
        let flown_s = end.time.seconds_since(SimTime(begin));
        let (result, reason) = (end.verdict.result.to_string(), end.verdict.reason.clone());
        if let Some(recorder) = self.recorder {
            let (result, reason) = (result.clone(), reason.clone());
            recorder.finish(End { t: end.time, result, reason, flown_s, hash: None })?;
        }
        Ok(Track { seed, result, reason, flown_s: Some(flown_s), ..self.track })
    }

    /// Moves the sticks to their place at this time.
    fn move_sticks(&mut self, vehicle: &mut Vehicle) {
        let now = vehicle.time();
        if self.started.is_none() && now >= self.earliest {
            let view = vehicle.controller().craft_view();
            self.started = (view.has_fix() && view.arming_flags().is_empty()).then_some(now);
        }
        let Some(started) = self.started else {
            self.is_over = now.0 > self.earliest.0 + READY_US;
            return;
        };
        let since_us = now.0 - started.0;
        self.is_over = since_us > self.sticks.length().0 + AFTER_US;
        let Some(sticks) = self.sticks.at(since_us).copied() else { return };
        let is_cut = sticks.frame.is_none();
        if vehicle.transmitter().is_cut() != is_cut {
            vehicle.apply(&VehicleCommand::CutRc(is_cut));
        }
        if let Some(frame) = sticks.frame
            && vehicle.transmitter().sticks() != frame
        {
            vehicle.apply(&VehicleCommand::Sticks(frame));
        }
    }
}

impl Subscriber<Flight> for Feed {
    fn before_tick(&mut self, vehicle: &mut Vehicle) {
        self.move_sticks(vehicle);
        if let Some(recorder) = &mut self.recorder {
            recorder.before_tick(vehicle);
        }
    }

    fn event(&mut self, event: &Event) {
        if let Some(recorder) = &mut self.recorder {
            recorder.event(event);
        }
        self.has_disarmed |=
            matches!(event.kind, SessionEvent::Vehicle(EventKind::Firmware(FirmwareEvent::Disarmed(_))));
    }

    fn after_tick(&mut self, flight: &Flight) {
        if let Some(Err(problem)) =
            self.recorder.as_mut().map(|recorder| recorder.after_tick(flight.vehicle(), false))
        {
            self.problem.get_or_insert(problem);
        }
        let has_disarmed = std::mem::take(&mut self.has_disarmed);
        let now = flight.vehicle().time();
        let (Some(started), Some(truth)) = (self.started, flight.vehicle().truth()) else { return };
        let begin = SimTime(started.0 + self.begin_us);
        if now < begin {
            return;
        }
        let (time_s, ne) = (now.seconds_since(begin), north_east(truth.pos_enu));
        if has_disarmed {
            self.track.touchdown = Some(Landing::from_disarming(time_s, ne));
        }
        if now.0.is_multiple_of(INTERVAL_US) {
            let (alt_m, attitude) = (truth.pos_enu.z - self.standing_m, Some(truth.into()));
            self.track.samples.push(TrackSample { time_s, ne, alt_m, attitude });
        }
    }

    fn goes_on(&self) -> bool {
        !self.is_over && self.problem.is_none()
    }
}
