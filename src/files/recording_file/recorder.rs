//! The recording of a headless flight: `fly --record`, `compare --log LOG --record`.

use std::io::Write as _;
use std::path::Path;

use super::{header, recorded};
use crate::events::Event;
use crate::files::output_file::{StreamedOutput, write_failed};
use crate::flight::FlightSetup;
use crate::process::error::AppError;
use crate::recording::{Cadence, End, FlightPrint, Seen, Setup, Writer};
use crate::signals::SimTime;
use crate::vehicle::Vehicle;

/// A recording that grows with its flight. After a kill it is readable up to its last second.
pub(crate) struct Recorder {
    writer: Writer,
    file: StreamedOutput,
    cadence: Cadence,
    print: FlightPrint,
    /// `true` once a picture had no number, so the flight has no hash.
    is_unknown: bool,
    flushed_at: SimTime,
}

/// Simulated time between two writes, µs.
const FLUSH_US: u64 = 1_000_000;

impl Recorder {
    /// Begins the file of a flight. If an earlier one has that name, it is replaced.
    pub(crate) fn begin(path: &Path, setup: &FlightSetup) -> Result<Self, AppError> {
        let mut writer = Writer::new(header(&setup.plan.name));
        writer.setup(&Setup::from(setup));
        writer.begin(SimTime::ZERO);
        let file = StreamedOutput::begin_with(path, &writer.flush())?;
        let (cadence, print) = (Cadence::default(), FlightPrint::default());
        Ok(Self { writer, file, cadence, print, is_unknown: false, flushed_at: SimTime::ZERO })
    }

    pub(crate) fn event(&mut self, event: &Event) {
        if let Some(event) = recorded(event) {
            self.writer.event(&event);
        }
    }

    /// Records the inputs since the last tick.
    pub(crate) fn before_tick(&mut self, vehicle: &mut Vehicle) {
        let now = vehicle.time();
        vehicle.take_inputs(|input| self.writer.input(now, &input));
    }

    /// Records a picture if one is due or if it is the last one, and writes what there is once a second.
    pub(crate) fn after_tick(&mut self, vehicle: &Vehicle, is_last: bool) -> Result<(), AppError> {
        if let Some(seen) = self.cadence.due(vehicle).or_else(|| is_last.then(|| Seen::of(vehicle))) {
            match seen.print {
                Some(print) => self.print.add(vehicle.time(), print),
                None => self.is_unknown = true,
            }
            self.writer.picture(seen);
        }
        if vehicle.time().0 < self.flushed_at.0 + FLUSH_US {
            return Ok(());
        }
        self.flushed_at = vehicle.time();
        let bytes = self.writer.flush();
        self.file.write_all(&bytes).and_then(|()| self.file.flush()).map_err(write_failed)
    }

    /// Ends the file.
    pub(crate) fn finish(mut self, end: End) -> Result<(), AppError> {
        let hash = (!self.is_unknown).then(|| self.print.text());
        let bytes = self.writer.finish(End { hash, ..end });
        self.file.add(&bytes)?;
        self.file.finish()
    }
}
