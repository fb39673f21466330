//! Where the reports of a headless flight go: lines, a track, and the last words on standard error.

use std::io::{BufWriter, Write};
use std::path::Path;

use crate::app::error::{self, AppError};
use crate::app::firmware::told;
use crate::app::output_file::{self, StreamedOutput};
use crate::app::patient_output::PatientOutput;
use crate::app::setup;
use crate::args::{FlyArgs, OutputFile};
use crate::flight::Report;
use crate::plan::format::PlanFile;
use crate::printable;
use crate::record::{End, GpxHeader, GpxPoint, GpxWriter, UtcSeconds, json, sentence, truth};
use crate::session::Event;
use crate::signals::SimTime;
use crate::vehicle::Vehicle;

/// What is told before a flight with a firmware outside. The files begin when it begins.
#[derive(Debug)]
pub(super) struct Prelude<'a> {
    args: &'a FlyArgs,
    /// What the lines of JSON begin with.
    held: Vec<Event>,
}

impl<'a> Prelude<'a> {
    /// Before the flight of these options.
    pub(super) fn new(args: &'a FlyArgs) -> Self {
        Self { args, held: Vec::new() }
    }

    /// Tells an event: as a sentence on standard output, or with JSON on standard error until the lines begin.
    pub(super) fn event(&mut self, event: &Event) -> Result<(), AppError> {
        if self.args.json.is_some() {
            told::tell(event);
            self.held.push(event.clone());
        } else if let Some(line) = sentence::line(event) {
            error::write_stdout(format!("{}\n", printable::line(&line)).as_bytes())?;
        }
        Ok(())
    }

    /// Opens the outputs: the flight begins.
    pub(super) fn open(self, vehicle: &Vehicle, plan: &PlanFile) -> Result<Output, AppError> {
        let mut output = Output::open(self.args, vehicle, plan)?;
        self.held.iter().try_for_each(|event| output.event(event))?;
        output.flush()?;
        Ok(output)
    }
}

/// Whether the outputs may be written where the options say. The results of an earlier flight are removed when they all may:
/// this one may not come to be flown.
pub(super) fn claim(args: &FlyArgs) -> Result<(), AppError> {
    let mut kept = setup::kept_files(&args.flight, Some(&args.plan));
    if let Some(OutputFile::File(path)) = &args.json {
        kept.claim("--json", path)?;
    }
    if let Some(path) = &args.gpx {
        kept.claim("--gpx", path)?;
    }
    files(args).for_each(output_file::remove_results);
    Ok(())
}

/// The files that the options name for output.
fn files(args: &FlyArgs) -> impl Iterator<Item = &Path> {
    let json = match &args.json {
        Some(OutputFile::File(path)) => Some(path.as_path()),
        Some(OutputFile::Stdout) | None => None,
    };
    json.into_iter().chain(args.gpx.as_deref())
}

/// Where the reports go.
pub(super) struct Output {
    lines: Option<Lines>,
    /// JSON lines, or sentences.
    json: bool,
    gpx: Option<GpxWriter<StreamedOutput>>,
}

/// Where the lines go.
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
    /// Opens what the options name.
    pub(super) fn open(args: &FlyArgs, vehicle: &Vehicle, plan: &PlanFile) -> Result<Self, AppError> {
        let lines = match &args.json {
            None | Some(OutputFile::Stdout) => {
                Lines::Stdout(BufWriter::new(PatientOutput(std::io::stdout())))
            }
            Some(OutputFile::File(path)) => Lines::File(StreamedOutput::begin(path)?),
        };
        let json = args.json.is_some();
        let gpx = match &args.gpx {
            None => None,
            Some(path) => {
                let home_amsl_m = vehicle.local_frame().map_or(0.0, |frame| frame.alt_amsl_m);
                let header = GpxHeader {
                    creator: "betadeck (simulated)".to_owned(),
                    track: plan.name.clone(),
                    home_amsl_m,
                    boot: UtcSeconds::SIMULATED_BOOT,
                };
                let file = StreamedOutput::begin(path)?;
                Some(GpxWriter::new(file, header, &plan.plan).map_err(write_failed)?)
            }
        };
        Ok(Self { lines: Some(lines), json, gpx })
    }

    /// Writes an event or a sample.
    pub(super) fn report(&mut self, report: Report) -> Result<(), AppError> {
        match report {
            Report::Event(event) => self.event(&event.into()),
            Report::Sample(vehicle) => self.line(&json::sample_line(&vehicle.snapshot())),
        }
    }

    pub(super) fn event(&mut self, event: &Event) -> Result<(), AppError> {
        let line = if self.json { json::event_line(event) } else { sentence::line(event) };
        line.map_or(Ok(()), |line| self.line(&line))
    }

    fn line(&mut self, line: &str) -> Result<(), AppError> {
        let Some(lines) = &mut self.lines else { return Ok(()) };
        let line = if self.json { printable::json(line) } else { printable::line(line) };
        let written = writeln!(lines.writer(), "{line}");
        self.after(written)
    }

    /// Lets a reader see what was written.
    pub(super) fn flush(&mut self) -> Result<(), AppError> {
        let Some(lines) = &mut self.lines else { return Ok(()) };
        let written = lines.writer().flush();
        self.after(written)
    }

    /// A reader that went away has seen enough; the flight and its exit code go on.
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

    /// Writes a point of the track when a second is full.
    pub(super) fn track(&mut self, vehicle: &Vehicle) -> Result<(), AppError> {
        let Some(gpx) = &mut self.gpx else { return Ok(()) };
        if !vehicle.time().0.is_multiple_of(1_000_000) {
            return Ok(());
        }
        let Some(world) = vehicle.world() else { return Ok(()) };
        let truth = world.truth();
        let frame = world.local_frame();
        let (lat_deg, lon_deg, amsl_m) = frame.to_geodetic(truth.pos_enu);
        let alt_m = amsl_m - frame.alt_amsl_m;
        gpx.offer(&GpxPoint { time: vehicle.time(), lat_deg, lon_deg, alt_m }).map_err(write_failed)
    }

    /// Ends the files and says how the flight ended.
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
        error::tell(&end.result_line());
        error::tell(&end.flown_line());
        Ok(())
    }
}

#[expect(clippy::needless_pass_by_value, reason = "a map_err argument")]
fn write_failed(error: std::io::Error) -> AppError {
    AppError::environment(format!("cannot write the output: {error}"))
}
