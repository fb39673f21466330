//! The answer of `rescue`: five sentences, the worst flights, and what would mend them.

use std::collections::BTreeMap;
use std::path::Path;

use super::settings::PilotSettings;
use super::trial::{Begin, Craft, Flown, Trouble};
use crate::report::check::shell_word;

/// The flights that the answer names.
const WORST: usize = 3;
/// A touchdown at more than this breaks parts, m/s.
const HARD_MPS: f64 = 2.0;

/// Lines that helped, and how much.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub(super) struct Mend {
    pub(super) lines: Vec<String>,
    /// The number of flights that came home with them, of those that were tried.
    pub(super) home: usize,
    pub(super) tried: usize,
}

/// All flights and what they say.
#[derive(Debug)]
pub(super) struct Answer {
    profile: &'static str,
    wind_mps: f64,
    flights: Vec<Flown>,
    mend: Option<Mend>,
}

impl Answer {
    pub(super) fn new(
        settings: &PilotSettings,
        craft: &Craft,
        flights: Vec<Flown>,
        mend: Option<Mend>,
    ) -> Self {
        Self { profile: settings.profile.into(), wind_mps: craft.wind_mps, flights, mend }
    }

    /// Returns `true` if every flight came home.
    pub(super) fn is_safe(&self) -> bool {
        self.flights.iter().all(|flown| flown.is_home)
    }

    /// Returns the flights to look at: of each reason one, those nearest to home first.
    pub(super) fn worst(&self) -> impl Iterator<Item = &Flown> {
        let mut by_kind: BTreeMap<(String, u16, bool), &Flown> = BTreeMap::new();
        for flown in self.flights.iter().filter(|flown| !flown.is_home) {
            let trial = &flown.trial;
            by_kind.entry((flown.result.clone(), trial.compass_deg, trial.is_windy)).or_insert(flown);
        }
        by_kind.into_values().take(WORST)
    }

    /// Returns the answer and all flights as a line of JSON.
    pub(super) fn json(&self) -> String {
        let object = serde_json::json!({
            "profile": self.profile,
            "wind_mps": self.wind_mps,
            "home": self.flights.iter().filter(|flown| flown.is_home).count(),
            "flights": self.flights,
            "mend": self.mend,
        });
        format!("{object}\n")
    }

    /// Returns the sentences, the worst flights and the lines that mend.
    pub(super) fn text(&self, scenario: Option<&Path>) -> String {
        let mut text = String::new();
        for sentence in self.sentences() {
            text.push_str(&sentence);
            text.push('\n');
        }
        for flown in self.worst() {
            text.push_str(&format!("  {}: {}\n", flown.trial.name(), flown.reason));
            if let Some(file) = scenario {
                let (file, case) = (shell_word(&file.display().to_string()), flown.trial.name());
                text.push_str(&format!("      betadeck open {file} --case '{case}'\n"));
            }
        }
        if scenario.is_none() && !self.is_safe() {
            text.push_str("  --scenario FILE writes these flights, to be opened and flown again\n");
        }
        if let Some(mend) = &self.mend {
            text.push_str(&format!(
                "With these lines {} of {} of the failed flights come home:\n",
                mend.home, mend.tried
            ));
            mend.lines.iter().for_each(|line| text.push_str(&format!("  {line}\n")));
        } else if !self.is_safe() {
            text.push_str("None of the changes that were tried helps.\n");
        }
        text
    }

    fn sentences(&self) -> [String; 5] {
        let share = |keep: &dyn Fn(&Flown) -> bool| {
            let of: Vec<&Flown> = self.flights.iter().filter(|flown| keep(flown)).collect();
            format!("{} of {}", of.iter().filter(|flown| flown.is_home).count(), of.len())
        };
        let right = |flown: &Flown| flown.trial.compass_deg == 0 && flown.trial.trouble == Trouble::Nothing;
        let mut distances_m: Vec<u16> = self.flights.iter().map(|flown| flown.trial.distance_m).collect();
        distances_m.dedup();
        let by_distance: Vec<String> = distances_m
            .into_iter()
            .map(|distance_m| {
                let is_here = |flown: &Flown| {
                    right(flown) && !flown.trial.is_windy && flown.trial.distance_m == distance_m
                };
                format!("from {distance_m} m in {}", share(&is_here))
            })
            .collect();
        let windy = share(&|flown| right(flown) && flown.trial.is_windy);
        let compass = [30, 90].map(|degrees| {
            format!("{degrees}° off in {}", share(&|flown| flown.trial.compass_deg == degrees))
        });
        let begin = |begin| share(&move |flown: &Flown| right(flown) && flown.trial.begin == begin);
        let trouble = |trouble| share(&move |flown: &Flown| flown.trial.trouble == trouble);
        [
            format!("In calm air it comes home {}.", by_distance.join(", ")),
            format!("In a wind of {} m/s it comes home in {windy}{}.", self.wind_mps, self.short()),
            format!("With the compass {} it comes home.", compass.join(" and ")),
            format!(
                "By the switch it comes home in {}, after a lost link in {}, with the link back after 12 s in {}; with a GPS \
                 that is 0.5 s late in {}, with a low battery in {}.",
                begin(Begin::Switch),
                begin(Begin::LinkLost),
                begin(Begin::LinkBack),
                trouble(Trouble::GpsLate),
                trouble(Trouble::BatteryLow)
            ),
            self.landing(),
        ]
    }

    /// Returns how far those that do not come home against the wind stay away.
    fn short(&self) -> String {
        let windy = self.flights.iter().filter(|flown| flown.trial.is_windy && !flown.is_home);
        let nearest = windy.filter_map(|flown| flown.nearest_m).fold(0.0_f64, f64::max);
        if nearest > 20.0 { format!("; the worst gets no nearer than {nearest:.0} m") } else { String::new() }
    }

    fn landing(&self) -> String {
        let mut impacts: Vec<f64> = self.flights.iter().filter_map(|flown| flown.impact_mps).collect();
        impacts.sort_by(f64::total_cmp);
        let (Some(median), Some(most)) = (impacts.get(impacts.len() / 2), impacts.last()) else {
            return "No flight touches the ground.".to_owned();
        };
        let hard = impacts.iter().filter(|impact| **impact > HARD_MPS).count();
        format!(
            "It touches the ground at {median:.1} m/s, at most at {most:.1} m/s; {hard} of {} are harder than {HARD_MPS} m/s.",
            impacts.len()
        )
    }
}
