//! The middle and the spread of a few values.

/// The median and the spread of the values of several flights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// The middle value, or the mean of the two in the middle.
    pub median: f64,
    pub min: f64,
    pub max: f64,
    /// The number of values.
    pub count: usize,
}

impl Statistics {
    /// Returns the statistics of these values; `None` if there are no values.
    pub(in crate::report) fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let (min, max) = (*values.first()?, *values.last()?);
        let count = values.len();
        let (low, high) = (*values.get((count - 1) / 2)?, *values.get(count / 2)?);
        Some(Self { median: f64::midpoint(low, high), min, max, count })
    }

    /// Returns the greatest value less the least.
    pub(super) fn spread(self) -> f64 {
        self.max - self.min
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64]) -> Option<Statistics> {
        Statistics::of(values.iter().copied())
    }

    #[test]
    fn median_and_spread() {
        assert_eq!(of(&[6.0, 1.0, 2.0]), Some(Statistics { median: 2.0, min: 1.0, max: 6.0, count: 3 }));
        assert_eq!(of(&[6.0, 1.0, 2.0, 3.0]).map(|four| (four.median, four.spread())), Some((2.5, 5.0)));
        assert_eq!(of(&[4.0]), Some(Statistics { median: 4.0, min: 4.0, max: 4.0, count: 1 }));
        assert_eq!(of(&[]), None);
    }
}
