//! Mean and spread of a few values.

/// Mean and spread of the values of several flights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    pub mean: f64,
    /// The standard deviation; `None` for a single value.
    pub spread: Option<f64>,
    /// The number of values.
    pub count: usize,
}

impl Statistics {
    /// Returns the statistics of these values; `None` if there are no values.
    pub(super) fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let values: Vec<f64> = values.collect();
        let count = values.len();
        if count == 0 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        let spread = (count > 1).then(|| (squares / (count - 1) as f64).sqrt());
        Some(Self { mean, spread, count })
    }

    /// Returns these statistics less `other`. The spreads of the two are independent.
    pub(super) fn less(self, other: Self) -> Self {
        let spread = match (self.spread, other.spread) {
            (Some(one), Some(two)) => Some(one.hypot(two)),
            (one, two) => one.or(two),
        };
        Self { mean: self.mean - other.mean, spread, count: self.count.min(other.count) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_standard_deviation() {
        let three = Statistics::of([1.0, 2.0, 6.0].into_iter()).unwrap();
        assert!((three.mean - 3.0).abs() < 1e-12 && (three.spread.unwrap() - 7.0_f64.sqrt()).abs() < 1e-12);
        let one = Statistics::of([4.0].into_iter()).unwrap();
        assert_eq!((one.mean, one.spread, one.count), (4.0, None, 1));
        assert_eq!(Statistics::of([].into_iter()), None);
        let less = three.less(one);
        assert!((less.mean + 1.0).abs() < 1e-12 && less.spread == three.spread);
        let both = three.less(three);
        assert!((both.spread.unwrap() - 14.0_f64.sqrt()).abs() < 1e-12);
    }
}
