//! The distribution of a number over many flights, in little memory.

use std::collections::BTreeMap;

/// The most values that are kept as they are.
const EXACT: usize = 65_536;
/// The bits of the mantissa that are dropped when values are only counted. The other eleven tell values apart that differ
/// by a two-thousandth.
const DROPPED: u32 = 52 - 11;

/// The values of a number.
///
/// Up to 65 536 values are kept, and all results are exact. Beyond, values are counted in narrow classes, and a quantile is
/// wrong by at most [`Self::ERROR`] of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    values: Vec<f64>,
    classes: BTreeMap<i64, u64>,
    count: u64,
    sum: f64,
    least: f64,
    greatest: f64,
}

impl Default for Summary {
    fn default() -> Self {
        Self {
            values: Vec::new(),
            classes: BTreeMap::new(),
            count: 0,
            sum: 0.0,
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
        }
    }
}

impl Summary {
    /// The greatest error of a quantile of counted values, as a share of itself.
    pub const ERROR: f64 = 1.0 / 4096.0;

    /// Adds a finite value.
    pub fn add(&mut self, value: f64) {
        if !value.is_finite() {
            return;
        }
        self.count += 1;
        self.sum += value;
        self.least = self.least.min(value);
        self.greatest = self.greatest.max(value);
        if self.classes.is_empty() && self.values.len() < EXACT {
            self.values.push(value);
            return;
        }
        for value in std::mem::take(&mut self.values) {
            *self.classes.entry(class_of(value)).or_default() += 1;
        }
        *self.classes.entry(class_of(value)).or_default() += 1;
    }

    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns `true` if quantiles are exact.
    pub fn is_exact(&self) -> bool {
        self.classes.is_empty()
    }

    /// Returns the mean; `None` without values.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }

    /// Returns the smallest value.
    pub fn least(&self) -> Option<f64> {
        (self.count > 0).then_some(self.least)
    }

    /// Returns the greatest value.
    pub fn greatest(&self) -> Option<f64> {
        (self.count > 0).then_some(self.greatest)
    }

    /// Returns the quantiles for these shares, 0…1. Between two values it interpolates linearly.
    pub fn quantiles<const N: usize>(&self, shares: [f64; N]) -> Option<[f64; N]> {
        let last = self.count.checked_sub(1)? as f64;
        let sorted = self.sorted();
        let quantile = |share: f64| {
            let place = share.clamp(0.0, 1.0) * last;
            let (low, high) = (self.at(&sorted, place.floor() as u64), self.at(&sorted, place.ceil() as u64));
            low + (high - low) * place.fract()
        };
        Some(shares.map(quantile))
    }

    /// Returns the number of values in each of so many classes of equal width, from the least value to the greatest.
    pub fn histogram(&self, classes: usize) -> Vec<u64> {
        let mut counts = vec![0; classes.max(1)];
        let width = (self.greatest - self.least) / counts.len() as f64;
        let last = counts.len() - 1;
        let mut add = |value: f64, count: u64| {
            let class = if width > 0.0 { ((value - self.least) / width) as usize } else { 0 };
            counts[class.min(last)] += count;
        };
        self.values.iter().for_each(|&value| add(value, 1));
        self.classes.iter().for_each(|(&class, &count)| add(value_of(class), count));
        counts
    }

    /// Returns the value with a rank, from 1.
    pub fn ranked(&self, rank: u64) -> Option<f64> {
        let index = rank.checked_sub(1).filter(|&index| index < self.count)?;
        Some(self.at(&self.sorted(), index))
    }

    fn sorted(&self) -> Vec<f64> {
        let mut sorted = self.values.clone();
        sorted.sort_by(f64::total_cmp);
        sorted
    }

    /// Returns the value at an index of the ordered values.
    fn at(&self, sorted: &[f64], index: u64) -> f64 {
        if self.is_exact() {
            return sorted.get(index as usize).copied().unwrap_or(f64::NAN);
        }
        let mut before = 0;
        for (&class, &count) in &self.classes {
            before += count;
            if index < before {
                return value_of(class).clamp(self.least, self.greatest);
            }
        }
        self.greatest
    }
}

/// Returns the class of a value. Classes are in the order of their values.
fn class_of(value: f64) -> i64 {
    let class = (value.abs().to_bits() >> DROPPED) as i64;
    if value < 0.0 { -class - 1 } else { class }
}

/// Returns the middle of a class.
fn value_of(class: i64) -> f64 {
    let size = if class < 0 { -class - 1 } else { class } as u64;
    let middle = f64::from_bits(size << DROPPED | 1 << (DROPPED - 1));
    match (size, class < 0) {
        (0, _) => 0.0,
        (_, true) => -middle,
        (_, false) => middle,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: impl IntoIterator<Item = f64>) -> Summary {
        let mut summary = Summary::default();
        values.into_iter().for_each(|value| summary.add(value));
        summary
    }

    #[test]
    fn few_values_have_exact_quantiles() {
        let summary = of([9.0, 1.0, 4.0, 6.0, f64::NAN]);
        let [least, quartile, median, greatest] = summary.quantiles([0.0, 0.25, 0.5, 1.0]).unwrap();
        assert_eq!((least, quartile, median, greatest), (1.0, 3.25, 5.0, 9.0));
        assert_eq!((summary.mean(), summary.count(), summary.ranked(3)), (Some(5.0), 4, Some(6.0)));
        assert!(summary.is_exact());
        assert_eq!(of([]).quantiles([0.5]), None);
        assert_eq!(of([]).mean(), None);
    }

    #[test]
    fn many_values_have_quantiles_within_the_stated_error() {
        // Deterministic values over many sizes, half of them negative.
        let value = |index: u32| {
            let unit = f64::from(index.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24);
            if index.is_multiple_of(2) { (10.0 * unit).exp() * 1e-3 } else { -(6.0 * unit).exp() }
        };
        let count = 200_000;
        let mut exact: Vec<f64> = (0..count).map(value).collect();
        let summary = of(exact.iter().copied());
        exact.sort_by(f64::total_cmp);
        assert!(!summary.is_exact());
        for share in [0.0, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 1.0] {
            let [found] = summary.quantiles([share]).unwrap();
            let place = share * f64::from(count - 1);
            let (low, high) = (exact[place.floor() as usize], exact[place.ceil() as usize]);
            let wanted = low + (high - low) * place.fract();
            assert!(
                (found - wanted).abs() <= Summary::ERROR * wanted.abs() + 1e-12,
                "{share}: {found} {wanted}"
            );
        }
        assert!(summary.classes.len() < 60_000, "{}", summary.classes.len());
    }

    #[test]
    fn each_value_is_in_one_class_of_the_histogram() {
        assert_eq!(of([0.0, 1.0, 2.5, 9.9, 10.0]).histogram(5), [2, 1, 0, 0, 2]);
        assert_eq!(of([3.0, 3.0]).histogram(4), [2, 0, 0, 0]);
        assert_eq!(of([]).histogram(3), [0, 0, 0]);
        let counted = of((0..100_000).map(|index| f64::from(index % 1000)));
        let counts = counted.histogram(10);
        assert!(!counted.is_exact() && counts.iter().sum::<u64>() == 100_000);
        assert!(counts.iter().all(|count| (9_800..=10_200).contains(count)), "{counts:?}");
    }

    #[test]
    fn classes_keep_the_order_of_their_values() {
        let values = [-1e9, -3.0, -2.999, -1e-9, 0.0, 1e-9, 2.999, 3.0, 1e9];
        assert!(values.windows(2).all(|pair| class_of(pair[0]) <= class_of(pair[1])));
        for value in values {
            assert!((value_of(class_of(value)) - value).abs() <= Summary::ERROR * value.abs());
        }
    }
}
