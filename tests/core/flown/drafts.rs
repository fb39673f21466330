//! Scenarios that are written of plans and of recorded flights.

use betadeck_core::plan::builtin::BuiltinPlan;
use betadeck_core::plan::format::{PlanFile, report};
use betadeck_core::scenario::{BuiltinFiles, CaseFlight, Draft, Flown, judge, read};
use betadeck_core::sim::WorldCommand;
use betadeck_core::telemetry::InFlightCommand;
use betadeck_core::timeline::{RecordedFlight, Timeline};
use betadeck_core::vehicle::{Vehicle, VehicleCommand, VehicleConfig};

#[test]
fn a_plan_becomes_a_scenario_that_passes() {
    let plan = BuiltinPlan::find("land").unwrap().read().unwrap();
    let text = Draft::from_plan(&plan).finish().unwrap();
    for part in
        ["format = 1", "seeds = \"1..\"", "[plan]", "LANDING", "\"disarmed LANDING\"", "no_event = \"crash\""]
    {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let scenario = read("land", &text, None, &mut BuiltinFiles).unwrap();
    let (case, air) = (&scenario.cases[0], scenario.cases[0].airs[0]);
    let flown = CaseFlight::new(case, &air).unwrap().fly();
    assert!(judge(case, &flown).0.iter().all(|judgement| judgement.outcome.is_met()));
}

/// Returns the first flight of a session: the craft boots without a plan, gets one over the command line, and
/// flies it.
fn first_flight(happen: impl Fn(u64, &mut Vehicle), seconds: u64) -> (RecordedFlight, Vehicle) {
    let mut configuration = betadeck_core::firmware::config::Configuration::default();
    configuration.starter_modes();
    let config = VehicleConfig {
        world: betadeck_core::sim::WorldConfig::default(),
        firmware: betadeck_core::firmware::FirmwareOptions::default(),
        configuration,
        live: true,
    };
    let mut vehicle = Vehicle::new(config).unwrap();
    let mut timeline = Timeline::new(&mut vehicle).unwrap();
    for tick in 0..seconds * 1000 {
        happen(tick, &mut vehicle);
        timeline.record(&mut vehicle);
        vehicle.tick();
        vehicle.drain_events(drop);
    }
    timeline.record(&mut vehicle);
    (timeline.recorded_flight(vehicle.time()).unwrap(), vehicle)
}

fn upload(plan: &PlanFile, vehicle: &mut Vehicle) {
    let _reported = vehicle.apply(&VehicleCommand::upload(plan.plan.clone(), plan.settings.clone()));
}

/// Flies a written scenario in the same way as `check`.
fn checked(text: &str) -> (Flown, Vec<String>) {
    let scenario = read("flight", text, None, &mut BuiltinFiles)
        .unwrap_or_else(|problems| panic!("{}\n{text}", report(&problems)));
    let (case, air) = (&scenario.cases[0], scenario.cases[0].airs[0]);
    let flown = CaseFlight::new(case, &air).unwrap().fly();
    let unmet = judge(case, &flown).0.into_iter().filter(|judgement| !judgement.outcome.is_met());
    let unmet = unmet.map(|judgement| judgement.label).collect();
    (flown, unmet)
}

#[test]
fn the_first_flight_of_a_session_is_the_scenario_that_is_written_of_it() {
    let plan = BuiltinPlan::find(betadeck_core::plan::builtin::DEMO).unwrap().read().unwrap();
    let happen = |tick: u64, vehicle: &mut Vehicle| match tick {
        2000 => upload(&plan, vehicle),
        2001 => vehicle.apply(&VehicleCommand::StartPilot(10.0)).accepted().unwrap(),
        40_000 => vehicle
            .apply(&VehicleCommand::from(WorldCommand::parse("wind=3@270").unwrap()))
            .accepted()
            .unwrap(),
        // This plan is stored now, but it is not flown.
        50_000 => upload(&BuiltinPlan::find("land").unwrap().read().unwrap(), vehicle),
        _ => {}
    };
    let (flight, flown) = first_flight(happen, 100);
    let truth = *flown.truth().unwrap();
    let text = Draft::from_recorded("first", flight).unwrap().finish().unwrap();
    assert!(text.contains("wind 3@270") && text.contains("ARRIVED 1 of stored"), "{text}");
    // The flown plan is at the top of the text. No input types it again before the flight.
    let (top, inputs) = text.split_once("[[input]]").unwrap();
    assert!(top.contains("0 40.4640000 -79.5175000 5000"), "{text}");
    assert_eq!(inputs.matches("cli waypoint insert").count(), 1, "{text}");
    // Nor does one set what the craft has from the start.
    assert!(top.contains("ap_position_p = 40") && !inputs.contains("cli set ap_position_p"), "{text}");
    assert!(!top.contains("battery_profile") && !text.contains("000 s after boot"), "{text}");
    let (again, unmet) = checked(&text);
    assert!(unmet.is_empty(), "{unmet:?}");
    let end = again.trace.samples.iter().find(|sample| sample.time == flown.time()).unwrap();
    let [north, east] = end.place();
    let apart = (north - truth.pos_enu.y).hypot(east - truth.pos_enu.x);
    assert!(apart < 1e-3, "{apart} m from where it was");
}

#[test]
fn a_longer_plan_that_is_flown_later_has_its_own_numbers() {
    let plan = |name| BuiltinPlan::find(name).unwrap().read().unwrap();
    let (short, long) = (plan("land"), plan(betadeck_core::plan::builtin::DEMO));
    let happen = |tick: u64, vehicle: &mut Vehicle| match tick {
        2000 => upload(&short, vehicle),
        2001 => vehicle.apply(&VehicleCommand::StartPilot(5.0)).accepted().unwrap(),
        22_000 => upload(&long, vehicle),
        23_000 => {
            let _done = vehicle.apply(&VehicleCommand::InFlight(InFlightCommand::GoTo(2)));
        }
        _ => {}
    };
    let (flight, _) = first_flight(happen, 80);
    let text = Draft::from_recorded("two plans", flight).unwrap().finish().unwrap();
    assert!(text.contains("APPROACHING 2"), "{text}");
    assert_eq!(checked(&text).1, [""; 0]);
}

#[test]
fn waiting_after_the_landing_is_left_out() {
    let plan = BuiltinPlan::find("land").unwrap().read().unwrap();
    let happen = |tick: u64, vehicle: &mut Vehicle| match tick {
        2000 => upload(&plan, vehicle),
        2001 => vehicle.apply(&VehicleCommand::StartPilot(5.0)).accepted().unwrap(),
        _ => {}
    };
    let (flight, _) = first_flight(happen, 300);
    let text = Draft::from_recorded("landed", flight).unwrap().finish().unwrap();
    assert!(text.contains("disarmed LANDING"), "{text}");
    let (again, unmet) = checked(&text);
    assert_eq!(unmet, [""; 0]);
    let end = again.trace.samples.last().unwrap().time;
    assert!(end.as_secs_f64() < 120.0, "{end:?}");
}
