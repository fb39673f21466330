//! `betadeck compare`: the same plan, air and seed on two firmwares.

mod flights;
mod recorder;

use std::io::Write as _;

use super::error::{self, AppError};
use super::firmware::{self, Beside, RemoteFirmware};
use super::{output_file, setup};
use crate::args::{CompareArgs, FirmwareChoice, FlightArgs, OutputFile, PhysicsArgs};
use crate::record::compare::{Comparison, Side};
use flights::Flights;

/// Flies and compares; the exit code says whether all flights completed.
pub(super) fn run(args: &CompareArgs) -> Result<u8, AppError> {
    let mut notices = Vec::new();
    let choices = choices(args, &mut notices)?;
    let physics = PhysicsArgs::default();
    let beside = Beside { ports: (&args.firmware_ports).into(), flight: &args.flight, physics: &physics };
    let mut found: Vec<Option<RemoteFirmware>> = Vec::new();
    for choice in &choices {
        found.push(firmware::check(choice, &args.link, beside)?);
    }
    let names = names(&choices);
    let outside = found.iter().any(Option::is_some);
    notices.extend(args.firmware_ports.idle_options(outside));
    if args.flight.speed.is_some() && !outside {
        notices.push(
            "--speed has no effect: the embedded firmware is flown as fast as the machine allows.".to_owned(),
        );
    }
    let mut outputs = Outputs::open(args)?;
    let starts_fresh =
        |firmware: &RemoteFirmware| firmware.executable.is_some() && args.flight.state_dir.is_none();
    let beside_fresh = found.iter().flatten().any(starts_fresh);
    let flights = Flights::new(args, found.contains(&None), beside_fresh, &mut notices)?;
    notices.iter().for_each(|notice| error::tell(notice));
    let mut sides = Vec::new();
    for (name, firmware) in names.into_iter().zip(&found) {
        let repeatable = firmware.is_none();
        let times = if repeatable { 1 } else { args.repeat() };
        let mut side = Side { name, repeatable, flights: Vec::new() };
        for time in 1..=times {
            let Some(track) = flights.fly(firmware.as_ref())? else { return Ok(error::INTERRUPTED) };
            error::tell(&format!(
                "{}, flight {time} of {times}: {}: {}",
                side.name, track.result, track.reason
            ));
            side.flights.push(track);
        }
        sides.push(side);
    }
    let all_complete = sides.iter().flat_map(|side| &side.flights).all(|flight| flight.result == "complete");
    let sides: [Side; 2] = sides.try_into().map_err(|_| AppError::internal("two firmwares are compared"))?;
    let comparison = Comparison::new(flights.plan_name(), &conditions(&args.flight), flights.route(), sides);
    outputs.write(&comparison)?;
    Ok(if all_complete { 0 } else { error::FAILED })
}

/// The two that are compared: with one, the first is the embedded one.
fn choices(args: &CompareArgs, notices: &mut Vec<String>) -> Result<[FirmwareChoice; 2], AppError> {
    let of_file =
        args.link.betaloop.as_deref().map(|file| firmware::of_launcher(file, notices)).transpose()?;
    match (&args.firmware[..], of_file) {
        ([first, second], _) => Ok([first.clone(), second.clone()]),
        ([other], _) => Ok([FirmwareChoice::Embedded, other.clone()]),
        (_, Some(other)) => Ok([FirmwareChoice::Embedded, other]),
        (_, None) => Err(AppError::input("name the firmware to compare with: --firmware PATH")),
    }
}

/// What they are called: by their files, with the path where the files are called alike.
fn names(choices: &[FirmwareChoice; 2]) -> [String; 2] {
    let short = choices.each_ref().map(|choice| match choice {
        FirmwareChoice::Embedded => "embedded".to_owned(),
        FirmwareChoice::Attach => "the running one".to_owned(),
        FirmwareChoice::Executable(path) => {
            path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
        }
    });
    match (choices, &short) {
        ([FirmwareChoice::Executable(a), FirmwareChoice::Executable(b)], [first, second])
            if first == second =>
        {
            [a, b].map(|path| path.display().to_string())
        }
        _ => short,
    }
}

/// The air and the seed, for people.
fn conditions(flight: &FlightArgs) -> String {
    let mut told = vec![flight.wind.map_or_else(|| "calm".to_owned(), |wind| format!("wind {wind}"))];
    told.extend(flight.gust.map(|gust| format!("gusts {gust} m/s")));
    told.extend(flight.turbulence.map(|level| format!("turbulence {level}")));
    told.extend(flight.noise.map(|noise| format!("noise {noise}")));
    told.push(format!("seed {}", flight.seed.unwrap_or(1)));
    told.join(", ")
}

/// Where the comparison goes.
#[derive(Debug)]
struct Outputs<'a> {
    args: &'a CompareArgs,
    json: Option<std::fs::File>,
    svg: Option<std::fs::File>,
}

impl<'a> Outputs<'a> {
    /// Opens the files, so that no flight is flown for nothing.
    fn open(args: &'a CompareArgs) -> Result<Self, AppError> {
        let mut kept = setup::kept_files(&args.flight, Some(&args.plan));
        let json = match &args.json {
            Some(OutputFile::File(path)) => Some(("--json", path)),
            Some(OutputFile::Stdout) | None => None,
        };
        let svg = args.svg.as_ref().map(|path| ("--svg", path));
        for (option, path) in json.iter().chain(&svg) {
            kept.claim(option, path)?;
        }
        let create = |file: Option<(&str, &std::path::PathBuf)>| {
            file.map(|(_, path)| output_file::create(path)).transpose()
        };
        Ok(Self { args, json: create(json)?, svg: create(svg)? })
    }

    fn write(&mut self, comparison: &Comparison) -> Result<(), AppError> {
        let failed = |error| AppError::environment(format!("cannot write the output: {error}"));
        let json = format!("{}\n", comparison.json());
        if let Some(file) = &mut self.json {
            file.write_all(json.as_bytes()).map_err(failed)?;
        }
        if let Some(file) = &mut self.svg {
            file.write_all(comparison.svg().as_bytes()).map_err(failed)?;
        }
        match &self.args.json {
            Some(OutputFile::Stdout) => error::write_stdout(json.as_bytes()),
            Some(OutputFile::File(_)) | None => error::print(&comparison.text()),
        }?;
        Ok(())
    }
}
