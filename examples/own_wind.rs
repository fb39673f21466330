//! Flies a plan in a wind of its own: a front that turns the wind, and a lee wave with rising and sinking air. Compares
//! the flight with the same one in calm air.
//!
//! ```sh
//! cargo run --release -p betadeck-core --example own_wind          # one flight in each air
//! cargo run --release -p betadeck-core --example own_wind -- 3     # three of each, with other seeds
//! ```
//!
//! The exit code is 1 if a flight does not complete its plan.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use std::process::ExitCode;

use betadeck_core::flight::{Flight, FlightOptions, FlightResult, FlightSetup};
use betadeck_core::nalgebra::Vector3;
use betadeck_core::plan::builtin::{BuiltinPlan, DEMO};
use betadeck_core::plan::format::report;
use betadeck_core::sim::AIR_TICK_US;

/// Returns the velocity of the air at a time since boot, s, and a place, ENU from home, m: ENU, m/s.
fn wind(time_s: f64, place: &Vector3<f64>) -> Vector3<f64> {
    // The front comes 100 s after boot, within ten seconds: 2 m/s to the east turn into 7 m/s to the south.
    let share = ((time_s - 100.0) / 10.0).clamp(0.0, 1.0);
    let mean = Vector3::new(2.0, 0.0, 0.0).lerp(&Vector3::new(0.0, -7.0, 0.0), share);
    // The wave stands over the ground, 80 m from crest to crest, and dies out near the ground.
    let height = (place.z / 10.0).clamp(0.0, 1.0);
    let up_mps = 1.2 * height * (std::f64::consts::TAU * place.x / 80.0).sin();
    mean + Vector3::new(0.0, 0.0, up_mps)
}

/// No wind.
fn calm(_: f64, _: &Vector3<f64>) -> Vector3<f64> {
    Vector3::zeros()
}

/// The result of one flight.
struct Flown {
    complete: bool,
    reason: String,
    flown_s: f64,
    /// Strongest wind at the craft, m/s.
    strongest_mps: f64,
    /// Greatest tilt, degrees.
    tilt_deg: f64,
    /// Greatest horizontal miss of a waypoint, m.
    miss_m: f64,
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let flights: u64 = std::env::args().nth(1).map_or(Ok(1), |count| count.parse())?;
    let mut all_complete = true;
    for seed in 1..=flights {
        for (name, air) in [("calm", calm as fn(f64, &Vector3<f64>) -> _), ("own wind", wind)] {
            let flown = fly(seed, air)?;
            println!(
                "seed {seed}, {name:<8}: {:.0} s, wind up to {:.1} m/s, lean up to {:.0}°, waypoints missed by at \
                 most {:.2} m: {}",
                flown.flown_s, flown.strongest_mps, flown.tilt_deg, flown.miss_m, flown.reason
            );
            all_complete &= flown.complete;
        }
    }
    Ok(ExitCode::from(u8::from(!all_complete)))
}

/// Flies the plan from boot to the verdict in this air.
fn fly(seed: u64, air: fn(f64, &Vector3<f64>) -> Vector3<f64>) -> Result<Flown, Box<dyn Error>> {
    let plan = BuiltinPlan::find(DEMO).ok_or("no such plan")?.read().map_err(|errors| report(&errors))?;
    let mut setup = FlightSetup { plan: plan.clone(), ..FlightSetup::default() };
    setup.stored.plan = plan.plan;
    setup.world.seed = seed;
    let (vehicle, _) = setup.build()?;
    let options = FlightOptions::default();
    let mut flight = Flight::new(vehicle, &options)?;
    let (mut strongest_mps, mut tilt_deg) = (0.0_f64, 0.0_f64);
    let end = loop {
        let vehicle = flight.vehicle_mut();
        if vehicle.time().0.is_multiple_of(AIR_TICK_US) {
            let truth = vehicle.truth().ok_or("the world is embedded")?;
            strongest_mps = strongest_mps.max(truth.wind_enu.norm());
            tilt_deg = tilt_deg.max((truth.attitude * Vector3::z()).angle(&Vector3::z()).to_degrees());
            let blown = air(vehicle.time().as_secs_f64(), &truth.pos_enu);
            vehicle.set_added_wind(blown)?;
        }
        if let Some(end) = flight.tick(|_| ()) {
            break end;
        }
    };
    Ok(Flown {
        complete: end.verdict.result == FlightResult::Complete,
        reason: end.verdict.reason,
        flown_s: end.flown_s,
        strongest_mps,
        tilt_deg,
        miss_m: end.truth.waypoints.iter().map(|waypoint| waypoint.miss_m).fold(0.0, f64::max),
    })
}
