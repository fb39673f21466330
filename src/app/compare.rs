//! `betadeck compare`: the same plan, air and seed on two firmwares.

mod flights;
mod outputs;
mod recorder;

use super::error::{self, AppError};
use super::firmware::{Beside, Chosen, RemoteFirmware};
use crate::args::{CompareArgs, FirmwareChoice, FlightArgs, PhysicsArgs};
use crate::report::compare::{Comparison, Side};
use flights::Flights;
use outputs::Outputs;

/// A firmware in the comparison.
#[derive(Debug)]
struct Compared {
    /// The name of the firmware.
    name: String,
    /// `None` = the embedded firmware.
    firmware: Option<RemoteFirmware>,
    /// The number of flights.
    times: u32,
}

/// Flies and compares. The exit code is 0 if all flights completed.
pub(super) fn run(args: &CompareArgs) -> Result<u8, AppError> {
    let mut notices = Vec::new();
    let compared = compared(args, &mut notices)?;
    let outside = compared.iter().any(|one| one.firmware.is_some());
    notices.extend(args.firmware_ports.idle_options(outside));
    if args.flight.speed.is_some() && !outside {
        notices.push(
            "--speed has no effect: the embedded firmware is flown as fast as the machine allows.".to_owned(),
        );
    }
    let flights = Flights::new(args, &compared, &mut notices)?;
    let outputs = Outputs::prepare(args)?;
    notices.iter().for_each(|notice| error::tell(notice));
    let mut sides = compared.each_ref().map(|one| Side {
        name: one.name.clone(),
        repeatable: one.firmware.is_none(),
        flights: Vec::new(),
    });
    let flown = fly(&flights, &compared, &mut sides);
    let has_flown = sides.iter().any(|side| !side.flights.is_empty());
    let all_complete = sides.iter().flat_map(|side| &side.flights).all(|flight| flight.result == "complete");
    let comparison = Comparison::new(flights.plan_name(), &conditions(&args.flight), flights.route(), sides);
    if !matches!(flown, Ok(true)) && has_flown {
        error::tell(&format!("Not everything was flown. So far:\n\n{}", comparison.text()));
    }
    if !flown? {
        return Ok(error::INTERRUPTED);
    }
    outputs.write(&comparison)?;
    Ok(if all_complete { 0 } else { error::FAILED })
}

/// Flies each firmware the requested number of times. Returns `false` after an interrupt; earlier flights are kept.
fn fly(flights: &Flights, compared: &[Compared; 2], sides: &mut [Side; 2]) -> Result<bool, AppError> {
    for (one, side) in compared.iter().zip(sides) {
        for time in 1..=one.times {
            let Some(track) = flights.fly(one.firmware.as_ref())? else { return Ok(false) };
            let times = one.times;
            error::tell(&format!(
                "{}, flight {time} of {times}: {}: {}",
                one.name, track.result, track.reason
            ));
            side.flights.push(track);
        }
    }
    Ok(true)
}

/// Returns the two firmwares, checked.
fn compared(args: &CompareArgs, notices: &mut Vec<String>) -> Result<[Compared; 2], AppError> {
    let chosen = choose(args, notices)?;
    let choices = chosen.each_ref().map(|chosen| &chosen.choice);
    if choices.iter().all(|choice| choice.is_remote()) && choices.contains(&&FirmwareChoice::Attach) {
        return Err(AppError::input(
            "--firmware attach is compared only with the embedded firmware: a second remote one would need the same \
             ports; name both executables",
        ));
    }
    let started = choices.iter().find(|choice| matches!(choice, FirmwareChoice::Executable(_)));
    let outermost = started.or(choices.iter().find(|choice| choice.is_remote()));
    notices.extend(args.link.idle_options(outermost.unwrap_or(&&FirmwareChoice::Embedded)));
    let physics = PhysicsArgs::default();
    let beside = Beside { ports: (&args.firmware_ports).into(), flight: &args.flight, physics: &physics };
    let [first, second] = names(choices);
    let mut one = |name: String, chosen: &Chosen| -> Result<Compared, AppError> {
        let times = args.flights_of(&chosen.choice).map_err(AppError::input)?;
        Ok(Compared { name, firmware: chosen.check(&args.link, beside, notices)?, times })
    };
    let [a, b] = &chosen;
    Ok([one(first, a)?, one(second, b)?])
}

/// Chooses the two firmwares. With one option, the first is the embedded one; without options, the second is that of
/// the launcher.
fn choose(args: &CompareArgs, notices: &mut Vec<String>) -> Result<[Chosen; 2], AppError> {
    let other = match &args.firmware[..] {
        [first, second] => return Ok([first, second].map(|choice| Chosen::by_option(choice.clone()))),
        [other] => Chosen::by_option(other.clone()),
        _ => Chosen::by_launcher(args.link.betaloop.as_deref(), notices)?,
    };
    if !other.choice.is_remote() {
        return Err(AppError::input(
            "name the firmware to compare with: --firmware PATH, or --betaloop FILE for the one of the launcher",
        ));
    }
    Ok([Chosen::by_option(FirmwareChoice::Embedded), other])
}

/// Returns the names: the names of their files, with the path if both files have the same name.
fn names(choices: [&FirmwareChoice; 2]) -> [String; 2] {
    let short = choices.map(|choice| match choice {
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

/// Returns the air and the seed, for people.
fn conditions(flight: &FlightArgs) -> String {
    let mut reported = vec![flight.wind.map_or_else(|| "calm".to_owned(), |wind| format!("wind {wind}"))];
    reported.extend(flight.gust.map(|gust| format!("gusts {gust} m/s")));
    reported.extend(flight.turbulence.map(|level| format!("turbulence {level}")));
    reported.extend(flight.noise.map(|noise| format!("noise {noise}")));
    reported.push(format!("seed {}", flight.seed.unwrap_or(1)));
    reported.join(", ")
}
