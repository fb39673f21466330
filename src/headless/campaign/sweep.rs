//! Flies a plan with a fault at every second of the flight.

use std::sync::atomic::Ordering;

use super::{definition, outputs};
use crate::args::{CampaignArgs, OutputFile};
use crate::files::output_file::FinalOutput;
use crate::flight::Flight;
use crate::flight::sweep::{Fate, Sweep, SweepPoint};
use crate::headless::campaign::definition::Wanted;
use crate::headless::campaign::loaded::Loaded;
use crate::headless::campaign::progress::Progress;
use crate::headless::report;
use crate::lookahead::{SweepProblem, fly_sweep};
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::process::{error, parallel};
use crate::report::flight::FlightReport;
use crate::report::html::{SweepPage, sweep_page};
use crate::report::sweep::{SweptFlight, sweep_csv, sweep_json, sweep_sentences};
use crate::scenario::CaseFlight;
use crate::sim::ScheduledFault;

/// Flies and reports. The exit code is 0 if the craft is lost at no second.
pub(super) fn run(args: &CampaignArgs, fault: ScheduledFault, repeat: &[String]) -> Result<u8, AppError> {
    let name = args.what.as_deref().unwrap_or_default();
    let (definition, sources) = match definition::read(args)? {
        Wanted::Plan(definition, sources) => (*definition, sources),
        Wanted::Scenario(..) | Wanted::Run(..) => {
            return Err(AppError::input(format!(
                "--sweep flies a plan with the options of fly, and {name} is none: name the plan"
            )));
        }
    };
    if !definition.firmware.is_empty() {
        return Err(AppError::input(
            "--sweep flies copies of the embedded firmware, and another program cannot be copied: leave --firmware out",
        ));
    }
    outputs::claim(&args.output, None, &crate::headless::campaign::fly::inputs(&definition.file, &sources))?;
    let loaded = Loaded::new(definition, sources)?;
    let flight = flight(&loaded)?;
    let about = about(&loaded, &flight);
    let mut sweep = Sweep::new(flight, fault);
    let json = match &args.output.json {
        Some(OutputFile::File(path)) => Some(FinalOutput::begin(path)?),
        Some(OutputFile::Stdout) | None => None,
    };
    let csv = args.output.csv.as_deref().map(FinalOutput::begin).transpose()?;
    let page = args.output.report.as_deref().map(FinalOutput::begin).transpose()?;

    let interrupted = interrupt_flag()?;
    let is_stopped = || interrupted.load(Ordering::Relaxed);
    let threads = parallel::threads(args.jobs);
    let mut points: Vec<SweepPoint> = Vec::new();
    let mut progress = Progress::new(None, 0);
    let flown = fly_sweep(&mut sweep, threads, &is_stopped, |point| {
        points.push(point);
        progress.show(points.len() as u64, count(&points, Fate::Lost));
    });
    flown.map_err(|problem| match problem {
        SweepProblem::Refused(reason) => AppError::input(reason),
        SweepProblem::Panicked(panicked) => AppError::internal(panicked),
    })?;
    progress.clear();

    let end = sweep.end().map(|end| (end.verdict.result.to_string(), end.verdict.reason.as_str()));
    let swept = SweptFlight {
        name: &loaded.header.name,
        fault,
        without: end.as_ref().map(|(result, reason)| (result.as_str(), *reason)),
        points: &points,
    };
    let printed = match args.output.json {
        Some(OutputFile::Stdout) => error::write_stdout((sweep_json(&swept) + "\n").as_bytes()).map(drop),
        _ => error::print(&(sweep_sentences(&swept).join("\n") + "\n")).map(drop),
    };
    let json = json.map_or(Ok(()), |file| file.write((sweep_json(&swept) + "\n").as_bytes()));
    let csv = csv.map_or(Ok(()), |file| file.write(&sweep_csv(&points)));
    let page = page.map_or(Ok(()), |file| {
        let worst = swept.worst_fault().map(|fault| of_fault(repeat, fault));
        let page = SweepPage {
            swept: &swept,
            route: about.route.as_ref(),
            fence_m: about.fence_m,
            command: Some(&report::command(repeat)),
            worst: worst.as_deref(),
        };
        file.write(sweep_page(&page, &report::program()).as_bytes())
    });
    printed.and(json).and(csv).and(page)?;
    let seconds = progress.seconds();
    error::tell(&format!("{} flights in {seconds:.2} s", points.len()));
    Ok(match () {
        () if is_stopped() => error::INTERRUPTED,
        () if swept.count(Fate::Lost) == 0 => 0,
        () => error::FAILED,
    })
}

/// Returns the places of the plan, for a report.
fn about(loaded: &Loaded, flight: &Flight) -> FlightReport {
    let plan = loaded.campaign.scenario().cases.first().map(|case| case.setup.plan.plan.clone());
    report::about(flight.vehicle(), &loaded.header.name, &plan.unwrap_or_default())
}

/// Returns the command that flies the plan with the fault at one second.
fn of_fault(repeat: &[String], fault: ScheduledFault) -> String {
    let mut words = vec!["fly".to_owned()];
    let mut typed = repeat.iter().skip(1);
    while let Some(word) = typed.next() {
        match word.as_str() {
            "--sweep" | "--jobs" => drop(typed.next()),
            word if word.starts_with("--sweep=") || word.starts_with("--jobs=") => {}
            _ => words.push(word.clone()),
        }
    }
    words.extend(["--fault".to_owned(), fault.to_string()]);
    report::command(&words)
}

/// Returns the flight of the plan, at home.
fn flight(loaded: &Loaded) -> Result<Flight, AppError> {
    let first = loaded.campaign.flight(1).ok_or_else(|| AppError::internal("a plan without a flight"))?;
    if let Some(problem) = first.problem {
        return Err(AppError::input(problem));
    }
    let flight = CaseFlight::new(&first.case, &first.air).map_err(AppError::input)?;
    Ok(flight.into_flight())
}

fn count(points: &[SweepPoint], fate: Fate) -> u64 {
    points.iter().filter(|point| point.fate == fate).count() as u64
}
