//! Reads the named scenarios.

use std::path::{Path, PathBuf};

use crate::args::{CheckArgs, MAX_ALLOWED_FLIGHTS};
use crate::files::input_file;
use crate::headless::check::run::is_wanted;
use crate::headless::scenario_folder;
use crate::headless::scenario_folder::ScenarioFolder;
use crate::plan::format::{self, PlanFile};
use crate::process::error;
use crate::process::error::AppError;
use crate::report::check::STANDARD_INPUT;
use crate::scenario::{
    self, BuiltinFiles, BuiltinScenario, Files, Flights, MISSION, Request, SCENARIOS, Scenario, mission,
    mission_number, read_request,
};
use crate::telemetry::FirmwareProfile;

#[derive(Debug)]
pub(super) struct Loaded {
    /// The scenarios in the order of the arguments.
    pub(super) scenarios: Vec<Scenario>,
    /// The files that were read.
    pub(super) files: Vec<PathBuf>,
    /// The number of slow scenarios that were left out.
    pub(super) left_out: usize,
    /// `true` if the seeds come from the command line.
    pub(super) seeds_are_given: bool,
    /// The laws of the embedded firmware from the command line.
    pub(super) profile: Option<FirmwareProfile>,
}

/// The source of a scenario.
enum Source {
    Builtin(BuiltinScenario),
    /// The random mission with this number.
    Mission(u64),
    File(PathBuf),
    Stdin,
}

/// Reads the scenarios in the arguments. All problems of all files are reported together.
pub(super) fn load(args: &CheckArgs) -> Result<Loaded, AppError> {
    let mut loaded = Loaded {
        scenarios: Vec::new(),
        files: Vec::new(),
        left_out: 0,
        seeds_are_given: args.seeds.is_some(),
        profile: args.profile,
    };
    let mut problems = Vec::new();
    let seeds = args.seeds.as_ref().map(|seeds| seeds.0.as_slice());
    for (source, is_named) in sources(args)? {
        match read(&source, seeds, args.most_flights(), args.any_folder, &mut loaded.files) {
            Ok(scenario) if scenario.slow && !args.slow && !is_named => loaded.left_out += 1,
            // Of many thousand scenarios only those that are flown are kept.
            Ok(scenario) if !scenario.cases.iter().any(|case| is_wanted(&scenario, case, args)) => {}
            Ok(mut scenario) => {
                if let Some(profile) = args.profile {
                    scenario.use_profile(profile);
                }
                loaded.scenarios.push(scenario);
            }
            Err(error) if error.code == crate::process::error::USAGE => problems.push(error.message),
            Err(error) => return Err(error),
        }
    }
    if problems.is_empty() { Ok(loaded) } else { Err(AppError::input(problems.join("\n"))) }
}

/// Reads the scenario with a name, as for `open`. Seeds replace those of the file.
pub(crate) fn load_one(name: &str, seeds: Option<&[u64]>, names_any: bool) -> Result<Scenario, AppError> {
    let (source, _) = source(name)?;
    // `open` shows only one of the flights, so the user's limit does not apply.
    read(&source, seeds, MAX_ALLOWED_FLIGHTS as usize, names_any, &mut Vec::new())
}

/// Reads a scenario, or a plan as a scenario with these lines. Seeds replace those of the file. Returns `true` for a plan.
pub(crate) fn load_or_plan(
    path: &Path,
    lines: &str,
    seeds: Option<&[u64]>,
) -> Result<(Scenario, bool), AppError> {
    let name = path.display().to_string();
    let contents = input_file::read_plan(path)?;
    if std::str::from_utf8(&contents).is_ok_and(is_scenario) {
        return Ok((load_one(&name, seeds, true)?, false));
    }
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let text = format!("format = 1\n{lines}\n[plan]\nfile = {}\n", toml_text(&file));
    let request = Request { file: &name, text: &text, seeds, max_flights: 100, flights: Flights::Listed };
    let scenario =
        read_request(&request, &mut Beside { place: ScenarioFolder::of(path, true), read: &mut Vec::new() });
    scenario
        .map(|scenario| (scenario, true))
        .map_err(|errors| AppError::input(format::report(&errors).trim_end().to_owned()))
}

/// Returns a text as a TOML string.
fn toml_text(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Returns the sources in the arguments, each with `true` if the argument is the scenario itself.
fn sources(args: &CheckArgs) -> Result<Vec<(Source, bool)>, AppError> {
    if args.what.is_empty() {
        return Ok(SCENARIOS.iter().map(|&scenario| (Source::Builtin(scenario), false)).collect());
    }
    let mut sources = Vec::new();
    for name in &args.what {
        if Path::new(name).is_dir() {
            sources
                .extend(in_directory(Path::new(name))?.into_iter().map(|file| (Source::File(file), false)));
        } else {
            sources.push(source(name)?);
        }
    }
    Ok(sources)
}

fn source(name: &str) -> Result<(Source, bool), AppError> {
    if name == "-" {
        return Ok((Source::Stdin, true));
    }
    if let Some(scenario) = BuiltinScenario::find(name) {
        return Ok((Source::Builtin(scenario), true));
    }
    if let Some(number) = mission_number(name) {
        return Ok((Source::Mission(number), true));
    }
    let path = PathBuf::from(name);
    if path.exists() || name.contains('/') || name.ends_with(".toml") {
        return Ok((Source::File(path), true));
    }
    let guess = BuiltinScenario::suggest(name);
    let guess = guess.map_or_else(String::new, |name| format!("; did you mean {name}?"));
    Err(AppError::input(format!(
        "{name} is neither a built-in scenario nor a file{guess} (betadeck check --list shows the built-in ones)"
    )))
}

/// Returns the scenarios of a directory, in the order of their names. Skips plans and other TOML files.
fn in_directory(directory: &Path) -> Result<Vec<PathBuf>, AppError> {
    let name = directory.display();
    let cannot = |error: std::io::Error| AppError::environment(format!("cannot read {name}: {error}"));
    let mut files = Vec::new();
    for entry in std::fs::read_dir(directory).map_err(cannot)? {
        let path = entry.map_err(cannot)?.path();
        let is_toml = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
        if is_toml && path.is_file() && is_scenario(&input_file::read_small(&path)?) {
            files.push(path);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(AppError::input(format!(
            "{name} has no scenario: a scenario is a *.toml file with format = {}",
            scenario::FORMAT
        )));
    }
    Ok(files)
}

/// Returns `true` if a TOML file is a scenario: it begins with its format, or it has an expectation.
fn is_scenario(text: &str) -> bool {
    if text.lines().any(|line| line.trim_start().starts_with("[[expect]]")) {
        return true;
    }
    text.trim_start_matches('\u{feff}').lines().take_while(|line| !line.trim_start().starts_with('[')).any(
        |line| {
            line.trim_start().strip_prefix("format").is_some_and(|rest| rest.trim_start().starts_with('='))
        },
    )
}

fn read(
    source: &Source,
    seeds: Option<&[u64]>,
    max_flights: usize,
    names_any: bool,
    read: &mut Vec<PathBuf>,
) -> Result<Scenario, AppError> {
    let request = |file, text| Request { file, text, seeds, max_flights, flights: Flights::Listed };
    let scenario = match source {
        Source::Builtin(builtin) => read_request(&request(builtin.name, builtin.text), &mut BuiltinFiles),
        Source::Mission(number) => {
            let name = format!("{MISSION}{number}");
            read_request(&request(&name, &mission(*number)), &mut BuiltinFiles)
        }
        Source::Stdin => {
            let text = input_file::read_stdin_text()?;
            let place = ScenarioFolder { names_any, ..ScenarioFolder::default() };
            let mut beside = Beside { place, read };
            read_request(&request(STANDARD_INPUT, &text), &mut beside)
        }
        Source::File(path) => {
            let text = input_file::read_small(path)?;
            read.push(path.clone());
            let place = ScenarioFolder::of(path, names_any);
            let name = path.display().to_string();
            read_request(&request(&name, &text), &mut Beside { place, read })
        }
    };
    scenario.map_err(|errors| AppError::input(format::report(&errors).trim_end().to_owned()))
}

/// Reads files with names relative to the place of a scenario.
struct Beside<'f> {
    place: ScenarioFolder,
    read: &'f mut Vec<PathBuf>,
}

impl Files for Beside<'_> {
    fn plan(&mut self, name: &str) -> Result<PlanFile, String> {
        let path = self.place.path(name)?;
        let contents = input_file::read_plan(&path).map_err(|error| error.message)?;
        self.read.push(path);
        let (plan, findings) = scenario_folder::read_plan(name, &contents)?;
        findings.iter().for_each(|found| error::tell(&format!("{name}: {found}")));
        Ok(plan)
    }

    fn text(&mut self, name: &str) -> Result<String, String> {
        let path = self.place.path(name)?;
        let text = input_file::read_small(&path).map_err(|error| error.message)?;
        self.read.push(path);
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_scenarios_of_the_filter_are_kept() {
        let all = CheckArgs { slow: true, ..CheckArgs::default() };
        let wanted = SCENARIOS[3].name;
        let one = CheckArgs { filter: Some(wanted.to_owned()), ..all.clone() };
        let kept = load(&one).unwrap().scenarios;
        assert!(kept.iter().any(|scenario| scenario.name == wanted));
        assert!(kept.len() < load(&all).unwrap().scenarios.len() / 2, "{}", kept.len());
        let none = CheckArgs { filter: Some("no such name".to_owned()), ..all };
        assert!(load(&none).unwrap().scenarios.is_empty());
    }
}
