//! `betadeck plan`: the built-in plans by name, and a plan as a table with distances, times and findings.

use std::path::PathBuf;

use crate::args::{BackdropArgs, PlanArg, ReviewArgs, TerrainArgs};
use crate::files::terrain::TerrainFiles;
use crate::flight::FlightSetup;
use crate::flight::setup::check_setting;
use crate::geo::{LatLon, distance_bearing};
use crate::headless::setup;
use crate::plan::builtin::PLANS;
use crate::plan::estimate::Assumptions;
use crate::plan::feature::Feature;
use crate::plan::format::{self, PlanFile, ReadOptions};
use crate::plan::review::{Clearances, Finding, clearances, review, zone_findings};
use crate::plan::{MAX_WAYPOINTS, Waypoint};
use crate::process::error;
use crate::process::error::AppError;
use crate::screen_files::backdrop_file;
use crate::sim::density_ratio;
use crate::terrain::Relief;

/// Prints the built-in plans, one on each line.
pub(super) fn list() -> Result<u8, AppError> {
    let longest = PLANS.iter().map(|plan| plan.name.len()).max().unwrap_or_default();
    let mut text = String::new();
    for builtin in PLANS {
        let file = builtin.read().map_err(|errors| {
            let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
            AppError::internal(format!("the built-in plan {}: {}", builtin.name, errors.join("; ")))
        })?;
        let count = file.plan.waypoints.len();
        let noun = if count == 1 { "waypoint " } else { "waypoints" };
        text.push_str(&format!("{:longest$}  {count} {noun}  {}\n", builtin.name, file.description));
    }
    error::print(&text)
}

/// Prints the plan; a plan that the craft would refuse is invalid input.
pub(super) fn show(
    plan: &PlanArg,
    limits: ReviewArgs,
    maps: &BackdropArgs,
    terrain: &TerrainArgs,
) -> Result<u8, AppError> {
    let options = ReadOptions { check: check_setting, long: true, ..ReadOptions::default() };
    let (_, file) = setup::read_plan_with(plan, &options)?;
    let mut zones = Vec::new();
    let own = plan.path().filter(|path| backdrop_file::has_fences(path));
    for path in maps.backdrop.iter().map(PathBuf::as_path).chain(own) {
        zones
            .extend(backdrop_file::read_features(path)?.into_iter().filter(|feature| feature.zone.is_some()));
    }
    let parts = file.parts();
    if let [part] = &parts[..] {
        return show_part(part, limits, &zones, terrain);
    }
    error::print(&format!(
        "{} waypoints, {:.2} km in all: a plan holds at most {MAX_WAYPOINTS}, so {} parts are shown, each of which begins \
         where the one before ends. To fly it, `betadeck convert` with --simplify METRES leaves out points near the line, \
         with --split it writes the parts.\n",
        file.plan.waypoints.len() + file.rest.len(),
        length_m(&file.waypoints()) / 1000.0,
        parts.len()
    ))?;
    for part in parts {
        error::print("\n")?;
        show_part(&part, limits, &zones, terrain)?;
    }
    // No craft takes the whole.
    Ok(error::USAGE)
}

/// Returns the length of the way through all places, m.
fn length_m(waypoints: &[Waypoint]) -> f64 {
    let places: Vec<LatLon> = waypoints
        .iter()
        .filter(|waypoint| waypoint.kind.uses_position())
        .map(|waypoint| waypoint.position)
        .collect();
    places.windows(2).map(|leg| distance_bearing(leg[0], leg[1]).0).sum()
}

/// Prints a plan that fits into a craft.
fn show_part(
    file: &PlanFile,
    limits: ReviewArgs,
    zones: &[Feature],
    terrain: &TerrainArgs,
) -> Result<u8, AppError> {
    let setup = FlightSetup { plan: file.clone(), ..FlightSetup::default() };
    let (home, notice) = setup.boot_home();
    let density = density_ratio(home.alt_amsl_m);
    let assumptions = Assumptions {
        max_alt_m: Some(limits.max_altitude_m()),
        endurance_s: Some(setup.world.airframe.hover_endurance_s(density)),
        ..Assumptions::from_settings(&file.settings)
    };
    let home = LatLon::from_degrees(home.lat_deg, home.lon_deg);
    let mut text = format::table(file, home, &assumptions);
    for finding in zone_findings(&file.plan, home, zones) {
        text.push_str(&format!("{finding}\n"));
    }
    if let Some(notice) = notice {
        text.push_str(&format!("{notice}\n"));
    }
    let mut notices = Vec::new();
    let tiles = TerrainFiles::new(terrain)?.read(home, &file.plan, &mut notices);
    if let Some(relief) = tiles.and_then(|tiles| Relief::new(tiles, home)) {
        text.push_str(&ground(&clearances(&file.plan, &assumptions, &relief, limits.clearance_m())));
    }
    for notice in notices {
        text.push_str(&format!("{notice}\n"));
    }
    error::print(&text)?;
    let refused = review(&file.plan, home, &assumptions).iter().any(Finding::is_refusal);
    Ok(if refused { error::USAGE } else { 0 })
}

/// Returns the clearance of a plan above the ground as lines.
fn ground(found: &Clearances) -> String {
    let mut text = String::new();
    if let Some((clearance_m, index, along_m)) = found.lowest {
        text.push_str(&format!(
            "lowest clearance above the ground: {clearance_m:.0} m, {along_m:.0} m along the leg to waypoint {index} \
             (tiles err by 5 to 10 m, more on slopes, and hold roofs and trees only partly)\n"
        ));
    }
    for finding in &found.findings {
        text.push_str(&format!("{finding}\n"));
    }
    if !found.unknown.is_empty() {
        let legs: Vec<String> = found.unknown.iter().map(ToString::to_string).collect();
        let noun = if legs.len() == 1 { "waypoint" } else { "waypoints" };
        text.push_str(&format!("the ground on the way to {noun} {} is unknown\n", legs.join(", ")));
    }
    text
}
