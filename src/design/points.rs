//! The points of a design: for each flight and each input a number between 0 and 1.

use super::latin::shuffled;
use super::sobol::{DIMENSIONS, coordinate, scrambled};
use super::stream::{Stream, fingerprint, mixed, unit_of};

/// The way in which the flights of a campaign are spread over the values of its inputs.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, strum::Display, strum::EnumString, strum::VariantNames,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Design {
    /// Every combination of the values.
    Grid,
    /// Each flight is drawn independently of the others.
    #[default]
    MonteCarlo,
    /// Each input has one flight in each of as many equal parts of its distribution as there are flights.
    LatinHypercube,
    /// A scrambled Sobol sequence: even in each input, and in the built-in inputs together.
    Sobol,
}

/// The points of a campaign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Points {
    /// Returns the design.
    pub design: Design,
    /// The seed of all draws.
    pub seed: u64,
    /// The number of flights.
    pub count: u64,
}

impl Points {
    /// Returns the number of an input in a flight, greater than 0 and less than 1. Flights count from 0. An input with a
    /// `dimension` shares the Sobol sequence with the others that have one. Each other input has a sequence of its own.
    /// A grid has no random numbers, so it gets those of [`Design::MonteCarlo`].
    pub fn unit(&self, name: &str, dimension: Option<usize>, index: u64) -> f64 {
        let stream = Stream::new(self.seed, name);
        let bits = stream.bits(index);
        match self.design {
            Design::Grid | Design::MonteCarlo => unit_of(bits),
            Design::LatinHypercube => {
                let part = shuffled(index % self.count.max(1), self.count.max(1), self.key(name));
                (part as f64 + unit_of(bits)) / self.count.max(1) as f64
            }
            Design::Sobol => {
                let key = self.key(name);
                let index = index as u32;
                let point = match dimension.filter(|&dimension| dimension < DIMENSIONS) {
                    Some(dimension) => coordinate(index, dimension),
                    // Another order of the points makes the pairs with other inputs random.
                    None => coordinate(scrambled(index, mixed(key)), 0),
                };
                let high = u64::from(scrambled(point, key)) << 32;
                unit_of(high | bits >> 32)
            }
        }
    }

    fn key(&self, name: &str) -> u64 {
        mixed(self.seed ^ mixed(fingerprint(name.as_bytes())))
    }
}

#[cfg(test)]
mod tests {
    use strum::VariantNames as _;

    use super::*;

    const DESIGNS: [Design; 3] = [Design::MonteCarlo, Design::LatinHypercube, Design::Sobol];

    fn units(design: Design, name: &str, dimension: Option<usize>, count: u64) -> Vec<f64> {
        let points = Points { design, seed: 1, count };
        (0..count).map(|index| points.unit(name, dimension, index)).collect()
    }

    #[test]
    fn designs_have_names() {
        assert_eq!(Design::VARIANTS, ["grid", "monte-carlo", "latin-hypercube", "sobol"]);
        assert_eq!("latin-hypercube".parse(), Ok(Design::LatinHypercube));
    }

    #[test]
    fn every_number_lies_between_its_ends() {
        for design in DESIGNS {
            for dimension in [None, Some(0), Some(3), Some(900)] {
                let all = units(design, "wind", dimension, 300);
                assert!(all.iter().all(|&unit| 0.0 < unit && unit < 1.0), "{design}");
            }
        }
    }

    #[test]
    fn a_latin_hypercube_and_a_sequence_have_one_flight_in_each_part() {
        for (design, dimension) in
            [(Design::LatinHypercube, None), (Design::Sobol, None), (Design::Sobol, Some(5))]
        {
            let count = 128;
            let mut parts: Vec<u64> = units(design, "mass", dimension, count)
                .iter()
                .map(|unit| (unit * count as f64) as u64)
                .collect();
            parts.sort_unstable();
            assert_eq!(parts, (0..count).collect::<Vec<_>>(), "{design} {dimension:?}");
        }
    }

    #[test]
    fn inputs_are_not_correlated() {
        for design in DESIGNS {
            let a = units(design, "wind", None, 1024);
            let b = units(design, "mass", None, 1024);
            let product: f64 = std::iter::zip(&a, &b).map(|(a, b)| (a - 0.5) * (b - 0.5)).sum();
            let correlation = product / 1024.0 * 12.0;
            assert!(correlation.abs() < 0.13, "{design}: {correlation}");
        }
    }

    #[test]
    fn a_sequence_integrates_better_than_independent_draws() {
        // The mean of the product of four inputs is 1/16.
        let error = |design| {
            let points = Points { design, seed: 2, count: 4096 };
            let product = |index| {
                let unit =
                    |dimension: usize| points.unit(["a", "b", "c", "d"][dimension], Some(dimension), index);
                (0..4).map(unit).product::<f64>()
            };
            ((0..4096).map(product).sum::<f64>() / 4096.0 - 0.0625).abs()
        };
        let (sobol, drawn) = (error(Design::Sobol), error(Design::MonteCarlo));
        assert!(sobol < 1e-4 && sobol < drawn / 3.0, "{sobol} {drawn}");
    }
}
