//! Reads the scenario, plan or run that the user names, with its options, into a definition of all flights.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::{Path, PathBuf};

use super::of_plan;
use crate::args::{
    CampaignArgs, FirmwareArgs, FirmwareChoice, FirmwarePortArgs, FlightArgs, PhysicsArgs, PlanArg,
};
use crate::design::fingerprint;
use crate::files::input_file;
use crate::headless::campaign::sources::Sources;
use crate::headless::scenario_folder::ScenarioFolder;
use crate::headless::setup;
use crate::launch;
use crate::launch::{Beside, Chosen, RemoteFirmware};
use crate::link::conventions::FirmwareClock;
use crate::plan::builtin::BuiltinPlan;
use crate::process::error;
use crate::process::error::AppError;
use crate::report::campaign::{Contents, Definition, OtherSide, RunHeader};
use crate::report::check::STANDARD_INPUT;
use crate::scenario::BuiltinScenario;

/// The longest first line of a run's file, bytes: all files of the campaign are in it.
pub(super) const MAX_HEADER: u64 = 64 << 20;

/// A campaign as the user names it.
pub(super) enum Wanted {
    /// The file of an earlier run, to go on.
    Run(PathBuf, Box<RunHeader>),
    /// A scenario, with the reader of the files that it names.
    Scenario(Box<Definition>, Sources),
    /// A plan, with its file.
    Plan(Box<Definition>, Sources),
}

/// Reads what the user names, with the options.
pub(super) fn read(args: &CampaignArgs) -> Result<Wanted, AppError> {
    let name = args.what.as_deref().unwrap_or_default();
    if let Some(plan) = BuiltinPlan::find(name) {
        if BuiltinScenario::find(name).is_some() {
            error::tell(&format!("{name} is also a built-in scenario; here it is the plan."));
        }
        return of_plan(args, &PlanArg::Builtin(plan), None);
    }
    let place = |scenario: &Path| ScenarioFolder::of(scenario, args.any_folder);
    if let Some(scenario) = BuiltinScenario::find(name) {
        return of_scenario(args, scenario.name, scenario.text.to_owned(), None);
    }
    if name == "-" {
        let bytes = input_file::read_stdin()?;
        return match scenario_text(&bytes) {
            Some(text) => of_scenario(args, STANDARD_INPUT, text, Some(place("".as_ref()))),
            None => of_plan(args, &PlanArg::Stdin(None), Some(&bytes)),
        };
    }
    let path = Path::new(name);
    if let Some(header) = run_header(path)? {
        refuse_options_of_run(args, name)?;
        return Ok(Wanted::Run(path.to_owned(), Box::new(header)));
    }
    if !path.exists() && !name.contains(['/', '.']) {
        let guess = BuiltinPlan::suggest(name).or(BuiltinScenario::suggest(name));
        let guess = guess.map_or_else(String::new, |name| format!("; did you mean {name}?"));
        return Err(AppError::input(format!(
            "{name} is neither a file, nor a built-in plan or scenario{guess} (betadeck plan list and betadeck check \
             --list show them)"
        )));
    }
    let bytes = input_file::read_plan(path)?;
    if let Some(text) = scenario_text(&bytes) {
        return of_scenario(args, name, text, Some(place(path)));
    }
    let plan = name.parse().map_err(|error| AppError::input(format!("{name}: {error}")))?;
    of_plan(args, &plan, Some(&bytes))
}

/// Returns the header if a path leads to the file of a run.
fn run_header(path: &Path) -> Result<Option<RunHeader>, AppError> {
    let Some(line) = first_line(path).filter(|line| RunHeader::begins(line)) else { return Ok(None) };
    let read = RunHeader::read(line.trim_end());
    read.map(Some).map_err(|problem| AppError::input(format!("{} {problem}", path.display())))
}

/// Returns the first line of a file that may be JSON.
fn first_line(path: &Path) -> Option<String> {
    let file = File::open(path).ok().filter(|_| path.is_file())?;
    let mut line = Vec::new();
    let mut reader = BufReader::new(file.take(MAX_HEADER));
    // Most other files are recognised by their first byte.
    if reader.fill_buf().ok()?.first() != Some(&b'{') {
        return None;
    }
    reader.read_until(b'\n', &mut line).ok()?;
    String::from_utf8(line).ok()
}

/// Returns the text if it is that of a scenario.
fn scenario_text(bytes: &[u8]) -> Option<String> {
    let text = std::str::from_utf8(bytes).ok()?;
    let lines = || text.trim_start_matches('\u{feff}').lines().map(str::trim_start);
    let has_format = lines()
        .take_while(|line| !line.starts_with('['))
        .any(|line| line.strip_prefix("format").is_some_and(|rest| rest.trim_start().starts_with('=')));
    let has_plan = lines().any(|line| line.starts_with("[plan]"));
    (has_format || has_plan).then(|| text.to_owned())
}

fn refuse_options_of_run(args: &CampaignArgs, name: &str) -> Result<(), AppError> {
    let mut given = args.of_plan();
    let more = [
        ("--flights", args.flights.is_some()),
        ("--design", args.design.is_some()),
        ("--seeds", args.seeds.is_some()),
        ("--vs", args.has_two_sides()),
        ("--out", args.out.is_some()),
        ("--shard", args.shard.is_some()),
    ];
    given.extend(more.into_iter().filter(|(_, is_given)| *is_given).map(|(option, _)| option));
    match given.first() {
        None => Ok(()),
        Some(option) => Err(AppError::input(format!(
            "{option} has no meaning here: {name} is a run that says it all; leave it out"
        ))),
    }
}

fn of_scenario(
    args: &CampaignArgs,
    name: &str,
    text: String,
    place: Option<ScenarioFolder>,
) -> Result<Wanted, AppError> {
    if let Some(option) = args.of_plan().first() {
        return Err(AppError::input(format!(
            "{option} is for a plan, and {name} is a scenario: write it into the file, or name the plan"
        )));
    }
    let definition = Definition { file: name.to_owned(), text, ..common(args)? };
    Ok(Wanted::Scenario(Box::new(definition), Sources { place, ..Sources::default() }))
}

/// Returns the campaign of a plan, whose bytes were read unless it is built in.
fn of_plan(args: &CampaignArgs, plan: &PlanArg, bytes: Option<&[u8]>) -> Result<Wanted, AppError> {
    let place = ScenarioFolder { names_any: true, ..ScenarioFolder::default() };
    let mut sources = Sources { place: Some(place), ..Sources::default() };
    let file = bytes.map(|bytes| {
        let name = match plan {
            // Without an extension the contents show the format.
            PlanArg::Stdin(_) => "standard-input".to_owned(),
            _ => plan.display_name(),
        };
        sources.contents.insert(name.clone(), Contents::new(bytes));
        name
    });
    let text = of_plan::text(args, plan, file.as_deref())?;
    let needs_terrain = args.flight.terrain.directory.is_some()
        || args.flight.world.iter().any(|switch| switch.replace(' ', "") == "ground=terrain");
    let terrain = needs_terrain.then(|| {
        let directory = args.flight.terrain.directory.as_ref();
        directory.map_or_else(String::new, |directory| directory.display().to_string())
    });
    let definition = Definition { file: plan.display_name(), text, terrain, ..common(args)? };
    Ok(Wanted::Plan(Box::new(definition), sources))
}

/// Returns the parts of a definition that scenarios and plans share.
fn common(args: &CampaignArgs) -> Result<Definition, AppError> {
    let mut notices = Vec::new();
    let (flight, physics) = (FlightArgs::default(), PhysicsArgs::default());
    let beside = Beside { ports: (&args.firmware_ports).into(), flight: &flight, physics: &physics };
    let chosen = launch::choose(&args.firmware, beside, &mut notices)?;
    let versus = args.has_two_sides().then(|| other_side(args, beside, &mut notices)).transpose()?;
    let is_remote = chosen.is_some() || versus.as_ref().is_some_and(|side| !side.firmware.is_empty());
    notices.extend(args.firmware_ports.idle_options(is_remote));
    notices.iter().for_each(|notice| error::tell(notice));
    let (firmware, firmware_print) = of_firmware(chosen.as_ref())?;
    Ok(Definition {
        flights: args.flights,
        design: args.design.map(|design| design.to_string()),
        seeds: args.seeds,
        firmware,
        firmware_print,
        versus,
        ..Definition::default()
    })
}

fn other_side(
    args: &CampaignArgs,
    beside: Beside<'_>,
    notices: &mut Vec<String>,
) -> Result<OtherSide, AppError> {
    let mut settings = Vec::new();
    if let Some(path) = &args.vs_settings {
        let text = input_file::read(path)?;
        let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
        for line in lines {
            let setting = line.strip_prefix("set ").and_then(crate::plan::format::setting_line);
            settings.extend(setting);
        }
        if settings.is_empty() {
            let name = path.display();
            return Err(AppError::input(format!("--vs-settings {name} has no line `set NAME = VALUE`")));
        }
    }
    settings.extend(args.vs.iter().cloned());
    let Some(choice) = &args.vs_firmware else {
        return Ok(OtherSide { settings, ..OtherSide::default() });
    };
    let chosen = Chosen::by_option(choice.clone()).check(&args.firmware.link, beside, notices)?;
    let (firmware, firmware_print) = of_firmware(chosen.as_ref())?;
    Ok(OtherSide { settings, has_firmware: true, firmware, firmware_print })
}

/// Returns the options that choose a firmware again, and the fingerprint of its executable.
fn of_firmware(firmware: Option<&RemoteFirmware>) -> Result<(Vec<String>, Option<String>), AppError> {
    let Some(firmware) = firmware else { return Ok((Vec::new(), None)) };
    let Some(executable) = firmware.executable.as_ref().filter(|_| firmware.clock == FirmwareClock::Sim)
    else {
        return Err(AppError::input(
            "a campaign flies an executable in simulated time: name its path with --firmware, without --clock real",
        ));
    };
    let ports = firmware.ports;
    let udp = ports.udp;
    let mut words = vec!["--firmware".to_owned(), executable.display().to_string()];
    words.extend(firmware.arguments.iter().map(|argument| format!("--firmware-arg={argument}")));
    words.extend([
        format!("--tcp-port={}", ports.tcp),
        format!("--udp-ports={},{},{},{}", udp.raw, udp.motors, udp.fdm, udp.rc),
        format!("--fdm-dialect={}", ports.dialect),
        format!("--motor-order={}", ports.motor_order),
    ]);
    Ok((words, Some(print_of(executable)?)))
}

/// Returns the fingerprint of a file.
pub(super) fn print_of(path: &Path) -> Result<String, AppError> {
    if !path.is_file() {
        return Err(AppError::environment(format!("cannot read {}: it is not a file", path.display())));
    }
    let bytes = std::fs::read(path)
        .map_err(|error| AppError::environment(format!("cannot read {}: {error}", path.display())))?;
    Ok(format!("{:016x}", fingerprint(&bytes)))
}

/// Returns the firmware that these options choose; `None` = the embedded one.
pub(super) fn firmware_of(words: &[String], print: Option<&str>) -> Result<Option<RemoteFirmware>, AppError> {
    let Some((args, ports)) = named_firmware(words)? else { return Ok(None) };
    let (flight, physics) = (FlightArgs::default(), PhysicsArgs::default());
    let beside = Beside { ports: (&ports).into(), flight: &flight, physics: &physics };
    let firmware = launch::choose(&args, beside, &mut Vec::new())?;
    if let Some(executable) = firmware.as_ref().and_then(|firmware| firmware.executable.as_ref())
        && let Some(print) = print
        && print_of(executable)? != print
    {
        return Err(AppError::input(format!(
            "{} is not the executable that flew the campaign: it has changed since",
            executable.display()
        )));
    }
    // The same check as that of the options that began the campaign.
    of_firmware(firmware.as_ref())?;
    Ok(firmware)
}

/// Parses the options of a firmware that a definition holds; `None` for the embedded one. A campaign writes the path of an
/// executable and its link only, so that other options are refused: who wrote a file must not choose how it is started.
///
/// # Errors
/// Returns a sentence with the options.
fn named_firmware(words: &[String]) -> Result<Option<(FirmwareArgs, FirmwarePortArgs)>, AppError> {
    if words.is_empty() {
        return Ok(None);
    }
    let (args, ports) = crate::args::firmware_options(words).map_err(AppError::input)?;
    let is_executable = matches!(args.firmware, Some(FirmwareChoice::Executable(_)));
    if !is_executable || args.link.betaloop.is_some() || args.link.yes || args.link.clock.is_some() {
        return Err(AppError::input(format!(
            "the campaign names its firmware by options that no campaign writes, {}: allowed are --firmware PATH and the \
             options of its link",
            words.join(" ")
        )));
    }
    Ok(Some((args, ports)))
}

/// Returns the executable that the options of a definition name.
///
/// # Errors
/// Returns a sentence about options that no campaign writes.
pub(super) fn executable_of(words: &[String]) -> Result<Option<PathBuf>, AppError> {
    Ok(named_firmware(words)?.and_then(|(args, _)| match args.firmware {
        Some(FirmwareChoice::Executable(path)) => Some(path),
        _ => None,
    }))
}

/// Checks that the embedded firmware accepts the settings of the other side.
pub(super) fn check_other_side(side: &OtherSide, is_embedded: bool) -> Result<(), AppError> {
    if is_embedded { setup::check_set(&side.settings) } else { Ok(()) }
}
