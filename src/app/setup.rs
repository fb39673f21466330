//! Builds the vehicle that the options ask for.

use std::io::Read as _;
use std::path::Path;

use super::AppError;
use super::sitl::{DECLINATION_DEG, GPS_TIMEOUT_S};
use crate::args::{Attitude, FlightArgs, PlanArg};
use crate::firmware::cli::{
    BuildInfo, CliContext, CliFacts, CliReply, Interpreter, Mode, advice, apply_lines,
};
use crate::firmware::config::Configuration;
use crate::firmware::settings;
use crate::firmware::{AttitudeSource, FirmwareOptions};
use crate::plan::builtin::BuiltinPlan;
use crate::plan::format::{self, PlanFile, Problems, SettingPart};
use crate::record::UtcSeconds;
use crate::sim::{Airframe, FaultLink, Noise, ScheduledFault, Wind, WorldConfig};
use crate::storage::Store;
use crate::vehicle::{Vehicle, VehicleConfig};

/// Largest plan or settings file that is read, bytes.
const MAX_FILE: u64 = 4 << 20;

/// Reads a plan from wherever it is.
pub(super) fn read_plan(plan: &PlanArg) -> Result<PlanFile, AppError> {
    let name = plan.display_name();
    let text = match plan {
        PlanArg::Builtin(BuiltinPlan { text, .. }) => (*text).to_owned(),
        PlanArg::Stdin(_) => read_text(std::io::stdin().lock(), "standard input")?,
        PlanArg::File(path, _) => read_file(path)?,
    };
    format::parse_checked(&name, &text, plan.format(&text), settings::judge)
        .map_err(|errors| AppError::input(format::report(&errors).trim_end().to_owned()))
}

/// Reads a text file of sensible size.
pub(super) fn read_file(path: &Path) -> Result<String, AppError> {
    let name = path.display().to_string();
    let file = std::fs::File::open(path)
        .map_err(|error| AppError::environment(format!("cannot open {name}: {error}")))?;
    read_text(file, &name)
}

fn read_text(source: impl std::io::Read, name: &str) -> Result<String, AppError> {
    let mut bytes = Vec::new();
    source
        .take(MAX_FILE + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| AppError::environment(format!("cannot read {name}: {error}")))?;
    if bytes.len() as u64 > MAX_FILE {
        return Err(AppError::input(format!("{name} is larger than 4 MiB: that is no plan and no settings")));
    }
    String::from_utf8(bytes).map_err(|_| AppError::input(format!("{name} is not a text file (UTF-8)")))
}

/// What a command adds to the shared options.
#[derive(Debug, Default)]
pub(super) struct Extras {
    /// Faults of the flight.
    pub faults: Vec<ScheduledFault>,
    /// Settings after all other sources, as `name=value`.
    pub set: Vec<String>,
    /// Settings of the plan.
    pub plan_settings: Vec<String>,
    /// The default of `--arm-assist`.
    pub arm_assist: bool,
    /// Doors or files can influence the flight.
    pub live: bool,
    /// A simulator outside moves the craft.
    pub external: bool,
}

/// Builds a vehicle at boot. Notices for the user are added to `notices`.
pub(super) fn vehicle(
    args: &FlightArgs,
    plan: &PlanFile,
    store: &mut Store,
    extras: Extras,
    notices: &mut Vec<String>,
) -> Result<Vehicle, AppError> {
    let rate_hz = args.rate_hz();
    let usual = if extras.external { Attitude::Truth } else { Attitude::Estimated };
    let mut firmware = FirmwareOptions {
        rate_hz,
        arm_assist: args.arm_assist.map_or(extras.arm_assist, crate::args::OnOff::is_on),
        attitude: match args.attitude.unwrap_or(usual) {
            Attitude::Truth => AttitudeSource::Truth,
            Attitude::Estimated => AttitudeSource::Estimated,
        },
        ..FirmwareOptions::default()
    };
    let world = if extras.external {
        firmware.gps_timeout_s = GPS_TIMEOUT_S;
        firmware.declination_deg = DECLINATION_DEG;
        let seed = args.seed.unwrap_or(WorldConfig::default().seed);
        WorldConfig { rate_hz, seed, faults: extras.faults, ..WorldConfig::default() }
    } else {
        world(args, plan, rate_hz, extras.faults, notices)?
    };
    let mut configuration = load(store, notices);
    let plan_lines = set_lines(&extras.plan_settings);
    apply(&mut configuration, &plan_lines, &format!("settings of plan {}", plan.name))?;
    if let Some(path) = &args.settings {
        apply(&mut configuration, &read_file(path)?, &path.display().to_string())?;
    }
    apply(&mut configuration, &set_lines(&extras.set), "--set")?;
    let config = VehicleConfig { world, firmware, configuration, live: extras.live };
    let vehicle = if extras.external { Vehicle::moved_from_outside(config) } else { Vehicle::new(config) };
    let mut vehicle = vehicle.map_err(|error| AppError::input(error.to_string()))?;
    vehicle.firmware_mut().set_build(build_info());
    Ok(vehicle)
}

/// The embedded world.
fn world(
    args: &FlightArgs,
    plan: &PlanFile,
    rate_hz: u32,
    faults: Vec<ScheduledFault>,
    notices: &mut Vec<String>,
) -> Result<WorldConfig, AppError> {
    let (home, guess) = args.start(plan.home, &plan.plan);
    notices.extend(guess);
    Ok(WorldConfig {
        airframe: airframe(args.airframe.as_deref())?,
        home,
        rate_hz,
        seed: args.seed.unwrap_or(1),
        noise: args.noise.unwrap_or(Noise::Real),
        wind: args.wind.unwrap_or(Wind::CALM),
        gust_mps: args.gust.unwrap_or(0.0),
        turbulence: args.turbulence.unwrap_or_default(),
        switches: args.switches().map_err(|error| AppError::input(error.to_string()))?,
        faults,
        link: FaultLink::Embedded,
    })
}

/// What the CLI's `version` and MSP tell about this executable.
pub(super) fn build_info() -> BuildInfo {
    let epoch = env!("BETADECK_BUILD_EPOCH").parse().unwrap_or_default();
    let (date, time) = UtcSeconds(epoch).build_stamp();
    BuildInfo { date, time, revision: env!("BETADECK_REVISION").to_owned(), ..BuildInfo::default() }
}

/// The stored configuration, with the starter modes when it has no modes at all.
pub(super) fn load(store: &mut Store, notices: &mut Vec<String>) -> Configuration {
    let loaded = store.load();
    notices.extend(loaded.findings);
    let mut configuration = loaded.configuration;
    if configuration.starter_modes() {
        notices.push(
            "The craft had no modes: ARM is on AUX1, AUTOPILOT on AUX2, ANGLE, ALTHOLD and POS HOLD on AUX3, each above \
             1700 µs; the CLI command save keeps them."
                .to_owned(),
        );
    }
    configuration
}

fn set_lines(settings: &[String]) -> String {
    settings.iter().map(|setting| format!("set {setting}\n")).collect()
}

/// Applies command lines at boot, as if typed; all refused lines are reported with their places.
fn apply(configuration: &mut Configuration, text: &str, source: &str) -> Result<(), AppError> {
    let facts = CliFacts::default();
    let mut context = CliContext { configuration, facts: &facts };
    let mut reasons = Vec::new();
    let report = apply_lines(text.lines(), &mut Interpreter::new(Mode::File), &mut context, |line, reply| {
        if reply.failed {
            reasons.push(refusal(line, reply));
        }
    });
    let mut problems = Problems::new(source, text);
    for (failed, (span, message, hint)) in std::iter::zip(&report.failed, reasons) {
        problems.add_line_part(failed.number, span, message, hint);
    }
    if problems.is_empty() {
        return Ok(());
    }
    Err(AppError::input(format::report(&problems.into_errors())))
}

/// The part of a refused line that is wrong, what is wrong with it, and what is allowed.
fn refusal(line: &str, reply: &CliReply) -> (String, String, String) {
    let setting =
        line.split_once(' ').filter(|(word, _)| word.eq_ignore_ascii_case("set")).map(|(_, rest)| rest);
    if let Some((name, value)) = setting.and_then(|rest| rest.split_once('='))
        && let Err(fault) = settings::judge(name.trim(), value.trim())
    {
        let part = if fault.part == SettingPart::Name { name } else { value };
        return (part.trim().to_owned(), fault.message, fault.hint);
    }
    let mut said = reply.text.lines().filter(|line| !line.is_empty());
    let message = said.next().unwrap_or("refused").trim_matches('#').to_owned();
    let hint = said.map(str::to_owned).chain(advice(line, reply)).collect::<Vec<_>>().join(" ");
    (line.to_owned(), message, hint)
}

fn airframe(name: Option<&str>) -> Result<Airframe, AppError> {
    let name = name.unwrap_or("iris");
    match name.parse() {
        Ok(airframe) => Ok(airframe),
        Err(_) if Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) => {
            let text = read_file(Path::new(name))?;
            Airframe::from_toml(&text).map_err(|error| AppError::input(error.in_file(name).to_string()))
        }
        Err(error) => Err(AppError::input(format!("--airframe: {error}"))),
    }
}

/// The directory of `--state-dir`, the user's, or none with `--fresh`.
pub(super) fn open_store(args: &FlightArgs) -> Result<Store, AppError> {
    if args.fresh {
        return Ok(Store::in_memory());
    }
    let directory = match &args.state_dir {
        Some(directory) => directory.clone(),
        None => super::layers::directories()?.state,
    };
    Store::open(&directory, false).map_err(|error| AppError::environment(error.to_string()))
}

/// Why `save` cannot work, as a sentence: better known at the start than when it is typed.
pub(super) fn storage_notice(store: &Store) -> Option<String> {
    store.refusal().map(|refusal| format!("`save` cannot work: {refusal}."))
}
