//! The track of a flight in files of map programs.

use std::path::PathBuf;

use crate::args::FlyArgs;
use crate::files::output_file::{StreamedOutput, write_failed};
use crate::headless::fly::output::pace::Pace;
use crate::plan::format::PlanFile;
use crate::process::error::AppError;
use crate::report::{GpxHeader, GpxPoint, GpxWriter, Track, TrackPoint, UtcSeconds};
use crate::vehicle::Vehicle;

/// The files.
pub(super) struct Tracks {
    gpx: Option<GpxWriter<StreamedOutput>>,
    of_states: Option<OfStates>,
}

/// The track with the states of the autopilot, written at the end.
struct OfStates {
    track: Track,
    pace: Pace,
    kml: Option<StreamedOutput>,
    geojson: Option<StreamedOutput>,
}

impl Tracks {
    /// Opens the files of the options.
    ///
    /// # Errors
    /// Returns the reason why a file cannot be written.
    pub(super) fn open(args: &FlyArgs, vehicle: &Vehicle, plan: &PlanFile) -> Result<Self, AppError> {
        let header = || GpxHeader {
            creator: "betadeck (simulated)".to_owned(),
            track: plan.name.clone(),
            home_amsl_m: vehicle.local_frame().map_or(0.0, |frame| frame.alt_amsl_m),
            boot: UtcSeconds::SIMULATED_BOOT,
        };
        let open = |path: &Option<PathBuf>| path.as_deref().map(StreamedOutput::begin).transpose();
        let gpx = open(&args.gpx)?.map(|file| GpxWriter::new(file, header(), &plan.plan));
        let gpx = gpx.transpose().map_err(write_failed)?;
        let (kml, geojson) = (open(&args.kml)?, open(&args.geojson)?);
        let of_states = (kml.is_some() || geojson.is_some()).then(|| OfStates {
            track: Track::new(header(), plan.plan.clone()),
            pace: Pace::from_us(args.track_every_us()),
            kml,
            geojson,
        });
        Ok(Self { gpx, of_states })
    }

    /// Records the place of the craft if a point is due.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn offer(&mut self, vehicle: &Vehicle) -> Result<(), AppError> {
        if let Some(OfStates { track, pace, .. }) = &mut self.of_states
            && pace.is_due(vehicle)
            && let Some((lat_deg, lon_deg, alt_m)) = place(vehicle)
        {
            let state = vehicle.snapshot().nav.map(|nav| nav.state);
            track.add(TrackPoint { time: vehicle.time(), lat_deg, lon_deg, alt_m, state });
        }
        let Some(gpx) = &mut self.gpx else { return Ok(()) };
        if !vehicle.time().0.is_multiple_of(1_000_000) {
            return Ok(());
        }
        let Some((lat_deg, lon_deg, alt_m)) = place(vehicle) else { return Ok(()) };
        gpx.offer(&GpxPoint { time: vehicle.time(), lat_deg, lon_deg, alt_m }).map_err(write_failed)
    }

    /// Ends the files.
    ///
    /// # Errors
    /// Returns the error of the output.
    pub(super) fn finish(self) -> Result<(), AppError> {
        if let Some(gpx) = self.gpx {
            gpx.finish().map_err(write_failed)?.finish()?;
        }
        let Some(OfStates { track, kml, geojson, .. }) = self.of_states else { return Ok(()) };
        let write = |file: Option<StreamedOutput>, text: &dyn Fn() -> String| {
            let Some(mut file) = file else { return Ok(()) };
            file.add(text().as_bytes())?;
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
