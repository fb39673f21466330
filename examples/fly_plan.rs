//! Flies a plan and prints its margins: how close the true path came to the limits of each waypoint.
//!
//! ```sh
//! cargo run --release -p betadeck-core --example fly_plan            # the built-in plan `square`, once
//! cargo run --release -p betadeck-core --example fly_plan -- 3 plans/takeoff.toml
//! ```
//!
//! The first argument is the number of flights, each with another seed; the second a plan file. The exit code is 1 if a
//! flight does not complete its plan.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use std::process::ExitCode;

use betadeck_core::flight::{Flight, FlightEnd, FlightOptions, FlightResult, FlightSetup};
use betadeck_core::plan::builtin::{BuiltinPlan, DEMO};
use betadeck_core::plan::format::{Format, PlanFile, parse, report};

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let flights: u64 = arguments.next().map_or(Ok(1), |count| count.parse())?;
    let plan = read(arguments.next())?;
    let options = FlightOptions::default();
    let mut all_complete = true;
    for seed in 1..=flights {
        let end = fly(&plan, seed, &options)?;
        println!("{}, seed {seed}: {} — {}", plan.name, end.verdict.result, end.verdict.reason);
        print_margins(&end, options.tolerance_m);
        all_complete &= end.verdict.result == FlightResult::Complete;
    }
    Ok(ExitCode::from(u8::from(!all_complete)))
}

/// Reads a plan file; without a path, the built-in demo plan.
fn read(path: Option<String>) -> Result<PlanFile, Box<dyn Error>> {
    let read = match path {
        Some(path) => {
            let text = std::fs::read_to_string(&path)?;
            parse(&path, &text, Format::from_contents(text.as_bytes()))
        }
        None => BuiltinPlan::find(DEMO).ok_or("no such plan")?.read(),
    };
    read.map_err(|errors| report(&errors).into())
}

/// Flies the plan in a light wind, from boot to the verdict.
fn fly(plan: &PlanFile, seed: u64, options: &FlightOptions) -> Result<FlightEnd, Box<dyn Error>> {
    let mut setup = FlightSetup { plan: plan.clone(), ..FlightSetup::default() };
    setup.stored.plan = plan.plan.clone();
    setup.world.seed = seed;
    setup.world.wind = "3@240".parse()?;
    let (vehicle, notices) = setup.build()?;
    notices.iter().filter(|_| seed == 1).for_each(|notice| println!("{notice}"));
    let mut flight = Flight::new(vehicle, options)?;
    loop {
        if let Some(end) = flight.tick(|_| ()) {
            return Ok(end);
        }
    }
}

/// Prints how much of each limit the flight left. The limits are those of the judge of the flight.
fn print_margins(end: &FlightEnd, tolerance_m: f64) {
    println!("  waypoint        miss      limit     margin   altitude error");
    for waypoint in &end.truth.waypoints {
        let limit_m = waypoint.radius_m + tolerance_m;
        let altitude =
            waypoint.alt_error_m.map_or_else(|| "-".to_owned(), |error_m| format!("{error_m:+.2} m"));
        let kind = waypoint.kind.to_string();
        println!(
            "  {:>2} {kind:<8} {:>7.2} m {limit_m:>8.2} m {:>8.2} m {altitude:>16}",
            waypoint.wp,
            waypoint.miss_m,
            limit_m - waypoint.miss_m
        );
    }
    if let Some(used_pct) = end.truth.battery_used_pct {
        println!("  {:.0} s flown, {:.0} % of the battery left", end.flown_s, 100.0 - used_pct);
    }
}
