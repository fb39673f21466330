//! Go or no-go: flies a plan in the weather to come.

use std::sync::atomic::Ordering;

use super::{definition, outputs};
use crate::args::{CampaignArgs, CampaignOutputArgs, FlightArgs, ForecastArgs, OutputFile};
use crate::campaign::{Forecast, ForecastAnswer, Standing};
use crate::files::output_file::FinalOutput;
use crate::headless::campaign::definition::Wanted;
use crate::headless::campaign::loaded::Loaded;
use crate::headless::campaign::progress::Progress;
use crate::headless::report;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::process::{error, parallel};
use crate::report::campaign::{Reported, forecast_json, forecast_reason, forecast_sentence};
use crate::report::flight::Verdict;
use crate::report::html::{CampaignPage, campaign_page};

/// Flies and answers. The exit code is 0 if the answer is go.
pub(super) fn run(args: &ForecastArgs, repeat: &[String]) -> Result<u8, AppError> {
    let Wanted::Plan(definition, sources) = definition::read(&campaign_of(args))? else {
        return Err(AppError::input(format!(
            "forecast flies a plan, and {} is none: name a plan, or fly it with betadeck campaign",
            args.plan
        )));
    };
    let (json, page) = (args.json.clone(), args.report.clone());
    let output = CampaignOutputArgs { json, report: page, ..CampaignOutputArgs::default() };
    outputs::claim(&output, None, &crate::headless::campaign::fly::inputs(&definition.file, &sources))?;
    let loaded = Loaded::new(*definition, sources)?;
    let json = match &args.json {
        Some(OutputFile::File(path)) => Some(FinalOutput::begin(path)?),
        Some(OutputFile::Stdout) | None => None,
    };
    let page = args.report.as_deref().map(FinalOutput::begin).transpose()?;
    let flights = loaded.header.flights;
    let reserve = args.reserve.map_or(Forecast::RESERVE, |reserve| reserve / 100.0);
    let mut forecast = Forecast::new(loaded.campaign.scenario(), flights, reserve);

    let interrupted = interrupt_flag()?;
    let is_stopped = || interrupted.load(Ordering::Relaxed);
    let mut progress = Progress::new(Some(flights), 0);
    let fly = |thread, line| loaded.fly(line, thread, &interrupted, &is_stopped, &mut Vec::new());
    let (mut trouble, mut flown, mut failed) = (Ok(()), 0, 0);
    parallel::in_order(
        0..flights,
        parallel::threads(args.jobs),
        &is_stopped,
        fly,
        |record, _| match record {
            Ok(record) => {
                flown += 1;
                failed += u64::from(record.standing == Standing::Failed);
                forecast.add(record);
                progress.show(flown, failed);
            }
            Err(problem) => trouble = Err(problem),
        },
    )?;
    progress.clear();
    trouble?;

    let (name, go_from) =
        (&loaded.header.name, args.go_from.map_or(Forecast::GO_FROM, |share| share / 100.0));
    let answer = forecast.answer();
    let object = || forecast_json(name, &answer, go_from) + "\n";
    match args.json {
        Some(OutputFile::Stdout) => error::write_stdout(object().as_bytes()),
        _ => error::print(&(forecast_sentence(name, &answer, go_from) + "\n")),
    }?;
    json.map_or(Ok(()), |file| file.write(object().as_bytes()))?;
    page.map_or(Ok(()), |file| {
        let page = forecast_page(name, &answer, go_from, &loaded.header.version, &report::command(repeat));
        file.write(page.as_bytes())
    })?;
    error::tell(&format!("{flown} flights in {:.2} s", progress.seconds()));
    Ok(match () {
        () if is_stopped() => error::INTERRUPTED,
        () if answer.is_go(go_from) => 0,
        () => error::FAILED,
    })
}

fn forecast_page(
    name: &str,
    forecast: &ForecastAnswer,
    go_from: f64,
    version: &str,
    command: &str,
) -> String {
    let reported = Reported {
        answer: &forecast.answer,
        name,
        version,
        design: None,
        run: None,
        sides: None,
        shard: None,
    };
    let is_go = forecast.is_go(go_from);
    let reason = forecast_reason(forecast);
    let word = if is_go { "go" } else { "no-go" }.to_owned();
    let verdict = Some(Verdict { passed: Some(is_go), word, reason });
    let page =
        CampaignPage { kind: "Forecast by betadeck", reported: &reported, verdict, command: Some(command) };
    campaign_page(&page, &report::program())
}

/// Returns the campaign whose flights the forecast flies.
fn campaign_of(args: &ForecastArgs) -> CampaignArgs {
    let mut vary = Vec::new();
    vary.extend(args.wind.as_ref().map(|wind| format!("wind={wind}")));
    vary.extend(args.battery.map(|charge| {
        let missing = charge.percent - 100.0;
        match charge.deviation {
            0.0 => format!("battery_pct={missing}"),
            deviation => format!("battery_pct={missing} +- {deviation} in -90..0"),
        }
    }));
    CampaignArgs {
        what: Some(args.plan.clone()),
        flights: Some(args.flights.unwrap_or(Forecast::FLIGHTS)),
        vary,
        jobs: args.jobs,
        mission: args.mission.clone(),
        flight: FlightArgs {
            gust: args.gust,
            turbulence: args.turbulence,
            world: args.world.clone(),
            airframe: args.airframe.clone(),
            home: args.home,
            settings: args.settings.clone(),
            seed: args.seed,
            ..FlightArgs::default()
        },
        ..CampaignArgs::default()
    }
}
