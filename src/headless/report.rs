//! Reports about flights: what the flights themselves know, and their files.

use std::path::PathBuf;

use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::plan::feature::Feature;
use crate::process::build;
use crate::process::error::AppError;
use crate::report::check::shell_word;
use crate::report::flight::{FlightReport, ReportedSettings};
use crate::report::route::Route;
use crate::report::{FlightRecord, RecordedSample};
use crate::screen_files::backdrop_file;
use crate::signals::SimTime;
use crate::telemetry::signal::Signal;
use crate::terrain::Relief;
use crate::ui::backdrop::MAX_VERTICES;
use crate::vehicle::Vehicle;

/// The name of this program with its version, for reports.
pub(crate) fn program() -> String {
    format!("betadeck {}", build::version())
}

/// Returns the command of these words, for a shell.
pub(crate) fn command(words: &[String]) -> String {
    let words = words.iter().map(|word| shell_word(word));
    std::iter::once("betadeck".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Reads the maps of the option.
pub(crate) fn backdrop(paths: &[PathBuf]) -> Result<Vec<Feature>, AppError> {
    let mut features = Vec::new();
    for path in paths {
        features.extend(backdrop_file::read_features(path)?);
    }
    let vertices: usize = features.iter().map(|feature| feature.vertices().count()).sum();
    if vertices > MAX_VERTICES {
        return Err(AppError::input(format!(
            "--backdrop: the files have {vertices} vertices; a backdrop has at most {MAX_VERTICES}: simplify them or cut \
             them to the area of the flight"
        )));
    }
    Ok(features)
}

/// Returns the report about a flight of this plan that is about to begin, without its record and its end.
pub(crate) fn about(vehicle: &Vehicle, name: &str, plan: &FlightPlan) -> FlightReport {
    let settings = vehicle.controller().settings_view();
    let frame = vehicle.local_frame().copied();
    let changed = vehicle.embedded().map(|firmware| {
        let changed = firmware.configuration().settings.changed();
        ReportedSettings::Changed(changed.map(|(name, value, default)| [name, value, default]).collect())
    });
    FlightReport {
        kind: "Flight of a plan by betadeck".to_owned(),
        name: name.to_owned(),
        route: frame.map(|frame| Route::new(plan, &frame, &settings.unwrap_or_default())),
        fence_m: settings.and_then(|settings| settings.fence_m),
        frame,
        settings: changed,
        ..FlightReport::default()
    }
}

/// Adds a sample to a record if one is due after a tick of the vehicle.
pub(crate) fn sample(record: &mut FlightRecord, vehicle: &Vehicle) {
    if record.is_due(vehicle.time(), vehicle.step_us()) {
        record.sample(&vehicle.snapshot(), vehicle.engaged_at());
    }
}

/// Adds the height of the ground under the craft.
pub(crate) fn add_ground(report: &mut FlightReport, relief: &Relief) {
    let Some(frame) = report.frame else { return };
    let height = |sample: &RecordedSample| {
        let [north, east, alt] =
            [Signal::North, Signal::East, Signal::Altitude].map(|signal| sample.values.get(signal));
        let (lat_deg, lon_deg, _) = frame.to_geodetic(nalgebra::Vector3::new(east, north, alt));
        let height_m = relief.above_home_m(LatLon::from_degrees(lat_deg, lon_deg))?;
        Some((sample.time, height_m))
    };
    let known = report.record.samples.iter().filter(|sample| sample.values.get(Signal::North).is_finite());
    report.ground = known.filter_map(height).collect::<Vec<(SimTime, f64)>>();
}
