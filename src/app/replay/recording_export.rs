//! Writes a recording as files: its pictures as a table, its places as a track, a page about its flight.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};

use super::outputs;
use super::report::Report;
use crate::args::ReplayArgs;
use crate::files::log_source::FileSource;
use crate::plan::FlightPlan;
use crate::process::error;
use crate::process::error::AppError;
use crate::recording::{Happened, Picture, Recording, Setup};
use crate::replay::{PastFlights as _, RecordedFlights};
use crate::report::{CsvWriter, GpxHeader, GpxPoint, GpxWriter, Track, TrackPoint, UtcSeconds};
use crate::signals::SimTime;
use crate::telemetry::signal::Observed;
use crate::telemetry::{EventKind, FirmwareEvent, NavEvent, NavState};

/// Writes the files of the options from a recording. Returns `false` if the user ended it; then no file is written.
///
/// # Errors
/// Returns a sentence if the recording cannot be read or a file cannot be written.
pub(super) fn run(
    args: &ReplayArgs,
    repeat: &[String],
    flights: &mut RecordedFlights<FileSource>,
    stop: &AtomicBool,
) -> Result<bool, AppError> {
    let report = Report::prepare(args, repeat)?;
    let is_stopped = || stop.load(Ordering::Relaxed);
    if !flights.read(&mut |_| !is_stopped()).map_err(AppError::input)? {
        return Ok(false);
    }
    let recording = flights.recording(args.number().unwrap_or_default()).map_err(AppError::input)?;
    recording.notices().iter().for_each(|notice| error::tell(notice));
    let points = points(&recording);
    if points.is_empty() && (args.gpx.is_some() || args.kml.is_some()) {
        let name = flights.name();
        return Err(AppError::input(format!(
            "{name} has no place of its craft, so there is no track to write"
        )));
    }
    if let Some(output) = &args.csv {
        let write = |out: &mut dyn io::Write| write_csv(&recording, args.row_every_us(), out, is_stopped);
        if !outputs::table(output, stop, write)? {
            return Ok(false);
        }
    }
    let (header, plan) = (header(&recording), plan(&recording));
    if let Some(path) = &args.gpx {
        outputs::file(path, |out| write_gpx(&points, header.clone(), &plan, out))?;
    }
    if let Some(path) = &args.kml {
        let mut track = Track::new(header, plan);
        points.into_iter().for_each(|point| track.add(point));
        outputs::file(path, |out| out.write_all(track.kml().as_bytes()))?;
    }
    if let Some(report) = report {
        let past = flights.open(args.number().unwrap_or_default()).map_err(AppError::input)?;
        report.write_recording(flights.name(), &recording, &past.overview())?;
    }
    Ok(!is_stopped())
}

/// Writes a row for each picture, or for the first one in each interval of so many microseconds.
fn write_csv(
    recording: &Recording,
    interval_us: Option<u64>,
    out: &mut dyn io::Write,
    is_stopped: impl Fn() -> bool,
) -> io::Result<()> {
    let engaged_at = engaged_at(recording);
    let mut table = CsvWriter::new(out)?;
    let mut due = SimTime::ZERO;
    for picture in recording.pictures.all() {
        if is_stopped() {
            break;
        }
        if picture.time() < due {
            continue;
        }
        let interval_us = interval_us.unwrap_or(1);
        due = SimTime((picture.time().0 / interval_us).saturating_add(1).saturating_mul(interval_us));
        let snapshot = picture.snapshot();
        let engaged_at = engaged_at.filter(|engaged| *engaged <= picture.time());
        table.row(&Observed { engaged_at, ..Observed::of(&snapshot) })?;
    }
    table.finish()?.flush()
}

fn write_gpx(
    points: &[TrackPoint],
    header: GpxHeader,
    plan: &FlightPlan,
    out: &mut dyn io::Write,
) -> io::Result<()> {
    let mut writer = GpxWriter::new(out, header, plan)?;
    for TrackPoint { time, lat_deg, lon_deg, alt_m, .. } in points.iter().copied() {
        writer.offer(&GpxPoint { time, lat_deg, lon_deg, alt_m })?;
    }
    writer.finish().map(drop)
}

fn engaged_at(recording: &Recording) -> Option<SimTime> {
    let is_engagement = |what: &Happened| {
        matches!(
            what,
            Happened::Vehicle(EventKind::Firmware(FirmwareEvent::Nav(NavEvent::State {
                from: NavState::Idle,
                ..
            })))
        )
    };
    recording.events.iter().find(|event| is_engagement(&event.what)).map(|event| event.time)
}

/// Returns the true places of the craft, or those that its GPS reports.
fn points(recording: &Recording) -> Vec<TrackPoint> {
    recording.pictures.all().iter().filter_map(point).collect()
}

fn point(picture: &Picture) -> Option<TrackPoint> {
    let snapshot = picture.snapshot();
    let (lat_deg, lon_deg, alt_m) = match (&snapshot.truth, &snapshot.craft.gps) {
        (Some(truth), _) => (truth.lat_deg, truth.lon_deg, truth.alt),
        (None, Some(gps)) => {
            (gps.position.lat_deg(), gps.position.lon_deg(), snapshot.estimate.alt.unwrap_or_default())
        }
        (None, None) => return None,
    };
    let state = snapshot.nav.map(|nav| nav.state);
    Some(TrackPoint { time: picture.time(), lat_deg, lon_deg, alt_m, state })
}

fn plan(recording: &Recording) -> FlightPlan {
    recording.setup().map(Setup::plan).unwrap_or_default().plan
}

/// Returns the header of the track, as `fly` writes it.
fn header(recording: &Recording) -> GpxHeader {
    let home_amsl_m = recording.setup().and_then(|setup| setup.flight().ok());
    GpxHeader {
        creator: "betadeck (simulated)".to_owned(),
        track: recording.header.plan.clone(),
        home_amsl_m: home_amsl_m.map_or(0.0, |flight| flight.world.home.alt_amsl_m),
        boot: UtcSeconds::SIMULATED_BOOT,
    }
}
