//! Reads the files of the options, and makes the start of a flight from both.

use std::path::{Path, PathBuf};

use crate::args::{
    AttitudeChoice, DoorArgs, FlightArgs, MissionArgs, OnOff, PhysicsArgs, PlanArg, is_descriptor,
};
use crate::files::input_file;
use crate::files::output_file::KeptFiles;
use crate::firmware::AttitudeSource;
use crate::firmware::cli::BuildInfo;
use crate::firmware::config::Configuration;
use crate::flight::setup::{BootLines, PhysicsSource, check_setting};
use crate::flight::{Flight, FlightOptions, FlightSetup};
use crate::plan::FlightPlan;
use crate::plan::builtin::BuiltinPlan;
use crate::plan::format::{self, Format, HomePosition, PlanFile, ReadOptions, SettingPart};
use crate::plan::review::Finding;
use crate::plan::validate::check_plan;
use crate::process::build::Build;
use crate::process::error;
use crate::process::error::AppError;
use crate::report::UtcSeconds;
use crate::signals::SimTime;
use crate::sim::{Airframe, Home, WorldConfig};
use crate::storage::Store;
use crate::vehicle::{Vehicle, VehicleCommand};

/// Reads a plan from its source. `home` is that of a file that has none, or none with its altitude above sea level.
pub(crate) fn read_plan(plan: &PlanArg, home: Option<HomePosition>) -> Result<PlanFile, AppError> {
    let options = ReadOptions { check: check_setting, home, ..ReadOptions::default() };
    read_plan_with(plan, &options).map(|(_, file)| file)
}

/// Reads a plan from its source, with the choices of the user. Returns also its format.
pub(crate) fn read_plan_with(plan: &PlanArg, options: &ReadOptions) -> Result<(Format, PlanFile), AppError> {
    let name = plan.display_name();
    let contents = match plan {
        PlanArg::Builtin(BuiltinPlan { text, .. }) => text.as_bytes().to_vec(),
        PlanArg::Stdin(_) => input_file::read_stdin()?,
        PlanArg::File(path, _) => input_file::read_plan(path)?,
    };
    let (format, finding) = plan.format(&contents);
    let mut file = format::read(&name, &contents, format, options)
        .map_err(|errors| AppError::input(format::report(&errors).trim_end().to_owned()))?;
    file.losses.findings.splice(0..0, finding);
    Ok((format, file))
}

/// Returns the start of a flight with this plan, from the options that all flying commands share.
pub(crate) fn from_args(
    args: &FlightArgs,
    physics: PhysicsSource,
    plan: PlanFile,
    stored: Configuration,
) -> Result<FlightSetup, AppError> {
    let world = WorldConfig {
        rate_hz: args.rate_hz(),
        seed: args.seed.unwrap_or(WorldConfig::default().seed),
        ..match physics {
            PhysicsSource::Embedded => embedded_world(args)?,
            PhysicsSource::External => WorldConfig::default(),
        }
    };
    let mut boot_lines = Vec::new();
    if let Some(path) = &args.settings {
        boot_lines.push(BootLines { source: path.display().to_string(), text: input_file::read(path)? });
    }
    let mut setup = FlightSetup {
        physics,
        world,
        home: args.home,
        plan,
        attitude: args.attitude.map(attitude_source),
        remote_controller: false,
        arm_assist: args.arm_assist.is_some_and(OnOff::is_on),
        stored,
        boot_lines,
        stick_inputs: Vec::new(),
        live: false,
        build: build_info(),
    };
    if let Some(profile) = args.profile {
        setup.use_profile(profile, true);
    }
    Ok(setup)
}

/// Returns the start of a flight in real time for a session.
pub(crate) fn for_session(
    flight: &FlightArgs,
    physics: &PhysicsArgs,
    doors: &DoorArgs,
    plan: PlanFile,
    stored: Configuration,
) -> Result<FlightSetup, AppError> {
    let source = if physics.is_external() { PhysicsSource::External } else { PhysicsSource::Embedded };
    let mut setup = from_args(flight, source, plan, stored)?;
    setup.world.faults.clone_from(&physics.fault);
    setup.arm_assist = flight.arm_assist.is_none_or(OnOff::is_on);
    setup.live = physics.is_external() || !doors.no_ports;
    Ok(setup)
}

/// Builds the vehicle. Notices for the user are added to `notices`.
pub(crate) fn build(setup: FlightSetup, notices: &mut Vec<String>) -> Result<Vehicle, AppError> {
    let (vehicle, found) = setup.build().map_err(|error| AppError::input(error.to_string()))?;
    notices.extend(found.iter().map(ToString::to_string));
    Ok(vehicle)
}

/// Returns the options for the flight and the judgement of a plan, with this number of reported samples a second.
pub(crate) fn flight_options(args: &MissionArgs) -> FlightOptions {
    FlightOptions {
        takeoff_m: args.takeoff_m(),
        timeout: SimTime::from_secs_f64(args.timeout_s()),
        tolerance_m: args.tolerance_m(),
    }
}

/// Returns the checked settings of `--set` that the embedded firmware has, when it flies next to another firmware.
/// Adds the others to `notices`.
pub(crate) fn set_of_embedded(
    settings: &[String],
    notices: &mut Vec<String>,
) -> Result<Vec<String>, AppError> {
    let is_unknown = |setting: &&String| {
        let (name, value) = setting.split_once(" = ").unwrap_or((setting, ""));
        check_setting(name, value).is_err_and(|fault| fault.part == SettingPart::Name)
    };
    let (unknown, known): (Vec<&String>, Vec<&String>) = settings.iter().partition(is_unknown);
    notices.extend(unknown.iter().map(|setting| {
        format!("The embedded firmware does not have `{setting}`: only the other one gets it.")
    }));
    let known: Vec<String> = known.into_iter().cloned().collect();
    check_set(&known)?;
    Ok(known)
}

/// Checks that the embedded firmware accepts the settings of `--set`.
pub(crate) fn check_set(settings: &[String]) -> Result<(), AppError> {
    settings.iter().try_for_each(|setting| {
        let (name, value) = setting.split_once(" = ").unwrap_or((setting, ""));
        check_setting(name, value).map_err(|fault| AppError::input(format!("--set {name}={value}: {fault}")))
    })
}

/// Stores a plan in the embedded firmware. A plan that it refuses is invalid input.
pub(crate) fn store_plan(vehicle: &mut Vehicle, plan: &FlightPlan) -> Result<(), AppError> {
    let stored = vehicle.apply(&VehicleCommand::upload(plan.clone(), Vec::new())).accepted();
    stored.map_err(|refusal| AppError::input(refusal.to_string()))
}

/// Starts a flight of the plan that is stored in the craft.
pub(crate) fn start_flight(vehicle: Vehicle, options: &FlightOptions) -> Result<Flight, AppError> {
    Flight::new(vehicle, options).map_err(|refusal| {
        AppError::input(format!("{refusal}: the pilot needs one; set it with an aux line in --settings"))
    })
}

/// Refuses a plan that no craft flies with any settings, so that nobody waits for it.
pub(crate) fn refuse_unflyable(plan: &PlanFile) -> Result<(), AppError> {
    check_plan(&plan.plan).map_err(|fault| {
        plan.notices().iter().for_each(|notice| error::tell(notice));
        AppError::input(format!("{}: {}", plan.name, Finding::Fault(fault)))
    })
}

/// Returns the embedded world without step rate, seed and faults.
fn embedded_world(args: &FlightArgs) -> Result<WorldConfig, AppError> {
    let usual = WorldConfig::default();
    Ok(WorldConfig {
        airframe: airframe(args.airframe.as_deref())?,
        home: Home { heading_deg: args.heading.unwrap_or(0.0), ..usual.home },
        noise: args.noise.unwrap_or(usual.noise),
        wind: args.wind.unwrap_or(usual.wind),
        gust_mps: args.gust.unwrap_or(usual.gust_mps),
        turbulence: args.turbulence.unwrap_or_default(),
        switches: args.switches().map_err(|error| AppError::input(error.to_string()))?,
        ..usual
    })
}

/// Returns the firmware's value for the option.
pub(crate) fn attitude_source(attitude: AttitudeChoice) -> AttitudeSource {
    match attitude {
        AttitudeChoice::Truth => AttitudeSource::Truth,
        AttitudeChoice::Estimated => AttitudeSource::Estimated,
    }
}

/// Returns the data about this executable for the CLI's `version` and MSP.
pub(crate) fn build_info() -> BuildInfo {
    let Build { revision, time_s } = Build::get();
    let (date, time) = UtcSeconds(time_s).build_stamp();
    BuildInfo { date, time, revision: revision.to_owned(), ..BuildInfo::default() }
}

/// Returns the stored configuration, and adds its problems to `notices`.
pub(crate) fn stored(store: &mut Store, notices: &mut Vec<String>) -> Configuration {
    stored_before(store, notices).0
}

/// Returns what is stored, and `true` if something was.
pub(crate) fn stored_before(store: &mut Store, notices: &mut Vec<String>) -> (Configuration, bool) {
    let loaded = store.load();
    notices.extend(loaded.findings);
    (loaded.configuration, !loaded.first_boot)
}

fn airframe(name: Option<&str>) -> Result<Airframe, AppError> {
    let name = name.unwrap_or("iris");
    match name.parse() {
        Ok(airframe) => Ok(airframe),
        Err(_) if is_airframe_file(name) => {
            let text = input_file::read_small(Path::new(name))?;
            Airframe::from_toml(&text).map_err(|error| AppError::input(error.in_file(name).to_string()))
        }
        Err(error) => Err(AppError::input(format!("--airframe: {error}"))),
    }
}

/// Returns `true` if the name is that of a TOML file, or of a pipe with one.
fn is_airframe_file(name: &str) -> bool {
    let path = Path::new(name);
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) || is_descriptor(path)
}

/// Returns the directory of `--state-dir`, or the user's; `None` with `--fresh`.
pub(crate) fn store_directory(args: &FlightArgs) -> Result<Option<PathBuf>, AppError> {
    if args.fresh {
        return Ok(None);
    }
    state_directory(args.state_dir.as_deref()).map(Some)
}

/// Returns this directory, or the user's.
pub(crate) fn state_directory(named: Option<&Path>) -> Result<PathBuf, AppError> {
    match named {
        Some(directory) => Ok(directory.to_owned()),
        None => crate::files::directories::directories().map(|directories| directories.state),
    }
}

/// Opens the store in that directory.
pub(crate) fn open_store(args: &FlightArgs) -> Result<Store, AppError> {
    match store_directory(args)? {
        None => Ok(Store::in_memory()),
        Some(directory) => {
            Store::open(&directory, false).map_err(|error| AppError::environment(error.to_string()))
        }
    }
}

/// Returns the files that a flight reads and stores. No output may replace them.
pub(crate) fn kept_files(args: &FlightArgs, plan: Option<&PlanArg>) -> KeptFiles {
    let mut kept = KeptFiles::default();
    match plan {
        Some(PlanArg::File(path, _)) => kept.keep("the plan", path),
        Some(PlanArg::Stdin(_)) => kept.keep("the plan", Path::new("/dev/stdin")),
        Some(PlanArg::Builtin(_)) | None => {}
    }
    if let Some(path) = &args.settings {
        kept.keep("--settings", path);
    }
    if let Some(name) = args.airframe.as_deref().map(Path::new).filter(|name| name.extension().is_some()) {
        kept.keep("--airframe", name);
    }
    keep_own_files(&mut kept);
    if let Some(directory) = &args.state_dir {
        kept.keep_state(directory);
    }
    kept
}

/// Protects the configuration file and the files in the user's state directory.
pub(crate) fn keep_own_files(kept: &mut KeptFiles) {
    if let Ok(directories) = crate::files::directories::directories() {
        kept.keep("the configuration file", &directories.config_file());
        kept.keep_state(&directories.state);
    }
}

/// Returns the reason why `save` cannot work, as a sentence. The user should know it at the start, not when typing
/// `save`.
pub(crate) fn storage_notice(store: &Store) -> Option<String> {
    store.refusal().map(|refusal| format!("`save` cannot work: {refusal}."))
}
