//! `betadeck compare PLAN --log FILE`: a log beside the same flight in the simulation.
//!
//! The embedded craft starts at the log's home with the log's settings, and gets its sticks and switches at their times.

mod feed;
mod opened;

use std::path::Path;
use std::sync::atomic::Ordering;

use nalgebra::Vector2;

use crate::args::CompareArgs;
use crate::files::recording_file::Recorder;
use crate::files::terrain::with_terrain;
use crate::firmware::config::Configuration;
use crate::flight::setup::{BootLines, PhysicsSource, settings_of_log};
use crate::flight::{Flight, FlightSetup};
use crate::flight_log::LogSticks;
use crate::geo::distance_bearing;
use crate::headless::compare::outputs::Outputs;
use crate::headless::setup;
use crate::plan::format::{HomePosition, PlanFile};
use crate::process::error;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::report::compare::{Comparison, Side, Track, begin_of_log};
use crate::report::route::Route;
use crate::runner::{Runner, Stopped};
use feed::Feed;
use opened::OpenLog;

/// The longest way from the home of a log to the nearest waypoint of the plan, m.
const FARTHEST_M: f64 = 50_000.0;

/// Flies the log again and compares. The exit code is 0 once both are measured.
pub(super) fn run(args: &CompareArgs, path: &Path, repeat: &[String]) -> Result<u8, AppError> {
    let mut notices = Vec::new();
    let log = OpenLog::open(path, &mut notices)?;
    let sticks = log.sticks()?;
    let (setup, plan) = simulated(args, &log, &mut notices)?;
    let outputs = Outputs::prepare(args, repeat, &[])?;
    let seed = setup.world.seed;
    let recorded = args.record.as_ref().map(|_| setup.clone());
    let mut vehicle = setup::build(setup, &mut notices)?;
    vehicle.keep_inputs(recorded.is_some());
    notices.iter().for_each(|notice| error::tell(notice));
    let frame = *vehicle.local_frame().ok_or_else(|| AppError::internal("the craft has no position"))?;
    let settings = vehicle.controller().settings_view().unwrap_or_default();
    let route = Route::new(&plan.plan, &frame, &settings);
    let measured = log.read(|flight, source| Track::from_log(flight, source, seed))?;
    setup::store_plan(&mut vehicle, &plan.plan)?;
    let standing_m = vehicle.truth().map_or(0.0, |truth| truth.pos_enu.z);
    let begin_us = begin_of_log(log.flight()).0.saturating_sub(log.flight().first().0);
    let recorder = args.record.as_deref().zip(recorded.as_ref());
    let recorder = recorder.map(|(path, setup)| Recorder::begin(path, setup)).transpose()?;
    let mut feed = Feed::new(sticks, log.flight().first(), (begin_us, standing_m), recorder);
    let mut flight = Flight::go_on(vehicle, &setup::flight_options(&args.mission));
    let mut runner = Runner::new(flight.vehicle().step_us(), f64::INFINITY, None);
    let interrupted = interrupt_flag()?;
    let end = match runner.fly(&mut flight, &mut feed, || interrupted.load(Ordering::Relaxed)) {
        Ok(end) => end,
        Err(Stopped::BySubscriber) => {
            feed.check(flight.vehicle())?;
            flight.interrupt("the log ends")
        }
        Err(_) => return Ok(error::INTERRUPTED),
    };
    let simulated = feed.finish(&end, seed)?;
    let conditions = crate::headless::compare::conditions(&args.flight, &[seed]);
    let side =
        |name: String, is_log: bool, track| Side { name, is_log, repeatable: !is_log, flights: vec![track] };
    let sides = [side(log.name(), true, measured), side("embedded".to_owned(), false, simulated)];
    outputs.write(&Comparison::new(&plan.name, &conditions, route, sides), &frame)?;
    Ok(0)
}

/// Returns the craft at the start of the log, and the plan.
fn simulated(
    args: &CompareArgs,
    log: &OpenLog,
    notices: &mut Vec<String>,
) -> Result<(FlightSetup, PlanFile), AppError> {
    let logged = log.home()?;
    let logged = HomePosition { position: logged.position, amsl_m: logged.alt_amsl_m };
    let home = Some(args.flight.home.unwrap_or(logged));
    let plan = setup::read_plan(&args.plan, home)?;
    setup::refuse_unflyable(&plan)?;
    refuse_another_place(log, logged, &plan)?;
    notices.extend(plan.notices());
    let mut setup =
        setup::from_args(&args.flight, PhysicsSource::Embedded, plan.clone(), Configuration::default())?;
    setup.home = home;
    if let (None, Some(attitude)) = (args.flight.heading, log.start()?.attitude) {
        setup.world.home.heading_deg = attitude.heading_deg;
    }
    let settings = settings_of_log(log.flight().header().lines());
    notices.push(format!(
        "{} was written by {}: {} settings of its header apply.",
        log.name(),
        log.firmware(),
        settings.len()
    ));
    let mut of_log = BootLines::settings(format!("the header of {}", log.name()), &settings);
    of_log.text.extend(LogSticks::switch_lines().map(|line| line + "\n"));
    setup.boot_lines.insert(0, of_log);
    let set = setup::set_of_embedded(&args.mission.set, notices)?;
    setup.boot_lines.push(BootLines::settings("--set", &set));
    Ok((with_terrain(setup, &args.flight.terrain, notices)?, plan))
}

/// Refuses a log that was flown far from the plan.
fn refuse_another_place(log: &OpenLog, home: HomePosition, plan: &PlanFile) -> Result<(), AppError> {
    let waypoints = plan.plan.waypoints.iter().filter(|waypoint| waypoint.kind.uses_position());
    let away = waypoints.map(|waypoint| distance_bearing(home.position, waypoint.position).0);
    match away.reduce(f64::min) {
        Some(away_m) if away_m > FARTHEST_M => Err(AppError::input(format!(
            "{} was flown {:.0} km away from the plan {}: allowed are {:.0} km; name the plan of that flight",
            log.name(),
            away_m / 1000.0,
            plan.name,
            FARTHEST_M / 1000.0
        ))),
        _ => Ok(()),
    }
}

/// Returns a place north and east of home.
fn north_east(enu: nalgebra::Vector3<f64>) -> Vector2<f64> {
    Vector2::new(enu.y, enu.x)
}
