//! The KML and GeoJSON tracks of a headless flight. They are written at its end.

use std::io::Write as _;

use super::output::write_failed;
use crate::app::error::AppError;
use crate::app::output_file::StreamedOutput;
use crate::args::FlyArgs;
use crate::report::{Track, TrackPoint};
use crate::vehicle::Vehicle;

/// The track and its files.
pub(super) struct TrackFiles {
    track: Track,
    /// The interval of the points, µs.
    every_us: u64,
    kml: Option<StreamedOutput>,
    geojson: Option<StreamedOutput>,
}

impl TrackFiles {
    /// Opens the files of the options, if there are any.
    pub(super) fn open(args: &FlyArgs, track: impl FnOnce() -> Track) -> Result<Option<Self>, AppError> {
        if args.kml.is_none() && args.geojson.is_none() {
            return Ok(None);
        }
        let open = |path: &Option<std::path::PathBuf>| path.as_deref().map(StreamedOutput::begin).transpose();
        let (kml, geojson) = (open(&args.kml)?, open(&args.geojson)?);
        Ok(Some(Self { track: track(), every_us: args.track_every_us(), kml, geojson }))
    }

    /// Records the place of the craft if a point is due.
    pub(super) fn offer(&mut self, vehicle: &Vehicle) {
        let time = vehicle.time();
        if time.0 / self.every_us == time.0.saturating_sub(vehicle.step_us()) / self.every_us {
            return;
        }
        let Some((lat_deg, lon_deg, alt_m)) = place(vehicle) else { return };
        let state = vehicle.snapshot().nav.map(|nav| nav.state);
        self.track.add(TrackPoint { time, lat_deg, lon_deg, alt_m, state });
    }

    /// Writes the files.
    pub(super) fn finish(self) -> Result<(), AppError> {
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
pub(super) fn place(vehicle: &Vehicle) -> Option<(f64, f64, f64)> {
    let (truth, frame) = (vehicle.truth()?, vehicle.local_frame()?);
    let (lat_deg, lon_deg, amsl_m) = frame.to_geodetic(truth.pos_enu);
    Some((lat_deg, lon_deg, amsl_m - frame.alt_amsl_m))
}
