//! A campaign as its file describes it: the inputs that vary, the design, and the goals.

use std::ops::RangeInclusive;

use super::air::AirTemplate;
use super::goal::Goal;
use super::varied::VariedInput;
use crate::design::Design;

/// The most flights of a campaign.
pub const MAX_CAMPAIGN: u64 = 10_000_000;
/// The usual number of flights of a campaign that is drawn.
pub const USUAL_FLIGHTS: u64 = 1000;
/// The usual number of levels into which a grid divides a distribution.
pub const USUAL_LEVELS: u64 = 5;

/// `[campaign]`, and what its flights vary.
#[derive(Debug, Clone, PartialEq)]
pub struct CampaignSpec {
    /// The way in which the values of the flights are chosen.
    pub design: Design,
    /// The number of flights; `None` = the size of the grid, or [`USUAL_FLIGHTS`].
    pub flights: Option<u64>,
    /// The seed of the drawn values.
    pub seed: u64,
    /// The number of values that a grid takes of a distribution.
    pub levels: u64,
    /// The inputs that vary, in the order of their names.
    pub inputs: Vec<VariedInput>,
    /// The air of each case, and the seeds of its flights.
    pub airs: Vec<(AirTemplate, FlightSeeds)>,
    /// The expectations of the whole campaign.
    pub goals: Vec<Goal>,
}

/// The seeds of the flights of a campaign, in turn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FlightSeeds {
    /// Another seed for each flight, from this one on.
    From(u64),
    /// The seeds of a range.
    Range(RangeInclusive<u64>),
    /// These seeds.
    List(Vec<u64>),
}

impl FlightSeeds {
    /// Returns the seed of a flight, from 0 on.
    pub fn at(&self, flight: u64) -> u64 {
        match self {
            Self::From(first) => first.wrapping_add(flight),
            Self::Range(seeds) => {
                let count = (seeds.end() - seeds.start()).saturating_add(1);
                seeds.start() + flight % count
            }
            Self::List(seeds) => {
                let at = flight % (seeds.len() as u64).max(1);
                seeds.get(at as usize).copied().unwrap_or(1)
            }
        }
    }

    /// Returns the number of seeds that a grid combines with the other values.
    pub fn count(&self) -> u64 {
        match self {
            Self::From(_) => 1,
            Self::Range(seeds) => (seeds.end() - seeds.start()).saturating_add(1),
            Self::List(seeds) => seeds.len() as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_are_taken_in_turn() {
        let first = |seeds: FlightSeeds| (0..5).map(|flight| seeds.at(flight)).collect::<Vec<_>>();
        assert_eq!(first(FlightSeeds::From(7)), [7, 8, 9, 10, 11]);
        assert_eq!(first(FlightSeeds::Range(1..=3)), [1, 2, 3, 1, 2]);
        assert_eq!(first(FlightSeeds::List(vec![4, 9])), [4, 9, 4, 9, 4]);
    }
}
