//! Flies a thousand flights of a plan on all processors, each in another wind, and prints the result of all.
//!
//! ```sh
//! cargo run --release -p betadeck-core --example thousand_flights             # 1000 flights, all processors
//! cargo run --release -p betadeck-core --example thousand_flights -- 50 1     # 50 flights on one thread
//! ```
//!
//! A flight depends on its number only, so the number of threads does not change the result. A thousand flights take less
//! than a minute of processor time.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

use std::collections::BTreeMap;
use std::error::Error;
use std::sync::atomic::{AtomicU64, Ordering};

use betadeck_core::flight::{Flight, FlightOptions, FlightSetup};
use betadeck_core::plan::builtin::BuiltinPlan;
use betadeck_core::plan::format::report;
use betadeck_core::sim::Wind;

/// The result of one flight.
struct Flown {
    number: u64,
    result: String,
    /// Greatest horizontal miss of a waypoint, m.
    miss_m: f64,
    /// Charge drawn, % of the capacity.
    used_pct: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let flights: u64 = arguments.next().map_or(Ok(1000), |count| count.parse())?;
    let processors = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.next().map_or_else(|| Ok(processors()), |count| count.parse())?;
    let plan = BuiltinPlan::find("land").ok_or("no such plan")?.read().map_err(|errors| report(&errors))?;
    let mut setup = FlightSetup { plan: plan.clone(), ..FlightSetup::default() };
    setup.stored.plan = plan.plan;

    // Each thread takes the next number until all are flown.
    let next = AtomicU64::new(0);
    let work = || {
        let mine = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        mine.take_while(|&number| number < flights).map(|number| fly(&setup, number)).collect::<Vec<_>>()
    };
    let results: Vec<Result<Flown, String>> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.max(1)).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap_or_default()).collect()
    });
    let mut flown = results.into_iter().collect::<Result<Vec<_>, _>>()?;
    flown.sort_by_key(|flight| flight.number);
    print_all(&flown);
    if flown.len() as u64 == flights { Ok(()) } else { Err("a thread stopped".into()) }
}

/// Flies the flight with this number. The number gives the seed of sensors and gusts, and the wind.
fn fly(setup: &FlightSetup, number: u64) -> Result<Flown, String> {
    let mut setup = setup.clone();
    setup.world.seed = number + 1;
    // Fewer and longer steps are enough for statistics.
    setup.world.rate_hz = 400;
    setup.world.wind = Wind { speed_mps: (number % 13) as f64, from_deg: (37 * number % 360) as f64 };
    setup.world.gust_mps = 2.0;
    let (vehicle, _) = setup.build().map_err(|error| error.to_string())?;
    let mut flight = Flight::new(vehicle, &FlightOptions::default()).map_err(|mode| mode.to_string())?;
    let end = std::iter::repeat_with(|| flight.tick(|_| ())).flatten().next().ok_or("no end")?;
    let misses = end.truth.waypoints.iter().map(|waypoint| waypoint.miss_m);
    Ok(Flown {
        number,
        result: end.verdict.result.to_string(),
        miss_m: misses.fold(0.0, f64::max),
        used_pct: end.truth.battery_used_pct.unwrap_or(f64::NAN),
    })
}

/// Prints how many flights had which result, the distribution of the numbers, and the worst flight.
fn print_all(flown: &[Flown]) {
    let mut results: BTreeMap<&str, usize> = BTreeMap::new();
    for flight in flown {
        *results.entry(&flight.result).or_default() += 1;
    }
    for (result, count) in results {
        println!("{count:>5} of {} {result}", flown.len());
    }
    for (name, unit, number) in [
        ("greatest miss of a waypoint", "m", (|flight| flight.miss_m) as fn(&Flown) -> f64),
        ("charge drawn", "%", |flight| flight.used_pct),
    ] {
        let mut sorted: Vec<f64> = flown.iter().map(number).collect();
        sorted.sort_by(f64::total_cmp);
        let quantile =
            |percent: usize| sorted.get((sorted.len() * percent / 100).min(sorted.len().wrapping_sub(1)));
        if let (Some(median), Some(high), Some(worst)) = (quantile(50), quantile(95), sorted.last()) {
            println!(
                "{name}: median {median:.2} {unit}, 95 % below {high:.2} {unit}, worst {worst:.2} {unit}"
            );
        }
    }
    if let Some(worst) = flown.iter().max_by(|a, b| a.miss_m.total_cmp(&b.miss_m)) {
        println!("the worst is flight {}: seed {}", worst.number, worst.number + 1);
    }
}
