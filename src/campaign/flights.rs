//! The flights of a campaign by their numbers.

use super::draw::{CASE, Drawn, Place, grid_levels, varies};
use super::record::InputValue;
use crate::design::{Design, Points};
use crate::scenario::{Air, CampaignSpec, Case, Change, FlightSeeds, MAX_CAMPAIGN, Scenario, USUAL_FLIGHTS};

/// The flights of a campaign.
#[derive(Debug, Clone)]
pub struct Campaign {
    scenario: Scenario,
    flights: Flights,
    count: u64,
    /// `true` if the wind differs between listed flights.
    has_winds: bool,
}

/// The way to a flight by its number.
#[derive(Debug, Clone)]
enum Flights {
    /// The first flight of each case.
    Listed(Vec<u64>),
    Drawn(Design),
}

/// A flight of a campaign, ready to be flown.
#[derive(Debug, Clone)]
pub struct CampaignFlight {
    /// The number, from 1.
    pub number: u64,
    /// The case with the values of the inputs.
    pub case: Case,
    pub air: Air,
    /// The inputs that differ between the flights.
    pub inputs: Vec<(String, InputValue)>,
    /// The reason why the flight cannot be flown.
    pub problem: Option<String>,
}

impl CampaignFlight {
    /// Returns the reason why the flight cannot be flown, as far as it is known without building its world.
    pub fn impossible(&self) -> Option<String> {
        let world = || self.case.setup_in(&self.air).world.check().err().map(|error| error.to_string());
        self.problem.clone().or_else(world)
    }
}

impl Campaign {
    /// Returns the flights of a scenario. `flights` and `design` take the place of those in the file.
    ///
    /// # Errors
    /// Returns a sentence if the number of flights does not fit.
    pub fn new(scenario: Scenario, flights: Option<u64>, design: Option<Design>) -> Result<Self, String> {
        let Some(spec) = &scenario.campaign else { return Ok(Self::listed(scenario)) };
        let design = design.unwrap_or(spec.design);
        let asked = flights.or(spec.flights);
        let count = match design {
            Design::Grid => {
                let size = grid_size(&scenario, spec).ok_or_else(|| {
                    format!("the grid has more than {MAX_CAMPAIGN} flights: leave values out")
                })?;
                match asked {
                    Some(asked) if asked != size => {
                        return Err(format!(
                            "the grid has {size} flights, not {asked}: leave the number out, or choose another design"
                        ));
                    }
                    _ => size,
                }
            }
            _ => asked.unwrap_or(USUAL_FLIGHTS),
        };
        Ok(Self { scenario, flights: Flights::Drawn(design), count, has_winds: false })
    }

    fn listed(scenario: Scenario) -> Self {
        let mut firsts = Vec::with_capacity(scenario.cases.len());
        let mut count = 0;
        for case in &scenario.cases {
            firsts.push(count);
            count += case.airs.len() as u64;
        }
        let mut winds = scenario.cases.iter().flat_map(|case| &case.airs).map(|air| air.wind);
        let first = winds.next();
        let has_winds = winds.any(|wind| Some(wind) != first);
        Self { scenario, flights: Flights::Listed(firsts), count, has_winds }
    }

    /// Checks that the flights differ. Equal flights say nothing more than one of them, and their share has no interval.
    ///
    /// # Errors
    /// Returns a sentence with the way to let them differ.
    pub fn refuse_equal_flights(&self) -> Result<(), String> {
        let Some(spec) = self.scenario.campaign.as_ref().filter(|_| self.design() != Some(Design::Grid))
        else {
            return Ok(());
        };
        let count = self.count;
        let different =
            spec.airs.iter().take(self.scenario.cases.len()).fold(0_u64, |sum, (template, seeds)| {
                let of_case = match seeds {
                    _ if !template.is_random() => 1,
                    FlightSeeds::From(_) => count,
                    FlightSeeds::Range(_) | FlightSeeds::List(_) => seeds.count(),
                };
                sum.saturating_add(of_case)
            });
        if spec.inputs.iter().any(varies) || different >= count {
            return Ok(());
        }
        let problem = match different {
            1 => format!("nothing varies: the {count} flights would be one and the same flight"),
            _ => format!("only {different} of the {count} flights would differ"),
        };
        let way_out = if spec.airs.iter().any(|(template, _)| template.is_random()) {
            format!("fly other seeds, --seeds 1..{count}, or vary an input")
        } else {
            "a seed changes nothing without noise, gusts and turbulence; add one of them, or vary an input"
                .to_owned()
        };
        Err(format!("{problem}: {way_out}"))
    }

    /// Returns the scenario of the flights.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Returns the number of flights.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the design; `None` if the flights are listed.
    pub fn design(&self) -> Option<Design> {
        match self.flights {
            Flights::Listed(_) => None,
            Flights::Drawn(design) => Some(design),
        }
    }

    /// Returns the flight with a number, from 1; `None` if there is none.
    pub fn flight(&self, number: u64) -> Option<CampaignFlight> {
        let index = number.checked_sub(1).filter(|&index| index < self.count)?;
        match (&self.flights, &self.scenario.campaign) {
            (Flights::Drawn(design), Some(spec)) => self.drawn(number, index, *design, spec),
            (Flights::Listed(firsts), _) => {
                let at = firsts.partition_point(|&first| first <= index).checked_sub(1)?;
                let case = self.scenario.cases.get(at)?;
                let air = *case.airs.get((index - firsts.get(at)?) as usize)?;
                let mut inputs = self.case_input(case);
                for (key, shown) in case.varied.iter().filter(|(key, _)| key != "wind") {
                    let (name, value) = named(key, shown);
                    inputs.push((name, InputValue::of(value)));
                }
                if self.has_winds {
                    inputs.extend(wind_inputs(&air));
                }
                Some(CampaignFlight { number, case: case.clone(), air, inputs, problem: None })
            }
            (Flights::Drawn(_), None) => None,
        }
    }

    fn drawn(&self, number: u64, index: u64, design: Design, spec: &CampaignSpec) -> Option<CampaignFlight> {
        let cases = &self.scenario.cases;
        let points = Points { design, seed: spec.seed, count: self.count };
        let (at, seed_at, levels) = match design {
            Design::Grid => grid_place(cases, spec, index)?,
            _ => {
                let place = Place { points, index, levels: &[] };
                let at = if cases.len() > 1 { (place.unit(CASE) * cases.len() as f64) as usize } else { 0 };
                (at.min(cases.len().saturating_sub(1)), index, Vec::new())
            }
        };
        let mut case = cases.get(at)?.clone();
        let (template, seeds) = spec.airs.get(at)?;
        let is_counted = matches!(seeds, FlightSeeds::From(_));
        let seed = seeds.at(if is_counted { index } else { seed_at });
        let mut problem = None;
        let mut air = template.of_seed(seed).unwrap_or_else(|error| {
            problem = Some(error.message);
            Air { seed, ..Air::default() }
        });
        let drawn = Place { points, index, levels: &levels }.draw(spec);
        let mut changes: Vec<&Change> = drawn.iter().flat_map(|drawn| &drawn.changes).collect();
        changes.sort_by_key(|change| change.phase());
        for change in changes {
            if let Err(sentence) = change.apply(&mut case, &mut air) {
                problem.get_or_insert(sentence);
            }
        }
        let mut inputs = self.case_input(&case);
        for Drawn { name, shown, changes } in drawn {
            let is_wind = matches!(changes.first(), Some(Change::Wind(_) | Change::WindIs(_)));
            if is_wind {
                inputs.extend(wind_inputs(&air));
                let gusts = changes.iter().any(|change| matches!(change, Change::Gust(_)));
                inputs.extend(gusts.then(|| ("gust_mps".to_owned(), InputValue::Number(air.gust_mps))));
            } else {
                let (name, value) = named(&name, &shown);
                inputs.push((name, InputValue::of(value)));
            }
        }
        Some(CampaignFlight { number, case, air, inputs, problem })
    }

    fn case_input(&self, case: &Case) -> Vec<(String, InputValue)> {
        let is_one_of_many =
            !case.base.is_empty() && self.scenario.cases.iter().any(|other| other.base != case.base);
        let input = is_one_of_many.then(|| (CASE.to_owned(), InputValue::Word(case.base.clone())));
        input.into_iter().collect()
    }
}

/// Returns the name and the value of an input. One of the lists `settings` and `world` is named as what it sets.
fn named<'a>(key: &str, shown: &'a str) -> (String, &'a str) {
    match shown.split_once('=') {
        Some((name, value)) if matches!(key, "settings" | "world") => (name.trim().to_owned(), value.trim()),
        _ => (key.to_owned(), shown),
    }
}

fn wind_inputs(air: &Air) -> [(String, InputValue); 2] {
    [
        ("wind_mps".to_owned(), InputValue::Number(air.wind.speed_mps)),
        ("wind_from_deg".to_owned(), InputValue::Number(air.wind.from_deg)),
    ]
}

/// Returns the number of flights of a grid; `None` if there are too many.
fn grid_size(scenario: &Scenario, spec: &CampaignSpec) -> Option<u64> {
    let inputs = spec
        .inputs
        .iter()
        .try_fold(1_u64, |size, input| size.checked_mul(grid_levels(input, spec.levels).max(1)))?;
    let seeds = spec
        .airs
        .iter()
        .take(scenario.cases.len())
        .try_fold(0_u64, |sum, (_, seeds)| sum.checked_add(seeds.count()))?;
    inputs.checked_mul(seeds).filter(|&size| (1..=MAX_CAMPAIGN).contains(&size))
}

/// Returns the case, the number of the seed and the levels of the inputs of a flight of a grid. The seeds change first,
/// then the last inputs, then the cases.
fn grid_place(cases: &[Case], spec: &CampaignSpec, index: u64) -> Option<(usize, u64, Vec<u64>)> {
    let counts: Vec<u64> = spec.inputs.iter().map(|input| grid_levels(input, spec.levels).max(1)).collect();
    let combinations: u64 = counts.iter().product();
    let mut rest = index;
    for (at, (_, seeds)) in spec.airs.iter().enumerate().take(cases.len()) {
        let of_case = seeds.count() * combinations;
        if rest >= of_case {
            rest -= of_case;
            continue;
        }
        let seed_at = rest % seeds.count();
        let mut place = rest / seeds.count();
        let mut levels = vec![0; counts.len()];
        for (level, count) in levels.iter_mut().zip(&counts).rev() {
            *level = place % count;
            place /= count;
        }
        return Some((at, seed_at, levels));
    }
    None
}
