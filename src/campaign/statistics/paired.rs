//! Comparisons of two sides that flew the same inputs.

use super::Significance;
use super::binomial::at_most;
use super::ranks::ranks;
use crate::design::normal_cdf;
use crate::math;

/// The least pairs with a difference for the normal approximation.
const MANY: usize = 10;

/// Returns McNemar's exact test: of the pairs in which only one side succeeded, how many were won by each.
pub(in crate::campaign) fn mcnemar(only_a: u64, only_b: u64) -> Significance {
    Significance { p: sign(only_a, only_b), test: "McNemar" }
}

/// Returns Wilcoxon's signed-rank test of the differences of the pairs; the sign test if there are few. `None` if all pairs
/// are equal.
pub(in crate::campaign) fn signed_rank(differences: &[f64]) -> Option<Significance> {
    let differences: Vec<f64> = differences
        .iter()
        .copied()
        .filter(|difference| difference.is_finite() && *difference != 0.0)
        .collect();
    if differences.is_empty() {
        return None;
    }
    if differences.len() < MANY {
        let positive = differences.iter().filter(|difference| **difference > 0.0).count() as u64;
        return Some(Significance { p: sign(positive, differences.len() as u64 - positive), test: "sign" });
    }
    let sizes: Vec<f64> = differences.iter().map(|difference| difference.abs()).collect();
    let ranks = ranks(&sizes);
    let n = ranks.len() as f64;
    let positive: f64 = std::iter::zip(&differences, &ranks)
        .filter(|(difference, _)| **difference > 0.0)
        .map(|(_, rank)| rank)
        .sum();
    let mean = n * (n + 1.0) / 4.0;
    // Equal sizes share their rank, which takes a part of the variance.
    let ties: f64 = {
        let mut sorted = sizes;
        sorted.sort_by(f64::total_cmp);
        sorted
            .chunk_by(|a, b| a == b)
            .map(|group| math::powi(group.len() as f64, 3) - group.len() as f64)
            .sum()
    };
    let variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0;
    let z = (positive - mean) / variance.sqrt();
    Some(Significance { p: (2.0 * normal_cdf(-z.abs())).min(1.0), test: "Wilcoxon" })
}

/// Returns the probability of counts at least as different, if both are as likely.
fn sign(a: u64, b: u64) -> f64 {
    (2.0 * at_most(a.min(b), a + b, 0.5)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mcnemars_test_is_a_binomial_test() {
        // 2 · (C(10,0) + C(10,1) + C(10,2)) / 2¹⁰
        assert!((mcnemar(2, 8).p - 112.0 / 1024.0).abs() < 1e-12);
        assert!((mcnemar(5, 5).p - 1.0).abs() < 1e-12);
        assert!((mcnemar(0, 0).p - 1.0).abs() < 1e-12);
        assert!(mcnemar(5, 41).is_real());
    }

    #[test]
    fn ranks_of_differences_are_compared_with_their_mean() {
        // 1 to 12, of which 3 and 7 are negative: the positive ranks sum to 68, their mean is 39, the variance 162.5.
        let differences: Vec<f64> = (1..=12)
            .map(|size| if [3, 7].contains(&size) { -f64::from(size) } else { f64::from(size) })
            .collect();
        let found = signed_rank(&differences).unwrap();
        let z = (68.0 - 39.0) / 162.5_f64.sqrt();
        assert_eq!(found.test, "Wilcoxon");
        assert!((found.p - 2.0 * normal_cdf(-z)).abs() < 1e-12);
    }

    #[test]
    fn few_pairs_are_compared_by_their_sign_and_equal_ones_not_at_all() {
        let found = signed_rank(&[0.5, 0.0, 1.5, 2.5, 3.0, 9.0]).unwrap();
        assert_eq!(found.test, "sign");
        assert!((found.p - 2.0 / 32.0).abs() < 1e-12);
        assert_eq!(signed_rank(&[0.0, 0.0, f64::NAN]), None);
    }
}
