//! A scenario made from a flight. It repeats the plan and the inputs, and expects the observed behaviour.

mod observed;
mod past;
mod recorded;
mod toml_text;

use super::case::Scenario;
use super::file::{Files, read};
use super::judge::judge;
use super::run::{CaseFlight, Flown};
use crate::plan::FlightPlan;
use crate::plan::format::{HomePosition, PlanFile};
use crate::signals::SimTime;

/// A scenario under construction.
#[derive(Debug, Clone, Default)]
#[doc(hidden)]
pub struct Draft {
    name: String,
    description: String,
    plan: FlightPlan,
    home: Option<HomePosition>,
    heading_deg: f64,
    airframe: Option<String>,
    takeoff_m: f64,
    pilot: bool,
    settings: Vec<String>,
    lines: Vec<String>,
    /// Lines of `[air]`, as key and text in TOML.
    air: Vec<(&'static str, String)>,
    seed: u64,
    /// The end of the flight, counted from boot.
    ends: Option<SimTime>,
    inputs: Vec<(String, String)>,
}

/// A table of a file: keys and values in TOML.
type Block = Vec<(&'static str, String)>;

impl Draft {
    /// Returns a draft for a flight of a plan without inputs: the scripted pilot flies it in calm air.
    pub fn of_plan(file: &PlanFile) -> Self {
        Self {
            name: file.name.clone(),
            description: file.description.clone(),
            plan: file.plan.clone(),
            home: file.home,
            takeoff_m: 10.0,
            pilot: true,
            settings: file.settings.clone(),
            seed: 1,
            ..Self::default()
        }
    }

    /// Flies the draft and returns the text of a scenario that expects the same behaviour, with margins.
    ///
    /// # Errors
    /// Returns a sentence if the draft cannot be flown.
    pub fn finish(mut self) -> Result<String, String> {
        let flown = self.fly()?;
        if flown.result == "timeout" && self.ends.is_none() {
            // The flight has no end of its own, as with a hold without an end.
            self.ends = Some(SimTime(flown.trace.end().0 / 1_000_000 * 1_000_000));
            return self.finish();
        }
        let text = toml_text::text(&self, &observed::expectations(&flown));
        let scenario = parse(&self.name, &text)?;
        let case = scenario.cases.first().ok_or("the scenario has no case")?;
        let unmet: Vec<String> = judge(case, &flown)
            .0
            .into_iter()
            .filter(|judgement| !judgement.outcome.is_met())
            .map(|judgement| judgement.label)
            .collect();
        if unmet.is_empty() {
            Ok(text)
        } else {
            Err(format!("the observations cannot become expectations: {}", unmet.join("; ")))
        }
    }

    /// Flies the draft without expectations.
    fn fly(&self) -> Result<Flown, String> {
        let scenario = parse(&self.name, &toml_text::text(self, &[]))?;
        let case = scenario.cases.first().ok_or("the scenario has no case")?;
        let air = case.airs.first().ok_or("the scenario has no seed")?;
        Ok(CaseFlight::new(case, air)?.fly())
    }
}

/// A reader that finds no files: a scenario written here names none.
struct NoFiles;

impl Files for NoFiles {
    fn plan(&mut self, name: &str) -> Result<PlanFile, String> {
        Err(format!("{name} is not available"))
    }

    fn text(&mut self, name: &str) -> Result<String, String> {
        Err(format!("{name} is not available"))
    }
}

/// Reads a scenario that was written here. The user has no file to open, so a problem is reported without a place.
fn parse(name: &str, text: &str) -> Result<Scenario, String> {
    read(name, text, None, &mut NoFiles).map_err(|errors| {
        let first = errors.first().map_or("", |problem| problem.message.as_str());
        format!("a scenario cannot say what happened in this flight: {first}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::FlightSetup;
    use crate::plan::builtin::BuiltinPlan;
    use crate::signals::SimTime;
    use crate::sim::WorldCommand;
    use crate::telemetry::InFlightCommand;
    use crate::timeline::{RecordedFlight, Timeline};
    use crate::vehicle::{Vehicle, VehicleCommand, VehicleConfig};

    #[test]
    fn a_plan_becomes_a_scenario_that_passes() {
        let plan = BuiltinPlan::find("land").unwrap().read().unwrap();
        let text = Draft::of_plan(&plan).finish().unwrap();
        for part in [
            "format = 1",
            "seeds = \"1..\"",
            "[plan]",
            "LANDING",
            "\"disarmed LANDING\"",
            "no_event = \"crash\"",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        let scenario = parse("land", &text).unwrap();
        let (case, air) = (&scenario.cases[0], scenario.cases[0].airs[0]);
        let flown = CaseFlight::new(case, &air).unwrap().fly();
        assert!(judge(case, &flown).0.iter().all(|judgement| judgement.outcome.is_met()));
    }

    #[test]
    fn what_was_wrong_at_the_start_of_a_recorded_flight_is_wrong_in_its_scenario() {
        let (mut start, _) = FlightSetup::default().build().unwrap();
        for line in ["fault=motor,,2:0.9", "fault=gps-loss@boot+20,3"] {
            start.change_world(WorldCommand::parse(line).unwrap()).unwrap();
        }
        let until = SimTime::from_secs_f64(2.0);
        let flight = RecordedFlight { start, inputs: Vec::new(), until };
        let text = Draft::of_recorded("wrong", flight).unwrap().finish().unwrap();
        for part in ["fault motor,,2:0.9", "fault gps-loss@boot+20,3"] {
            assert!(text.contains(part), "{part}\n{text}");
        }
    }

    /// Returns the first flight of a session: the craft boots without a plan, gets one over the command line, and
    /// flies it.
    fn first_flight(happen: impl Fn(u64, &mut Vehicle), seconds: u64) -> (RecordedFlight, Vehicle) {
        let mut configuration = crate::firmware::config::Configuration::default();
        configuration.starter_modes();
        let config = VehicleConfig {
            world: crate::sim::WorldConfig::default(),
            firmware: crate::firmware::FirmwareOptions::default(),
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
        let scenario = parse("flight", text).unwrap_or_else(|problem| panic!("{problem}\n{text}"));
        let (case, air) = (&scenario.cases[0], scenario.cases[0].airs[0]);
        let flown = CaseFlight::new(case, &air).unwrap().fly();
        let unmet = judge(case, &flown).0.into_iter().filter(|judgement| !judgement.outcome.is_met());
        let unmet = unmet.map(|judgement| judgement.label).collect();
        (flown, unmet)
    }

    #[test]
    fn the_first_flight_of_a_session_is_the_scenario_that_is_written_of_it() {
        let plan = BuiltinPlan::find(crate::plan::builtin::DEMO).unwrap().read().unwrap();
        let happen = |tick: u64, vehicle: &mut Vehicle| match tick {
            2000 => upload(&plan, vehicle),
            2001 => vehicle.start_pilot(10.0).unwrap(),
            40_000 => vehicle.change_world(WorldCommand::parse("wind=3@270").unwrap()).unwrap(),
            // This plan is stored now, but it is not flown.
            50_000 => upload(&BuiltinPlan::find("land").unwrap().read().unwrap(), vehicle),
            _ => {}
        };
        let (flight, flown) = first_flight(happen, 100);
        let truth = *flown.truth().unwrap();
        let text = Draft::of_recorded("first", flight).unwrap().finish().unwrap();
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
        let (short, long) = (plan("land"), plan(crate::plan::builtin::DEMO));
        let happen = |tick: u64, vehicle: &mut Vehicle| match tick {
            2000 => upload(&short, vehicle),
            2001 => vehicle.start_pilot(5.0).unwrap(),
            22_000 => upload(&long, vehicle),
            23_000 => {
                let _done = vehicle.apply(&VehicleCommand::InFlight(InFlightCommand::GoTo(2)));
            }
            _ => {}
        };
        let (flight, _) = first_flight(happen, 80);
        let text = Draft::of_recorded("two plans", flight).unwrap().finish().unwrap();
        assert!(text.contains("APPROACHING 2"), "{text}");
        assert_eq!(checked(&text).1, [""; 0]);
    }

    #[test]
    fn waiting_after_the_landing_is_left_out() {
        let plan = BuiltinPlan::find("land").unwrap().read().unwrap();
        let happen = |tick: u64, vehicle: &mut Vehicle| match tick {
            2000 => upload(&plan, vehicle),
            2001 => vehicle.start_pilot(5.0).unwrap(),
            _ => {}
        };
        let (flight, _) = first_flight(happen, 300);
        let draft = Draft::of_recorded("landed", flight).unwrap();
        assert!(draft.ends.is_some_and(|ends| ends.as_secs_f64() < 120.0), "{:?}", draft.ends);
        let text = draft.finish().unwrap();
        assert!(text.contains("disarmed LANDING"), "{text}");
        assert_eq!(checked(&text).1, [""; 0]);
    }

    #[test]
    fn a_problem_is_one_sentence_without_a_place_in_a_file_that_nobody_has() {
        let text =
            "format = 1\n[plan]\nwaypoints = []\n[[expect]]\nevent = \"ARRIVED 7\"\n[[expect]]\nno = 1\n";
        let problem = parse("square", text).unwrap_err();
        assert_eq!(problem, "a scenario cannot say what happened in this flight: the plan has no waypoint 7");
    }
}
