//! Forecasts: estimates, look-aheads and what-ifs.

use betadeck_core::flight::forecast::{
    Forecast, ForecastEnd, ForecastKind, ForecastRun, PlanWithSettings, WHAT_IFS, WhatIf,
};
use betadeck_core::flight::{Flight, FlightOptions, FlightResult, FlightSetup};
use betadeck_core::plan::builtin::BuiltinPlan;
use betadeck_core::plan::{FlightPlan, Seconds};
use betadeck_core::sim::{Noise, WorldCommand, WorldConfig};
use betadeck_core::vehicle::{Vehicle, VehicleCommand};

fn metres(length: f64) -> String {
    format!("{length:.0} m")
}

/// Returns a vehicle at boot with this built-in plan stored.
fn vehicle(plan: &str, noise: Noise) -> Vehicle {
    let plan = BuiltinPlan::find(plan).unwrap().read().unwrap();
    let world = WorldConfig { noise, ..WorldConfig::default() };
    let mut setup = FlightSetup { world, plan: plan.clone(), ..FlightSetup::default() };
    setup.stored.plan = plan.plan;
    setup.build().unwrap().0
}

fn plan(name: &str) -> FlightPlan {
    BuiltinPlan::find(name).unwrap().read().unwrap().plan
}

fn end(mut run: ForecastRun) -> Forecast {
    loop {
        if let Some(forecast) = run.advance(1000) {
            return forecast;
        }
    }
}

fn estimate(name: &str) -> Forecast {
    let vehicle = vehicle("square", Noise::None);
    end(ForecastRun::plan_estimate(vehicle, &plan(name), &[], 10.0).unwrap())
}

/// Lets the scripted pilot fly until `seconds` after the engagement.
fn in_flight(mut vehicle: Vehicle, seconds: f64) -> Vehicle {
    vehicle.apply(&VehicleCommand::StartPilot(10.0)).accepted().unwrap();
    while vehicle.engaged_at().is_none_or(|at| vehicle.time().seconds_since(at) < seconds) {
        vehicle.tick();
        vehicle.drain_events(drop);
    }
    vehicle
}

#[test]
fn an_estimate_agrees_with_the_flight_of_the_same_plan() {
    let mut flight = Flight::new(vehicle("square", Noise::None), &FlightOptions::default()).unwrap();
    let flown = loop {
        if let Some(end) = flight.tick(|_| {}) {
            break end;
        }
    };
    let forecast = estimate("square");
    assert_eq!(forecast.end, ForecastEnd::Flight(flown.verdict.result), "{}", forecast.reason);
    assert!((forecast.time_s - flown.flown_s).abs() <= 0.001 + 1e-9, "{} {}", forecast.time_s, flown.flown_s);
    let used_pct = flown.truth.battery_used_pct.unwrap();
    assert!((forecast.battery_used_pct - used_pct).abs() < 0.1, "{} {used_pct}", forecast.battery_used_pct);
    assert_eq!(forecast.legs.iter().map(|leg| leg.wp).collect::<Vec<_>>(), [0, 1, 2, 3]);
    assert!(forecast.legs.iter().is_sorted_by(|a, b| a.battery_used_pct < b.battery_used_pct));
    assert!((forecast.legs.iter().map(|leg| leg.time_s).sum::<f64>() - forecast.time_s).abs() < 2.0);
    // At 5 m/s the craft flies straight over waypoint 0 and overshoots the corner.
    let worst = forecast.worst_xte.unwrap();
    assert!(worst.wp == 1 && (1.0..8.0).contains(&worst.xte_m), "{worst:?}");
    assert!(forecast.path.windows(2).all(|pair| pair[0].along_m <= pair[1].along_m));
    let highest = forecast.path.iter().map(|point| point.alt).fold(0.0, f64::max);
    assert!((highest - 50.0).abs() < 3.0, "{highest}");
}

#[test]
fn an_estimate_is_the_same_in_slices_of_any_length() {
    let whole = estimate("land");
    let mut run =
        ForecastRun::plan_estimate(vehicle("square", Noise::None), &plan("land"), &[], 10.0).unwrap();
    let sliced = loop {
        if let Some(forecast) = run.advance(7) {
            break forecast;
        }
    };
    assert_eq!(whole, sliced);
}

#[test]
fn an_estimate_from_the_middle_of_another_flight_starts_at_home_without_faults() {
    let mut flying = in_flight(vehicle("square", Noise::None), 5.0);
    flying.apply(&VehicleCommand::from(WorldCommand::parse("fault=gps-loss").unwrap())).accepted().unwrap();
    let forecast = end(ForecastRun::plan_estimate(flying, &plan("land"), &[], 10.0).unwrap());
    assert!(forecast.is_complete(), "{}", forecast.reason);
    assert!(forecast.path[0].n.hypot(forecast.path[0].e) < 0.1);
}

#[test]
fn the_settings_of_the_plan_count() {
    let fast = ["ap_landing_descent_rate = 150".to_owned()];
    let vehicle = vehicle("square", Noise::None);
    let fast = end(ForecastRun::plan_estimate(vehicle, &plan("land"), &fast, 10.0).unwrap());
    assert!(fast.is_complete() && fast.time_s < estimate("land").time_s - 5.0, "{}", fast.time_s);
}

#[test]
fn the_settings_of_the_craft_count() {
    let mut vehicle = vehicle("square", Noise::None);
    let set = VehicleCommand::single_line("set ap_max_distance_from_home = 82");
    let reply = vehicle.apply(&set).line().unwrap();
    assert!(!reply.failed, "{}", reply.text);
    let forecast = end(ForecastRun::plan_estimate(vehicle, &plan("square"), &[], 10.0).unwrap());
    assert!(!forecast.is_complete(), "{}", forecast.reason);
    assert!(forecast.reason.contains("fence is 82 m"), "{}", forecast.reason);
}

#[test]
fn what_the_craft_refuses_is_said() {
    let lines = ["ap_max_velocity = fast".to_owned()];
    let refused = ForecastRun::plan_estimate(vehicle("square", Noise::None), &plan("square"), &lines, 10.0)
        .unwrap_err();
    assert!(refused.contains("set ap_max_velocity = fast"), "{refused}");
    let empty = ForecastRun::plan_estimate(vehicle("square", Noise::None), &FlightPlan::default(), &[], 10.0);
    assert!(empty.unwrap_err().contains("No waypoints"));
}

#[test]
fn a_hold_without_end_ends_the_forecast() {
    let mut endless = plan("hold-none");
    for waypoint in &mut endless.waypoints {
        waypoint.duration = Seconds::default();
    }
    let vehicle = vehicle("square", Noise::None);
    let forecast = end(ForecastRun::plan_estimate(vehicle, &endless, &[], 10.0).unwrap());
    assert_eq!(forecast.end, ForecastEnd::Endless, "{}", forecast.reason);
    assert!(forecast.line(metres).contains("without end"), "{}", forecast.line(metres));
    assert!(forecast.time_s < 200.0);
}

#[test]
fn a_look_ahead_is_what_then_happens() {
    let mut flying = in_flight(vehicle("land", Noise::Real), 8.0);
    let started = flying.time();
    let forecast = end(ForecastRun::look_ahead(flying.clone()).unwrap());
    assert!(forecast.is_complete(), "{}", forecast.reason);
    while flying.time().seconds_since(started) < forecast.time_s {
        flying.tick();
    }
    let last = forecast.path.last().unwrap();
    let truth = flying.truth().unwrap();
    assert_eq!((last.n.to_bits(), last.e.to_bits()), (truth.pos_enu.y.to_bits(), truth.pos_enu.x.to_bits()));
    assert!(!flying.controller().is_armed());
}

#[test]
fn a_lost_fix_makes_another_end() {
    let flying = in_flight(vehicle("square", Noise::None), 5.0);
    let plan = PlanWithSettings { plan: &FlightPlan::default(), settings: &[] };
    let forecast = end(ForecastRun::what_if(flying, &WHAT_IFS[0], plan, 10.0).unwrap());
    assert_eq!(forecast.end, ForecastEnd::Flight(FlightResult::Aborted), "{}", forecast.reason);
    assert!(forecast.line(metres).starts_with("drifts "), "{}", forecast.line(metres));
}

#[test]
fn on_the_ground_a_what_if_flies_the_plan_from_home_and_fails_at_the_engagement() {
    let (vehicle, land) = (vehicle("land", Noise::None), plan("land"));
    let plan = PlanWithSettings { plan: &land, settings: &[] };
    let flown = |text: &str| {
        let what_if = WhatIf::parse(text).unwrap();
        end(ForecastRun::what_if(vehicle.clone(), &what_if, plan, 10.0).unwrap())
    };
    let calm = flown("wind,,0@270");
    assert!(calm.is_complete(), "{}", calm.reason);
    assert!(flown("wind,,6@270").battery_used_pct > calm.battery_used_pct);
    let without_gps = flown("gps-loss");
    assert_ne!(without_gps.end, calm.end, "{}", without_gps.reason);
}

#[test]
fn a_craft_at_rest_has_nothing_ahead() {
    let refused = ForecastRun::look_ahead(vehicle("square", Noise::None)).unwrap_err();
    assert!(refused.contains("disarmed"), "{refused}");
}

#[test]
fn sticks_that_stay_have_an_end_too() {
    let mut flying = in_flight(vehicle("square", Noise::None), 5.0);
    flying.apply(&VehicleCommand::StopPilot);
    let mut sticks = flying.transmitter().sticks();
    sticks.channels[5] = 1000;
    flying.apply(&VehicleCommand::Sticks(sticks));
    let forecast = end(ForecastRun::look_ahead(flying).unwrap());
    // The autopilot is off from here on: only the sticks hold the craft.
    assert_eq!(forecast.end, ForecastEnd::Endless, "{}", forecast.reason);
    assert!(forecast.time_s < 120.0);
}

fn change(vehicle: Vehicle, changed: &str) -> Result<ForecastRun, String> {
    let plan = plan("land");
    let plan = PlanWithSettings { plan: &plan, settings: &[] };
    ForecastRun::setting_change(vehicle, &[changed.to_owned()], plan, 10.0)
}

#[test]
fn a_changed_setting_is_flown_beside_the_same_flight_without_it() {
    let forecast = end(change(vehicle("square", Noise::None), "ap_landing_descent_rate = 150").unwrap());
    let unchanged = forecast.unchanged.as_ref().unwrap();
    assert_eq!(**unchanged, estimate("land"), "nothing else is different");
    assert!(forecast.is_complete() && forecast.time_s < unchanged.time_s - 5.0, "{}", forecast.time_s);
    assert_eq!(forecast.kind, ForecastKind::PlanEstimate);
}

#[test]
fn in_flight_a_changed_setting_counts_from_this_instant_on() {
    let flying = in_flight(vehicle("land", Noise::Real), 4.0);
    let expected = end(ForecastRun::look_ahead(flying.clone()).unwrap());
    let forecast = end(change(flying, "ap_landing_descent_rate = 150").unwrap());
    let unchanged = forecast.unchanged.as_ref().unwrap();
    assert_eq!(**unchanged, expected);
    assert!(forecast.time_s < unchanged.time_s - 5.0, "{} {}", forecast.time_s, unchanged.time_s);
    assert_eq!((forecast.kind, forecast.path.first()), (ForecastKind::LookAhead, unchanged.path.first()));
}

#[test]
fn a_value_that_the_craft_refuses_is_not_flown() {
    for flying in [vehicle("square", Noise::None), in_flight(vehicle("land", Noise::None), 2.0)] {
        let refused = change(flying, "ap_max_angle = 999").unwrap_err();
        assert!(refused.contains("set ap_max_angle = 999"), "{refused}");
    }
}
