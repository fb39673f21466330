//! A scenario made from a flight: what was flown, what was done, and what was seen as what is expected.

mod observed;
mod recorded;
mod toml_text;

use super::case::Scenario;
use super::file::{Files, read};
use super::judge::judge;
use super::run::{CaseFlight, Flown};
use crate::plan::FlightPlan;
use crate::plan::format::{HomePosition, PlanFile, report};
use crate::signals::SimTime;

/// A scenario that is being made.
#[derive(Debug, Clone, Default)]
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
    /// When it ends, counted from boot.
    ends: Option<SimTime>,
    /// When and what.
    inputs: Vec<(String, String)>,
}

/// A table of a file: keys and values in TOML.
type Block = Vec<(&'static str, String)>;

impl Draft {
    /// A flight of a plan without inputs: the scripted pilot flies it in calm air.
    #[must_use]
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

    /// The text of the scenario that expects what a flight of it shows, with margins.
    ///
    /// # Errors
    /// A sentence, when it cannot be flown.
    pub fn finish(mut self) -> Result<String, String> {
        let flown = self.fly()?;
        if flown.result == "timeout" && self.ends.is_none() {
            // It goes on for ever, as a hold without an end does.
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
            Err(format!("what was seen cannot be expected again: {}", unmet.join("; ")))
        }
    }

    /// Flies what is there, without expectations.
    fn fly(&self) -> Result<Flown, String> {
        let scenario = parse(&self.name, &toml_text::text(self, &[]))?;
        let case = scenario.cases.first().ok_or("the scenario has no case")?;
        let air = case.airs.first().ok_or("the scenario has no seed")?;
        Ok(CaseFlight::new(case, air)?.fly())
    }
}

/// A scenario that was written here names no files.
struct NoFiles;

impl Files for NoFiles {
    fn plan(&mut self, name: &str) -> Result<PlanFile, String> {
        Err(format!("{name} is not at hand"))
    }

    fn text(&mut self, name: &str) -> Result<String, String> {
        Err(format!("{name} is not at hand"))
    }
}

fn parse(name: &str, text: &str) -> Result<Scenario, String> {
    read(name, text, None, &mut NoFiles).map_err(|errors| report(&errors))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::FlightSetup;
    use crate::plan::builtin::BuiltinPlan;
    use crate::signals::SimTime;
    use crate::sim::WorldCommand;
    use crate::timeline::RecordedFlight;

    #[test]
    fn a_plan_becomes_a_scenario_that_passes() {
        let plan = BuiltinPlan::find("land").unwrap().read().unwrap();
        let text = Draft::of_plan(&plan).finish().unwrap();
        for part in ["format = 1", "[plan]", "LANDING", "\"disarmed LANDING\"", "no_event = \"crash\""] {
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
}
