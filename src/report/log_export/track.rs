//! The track of a log as GPX and KML.

use std::io::{self, Write};

use super::date;
use crate::flight_log::{LogFlight, TrackFix};
use crate::plan::FlightPlan;
use crate::report::{GpxHeader, GpxPoint, GpxWriter, Track, TrackPoint, UtcSeconds};

/// Returns the header of a track.
fn header(flight: &LogFlight, name: &str) -> GpxHeader {
    let home = flight.home().and_then(|home| home.alt_amsl_m);
    GpxHeader {
        creator: "betadeck (from a log)".to_owned(),
        track: name.to_owned(),
        home_amsl_m: home.unwrap_or_default(),
        boot: date::boot(flight).unwrap_or(UtcSeconds::SIMULATED_BOOT),
    }
}

/// Returns the altitude of a place above home, m. The GPS counts before the barometer, because tracks are above sea level.
fn above_home_m(fix: &TrackFix, header: &GpxHeader) -> f64 {
    fix.alt_amsl_m.map(|amsl_m| amsl_m - header.home_amsl_m).or(fix.alt_m).unwrap_or_default()
}

/// Writes the track of a log as GPX, with one point for each second, and returns the output. `name` is the name of the track.
///
/// # Errors
///
/// Returns the error of the output.
pub fn log_gpx<W: Write>(flight: &LogFlight, name: &str, out: W) -> io::Result<W> {
    let header = header(flight, name);
    let mut writer = GpxWriter::new(out, header.clone(), &FlightPlan::default())?;
    for fix in flight.track() {
        let (lat_deg, lon_deg) = (fix.position.lat_deg(), fix.position.lon_deg());
        writer.offer(&GpxPoint { time: fix.time, lat_deg, lon_deg, alt_m: above_home_m(fix, &header) })?;
    }
    writer.finish()
}

/// Returns the track of a log, for [`Track::kml`] and [`Track::geojson`]. `name` is the name of the track.
pub fn log_track(flight: &LogFlight, name: &str) -> Track {
    let header = header(flight, name);
    let mut track = Track::new(header.clone(), FlightPlan::default());
    for fix in flight.track() {
        let (lat_deg, lon_deg) = (fix.position.lat_deg(), fix.position.lon_deg());
        track.add(TrackPoint {
            time: fix.time,
            lat_deg,
            lon_deg,
            alt_m: above_home_m(fix, &header),
            state: None,
        });
    }
    track
}
