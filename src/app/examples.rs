//! `betadeck examples`: the files that the commands of the documentation name.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::args::{FlightArgs, MissionArgs, PlanArg};
use crate::files::log_output::{LogOnly, LogOutput};
use crate::files::output_file::{cannot_write, replace};
use crate::firmware::config::Configuration;
use crate::flight::setup::{BootLines, PhysicsSource};
use crate::headless::setup;
use crate::plan::builtin::BuiltinPlan;
use crate::process::error;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::runner::Runner;

/// A file with its purpose.
struct Example {
    name: &'static str,
    purpose: &'static str,
    contents: &'static str,
}

/// Returns a file of `templates/examples/`.
macro_rules! example {
    ($name:literal, $purpose:literal) => {
        Example {
            name: $name,
            purpose: $purpose,
            contents: include_str!(concat!("../../templates/examples/", $name)),
        }
    };
}

const FILES: [Example; 9] = [
    example!("my-plan.toml", "a plan: out, a lap of hold, and back on the ground at home"),
    example!("my-plan.txt", "a plan as lines of the Betaflight CLI"),
    example!("diff.txt", "a configuration with a plan, as `diff all` prints it"),
    example!("theirs.plan", "a plan of QGroundControl"),
    example!("field.geojson", "a map: a field, a road and a no-fly zone"),
    example!("my-quad.toml", "a craft"),
    example!("my-test.toml", "a scenario: a flight of my-plan.toml, and what is expected of it"),
    example!("flight-tests/square.toml", "a scenario in a folder of its own"),
    example!("my-campaign.toml", "a campaign: what differs among many flights of my-plan.toml"),
];

/// The logs of a flight before and after a change of a setting, with that setting.
const FLOWN: [(&str, &str, &str); 2] = [
    ("before.bbl", "a blackbox log of a landing", "ap_landing_descent_rate = 50"),
    ("after.bbl", "a blackbox log of a faster landing", "ap_landing_descent_rate = 100"),
];
/// Files that are put together from these logs.
const JOINED: [(&str, &str, &[&str]); 2] = [
    ("LOG00001.BFL", "before.bbl under a name of the firmware", &["before.bbl"]),
    ("flights.bbl", "a file with both logs", &["before.bbl", "after.bbl"]),
];

/// Writes the files into a folder, which is created if it is missing. No file is replaced.
pub(super) fn run(folder: &Path) -> Result<u8, AppError> {
    let files = FILES.iter().map(|file| (file.name, file.purpose));
    let flown = FLOWN.iter().map(|(name, purpose, _)| (*name, *purpose));
    let joined = JOINED.iter().map(|(name, purpose, _)| (*name, *purpose));
    let all: Vec<(&str, &str)> = files.chain(flown).chain(joined).collect();
    let there: Vec<&str> = all
        .iter()
        .map(|(name, _)| *name)
        .filter(|name| folder.join(name).symlink_metadata().is_ok())
        .collect();
    if !there.is_empty() {
        return Err(AppError::environment(format!(
            "{} has {} already, and no file is replaced: name a new folder, such as betadeck examples try",
            folder.display(),
            there.join(", ")
        )));
    }
    match write_all(folder) {
        Ok(true) => {}
        // The next run refuses a folder with some of the files.
        stopped => {
            for (name, _) in &all {
                std::fs::remove_file(folder.join(name)).ok();
            }
            return stopped.map(|_| error::INTERRUPTED);
        }
    }
    let width = all.iter().map(|(name, _)| name.len()).max().unwrap_or_default();
    let rows = all.iter().map(|(name, purpose)| format!("{name:width$}  {purpose}\n"));
    error::print(&rows.collect::<String>())
}

/// Writes all files. Returns `false` after an interrupt.
fn write_all(folder: &Path) -> Result<bool, AppError> {
    let interrupted = interrupt_flag()?;
    for file in FILES {
        write(&folder.join(file.name), file.contents.as_bytes())?;
    }
    for (name, _, setting) in FLOWN {
        if !fly(&folder.join(name), setting, &interrupted)? {
            return Ok(false);
        }
    }
    for (name, _, parts) in JOINED {
        let mut contents = Vec::new();
        for part in parts {
            let path = folder.join(part);
            let cannot_read =
                |error| AppError::environment(format!("cannot read {}: {error}", path.display()));
            contents.append(&mut std::fs::read(&path).map_err(cannot_read)?);
        }
        write(&folder.join(name), &contents)?;
    }
    Ok(true)
}

fn write(path: &Path, contents: &[u8]) -> Result<(), AppError> {
    let folder = path.parent().map_or(Ok(()), std::fs::create_dir_all);
    folder.and_then(|()| replace(path, contents)).map_err(|error| cannot_write(path, &error))
}

/// Flies a landing with a setting, and writes its log. Returns `false` after an interrupt.
fn fly(log: &Path, setting: &str, interrupted: &AtomicBool) -> Result<bool, AppError> {
    let plan = BuiltinPlan::find("land").ok_or_else(|| AppError::internal("no plan land"))?;
    let plan = setup::read_plan(&PlanArg::Builtin(plan), None)?;
    let mut start = setup::from_args(
        &FlightArgs::default(),
        PhysicsSource::Embedded,
        plan.clone(),
        Configuration::default(),
    )?;
    start.boot_lines.push(BootLines::settings("the example", &[setting.to_owned()]));
    let mut vehicle = setup::build(start, &mut Vec::new())?;
    setup::store_plan(&mut vehicle, &plan.plan)?;
    let mut output = LogOnly::new(LogOutput::begin(log, &mut vehicle)?);
    let mut flight = setup::start_flight(vehicle, &setup::flight_options(&MissionArgs::default()))?;
    let mut runner = Runner::new(flight.vehicle().step_us(), f64::INFINITY, None);
    let end = runner.fly(&mut flight, &mut output, || interrupted.load(Ordering::Relaxed));
    output.finish()?;
    Ok(end.is_ok())
}
