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
    pub fn from_plan(file: &PlanFile) -> Self {
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
    use crate::sim::WorldCommand;
    use crate::timeline::RecordedFlight;
    use crate::vehicle::VehicleCommand;

    #[test]
    fn what_was_wrong_at_the_start_of_a_recorded_flight_is_wrong_in_its_scenario() {
        let (mut start, _) = FlightSetup::default().build().unwrap();
        for line in ["fault=motor,,2:0.9", "fault=gps-loss@boot+20,3"] {
            start.apply(&VehicleCommand::from(WorldCommand::parse(line).unwrap())).accepted().unwrap();
        }
        let until = SimTime::from_secs_f64(2.0);
        let flight = RecordedFlight { start, inputs: Vec::new(), until };
        let text = Draft::from_recorded("wrong", flight).unwrap().finish().unwrap();
        for part in ["fault motor,,2:0.9", "fault gps-loss@boot+20,3"] {
            assert!(text.contains(part), "{part}\n{text}");
        }
    }

    #[test]
    fn a_problem_is_one_sentence_without_a_place_in_a_file_that_nobody_has() {
        let text =
            "format = 1\n[plan]\nwaypoints = []\n[[expect]]\nevent = \"ARRIVED 7\"\n[[expect]]\nno = 1\n";
        let problem = parse("square", text).unwrap_err();
        assert_eq!(problem, "a scenario cannot say what happened in this flight: the plan has no waypoint 7");
    }
}
