//! The outputs of a headless flight: lines, a track, and the last lines on standard error.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::watched::WatchedFlight;
use crate::app::error::{self, AppError};
use crate::app::firmware::reported;
use crate::app::output_file::{self, StreamedOutput};
use crate::app::patient_output::PatientOutput;
use crate::app::setup;
use crate::args::{FlyArgs, OutputFile};
use crate::plan::format::PlanFile;
use crate::report::{
    End, GpxHeader, GpxPoint, GpxWriter, Track, TrackPoint, UtcSeconds, json, sentence, truth,
};
use crate::session::{Event, Flying as _, Subscriber};
use crate::signals::SimTime;
use crate::text::printable;
use crate::vehicle::Vehicle;

/// The messages before a flight with a remote firmware. The files begin with the flight.
#[derive(Debug)]
pub(super) struct Prelude<'a> {
    args: &'a FlyArgs,
    /// The first events of the JSON lines.
    held: Vec<Event>,
    problem: Option<AppError>,
}

impl<'a> Prelude<'a> {
    /// Creates the messages before the flight of these options.
    pub(super) fn new(args: &'a FlyArgs) -> Self {
        Self { args, held: Vec::new(), problem: None }
    }

    /// Reports an event: as a sentence on standard output, or, with JSON, on standard error until the lines begin.
    pub(super) fn write(&mut self, event: &Event) -> Result<(), AppError> {
        if self.args.json.is_some() {
            reported::tell(event);
            self.held.push(event.clone());
        } else if let Some(line) = sentence::line(event) {
            error::write_stdout(format!("{}\n", printable::line(&line)).as_bytes())?;
        }
        Ok(())
    }

    /// Returns the error with which an event could not be reported, if there was one.
    pub(super) fn check(&mut self) -> Result<(), AppError> {
        self.problem.take().map_or(Ok(()), Err)
    }

    /// Opens the outputs at the beginning of the flight.
    pub(super) fn open(self, vehicle: &Vehicle, plan: &PlanFile) -> Result<Output, AppError> {
        let mut output = Output::open(self.args, vehicle, plan)?;
        self.held.iter().try_for_each(|event| output.write(event))?;
        output.flush()?;
        Ok(output)
    }
}

impl Subscriber<Vehicle> for Prelude<'_> {
    fn event(&mut self, event: &Event) {
        if let Err(problem) = self.write(event) {
            self.problem.get_or_insert(problem);
        }
    }

    fn goes_on(&self) -> bool {
        self.problem.is_none()
    }
}

/// Checks that no output replaces a file that must be kept. If all outputs are allowed, removes the results of an
/// earlier flight, because this flight may fail before it begins.
pub(super) fn claim(args: &FlyArgs) -> Result<(), AppError> {
    let mut kept = setup::kept_files(&args.flight, Some(&args.plan));
    if let Some(OutputFile::File(path)) = &args.json {
        kept.claim("--json", path)?;
    }
    if let Some(path) = &args.gpx {
        kept.claim("--gpx", path)?;
    }
    if let Some(path) = &args.kml {
        kept.claim("--kml", path)?;
    }
    if let Some(path) = &args.geojson {
        kept.claim("--geojson", path)?;
    }
    files(args).for_each(output_file::remove_results);
    Ok(())
}

/// Returns the output files of the options.
fn files(args: &FlyArgs) -> impl Iterator<Item = &Path> {
    let json = match &args.json {
        Some(OutputFile::File(path)) => Some(path.as_path()),
        Some(OutputFile::Stdout) | None => None,
    };
    json.into_iter().chain(args.gpx.as_deref()).chain(args.kml.as_deref()).chain(args.geojson.as_deref())
}

/// The outputs of the flight.
pub(super) struct Output {
    lines: Option<Lines>,
    /// `true` for JSON lines, `false` for sentences.
    json: bool,
    /// The interval of the samples, µs; `None` = no samples.
    sample_every_us: Option<u64>,
    gpx: Option<GpxWriter<StreamedOutput>>,
    track: Option<TrackFiles>,
    /// `true` after the end of the flight: only its end remains to be reported.
    is_over: bool,
    /// The first error. The flight stops.
    problem: Option<AppError>,
}

/// The output for the lines.
enum Lines {
    Stdout(BufWriter<PatientOutput<std::io::Stdout>>),
    File(StreamedOutput),
}

impl Lines {
    fn writer(&mut self) -> &mut dyn Write {
        match self {
            Self::Stdout(lines) => lines,
            Self::File(lines) => lines,
        }
    }
}

impl Output {
    /// Opens the outputs of the options.
    pub(super) fn open(args: &FlyArgs, vehicle: &Vehicle, plan: &PlanFile) -> Result<Self, AppError> {
        let lines = match &args.json {
            None | Some(OutputFile::Stdout) => {
                Lines::Stdout(BufWriter::new(PatientOutput(std::io::stdout())))
            }
            Some(OutputFile::File(path)) => Lines::File(StreamedOutput::begin(path)?),
        };
        let json = args.json.is_some();
        let header = || GpxHeader {
            creator: "betadeck (simulated)".to_owned(),
            track: plan.name.clone(),
            home_amsl_m: vehicle.local_frame().map_or(0.0, |frame| frame.alt_amsl_m),
            boot: UtcSeconds::SIMULATED_BOOT,
        };
        let gpx = match &args.gpx {
            None => None,
            Some(path) => {
                let file = StreamedOutput::begin(path)?;
                Some(GpxWriter::new(file, header(), &plan.plan).map_err(write_failed)?)
            }
        };
        let track = TrackFiles::open(args, || Track::new(header(), plan.plan.clone()))?;
        let samples_hz = args.samples.filter(|hz| *hz > 0.0);
        let sample_every_us = samples_hz.map(|hz| ((1e6 / hz).round() as u64).max(1));
        Ok(Self { lines: Some(lines), json, sample_every_us, gpx, track, is_over: false, problem: None })
    }

    /// Returns the error that stopped the flight.
    pub(super) fn into_problem(self) -> AppError {
        self.problem.unwrap_or_else(|| AppError::internal("the output stopped without an error"))
    }

    /// Writes an event.
    pub(super) fn write(&mut self, event: &Event) -> Result<(), AppError> {
        let line = if self.json { json::event_line(event) } else { sentence::line(event) };
        line.map_or(Ok(()), |line| self.line(&line))
    }

    fn line(&mut self, line: &str) -> Result<(), AppError> {
        let Some(lines) = &mut self.lines else { return Ok(()) };
        let line = if self.json { printable::json(line) } else { printable::line(line) };
        let written = writeln!(lines.writer(), "{line}");
        self.after(written)
    }

    /// Writes a sample if one is due.
    fn sample(&mut self, vehicle: &Vehicle) -> Result<(), AppError> {
        let Some(every) = self.sample_every_us else { return Ok(()) };
        let now = vehicle.time().0;
        if now / every == (now - vehicle.step_us()) / every {
            return Ok(());
        }
        self.line(&json::sample_line(&vehicle.snapshot()))
    }

    /// Flushes the lines to the reader.
    fn flush(&mut self) -> Result<(), AppError> {
        let Some(lines) = &mut self.lines else { return Ok(()) };
        let written = lines.writer().flush();
        self.after(written)
    }

    /// Handles the result of a write. If the reader went away, the flight continues and keeps its exit code.
    fn after(&mut self, written: std::io::Result<()>) -> Result<(), AppError> {
        match written {
            Ok(()) => Ok(()),
            Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => {
                self.lines = None;
                Ok(())
            }
            Err(error) => Err(write_failed(error)),
        }
    }

    /// Records a point of the tracks if one is due.
    fn track(&mut self, vehicle: &Vehicle) -> Result<(), AppError> {
        if let Some(track) = &mut self.track {
            track.offer(vehicle);
        }
        let Some(gpx) = &mut self.gpx else { return Ok(()) };
        if !vehicle.time().0.is_multiple_of(1_000_000) {
            return Ok(());
        }
        let Some((lat_deg, lon_deg, alt_m)) = place(vehicle) else { return Ok(()) };
        gpx.offer(&GpxPoint { time: vehicle.time(), lat_deg, lon_deg, alt_m }).map_err(write_failed)
    }

    /// Keeps the error of `done`, if there is one.
    fn keep(&mut self, done: Result<(), AppError>) {
        if let Err(problem) = done {
            self.problem.get_or_insert(problem);
        }
    }

    /// Ends the files and reports the end of the flight.
    pub(super) fn finish(mut self, time: SimTime, end: &End) -> Result<(), AppError> {
        if self.json {
            self.line(&json::end_line(time, end))?;
        } else {
            for line in truth::lines(time, &end.truth) {
                self.line(&line)?;
            }
        }
        self.flush()?;
        if let Some(Lines::File(lines)) = self.lines.take() {
            lines.finish()?;
        }
        if let Some(gpx) = self.gpx.take() {
            gpx.finish().map_err(write_failed)?.finish()?;
        }
        if let Some(track) = self.track.take() {
            track.finish()?;
        }
        error::tell(&end.result_line());
        error::tell(&end.flown_line());
        Ok(())
    }
}

impl Subscriber<WatchedFlight> for Output {
    fn event(&mut self, event: &Event) {
        if !self.is_over {
            let done = self.write(event);
            self.keep(done);
        }
    }

    fn after_tick(&mut self, flight: &WatchedFlight) {
        if !self.is_over {
            let vehicle = flight.vehicle();
            let done = self.sample(vehicle).and_then(|()| self.track(vehicle));
            self.keep(done);
        }
        self.is_over = flight.end().is_some();
    }

    /// A person may be watching the output.
    fn before_rest(&mut self) {
        let done = self.flush();
        self.keep(done);
    }

    fn goes_on(&self) -> bool {
        self.problem.is_none()
    }
}

/// The track and its files.
struct TrackFiles {
    track: Track,
    /// The interval of the points, µs.
    every_us: u64,
    kml: Option<StreamedOutput>,
    geojson: Option<StreamedOutput>,
}

impl TrackFiles {
    /// Opens the files of the options, if there are any.
    fn open(args: &FlyArgs, track: impl FnOnce() -> Track) -> Result<Option<Self>, AppError> {
        if args.kml.is_none() && args.geojson.is_none() {
            return Ok(None);
        }
        let open = |path: &Option<PathBuf>| path.as_deref().map(StreamedOutput::begin).transpose();
        let (kml, geojson) = (open(&args.kml)?, open(&args.geojson)?);
        Ok(Some(Self { track: track(), every_us: args.track_every_us(), kml, geojson }))
    }

    /// Records the place of the craft if a point is due.
    fn offer(&mut self, vehicle: &Vehicle) {
        let time = vehicle.time();
        if time.0 / self.every_us == time.0.saturating_sub(vehicle.step_us()) / self.every_us {
            return;
        }
        let Some((lat_deg, lon_deg, alt_m)) = place(vehicle) else { return };
        let state = vehicle.snapshot().nav.map(|nav| nav.state);
        self.track.add(TrackPoint { time, lat_deg, lon_deg, alt_m, state });
    }

    /// Writes the files.
    fn finish(self) -> Result<(), AppError> {
        let Self { track, kml, geojson, .. } = self;
        let write = |file: Option<StreamedOutput>, text: &dyn Fn() -> String| {
            let Some(mut file) = file else { return Ok(()) };
            file.write_all(text().as_bytes()).map_err(write_failed)?;
            file.finish()
        };
        write(kml, &|| track.kml())?;
        write(geojson, &|| track.geojson())
    }
}

/// Returns the true place of the craft: latitude and longitude, degrees, and altitude above home, m.
fn place(vehicle: &Vehicle) -> Option<(f64, f64, f64)> {
    let (truth, frame) = (vehicle.truth()?, vehicle.local_frame()?);
    let (lat_deg, lon_deg, amsl_m) = frame.to_geodetic(truth.pos_enu);
    Some((lat_deg, lon_deg, amsl_m - frame.alt_amsl_m))
}

#[expect(clippy::needless_pass_by_value, reason = "a map_err argument")]
fn write_failed(error: std::io::Error) -> AppError {
    AppError::environment(format!("cannot write the output: {error}"))
}
