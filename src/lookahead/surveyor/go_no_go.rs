//! Go or no-go: the campaign of `forecast`, with the plan in a hundred winds around the present one.

use std::sync::atomic::{AtomicBool, Ordering};

use super::{SurveyNews, SurveyedPlan};
use crate::campaign::{Campaign, CampaignFlight, Forecast, Record, Side, wind_around};
use crate::flight::{FlightOptions, craft_at_boot};
use crate::lookahead::VehicleCopy;
use crate::plan::format::PlanFile;
use crate::runner::Runner;
use crate::runner::parallel::{self, Panicked};
use crate::scenario::{CaseFlight, FORMAT, Files, Flights, MAX_FLIGHTS, Request, read_request};
use crate::sim::{Noise, Wind};

/// Flies until it is over or stopped.
pub(super) fn fly(
    plan: &SurveyedPlan,
    copy: &VehicleCopy,
    is_stopped: &(impl Fn() -> bool + Sync),
    report: &mut impl FnMut(SurveyNews),
) -> Result<(), String> {
    let craft = craft_at_boot(&copy.vehicle, &plan.plan, &plan.settings, |_| {})?;
    let mean = craft.world_status().map(|world| world.wind).unwrap_or_default();
    let campaign = campaign(plan, copy.takeoff_m, mean)?;
    let mut answer = Forecast::new(campaign.scenario(), campaign.count(), Forecast::RESERVE);
    let (has_failed, mut problem) = (AtomicBool::new(false), None);
    let gives_up = || is_stopped() || has_failed.load(Ordering::Relaxed);
    let fly = |_, number| record(&campaign.flight(number)?, plan, copy, &gives_up).transpose();
    let mut flown = 0;
    parallel::in_order(1..campaign.count() + 1, parallel::beside_a_flight(), &gives_up, fly, |record, _| {
        match record {
            Ok(record) => {
                answer.add(record);
                flown += 1;
                report(SurveyNews::Flown(flown));
            }
            Err(reason) => {
                has_failed.store(true, Ordering::Relaxed);
                problem.get_or_insert(reason);
            }
        }
    })
    .map_err(|Panicked| Panicked.to_string())?;
    if let Some(reason) = problem {
        return Err(reason);
    }
    if !is_stopped() {
        report(SurveyNews::GoNoGo(Box::new(answer.answer())));
    }
    Ok(())
}

/// Flies and judges a flight; `None` if it was stopped.
pub(super) fn record(
    flight: &CampaignFlight,
    SurveyedPlan { plan, settings }: &SurveyedPlan,
    copy: &VehicleCopy,
    is_stopped: &impl Fn() -> bool,
) -> Result<Option<Record>, String> {
    let air = flight.air;
    let craft = craft_at_boot(&copy.vehicle, plan, settings, |world| {
        world.seed = air.seed;
        world.wind = air.wind;
        world.noise = Noise::Real;
    })?;
    let mut flown = CaseFlight::from_vehicle(&flight.case, craft)?;
    let mut runner = Runner::new(flown.vehicle().step_us(), f64::INFINITY, None);
    let is_over = runner.fly(&mut flown, &mut (), is_stopped).is_ok();
    Ok(is_over.then(|| Record::of(flight, Side::A, &flown.finish(), None)))
}

/// Returns the campaign of `forecast` with this plan and wind. The craft and the rest of the air are those of the session.
pub(super) fn campaign(plan: &SurveyedPlan, takeoff_m: f64, mean: Wind) -> Result<Campaign, String> {
    let usual = FlightOptions::default();
    let (timeout_s, tolerance_m) = (usual.timeout.as_secs_f64(), usual.tolerance_m);
    let text = format!(
        "format = {FORMAT}\nseeds = \"1..\"\ntimeout_s = {timeout_s}\ntime_limit_s = {timeout_s}\n\
         [plan]\nfile = \"plan\"\n\
         [craft]\ntakeoff_m = {takeoff_m}\ntolerance_m = {tolerance_m}\n\
         [vary]\nwind = \"{}\"\n\
         [campaign]\n",
        wind_around(mean)
    );
    let request = Request {
        file: "plan",
        text: &text,
        seeds: None,
        max_flights: MAX_FLIGHTS,
        flights: Flights::OfCampaign { is_drawn: true },
    };
    let scenario = read_request(&request, &mut OpenPlan(plan))
        .map_err(|errors| errors.first().map(ToString::to_string).unwrap_or_default())?;
    Campaign::new(scenario, Some(Forecast::FLIGHTS), None)
}

/// The open plan in the place of the file that the scenario names.
struct OpenPlan<'a>(&'a SurveyedPlan);

impl Files for OpenPlan<'_> {
    fn plan(&mut self, _: &str) -> Result<PlanFile, String> {
        Ok(PlanFile { plan: self.0.plan.clone(), ..PlanFile::default() })
    }

    fn text(&mut self, name: &str) -> Result<String, String> {
        Err(format!("{name} is not open"))
    }
}
