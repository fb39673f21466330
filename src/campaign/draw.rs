//! The values of the inputs of one flight.

use crate::design::{DIMENSIONS, Design, DrawnWind, Points};
use crate::scenario::{CampaignSpec, Change, Spread, VariedInput};
use crate::sim::Wind;

/// The name of the input that chooses among several cases.
pub(super) const CASE: &str = "case";

/// The dimensions of the Sobol sequence. Changing one changes every campaign.
const SHARED: [(&str, usize); 17] = [
    ("wind", 0),
    ("wind from", 1),
    ("gust_mps", 2),
    ("mass_pct", 3),
    ("thrust_pct", 4),
    ("drag_pct", 5),
    ("battery_pct", 6),
    ("inertia_pct", 7),
    ("turbulence", 8),
    ("noise", 9),
    ("gps", 10),
    ("takeoff_m", 11),
    ("heading_deg", 12),
    ("airframe", 13),
    ("rate_hz", 14),
    (CASE, 15),
    ("wind speed", 16),
];
const _: () = assert!(SHARED.len() <= DIMENSIONS);

/// The number of a flight in a design.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) points: Points,
    /// The flight, from 0.
    pub(super) index: u64,
    /// The level of each input, if the design is a grid.
    pub(super) levels: &'a [u64],
}

/// A value of an input.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Drawn {
    pub(super) name: String,
    /// The value for people; empty for winds, which the air shows.
    pub(super) shown: String,
    pub(super) changes: Vec<Change>,
}

impl Place<'_> {
    /// Returns the number of an input, greater than 0 and less than 1.
    pub(super) fn unit(&self, name: &str) -> f64 {
        let dimension = SHARED.iter().find(|(shared, _)| *shared == name).map(|&(_, dimension)| dimension);
        self.points.unit(name, dimension, self.index)
    }

    /// Returns the unit coordinate of an input that has this number of levels; in a grid, the centre of its level.
    fn unit_of(&self, input: usize, name: &str, count: u64) -> f64 {
        match self.levels.get(input) {
            Some(&level) if self.points.design == Design::Grid => (level as f64 + 0.5) / count.max(1) as f64,
            _ => self.unit(name),
        }
    }

    /// Returns the values of all inputs, in their order.
    pub(super) fn draw(&self, spec: &CampaignSpec) -> Vec<Drawn> {
        let inputs = spec.inputs.iter().enumerate();
        inputs.map(|(at, input)| self.draw_one(at, input, spec.levels)).collect()
    }

    fn draw_one(&self, at: usize, input: &VariedInput, levels: u64) -> Drawn {
        let name = input.name.as_str();
        let drawn = |shown: String, changes: Vec<Change>| Drawn { name: name.to_owned(), shown, changes };
        match &input.spread {
            Spread::Choice(choices) => {
                let index = (self.unit_of(at, name, choices.len() as u64) * choices.len() as f64) as usize;
                let choice = choices.get(index.min(choices.len().saturating_sub(1)));
                choice.map_or_else(
                    || drawn(String::new(), Vec::new()),
                    |choice| drawn(choice.shown.clone(), vec![choice.change.clone()]),
                )
            }
            Spread::Number(number, distribution) => {
                let value = distribution.quantile(self.unit_of(at, name, levels));
                let value = if number.is_whole() { value.round() } else { value };
                drawn(value.to_string(), vec![number.change(value)])
            }
            Spread::Wind { speed, from } => {
                let speed_mps = speed.quantile(self.unit_of(at, name, levels));
                let from_deg = from.quantile(self.unit("wind from")).rem_euclid(360.0);
                drawn(String::new(), vec![Change::WindIs(Wind { speed_mps, from_deg })])
            }
            Spread::Table(table) => {
                let units = [self.unit_of(at, name, levels), self.unit("wind from"), self.unit("wind speed")];
                let DrawnWind { speed_mps, from_deg, gust_mps } = table.draw(units);
                let mut changes = vec![Change::WindIs(Wind { speed_mps, from_deg })];
                changes.extend(gust_mps.map(Change::Gust));
                drawn(String::new(), changes)
            }
        }
    }
}

/// Returns the number of values that a grid takes of an input.
pub(super) fn grid_levels(input: &VariedInput, levels: u64) -> u64 {
    match &input.spread {
        Spread::Choice(choices) => choices.len() as u64,
        Spread::Number(_, distribution) if distribution.value().is_some() => 1,
        Spread::Wind { speed, .. } if speed.value().is_some() => 1,
        Spread::Number(..) | Spread::Wind { .. } | Spread::Table(_) => levels,
    }
}

/// Returns `true` if flights may have different values of an input.
pub(super) fn varies(input: &VariedInput) -> bool {
    match &input.spread {
        Spread::Choice(choices) => choices.len() > 1,
        Spread::Number(_, distribution) => distribution.value().is_none(),
        Spread::Wind { speed, from } => speed.value().is_none() || from.value().is_none(),
        Spread::Table(_) => true,
    }
}
